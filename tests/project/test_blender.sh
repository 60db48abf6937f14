#!/bin/sh
# SPDX-License-Identifier: MIT
# scripts/blender_hair.py in Blender: strands in both directions, particle hair, an Alembic groom through a simulation
# and back, the head, camera and lights, the add-on, errors. One Blender process runs all steps (blender_steps.py).
. tests/support/claims.sh
program=${BLENDER:-blender}
if ! command -v "$program" >/dev/null; then
    echo "skipped: no blender (scripts/setup blender installs it)"
    exit 77
fi
if ! "$program" -b --factory-startup --python-exit-code 9 --python-expr 'import numpy' >"$work/out" 2>"$work/err" </dev/null; then
    echo "skipped: blender does not start, or its Python has no numpy"
    exit 77
fi
export BLENDER_USER_SCRIPTS="$work/scripts" BLENDER_USER_CONFIG="$work/config"
# hair STATUS ARGUMENT...: checks the script's exit status; removes Blender's own lines from standard output.
hair() {
    status=$1; shift
    run "$status" -b --factory-startup --python scripts/blender_hair.py -- "$@"
}

claim "every step in Blender"
"$program" -b --factory-startup --python tests/project/blender_steps.py -- "$bin" "$work" >"$work/steps" 2>&1 </dev/null
counts=$(grep -E '^[0-9]+ passed, [0-9]+ failed, [0-9]+ skipped$' "$work/steps")
if [ -z "$counts" ]; then
    tail -n 20 "$work/steps"
    bad "Blender ended before the steps did"
else
    sed -n '/^FAILED: /,/^[^ ]/p; /^skipped: /p; /^round trip: /p; /^rigid head: /p; /^camera, /p' "$work/steps"
    # shellcheck disable=SC2086 # six words
    set -- $counts
    passed=$((passed + $1)) failed=$((failed + $3)) skipped=$((skipped + $5))
fi

claim "the command line's statuses and lines"
hair 3 export "$work/none.abc" -o "$work/x.npz"; one_line; says "no such file"
hair 3 import assets/fur.tfx --scene "$work/none.json" -o "$work/x.blend"; one_line; says "none.json: No such file or directory: expected a scene file"
hair 0 import --help; says "usage: blender_hair import"
finish
