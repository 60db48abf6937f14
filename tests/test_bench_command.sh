#!/bin/sh
# SPDX-License-Identifier: MIT
# tractrix-bench as a user meets it: its rows in all three forms, bounds as exit statuses, messages. No timings.
set -u
bench=${TRACTRIX_BIN:-out/release}/tractrix-bench
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
passed=0 failed=0

claim() { claim=$1; }
good() { passed=$((passed + 1)); }
bad() { failed=$((failed + 1)); echo "FAILED: $claim: $*"; sed 's/^/    /' "$work/err"; }
# run STATUS ARGUMENT...: compares the exit status; output in $work/out and $work/err.
run() {
    expected=$1; shift
    "$bench" "$@" >"$work/out" 2>"$work/err" </dev/null
    status=$?
    if [ "$status" = "$expected" ]; then good; else bad "exit status $status, expected $expected: $*"; fi
}
says() { if grep -qF -- "$1" "$work/err" "$work/out"; then good; else bad "does not say '$1'"; fi; }
# field FILE.csv NAME: the column's values, a line each.
field() { awk -F, -v name="$2" 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == name) at = i; next } { print $at }' "$1"; }
# equal A B WHAT
equal() { if [ "$1" = "$2" ]; then good; else bad "$3: got '$1', expected '$2'"; fi; }

claim "the step's table has our rule and the thesis's, and ours holds its bound"
run 0 step --csv "$work/step.csv" --json "$work/step.json"
equal "$(field "$work/step.csv" rule | sort -u | tr '\n' ' ')" "ours thesis " "rules"
equal "$(grep -c '"category"' "$work/step.json")" "$(field "$work/step.csv" rule | wc -l)" "rows of JSON and CSV"
equal "$(field "$work/step.csv" renderer | sort -u | wc -l)" 1 "renderers"
lines=$(wc -l <"$work/out")
equal "$lines" "$(wc -l <"$work/step.csv")" "lines on the screen and in CSV"

claim "a bound that is broken ends with 1, after the rows"
printf 'id,category,hx_hex,hy_hex,hz_hex,tx_hex,ty_hex,tz_hex,px_hex,py_hex,pz_hex,floor32,tnx,tny,tnz\n0,pull,0,0,0,1,0,0,-0.5,0,0,1e-7,0.6,0,0\n' >"$work/wrong.csv"
run 1 step --vectors "$work/wrong.csv" --csv "$work/broken.csv"
says "1 of 1 bounds are broken"; says "stated is at most 16"
equal "$(field "$work/broken.csv" verdict | head -1)" broken "verdict"

claim "errors against exact motions, and a command that repeats the row"
mkdir "$work/motion"
cp tests/data/motion/c_root2Hz_n16_c4.* "$work/motion"
run 0 accuracy --part motions --reference "$work/motion" --algo chain --rates 60,120 --csv "$work/a.csv" --json "$work/a.json"
equal "$(field "$work/a.csv" what | tr '\n' ' ')" "error error order error error order " "rows"
command=$(field "$work/a.csv" command | head -1)
# shellcheck disable=SC2086
run 0 ${command#tractrix-bench } --csv "$work/again.csv"
equal "$(field "$work/again.csv" value | head -1)" "$(field "$work/a.csv" value | head -1)" "the repeated value"

claim "solvers' own flags reach them"
run 0 accuracy --part motions --reference "$work/motion" --algo rope --rope-iterations 3 --rates 60 --csv "$work/r3.csv"
run 0 accuracy --part motions --reference "$work/motion" --algo rope --rates 60 --csv "$work/r10.csv"
equal "$(field "$work/r3.csv" settings | head -1)" "--rope-iterations 3" "settings"
if [ "$(field "$work/r3.csv" value | head -1)" = "$(field "$work/r10.csv" value | head -1)" ]; then bad "3 sweeps are as good as 10"; else good; fi

claim "speed has a row for each solver, with the thesis's figure beside its sets"
run 0 speed --set 1k16 --algo split --steps 2 --warm-up 0 --csv "$work/s.csv"
equal "$(field "$work/s.csv" thesis_ms)" 0.4 "the thesis's ms"
equal "$(field "$work/s.csv" particles)" 16000 "particles"

claim "wrong usage ends with 2 and one line that helps"
run 2 stepp; says "did you mean 'step'"
run 2 accuracy --part motion; says "motions"
run 2 accuracy --algo rope --rope-iterations 0; says "--rope-iterations"
run 2 accuracy --variant thesis; says "--algo"
run 2 speed --set 2k16; says "2k16"
run 3 accuracy --reference "$work/nothing"
run 3 step --vectors "$work/nothing.csv"

printf '\n%d passed, %d failed, 0 skipped\n' "$passed" "$failed"
[ "$failed" = 0 ]
