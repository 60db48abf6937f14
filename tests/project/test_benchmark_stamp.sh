#!/bin/sh
# SPDX-License-Identifier: MIT
# scripts/benchmark-stamp on a copy of the solvers: it notices figures that are older than the solvers or the defaults.
# It ignores comments, help texts and drawing, and accepts a stated reason.
# shellcheck disable=SC2016 # $ of sed
. tests/support/claims.sh
program=scripts/benchmark-stamp
export TREE="$work/tree"
stamp=$TREE/docs/benchmarks/stamp.txt
mkdir -p "$TREE/glsl" "$TREE/src/base" "$TREE/docs/benchmarks"
cp -r glsl/sim glsl/common "$TREE/glsl"
cp -r src/sim "$TREE/src"
cp src/base/params.def "$TREE/src/base"

# change FILE SED: edits the file of the copy; the test fails if the pattern matches nothing.
change() {
    cp "$TREE/$1" "$work/before"
    sed -i "$2" "$TREE/$1"
    if cmp -s "$work/before" "$TREE/$1"; then bad "sed does not change $1: $2"; fi
}
back() { cp "$work/before" "$TREE/$1"; }
# stale FILE SED: the check must fail after this change, and pass once it is undone.
stale() {
    change "$1" "$2"
    run 1 check; says "solvers or defaults changed since the figures of docs/benchmarks.md (on 2026-11-25 at commit abc)"; silent out
    back "$1"
    run 0 check
}
fresh() {
    change "$1" "$2"
    run 0 check; says "the figures are those of these solvers"
    back "$1"
}

claim "without a stamp the check says that it is skipped"
run 0 check; says "benchmarks: not stamped: skipped"

claim "a stamp of these sources holds"
run 0 hash
echo "measured $(cat "$work/out") on 2026-11-25 at commit abc" >"$stamp"
run 0 check; says "the figures are those of these solvers"

claim "a shader, a header, a solver in C or a default that changed is noticed"
stale glsl/sim/dftl.comp '$s/$/int another;/'
stale glsl/common/rigid.glsl '$s/$/int another;/'
stale src/sim/step_sizes.c '$s/$/int another;/'
stale src/base/params.def 's/ftl_damping, 0, "[0-9.]*"/ftl_damping, 0, "0.123"/'
stale src/base/params.def 's/gravity, 0, "0,-9.81,0"/gravity, 0, "0,-9.8,0"/'

claim "a file that is new or gone is noticed"
echo 'void another(void);' >"$TREE/src/sim/another.h"
run 1 check
rm "$TREE/src/sim/another.h"
mv "$TREE/glsl/sim/dftl.comp" "$work"
run 1 check
mv "$work/dftl.comp" "$TREE/glsl/sim"
run 0 check

claim "comments, white space, help texts and defaults of drawing do not count"
fresh glsl/sim/dftl.comp '$s,$, // a comment,'
fresh src/sim/solver_dftl.c 's/^    /        /'
fresh src/base/params.def 's/^      "[a-z]/&x/'
fresh src/base/params.def 's/specular1, 0, "[0-9.]*"/specular1, 0, "0.123"/'

claim "a change that leaves the figures alone is written down with its reason"
change glsl/sim/dftl.comp '$s/$/int another;/'
run 2 same; one_line
run 1 check
run 0 same "a variable that nothing reads"
run 0 check
in_file "$stamp" "a variable that nothing reads"

claim "wrong usage"
run 2; one_line
run 2 verify; one_line
rm "$stamp"
run 1 same "a reason"; says "run scripts/update-benchmarks first"; one_line
finish
