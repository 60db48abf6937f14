#!/bin/sh
# SPDX-License-Identifier: MIT
# The short form of `make torture`: some call sites of each small run fail, one call at a time, and each kind of run is
# killed twice.
# First: JSON memory is allocated by calls that can be made to fail, at least one for each of 1000 numbers.
set -eu
bin=${TRACTRIX_BIN:-out/release}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
seq -s, 1000 | sed 's/.*/[&]/' >"$work/numbers.json"
TRACTRIX_FAULT_LOG=$work/log "$bin/faults/tractrix-render" "$work/numbers.json" -o "$work/x.png" 2>"$work/errors" || true
calls=$(grep -c '^malloc ' "$work/log")
if [ "$calls" -lt 1000 ]; then
    echo "1000 numbers of JSON made $calls calls of malloc: expected 1000 or more (json_watch.c)"
    exit 1
fi
rm -rf "$work"
exec "$bin/tests/faults/torture" "$bin"
