# SPDX-License-Identifier: MIT
# shellcheck shell=sh
# Shared by the programs that are scripts (farm, turntable, compare-goldens); the build copies it into them. Finds the
# programs and runs them as steps. A step is a separate session. If the script receives INT, TERM or HUP, it ends all
# processes of the running step, whatever process groups they have made, and then itself with status 130.
me=${0##*/} running='' at_end=:

# fail STATUS MESSAGE
fail() {
    status=$1
    shift
    echo "$me: $*" >&2
    exit "$status"
}

# find_program NAME: if TRACTRIX_BIN is set, looks only there.
find_program() {
    here=$(dirname "$0")
    for folder in "${TRACTRIX_BIN:-$here}" "${TRACTRIX_BIN:-$here/../out/release}"; do
        [ ! -x "$folder/$1" ] || { (cd "$folder" && echo "$PWD/$1") && return; }
    done
    [ -z "${TRACTRIX_BIN-}" ] || fail 1 "no $1 in $TRACTRIX_BIN: expected TRACTRIX_BIN to name the folder of the programs"
    command -v "$1" || fail 1 "no $1: expected it beside this program, in PATH or in TRACTRIX_BIN"
}

# step COMMAND...: runs the command and returns its status.
step() {
    running=yes
    setsid "$@" </dev/null &
    step_status=0
    wait $! || step_status=$?
    running=
    return "$step_status"
}

# processes_of SESSION: the numbers of its processes. In a stat file the name may contain anything; after it come state,
# parent, group and session. State Z: the process has ended.
processes_of() {
    for stat in /proc/[0-9]*/stat; do
        { read -r line <"$stat"; } 2>/dev/null || continue
        # shellcheck disable=SC2086
        set -- "$1" ${line##*) }
        number=${stat#/proc/}
        if [ "${5-}" = "$1" ] && [ "$2" != Z ]; then echo "${number%/stat}"; fi
    done
}

# Signals each process once, because many take a second signal as an order to abandon everything. Goes on while new
# processes appear, for at most 20 s. $! is the step's first process, even if the signal came before the shell could
# store it.
end_step() {
    asked="$!" rounds=0
    kill -s TERM "$!" 2>/dev/null || :
    while left=$(processes_of "$!") && [ "$left" ]; do
        for process in $left; do
            case " $asked " in *" $process "*) ;; *) asked="$asked $process"; kill -s TERM "$process" 2>/dev/null || : ;; esac
        done
        sleep 0.05
        [ $((rounds += 1)) -lt 400 ] || { echo "$left" | xargs kill -s KILL 2>/dev/null || : ; }
    done
    wait "$!" || :
}

# $at_end: a command that ends what does not run as a process here.
end_steps() {
    trap '' INT TERM HUP
    [ -z "$running" ] || end_step
    $at_end
    exit 130
}
trap end_steps INT TERM HUP
