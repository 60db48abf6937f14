#!/bin/sh
# SPDX-License-Identifier: MIT
# Builds the examples of examples/library against the library and runs them.
. tests/support/claims.sh
if grep -q fsanitize "$bin/flags"; then echo "a sanitizer's library needs a sanitizer's programs: skipped"; exit 77; fi
LD_LIBRARY_PATH=$(realpath "$bin/lib")
export LD_LIBRARY_PATH

for name in game_loop grooms regression; do
    claim "$name.c is a program of less than 100 lines, without warnings"
    # shellcheck disable=SC2046 # words
    holds cc -Wall -Wextra -Werror -o "$work/$name" "examples/library/$name.c" -Isrc/library -L"$bin/lib" -ltractrix \
        $(pkg-config --libs epoxy egl) -lm
    holds test "$(wc -l <"examples/library/$name.c")" -lt 100
done

claim "the game's loop draws hair in the host's context"
holds "$work/game_loop" assets/fur.tfx "$work/game.png"
silent out; silent err
is_png "$work/game.png"
# More than the background alone: PNG compresses an even picture to a few kB.
holds test "$(wc -c <"$work/game.png")" -gt 8000

claim "the same in the context of a window, by GLX"
if pkg-config --exists glfw3 && command -v xvfb-run >/dev/null; then
    # shellcheck disable=SC2046 # words
    holds cc -DWINDOW -Wall -Wextra -Werror -o "$work/game_window" examples/library/game_loop.c -Isrc/library -L"$bin/lib" -ltractrix \
        $(pkg-config --libs epoxy glfw3) -lm
    holds xvfb-run -a "$work/game_window" assets/fur.tfx "$work/window.png"
    same_images "$work/game.png" "$work/window.png"
else
    skip "no GLFW or no Xvfb"
fi

claim "grooms are one array of the expected size and a picture each"
mkdir "$work/data"
holds "$work/grooms" "$work/data" 2
silent out; silent err
is_png "$work/data/groom_0000.png"; is_png "$work/data/groom_0001.png"
holds test "$(wc -c <"$work/data/positions.npy")" = $((128 + 2 * 600 * 16 * 16))
if /usr/bin/python3 -c 'import numpy' 2>/dev/null; then
    holds /usr/bin/python3 -c "
import numpy
a = numpy.load('$work/data/positions.npy')
assert a.shape == (2, 600, 16, 4) and numpy.isfinite(a).all() and (a[..., 3] == 1).all()
assert abs(numpy.linalg.norm(a[0, :, 0, :3], axis=1) - 0.1).max() < 1e-6"
else
    skip "no numpy"
fi

claim "the regression test tells equal pictures from others"
run_render() { holds "$bin/tractrix-render" "$@"; }
printf '{"sections": [{"file": "%s/assets/curls.tfx"}], "look": "plain", "followers": 0, "frames": 1}' "$PWD" >"$work/scene.json"
run_render "$work/scene.json" --size 96x72 -q -o "$work/golden.png"
program=$work/regression
run 0 "$work/scene.json" "$work/golden.png" "$work/new.png"
says "same: RMSE 0 levels"; none "$work/new.png"
run 1 assets/fur.tfx "$work/golden.png" "$work/new.png"
says "different: "; is_png "$work/new.png"
run 2 assets/none.tfx "$work/golden.png" "$work/other.png"
says "regression: assets/none.tfx: "; one_line
finish
