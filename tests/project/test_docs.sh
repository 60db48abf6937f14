#!/bin/sh
# SPDX-License-Identifier: MIT
# Runs the examples of the pages in docs/ (blocks marked sh) with smaller images and fewer frames. The tutorial has its
# own test.
. tests/support/checkout.sh

make_checkout
cp -r docs tests python "$work/checkout/"
PATH=$(realpath "$bin"):$PATH
export PATH

for page in docs/*.md; do
    [ "$page" != docs/tutorial.md ] || continue
    claim "the examples of $page run"
    awk '/^```sh$/ { inside = 1; print "# line " NR; next } /^```$/ { inside = 0 } inside' "$page" |
        sed 's/^\( *\([A-Z_]*=[^ ]* \)*\)tractrix-render /\1.\/small /; s/--contact-sheet [0-9x]*/--contact-sheet 2x2/; s/--count 20000 /--count 500 /; s/--guides [1-9]*00 /--guides 200 /; s/ -n 10000 / -n 200 /; s/range(200)/range(5)/; s/size=(160, 120)/size=(64, 48), exposure=0/; s/ --curve bspline//
            s/^for color in .*; do$/for color in black ginger; do/
            s/ --first 72 / --first 6 /; /^curls_/ { s/--size 320x240/--size 64x48 --look plain --followers 1/; s/--frames 20 --first 19/--frames 4 --first 3/; }
            /^tractrix-gen --kind straight/ s/ -n 2000 / -n 200 /
            /^tractrix-bench /{ s/ image --set curls / image --set fur /; s/ --frames 2 / --frames 1 /; }
            /^tractrix-bench scenes / s/ --steps 20 / --steps 3 --warm-up 2 /
            /^tractrix-bench / { s/ --seconds 5/ --seconds 1/; s/ --steps [25]0/ --steps 5/; s/ --size 320x180/ --size 96x54/; }
            /^scripts.turntable / { s/--seconds 1 /--seconds 0.2 /; s/$/ --size 64x48 --followers 0 --quality draft --preroll 0 --sdf-resolution 24 --sim-rate 60/; }' >"$work/checkout/commands"
    if grep -q ffmpeg "$page" && ! command -v ffmpeg >/dev/null; then skip "no ffmpeg"; continue; fi
    if (cd "$work/checkout" && sh -eu commands) >"$work/out" 2>"$work/err" </dev/null; then
        good
    elif grep -q '^blender ' "$work/checkout/commands" && ! blender -b --factory-startup --python-exit-code 9 --python-expr 'import numpy' >/dev/null 2>&1; then
        skip "blender does not start, or its Python has no numpy"
    else
        bad "see above"
    fi
done
finish
