# SPDX-License-Identifier: MIT
# shellcheck shell=bash
# Sourced by tests of recorded texts: recorded_check SET compares what the commands of tests/data/recorded/SET.txt print
# (scripts/recorded-text) with tests/data/recorded/SET.out, a test for each command.
#
# recorded_platform FOLDER: the platform of the programs there, and the maker of the processor.
recorded_platform() {
    echo "$("$1/tractrix-render" --platform) $(awk '/^vendor_id/ { print $3; exit }' /proc/cpuinfo)"
}

recorded_check() {
    local set=$1 passed=0 failed=0 now old name
    now=$(mktemp -d)
    trap 'rm -rf "$now"' EXIT
    scripts/recorded-text "$set" "${TRACTRIX_BIN:-out/release}" >"$now/all"
    mkdir "$now/new" "$now/old"
    # A file for each command.
    awk -v to="$now/new/" '/^== / { file = to $2 } { print >file }' "$now/all"
    awk -v to="$now/old/" '/^== / { file = to $2 } { print >file }' "tests/data/recorded/$set.out"
    for new in "$now/new"/*; do
        name=${new##*/} old=$now/old/${new##*/}
        if cmp -s "$new" "$old"; then
            passed=$((passed + 1))
        else
            failed=$((failed + 1))
            echo "FAILED: $set ${name%:}"
            diff "$old" "$new" | head -n 20 | cut -c1-200
        fi
    done
    echo "$passed passed, $failed failed, 0 skipped"
    [ "$failed" = 0 ] && [ "$passed" -gt 0 ]
}
