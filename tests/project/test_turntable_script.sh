#!/bin/sh
# SPDX-License-Identifier: MIT
# The command line of scripts/turntable: every format, options of tractrix-render, errors.
. tests/support/claims.sh
program=scripts/turntable
turns=$work/turns
export TRACTRIX_BIN="$bin" TURNTABLE_OUT="$turns" TURNTABLE_S=0.5
small="--size 64x48 --quality draft --look plain --followers 0 --preroll 0.1"

# stream FILE EXPECTED: compares codec, size, pixel format and frames, as ffprobe reports them.
stream() {
    got=$(ffprobe -v error -count_frames -of csv=p=0 -show_entries stream=codec_name,width,height,pix_fmt,nb_read_frames "$turns/$1")
    if [ "$got" = "$2" ]; then good; else bad "$1: $got, expected $2"; fi
}
# png FILE EXPECTED: compares width, height, bits of a channel and the type of colour (2: RGB) in the header.
png() {
    # shellcheck disable=SC2046 # numbers
    set -- "$1" "$2" $(od -An -tu1 -j 16 -N 10 "$turns/$1")
    got=$(($5 * 256 + $6)),$(($9 * 256 + ${10})),${11},${12}
    if [ "$3$4$7$8" = 0000 ] && [ "$got" = "$2" ]; then good; else bad "$1: $got, expected $2"; fi
}

claim "a sheet and frames, and nothing else"
# shellcheck disable=SC2086 # lists of words
run 0 assets/fur.tfx sheet frames -- $small
is_file "$turns/fur_sheet.png"
if [ "$(find "$turns/fur" -name 'frame_*.png' | wc -l)" = 15 ]; then good; else bad "not 15 frames"; fi
if [ "$(find "$turns" -name '*.cache*' | wc -l)" = 0 ]; then good; else bad "the cache was left behind"; fi

claim "videos of each kind"
if command -v ffprobe >/dev/null; then
    # shellcheck disable=SC2086
    run 0 assets/fur.tfx mp4 webm gif -- $small --size 65x49
    stream fur.mp4 h264,66,50,yuv420p,15
    stream fur.webm vp9,65,49,yuv420p,15
    stream fur.gif gif,65,49,bgra,8
else
    skip "ffprobe is not installed"
fi

claim "frames are drawn once: gif and sheet are made of them, the sheet with the same tiles as tractrix-render's"
if command -v ffmpeg >/dev/null; then
    mkdir "$work/counted"
    printf '#!/bin/sh\necho "$*" >>"%s/runs"\nexec "%s/tractrix-render" "$@"\n' "$work" "$bin" >"$work/counted/tractrix-render"
    chmod +x "$work/counted/tractrix-render"
    # shellcheck disable=SC2086
    TRACTRIX_BIN="$work/counted" run 0 assets/fur.tfx sheet gif frames -o "$work/once" $small --fps 20 -s 1 -q
    if [ "$(grep -c -- '--from-cache' "$work/runs")" = 1 ]; then good; else bad "frames were drawn more than once"; fi
    # shellcheck disable=SC2086
    run 0 assets/fur.tfx sheet -o "$work/alone" $small --fps 20 -s 1 -q
    holds "$bin/tractrix-compare" "$work/alone/fur_sheet.png" "$work/once/fur_sheet.png" --pixel-tolerance 0
    # One second of 20 frames, of which a gif has every second one.
    turns=$work/once stream fur.gif gif,64,48,bgra,10

    claim "several videos, or frames and videos, are made from frames that are drawn once, with the bytes of tractrix-render's own"
    for more in "" "--background transparent"; do
        kinds="mp4 webm"
        [ -z "$more" ] || kinds="webm frames"
        : >"$work/runs"
        # shellcheck disable=SC2086
        TRACTRIX_BIN="$work/counted" run 0 assets/fur.tfx $kinds gif sheet -o "$work/several" $small --size 65x49 --caption frame -s 0.5 -q $more
        if [ "$(grep -c -- '--from-cache' "$work/runs")" = 1 ]; then good; else bad "$kinds: frames were drawn more than once"; fi
        for kind in $kinds; do
            case $kind in frames) continue ;; esac
            # shellcheck disable=SC2086
            run 0 assets/fur.tfx $kind -o "$work/single" $small --size 65x49 --caption frame -s 0.5 -q $more
            equal "$work/single/fur.$kind" "$work/several/fur.$kind"
        done
        turns=$work/several stream fur.gif gif,65,49,bgra,8
    done
    if [ "$(find "$work/several" -type f | wc -l)" = 19 ]; then good; else bad "other files than two videos, a sheet, an animation and 15 frames are left"; fi
    # shellcheck disable=SC2086
    : >"$work/runs"
    # shellcheck disable=SC2086
    TRACTRIX_BIN="$work/counted" run 2 assets/fur.tfx mp4 frames -o "$work/clear" $small -s 0.1 -q --background transparent; says ".mp4 cannot hold a transparent background"
    if grep -q -- '--cache' "$work/runs"; then bad "it was simulated before"; else good; fi
    # Hair with a defect is repaired; a file that is not there gets its message.
    printf 'numStrands 1\nis sorted 1\nstrand 0 numVerts 3 texcoord 0 0\n0 0 0\n0 -0.1 0\n0 -0.1 0\n' >"$work/mended.tfx"
    # shellcheck disable=SC2086
    run 0 "$work/mended.tfx" mp4 -o "$work/mended" $small --unit m -s 0.1 -q; is_file "$work/mended/mended.mp4"
    run 3 "$work/none.tfx" mp4 -o "$work/mended"; one_line; says "none.tfx"

    claim "--contact-sheet and --every need no second drawing"
    : >"$work/runs"
    # shellcheck disable=SC2086
    TRACTRIX_BIN="$work/counted" run 0 assets/fur.tfx mp4 sheet gif --contact-sheet 3x2 --every 3 -o "$work/own_sheet" $small -s 0.5 -q
    if [ "$(grep -c -- '--from-cache' "$work/runs")" = 1 ]; then good; else bad "frames were drawn more than once"; fi
    turns=$work/own_sheet png fur_sheet.png 192,96,8,2
    turns=$work/own_sheet stream fur.gif gif,64,48,bgra,5
    for tiles in 3 0x3 08x3 3x1000 ''; do run 2 assets/fur.tfx sheet --contact-sheet "$tiles"; one_line; says "expected WxH"; done
    run 2 assets/fur.tfx gif --contact-sheet 3x2; one_line; says "expected the format sheet"

    claim "an --every of 1 holds for animations, too; a scene's own does not count"
    # shellcheck disable=SC2086
    run 0 assets/fur.tfx mp4 gif --every 1 -o "$work/each" $small -s 0.5 -q
    turns=$work/each stream fur.gif gif,64,48,bgra,15
    cp assets/fur.tfx "$work/fur.tfx"
    printf '{"sections": [{"file": "fur.tfx"}], "every": 2}' >"$work/halved.json"
    # shellcheck disable=SC2086
    run 0 "$work/halved.json" webm frames -o "$work/halved" $small -s 0.1 -q
    if [ "$(find "$work/halved/halved" -name 'frame_*.png' | wc -l)" = 3 ]; then good; else bad "not 3 frames"; fi
    if [ "$(find "$work/once" | wc -l)" = 24 ]; then good; else bad "other files than 20 frames, a sheet and an animation are left"; fi
else
    skip "ffmpeg is not installed"
fi

claim "--help and --version are answered, wherever it stands and whatever may be written"
run 0 --help; says "Usage: turntable [OPTION]... ASSET"; silent err
run 0 --version; says "turntable "
none out/turntable/--help
# A parallel build makes its manual page before there are programs.
TRACTRIX_BIN="$work/nowhere" run 0 --help; says "Usage: turntable [OPTION]... ASSET"; silent err

claim "options of its own, and of tractrix-render without --"
unset TURNTABLE_OUT TURNTABLE_S
# shellcheck disable=SC2086
run 0 -s 0.1 assets/fur.tfx frames -o "$work/own/" $small -q
if [ "$(find "$work/own/fur" -name 'frame_*.png' | wc -l)" = 3 ]; then good; else bad "not 3 frames"; fi
run 0 --seconds=0.04 --output="$work/long" assets/fur.tfx sheet --size 16x16 --quality draft --look plain --followers 0 --preroll 0 -q
is_file "$work/long/fur_sheet.png"; silent err

claim "results are listed; gusts repeat with a turn of --frames"
printf '#!/bin/sh\necho "$*" >>"%s/words"\nexec "%s/tractrix-render" "$@"\n' "$work" "$bin" >"$work/heard"
mkdir "$work/hears" && mv "$work/heard" "$work/hears/tractrix-render" && chmod +x "$work/hears/tractrix-render"
TRACTRIX_BIN="$work/hears" run 0 assets/fur.tfx sheet frames -o "$work/told" --size 16x16 --quality draft --look plain --followers 0 --preroll 0 --frames 5 --fps 10 --wind 1,0,0
says "turntable: $work/told/fur_sheet.png"; says "turntable: $work/told/fur/"
if grep -q -- '--gust-repeat 0.5 ' "$work/words"; then good; else bad "gusts do not repeat after 5 frames of 10 a second"; fi

claim "without --size: frames of 960x960 px, animations of 480x480, sheets of tiles of 320x320"
if command -v ffprobe >/dev/null; then
    run 0 -s 0.04 assets/fur.tfx frames gif sheet -o "$work/free" --quality draft --look plain --followers 0 --preroll 0 -q
    turns=$work/free
    png fur/frame_0000.png 960,960,8,2
    stream fur.gif gif,480,480,bgra,1
    png fur_sheet.png 1920,1280,8,2
else
    skip "ffprobe is not installed"
fi

claim "options, asset and formats stand in any order"
run 0 --size 16x16 -q --turntable 90 --turn-lights assets/fur.tfx --quality=draft --look plain --followers 0 sheet --preroll 0 --seconds 0.04 -o "$work/late"
is_file "$work/late/fur_sheet.png"

claim "what it can't do is refused"
run 2 -o; one_line; says "expected DIR"; run 2 --seconds x assets/fur.tfx; one_line; says "got 'x'"; run 2 --output= assets/fur.tfx; one_line
run 2 sheet; one_line; says "no asset"
run 2 assets/fur.tfx assets/ball.obj sheet; one_line; says "a second file: expected one ASSET (a mesh goes after --mesh"
echo text >"$work/text"; run 2 assets/fur.tfx -o "$work/text"; one_line; says "is a file: expected a folder"
run 2 assets/fur.tfx -o "$work/turn.mp4"; one_line; says "expected a folder; mp4 is the word for a format"; none "$work/turn.mp4"
for wrong in "--colour red" "-q --colour red --size 16x16"; do
    # shellcheck disable=SC2086 # lists of words
    run 2 assets/fur.tfx sheet $wrong; one_line; says "--colour: no such option: did you mean '--color'?"
done
run 2 assets/fur.tfx sheet --albedo blnod; one_line; says "nearest: blond"
run 2; one_line; says "no asset"; run 2 --no-such-option; one_line; run 2 assets/fur.tfx avi; one_line; run 3 "$work/none.tfx" sheet; run 2 assets/fur.tfx sheet -- --no-such-flag
finish
