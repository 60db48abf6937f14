#!/bin/sh
# SPDX-License-Identifier: MIT
# The page of tractrix-compare --html: first the content of the file, then the actions of a reader, in a headless
# Chromium.
. tests/support/claims.sh
. tests/support/browser.sh
bin=$(realpath "$bin")
program=$bin/tractrix-compare
root=$PWD
golden=$root/tests/golden

# be32 NUMBER: prints four bytes, the most significant first.
be32() { env printf "$(printf '%08x' "$1" | sed 's/../\\x&/g')"; }
# add_text IN OUT KEY TEXT: a PNG file with an additional text chunk before its pixels. If a key occurs twice, the last
# applies.
add_text() {
    printf 'tEXt%s\0%s' "$3" "$4" >"$work/chunk"
    crc=$(gzip -c "$work/chunk" | tail -c 8 | od -An -N4 -tu4)
    at=$(($(grep -obUaF IDAT "$1" | head -n 1 | cut -d: -f1) - 4))
    { head -c $at "$1" && be32 $(($(wc -c <"$work/chunk") - 4)) && cat "$work/chunk" && be32 "$crc" && tail -c +$((at + 1)) "$1"; } >"$2"
}
# add_pfm FILE BYTES: a picture of 4 x 1 pixels; BYTES are the first pixel, the others are black.
add_pfm() { { printf 'PF\n4 1\n-1\n' && env printf "$2" && head -c 36 /dev/zero; } >"$1"; }
# count PATTERN: the number of times that it occurs in the page.
count() { grep -oF -- "$1" "$work/report.html" | wc -l; }
# counts NUMBER PATTERN
counts() { if [ "$(count "$2")" = "$1" ]; then good; else bad "'$2' stands $(count "$2") times, expected $1"; fi; }

mkdir "$work/a" "$work/b"
add_text "$golden"/curls_still.png "$work/a/differ.png" Comment 'Old <card>'
add_text "$golden"/curls_split.png "$work/b/differ.png" Comment 'New </script>'
cp "$golden"/curls_still.png "$work/a/size.png" && cp "$golden"/fur_transparent.png "$work/b/size.png"
cp "$golden"/fur_grid.png "$work/a/gone.png" && cp "$golden"/curls_tips.png "$work/b/new.png"
cp "$golden"/curls_floor.png "$work/a/cut.png" && head -c 3000 "$golden"/curls_floor.png >"$work/b/cut.png"
for side in a b; do cp "$golden"/fur_grid.png "$work/$side/same.png" && cp "$golden"/curls_studio.png "$work/$side/<b>&amp; it's.png"; done
add_pfm "$work/a/float.pfm" '\0\0\0\x3f\0\0\0\x40\0\0\x80\x39'
add_pfm "$work/b/float.pfm" '\0\0\0\x3f\0\0\0\x40\0\0\0\0'
cd "$work" || exit 1

claim "the page is written beside everything else"
run 3 a b --pixel-tolerance 8 --max-failing-pixels 2% --html report.html; says "8 images: 2 same, 1 within limits"; is_file report.html
cp report.html first.html
run 3 a b --pixel-tolerance 8 --max-failing-pixels 2% --html report.html -q -j 1
sed 's/ -q -j 1//' report.html >second.html; equal first.html second.html

claim "it names nothing elsewhere, and its policy allows nothing"
counts 0 "http://"; counts 0 "https://"; counts 0 "@import"; counts 1 "default-src 'none'"; counts 0 "unsafe"

claim "no text of the data can end its block"
counts 0 "New </script>"; counts 1 'New \u003c/script>'; counts 0 "<b>&amp;"

claim "equal images stand once"
# 13: differ 2 and its map, size 2, gone, new, the reference of cut, float 2 and its map, and one image for each equal
# pair
counts 13 '<script type="text/plain" id="image-'

claim "equal images and thumbnails are JPEG, what differs is not, heat maps have palettes"
counts 2 '"lossy":true'; counts 2 '>/9j/'; counts 8 '"thumbnail":"'; counts 7 '"thumbnail":"/9j/'; counts 2 'CAMAAA'

claim "commands are quoted"
in_file report.html '"accept":"tractrix-compare --update -- a/differ.png b/differ.png"'
mkdir one two && cp a/differ.png "one/it's \$HOME.png" && cp b/differ.png "two/it's \$HOME.png"
run 1 one two --html report.html
accept=$(sed -n 's/.*"accept":"\([^"]*\)".*/\1/p' report.html | sed 's/\\\\/\\/g')
(PATH=$(dirname "$program"):$PATH && eval "$accept") >out 2>err; run 0 one two

claim "--update shows what was there before"
cp a/differ.png one/x.png; cp b/differ.png two/x.png
run 0 one two --update --html report.html; counts 1 '"updated":true'; counts 4 'id="image-'

claim "--only-failures leaves out what is the same"
run 3 a b --pixel-tolerance 8 --max-failing-pixels 2% --only-failures --html report.html
counts 0 same.png; counts 1 '"images":8'; counts 5 '"outcome":'
run 0 a/same.png b/same.png --only-failures --html report.html; counts 1 '"pairs":[]'
cp report.html nothing.html

claim "texts of EXR files are shown"
if "$bin/tractrix-render" "$root/assets/curls.tfx" --algo none --look plain --followers 0 --size 32x24 -q -o one.exr; then
    run 0 one.exr one.exr --html report.html; counts 2 '["Software","tractrix '; counts 2 '"depth":"float"'; counts 1 'id="image-'
else skip "no image of floats: no driver"; fi

claim "a page that cannot be written is named, and none is left"
run 1 a b --html /proc/none/report.html; says /proc/none; one_line
run 1 a b --html /dev/full -q; says /dev/full; one_line
mkdir left && run 2 a b/same.png --html left/report.html; no_files left

run 3 a b --pixel-tolerance 8 --max-failing-pixels 2% --html report.html

cd "$root" || exit 1
claim "in a browser"
if [ -z "$browser" ]; then skip "no chromium here" && finish; fi
drive "$work/report.html" tests/compare/html_report.js
claim "in a narrow window"
sed 's/await drive\(List\|Modes\|Zoom\|Figures\)();//' tests/compare/html_report.js >"$work/narrow.js"
size=500,900 drive "$work/report.html" "$work/narrow.js"
claim "without a failure to show"
cat >"$work/nothing.js" <<'END'
claim("it says so", document.querySelector("main").textContent.includes("there is none") && byId("verdict").textContent === "The image is within the limits");
press("j");
press("?");
claim("keys do no harm", byId("help").open);
finish();
END
drive "$work/nothing.html" "$work/nothing.js"
claim "a script that is not the page's own does not run"
{ cat "$work/report.html" && echo '<script>document.title = "foreign"</script>'; } >"$work/foreign.html"
dump "$work/foreign.html"
if grep -q '<title>5 bad: tractrix-compare</title>' "$work/dump"; then good; else bad "$(grep -o '<title>.*</title>' "$work/dump")"; fi
finish
