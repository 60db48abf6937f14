#!/bin/sh
# SPDX-License-Identifier: MIT
# Compares small images with tests/golden/.
#
#   pixel tolerance 2        levels of 255: a pixel that differs by no more counts as equal
#   max failing pixels 0.5%  share of the pixels that may differ by more
#
# These limits apply to the driver that made the goldens (tests/golden/renderer), on any CPU. Measured with every set of
# instructions that it knows (scripts/goldens-by-cpu), at most 0.01 % of the pixels differ by 1 level. Other drivers
# round differently (a hair's edge in a neighbouring pixel): they have 8 levels and 2 %, which the test prints.
#
# The test also proves that it can fail: no golden matches another one of its size. Rendered images, and heat maps of
# those that differ, stay in goldens/ beside the programs. scripts/update-goldens renders the goldens again.
set -u
bin=${TRACTRIX_BIN:-out/release}
golden=tests/golden
TRACTRIX_BIN=$bin
export TRACTRIX_BIN

# The driver's name without its vector width, which depends on the CPU.
driver() { head -n 1 "$1" | sed -E 's/^.{18}//; s/, [0-9]+ bits//'; }
limits="--pixel-tolerance 2 --max-failing-pixels 0.5%" platform=
devices=$(mktemp)
trap 'rm -f "$devices"' EXIT
"$bin/tractrix-render" --list-devices >"$devices"
if [ "$(driver "$devices")" != "$(driver $golden/renderer)" ]; then
    limits="--pixel-tolerance 8 --max-failing-pixels 2%" platform=--any-platform
    echo "another driver than the goldens', which was $(driver $golden/renderer): compared with $limits"
fi

# shellcheck disable=SC2086
lines=$(scripts/compare-goldens tests/goldens.txt $golden "$bin/goldens" $limits $platform 2>&1)
status=$?
echo "$lines"
passed=$(echo "$lines" | grep -cE ': (same|within limits): ')
failed=$(echo "$lines" | grep -cE ': (different|size mismatch|missing|unrendered|unreadable|failed): ')
[ $status = 0 ] || [ "$failed" -gt 0 ] || failed=1

# The limits tell the goldens themselves apart.
for a in curls_still curls_split curls_thesis; do
    for b in curls_split curls_thesis fur_wind; do
        [ $a = $b ] && continue
        # shellcheck disable=SC2086
        "$bin/tractrix-compare" $golden/$a.png $golden/$b.png $limits -q
        if [ $? = 1 ]; then
            passed=$((passed + 1))
        else
            failed=$((failed + 1)); echo "FAILED: $a and $b pass for the same picture"
        fi
    done
done
echo "$passed passed, $failed failed, 0 skipped"
[ "$failed" = 0 ]
