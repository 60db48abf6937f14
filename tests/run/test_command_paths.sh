#!/bin/sh
# SPDX-License-Identifier: MIT
# Where tractrix-render may write: never over its inputs, never two outputs to one file, and from a scene file only to
# the scene file's own folder.
. tests/support/claims.sh
program=$bin/tractrix-render
small="--look plain --followers 0 --algo none --frames 1 --size 32x24 -q"
checkout=$PWD
cp assets/fur.tfx "$work/own.tfx"
cp assets/ball.obj "$work/ball.obj"
mkdir "$work/scene" "$work/elsewhere"

# scene KEYS: a scene file with hair and these members.
scene() { printf '{"sections": [{"file": "%s/assets/fur.tfx"}], %s}\n' "$checkout" "$1" >"$work/scene/own.json"; }

# refuses WORD...: the error is a single line that contains all words.
refuses() {
    one_line
    for word in "$@"; do says "$word"; done
}

claim "an output is never an input of the same run"
cp "$work/own.tfx" "$work/before"
# shellcheck disable=SC2086
{
run 2 "$work/own.tfx" $small --cache "$work/own.tfx"; refuses "--cache" "the hair file"
ln -s own.tfx "$work/link.tfx"; ln "$work/own.tfx" "$work/hard.tfx"
run 2 "$work/own.tfx" $small --export "$work/link.tfx"; refuses "--export" "the hair file"
run 2 "$work/own.tfx" $small -o "$work/x.png" --stats "$work/hard.tfx"; refuses "--stats" "the hair file"
run 2 "$work/own.tfx" $small --mesh "$work/ball.obj" --export "$work/./ball.obj"; refuses "--export" "--mesh"
scene '"frames": 1'
cp "$work/scene/own.json" "$work/own.json"
run 2 "$work/scene/own.json" $small -o "$work/x.png" --stats "$work/scene/own.json"; refuses "--stats" "the scene file"
}
equal "$work/own.tfx" "$work/before"
equal "$work/scene/own.json" "$work/own.json"
equal "$work/ball.obj" assets/ball.obj

claim "two outputs of a run are two files"
# shellcheck disable=SC2086
{
run 2 assets/fur.tfx $small --cache "$work/e.usda" --export "$work/e.usda"; refuses "--cache" "--export"
run 2 assets/fur.tfx $small -o "$work/e_%d.png" --stats "$work/e_0.png"; refuses "--output" "--stats"
run 2 assets/fur.tfx $small -o "$work/new/" --stats "$work/new/frame_0000.png"; refuses "--output" "--stats"
run 2 assets/fur.tfx $small --cache "$work/c" --stats "$work/c.state"; refuses "--cache's state" "--stats"
}
for file in e.usda e_0.png new c c.state; do none "$work/$file"; done

claim "folders that are missing are made, and a place that takes no files is told before a frame is drawn"
# shellcheck disable=SC2086
{
run 0 assets/fur.tfx $small -o "$work/made.png" --stats "$work/deep/er/x.json"; is_file "$work/deep/er/x.json"
run 1 assets/fur.tfx $small -o "$work/first.png" --stats "$work/own.tfx/x.json"; refuses "--stats" "Not a directory"
}
none "$work/first.png"

claim "a scene file writes into its own folder only, unless the command line says otherwise"
ln -s ../elsewhere "$work/scene/away"
for key in '"output": "../elsewhere/"' '"output": "away/x.png"' '"export": "new/../../elsewhere/x.usda"' \
    '"cache": "'"$work"'/elsewhere/x.cache"' '"output": "in/", "stats": "../elsewhere/x.json"'; do
    scene "$key"
    # shellcheck disable=SC2086
    run 3 "$work/scene/own.json" $small; refuses "outside the scene file's folder" "--allow-paths"
done
no_files "$work/elsewhere"
# shellcheck disable=SC2086
{
scene '"output": "in/", "stats": "in/x.json"'
run 0 "$work/scene/own.json" $small; is_png "$work/scene/in/frame_0000.png"; is_file "$work/scene/in/x.json"
(cd "$work/scene" && rm -r in && "$(cd "$checkout" && realpath "$program")" own.json $small); is_file "$work/scene/in/x.json"
scene '"output": "../elsewhere/"'
run 0 "$work/scene/own.json" $small --allow-paths; is_png "$work/elsewhere/frame_0000.png"
run 0 "$work/scene/own.json" $small -o "$work/elsewhere/y.png"; is_png "$work/elsewhere/y.png"
scene '"output": "../elsewhere/", "allow_paths": true'
run 3 "$work/scene/own.json" $small; refuses "allow_paths" "on the command line only"
}

claim "a scene file reads any file, but no device or pipe, which may never end"
mkfifo "$work/scene/pipe"
for key in '"mesh": "/dev/zero"' '"mesh": "pipe"' '"color_map": "/dev/zero"' '"from_cache": "pipe"'; do
    scene "$key"
    # shellcheck disable=SC2086
    run 3 "$work/scene/own.json" $small -o "$work/x.png"; refuses "is a device or pipe"
done
printf '{"sections": [{"file": "pipe"}]}\n' >"$work/scene/own.json"
# shellcheck disable=SC2086
run 3 "$work/scene/own.json" $small -o "$work/x.png"; refuses "is a device or pipe"
scene '"mesh": "m_%d.obj"'
cp assets/ball.obj "$work/scene/m_0.obj"; mkfifo "$work/scene/m_1.obj"
# shellcheck disable=SC2086
run 3 "$work/scene/own.json" $small -o "$work/x.png"; refuses "m_1.obj: is a device or pipe"
# Such files of /proc are plain and empty, but a read of one may wait for ever. Only root may try.
if [ -r /proc/kmsg ]; then
    scene '"color_map": "/proc/kmsg"'
    # shellcheck disable=SC2086
    run 3 "$work/scene/own.json" $small -o "$work/x.png"; refuses "/proc/kmsg: "
fi

claim "the command line may name a pipe for hair, but not in the place of a frame"
mkfifo "$work/hair"; cat assets/fur.tfx >"$work/hair" &
# shellcheck disable=SC2086
run 0 "$work/hair" $small -o "$work/x.png"
mkdir "$work/frames"; mkfifo "$work/frames/frame_0000.png"
# shellcheck disable=SC2086
run 1 assets/fur.tfx $small --resume -o "$work/frames/"; refuses "is a device or a pipe"
mkfifo "$work/x.pipe.png"
# shellcheck disable=SC2086
"$program" assets/fur.tfx $small --resume -o "$work/x.pipe.png" & cat "$work/x.pipe.png" >"$work/piped.png"
wait $!; is_png "$work/piped.png"

claim "the cache of distance fields is neither read nor written through pipes and links"
# shellcheck disable=SC2317 # called by holds
collides() { XDG_CACHE_HOME=$work/cache "$program" assets/fur.tfx --mesh assets/ball.obj --look plain --followers 0 --frames 1 --size 32x24 -q -o "$work/x.png"; }
holds collides
field=$(echo "$work"/cache/tractrix/*.field)
is_file "$field"
rm "$field"; mkfifo "$field"
holds collides; holds test -p "$field"
echo precious >"$work/victim"
rm "$field"; ln -s "$work/victim" "$field"
holds collides; in_file "$work/victim" precious
rm "$field"; ln -s "$work/none" "$field"
holds collides; none "$work/none"

finish
