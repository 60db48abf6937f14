#!/bin/sh
# SPDX-License-Identifier: MIT
# Frames from many processes equal those of one process, to the byte: shares by --part, and scripts/farm with each of
# its runners. Lost frames are found and drawn. `make check-farm` installs the runners.
. tests/support/claims.sh
program=$bin/tractrix-render
# Without warm-up, at 10 frames a second: the seven frames still differ, because the wind begins at 0.5 s.
scene="assets/gust.json --look plain --frames 7 --fps 10 --preroll 0 --followers 0 --size 64x48"
same() { if diff -r "$work/one" "$1" >"$work/out" 2>"$work/err"; then good; else bad "$1 differs from one process's"; fi; }
# farm ARGUMENT...: runs the farm with the test's program.
farm() {
    if TRACTRIX_RENDER=$program scripts/farm "$@" >"$work/out" 2>"$work/err" </dev/null; then good; else bad "scripts/farm $*"; fi
}

# shellcheck disable=SC2086
run 0 $scene -q -o "$work/one/"

claim "--help is answered"
farm --help; says "Usage: farm"
farm --version; says "farm "

claim "shares are whole together, and none has another's frames"
for part in 1/3 2/3 3/3; do
    # shellcheck disable=SC2086
    run 0 $scene -q --part $part -o "$work/shares/"
done
same "$work/shares"
# shellcheck disable=SC2086
run 0 $scene -q --first 1 --every 2 --part 2/2 -o "$work/second/"
holds test "$(cd "$work/second" && echo *)" = frame_0003.png

claim "a share of no frames is done at once"
# shellcheck disable=SC2086
run 0 $scene -q --part 9/9 -o "$work/nothing/"
no_files "$work/nothing"

claim "a share that cannot be is refused"
for part in 0/2 3/2 2 1/0 x/2 1.5/2; do
    # shellcheck disable=SC2086
    run 2 $scene --part $part -o "$work/x/"; one_line; says "I/N"
done
# shellcheck disable=SC2086
run 2 $scene --part 1/2 -o "$work/x.mp4"; one_line
none "$work/x.mp4"
# shellcheck disable=SC2086
run 2 $scene --part 1/2 --export "$work/x.usda"; one_line

claim "one process after the other"
# shellcheck disable=SC2086
farm -n 3 plain -o "$work/plain/" $scene
same "$work/plain"

claim "a frame that is missing and one that is cut off are found and drawn again"
rm "$work/plain/frame_0002.png"
head -c 500 "$work/one/frame_0004.png" >"$work/plain/frame_0004.png"
# shellcheck disable=SC2086
farm -n 3 plain -o "$work/plain/" $scene
same "$work/plain"

claim "GPUs are shared out among the parts"
cat >"$work/gpus" <<END
#!/bin/sh
# A machine with three GPUs, one of which cannot be used. --device is logged and removed.
for word do
    shift
    case \$word in
    --list-devices)
        echo "--device 0        llvmpipe (LLVM 15.0.6, 256 bits), OpenGL 4.5 (CPU)"
        echo "                  Mesa/X.org"
        for number in 1 2 4; do echo "--device \$number        A GPU, OpenGL 4.6"; done
        echo "--device 3        not usable: no access"
        exit ;;
    --device) takes=1; continue ;;
    esac
    if [ "\${takes-}" ]; then takes=; echo "\$word" >>"$work/taken"; continue; fi
    set -- "\$@" "\$word"
done
exec "$program" "\$@"
END
chmod +x "$work/gpus"
# taken LIST OPTION...: the devices that four parts use, in order.
taken() {
    list=$1
    shift
    rm -rf "$work/taken" "$work/shared" "$work/shared.cache"
    # shellcheck disable=SC2086
    holds env TRACTRIX_RENDER="$work/gpus" scripts/farm -n 4 "$@" plain -o "$work/shared/" $scene
    if [ "$(tr '\n' ' ' <"$work/taken" 2>/dev/null)" = "$list" ]; then good; else bad "took $(cat "$work/taken"), expected $list"; fi
}
taken "1 2 4 1 "
same "$work/shared"
taken "4 0 4 0 " --devices 4,0
taken "" --devices none
# shellcheck disable=SC2086
if scripts/farm --devices 1,x plain -o "$work/x/" $scene >"$work/out" 2>"$work/err"; then bad "took '1,x'"; else says "--devices: got '1,x'"; fi

claim "a share that is lost is drawn at the end"
cat >"$work/losing" <<END
#!/bin/sh
case "\$*" in *"--part 2/3"*) kill -9 \$\$ ;; esac
exec "$program" "\$@"
END
chmod +x "$work/losing"
# shellcheck disable=SC2086
holds env TRACTRIX_RENDER="$work/losing" scripts/farm -n 3 -c "$work/l.cache" plain -o "$work/lost/%04d.png" $scene
says "part 2 failed"; says "5 of 7 frames are already written"
for frame in 0 1 2 3 4 5 6; do equal "$work/one/frame_000$frame.png" "$work/lost/000$frame.png"; done

claim "wrong usage is told"
for words in "" "plain" "plain -o $work/x/" "cloud -o $work/x/ a.json" "-n 0 plain -o $work/x/ a.json" "-z plain -o $work/x/ a.json" \
    "plain -o $work/x/" "--parts" "plain --wind 1 -o $work/x/ a.json"; do
    # shellcheck disable=SC2086
    scripts/farm $words >"$work/out" 2>"$work/err"
    if [ $? = 2 ]; then good; else bad "scripts/farm $words: not status 2"; fi
    one_line
done

claim "long options, before the runner and behind it"
# shellcheck disable=SC2086
farm --parts=2 plain --cache "$work/long.cache" --output "$work/long/" $scene
same "$work/long"
is_file "$work/long.cache"

claim "GNU parallel"
if command -v parallel >/dev/null; then
    # shellcheck disable=SC2086
    farm -n 4 parallel -o "$work/parallel/" $scene
    same "$work/parallel"
else
    skip "no parallel"
fi

claim "Slurm"
if ! PATH=$PATH:/usr/sbin command -v slurmctld >/dev/null; then
    skip "no Slurm"
elif [ "$(id -u)" != 0 ]; then
    skip "not root"
else
    setting=$(scripts/slurm-here start "$work/slurm" 2>"$work/err") || bad "scripts/slurm-here start"
    export "${setting:-SLURM_CONF=}"
    # shellcheck disable=SC2086
    farm -n 3 slurm -o "$work/jobs/" $scene
    same "$work/jobs"
    holds scripts/slurm-here stop "$work/slurm"
fi

finish
