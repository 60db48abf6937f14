#!/bin/sh
# SPDX-License-Identifier: MIT
# scripts/gpu-report with the CPU driver: its page and its JSON have the measurements, and the failures.
. tests/support/claims.sh
if ! command -v python3 >/dev/null; then skip 'no python3'; finish; fi
if ! has_driver llvmpipe; then skip 'no CPU driver'; finish; fi
program=scripts/gpu-report

# The programs, with a wrapper that draws simple images.
mkdir "$work/bin"
ln -s "$(realpath "$bin")"/* "$work/bin/"
rm "$work/bin/tractrix-render"
printf '#!/bin/sh\nexec "%s" "$@" --look plain --followers 0 --preroll 0 --smooth 1\n' "$(realpath "$bin")/tractrix-render" >"$work/bin/tractrix-render"
chmod +x "$work/bin/tractrix-render"
measure() { status=$1; shift; run "$status" --programs "$work/bin" -o "$work/report" --size 48x36 --scenes '^curls' --tests gpu_dispatch --sets 1k16 "$@"; }

# shellcheck disable=SC2317 # holds calls it
# known EXPRESSION: evaluates it in Python; `k` is the report.
known() { python3 -c "import json; k = json.load(open('$work/report/gpu-report.json')); assert $1, k"; }

claim "images by three rasterisers, their differences, solvers and tests"
measure 0 --software --minutes=10
holds known "[i['raster'] for i in k['images']] == ['blocks', 'compute', 'quads']"
holds known "all(i['draw_ms']['least'] > 0 and i['passes_ms'] and i['peak_memory_mib'] > 1 for i in k['images'])"
holds known "all(0 < i['against_blocks']['rmse'] < 10 for i in k['images'][1:])"
holds known "len(k['solvers']) >= 8 and all(s['step_ms']['least'] > 0 for s in k['solvers'])"
holds known "k['tests']['passed'] > 0 and k['tests']['failed'] == 0 and k['device']['software']"
holds test "$(grep -o '<img alt="curls_[a-z]*" src="data:image/png;base64,' "$work/report/gpu-report.html" | wc -l)" = 3

claim "what fails stands in the report"
printf '#!/bin/sh\ncase "$*" in *"--raster compute"*) echo "tractrix-render: no such luck" >&2; exit 1 ;; esac\nexec "%s" "$@" --look plain --followers 0 --preroll 0\n' "$(realpath "$bin")/tractrix-render" >"$work/bin/tractrix-render"
measure 1 --software --minutes=10
holds known "[i.get('failed', '') for i in k['images']] == ['', 'failed with status 1: tractrix-render: no such luck', '']"

claim "what there is no time for is named"
measure 0 --software --minutes=0
holds known "all('no time' in s['outcome'] for s in k['steps']) and k['images'] == []"

claim "a build that fails or takes too long stands in the report"
mkdir "$work/stubs"
printf '#!/bin/sh\necho "cc: no such compiler"\nexit 2\n' >"$work/stubs/make"
chmod +x "$work/stubs/make"
PATH=$work/stubs:$PATH run 1 --software -o "$work/report"
holds known "[s['outcome'] for s in k['steps']] == ['failed with status 2: cc: no such compiler'] and k['images'] == []"
printf '#!/bin/sh\nsleep 60\n' >"$work/stubs/make"
PATH=$work/stubs:$PATH run 0 --software -o "$work/report" --minutes 0.01
holds known "[s['outcome'] for s in k['steps']] == ['left out: no time was left']"

claim "programs that are not there are named"
run 4 --software -o "$work/report" --programs "$work/stubs"
says "tractrix-render"; one_line

claim "without a GPU nothing is measured"
TRACTRIX_ASSUME='' measure 4 --minutes=1 --device=
says 'no GPU to measure'
finish
