#!/bin/sh
# SPDX-License-Identifier: MIT
# scripts/gpu-statistics on made-up shaders: one that fits, one that needs scratch memory, one with few waves, one that
# is not GLSL; and on a machine without the packages.
. tests/support/claims.sh
program=scripts/gpu-statistics
sources=$work/sources
mkdir "$sources"
# shader NAME STATEMENTS: a shader with these statements for a lane, which can fetch from `texels`.
shader() {
    cat >"$sources/$1.0123456789abcdef.comp" <<END
#version 430 core
#define IN_REGISTERS 1
#define VERTICES 7
#define LEAD 1
layout(local_size_x = 64) in;
layout(std430, binding = 3) buffer Words { float words[]; };
layout(binding = 2) uniform samplerBuffer texels;
void main()
{
    int lane = int(gl_GlobalInvocationID.x);
    $2
}
END
}
# wide COUNT: statements that need this many numbers at once, because each is scaled by the sum of all.
wide() {
    seq "$1" | sed 's/.*/float a& = texelFetch(texels, lane + 64 * &).x;/'
    printf 'float sum = 0.0'; seq "$1" | sed 's/^/ + a/' | tr -d '\n'; echo ';'
    seq "$1" | sed 's/.*/words[lane + 64 * &] = sum * a&;/'
}

claim "a shader that fits"
shader sim_small "$(wide 4)"
if FAMILIES=NAVI21 "$program" --sources "$sources" --csv "$work/rows.csv" >"$work/out" 2>"$work/err" </dev/null; then
    good
elif [ $? = 77 ]; then
    cat "$work/out"
    exit 77
else
    bad "status 1"
fi
says "sim/small                         8 registers        1"
says "0 of 1 variants break a rule"
in_file "$work/rows.csv" "sim/small,8,registers,NAVI21,"

export FAMILIES=NAVI21
claim "too few waves"
shader sim_wide "$(wide 150)"
run 1 --sources "$sources"
says "sim/wide, 8 vertices, NAVI21: "
says "waves: expected at least 8 (IN_REGISTERS=1 VERTICES=7 LEAD=1)"

claim "scratch memory"
rm "$sources"/sim_wide.*
shader sim_spills "$(wide 300)"
run 1 --sources "$sources"
says "sim/spills, 8 vertices, NAVI21: "
says "B of scratch memory: expected 0"
says "1 of 2 variants break a rule"

claim "a shader that is no GLSL"
rm "$sources"/sim_spills.*
shader sim_broken 'lane = texels;'
run 1 --sources "$sources"
says "gpu-statistics: refused: sim_broken.0123456789abcdef.comp: "

claim "no shaders"
rm "$sources"/*
run 1 --sources "$sources"
says "no *.comp: expected sources that TRACTRIX_GLSL_DUMP wrote"

claim "no packages"
mkdir "$work/bin"
for tool in bash dirname env; do ln -s "$(command -v $tool)" "$work/bin/$tool"; done
PATH=$work/bin run 77 --sources "$sources"
says "gpu-statistics: skipped: no glslangValidator (scripts/setup gpu installs it)"
FAMILIES=NOWHERE run 77 --sources "$sources"
says "gpu-statistics: skipped: Mesa has no NOWHERE to compile for"

claim "a wrong option"
run 2 --nonsense
says "no option '--nonsense'"
finish
