#!/bin/sh
# SPDX-License-Identifier: MIT
# Caches, resumed runs and exported hair of tractrix-render.
. tests/support/claims.sh
program=$bin/tractrix-render
hair=assets/fur.tfx
plain="--look plain --followers 0"

claim "a cache plays back what was simulated: any frames, the same pictures, in several processes at once"
scene="assets/demo.json --look plain --followers 1 --preroll 0.1 --sdf-resolution 32 --size 48x32 --frames 12" # followers avoid the mesh, which is not part of a cache
# shellcheck disable=SC2086
{
run 0 $scene -q --cache "$work/a.cache" -o "$work/direct/"
run 0 $scene -q --from-cache "$work/a.cache" -o "$work/played/"
"$program" $scene -q --from-cache "$work/a.cache" --first 6 -o "$work/farm/" 2>"$work/err" &
pid=$!
run 0 $scene -q --from-cache "$work/a.cache" --last 5 -o "$work/farm/"
}
wait $pid || bad "the other process"
for other in played farm; do
    if diff -r "$work/direct" "$work/$other" >"$work/err"; then good; else bad "$other differs"; fi
done
if [ -e "$work/a.cache.state" ]; then bad "a whole cache has a state"; else good; fi

claim "a cache of another scene, or one that is damaged or cut off, is refused by one line that says where"
# shellcheck disable=SC2086
{
run 3 $scene -q --from-cache "$work/a.cache" --style 0.3 -o "$work/x/"; one_line; says "sections[0].style"
run 3 $hair -q --from-cache "$work/a.cache" --frames 2 -o "$work/x/"; one_line; says "a.cache: was simulated with"
run 0 assets/fur.tfx --algo none --scalp none --frames 1 -q --cache "$work/fur.cache"
"$bin/tractrix-convert" assets/fur.tfx --scale 1.01 -q -o "$work/larger.tfx"
# One line: neither a device nor an exposure is reported before.
run 3 "$work/larger.tfx" --algo none --scalp none --frames 1 --from-cache "$work/fur.cache" -o "$work/x/"; one_line; says "fur.cache: was simulated with hair that differs from $work/larger.tfx"
run 3 $scene -q --from-cache "$work/a.cache" --frames 13 -o "$work/x/"; one_line; says "no frame 12: complete frames: 0 to 11"
run 3 $scene -q --from-cache "$work/none.cache" -o "$work/x/"; one_line; says "none.cache"
run 3 $scene -q --from-cache "$hair" -o "$work/x/"; one_line; says "TRXCACHE"
size=$(($(wc -c <"$work/a.cache") * 2 / 3))
head -c $size "$work/a.cache" >"$work/cut.cache"
run 3 $scene -q --from-cache "$work/cut.cache" -o "$work/x/"; one_line; says "complete frames: 0 to"; says "the file ends within"
if [ "$(grep -o cut.cache "$work/err" | wc -l)" = 1 ]; then good; else bad "the file is named more than once"; fi
run 0 $scene -q --from-cache "$work/cut.cache" --last 6 -o "$work/whole6/"
run 2 $scene --cache "$work/a.cache" --from-cache "$work/a.cache"; one_line
cp "$work/a.cache" "$work/flip.cache"
printf 'x' | dd of="$work/flip.cache" bs=1 seek=$size conv=notrunc 2>/dev/null
run 3 $scene -q --from-cache "$work/flip.cache" -o "$work/flip/"; one_line; says "flip.cache: frame"; says "checksum"
}
flipped=$(sed -n 's/.*flip.cache: frame \([0-9]*\),.*/\1/p' "$work/err")
for last in $((flipped - 1)) $flipped; do # frames before the damaged one were drawn completely
    name=$(printf frame_%04d.png "$last")
    if [ "$last" = "$flipped" ]; then none "$work/flip/$name"; else equal "$work/flip/$name" "$work/direct/$name"; fi
done
for to in flip.y4m sheet.png; do # but no incomplete video or sheet
    sheet=; [ $to = flip.y4m ] || sheet="--contact-sheet 4x3"
    # shellcheck disable=SC2086
    run 3 $scene -q --from-cache "$work/flip.cache" $sheet -o "$work/$to"; one_line; says "flip.cache: frame $flipped,"
    none "$work/$to"
done
# shellcheck disable=SC2086
"$program" $scene -q --from-cache "$work/flip.cache" -o - >"$work/flip.stream" 2>"$work/err"
cat "$work"/flip/frame_*.png >"$work/flip.files"; equal "$work/flip.files" "$work/flip.stream"
if cmp -s "$work/whole6/frame_0006.png" "$work/direct/frame_0006.png"; then good; else bad "frame 6 differs"; fi

claim "a file that is no cache stays as it is, and a full disk is said as such, in a cache and in USD"
cp "$hair" "$work/own.tfx"
run 1 "$hair" -q --frames 2 --cache "$work/own.tfx"; one_line; says "is not a cache"
if cmp -s "$hair" "$work/own.tfx"; then good; else bad "the file was changed"; fi
for out in --cache --export; do # a limit of the file size imitates a full disk
    # shellcheck disable=SC2086
    (ulimit -f 20; "$program" "$hair" $plain -q --frames 9 $out "$work/full.usda" 2>"$work/err") && bad "$out reports success"
    one_line; says "cannot write: File too large"
    rm -f "$work"/full.usda*
done

claim "a run that was stopped goes on where it was, and only what is missing or broken is drawn"
# shellcheck disable=SC2086
{
run 0 $scene -q --last 4 --cache "$work/r.cache" -o "$work/res/"
is_file "$work/r.cache.state"
run 0 $scene --resume --cache "$work/r.cache" -o "$work/res/"; says "5 of 12 frames are already written"; says "7 frames in"
if cmp -s "$work/a.cache" "$work/r.cache"; then good; else bad "the resumed cache differs"; fi
rm "$work/res/frame_0003.png"
head -c 900 "$work/direct/frame_0009.png" >"$work/res/frame_0009.png"
run 0 $scene --resume --from-cache "$work/a.cache" -o "$work/res/"; says "10 of 12"; says "2 frames in"
if diff -r "$work/direct" "$work/res" >"$work/err"; then good; else bad "resumed pictures differ"; fi
rm "$work/res/frame_0011.png"
run 0 $scene --resume -o "$work/res/"; says "1 frame in"
if diff -r "$work/direct" "$work/res" >"$work/err"; then good; else bad "pictures drawn again differ"; fi
head -c $size "$work/a.cache" >"$work/r.cache" # without a state it starts from frame 0
run 0 $scene --resume --cache "$work/r.cache"; says "simulating again from the start"
if cmp -s "$work/a.cache" "$work/r.cache"; then good; else bad "the cache made again differs"; fi
echo old >"$work/r.cache.state" # a run that was killed after completing its cache may leave a state
run 0 $scene -q --resume --cache "$work/r.cache"; none "$work/r.cache.state"
run 3 $scene -q --resume --cache "$work/r.cache" --gravity 0,-1,0; one_line; says "gravity"
run 2 $scene -q --resume -o "$work/v.mp4"; one_line; says "--cache"
"$program" assets/demo.json $plain --preroll 0 --frames 5000 --cache "$work/i.cache" >"$work/out" 2>"$work/err" &
pid=$!
while [ ! -s "$work/i.cache" ] && kill -0 $pid 2>/dev/null; do sleep 0.05; done
sleep 0.3; kill -INT $pid
wait $pid
status=$?
}
if [ $status = 130 ]; then good; else bad "exit status $status, expected 130"; fi
is_file "$work/i.cache.state"

claim "each frame as a hair file, which reads back"
# shellcheck disable=SC2086
run 0 $hair $plain --frames 3 --size 32x24 -q --export "$work/hair/fur_%03d.tfx" -o "$work/hair/"
run 0 --check "$work/hair/fur_002.tfx"; says "TressFX 4"
run 0 assets/curls.tfx assets/demo.tfx --frames 1 -q --export "$work/hair/both.hair"
run 0 --check "$work/hair/both.hair"
run 2 $hair --frames 3 -q --export "$work/hair/one.tfx"; one_line
run 0 assets/curls.tfx assets/demo.tfx --frames 3 --export "$work/hair/x.usda" --cache "$work/hair/cache"
run 0 assets/curls.tfx assets/demo.tfx --frames 3 -q --export "$work/hair/y.usda" --from-cache "$work/hair/cache"
if cmp -s "$work/hair/x.usda" "$work/hair/y.usda"; then good; else bad "the USD file from a cache differs"; fi
run 0 $hair --frames 2 --export "$work/hair/x_%d.obj"; says "--export: Wavefront lines files leave out: texture coordinates of strands"
run 0 --check --unit m "$work/hair/x_1.obj"; says "Wavefront lines"
run 2 $hair --frames 3 -q --resume --export "$work/hair/x.usda"; says "written in one piece"; one_line
run 2 $hair --frames 3 -q --export "$work/hair/"; one_line

claim "--resume keeps only frames of this very scene, whatever their form, and says which it writes again and why"
# go TEXT ARGUMENT...: runs with --resume and without --quiet; the output must contain TEXT.
go() {
    text=$1; shift
    # shellcheck disable=SC2086
    run 0 "$work/own.tfx" $plain --scalp none --algo none --size 32x24 --resume $to "$work/again/$name" "$@"
    says "$text"
}
for name in f_%d.png f_%d.exr f_%d.pfm f_%d.tfx; do
    to=-o; [ $name != f_%d.tfx ] || to=--export
    first=$work/again/f_0${name#f_%d}
    cp $hair "$work/own.tfx"
    go "2 frames in" --frames 2
    cp "$first" "$work/first"
    go "2 of 2 frames are already written" --frames 2 --stats "$work/again.json" --verbose
    go "1 of 1 frames are already written" --frames 2 --first 1 --part 1/2
    go "2 of 3 frames are already written" --frames 3
    go "3 existing files will be written again: $first: was made with other parameters or input files" --frames 3 --color red
    go "3 of 3 frames are already written" --frames 3 --color red
    cp assets/fall.tfx "$work/own.tfx"
    go "3 existing files will be written again" --frames 3 --color red
    cp $hair "$work/own.tfx"
    go "3 existing files will be written again" --frames 3
    equal "$first" "$work/first"
    head -c 300 "$work/first" >"$first"
    go "1 existing file will be written again: $first:" --frames 3
    equal "$first" "$work/first"
    # A later frame, with all frames before it unchanged.
    second=$work/again/f_1${name#f_%d}
    cp "$second" "$work/second"
    head -c 300 "$work/first" >"$second"
    go "1 existing file will be written again: $second:" --frames 3; says "2 of 3 frames are already written"; equal "$second" "$work/second"
    go "1 existing file will be written again: $second: was made with other parameters or input files" --first 1 --last 1 --frames 3 --color red
    go "1 existing file will be written again: $second: was made with other parameters or input files" --frames 3; equal "$second" "$work/second"
    go "3 of 3 frames are already written" --frames 3
done
name=t_%d.png; to=-o
go "2 frames in" --frames 2 --background transparent
go "2 of 2 frames are already written" --frames 2 --background transparent
go "2 existing files will be written again" --frames 2
name=c_%d.png; to=-o
go "2 frames in" --frames 2 --aov coverage --background transparent
go "2 of 2 frames are already written" --frames 2 --aov coverage --background transparent
name=x_%d.pfm; to=-o
go "2 frames in" --frames 2
mv "$work/again/x_.pfm.scenes" "$work/lines"
# shellcheck disable=SC2086
run 0 "$work/own.tfx" $plain --scalp none --algo none --size 32x24 --frames 2 -q -o "$work/again/y_%d.pfm" --export "$work/again/y_%d.tfx"
if ls "$work"/again/y_*.scenes >/dev/null 2>&1; then bad "a record without --resume"; else good; fi
go "there is no record of how it was rendered" --frames 2
(cat "$work/lines"; printf '0 no\n7\n99999999999 0123456789abcdef 01234567\n-1 0 0\n%s' "$(head -c 20 "$work/lines")") >"$work/again/x_.pfm.scenes"
go "2 of 2 frames are already written" --frames 2
run 2 $hair -q -o "$work/again/x_%d.pfm" --stats "$work/again/x_.pfm.scenes"; one_line; says "--output's record"

finish
