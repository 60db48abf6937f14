#!/bin/sh
# SPDX-License-Identifier: MIT
# scripts/mutate on a made-up project of two sources, whose tests are scripts that search the sources for certain texts.
. tests/support/claims.sh
if ! command -v python3 >/dev/null || ! command -v git >/dev/null; then echo 'skipped: python3 and git are needed'; exit 77; fi
# Without a shim, such as pyenv's, which takes longer than the script itself.
PATH=$(python3 -c 'import os, sys; print(os.path.dirname(sys.executable))'):$PATH
tree=$work/tree
program=$tree/scripts/mutate
export TMPDIR="$work/tmp"
mkdir -p "$TMPDIR" "$tree/scripts" "$tree/src/base" "$tree/glsl/sim" "$tree/tests/base" "$tree/tests/sim"
cp scripts/mutate "$tree/scripts/"
git -C "$tree" init -q 2>/dev/null
echo /out/ >"$tree/.gitignore"
printf 'all:\n\t@! grep -q "x <;" src/base/a.c || { echo "a.c: error: no number"; exit 1; }\n' >"$tree/Makefile"
printf 'if (x < 10) y = 2;\nz = 3;\nz += 4;\nw = 5;\n' >"$tree/src/base/a.c"
printf 'float f = 1.0;\nfloat g = 2.0;\n' >"$tree/glsl/sim/b.comp"

# script NAME LINE...: makes a test.
script() {
    name=$1; shift
    { echo '#!/bin/sh'; printf '%s\n' "$@"; } >"$tree/tests/$name"
    chmod +x "$tree/tests/$name"
}
ten='grep -q "x < 10" src/base/a.c || { echo "expected 10"; exit 1; }' seven='if grep -q "y = 7" src/base/a.c; then exec sleep 60; fi'
script base/test_a.sh "$ten" "$seven"
script base/test_room.sh 'grep -q "z = 3" src/base/a.c'
script sim/test_b.sh 'grep -q "f = 3.0" glsl/sim/b.comp && { echo "glsl/sim/b.comp:1: error: syntax"; exit 1; }' 'grep -q "f = 1.0" glsl/sim/b.comp'
script sim/test_broken.sh 'exit 1'

claim "--random makes faults of every kind by itself, the same for the same seed, outside of comments and texts"
mkdir -p "$tree/src/run" "$tree/tests/run"
cat >"$tree/src/run/c.c" <<'END'
// a < b + 1
#define X (1 + 2)
int f(int a, int b) {
    if (a < b) return 1 + g(a, b);
    print("1 < 2, /* + */", 'a'); /* 3 > 4
    5 == 6 */
    skip(me);
    things_destroy(me);
    assert(a < 7);
    float room[8];
    return max(a, b);
}
END
script run/test_c.sh 'grep -q "if (a < b) return 1 + g(a, b);" src/run/c.c && grep -q "skip(me);" src/run/c.c && grep -q "return max(a, b)" src/run/c.c'
printf 'all:\n\t@:\n' >"$tree/Makefile"
run 0 --random 80 --list; cp "$work/out" "$work/all"
for fault in "a <= b" "2 + g(a, b)" "1 - g(a, b)" "g(b, a)" "!(a < b)" "1 == 1" "return min(a, b)" "skip(me);  ->  ;" "f = 1.1;"; do says "$fault"; done
for no in "assert" "room[9]" "X (" "a < b + 2" "2 < 2" "4 >" "max(b, a)" "int b, int a"; do
    if grep -qF -- "->  ${no}" "$work/all" || grep -- '->' "$work/all" | sed 's/.*->//' | grep -qF -- "$no"; then bad "made '$no'"; else good; fi
done
run 0 --random 80 --list; equal "$work/out" "$work/all"
run 0 --random 5 --seed 9 --list; if [ "$(grep -c '  ->  ' "$work/out")" = 5 ]; then good; else bad "not five faults"; fi
run 0 --random 9 --only 'run/c' --least 50 --limit 2; says "caught"; says "src/run"; says "all:"
run 0 --random 80 --only 'w = 5' --limit 2; says "survived: src/base/a.c:4: w = 5;"; no_files "$TMPDIR"; in_file "$tree/src/base/a.c" "w = 5;"
run 0 --random 80 --only 'w = 5' --limit 2; says "faults were tried before"
run 1 --random 80 --only 'w = 5' --limit 2 --least 1
if grep -q -- 'things_destroy.*->  ;' "$work/all"; then bad "skips what only frees memory"; else good; fi

claim "a random fault is given only to tests that run its line"
rm "$tree"/src/run/* "$tree"/tests/run/*
cat >"$tree/src/run/d.c" <<'END'
int f(int a);
int g(int a);
int f(int a)
{
    return a + 3;
}
int g(int a)
{
    return a - 4;
}
END
for name in f g; do
    printf 'int %s(int a);\nint main(void) { return %s(9) / 100; }\n' $name $name >"$tree/tests/run/test_$name.c"
done
printf 'int g(int a);\nint main(void) { return g(9) != 5; }\n' >"$tree/tests/run/test_exact.c"
cat >"$tree/Makefile" <<'END'
all:
	@:
$(OUT)/tests/run/%: tests/run/%.c src/run/d.c
	@mkdir -p $(OUT)/run $(OUT)/tests/run
	@$(CC) $(CFLAGS) -c -o $(OUT)/run/d.o src/run/d.c
	@$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $< $(OUT)/run/d.o
SANITIZE_BUT = ^test_none
ifeq ($(CONFIG),sanitize)
CFLAGS += -fsanitize=address
LDFLAGS += -fsanitize=address
endif
END
run 0 --random 60 --seed 3 --only 'src/run' --limit 2
says "survived  src/run/d.c:5: return a + 3;  ->  return a - 3;: 1 of 3 tests run its line"
says "caught    src/run/d.c:9: return a - 4;  ->  return a + 4;: by test_exact"
says "| \`src/run\` |"

claim "a test that fails because lines are counted is used without its counts"
# shellcheck disable=SC2016 # expanded by the test
script run/test_uncounted.sh 'case ${CFLAGS-} in *coverage*) exit 1 ;; esac' 'grep -q "a + 3" src/run/d.c'
run 0 --random 60 --seed 3 --only 'return a - 3' --limit 2 --fresh
says "caught    src/run/d.c:5: return a + 3;  ->  return a - 3;: by test_uncounted.sh"
rm "$tree/tests/run/test_uncounted.sh"

claim "--others gives survivors to quick tests of other rooms, --sanitize to the sanitizers"
script base/test_text.sh 'grep -q "a + 3" src/run/d.c'
run 0 --random 60 --seed 3 --only 'return a - 3' --limit 2 --fresh --others 30
says "caught    src/run/d.c:5: return a + 3;  ->  return a - 3;: by test_text.sh"
rm "$tree"/tests/base/test_text.sh "$tree"/tests/run/*
cat >"$tree/src/run/d.c" <<'END'
#include <stdlib.h>
int f(int a);
int f(int a)
{
    char *room = malloc(16);
    for (int i = 0; i < 16; i++) room[i] = 1;
    free(room);
    return a;
}
END
cat >"$tree/tests/run/test_f.c" <<'END'
#include <stdio.h>
int f(int a);
int main(void)
{
    int status = f(0);
    puts("[  PASSED  ] 1 test(s)."); // as cmocka does, for tests/runner
    return status;
}
END
cp tests/runner "$tree/tests/"
run 0 --random 60 --seed 3 --only 'i <= 16' --limit 2; says "survived  src/run/d.c:6"
run 0 --random 60 --seed 3 --only 'i <= 16' --limit 2 --fresh --sanitize
says "caught    src/run/d.c:6: for (int i = 0; i < 16; i++) room[i] = 1;  ->  for (int i = 0; i <= 16; i++) room[i] = 1;: by test_f: with the sanitizers"
says "of them only with the sanitizers"
rm -r "$tree/src/run" "$tree/tests/run"

claim "wrong options"
run 2 --random 3 --only '('; says "expected a regular expression"
run 2 --random 3 --jobs 0
run 2; says "--random"
run 3 --random 9 --only nothing; says "nothing: no fault contains this text"
finish
