#!/bin/sh
# SPDX-License-Identifier: MIT
# Bodies that deform, in whole runs of tractrix-render.
. tests/support/claims.sh
program=$bin/tractrix-render
hair=assets/demo.tfx

# The bundled head as ten samples: it turns on its neck, and the chin drops.
sample() {
    awk -v t="$1" '/^v / { s = ($3 + 0.3) / 0.3; if (s < 0) s = 0; if (s > 1) s = 1
            a = 0.5 * t * s * s * (3 - 2 * s); c = cos(a); d = sin(a)
            y = $3; if ($4 > 0.05 && $3 < -0.05) y -= 0.02 * t
            printf "v %.7g %.7g %.7g\n", c * $2 + d * $4, y, c * $4 - d * $2; next } { print }' assets/head.obj
}
for i in 0 1 2 3 4 5 6 7 8 9; do sample "0.$i" >"$work/head_$i.obj"; done
scene="$hair --look plain --followers 1 --algo chain --sdf-resolution 32 --size 48x32 --frames 8 --fps 24 --mesh $work/head_%d.obj"

claim "runs, caches, parts and resumed runs of a body give the same pictures; the body moves"
# shellcheck disable=SC2086
{
run 0 $scene -q --cache "$work/a.cache" -o "$work/direct/"
run 0 $scene -q --from-cache "$work/a.cache" -o "$work/played/"
run 0 $scene -q --part 1/2 -o "$work/farm/"
run 0 $scene -q --part 2/2 -o "$work/farm/"
run 0 $scene -q --last 4 -o "$work/resumed/"
run 0 $scene -q --resume -o "$work/resumed/"
}
for other in played farm resumed; do
    if diff -r "$work/direct" "$work/$other" >"$work/err"; then good; else bad "$other differs"; fi
done
if cmp -s "$work/direct/frame_0000.png" "$work/direct/frame_0007.png"; then bad "nothing moves"; else good; fi

claim "a cache or an image of other samples is not this scene's"
sample 0.75 >"$work/head_9.obj" # beyond the last frame, which the camera frames
# shellcheck disable=SC2086
{
run 3 $scene -q --from-cache "$work/a.cache" -o "$work/x/"; one_line; says "body.checksum"
run 0 $scene --resume -o "$work/resumed/"; says "8 existing files will be written again"
run 3 $scene -q --from-cache "$work/a.cache" --mesh-motion linear -o "$work/x/"; one_line; says "body."
}

claim "what a body cannot be is refused by one line with file and sample"
rm "$work/head_3.obj"
# shellcheck disable=SC2086
{
run 3 $scene -q -o "$work/x/"; one_line; says "head_3.obj: missing: expected files for samples 0 to 9 without gaps"

claim "numbers may begin anywhere, and a far one is a gap at once; a mesh that stands still may come through a pipe"
mkdir "$work/far"
cp assets/ball.obj "$work/far/x_20240101.obj"
run 0 assets/curls.tfx --mesh "$work/far/x_%d.obj" --look plain --followers 0 --frames 1 --size 32x24 -q -o "$work/far.png"
cp assets/ball.obj "$work/far/x_999999999.obj"
run 3 assets/curls.tfx --mesh "$work/far/x_%d.obj" --look plain --followers 0 --frames 1 --size 32x24 -q -o "$work/far.png"; one_line
says "x_20240102.obj: missing: expected files for samples 20240101 to 999999999 without gaps"
# shellcheck disable=SC2002 # the test needs a pipe
cat assets/ball.obj | "$program" assets/curls.tfx --mesh /dev/stdin --look plain --followers 0 --frames 1 --size 32x24 -q -o "$work/piped.png" 2>"$work/err"
run 0 assets/curls.tfx --mesh assets/ball.obj --look plain --followers 0 --frames 1 --size 32x24 -q -o "$work/named.png"
same_images "$work/piped.png" "$work/named.png"
sed 's/^f .*/f 1 2 3/;3q' assets/head.obj >"$work/head_3.obj"; echo "f 1 2 2" >>"$work/head_3.obj"
run 3 $scene -q -o "$work/x/"; one_line; says "head_3.obj: 2 vertices: expected 6002"
sample 0.3 | sed '2s/.*/v 0 nan 0/' >"$work/head_3.obj"
run 3 $scene -q -o "$work/x/"; one_line; says "head_3.obj:2:"
sample 0.3 >"$work/head_3.obj"
run 3 $scene -q --mesh-unit 10 -o "$work/x/"; one_line; says "check --mesh-unit, --mesh-up and --mesh-rest"
run 2 $hair -q --mesh assets/head.obj --mesh-fps 12 -o "$work/x/"; one_line; says "--mesh does not deform"
}

claim "a stiff sequence of one sample is a mesh"
cp assets/head.obj "$work/one_0.obj"
still="$hair --look plain --frames 1 --size 48x32"
# shellcheck disable=SC2086
{
run 0 $still -q --mesh "$work/one_%d.obj" -o "$work/one.png"
run 0 $still -q --mesh assets/head.obj -o "$work/plain.png"
}
same_images "$work/one.png" "$work/plain.png"
finish
