#!/bin/sh
# SPDX-License-Identifier: MIT
# Goldens by platform: where they are looked for, their limits, what --update writes and removes, and that a GPU's image
# is never silently compared with a CPU's.
. tests/support/claims.sh
unset CI_PROJECT_DIR GITHUB_WORKSPACE GITHUB_STEP_SUMMARY JENKINS_URL TRACTRIX_ASSUME
program=$(realpath "$bin")/tractrix-compare
render=$(realpath "$bin")/tractrix-render
platform=llvmpipe-mesa22.3-llvm15-256-fma-x86_64 other=llvmpipe-mesa24.2-llvm19-128-x86_64

# plain COUNT: pixels of 0.5, as escapes of printf.
plain() { printf "%$1s" | sed 's/ /\\0\\0\\0\\077/g'; }
# grey FILE LEVEL: a PFM of 16 x 16 pixels in one grey, 0.5 of the light; one pixel is brighter by LEVEL levels.
grey() {
    case $2 in 0) bits='\0\0\0\077' ;; 1) bits='\067\211\001\077' ;; 5) bits='\024\256\007\077' ;; 20) bits='\122\270\036\077' ;; esac
    mkdir -p "$(dirname "$1")"
    env printf "Pf\\n16 16\\n-1.0\\n$(plain 120)$bits$(plain 135)" >"$1"
}
g=$work/goldens new=$work/new
# compare STATUS OPTION...
compare() {
    expected=$1; shift
    run "$expected" "$g" "$new" "$@"
}

claim "the name says what draws, and other instructions are another platform"
name=$("$render" --platform)
case $name in
llvmpipe-*)
    if [ "$(echo "$name" | grep -cE '^llvmpipe-mesa[0-9]+\.[0-9]+-llvm[0-9]+-[0-9]+(-fma)?-[a-z0-9_]+$')" = 1 ]; then good; else bad "$name"; fi
    if [ "$(LP_NATIVE_VECTOR_WIDTH=128 "$render" --platform)" != "$(LP_NATIVE_VECTOR_WIDTH=256 "$render" --platform)" ]; then good; else bad "128 and 256 bits: one name"; fi
    case $(GALLIUM_OVERRIDE_CPU_CAPS=sse2 "$render" --platform) in *-fma-*) bad "FMA with SSE2" ;; *) good ;; esac
    case $(TRACTRIX_ASSUME=hardware "$render" --platform) in gpu-llvmpipe-*) good ;; *) bad "assumed hardware is no GPU" ;; esac
    ;;
*) skip "not on llvmpipe: $name" ;;
esac

claim "without goldens of its own a platform has those of its class, then those of all, each with its limits"
for level in 0 1 5 20; do grey "$new/x_$level.pfm" $level; grey "$g/x_$level.pfm" 0; done
compare 1 --platform $platform --json "$work/report.json"
says "x_5.pfm: within limits"; says "golden: $g/x_5.pfm (common)"; says "x_20.pfm: different"; says "4 images: 1 same, 2 within limits, 1 different"
in_file "$work/report.json" '"level": "common"'; in_file "$work/report.json" '"max_failing_percent": 0.1'
for level in 1 5; do grey "$g/cpu/x_$level.pfm" 0; done
compare 1 --platform $platform; says "x_1.pfm: within limits"; says "golden: $g/cpu/x_1.pfm (class)"; says "x_5.pfm: different"; says "4 images: 1 same, 1 within limits, 2 different"
grey "$g/$platform/x_1.pfm" 0; grey "$g/$other/x_0.pfm" 20
compare 1 --platform $platform; says "x_1.pfm: different"; says "golden: $g/$platform/x_1.pfm (platform)"; says "x_0.pfm: same"; says "4 images: 1 same, 3 different"
compare 1 --platform $other; says "x_0.pfm: different"; says "x_1.pfm: within limits"

claim "limits that are given hold at each level, unless a level has its own"
compare 0 --platform $platform --pixel-tolerance 30
compare 1 --platform $platform --pixel-tolerance 0; says "4 images: 1 same, 3 different"
compare 1 --platform $platform --class-limits 6,0; says "x_5.pfm: within limits"; says "x_1.pfm: different"
compare 1 --platform $platform --pixel-tolerance 0 --common-limits 30,0%; says "x_20.pfm: within limits"; says "x_5.pfm: different"
for wrong in 2 "2," ",1" 300,1 2,1.5 2,101%; do compare 2 --platform $platform --class-limits $wrong; one_line; says "--class-limits: got '"; done

claim "a GPU's images are not compared with a CPU's unless that is asked for"
compare 1 --platform nvidia-h100-550
says "x_0.pfm: new: no $g/nvidia/x_0.pfm; images of GPUs are compared with the golden for all platforms only if --any-platform is given"; says "4 images: 4 new"
compare 1 --platform nvidia-h100-550 --any-platform; says "golden: $g/x_0.pfm (common)"; says "1 same, 2 within limits, 1 different"
grey "$g/nvidia/x_1.pfm" 0
compare 1 --platform nvidia-a100-535; says "golden: $g/nvidia/x_1.pfm (class)"; says "4 images: 1 within limits, 3 new"
compare 1 --platform amd-radeon-rx-6800-mesa23.2; says "4 images: 4 new"
compare 1 --platform power-vr-1.17; says "no $g/gpu/x_0.pfm"

claim "--update writes the golden in use; new ones are of all platforms for CPUs, of the class for GPUs"
rm -r "$g"; grey "$g/x_1.pfm" 20; grey "$g/cpu/x_5.pfm" 20
compare 0 --platform $platform --update; equal "$g/x_1.pfm" "$new/x_1.pfm"; equal "$g/cpu/x_5.pfm" "$new/x_5.pfm"; equal "$g/x_20.pfm" "$new/x_20.pfm"; none "$g/$platform"
compare 0 --platform $platform --pixel-tolerance 0
compare 0 --platform nvidia-h100-550 --update; equal "$g/nvidia/x_20.pfm" "$new/x_20.pfm"

claim "--update --level writes that level, where its fallback is not equal"
compare 0 --platform $other --update --level platform; says "needs no golden of its own, because $g/x_1.pfm is equal"; none "$g/$other"
grey "$new/x_1.pfm" 5
compare 0 --platform $other --update --level platform; equal "$g/$other/x_1.pfm" "$new/x_1.pfm"; none "$g/$other/x_0.pfm"
says "4 references updated"
compare 0 --platform $other --pixel-tolerance 0; says "golden: $g/$other/x_1.pfm (platform)"

claim "--update drops a golden that has become equal to its fallback"
grey "$new/x_1.pfm" 1
compare 1 --platform $other; says "x_1.pfm: different"
compare 0 --platform $other --update --json "$work/report.json"; says "x_1.pfm: different"; says "needs no golden of its own, because $g/x_1.pfm is equal"; none "$g/$other/x_1.pfm"
in_file "$work/report.json" "\"left_to\": \"$g/x_1.pfm\""
compare 0 --platform $other --pixel-tolerance 0
cp "$g/x_1.pfm" "$g/cpu/x_1.pfm"
compare 0 --platform $other --update; says "x_1.pfm: same"; none "$g/cpu/x_1.pfm"; is_file "$g/x_1.pfm"
compare 0 --platform $other; cp "$g/x_1.pfm" "$g/nvidia/x_1.pfm"
compare 0 --platform nvidia-h100-550 --update; is_file "$g/nvidia/x_1.pfm" # the golden for all platforms does not apply to a GPU

claim "what a run on a GPU draws goes to a folder of its own, though the CPU's goldens are there"
printf 'plain assets/curls.tfx --algo none --followers 0 --look plain --size 48x36 --frames 1\n' >"$work/list"
TRACTRIX_BIN=$(realpath "$bin"); export TRACTRIX_BIN
program=scripts/compare-goldens; rm -r "$g"
run 0 "$work/list" "$g" "$work/out_" --update; is_file "$g/plain.png"
TRACTRIX_ASSUME=hardware; export TRACTRIX_ASSUME
run 1 "$work/list" "$g" "$work/out_"; says "only if --any-platform is given"
run 0 "$work/list" "$g" "$work/out_" --update; is_file "$g/gpu/plain.png"
run 0 "$work/list" "$g" "$work/out_"; says "golden: $g/gpu/plain.png (class)"
unset TRACTRIX_ASSUME
run 0 "$work/list" "$g" "$work/out_"; says "golden: $g/plain.png (common)"
run 0 "$work/list" "$g" "$work/out_" --platform nvidia-x --any-platform; says "(common)"
program=$(realpath "$bin")/tractrix-compare

claim "wrong usage is status 2 and one line"
for option in --any-platform "--level class --update" "--class-limits 2,1" "--common-limits 2,1"; do
    # shellcheck disable=SC2086
    compare 2 $option; one_line; says "expected --platform NAME"
done
compare 2 --platform $platform --level class; one_line; says "expected --update"
compare 2 --platform nvidia-h100-550 --level common --update; one_line; says "are not compared with goldens for all platforms"
for wrong in cpu ../x a/b .x 'A b'; do compare 2 --platform "$wrong"; one_line; says "expected the output of tractrix-render --platform"; done
run 2 "$new/x_1.pfm" "$new/x_1.pfm" --platform $platform; one_line; says "expected two folders"

finish
