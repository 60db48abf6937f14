#!/bin/sh
# SPDX-License-Identifier: MIT
# Imitated devices (TRACTRIX_ASSUME, --assume-hardware): a low limit of work groups changes no byte, decisions as on a
# GPU draw the same picture, and so does a driver that rounds differently.
. tests/support/claims.sh
program=$bin/tractrix-render
# Every pass: followers, collisions with shapes and the mesh's field, volume, wind, sleep, shadows, light among hair, a floor.
scene="assets/curls.tfx --mesh assets/ball.obj --mesh-unit auto --sdf-resolution 24 --colliders capsule:0,-1,0,0.05,0,-1.2,0,0.05 --volume 0.5 --frames 2 --size 112x84 --samples 2 --scatter-cells 8 --shadow-size 128 --followers 1 --floor shadow --exposure 0 -q"

# draw FOLDER OPTION...
draw() {
    folder=$1
    shift
    # shellcheck disable=SC2086
    run 0 $scene "$@" -o "$work/$folder/"
}

claim "few work groups side by side draw the same bytes as many"
for raster in blocks compute quads; do
    draw "many_$raster" --raster $raster
    TRACTRIX_ASSUME=groups=3
    export TRACTRIX_ASSUME
    draw "few_$raster" --raster $raster
    unset TRACTRIX_ASSUME
    for frame in 0 1; do equal "$work/many_$raster/frame_000$frame.png" "$work/few_$raster/frame_000$frame.png"; done
done

claim "decisions as on a GPU draw the picture that a CPU driver has, and the picture says what it is of"
draw hardware --assume-hardware --raster blocks
holds "$bin/tractrix-compare" -q --pixel-tolerance 2 "$work/many_blocks" "$work/hardware"
in_file "$work/hardware/frame_0000.png" "assumed to be hardware"

claim "an image that is larger than a framebuffer is drawn as tiles, and no seam is seen"
for raster in blocks quads compute; do
    [ -d "$work/many_$raster" ] || draw "many_$raster" --raster $raster
    TRACTRIX_ASSUME=side=96
    export TRACTRIX_ASSUME
    draw "tiles_$raster" --raster $raster
    unset TRACTRIX_ASSUME
    # Positions relative to a tile are rounded differently than in the image: one level of difference, a few at a mesh's
    # edge.
    holds "$bin/tractrix-compare" -q --pixel-tolerance 1 --max-failing-pixels 0.2% "$work/many_$raster" "$work/tiles_$raster"
done

claim "an assumption that is not known is wrong usage"
TRACTRIX_ASSUME="hardware speed=2"
export TRACTRIX_ASSUME
run 2 assets/fur.tfx --frames 1 --size 32x24 -q -o "$work/x/"; one_line; says "'speed=2'"
unset TRACTRIX_ASSUME
finish
