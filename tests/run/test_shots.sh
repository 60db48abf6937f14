#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Shots: animated hair is drawn frame by frame, and frames have the numbers of the body or hair file in all outputs.
set -euo pipefail
render=$TRACTRIX_BIN/tractrix-render convert=$TRACTRIX_BIN/tractrix-convert
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
passed=0
good() { passed=$((passed + 1)); }
quick=(--look plain --followers 0 --scalp none --size 48x36 --quiet)

cat >sway.usda <<'U'
#usda 1.0
(
    metersPerUnit = 1
    upAxis = "Y"
    timeCodesPerSecond = 24
)
def BasisCurves "hair"
{
    uniform token type = "linear"
    int[] curveVertexCounts = [2]
    float[] widths = [0.02] (interpolation = "constant")
    point3f[] points.timeSamples = { 1001: [(0, 0, 0), (0, 0.1, 0)], 1002: [(0, 0, 0), (0.1, 0, 0)], 1003: [(0, 0, 0), (0, -0.1, 0)] }
}
U

# A played file: three frames at its rate, with its numbers, which differ; what is exported is what was read.
"$render" sway.usda "${quick[@]}" -o played/ --export played.usda
files=(played/*)
[ "${files[*]}" = "played/frame_1001.png played/frame_1002.png played/frame_1003.png" ] && good
"$TRACTRIX_BIN/tractrix-compare" played/frame_1001.png played/frame_1003.png >/dev/null && exit 1
good
grep -q 'timeCodesPerSecond = 24$' played.usda && grep -q 'startTimeCode = 1001' played.usda && good
grep -q '^ *1002: \[(0, 0, 0), (0.1, 0, 0)\]' played.usda && grep -q 'widths = \[0.02' played.usda && good

# --first and --last are these numbers, and others are refused.
"$render" sway.usda "${quick[@]}" --first 1002 --last 1002 -o one/
[ "$(ls one)" = frame_1002.png ] && good
status=0
"$render" sway.usda "${quick[@]}" --first 1 -o one/ 2>message || status=$?
[ $status = 2 ] && grep -q -- '--first 1: expected 1001 to 1003, since --frames is 3' message && good

# A simulation starts from any frame; a cache keeps the numbers.
"$render" sway.usda "${quick[@]}" --algo split --hair-frame 1003 --frames 1 --frame-number 7 --cache sim.cache --export rest.npz
"$convert" sim.cache -o sim.usda >/dev/null
grep -q 'startTimeCode = 7' sim.usda && grep -q '7: \[(0, 0, 0), (0, -0.1, 0)\]' sim.usda && good
"$convert" sway.usda --frame-number 1 -o shifted.usda >/dev/null
grep -q 'startTimeCode = 1$' shifted.usda && good

# Numbered files are frames, too.
"$convert" sway.usda -o "sway_%04d.tfx" >/dev/null 2>&1
"$render" "sway_%04d.tfx" "${quick[@]}" -o numbered/
[ "$(find numbered -name 'frame_100[123].png' | wc -l)" = 3 ] && good

# An encoder that ends early with success, though the frames fit into the pipe, is a failure.
mkdir fake
cat >fake/ffmpeg <<'F'
#!/bin/sh
head -c 100 >/dev/null
for last; do :; done
echo video >"${last#file:}"
F
chmod +x fake/ffmpeg
status=0
PATH=$PWD/fake:$PATH "$render" sway.usda "${quick[@]}" -o early.mp4 2>message || status=$?
[ $status = 1 ] && grep -q 'stopped reading' message && [ ! -e early.mp4 ] && good
echo "$passed passed, $((10 - passed)) failed, 0 skipped"
