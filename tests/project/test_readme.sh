#!/bin/sh
# SPDX-License-Identifier: MIT
# The commands of README.md work as they stand there, one after the other, with smaller pictures and fewer frames. Those of
# tractrix-compare name files that a reader has.
. tests/support/checkout.sh

command -v ffmpeg >/dev/null || { echo "skipped: no ffmpeg"; exit 77; }
make_checkout

# What stands in a line of its own; tractrix-render is the small one, and has fewer frames to choose from.
sed -n -e 's/^    \(PATH=\|tractrix-gen \|tractrix-convert \)/\1/p' -e 's/^    tractrix-render /.\/small /p' README.md |
    sed -e 's/--first 43 --last 93 --every 50/--first 1 --last 3 --every 2/' -e 's/--first 60 --last 119/--first 2 --last 3/; s/--last 29/--last 3/' \
        >"$work/checkout/commands"

claim "the README's commands work"
cd "$work/checkout" || exit 1
if [ "$(grep -c tractrix- commands)" -ge 5 ] && [ "$(grep -c small commands)" -ge 8 ]; then good; else bad "commands are missing"; fi
holds sh -eu commands
says "curvature"
for file in frames/frame_0003.png both/frame_0003.png curls.mp4 large/demo_0003.png demo.png gust/frame_0003.png thin.hair gust.usda; do
    is_file "out/$file"
done
finish
