#!/bin/sh
# SPDX-License-Identifier: MIT
# The library in hosts that have chosen a locale: with decimal commas, and with other letters for i and I. The tests of the library, its
# examples and the Python module's tests run again there. A preloaded file chooses the locale before main.
. tests/support/claims.sh
if grep -q fsanitize "$bin/flags"; then echo "a sanitizer's library must be loaded first: skipped"; exit 77; fi
cat >"$work/choose.c" <<'END'
#include <locale.h>
#include <stdlib.h>
static __attribute__((constructor)) void choose(void)
{
    if (!setlocale(LC_ALL, "")) abort();
}
END
holds cc -shared -fPIC -o "$work/choose.so" "$work/choose.c"
programs=$(realpath "$bin")

# in_locale NAME COMMAND...
in_locale() {
    name=$1; shift
    env -u LC_ALL LOCPATH="$work" LANG="$name.UTF-8" LD_PRELOAD="$work/choose.so" "$@"
}

for name in de_DE tr_TR; do
    claim "$name"
    if ! localedef -i "$name" -f UTF-8 "$work/$name.UTF-8" >"$work/out" 2>&1; then skip "no source of this locale"; continue; fi
    holds in_locale "$name" sh -c 'test "$(printf %.1f 0.5)" = 0,5'
    for test in scene device; do
        holds in_locale "$name" "$programs/tests/library/test_library_$test"
    done
    holds in_locale "$name" env TRACTRIX_BIN="$programs" tests/library/test_library_examples.sh
    holds in_locale "$name" env TRACTRIX_BIN="$programs" TRACTRIX_LIBRARY="$programs/lib/libtractrix.so.0" PYTHONPATH=python PYTHONDONTWRITEBYTECODE=1 \
        /usr/bin/python3 -m pytest -q -p no:cacheprovider --rootdir=. tests/python --ignore tests/python/test_stub.py
done
finish
