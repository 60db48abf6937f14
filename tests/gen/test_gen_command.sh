#!/bin/sh
# SPDX-License-Identifier: MIT
# The command line of tractrix-gen: hair, meshes, fur, messages.
. tests/support/claims.sh
program=$bin/tractrix-gen

# refused STATUS MESSAGE ARGUMENT...: the program prints one line with the message and writes nothing.
refused() {
    wanted=$1 message=$2; shift 2
    run "$wanted" "$@" -o "$work/none"; says "$message"; one_line
    none "$work/none"; rm -f "$work/none"
}

claim "the assets are what scripts/make-assets makes"
# Hair by the C library's sine and power may differ in the last bit elsewhere; fur does not use them.
holds scripts/make-assets "$bin" "$work"
for file in assets/*.tfx assets/*.obj; do
    if [ -e "$work/${file#assets/}" ]; then equal "$file" "$work/${file#assets/}"; else bad "does not make $file"; fi
done

claim "values are checked, and no option is ignored"
refused 2 "--kind: got 'crls', expected random, straight, curls or fur (nearest: curls)" --kind crls
refused 2 "--knid: no such option: did you mean '--kind'?" --knid curls
refused 2 "--count: got '0', expected a whole number from 1 to 10000000" --count 0
refused 2 "--curl-radius: has no effect: --kind is fur" --kind fur --curl-radius 0.01
refused 2 "65537 strands of 65535 vertices: expected fewer than 2^32 - 1 vertices in all" --count 65537 --vertices 65535
refused 2 "--set 1k16 and --kind: expected only one of them" --set 1k16 --kind random
refused 2 "--set 1k16 and --count: expected only one of them" --set 1k16 --count 5
refused 2 "x: got a file, expected only options" x
run 2; says "no output: expected -o FILE"
run 2 fur assets/ball.obj; says "no output: expected -o FILE"; one_line
run 3 fur assets/bob.tfx; says "bob.tfx: hair (TressFX 3 binary), not a mesh: expected a mesh"; one_line

claim "an image is no name for hair unless --format says so"
for image in x.png x.JPG x.exr x.mp4; do
    run 2 --count 5 -o "$work/$image"; says "$image: an image, not hair: expected a name ending in .usda, "; one_line
    run 2 fur assets/ball.obj -n 9 -o "$work/$image"; says "$image: an image, not hair"; one_line
    none "$work/$image"
done
run 0 --count 5 --format tfx4 -q -o "$work/hair.png"; run 0 --count 5 -q -o "$work/hair.dat"; equal "$work/hair.png" "$work/hair.dat"

claim "help and manual page"
run 0 --help; says "Usage: tractrix-gen"; says "Defaults. random: --shape sphere --count 1000"
run 0 --help=man; says ".TH TRACTRIX"
run 0 fur --help; says "--per-cm2"

claim "fur grows, the same from the same seed"
for i in 1 2; do run 0 fur assets/ball.obj -n 50 --seed 7 --comb 0,-1,0 -o "$work/fur$i.tfx"; done
says "50 strands of 16 vertices, 50 of them guides, TressFX 4 binary"
equal "$work/fur1.tfx" "$work/fur2.tfx"
run 0 fur assets/ball.obj -n 50 --seed 8 --comb 0,-1,0 -q -o "$work/fur2.tfx"
if [ -s "$work/out" ] || cmp -s "$work/fur1.tfx" "$work/fur2.tfx"; then bad "said something, or the seed does nothing"; else good; fi

claim "by area: one a cm2 on half the ball's 1257 cm2, within 2 %"
run 0 fur assets/ball.obj --per-cm2 1 --density 'y > 0' -o "$work/area.tfx"
count=$(sed -n 's/.*: \([0-9]*\) strands of.*/\1/p' "$work/out")
if [ "$count" -gt 615 ] && [ "$count" -lt 641 ]; then good; else bad "$count strands"; fi

claim "the suffix says the format, --format says otherwise"
for suffix in tfx hair obj usda data ply npz npy; do
    run 0 --count 5 --vertices 4 -q -o "$work/suffix.$suffix"
    run 0 fur assets/ball.obj -n 9 -q -o "$work/fur.$suffix"
    case $suffix in
    tfx) kind="TressFX 4 binary" ;; hair) kind="HAIR" ;; obj) kind="Wavefront" ;; usda) kind="USD" ;;
    data) kind="USC-HairSalon" ;; ply) kind="PLY" ;; npz) kind="(.npz)" ;; *) kind="(.npy)" ;;
    esac
    for name in suffix fur; do
        "$bin/tractrix-convert" "$work/$name.$suffix" >"$work/out" 2>"$work/err" </dev/null
        says "$kind"
    done
done
run 0 --count 5 --vertices 4 -o "$work/any.name"; says "TressFX 4 binary"
run 0 --count 5 --vertices 4 --format text -o "$work/text.hair"; says "TressFX 2 text"

claim "followers and thickness go where the format holds them"
run 0 fur assets/ball.obj -n 9 --followers 16 --format tfx3 -o "$work/f.tfx"
run 0 fur assets/ball.obj -n 9 --thickness 1e-4 --tip-thickness 0.1 --format hair -o "$work/f.hair"
refused 2 "--followers: the format of the output cannot store it: expected --format usda, abc, tfx3, text or npz" fur assets/ball.obj --followers 3
refused 2 "--thickness: the format of the output cannot store it: expected --format usda, abc, hair, ply, ply-text or npz" fur assets/ball.obj --thickness 1e-4

claim "the unit and the axis of the mesh count"
printf 'v 0 0 0\nv 100 0 0\nv 0 100 0\nf 1 2 3\n' >"$work/flat.obj"
run 0 fur "$work/flat.obj" -n 9 --unit 0.01 --up z --format text -o "$work/flat.tfx"
# Roots lie on y = 0, but for the lift of 0.1 mm, and hair stands up.
if awk '/^strand/ { root = NR + 1 } NR == root && ($2 < 0.00009 || $2 > 0.00011 || $1 < 0 || $1 > 1 || $3 > 0) { wrong = 1 } END { exit wrong }' \
    "$work/flat.tfx"; then good; else bad "roots elsewhere"; fi

claim "of more clumps than strands, each strand is one"
run 0 fur assets/ball.obj -n 40 --clumps 40 --clump 0.7 -o "$work/each.tfx"
run 0 fur assets/ball.obj -n 40 --clumps 2000000 --clump 0.7 -o "$work/more.tfx"
equal "$work/more.tfx" "$work/each.tfx"

claim "bad meshes and maps are refused in a line"
printf 'v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n' >"$work/line.obj"
printf 'v 0 0 0\n' >"$work/empty.obj"
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 1 2\n' >"$work/part.obj"
refused 3 "line.obj: no triangle has an area" fur "$work/line.obj"
refused 3 "empty.obj:2: no faces" fur "$work/empty.obj"
refused 3 "bob.tfx: hair (TressFX 3 binary), not a mesh: expected a mesh" fur assets/bob.tfx
"$bin/tractrix-convert" assets/bob.tfx --nth 50 -q -o "$work/lines.obj" && "$bin/tractrix-convert" assets/bob.tfx --nth 50 -q -o "$work/hair.npz"
refused 3 "lines.obj: hair (Wavefront lines), not a mesh: expected a mesh" fur "$work/lines.obj"
refused 3 "hair.npz: no faces: expected a mesh" fur "$work/hair.npz"
refused 3 "none.obj" fur "$work/none.obj"
refused 2 "an image is placed by texture coordinates, which the mesh lacks" fur "$work/part.obj" --density "$work/none.png"
refused 3 "--density: " fur assets/ball.obj --density "$work/none.png"
refused 2 "--density: nowhere above 0" fur assets/ball.obj --density 0
refused 2 "--comb: got '1,2', expected X,Y,Z" fur assets/ball.obj --comb 1,2
refused 2 "fur: got 0 files, expected one mesh" fur
refused 2 "fur: got 2 files, expected one mesh" fur assets/ball.obj assets/head.obj
refused 2 "--vertices: got 16, expected at least 161: 4 for each of the 40 turns of curls over 1 m" fur assets/ball.obj --curl-radius 0.01 --length 1
refused 2 "--clump and --clump-root: have no effect: expected --guides or --clumps" fur assets/ball.obj --clump 0.5
refused 3 "$work/none.obj: " fur "$work/none.obj"
"$program" fur --help >/dev/full 2>"$work/err"
if [ $? = 1 ]; then good; else bad "status with a full disk"; fi
one_line
run 0 fur "$work/part.obj" -n 9 -o "$work/part.tfx"; says "1 triangles without area are ignored"; one_line

claim "hair and mesh are two files, and neither is the mesh that hair grows on"
run 2 -n 3 -o "$work/same.obj" --mesh "$work/same.obj"; one_line; says "--mesh"; none "$work/same.obj"
cp assets/ball.obj "$work/own.obj"
run 2 fur "$work/own.obj" --count 20 -o "$work/own.obj"; one_line; says "the mesh"
equal "$work/own.obj" assets/ball.obj

claim "the light of a studio is the bundled one, and a file of its own"
run 0 --environment "$work/studio.pfm"; says "64 x 32 px"
equal "$work/studio.pfm" assets/studio.pfm
run 2 --mesh "$work/two" --environment "$work/two"; one_line; says "--environment"; none "$work/two"
claim "the head in motion is the bundled one, and a file of its own"
run 0 --motion "$work/nod.npz"; says "3002 vertices, 8 s at 12 samples a second"
equal "$work/nod.npz" assets/nod.npz
run 2 --mesh "$work/two" --motion "$work/two"; one_line; says "--motion"; none "$work/two"
holds "$bin/tractrix-render" assets/fall.tfx -q --mesh "$work/nod.npz" --frames 1 --size 32x32 --look plain -o "$work/nod.png"

finish
