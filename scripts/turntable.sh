#!/bin/sh
# SPDX-License-Identifier: MIT
# Makes a turntable of a hair file or scene, in every format asked for. Simulates once.
# usage: turntable.sh ASSET [FORMAT...] [-- OPTION...]
#   FORMAT   mp4 webm gif sheet frames; default: mp4 sheet (without ffmpeg: sheet)
#   OPTION   of tractrix-render, for all of them, over what is set below: -- --mesh head.obj --wind 2,0,0
# Environment: TRACTRIX_BIN folder of the programs (this one's, or out/release), TURNTABLE_OUT where files go (out/turntable),
# TURNTABLE_S seconds of a turn (6).
set -eu
here=$(dirname "$0")
if [ -x "$here/tractrix-render" ]; then beside=$here; else beside=$here/../out/release; fi # installed as tractrix-turntable, or not
programs=${TRACTRIX_BIN:-$beside}
out=${TURNTABLE_OUT:-out/turntable}
seconds=${TURNTABLE_S:-6}
name=$(basename "$0")
fail() { echo "$name: $*" >&2; exit 2; }

case ${1-} in
-h | --help) sed -n "s/turntable.sh/$name/; 3,8s/^# //p" "$0"; exit ;;
--version) "$programs/tractrix-render" --version | sed "s/^[^ ]*/$name/"; exit ;;
-*) fail "$1: no such option: expected $name ASSET [FORMAT...] [-- OPTION...]" ;;
'') fail "no asset: expected $name ASSET [mp4|webm|gif|sheet|frames ...] [-- OPTION...]" ;;
esac
asset=$1
shift
formats=
while [ $# -gt 0 ] && [ "$1" != -- ]; do
    case $1 in mp4 | webm | gif | sheet | frames) formats="$formats $1" ;;
    *) fail "$1: no such format: expected mp4, webm, gif, sheet or frames, and -- before options" ;; esac
    shift
done
[ $# -eq 0 ] || shift
if [ -z "$formats" ]; then
    formats=sheet
    if command -v ffmpeg >/dev/null; then formats="mp4 sheet"; else echo "$name: no ffmpeg: writes no video" >&2; fi
fi
hair=$(basename "$asset")
hair=${hair%.*}
mkdir -p "$out"
cache=$(mktemp "$out/$hair.XXXXXX.cache")
trap 'rm -f "$cache" "$cache.state"' EXIT
trap 'exit 130' INT TERM

# What moves: 30 frames a second, forces that repeat with the turn, hair that has settled for two turns before.
frames=$(awk "BEGIN { print int(30 * $seconds + 0.5) }")
[ "$frames" -gt 0 ] || fail "TURNTABLE_S=$seconds: expected seconds"
turn_s=$(awk "BEGIN { print $frames / 30 }")
moves="--frames $frames --fps 30 --sim-rate 120 --preroll $(awk "BEGIN { print 2 * $turn_s }")"
case "$* $(grep -ao '"wind"' "$asset" 2>/dev/null || true)" in # without wind there are no gusts
*--wind* | *'"wind"'*) moves="$moves --gust-repeat $turn_s" ;;
esac

# The image: a neutral background, light that stays with the camera, shadows.
looks="--turntable --quality final --background #8a8d91 --turn-lights"

# shellcheck disable=SC2086 # lists of words
run() { "$programs/tractrix-render" "$asset" $moves $looks "$@"; }
run --quiet --cache "$cache" "$@"
for format in $formats; do
    case $format in
    mp4 | webm) run --from-cache "$cache" --size 1280x720 -o "$out/$hair.$format" "$@" ;;
    gif) run --from-cache "$cache" --size 480x360 --every 2 -o "$out/$hair.gif" "$@" ;;
    sheet) run --from-cache "$cache" --size 320x320 --contact-sheet 6x4 -o "$out/${hair}_sheet.png" "$@" ;;
    frames)
        rm -f "$out/$hair"/frame_*.png
        run --from-cache "$cache" --size 1280x720 -o "$out/$hair/" "$@"
        ;;
    esac
done
