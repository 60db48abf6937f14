#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What runs and measurements print and write, compared with a record. Every digit counts, so only the platform that
# recorded it can be compared. Processors of another maker are expected to give the same digits, but this was not tried:
# there a difference is reported as skipped.
. tests/support/recorded.sh
read -r recorded maker <tests/data/recorded/reports.platform
read -r platform here <<<"$(recorded_platform "${TRACTRIX_BIN:-out/release}")"
if [ "$platform" != "$recorded" ] || [ -n "${TRACTRIX_ASSUME:-}" ]; then
    echo "skipped: recorded on $recorded"
    exit 77
fi
recorded_check reports && exit
[ "$here" = "$maker" ] && exit 1
echo "skipped: recorded on a processor of $maker, this one is of $here"
exit 77
