#!/bin/sh
# SPDX-License-Identifier: MIT
# Links, missing folders and places that cannot hold files, in all five programs: nothing is overwritten that is an
# input or that a scene file may not touch, and unwritable outputs are reported before the work begins.
. tests/support/claims.sh
checkout=$PWD
small="--look plain --followers 0 --algo none --frames 3 --size 32x24 -q"
"$bin/tractrix-gen" --kind straight --count 20 --vertices 8 -q -o "$work/h.tfx"
cp "$work/h.tfx" "$work/before"
echo victim >"$work/victim"; cp "$work/victim" "$work/victim.before"

# refuses WORD...: the error is a single line that contains all words.
refuses() {
    one_line
    for word in "$@"; do says "$word"; done
}
safe() { equal "$work/victim" "$work/victim.before"; equal "$work/h.tfx" "$work/before"; }
# scene KEYS: sc/own.json with hair and these members.
scene() { printf '{"sections": [{"file": "%s/assets/fur.tfx"}], %s}\n' "$checkout" "$1" >"$work/sc/own.json"; }

program=$bin/tractrix-render
claim "outputs of a scene file follow no links: single, numbered, records, caches and folders"
mkdir -p "$work/sc/f" "$work/sc/in" "$work/away"
ln -s ../../victim "$work/sc/f/frame_0001.png"
ln -s ../victim "$work/sc/p_.pfm.scenes"; ln -s ../victim "$work/sc/x_.tfx.scenes"; ln -s ../victim "$work/sc/c"; ln -s ../victim "$work/sc/d.state"
ln -s ../victim "$work/sc/s.json"; ln -s ../nowhere "$work/sc/n.json"; ln -s ../away "$work/sc/out"; ln -s in "$work/sc/same"
# shellcheck disable=SC2086
for keys in '"output": "f/"' '"output": "p_%d.pfm"' '"export": "x_%d.tfx"' '"cache": "c"' '"cache": "d"' '"output": "in/", "stats": "s.json"' '"output": "in/", "stats": "n.json"' \
    '"output": "out/"' '"output": "out/new/a_%d.png"' '"output": "same/../../a.png"'; do
    scene "$keys"
    run 3 "$work/sc/own.json" $small; one_line; safe
done
none "$work/nowhere"; no_files "$work/away"
# shellcheck disable=SC2086
{
scene '"output": "same/", "stats": "same/s.json"'
run 0 "$work/sc/own.json" $small; is_png "$work/sc/in/frame_0002.png"; is_file "$work/sc/in/s.json"
scene '"output": "f/"'
run 0 "$work/sc/own.json" $small --allow-paths
}
if [ -L "$work/sc/f/frame_0001.png" ]; then good; else bad "the link was replaced"; fi
is_png "$work/victim"; cp "$work/victim.before" "$work/victim"

claim "links among numbered outputs do not lead to inputs, nor to other outputs"
mkdir "$work/d" "$work/e"
ln -s ../h.tfx "$work/d/x_2.tfx"
# shellcheck disable=SC2086
{
run 2 "$work/h.tfx" $small --export "$work/d/x_%d.tfx"; refuses "--export" "would overwrite the hair file"; none "$work/d/x_0.tfx"; safe
"$program" "$work/h.tfx" $small --cache "$work/e.cache"
ln -s ../e.cache "$work/e/y_1.png"
run 2 "$work/h.tfx" $small --cache "$work/e.cache" -o "$work/e/y_%d.png"; refuses "--cache" "--output"
ln -s y_2.pfm "$work/e/y_0.pfm"
run 2 "$work/h.tfx" $small -o "$work/e/y_%d.pfm"; refuses "y_2.pfm" "another name"
ln -s ../victim "$work/e/z_1.png"
run 0 "$work/h.tfx" $small -o "$work/e/z_%d.png" # outputs on the command line: links are followed as usual
}
is_png "$work/victim"; cp "$work/victim.before" "$work/victim"

claim "a link that appears while frames are drawn is looked at when its frame is written"
scene '"output": "late/frame_%d.png"'
cat >"$work/sc/swap" <<'END'
while ! [ -e late/frame_0.png ]; do sleep 0.02; done
ln -sf ../../victim late/frame_199.png
END
(cd "$work/sc" && sh swap) &
# shellcheck disable=SC2086
run 3 "$work/sc/own.json" --look plain --followers 0 --algo none --frames 200 --size 32x24 -q; refuses "frame_199.png" "is a symbolic link"
wait; safe

# A write to a pipe without a reader would wait for ever.
claim "outputs of a scene file do not go to pipes"
scene '"output": "piped/frame_%d.png"'
mkdir "$work/sc/piped"; mkfifo "$work/sc/piped/frame_1.png"
# shellcheck disable=SC2086
run 3 "$work/sc/own.json" $small; refuses "frame_1.png" "is a device or a pipe"
scene '"stats": "piped/frame_1.png"'
# shellcheck disable=SC2086
run 3 "$work/sc/own.json" $small -o "$work/t/"; refuses "frame_1.png" "is a device or a pipe"

claim "a folder that is missing and .. behind it lead back"
# shellcheck disable=SC2086
{
run 2 "$work/h.tfx" $small -o "$work/t/" --stats "$work/new/../h.tfx"; refuses "--stats" "the hair file"; none "$work/new"; safe
run 0 "$work/h.tfx" $small -o "$work/t/" --stats "$work/new/../s.json"; is_file "$work/s.json"; none "$work/new"
}
program=$bin/tractrix-convert
run 2 "$work/h.tfx" --resample 5 -o "$work/new/../h.tfx"; refuses "-o" "the input"; none "$work/new"; safe
run 2 "$work/h.tfx" --resample 5 -o "$work/a/b/../../h.tfx"; refuses "-o" "the input"; safe

program=$(realpath "$bin/tractrix-compare")
claim "tractrix-compare never writes over what it compares"
mkdir "$work/ref" "$work/new"
for n in 1 2; do
    "$bin/tractrix-render" "$work/h.tfx" --look plain --algo none --followers 0 --frames 1 --size 16x16 -q -o "$work/ref/r_$n.png"
    "$bin/tractrix-render" "$work/h.tfx" --look plain --algo none --followers 0 --frames 1 --size 16x16 -q --background 1,0,0 -o "$work/new/r_$n.png"
done
cp -r "$work/ref" "$work/ref.before"; cp -r "$work/new" "$work/new.before"
whole() { holds diff -r "$work/ref" "$work/ref.before"; holds diff -r "$work/new" "$work/new.before"; }
for words in "ref/r_%d.png new/r_%d.png --heatmap ref" "ref/r_%d.png new/r_%d.png --sheet new" "ref new --heatmap ref/" "ref new --sheet ./new" \
    "ref new --html ref/r_1.png" "ref new --json new/r_2.png" "ref new --junit ref/../new/r_1.png" "ref/r_%d.png new/r_%d.png --html ref/r_1.png" \
    "ref new --heatmap d --sheet d" "ref/r_1.png new/r_1.png --heatmap new/r_1.png" "ref/r_1.png new/r_1.png --sheet ./ref/r_1.png" "ref new --json x --junit ./x"; do
    # shellcheck disable=SC2086
    (cd "$work" && exec "$program" $words) >"$work/out" 2>"$work/err" </dev/null
    status=$?
    if [ "$status" = 2 ]; then good; else bad "exit status $status, expected 2: $words"; fi
    one_line; whole
done
cd "$work/ref" || exit 1
holds test "$("$program" r_%d.png ../new/r_%d.png --sheet . >/dev/null 2>&1; echo $?)" = 2
cd "$checkout" || exit 1
whole
ln -s ../ref/r_2.png "$work/link.png"; ln -s ref/r_1.png "$work/to_reference.html"
run 2 "$work/ref" "$work/new" --html "$work/to_reference.html"; refuses "--html" "A's image"; whole
run 1 "$work/ref" "$work/new" --heatmap "$work/maps" --json "$work/maps/all.json" -q; is_png "$work/maps/r_1.png"; is_file "$work/maps/all.json"; whole
run 0 "$work/ref" "$work/new" --update -q; holds diff -r "$work/ref" "$work/new"

program=$bin/tractrix-gen
claim "tractrix-gen fur never writes over a map"
for flag in --density --length-map --comb; do
    cp "$work/ref/r_1.png" "$work/m.png"
    run 2 fur assets/ball.obj "$flag" "$work/m.png" --count 10 --format tfx4 -o "$work/m.png"; refuses "-o" "$flag"
    equal "$work/m.png" "$work/ref/r_1.png"
done

claim "a place that takes no files is told before the work, and nothing is left"
mkdir "$work/dir"
program=$bin/tractrix-render
# shellcheck disable=SC2086
for path in "$work/dir" "$work/dir/" "$work/victim/x.json"; do
    rm -rf "$work/early"
    run 1 "$work/h.tfx" $small -o "$work/early/" --stats "$path"; refuses "--stats" "cannot write"; none "$work/early"
done
program=$bin/tractrix-convert; run 1 "$work/h.tfx" -o "$work/early.usda" --json "$work/dir"; refuses "--json" "Is a directory"; none "$work/early.usda"
program=$bin/tractrix-compare; run 1 "$work/ref" "$work/new" --heatmap "$work/early" --json "$work/dir"; refuses "--json"; none "$work/early"
program=$bin/tractrix-gen; run 1 -o "$work/early.tfx" --mesh "$work/dir"; refuses "--mesh"; none "$work/early.tfx"
program=$bin/tractrix-bench
for flag in --csv --json --html; do run 1 speed --set 1k16 --steps 1 $flag "$work/dir"; refuses "$flag" "Is a directory"; silent out; done
program=$bin/tractrix-render
run 3 "$work/none.tfx" -o "$work/early/deep/" --stats "$work/early/other/s.json"; none "$work/early" # folders that were made are removed again

claim "a cache whose state has too long a name is told at once"
long=$(printf '%0250d' 0)
# shellcheck disable=SC2086
run 1 "$work/h.tfx" $small --cache "$work/$long"; refuses "--cache's state" "File name too long"; none "$work/$long"

finish
