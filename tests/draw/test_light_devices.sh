#!/bin/sh
# SPDX-License-Identifier: MIT
# Light among hair is the same on CPU drivers, which find it in C, and on GPUs, which find it by shaders and are imitated here,
# where little else tests it: a lamp inside the hair with a mesh before and behind it, and sheer hair.
. tests/support/claims.sh
program=$bin/tractrix-render
"$bin/tractrix-gen" --kind straight --shape sphere --count 300 --vertices 6 --length 0.05 -q -o "$work/h.tfx"
"$bin/tractrix-gen" --kind straight --shape sphere --count 25 --vertices 6 --length 0.2 -q -o "$work/sheer.tfx"

# wall NAME X: a square of 12 cm across x.
wall() {
    printf 'v %s -.06 -.06\nv %s .06 -.06\nv %s .06 .06\nv %s -.06 .06\nf 1 2 3\nf 1 3 4\nf 3 2 1\nf 4 3 1\n' "$2" "$2" "$2" "$2" >"$work/$1.obj"
}
wall right 0.05; wall left -0.05
lamp='{"type": "point", "position": [0, 0.004, 0.003], "distance": 0.1, "intensity": 3, "shadow": true}'
sun='{"type": "directional", "direction": [-1, -1, -0.5], "intensity": 3, "shadow": true}'
printf '{"sections": [{"file": "h.tfx"}], "lights": [%s]}\n' "$lamp" >"$work/lamp.json"
printf '{"sections": [{"file": "sheer.tfx"}], "lights": [%s]}\n' "$sun" >"$work/sheer.json"

# alike NAME SCENE OPTION...: both devices draw it; at most one pixel in a hundred differs by more than a level. Sums of floats in another order, and sines of a GPU, move a few of them.
alike() {
    name=$1 scene=$2; shift 2
    for device in cpu gpu; do
        TRACTRIX_ASSUME=
        if [ $device = gpu ]; then TRACTRIX_ASSUME="hardware ulps=1"; fi
        export TRACTRIX_ASSUME
        run 0 "$work/$scene.json" --frames 1 --algo none --followers 0 --scalp none --eye 0,0,0.9 --target 0,0,0 --fov 25 --size 40x40 --sky black --ground black \
            --background black --color white --albedo auto --scatter grid --scatter-cells 16 --raster blocks --exposure 2 --tone-map none -q -o "$work/$name.$device.png" "$@"
    done
    holds "$bin/tractrix-compare" "$work/$name.cpu.png" "$work/$name.gpu.png" --pixel-tolerance 1 --max-failing-pixels 1%
}

claim "a lamp among hair, with a mesh between it and one half"
alike none lamp --radius 1e-3
for side in left right; do
    alike $side lamp --radius 1e-3 --mesh "$work/$side.obj" --no-collide-mesh
    # and the mesh does something
    if "$bin/tractrix-compare" -q "$work/none.gpu.png" "$work/$side.gpu.png" --pixel-tolerance 2; then bad "$side: without effect"; else good; fi
done

claim "sheer hair, of a few strands that let light through"
for words in "--radius 1e-4" "--radius 3e-3 --shadow-opacity 0.05 --scatter-cells 40"; do
    # shellcheck disable=SC2086
    alike sheer sheer $words
done
finish
