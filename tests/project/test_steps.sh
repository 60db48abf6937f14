#!/bin/sh
# SPDX-License-Identifier: MIT
# The programs that are scripts end at once when they receive a signal, with status 130, and end all of their processes,
# whatever these are doing and whatever process groups they have made (scripts/steps.sh).
. tests/support/claims.sh
here=$work/here
mkdir "$work/fake"
# A very slow program that starts others in their own process groups, and continues after the first signal.
cat >"$work/fake/tractrix-render" <<END
#!/bin/bash
case "\$*" in *--version*) exec "$bin/tractrix-render" --version ;; esac
trap : TERM INT HUP
set -m
sleep 300.125 & # in its own process group
echo started >>"$work/started"
wait || wait || wait
END
cp "$work/fake/tractrix-render" "$work/fake/parallel"
chmod +x "$work/fake/"*
for program in compare gen convert bench; do ln -s "$(realpath "$bin")/tractrix-$program" "$work/fake/"; done

# left: processes that have the test's folder in their arguments, or belong to the fake program.
left() {
    set -- /proc/[0-9]*/cmdline
    printf '%s\n300.125\n' "$work" | grep -aslFf - "$@"
}

# ends SIGNAL SCRIPT ARGUMENT...: sends the signal when the first process has started.
ends() {
    signal=$1; shift
    rm -rf "$here" "$work/started"; mkdir "$here"
    env --default-signal=INT TRACTRIX_BIN="${programs:-$work/fake}" PATH="$work/fake:$PATH" timeout -k 4 --foreground 60 "$@" >"$work/out" 2>"$work/err" </dev/null &
    pid=$!
    for _ in $(seq 200); do
        if [ -s "$work/started" ] || [ -n "$(find "$here" -name '*cache' -size +0 2>/dev/null)" ]; then break; fi
        sleep 0.05
    done
    begin_ms=$(($(date +%s%N) / 1000000))
    kill "-$signal" $pid 2>/dev/null || bad "it had ended before"
    wait $pid
    status=$?
    took_ms=$(($(date +%s%N) / 1000000 - begin_ms))
    if [ $status = 130 ]; then good; else bad "$*: exit status $status"; fi
    if [ $took_ms -lt 3000 ]; then good; else bad "$*: it took $took_ms ms"; fi
    rest=$(left)
    if [ -z "$rest" ]; then good; else bad "left running: $rest"; fi
}

claim "a signal ends a script and all processes of its step"
for signal in TERM HUP INT; do
    ends "$signal" scripts/farm -n 2 plain -o "$here/" assets/fur.tfx
    ends "$signal" scripts/turntable assets/fur.tfx sheet -o "$here"; no_files "$here"
done
echo "x assets/fur.tfx" >"$work/list"; mkdir "$work/goldens"; touch "$work/goldens/x.png"
ends TERM scripts/compare-goldens "$work/list" "$work/goldens" "$here"

claim "also where others share out the work"
cat >"$work/simulated" <<END
#!/bin/sh
case "\$*" in *--cache*) : ;; *) exec "$work/fake/tractrix-render" "\$@" ;; esac
END
chmod +x "$work/simulated"
TRACTRIX_RENDER=$work/simulated; export TRACTRIX_RENDER
ends TERM scripts/farm -n 2 parallel -o "$here/" assets/fur.tfx
unset TRACTRIX_RENDER

claim "with the true programs, while they simulate"
programs=$(realpath "$bin")
ends TERM scripts/farm -n 2 plain -c "$here/long.cache" -o "$here/" assets/fur.tfx --look plain --frames 100000 --size 16x16
ends HUP scripts/turntable assets/fur.tfx sheet -o "$here" --frames 100000; no_files "$here"

claim "a status that is no signal's is the script's own"
program=scripts/turntable
TRACTRIX_BIN=$programs; export TRACTRIX_BIN
run 3 "$work/none.tfx" sheet -o "$here"; one_line
finish
