#!/bin/sh
# SPDX-License-Identifier: MIT
# Compares small images with tests/golden/. On the driver that made them (tests/golden/renderer) they are equal to the byte or nearly so.
# Other CPUs and drivers round differently: few pixels differ much (a hair's edge in a neighbouring pixel), most not at all.
#
#   pixel tolerance 8      of 255 levels: a pixel that differs by no more counts as equal
#   max failing pixels 2%  of the pixels may differ by more
#
# The test also proves that it can fail: no golden matches another one of its size. What was rendered, and heat maps of what differs,
# stay in goldens/ beside the programs. scripts/update-goldens renders the goldens anew.
set -u
bin=${TRACTRIX_BIN:-out/release}
limits="--pixel-tolerance 8 --max-failing-pixels 2%"
golden=tests/golden
TRACTRIX_BIN=$bin
export TRACTRIX_BIN

# shellcheck disable=SC2086
lines=$(scripts/compare-goldens tests/goldens.txt $golden "$bin/goldens" $limits 2>&1)
status=$?
echo "$lines"
passed=$(echo "$lines" | grep -c ': same: ')
failed=$(echo "$lines" | grep -cE ': (different|size mismatch|missing|unrendered|unreadable|failed): ')
[ $status = 0 ] || [ "$failed" -gt 0 ] || failed=1

# The threshold tells the goldens themselves apart.
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
