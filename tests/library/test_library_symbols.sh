#!/bin/sh
# SPDX-License-Identifier: MIT
# The symbols that the library exports and calls: it exports the names of tractrix.h and no others, and calls nothing
# that prints, ends a program, handles signals or starts processes.
. tests/support/claims.sh
library=$bin/lib/libtractrix.so.0

# A sanitizer that is linked in makes calls of its own.
if grep -q fsanitize "$bin/flags"; then echo "a sanitizer's library calls what it likes: skipped"; exit 77; fi

sed -n 's/^[^ /#].*[ *]\(tractrix_[a-z_]*\)(.*/\1/p' src/library/tractrix.h | sort >"$work/declared"

claim "the shared library has what the header declares, and nothing else"
nm -D --defined-only "$library" | awk '$2 != "A" { print $3 }' | sed 's/@.*//' | sort >"$work/exported"
holds test "$(wc -l <"$work/declared")" -gt 25
holds diff "$work/declared" "$work/exported"

claim "the static library has what the header declares, and nothing else"
nm -g --defined-only "$bin/lib/libtractrix.a" | awk 'NF == 3 { print $3 }' | sort >"$work/static"
holds diff "$work/declared" "$work/static"

claim "the library's version is that of its symbols and of the header"
version=$(sed -n 's/^VERSION := //p' Makefile)
number=$(echo "$version" | awk -F. '{ printf "0x%02x%02x%02x", $1, $2, $3 }')
holds test "$number" = "$(sed -n 's/^#define TRACTRIX_VERSION_NUMBER \(0x[0-9]*\).*/\1/p' src/library/tractrix.h)"
holds grep -q "^TRACTRIX_${version%.*} {" src/library/tractrix.map

claim "nothing ends the program, prints, handles signals or starts a process"
for file in "$library" "$bin/lib/libtractrix.a"; do
    case $file in *.a) nm -u "$file" ;; *) nm -D -u "$file" ;; esac | awk '{ print $NF }' | sed 's/@.*//' | sort -u >"$work/called"
    holds test -s "$work/called"
    for name in exit _exit _Exit quick_exit abort atexit signal sigaction sigprocmask raise fork vfork posix_spawn posix_spawnp \
        execve execvp system popen stderr printf puts putchar perror __printf_chk setlocale chdir umask json_set_alloc_funcs json_set_alloc_funcs2; do
        if grep -qx "$name" "$work/called"; then bad "$(basename "$file") calls $name"; else good; fi
    done
done

claim "each function of the library has the C locale from its first statement on (LIBRARY_CALL)"
awk 'FNR == 1 { name = "" } /^[A-Za-z].*[ *]tractrix_[a-z_]*\(/ && !/^static/ { name = $0 } /^\{/ && name { getline; if ($0 !~ /^ *LIBRARY_CALL;$/) print FILENAME ": " name
    else ++found; name = "" } END { if (found < 39) print "only " found + 0 " functions found" }' src/library/*.c >"$work/out"
silent out

claim "the library has its name and stays loaded"
holds sh -c "readelf -d '$library' | grep -q 'SONAME.*\[libtractrix.so.0\]'"
holds sh -c "readelf -d '$library' | grep -q NODELETE"
finish
