#!/bin/sh
# SPDX-License-Identifier: MIT
# Shared by the tests of command lines: they source it with `. tests/support/claims.sh`, set `program` to the program
# that `run` runs, and end with `finish`.
set -u
# shellcheck disable=SC2034 # they use it
bin=${TRACTRIX_BIN:-out/release}
work=$(mktemp -d)
trap 'chmod -R u+w "$work"; rm -rf "$work"' EXIT
: >"$work/out"; : >"$work/err"
passed=0 failed=0 skipped=0 claim=

# claim TEXT: the claim that the next lines test.
claim() { claim=$1; }
good() { passed=$((passed + 1)); }
bad() { failed=$((failed + 1)); echo "FAILED: $claim: $*"; sed 's/^/    /' "$work/out" "$work/err"; }
skip() { skipped=$((skipped + 1)); echo "skipped: $claim: $*"; }
# holds COMMAND...: the command succeeds.
holds() { if "$@" >"$work/out" 2>"$work/err" </dev/null; then good; else bad "does not hold: $*"; fi; }
# run STATUS ARGUMENT...: runs the program and compares the exit status; its output goes to $work/out and $work/err.
run() {
    expected=$1; shift
    "${program:?}" "$@" >"$work/out" 2>"$work/err" </dev/null
    status=$?
    if [ "$status" = "$expected" ]; then good; else bad "exit status $status, expected $expected: $*"; fi
}
says() { if grep -qF -- "$1" "$work/err" "$work/out"; then good; else bad "does not say '$1'"; fi; }
silent() { if [ -s "$work/$1" ]; then bad "said something on $1"; else good; fi; }
one_line() { if [ "$(wc -l <"$work/err")" = 1 ]; then good; else bad "not one line"; fi; }
in_file() { if grep -qF -- "$2" "$1"; then good; else bad "$1 has no $2"; fi; }
is_file() { if [ -s "$1" ]; then good; else bad "no file $1"; fi; }
is_png() { if [ "$(head -c 4 "$1" | tail -c 3)" = PNG ]; then good; else bad "no picture $1"; fi; }
none() { if [ -e "$1" ]; then bad "there is $1"; else good; fi; }
no_files() { if [ -z "$(ls -A "$1" 2>/dev/null)" ]; then good; else bad "left behind: $(ls -A "$1")"; fi; }
equal() { if cmp -s "$1" "$2"; then good; else bad "$1 and $2 are not equal"; fi; }
# same_images A B: two images, or the images of two folders, have the same pixels; their texts may differ.
same_images() { holds "$bin/tractrix-compare" -q "$1" "$2"; }
# has_driver NAME: tractrix-render can use a driver of this name (a pattern).
has_driver() { "$bin/tractrix-render" --list-devices | grep -E -- "$1" | grep -qv 'not usable'; }

finish() {
    echo "$passed passed, $failed failed, $skipped skipped"
    [ "$failed" = 0 ]
    exit
}
