#!/bin/sh
# SPDX-License-Identifier: MIT
# Runs the examples of README.md (its block marked sh) with smaller images and fewer frames.
. tests/support/checkout.sh

command -v ffmpeg >/dev/null || { echo "skipped: no ffmpeg"; exit 77; }
make_checkout
awk '/^```sh$/ { inside = 1; next } /^```$/ { inside = 0 } inside' README.md |
    sed -e 's/^tractrix-render /.\/small /' -e 's/--first 0 --last 92 --every 92/--first 1 --last 3 --every 2/' -e 's/--first 60 --last 119/--first 2 --last 3/' \
        >"$work/checkout/commands"

claim "the README's commands work"
cd "$work/checkout" || exit 1
if [ "$(grep -c '^tractrix-' commands)" -ge 3 ] && [ "$(grep -c '^./small' commands)" -ge 5 ]; then good; else bad "commands are missing"; fi
holds sh -eu commands
says "curvature"
for file in frames/frame_0003.png curls.mp4 demo.png gust/frame_0003.png gust.usda; do is_file "out/$file"; done
finish
