#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What runs and measurements print and write, compared with a record. Every digit counts, so only the platform that
# recorded it can be compared.
. tests/support/recorded.sh
recorded=$(cat tests/data/recorded/reports.platform)
if [ "$("${TRACTRIX_BIN:-out/release}/tractrix-render" --platform)" != "$recorded" ] || [ -n "${TRACTRIX_ASSUME:-}" ]; then
    echo "skipped: recorded on $recorded"
    exit 77
fi
recorded_check reports
