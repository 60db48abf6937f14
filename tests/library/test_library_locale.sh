#!/bin/sh
# SPDX-License-Identifier: MIT
# The library in hosts that have chosen a locale: with decimal commas, and with other letters for i and I. The tests of the library, its
# examples and the Python module's tests run again there. In these hosts
# a preloaded file chooses the locale before main; shells, compilers and the programs run as usual.
. tests/support/claims.sh
if grep -q fsanitize "$bin/flags"; then echo "a sanitizer's library must be loaded first: skipped"; exit 77; fi
cat >"$work/choose.c" <<'END'
#include <errno.h>
#include <locale.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
static __attribute__((constructor)) void choose(void)
{
    static const char *const hosts[] = {"test_library", "game_", "grooms", "regression", "python"};
    char text[8] = "";
    for (int i = 0; i < 5; ++i)
        if (strncmp(program_invocation_short_name, hosts[i], strlen(hosts[i])) == 0 &&
            (!setlocale(LC_ALL, "") || snprintf(text, sizeof text, "%.1f", 0.5) != 3 || text[1] != ','))
            abort();
}
END
holds cc -D_GNU_SOURCE -shared -fPIC -o "$work/choose.so" "$work/choose.c"
programs=$(realpath "$bin")

# in_locale NAME COMMAND...
# shellcheck disable=SC2317 # called by holds
in_locale() {
    name=$1; shift
    env -u LC_ALL LOCPATH="$work" LANG="$name.UTF-8" LC_MESSAGES=C LD_PRELOAD="$work/choose.so" "$@"
}

for name in de_DE tr_TR; do
    claim "$name"
    if ! localedef -i "$name" -f UTF-8 "$work/$name.UTF-8" >"$work/out" 2>&1; then skip "no source of this locale"; continue; fi
    for test in scene device; do
        holds in_locale "$name" "$programs/tests/library/test_library_$test"
    done
    holds in_locale "$name" env TRACTRIX_BIN="$programs" tests/library/test_library_examples.sh
    if ! /usr/bin/python3 -c 'import numpy, pytest' 2>/dev/null; then skip "no numpy or no pytest"; continue; fi
    holds in_locale "$name" env TRACTRIX_BIN="$programs" TRACTRIX_LIBRARY="$programs/lib/libtractrix.so.0" PYTHONPATH=python PYTHONDONTWRITEBYTECODE=1 \
        /usr/bin/python3 -m pytest -q -p no:cacheprovider --rootdir=. tests/python \
        --ignore tests/python/test_stub.py --ignore tests/python/test_plugin.py # these need an installed module
done
finish
