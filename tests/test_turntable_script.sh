#!/bin/sh
# SPDX-License-Identifier: MIT
# scripts/turntable.sh as a user meets it: every format, options behind --, what it refuses.
set -u
bin=${TRACTRIX_BIN:-out/release}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
passed=0 failed=0 skipped=0
good() { passed=$((passed + 1)); }
bad() { failed=$((failed + 1)); echo "FAILED: $*"; sed 's/^/    /' "$work/err"; }
export TRACTRIX_BIN="$bin" TURNTABLE_OUT="$work/out" TURNTABLE_S=0.5
small="--size 64x48 --quality draft --preroll 0.1"

# turn STATUS ARGUMENT...
turn() {
    expected=$1; shift
    scripts/turntable.sh "$@" >"$work/log" 2>"$work/err"
    status=$?
    if [ "$status" = "$expected" ]; then good; else bad "status $status, expected $expected: $*"; fi
}
is_file() { if [ -s "$work/out/$1" ]; then good; else bad "no $1"; fi; }
# stream FILE EXPECTED: codec, size, kind of pixels and frames as ffprobe has them.
stream() {
    got=$(ffprobe -v error -count_frames -of csv=p=0 -show_entries stream=codec_name,width,height,pix_fmt,nb_read_frames "$work/out/$1")
    if [ "$got" = "$2" ]; then good; else bad "$1: $got, expected $2"; fi
}

# shellcheck disable=SC2086 # lists of words
turn 0 assets/fur.tfx sheet frames -- $small
is_file fur_sheet.png
if [ "$(find "$work/out/fur" -name 'frame_*.png' | wc -l)" = 12 ]; then good; else bad "not 12 frames"; fi
if [ "$(find "$work/out" -name '*.cache*' | wc -l)" = 0 ]; then good; else bad "the cache was left behind"; fi

if command -v ffprobe >/dev/null; then
    # shellcheck disable=SC2086
    turn 0 assets/fur.tfx mp4 webm gif -- $small --size 65x49
    stream fur.mp4 h264,66,50,yuv420p,12
    stream fur.webm vp9,65,49,yuv420p,12
    stream fur.gif gif,65,49,bgra,6
else
    echo "skipped: ffprobe is not installed"
    skipped=$((skipped + 1))
fi

turn 2; turn 2 assets/fur.tfx avi; turn 3 "$work/none.tfx" sheet; turn 2 assets/fur.tfx sheet -- --no-such-flag
echo "$passed passed, $failed failed, $skipped skipped"
[ "$failed" = 0 ]
