#!/bin/sh
# SPDX-License-Identifier: MIT
# scripts/compare-goldens renders, updates, compares, continues after failures, and keeps images that differ.
# shellcheck disable=SC2016 # nothing must be expanded
. tests/support/claims.sh
TRACTRIX_BIN=$(realpath "$bin")
export TRACTRIX_BIN
unset CI_PROJECT_DIR GITHUB_WORKSPACE GITHUB_STEP_SUMMARY JENKINS_URL
program=scripts/compare-goldens
small="assets/curls.tfx --algo none --followers 0 --look plain --size 48x36 --frames 1"
goldens() {
    expected=$1; shift
    run "$expected" "$work/list" "$work/goldens" "$work/result" "$@"
}

claim "help and version are answered, wrong usage is status 2 and one line"
run 0 --help; says "Usage: compare-goldens LIST GOLDENS OUT [OPTION]..."; says "Exit status:"; silent err
run 0 -h; run 0 --version; says "compare-goldens "
run 2; one_line
run 2 a b; one_line
run 2 a b --update; one_line
run 2 a "" c; one_line
run 2 "$work/none" "$work/goldens" "$work/result"; one_line; says "none: cannot read it"
mkdir -p "$work/cleared/frames" "$work/cleared/sheets"
echo "still assets/fur.tfx" >"$work/cleared/report.xml"; cp "$work/cleared/report.xml" "$work/cleared/sheets/list.txt"
ln -s cleared "$work/alias"
run 2 "$work/cleared/sheets/list.txt" "$work/goldens" "$work/alias/"; one_line; says "would be removed with"; is_file "$work/cleared/sheets/list.txt"
run 2 "$work/cleared/report.xml" "$work/goldens" "$work/cleared"; one_line; says "would be removed with"; is_file "$work/cleared/report.xml"
run 2 "$work/cleared/report.xml" "$work/cleared/frames" "$work/alias" --update; one_line; says "would be removed with"
run 2 "$work" "$work/goldens" "$work/result"; one_line

claim "a mistake in the list is found before an image is drawn"
for line in 'a/b x.tfx' 'plain' 'plain "x.tfx' "plain it's" 'one x.tfx
one y.tfx' '# only a comment'; do
    printf '%s\n' "$line" >"$work/list"
    goldens 2 --update; one_line; says "$work/list: "; none "$work/result"
done
printf 'a x.tfx\n\nb y.tfx\na z.tfx' >"$work/list"
goldens 2 --update; says "list: line 4: a: a second scene with this name"
printf 'plain %s\nbad assets/fur.tfx --bogus\n' "$small" >"$work/list"
goldens 2 --update; one_line; says "list: line 2: bad: --bogus: no such option"; none "$work/result"; none "$work/goldens"
printf 'bad assets/fur.tfx --color nothing\n' >"$work/list"
goldens 2 --update; one_line; says "list: line 1: bad: --color: got 'nothing'"; none "$work/result"

claim "without goldens it says how to make them, before an image is drawn"
printf '# a comment\nplain %s\ntwo_%%02d "assets/fur.tfx" --algo none --followers 0 --look plain --size 48x36 --frames 2\r' "$small" >"$work/list"
goldens 3; one_line; says "$work/goldens: no goldens yet: expected --update"; none "$work/result"
mkdir "$work/goldens"
goldens 3; one_line; says "no goldens yet: expected --update"
goldens 2 --bogus; one_line; none "$work/result"

claim "goldens are made, and equal images pass"
goldens 0 --update; says "3 references updated"
goldens 0; says "3 images: 3 same"; none "$work/result/sheets/plain.png"; silent err
in_file "$work/result/report.xml" 'tests="3" failures="0"'; in_file "$work/result/report.json" '"images": 3'

claim "a golden of the same driver and processor must be equal, another one within the limits"
printf 'plain %s --exposure 0.01\ntwo_%%02d assets/fur.tfx --algo none --followers 0 --look plain --size 48x36 --frames 2\n' "$small" >"$work/list"
goldens 1; says "plain.png: different: RMSE 0."; says "golden: $work/goldens/plain.png (common), from the same driver and processor: expected equal pixels"; in_file "$work/result/report.json" '"exact": true'
goldens 0 --common-limits 8,0; says "plain.png: within limits: RMSE 0."; says "3 images: 2 same, 1 within limits"; in_file "$work/result/report.xml" 'failures="0"'

claim "an image that differs fails, with sheet and reports; all failures are named at the end"
printf 'plain %s --color #ff0000\n' "$small" >"$work/list"
goldens 1 --pixel-tolerance 8 --max-failing-pixels 1%; says "plain.png: different"; says "two_00.png: missing"
says "golden: $work/goldens/plain.png (common)"
says "compare-goldens: failed:"; says "  plain.png: different"; says "  two_01.png: missing"
is_png "$work/result/sheets/plain.png"; in_file "$work/result/report.xml" "plain.png"; in_file "$work/result/report.html" "plain.png"

claim "the report says what made each image, the terminal what accepts all, and both commands do it"
in_file "$work/result/report.html" "\"command\":\"tractrix-render $small --color '#ff0000' -q -o $work/result/frames/plain.png\""
accept=$(sed -n 's/^to accept the new images: //p' "$work/err")
rm "$work/goldens/two_00.png" "$work/goldens/two_01.png"; cp "$work/goldens/plain.png" "$work/before.png"
PATH=$TRACTRIX_BIN:$PATH sh -c "$accept" >"$work/out" 2>"$work/err"; equal "$work/goldens/plain.png" "$work/result/frames/plain.png"
made=$(sed -n 's/^ *"command": "\(.*plain.png\)",$/\1/p' "$work/result/report.json")
rm "$work/result/frames/plain.png"; PATH=$TRACTRIX_BIN:$PATH sh -c "$made"; equal "$work/goldens/plain.png" "$work/result/frames/plain.png"
goldens 0; says "1 image: 1 same"

claim "--only renders and compares one scene"
printf 'plain %s\ntwo_%%02d assets/fur.tfx --algo none --followers 0 --look plain --size 48x36 --frames 2\n' "$small" >"$work/list"
goldens 1; says "plain.png: different"; says "two_00.png: new"; none "$work/goldens/two_00.png"
goldens 0 --only two_%02d --update; says "2 images: 2 new; 2 references updated"; none "$work/result/frames/plain.png"
goldens 0 --only=two_%02d; says "2 images: 2 same"
goldens 2 --only two; one_line; says "no scene two: expected one of plain two_%02d"
cp "$work/before.png" "$work/goldens/plain.png"

claim "an image that does not render does not stop the others, and is in the reports"
printf 'new_%%02d nowhere.tfx\ntwo_%%02d nothing.tfx\nplain %s\n' "$small" >"$work/list"
goldens 1; says "new_%02d: did not render: nowhere.tfx: No such file"; says "two_%02d: did not render: nothing.tfx"
says "plain.png: same"; says "two_01.png: unrendered: nothing.tfx"; says "new_%02d.png: unrendered: nowhere.tfx"; says "4 images: 1 same, 3 unrendered"
says "  new_%02d.png: unrendered"
in_file "$work/result/report.xml" 'failures="0" errors="3"'; in_file "$work/result/report.json" '"outcome": "unrendered"'
in_file "$work/result/report.html" "new_%02d.png"
goldens 1 --update; says "two_01.png: unrendered"; is_png "$work/goldens/two_01.png"

claim "arguments in quotes keep blanks; no variable, pattern or command is expanded"
cp assets/fur.tfx "$work/two words.tfx"
printf "plain '%s' --algo none --followers 0 --look plain --size 48x36 --frames 1\nodd \$(touch $work/harm) ; * > $work/harm\n" "$work/two words.tfx" >"$work/list"
rm -r "$work/goldens"
goldens 1 --update; says "plain.png: new"; says "1 reference updated"; says 'odd: did not render: $(touch: No such file'; none "$work/harm"
is_png "$work/goldens/plain.png"

claim "pictures may be JPEG files, goldens may not"
render() { # STATUS OPTION...
    expected=$1; shift
    # shellcheck disable=SC2086 # words
    "$TRACTRIX_BIN/tractrix-render" $small -q "$@" >"$work/out" 2>"$work/err"
    status=$?
    if [ "$status" = "$expected" ]; then good; else bad "exit status $status, expected $expected: $*"; fi
}
mkdir "$work/jpeg" "$work/png"
render 0 -o "$work/jpeg/x.jpg"; render 0 -o "$work/png/x.jpg"
for option in "--depth 16" "--aov depth" "--background transparent" "--resume"; do
    # shellcheck disable=SC2086 # words
    render 2 -o "$work/y_%d.jpg" $option; one_line; none "$work/y_0.jpg"
done
program=$TRACTRIX_BIN/tractrix-compare
run 3 "$work/jpeg/" "$work/png/"; says "x.jpg: unreadable: $work/png/x.jpg: a JPEG file, whose compression changes pixels: expected PNG, EXR or PFM"
render 0 -o "$work/new.png"
run 3 "$work/jpeg/x.jpg" "$work/new.png"; says "$work/jpeg/x.jpg: a JPEG file"
program=scripts/compare-goldens

claim "without the programs it says what it expected, and an interruption is status 130"
TRACTRIX_BIN=$work
goldens 1; one_line; says "no tractrix-render in $work"
TRACTRIX_BIN=$(realpath "$bin")
printf 'long_%%d assets/curls.tfx --algo none --followers 0 --look plain --size 48x36 --frames 100000\nafter %s\n' "$small" >"$work/list"
for signal in INT TERM; do
    rm -rf "$work/result"
    # `timeout` passes the signal on to all processes of the script, as a terminal does.
    (until [ -e "$work/result/frames/long_1.png" ]; do sleep 0.05; done; kill -s $signal "$(cat "$work/pid")") &
    # shellcheck disable=SC2016 # the inner shell's
    sh -c 'echo $$ >"$0"; exec timeout --preserve-status 60 "$@"' "$work/pid" "$program" "$work/list" "$work/goldens" "$work/result" >"$work/out" 2>"$work/err"
    status=$?
    kill $! 2>/dev/null; wait
    if [ $status = 130 ]; then good; else bad "exit status $status after SIG$signal"; fi
    silent out; none "$work/result/frames/after.png"; none "$work/result/report.json"
done

claim "it works from a folder with blanks and with programs from PATH"
printf 'plain %s\n' "$small" >"$work/two words"
run 0 "$work/two words" "$work/golden images/" "$work/new images/" --update
PATH=$TRACTRIX_BIN:$PATH
unset TRACTRIX_BIN
mkdir "$work/bin"; cp "$bin/tractrix-compare-goldens" "$work/bin/"; program=$work/bin/tractrix-compare-goldens
run 0 "$work/two words" "$work/golden images/" "$work/new images/"; says "1 image: 1 same"
run 0 --help; says "Usage: tractrix-compare-goldens "

finish
