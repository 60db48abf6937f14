#!/bin/sh
# SPDX-License-Identifier: MIT
# Small pictures against tests/golden/. On the driver that made them (tests/golden/renderer) they are equal to the byte or nearly so; other
# CPUs and drivers round differently, which moves few pixels far (a hair's edge in a neighbouring pixel) and most not at all.
#
#   level 8   of 255 levels: a pixel that differs by no more counts as equal
#   share 2 % of the pixels may differ by more
#
# The test first proves that it can fail: no golden matches another one of its size.
# GOLDEN_UPDATE=1 writes the pictures instead of comparing (scripts/update-goldens).
set -u
bin=${TRACTRIX_BIN:-out/release}
level=8 share=0.02
golden=tests/golden
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
passed=0 failed=0

while read -r name arguments; do
    case $name in '#'* | '') continue ;; esac
    # shellcheck disable=SC2086
    if ! "$bin/tractrix-render" $arguments -q -o "$work/$name/"; then
        echo "FAILED: $name: did not render"; failed=$((failed + 1)); continue
    fi
    picture=$(find "$work/$name" -name '*.png')
    if [ -n "${GOLDEN_UPDATE-}" ]; then cp "$picture" "$golden/$name.png"; continue; fi
    if line=$("$bin/tractrix-bench" compare "$golden/$name.png" "$picture" --level $level --share $share 2>&1); then
        passed=$((passed + 1)); echo "$name: $line"
    else
        failed=$((failed + 1)); echo "FAILED: $name: $line"
    fi
done <tests/goldens.txt
[ -z "${GOLDEN_UPDATE-}" ] || exit 0

# The threshold tells the goldens themselves apart.
for a in curls_still curls_split curls_thesis; do
    for b in curls_split curls_thesis fur_wind; do
        [ $a = $b ] && continue
        if "$bin/tractrix-bench" compare $golden/$a.png $golden/$b.png --level $level --share $share >/dev/null 2>&1; then
            failed=$((failed + 1)); echo "FAILED: $a and $b pass for the same picture"
        else
            passed=$((passed + 1))
        fi
    done
done
echo "$passed passed, $failed failed, 0 skipped"
[ "$failed" = 0 ]
