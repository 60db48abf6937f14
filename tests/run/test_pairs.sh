#!/bin/bash
# SPDX-License-Identifier: MIT
# Two runs at the same time whose outputs lie in one folder, in random pairs: each ends as it would alone, and each file is whole and of one of
# them. 20 pairs; TEST_LONG=1: 200 (make torture). SEED=N: other pairs.
. tests/support/claims.sh
RANDOM=${SEED:-1}
pairs=20
[ -z "${TEST_LONG:-}" ] || pairs=200
render="$bin/tractrix-render" convert="$bin/tractrix-convert"
folder=$work/new/deep
"$bin/tractrix-gen" --count 6 --vertices 8 -q -o "$work/good.tfx"
mkfifo "$work/bad.tfx" # a run that reads it has made its folder, and fails later

draw() { "$render" "$@" --look plain --size 16x12 -q --frames 4; }
claim "each run alone"
for color in red blue; do holds draw "$work/good.tfx" --color $color -o "$work/$color/"; done
holds "$convert" "$work/good.tfx" -q -o "$work/one.npz"
holds "$convert" "$work/good.tfx" --scale 2 -q -o "$work/two.npz"

# of_one FILE A B: the file is that of the first or of the second run alone.
of_one() { cmp -s "$1" "$2" || cmp -s "$1" "$3"; }
# wait_for PROCESS STATUS NAME
wait_for() {
    wait "$1"
    status=$?
    if [ $status = "$2" ]; then good; else bad "$3: exit status $status, expected $2"; fi
}
pause() { sleep "0.0$((RANDOM % 7))"; }

for ((i = 0; i < pairs; ++i)); do
    kind=$((RANDOM % 5)) first=good.tfx second=good.tfx
    rm -rf "$work/new"
    if [ $((RANDOM % 3)) = 0 ]; then first=bad.tfx; elif [ $((RANDOM % 3)) = 0 ]; then second=bad.tfx; fi
    if [ $first != $second ]; then { pause; echo garbage; } >"$work/bad.tfx" & fi
    claim "pair $i of kind $kind: $first and $second"
    case $kind in
    0) draw "$work/$first" --color red -o "$folder/" 2>"$work/err" & one=$!; pause; draw "$work/$second" --color blue -o "$folder/" 2>"$work/out" & ;;
    1) draw "$work/$first" --color red -o "$folder/" 2>"$work/err" & one=$!; pause; draw "$work/$second" --color red -o "$folder/" 2>"$work/out" & ;;
    2) draw "$work/$first" --color red --first 0 --last 1 -o "$folder/" 2>"$work/err" & one=$!; pause
       draw "$work/$second" --color red --first 2 --last 3 -o "$folder/" 2>"$work/out" & ;;
    3) "$convert" "$work/$first" -q -o "$folder/one.npz" 2>"$work/err" & one=$!; pause; "$convert" "$work/$second" --scale 2 -q -o "$folder/one.npz" 2>"$work/out" & ;;
    4) "$convert" "$work/$first" -q -o "$folder/one.npz" 2>"$work/err" & one=$!; pause; draw "$work/$second" --color blue -o "$folder/" 2>"$work/out" & ;;
    esac
    two=$!
    if [ $first = good.tfx ]; then wait_for "$one" 0 first; else wait_for "$one" 3 first; fi
    if [ $second = good.tfx ]; then wait_for "$two" 0 second; else wait_for "$two" 3 second; fi
    whole=0
    for file in "$folder"/*; do
        name=${file##*/}
        case $name in
        *.png) if of_one "$file" "$work/red/$name" "$work/blue/$name"; then whole=$((whole + 1)); else bad "$name is of neither run"; fi ;;
        *.npz) if of_one "$file" "$work/one.npz" "$work/two.npz"; then whole=$((whole + 1)); else bad "$name is of neither run"; fi ;;
        esac
    done
    least=1
    if [ $first = $second ]; then least=$((kind == 3 ? 1 : kind == 4 ? 5 : 4)); fi
    if [ "$whole" -ge $least ]; then good; else bad "$whole files, expected $least"; fi
    if [ -z "$(find "$work/new" -name '.*' 2>/dev/null)" ]; then good; else bad "left behind: $(find "$work/new" -name '.*')"; fi
done
finish
