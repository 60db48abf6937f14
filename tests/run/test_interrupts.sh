#!/bin/sh
# SPDX-License-Identifier: MIT
# Every program ends soon after a signal, at any point: status 130, one line, no half-written file.
. tests/support/claims.sh
export XDG_CACHE_HOME="$work/cache"

# Generous, for busy machines; the interrupted work takes many times as long.
limit_ms=4000

# interrupted SIGNAL AFTER_S PROGRAM ARGUMENT...: sends the signal after this many seconds. The program must leave
# nothing in $work/here.
interrupted() {
    signal=$1 after=$2 program=$3; shift 3
    claim="$program, interrupted by $signal after $after s, ends at once"
    rm -rf "$work/here"; mkdir "$work/here"
    "$bin/$program" "$@" >"$work/out" 2>"$work/err" </dev/null &
    pid=$!
    sleep "$after"
    begin_ms=$(($(date +%s%N) / 1000000))
    kill "-$signal" $pid 2>/dev/null || bad "it had ended before"
    wait $pid
    status=$?
    took_ms=$(($(date +%s%N) / 1000000 - begin_ms))
    if [ $status = 130 ]; then good; else bad "exit status $status"; fi
    if [ $took_ms -lt $limit_ms ]; then good; else bad "it took $took_ms ms"; fi
    if tail -n 1 "$work/err" | grep -q "^$program: interrupted"; then good; else bad "does not say so"; fi
    no_files "$work/here"
}

interrupted TERM 0.3 tractrix-gen --kind fur --count 3000000 -q -o "$work/here/x.tfx"
interrupted HUP 0.3 tractrix-convert assets/demo.tfx --resample 2000 --smooth 9999 --smooth 9999 -q -o "$work/here/x.tfx"
interrupted INT 0.5 tractrix-render assets/demo.tfx --frames 100000 --size 32x24 -q --export "$work/here/x.usda"
interrupted TERM 0.2 tractrix-render assets/demo.json --size 8192x8192 -q -o "$work/here/x.png"
interrupted TERM 0.5 tractrix-bench accuracy --part work

"$bin/tractrix-render" assets/fur.tfx --look plain --algo none --size 4096x4096 -q -o "$work/a.png"
"$bin/tractrix-render" assets/fur.tfx --look plain --algo none --size 4096x4096 --eye 0,0.1,1 --target 0,0,0 -q -o "$work/b.png"
interrupted HUP 0.5 tractrix-compare "$work/a.png" "$work/b.png" -q --heatmap "$work/here/x.png"

finish
