#!/bin/sh
# SPDX-License-Identifier: MIT
# Several bodies in one scene, through whole runs of tractrix-render.
. tests/support/claims.sh
program=$bin/tractrix-render

# A ball that swells over two samples, and a bigger one that turns and carries a collider.
awk '/^v / { printf "v %.7g %.7g %.7g\n", 1.05 * $2 + 0.01, 1.1 * $3, $4; next } { print }' assets/ball.obj >"$work/ball_1.obj"
cp assets/ball.obj "$work/ball_0.obj"
cp assets/ball.obj assets/curls.tfx "$work/"
one='"mesh": "ball_%d.obj", "sections": [{"file": "curls.tfx", "algo": "split", "followers": 1, "color": "#a03010"}]'
two='"mesh": "big.obj", "head": {"translate": [0.3, "0.05*sin(20*t)", 0], "rotate": [0, "200*t", 0]},
     "colliders": [{"sphere": [0, -0.15, 0.1, 0.05]}], "sections": [{"file": "curls.tfx", "algo": "chain", "followers": 1, "color": "#1030a0"}]'
awk '/^v / { printf "v %.7g %.7g %.7g\n", 1.2 * $2, 1.2 * $3, 1.2 * $4; next } { print }' assets/ball.obj >"$work/big.obj"
run='"frames": 4, "fps": 24, "sim_rate": 60, "size": "48x32", "look": "plain", "floor": "plane", "scalp_tint": 0.8, "mesh_fps": 24, "sdf_resolution": 16, "sdf_cache": false'
echo "{$run, $one}" >"$work/one.json"
echo "{$run, $two}" >"$work/two.json"
echo "{$run, \"bodies\": [{$one}, {$two}]}" >"$work/both.json"
echo "{$run, \"bodies\": [{$one}]}" >"$work/listed.json"
echo "{$run, \"bodies\": [{$two}, {$one}]}" >"$work/swapped.json"
both="$work/both.json"
hair='"sections": [{"file": "curls.tfx"}]'

claim "a list of one body is the scene without a list"
run 0 "$work/one.json" -q -o "$work/one/"
run 0 "$work/listed.json" -q -o "$work/listed/"
if diff -r "$work/one" "$work/listed" >"$work/err"; then good; else bad "they differ"; fi

claim "hair of two bodies is exported as that of two scenes"
run 0 "$both" -q -o "$work/direct/" --export "$work/both_%d.obj" --export-followers
run 0 "$work/one.json" -q --export "$work/first_%d.obj" --export-followers
run 0 "$work/two.json" -q --export "$work/second_%d.obj" --export-followers
for frame in 0 3; do
    grep '^v ' "$work/both_$frame.obj" >"$work/joined"
    cat "$work/first_$frame.obj" "$work/second_$frame.obj" | grep '^v ' >"$work/alone"
    if [ -s "$work/joined" ]; then good; else bad "no hair in frame $frame"; fi
    if cmp -s "$work/alone" "$work/joined"; then good; else bad "frame $frame differs"; fi
done

claim "caches, parts and resumed runs of two bodies give the same pictures; both move"
run 0 "$both" -q --cache "$work/a.cache"
run 0 "$both" -q --from-cache "$work/a.cache" -o "$work/played/"
run 0 "$both" -q --part 1/2 -o "$work/farm/"
run 0 "$both" -q --part 2/2 -o "$work/farm/"
run 0 "$both" -q --last 1 -o "$work/resumed/"
run 0 "$both" -q --resume -o "$work/resumed/"
for other in played farm resumed; do
    if diff -r "$work/direct" "$work/$other" >"$work/err"; then good; else bad "$other differs"; fi
done
if cmp -s "$work/direct/frame_0000.png" "$work/direct/frame_0003.png"; then bad "nothing moves"; else good; fi

claim "each body is drawn where it is, whichever stands first"
run 0 "$work/swapped.json" -q -o "$work/swapped/"
holds "$bin/tractrix-compare" -q "$work/direct/frame_0003.png" "$work/swapped/frame_0003.png" --pixel-tolerance 8 --max-failing-pixels 1%

claim "the numbers of strands that represent all of them are multiplied by the number of bodies"
curls=300 # strands in curls.tfx
lit='"frames": 1, "followers": 0, "size": "48x32", "raster": "blocks", "radius": 0.002'
echo "{$lit, \"bodies\": [{$hair}, {$hair, \"head\": {\"translate\": [0.3, 0, 0]}}]}" >"$work/lit.json"
same() { # A, B: images with the same pixels
    "$bin/tractrix-compare" -q "$work/$1.png" "$work/$2.png" --pixel-tolerance 0 >"$work/out" 2>&1
}
run 0 "$work/lit.json" -q --scatter-strands 0 --shadow-strands 0 -o "$work/all.png"
for option in --scatter-strands --shadow-strands; do
    run 0 "$work/lit.json" -q --scatter-strands 0 --shadow-strands 0 $option "$curls" -o "$work/most.png"
    if same all most; then good; else bad "$option $curls leaves strands out"; fi
    run 0 "$work/lit.json" -q --scatter-strands 0 --shadow-strands 0 $option $((curls / 2)) -o "$work/half.png"
    if same all half; then bad "$option: half of the strands, and no difference"; else good; fi
done

claim "another name of a body's mesh does not matter to the cache, its content and its motion do"
cp "$work/big.obj" "$work/renamed.obj"
sed 's/big.obj/renamed.obj/' "$both" >"$work/other.json"
run 0 "$work/other.json" -q --from-cache "$work/a.cache" -o "$work/renamed/"
if diff -r "$work/direct" "$work/renamed" >"$work/err"; then good; else bad "they differ"; fi
sed 's/200\*t/190*t/' "$both" >"$work/other.json"
run 3 "$work/other.json" -q --from-cache "$work/a.cache" -o "$work/x/"; one_line; says "bodies[1].head"
awk '/^v / { printf "v %.7g %.7g %.7g\n", 1.2 * $2, 1.2 * $3 + 0.001, 1.2 * $4; next } { print }' assets/ball.obj >"$work/big.obj"
run 3 "$both" -q --from-cache "$work/a.cache" -o "$work/x/"; one_line; says "bodies[1].mesh_checksum"

claim "what a list of bodies cannot be is refused by one line with the place"
refused() { # JSON, expected
    echo "$1" >"$work/bad.json"
    run 3 "$work/bad.json" -q -o "$work/x/"; one_line; says "$2"
}
refused '{"bodies": []}' "bodies: got [], expected an array of 1 to 16 bodies"
refused "{\"bodies\": [{$hair}], $hair}" "'sections' beside 'bodies': expected this key in a body"
refused "{\"bodies\": [{$hair}], \"head\": {\"translate\": [1, 0, 0]}}" "'head' beside 'bodies': expected this key in a body"
refused '{"bodies": [{"mesh": "ball.obj"}]}' "bodies[0]: expected a key 'sections'"
refused "{\"bodies\": [{$hair}, {$hair, \"fps\": 3}]}" "bodies[1]: 'fps' belongs to the top level, not to a body"
refused "{\"bodies\": [{$hair, \"style\": 3}]}" "bodies[0]: 'style' belongs to the top level or to a section, not to a body"
refused '{"bodies": [{"sections": [{"file": "curls.tfx", "mesh": "ball.obj"}]}]}' "bodies[0].sections[0]: 'mesh' belongs to the top level or to a body, not to a section"
refused "{\"bodies\": [{$hair}, {$hair, \"head\": {\"translate\": [\"1/t\", 0, 0]}}]}" "bodies[1].head."
refused "{\"bodies\": [{$hair, \"mesh\": \"none.obj\"}]}" "none.obj"
refused "{\"bodies\": [{$hair, \"head\": {\"translate\": [\"1/t\", 0, 0]}}]}" "bodies[0].head."
refused '{"bodies": [{"sections": [{"file": "curls.tfx", "drag": {"formula": "1/t"}}]}]}' "bodies[0].sections[0].drag"

claim "a body without a mesh is told which head it gets"
echo "{\"look\": \"plain\", \"scalp\": \"auto\", \"frames\": 1, \"size\": \"32x24\", \"bodies\": [{$hair}, {$hair, \"mesh\": \"ball.obj\"}]}" >"$work/bald.json"
run 0 "$work/bald.json" -o "$work/bald.png"; says "bodies[0]: scalp: guessed a head of"

claim "keys of a body that have no effect are named, shared keys only if they have none in any body"
echo "{\"look\": \"plain\", \"frames\": 1, \"size\": \"32x24\", \"bodies\": [{$hair, \"mesh\": \"ball.obj\"}, {$hair, \"mesh\": \"ball.obj\", \"mesh_fps\": 12}]}" >"$work/idle.json"
run 0 "$work/idle.json" -o "$work/idle.png"; says "idle.json: bodies[1].mesh_fps: has no effect: --mesh does not deform"
echo "{\"look\": \"plain\", \"frames\": 1, \"size\": \"32x24\", \"mesh_fps\": 12, \"bodies\": [{$hair, \"mesh\": \"ball.obj\"}]}" >"$work/idle.json"
run 0 "$work/idle.json" -o "$work/idle.png"; says "idle.json: mesh_fps: has no effect: --mesh does not deform"
run 0 "$both" --last 0 -o "$work/idle/"; if grep -q mesh_fps "$work/err"; then bad "warns"; else good; fi
finish
