#!/bin/sh
# SPDX-License-Identifier: MIT
# tractrix-compare for continuous integration: masks, JUnit, annotations, lists of failures.
# shellcheck disable=SC2016 # backticks of Markdown
. tests/support/claims.sh
program=$(realpath "$bin")/tractrix-compare
unset CI_PROJECT_DIR GITHUB_WORKSPACE GITHUB_STEP_SUMMARY JENKINS_URL
golden=tests/golden
a=$golden/curls_still.png b=$golden/curls_split.png

# picture FILE LEFT RIGHT [WIDTH]: a PFM of WIDTH x 30 pixels (default 40), in grey; its left half and its right half
# are white (1) or black.
picture() {
    width=${4:-40}
    {
        printf 'Pf\n%d 30\n-1.0\n' "$width"
        for _ in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29 30; do
            for color in "$2" "$3"; do
                i=0
                while [ $i -lt $((width / 2)) ]; do
                    case $color in white) printf '\0\0\200\077' ;; grey) printf '\0\0\0\077' ;; *) printf '\0\0\0\0' ;; esac
                    i=$((i + 1))
                done
            done
        done
    } >"$1"
}
number() { grep -oF -- "$1" "$2" | wc -l; }
# counts FILE TEXT N
counts() { if [ "$(number "$2" "$1")" = "$3" ]; then good; else bad "$1 has '$2' $(number "$2" "$1") times, expected $3"; fi; }
not_in() { if grep -qF -- "$2" "$1"; then bad "$1 has $2"; else good; fi; }

mkdir "$work/a" "$work/b"
picture "$work/a/f_1.pfm" grey grey; cp "$work/a/f_1.pfm" "$work/a/f_2.pfm"
cp "$work/a/f_1.pfm" "$work/b/f_1.pfm"; picture "$work/b/f_2.pfm" grey white
picture "$work/left.pfm" white black; picture "$work/right.pfm" black white
picture "$work/black.pfm" black black; picture "$work/white.pfm" white white; picture "$work/small.pfm" white black 20

claim "a mask hides what it covers, and nothing else"
run 1 "$work/a/f_2.pfm" "$work/b/f_2.pfm"; says "600 failing pixels (50 %)"
run 0 "$work/a/f_2.pfm" "$work/b/f_2.pfm" --mask "$work/left.pfm"
says "same: RMSE 0, PSNR inf dB, SSIM 1, FLIP 0 (at most 0)"; says "0 failing pixels (0 %), 600 pixels ignored"
run 1 "$work/a/f_2.pfm" "$work/b/f_2.pfm" --mask "$work/right.pfm"; says "600 failing pixels (100 %), 600 pixels ignored"
run 1 "$work/a/f_2.pfm" "$work/b/f_2.pfm" --mask "$work/white.pfm"; says "600 failing pixels (50 %)"; not_in "$work/out" ignored
# In the compared half, grey and white are constant, so the mean of FLIP equals its maximum.
run 1 "$work/a/f_2.pfm" "$work/b/f_2.pfm" --mask "$work/right.pfm" --json "$work/report.json"
in_file "$work/report.json" '"compared_pixels": 600'; in_file "$work/report.json" "\"mask\": \"$work/right.pfm\""

claim "a wrong mask is status 3, one line, and says what is wrong"
for jobs in 1 2; do
    run 3 -q "$work/a" "$work/b" -j $jobs --mask "$work/small.pfm"; one_line; says "small.pfm: a mask of 20 x 30 pixels: expected 40 x 30, the size of $work/a/f_1.pfm"
    run 3 -q "$work/a" "$work/b" -j $jobs --mask "$work/black.pfm"; one_line; says "black.pfm: the whole mask is black"
    run 3 -q "$work/a" "$work/b" -j $jobs --mask "$work/none.pfm"; one_line; says "none.pfm"
    run 3 -q "$work/a" "$work/b" -j $jobs --mask README.md; one_line; says "README.md"
done
mkdir "$work/masks"
run 3 "$work/a" "$work/b" --mask "$work/masks"; one_line; says "no masks: expected images"
run 3 "$work/a" "$work/b" --mask "$work/none/"; one_line; says "none"
run 2 "$work/a" "$work/b" --mask "$work/masks/m_%d.pfm"; one_line; says "expected a file or a folder"
run 3 "$work/a/f_%d.pfm" "$work/b/f_%d.pfm" --mask "$work/masks/m_%d.pfm"; one_line
cp "$work/small.pfm" "$work/masks/f_2.pfm"
run 3 "$work/a" "$work/b" --mask "$work/masks" --update; says "f_2.pfm: unreadable: $work/masks/f_2.pfm: a mask of 20 x 30"
not_in "$work/out" updated; says "2 images: 1 same, 1 unreadable"

claim "masks go by name or number, and each must have an image"
cp "$work/left.pfm" "$work/masks/f_2.pfm"
run 0 "$work/a" "$work/b" --mask "$work/masks/"; says "f_2.pfm: same"; says "2 images: 2 same"
run 0 "$work/a/f_%d.pfm" "$work/b/f_%d.pfm" --mask "$work/masks/f_%d.pfm"
run 0 "$work/a/f_2.pfm" "$work/b/f_2.pfm" --mask "$work/masks/"
run 0 "$work/a" "$work/b" --mask "$work/left.pfm"
cp "$work/left.pfm" "$work/masks/f_3.pfm"
run 3 "$work/a" "$work/b" --mask "$work/masks"; one_line; says "the mask f_3.pfm belongs to no image: expected a mask with the name of an image"
run 3 "$work/a/f_%d.pfm" "$work/b/f_%d.pfm" --mask "$work/masks/f_%d.pfm"; one_line; says "the mask f_3.pfm belongs to no image: expected a mask with the number of an image"
mv "$work/masks/f_3.pfm" "$work/masks/f_2.PNG"
run 3 "$work/a" "$work/b" --mask "$work/masks"; one_line; says "two masks for f_2.pfm"

claim "heat map and sheet show what a mask ignores"
run 1 "$work/a/f_2.pfm" "$work/b/f_2.pfm" --heatmap "$work/plain.png" --sheet "$work/plain_sheet.png"
run 1 "$work/a/f_2.pfm" "$work/b/f_2.pfm" --mask "$work/right.pfm" --heatmap "$work/masked.png" --sheet "$work/masked_sheet.png"
is_png "$work/masked.png"
# With a mask, only the ignored half differs: it was black and now has stripes of grey 96 and 144.
run 1 "$work/plain.png" "$work/masked.png" --mask "$work/left.pfm" --pixel-tolerance 96; says "largest difference 144"
run 1 "$work/plain_sheet.png" "$work/masked_sheet.png"; says "largest difference 144 at (92, 0)"

claim "--only-failures lists what is bad and counts all"
run 1 "$work/a" "$work/b" --only-failures --json "$work/report.json" --junit "$work/report.xml"
counts "$work/out" "f_1.pfm" 0; says "f_2.pfm: different"; says "2 images: 1 same, 1 different"
counts "$work/report.json" '"name"' 1; in_file "$work/report.json" '"images": 2'; in_file "$work/report.json" '"same": 1'
counts "$work/report.xml" '<testcase' 1; in_file "$work/report.xml" 'tests="1" failures="1"'
run 0 "$work/a" "$work/a" --only-failures; if [ "$(wc -l <"$work/out")" = 1 ]; then good; else bad "more than the closing line"; fi

claim "JUnit has times and attachments, relative to the checkout"
cp $b "$work/b/g<&>.png"; cp $a "$work/a/g<&>.png"
run 1 "$work/a" "$work/b" --junit "$work/report.xml" --sheet "$work/sheets" --heatmap "$work/heats"
if command -v xmllint >/dev/null; then holds xmllint --noout "$work/report.xml"; else skip "no xmllint"; fi
in_file "$work/report.xml" 'tests="3" failures="2" errors="0" skipped="0" time="'
in_file "$work/report.xml" 'name="g&lt;&amp;&gt;.png"'; not_in "$work/report.xml" hostname
if [ "$(grep -cE '<test(case|suites?) .* time="[0-9]+\.[0-9]{3}"' "$work/report.xml")" = 5 ]; then good; else bad "not a time for each case and suite"; fi
if grep -qE 'timestamp="20[0-9]{2}-[01][0-9]-[0-3][0-9]T[0-2][0-9]:[0-5][0-9]:[0-6][0-9]"' "$work/report.xml"; then good; else bad "no timestamp"; fi
counts "$work/report.xml" '[[ATTACHMENT|' 8
real=$(realpath "$work")
in_file "$work/report.xml" "[[ATTACHMENT|$real/sheets/f_2.pfm.png]]"
for variable in CI_PROJECT_DIR GITHUB_WORKSPACE; do
    env "$variable=$work" "$program" "$work/a" "$work/b" -q --junit "$work/report.xml" --sheet "$work/./sheets/" --heatmap "$work/heats"
    for path in sheets/f_2.pfm.png heats/f_2.pfm.png b/f_2.pfm a/f_2.pfm; do in_file "$work/report.xml" "[[ATTACHMENT|$path]]"; done
done
in_file "$work/report.xml" 'file="a/f_1.pfm"'
(cd "$work" && "$program" a b -q --junit report.xml)
in_file "$work/report.xml" "[[ATTACHMENT|b/f_2.pfm]]"; counts "$work/report.xml" '[[ATTACHMENT|' 4
JENKINS_URL=x CI_PROJECT_DIR=$work "$program" "$work/a" "$work/b" -q --junit "$work/report.xml"
in_file "$work/report.xml" "[[ATTACHMENT|$real/b/f_2.pfm]]"
rm "$work/a/g<&>.png" "$work/b/g<&>.png"

claim "JUnit stays XML whatever bytes a name has"
odd=$(printf 'h\001i\033\tj\nk\177.pfm')
mkdir "$work/p" "$work/q"
cp "$work/a/f_2.pfm" "$work/p/$odd"; cp "$work/b/f_2.pfm" "$work/q/$odd"
cp "$work/a/f_2.pfm" "$work/p/$(printf '\377.pfm')"
run 1 "$work/p" "$work/q" --junit "$work/report.xml"
if command -v xmllint >/dev/null; then holds xmllint --noout "$work/report.xml"; else skip "no xmllint"; fi
in_file "$work/report.xml" 'name="h?i??j?k'; in_file "$work/report.xml" 'name="?.pfm"'
rm -r "$work/p" "$work/q"

claim "--github prints escaped annotations and appends a summary"
GITHUB_WORKSPACE=$work GITHUB_STEP_SUMMARY=$work/summary.md
export GITHUB_WORKSPACE GITHUB_STEP_SUMMARY
run 0 "$work/a" "$work/a" --github; counts "$work/out" "::" 0; in_file "$work/summary.md" "### Images: 0 of 2 failed"
odd=$(printf 'o,d:d 100%%\r\nx|`\033[2J\302\2330\342\200\256.pfm')
cp "$work/a/f_2.pfm" "$work/a/$odd"; cp "$work/b/f_2.pfm" "$work/b/$odd"
run 1 -q "$work/a" "$work/b" --github --max-failing-pixels 1%
says '::error file=a/f_2.pfm,title=f_2.pfm%3A different::RMSE 47.72'
# Only %, CR and LF are escaped in the message.
unseen='\x1b[2J\xc2\x9b0\xe2\x80\xae'
says '::error file=a/o%2Cd%3Ad 100%25%0D%0Ax|`'"$unseen.pfm"',title=o%2Cd%3Ad 100%25%0D%0Ax|`'"$unseen.pfm"'%3A different::RMSE 47.72'
says 'failing pixels (50 %25)'
counts "$work/out" "::error" 2; if [ "$(wc -l <"$work/out")" = 2 ]; then good; else bad "more than two lines"; fi
in_file "$work/summary.md" "### Images: 2 of 3 failed"; in_file "$work/summary.md" "Limits: pixel tolerance 0, failing pixels 1 %."
in_file "$work/summary.md" '| `f_2.pfm` | different |'; in_file "$work/summary.md" ' | 600 (50 %) | '; in_file "$work/summary.md" "| \`o,d:d 100%\\x0d\\x0ax\\|'$unseen.pfm\` | different |"
rm "$work/a/$odd" "$work/b/$odd"
cp "$work/b/f_2.pfm" "$work/b/unknown.pfm" # its reference is not there, but has a place in the checkout
run 1 -q "$work/a" "$work/b" --github; says '::error file=a/unknown.pfm,title=unknown.pfm%3A new::'
rm "$work/b/unknown.pfm"
GITHUB_STEP_SUMMARY=$work/summary.md/none
run 1 -q "$work/a" "$work/b" --github; one_line; says "summary.md/none: cannot write"
unset GITHUB_STEP_SUMMARY
run 1 -q "$work/a" "$work/b" --github; silent err
mkdir "$work/c" "$work/d"
for i in 1 2 3 4 5 6 7 8 9 10; do cp "$work/a/f_2.pfm" "$work/c/$i.pfm"; cp "$work/b/f_2.pfm" "$work/d/$i.pfm"; done
run 1 -q "$work/c" "$work/d" --github; counts "$work/out" "::error file=" 10
cp "$work/a/f_2.pfm" "$work/c/11.pfm"
run 1 -q "$work/c" "$work/d" --github; counts "$work/out" "::error file=" 9; says "::error title=tractrix-compare::2 more images failed: see the summary"
mkdir "$work/many" "$work/others"
for i in $(seq 1003); do
    printf 'Pf\n1 1\n-1.0\n\0\0\0\0' >"$work/many/$i.pfm"
    printf 'Pf\n1 1\n-1.0\n\0\0\0\077' >"$work/others/$i.pfm"
done
rm "$work/summary.md"
GITHUB_STEP_SUMMARY=$work/summary.md run 1 -q "$work/many" "$work/others" --github
counts "$work/summary.md" '.pfm` | different |' 1000; holds grep -qx "3 more images are not listed." "$work/summary.md"
unset GITHUB_WORKSPACE

claim "--unrendered puts images that could not be made into the reports"
rm "$work/b/f_2.pfm"
printf 'f_2.pfm: no hair: expected some\nnew_%%02d.png: the disk is full\n' >"$work/lines"
run 1 "$work/a" "$work/b" --unrendered "$work/lines" --junit "$work/report.xml"
says "f_2.pfm: unrendered: no hair: expected some"; says "new_%02d.png: unrendered: the disk is full"; says "3 images: 1 same, 2 unrendered"
in_file "$work/report.xml" '<error type="unrendered" message="the disk is full">'; in_file "$work/report.xml" 'failures="0" errors="2"'
printf 'f_%%d.pfm: cut off\n' >"$work/lines"
run 1 "$work/a" "$work/b" --unrendered "$work/lines" --update; says "f_1.pfm: same"; says "f_2.pfm: unrendered: cut off"; says "2 images: 1 same, 1 unrendered"
run 1 "$work/masks/none" "$work/b" --unrendered "$work/lines" --update; says "2 images: 1 new, 1 unrendered; 1 reference updated"
printf 'a%%%%b%%.png: odd\n' >"$work/lines"
run 1 "$work/a" "$work/b" --unrendered "$work/lines"; says "a%%b%.png: unrendered: odd"; says "f_2.pfm: missing"
printf 'nothing\n' >"$work/lines"
run 3 "$work/a" "$work/b" --unrendered "$work/lines"; one_line; says "got 'nothing', expected NAME: REASON"
run 2 $a $b --unrendered "$work/lines"; one_line; says "expected two folders"
run 3 "$work/a" "$work/b" --commands "$work/lines"; one_line; says "got 'nothing', expected NAME: COMMAND"
: >"$work/lines"
run 1 "$work/a" "$work/b" --unrendered "$work/lines"; says "f_2.pfm: missing"

claim "--commands says what made each image, --only leaves the images of one name"
printf 'f_%%d.pfm: draw -o f_%%d.pfm\nf_1.pfm: other\nnone.pfm: nothing\n' >"$work/lines"
run 1 "$work/a" "$work/b" --commands "$work/lines" --html "$work/report.html" --json "$work/report.json"
counts "$work/report.json" '"command": "draw -o f_%d.pfm"' 2; counts "$work/report.html" '"command":"draw -o f_%d.pfm"' 2; not_in "$work/report.json" other; not_in "$work/out" none.pfm
run 0 "$work/a" "$work/b" --only f_1.pfm; says "1 image: 1 same"
run 1 "$work/a" "$work/b" --only f_%d.pfm; says "2 images: 1 same, 1 missing"
run 0 "$work/a" "$work/b" --only f_1.pfm --mask "$work/masks" # the mask of another image
run 3 "$work/a" "$work/b" --only f_3.pfm; one_line; says "--only f_3.pfm: no image of this name: did you mean 'f_1.pfm'?"
run 3 "$work/a" "$work/b" --only f_2; one_line; says "--only f_2: no image of this name: did you mean 'f_2.pfm'?"
run 2 "$work/a"; one_line; says "got 1 name, expected two"
run 2 $a $b --only f_1.pfm; one_line; says "expected two folders"

finish
