#!/bin/sh
# SPDX-License-Identifier: MIT
# OpenGL calls for each frame of a running sequence: none makes the program wait for all queued work of a GPU.
. tests/support/claims.sh
program=$bin/tractrix-render
export TRACTRIX_GL_CALLS=1
scene="assets/bob.tfx --look plain --followers 0 --algo dftl --substeps 1 --size 96x72 -q --eye 0,0.1,0.8"

# calls MOST BLOCKING ARGUMENT...: a frame makes at most MOST calls, and exactly BLOCKING blocking reads.
calls() {
    most=$1 blocking=$2
    shift 2
    # shellcheck disable=SC2086 # words
    run 0 $scene "$@"
    if awk -v most="$most" -v blocking="$blocking" '
        / calls a frame/ { found = 1; good = $1 <= most && $5 == blocking }
        END { exit !(found && good) }' "$work/err"; then good; else bad "more than $most calls, or not $blocking blocking: $*"; fi
}

claim "quads: no read waits; images, the A-buffer's use and culled strands come late"
calls 200 0 --raster quads --turntable --frames 12 -o "$work/all/%d.png"

claim "compute: neither images nor the lists' use are waited for"
calls 200 0 --raster compute --turntable --frames 12 -o "$work/compute/%d.png"

claim "every frame is there and none is another's: they are those of single frames"
for i in 0 5 11; do
    # shellcheck disable=SC2086 # words
    run 0 $scene --raster compute --turntable --frames 12 --first $i --last $i -o "$work/one/c%d.png"
    same_images "$work/compute/$i.png" "$work/one/c$i.png"
    # shellcheck disable=SC2086 # words
    run 0 $scene --raster quads --turntable --frames 12 --first $i --last $i -o "$work/one/%d.png"
    same_images "$work/all/$i.png" "$work/one/$i.png"
done

claim "EXR files with layers: five images a frame, none is waited for"
calls 700 0 --raster quads --frames 4 -o "$work/%d.exr"

claim "blocks read hair by mapping it, which costs a CPU driver nothing"
calls 60 2 --raster blocks --frames 4 -o "$work/blocks/%d.png"

# ordered ARGUMENT...: every read of a buffer is ordered after the shaders that wrote it.
ordered() {
    run 0 "$@"
    if grep -q ' calls a frame.* 0 unordered in all$' "$work/err"; then good; else bad "unordered reads: $*: $(grep 'calls a frame' "$work/err")"; fi
}

claim "what a shader writes is read after a barrier; GPUs return older content otherwise"
"$bin/tractrix-gen" fur assets/ball.obj --count 200 -o "$work/few.tfx" >/dev/null 2>&1
small="$work/few.tfx --followers 0 -q --size 96x72 --frames 2 --preroll 0"
export XDG_CACHE_HOME="$work/cache"
# shellcheck disable=SC2086 # words
{
    ordered $small --raster blocks --algo split --colliders sphere:0,0,0,0.02 --stats "$work/split.json" --export "$work/split_%d.tfx" -o "$work/split/%d.png"
    ordered $small --raster compute --look plain --shadow dom --volume 0.5 --cache "$work/volume.cache" --resume -o "$work/volume/%d.png"
    ordered $small --raster quads --look plain --mesh assets/ball.obj --sdf-resolution 16 -o "$work/mesh/%d.png"
}

finish
