#!/bin/sh
# SPDX-License-Identifier: MIT
# The bundled scenes, simulated: the haircut keeps its volume and leaves the face free, and no hair flies away.
. tests/support/claims.sh
program=$bin/tractrix-render

# settled FILE: no vertex of the Wavefront file lies in a cone of 33 degrees around the face, with its apex inside the
# skull, or more than 5 cm above the crown (0.11 m), and the hair is a quarter wider than the head (0.16 m), so it has
# volume.
settled() {
    if awk '$1 == "v" {
        x = $2; y = $3 + 0.02; z = $4
        if (z - 0.15*y > cos(33*3.14159265/180)*sqrt(1 + 0.15*0.15)*sqrt(x*x + y*y + z*z)) face++
        if ($3 > 0.16) high++
        if ($3 > -0.05 && x > right) right = x
        if ($3 > -0.05 && x < left) left = x
        count++
    } END {
        printf "%d vertices, %d before the face, %d too high, %.3f m wide\n", count, face, high, right - left
        exit !(count > 40000 && !face && !high && right - left > 0.2)
    }' "$1" >"$work/out"; then good; else bad "$1"; fi
}

claim "long hair at rest, and after the head has turned to both sides"
run 0 assets/demo.json --frames 60 --every 59 -q --export "$work/demo_%04d.obj"
settled "$work/demo_0000.obj"
settled "$work/demo_0059.obj"

claim "a gust carries the tips by more than 5 cm on average, away from the wind"
run 0 assets/demo.json --first 85 --last 85 -q --export "$work/gust_%04d.obj"
if awk 'FNR == 1 { file++; n = 0 } $1 == "v" && ++n % 32 == 0 { sum[file] += $2; tips[file]++ }
    END { moved = sum[2]/tips[2] - sum[1]/tips[1]; print moved; exit !(moved > 0.05) }' \
    "$work/demo_0000.obj" "$work/gust_0085.obj" >"$work/out"; then good; else bad "moves by"; fi

finish
