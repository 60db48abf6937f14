#!/bin/sh
# SPDX-License-Identifier: MIT
# The command line of tractrix-bench: rows in all three formats, bounds as exit statuses, messages. No timings.
. tests/support/claims.sh
program=$bin/tractrix-bench

# field FILE.csv NAME: the column's values, one on each line.
field() { awk -F, -v name="$2" 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == name) at = i; next } { print $at }' "$1"; }
# same A B WHAT
same() { if [ "$1" = "$2" ]; then good; else bad "$3: got '$1', expected '$2'"; fi; }

claim "the step's table has our rule and the thesis's, and ours holds its bound"
run 0 step --csv "$work/step.csv" --json "$work/step.json"
same "$(field "$work/step.csv" rule | sort -u | tr '\n' ' ')" "ours thesis " "rules"
same "$(grep -c '"category"' "$work/step.json")" "$(field "$work/step.csv" rule | wc -l)" "rows of JSON and CSV"
same "$(field "$work/step.csv" renderer | sort -u | wc -l)" 1 "renderers"
lines=$(wc -l <"$work/out")
same "$lines" "$(wc -l <"$work/step.csv")" "lines on the screen and in CSV"

claim "a bound that is broken ends with 1, after the rows"
printf 'id,category,hx_hex,hy_hex,hz_hex,tx_hex,ty_hex,tz_hex,px_hex,py_hex,pz_hex,floor32,tnx,tny,tnz\n0,pull,0,0,0,1,0,0,-0.5,0,0,1e-7,0.6,0,0\n' >"$work/wrong.csv"
run 1 step --vectors "$work/wrong.csv" --csv "$work/broken.csv"
says "1 of 1 bounds are broken"; says "stated is at most 16"
same "$(field "$work/broken.csv" verdict | head -1)" broken "verdict"

claim "errors against exact motions, and a command that repeats the row"
mkdir "$work/motion"
cp tests/data/motion/c_root2Hz_n16_c4.* "$work/motion"
run 0 accuracy --part motions --reference "$work/motion" --algo chain --rates 60,120 --csv "$work/a.csv" --json "$work/a.json"
same "$(field "$work/a.csv" what | tr '\n' ' ')" "error error order error error order " "rows"
command=$(field "$work/a.csv" command | head -1)
# shellcheck disable=SC2086
run 0 ${command#tractrix-bench } --csv "$work/again.csv"
same "$(field "$work/again.csv" value | head -1)" "$(field "$work/a.csv" value | head -1)" "the repeated value"

claim "solvers' own flags reach them"
run 0 accuracy --part motions --reference "$work/motion" --algo rope --rope-iterations 3 --rates 60 --csv "$work/r3.csv"
run 0 accuracy --part motions --reference "$work/motion" --algo rope --rates 60 --csv "$work/r10.csv"
same "$(field "$work/r3.csv" settings | head -1)" "--rope-iterations 3" "settings"
if [ "$(field "$work/r3.csv" value | head -1)" = "$(field "$work/r10.csv" value | head -1)" ]; then bad "3 sweeps are as good as 10"; else good; fi

claim "time beside error: a point is remade by its command, and what nothing beats is named"
run 0 accuracy --part work --reference "$work/motion" --algo chain --rates 60 --set 1k16 --csv "$work/w.csv"
same "$(field "$work/w.csv" front | sort -u)" front "the only point"
same "$(field "$work/w.csv" value | head -1)" "$(field "$work/a.csv" value | head -1)" "its error"
same "$(field "$work/w.csv" command | head -1)" \
    "tractrix-bench accuracy --part work --algo chain --rates 60 --set 1k16 --reference $work/motion" "its command"

claim "split's tip is a pendulum, styled hair rests where it should, and so does a beam"
run 0 accuracy --part pendulum --algo split --rates 60 --csv "$work/p.csv"
same "$(field "$work/p.csv" verdict | grep -c holds)" 1 "bounds"
run 0 accuracy --part static --algo hybrid --csv "$work/t.csv"
same "$(field "$work/t.csv" value | awk '$1 < 1e-5' | wc -l)" 8 "states that are exact"
run 0 accuracy --part beam --algo spring --rates 60 --csv "$work/b.csv"
same "$(awk -F, '$8 == "error" && $9 < 1e-5' "$work/b.csv" | wc -l)" 6 "shapes that are exact"
run 0 accuracy --part physics --algo rod --rates 60 --csv "$work/c.csv"
same "$(field "$work/c.csv" verdict | grep -c holds)" 17 "bounds of rods"

claim "what should change nothing: units and frame rates; what strands should keep: lengths and energy"
run 0 accuracy --part scale,stretch,rate,drift --algo hybrid --seconds 1 --csv "$work/i.csv"
same "$(field "$work/i.csv" part | sort -u | tr '\n' ' ')" "drift rate scale stretch " "parts"
same "$(field "$work/i.csv" verdict | grep -c holds)" 3 "bounds"
run 0 accuracy --part energy --algo dftl --rates 60 --seconds 1 --csv "$work/e.csv"
same "$(field "$work/e.csv" verdict | grep -c holds)" 12 "bounds of energy"

claim "speed has a row for each solver, with the thesis's figure beside its sets"
run 0 speed --set 1k16 --algo split --steps 2 --warm-up 0 --csv "$work/s.csv"
same "$(field "$work/s.csv" thesis_ms)" 0.4 "the thesis's ms"
same "$(field "$work/s.csv" particles)" 16000 "particles"
run 0 speed --set 1k16 --algo dftl,split --steps 2 --warm-up 0 --csv "$work/two.csv"
same "$(field "$work/two.csv" algo | tr '\n' ' ')" "dftl split " "a list's solvers, in its order"
run 2 speed --set 1k16 --algo dftl,splt; one_line; says "no solver 'splt'"
run 2 stress --algo dftl,split; says "expected one solver"
run 2 scenes --algo dftl,split; says "expected one solver"

claim "split in plain C moves as on the GPU"
run 0 speed --part c --set 1k16 --algo split --steps 1 --warm-up 0 --csv "$work/c.csv"
same "$(field "$work/c.csv" verdict | tr '\n' ' ')" "holds holds holds holds " "bounds"

claim "growth, threads and start-up have rows of the same form, and exponents"
run 0 speed --part vertices --algo dftl --steps 1 --warm-up 0 --csv "$work/v.csv"
same "$(field "$work/v.csv" exponent | grep -c .)" 1 "exponents"
run 0 speed --part start,memory --algo dftl --csv "$work/n.csv"
same "$(field "$work/n.csv" remark | tr '\n' ' ')" "a = b + 3 c; 3 x 64 MiB cold warm " "starts"
if field "$work/n.csv" renderer | grep -q llvmpipe; then
    run 0 speed --part threads --set 1k16 --algo dftl --steps 1 --warm-up 0 --csv "$work/h.csv"
    same "$(field "$work/h.csv" threads | tr '\n' ' ')" "1 2 0 " "threads"
else
    skip "threads are of llvmpipe"
fi

claim "scenes have rows of the same form"
run 0 scenes --set 1k16 --steps 1 --warm-up 0 --algo dftl --csv "$work/scenes.csv"
same "$(field "$work/scenes.csv" guides | tail -1)" 2000 "guides of two sections"
same "$(field "$work/scenes.csv" ms_min | awk '!($1 > 0)' | wc -l)" 0 "scenes without a time"

claim "stress: solvers that keep their bounds have a row each, and it ends with 0"
run 0 stress --algo hybrid --cases 48 --steps 50 --csv "$work/kept.csv"
same "$(field "$work/kept.csv" what) $(field "$work/kept.csv" cases) $(field "$work/kept.csv" failures)" "form 48 0" "the row"

claim "stress: every case that breaks a bound is named on the screen and in both files, its command repeats it, and it ends with 1"
# A falling strand uses half of the energy that it is allowed, with any solver, so a bound of 0.4 of that is broken.
run 1 stress --algo hybrid --cases 48 --steps 50 --allow 0.4 --csv "$work/stress.csv" --json "$work/stress.json"
failures=$(field "$work/stress.csv" failures | tail -1)
if [ "$failures" -gt 0 ]; then good; else bad "nothing is broken"; fi
says "$failures cases failed"
same "$(field "$work/stress.csv" what | grep -c failed)" "$failures" "failed cases in CSV"
same "$(grep -c '"what": "failed"' "$work/stress.json")" "$failures" "in JSON"
same "$(grep -c '  set [0-9]*, strand [0-9]*: energy at step' "$work/out")" "$failures" "on the screen"
found=$(field "$work/stress.csv" case | head -1) used=$(field "$work/stress.csv" of_allowed | head -1)
smallest=$(field "$work/stress.csv" case | tail -2 | head -1)
says ", strand $(field "$work/stress.csv" strand | head -1): energy"; says ": '$found'"
says "--allow 0.4 --case '$smallest'"
run 1 stress --algo hybrid --steps 50 --allow 0.4 --case "$found" --csv "$work/repeated.csv"
same "$(field "$work/repeated.csv" of_allowed | head -1)" "$used" "the repeated case"
run 0 stress --algo hybrid --steps 50 --case "$found"
run 2 stress --algo hybrid --allow 1.1; says "--allow"

claim "wrong usage ends with 2 and one line that helps"
run 2 stepp; says "did you mean 'step'"
run 2 accuracy --part motion; says "no part 'motion': did you mean 'motions'?"
run 2 accuracy --algo rope --rope-iterations 0; says "--rope-iterations"
run 2 accuracy --variant thesis; says "--algo"
run 2 speed --set 2k16; says "2k16"
run 3 accuracy --reference "$work/nothing"; says "others are named with --reference DIR"
run 3 speed --part start "$work/none.tfx"; one_line; says "none.tfx: No such file or directory"
run 3 step --vectors "$work/nothing.csv"

claim "outputs overwrite neither what is read nor each other"
cp tests/data/motion/c_root2Hz_n16_c4.csv "$work/rows.csv" 2>/dev/null || cp "$work/step.csv" "$work/rows.csv"
cp "$work/rows.csv" "$work/rows.kept"; ln -s rows.csv "$work/link.csv"; cp assets/ball.obj "$work/ball.obj"
run 2 step --csv "$work/same" --json "$work/same"; one_line; says "--csv"; says "--json"; none "$work/same"
run 2 step --vectors "$work/rows.csv" --csv "$work/link.csv"; one_line; says "--vectors"
run 2 page "$work/rows.csv" --html "$work/rows.csv"; one_line; says "--html"
run 2 groom --mesh "$work/ball.obj" --json "$work/ball.obj"; one_line; says "--mesh"
run 2 light --picture "$work/x.png" --html "$work/x.png"; one_line; says "--picture"
run 2 speed "$work/rows.csv" --csv "$work/../$(basename "$work")/rows.csv"; one_line; says "the file"
equal "$work/rows.csv" "$work/rows.kept"; equal "$work/ball.obj" assets/ball.obj

finish
