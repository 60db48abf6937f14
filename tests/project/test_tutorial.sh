#!/bin/sh
# SPDX-License-Identifier: MIT
# Runs the commands of docs/tutorial.md in order, in a copy of what they need, with smaller images and fewer frames.
. tests/support/checkout.sh

command -v ffmpeg >/dev/null || { echo "skipped: no ffmpeg"; exit 77; }
make_checkout
awk '/^```sh$/ { inside = 1; print "# line " NR; next } /^```$/ { inside = 0 } inside' docs/tutorial.md >"$work/commands"
# shellcheck disable=SC2016 # the shell that runs them expands it
sed -e 's/^\( *\)tractrix-render /\1.\/small /' -e 's/--count 8000 --guides 800/--count 1000 --guides 400/' \
    -e 's/^scripts\/farm/TRACTRIX_RENDER=$PWD\/small &/' "$work/commands" >"$work/checkout/commands"

claim "the tutorial's commands work"
cd "$work/checkout" || exit 1
holds sh -eu commands
says "they differ"
for file in fur.tfx still.png scene.mp4 split.mp4 hybrid.json turn.mp4 sheet.png near.mp4 farmed/frame_0003.png sim.usda heat/frame_0000.png report.xml; do
    is_file "out/tutorial/$file"
done
finish
