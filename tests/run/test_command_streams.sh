#!/bin/sh
# SPDX-License-Identifier: MIT
# Images of tractrix-render on standard output, raw video, and EXR files.
. tests/support/claims.sh
program=$bin/tractrix-render
compare=$bin/tractrix-compare
hair="assets/fur.tfx --look plain --followers 0 --size 33x25"
turn="$hair --frames 3 --turntable 90 --speed 0"

# stream STATUS ARGUMENT...: runs the program with its output to $work/stream.
stream() {
    expected=$1; shift
    "$program" "$@" >"$work/stream" 2>"$work/err" </dev/null
    status=$?
    if [ "$status" = "$expected" ]; then good; else bad "exit status $status, expected $expected: $*"; fi
}

claim "PNG files follow one another on standard output, and nothing else"
# shellcheck disable=SC2086
run 0 $turn -q -o "$work/f_%d.png"
# shellcheck disable=SC2086
stream 0 $turn -o -
in_file "$work/err" "3 frames"; in_file "$work/err" "standard output"
cat "$work/f_0.png" "$work/f_1.png" "$work/f_2.png" >"$work/all"
equal "$work/all" "$work/stream"
if cmp -s "$work/f_0.png" "$work/f_2.png"; then bad "the turntable stands still"; else good; fi
# shellcheck disable=SC2086
stream 0 $turn -q -o -.png; equal "$work/all" "$work/stream"; silent err

claim "a contact sheet, PFM and EXR go to standard output as well"
# shellcheck disable=SC2086
stream 0 $turn -q --contact-sheet 2x1 -o -; is_png "$work/stream"
for kind in pfm exr; do
    # shellcheck disable=SC2086
    run 0 $hair -q -o "$work/one.$kind"
    # shellcheck disable=SC2086
    stream 0 $hair -q -o -.$kind; equal "$work/one.$kind" "$work/stream"
    # shellcheck disable=SC2086
    run 2 $turn -q -o -.$kind; one_line; says "one image for 3 frames"
done

claim "raw video: its size is that of its frames, and a file is the same as a stream"
# shellcheck disable=SC2086
stream 0 $turn -q --fps 29.97 -o -.y4m
# shellcheck disable=SC2086
run 0 $turn -q --fps 29.97 -o "$work/v.y4m"; equal "$work/v.y4m" "$work/stream"
head=$(head -n 1 "$work/v.y4m")
if [ "$head" = "YUV4MPEG2 W33 H25 F30000:1001 Ip A1:1 C444 XCOLORRANGE=LIMITED" ]; then good; else bad "$head"; fi
if [ "$(wc -c <"$work/v.y4m")" = $((${#head} + 1 + 3 * (6 + 3 * 33 * 25))) ]; then good; else bad "another size"; fi
# shellcheck disable=SC2086
run 2 $turn -q --background transparent -o -.y4m; one_line; says "transparent"

if command -v ffmpeg >/dev/null; then
    claim "ffmpeg reads both streams, every frame, and its colours are ours within the rounding of 8 bits"
    ffmpeg -nostdin -loglevel error -i "$work/v.y4m" -vf scale=in_color_matrix=bt709:flags=accurate_rnd+full_chroma_int \
        -pix_fmt rgb24 "$work/y_%d.png" -y 2>"$work/err"
    ffmpeg -nostdin -loglevel error -f image2pipe -i "$work/all" -start_number 0 "$work/p_%d.png" -y 2>"$work/err"
    none "$work/y_4.png"; none "$work/p_3.png"
    for frame in 0 1 2; do
        holds "$compare" "$work/f_$frame.png" "$work/p_$frame.png"
        # 1.164 levels of luma, 2.018 of chroma: half a step of each plus half a step of RGB is 2.1 levels.
        holds "$compare" "$work/f_$frame.png" "$work/y_$((frame + 1)).png" --pixel-tolerance 2.1
    done
    claim "a video comes out of a pipe"
    # shellcheck disable=SC2086
    "$program" $turn -q -o -.y4m | ffmpeg -loglevel error -i - -pix_fmt yuv420p -vf pad=34:26 "$work/v.mp4" 2>"$work/err"
    is_file "$work/v.mp4"
    claim "a video on a full disk is a failure that says so, and leaves nothing"
    mkdir "$work/disk"
    if unshare -m mount -t tmpfs -o size=24k none "$work/disk" 2>"$work/err"; then
        for name in v.mp4 v.webm v.gif; do
            # shellcheck disable=SC2016,SC2086
            unshare -m sh -c 'cd "$1" && mount -t tmpfs -o size=24k none disk || exit 9
                shift; "$@"; status=$?; ls -A "${0%/*}"; exit "$status"' "$work/disk/$name" "$work" \
                "$(realpath "$program")" "$PWD/assets/curls.tfx" --algo none --followers 0 --look plain --size 160x120 --turntable 360 --frames 40 -q \
                -o "$work/disk/$name" >"$work/out" 2>"$work/err"
            status=$?
            if [ $status = 1 ]; then good; else bad "exit status $status, expected 1"; fi
            one_line; says "No space left on device"; silent out
        done
    else
        skip "no file system can be mounted here"
    fi
else
    claim "ffmpeg reads streams"; skip "no ffmpeg"
fi

claim "a reader that leaves ends the run with one line and status 1"
for name in - -.y4m; do
    # shellcheck disable=SC2086
    { "$program" $hair --frames 100000 -q -o $name 2>"$work/err"; echo $? >"$work/status"; } | head -c 100 >/dev/null
    if [ "$(cat "$work/status")" = 1 ]; then good; else bad "status $(cat "$work/status")"; fi
    one_line; says "standard output: cannot write: Broken pipe"
done

claim "wrong streams are refused before anything is drawn"
# shellcheck disable=SC2086
run 2 $hair -q -o -.mp4; one_line; says "for standard output, or"
# shellcheck disable=SC2086
run 2 $hair -q -o - --stats -; one_line; says "--stats"
# shellcheck disable=SC2086
run 2 $turn -q --resume -o -; one_line; says "one piece"
if command -v script >/dev/null; then
    # shellcheck disable=SC2086
    script -qec "$program $hair -q -o -" /dev/null </dev/null >"$work/out" 2>&1
    if [ $? = 2 ]; then good; else bad "status $?"; fi
    says "is a terminal"

    claim "on a terminal, the simulation that fits the camera shows its progress"
    script -qec "$program $turn --frames 6 -o $work/turn/" /dev/null </dev/null >"$work/out" 2>&1
    # One bar ends before the bar of the images begins.
    grep -o '[16]/6 \[' "$work/out" | uniq | tr '\n' ' ' >"$work/bars"
    in_file "$work/bars" "6/6 [ 1/6 ["
fi

claim "statistics go to standard output, too"
# shellcheck disable=SC2086
stream 0 $hair -q -o "$work/s.png" --stats -; in_file "$work/stream" '"frames_drawn": 1'

claim "an EXR file shows what a PFM file does, within a half's 11 bits, and the same bytes each time"
# shellcheck disable=SC2086
run 0 $hair -q -o "$work/again.exr"; equal "$work/one.exr" "$work/again.exr"
# shellcheck disable=SC2086
run 0 $hair -q --exr-float -o "$work/wide.exr"
holds "$compare" "$work/one.pfm" "$work/wide.exr"
holds "$compare" "$work/one.pfm" "$work/one.exr" --pixel-tolerance 0.2
# shellcheck disable=SC2086
run 0 $hair -q --no-exr-layers -o "$work/bare.exr"; holds "$compare" "$work/one.exr" "$work/bare.exr"
if [ "$(wc -c <"$work/bare.exr")" -lt "$(wc -c <"$work/one.exr")" ]; then good; else bad "has layers"; fi
if grep -q coverage "$work/bare.exr"; then bad "has layers"; else good; fi
for word in Renderer worldToCamera worldToNDC tangent.X coverage; do in_file "$work/one.exr" "$word"; done

claim "numbered EXR files, repeated frames with their layers, and resumed ones"
# shellcheck disable=SC2086
run 0 $hair --algo none --frames 2 -q -o "$work/e/x_%d.exr"
holds "$compare" "$work/e/x_0.exr" "$work/e/x_1.exr"
if [ "$(wc -c <"$work/e/x_0.exr")" = "$(wc -c <"$work/e/x_1.exr")" ]; then good; else bad "another size"; fi
# shellcheck disable=SC2086
run 0 $hair --algo none --frames 3 --resume -o "$work/e/x_%d.exr"; says "2 of 3 frames are already written"
# shellcheck disable=SC2086
run 2 $hair -q --exr-float -o "$work/x.png"; one_line; says "exr"

claim "transparent EXR files keep their alpha: over black and white they are what PNG shows, but for blending in light"
# shellcheck disable=SC2086
run 0 $hair -q --background transparent --exr-float -o "$work/t.exr"
# shellcheck disable=SC2086
run 0 $hair -q --background transparent -o "$work/t.pfm"
holds "$compare" "$work/wide.exr" "$work/wide.exr"
if "$compare" -q "$work/t.exr" "$work/t.pfm"; then bad "the alpha is lost"; else good; fi

claim "reports of a comparison on standard output have it for themselves"
"$compare" "$work/one.exr" "$work/t.exr" --json - >"$work/stream" 2>"$work/err" </dev/null
if [ $? = 1 ]; then good; else bad "another status"; fi
in_file "$work/err" "1 image: 1 different"; in_file "$work/stream" '"rmse"'
if [ "$(head -c 1 "$work/stream")" = "{" ] && ! grep -q "image: " "$work/stream"; then good; else bad "lines among the JSON"; fi
"$compare" "$work/one.exr" "$work/one.exr" --junit - 2>"$work/err" </dev/null | head -n 1 >"$work/stream"; in_file "$work/stream" "<?xml"
"$compare" "$work/f_0.png" "$work/f_2.png" --heatmap - 2>"$work/err" </dev/null >"$work/stream"; is_png "$work/stream"
program=$compare; run 2 "$work/one.exr" "$work/one.exr" --json - --junit -; one_line; says "expected at most one"
# shellcheck disable=SC2086
if "$bin/tractrix-render" $hair -q -o -.exr 2>"$work/err" | "$compare" -q "$work/one.exr" /dev/stdin 2>>"$work/err"; then
    good
else
    bad "a pipe differs"
fi
finish
