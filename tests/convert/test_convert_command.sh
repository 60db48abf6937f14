#!/bin/sh
# SPDX-License-Identifier: MIT
# The command line of tractrix-convert: reports, files written and read back, errors.
. tests/support/claims.sh
program=$bin/tractrix-convert

curls=assets/curls.tfx fur=assets/fur.tfx
x=$work/x

claim "without an order it reports what files are"
run 0 $curls; says "TressFX 4 binary"; says "defects   none"; silent err
run 0 $curls $fur; says "$curls:"; says "$fur:"

claim "all that a format holds comes back, to the bit, through any other that holds it"
for format in text tfx3 tfx4 hair data obj usda abc ply ply-text npz npy; do
    run 0 $curls --unit m -q -o "$x.$format" --format $format; silent out; silent err
    run 0 "$x.$format" --unit m -q -o "$work/again.data"
    run 0 $curls --unit m -q -o "$work/direct.data"
    equal "$work/again.data" "$work/direct.data"
done
run 0 "$x.tfx3" --unit m -q -o "$work/a.tfx" --format tfx4
run 0 "$x.text" --unit m -q -o "$work/b.tfx" --format tfx4
equal "$work/a.tfx" "$work/b.tfx" # with texture coordinates

claim "what a format can't hold is reported in one line"
run 0 $curls -o "$x.obj"; says "x.obj: Wavefront lines leaves out: texture coordinates of strands"; one_line
run 0 $curls -o "$x.usda"; silent err; says "x.usda: USD (.usda)"
run 0 $curls -q -o "$x.obj"; silent err

claim "the name decides the format, --format overrules it"
run 0 $curls -o "$x.hair"; run 0 "$x.hair"; says "HAIR"
run 0 $curls -o "$work/noname" --format hair; equal "$x.hair" "$work/noname"
run 2 $curls -o "$work/noname2"; says ".usda, .abc, .hair, .obj, .tfx, .data, .ply, .npz or .npy"; one_line

claim "units and axes of what is written are those that are asked for"
run 0 $curls --unit m -q -o "$x.data" --to-unit 0.25 --to-up z
run 0 "$x.data" -q --unit 0.25 --up z -o "$work/again.data"
run 0 $curls --unit m -q -o "$work/direct.data"; equal "$work/again.data" "$work/direct.data"
run 0 $curls --unit m -q -o "$x.hair" --to-unit 0.25 --to-up z; run 0 "$x.hair" -o "$work/again.data" --format data; equal "$work/again.data" "$work/direct.data"
run 0 $curls --unit m -q -o "$x.data" --to-unit cm; run 0 "$x.data" -o "$work/again.data"; says "x.data: guessed a unit of 0.01 m and y up: set --unit and --up if this is wrong"
run 0 "$x.data" -q -o "$work/again.data"; silent err; run 0 $curls -o "$work/again.tfx"; silent err
run 0 $curls -q -o "$x.usda" --to-unit cm --to-up z; in_file "$x.usda" "metersPerUnit = 0.01"; in_file "$x.usda" 'upAxis = "Z"'; run 0 "$x.usda"; says "unit      0.01 m as given"

claim "steps are done in their order"
run 0 $curls -q -o "$work/a.data" --translate 1,0,0 --rotate y,90 --scale 2
run 0 $curls -q -o "$work/b.data" --scale 2 --rotate y,90 --translate 0,0,-2
run 0 $curls -q -o "$work/c.data" --rotate y,90 --translate 1,0,0 --scale 2
if cmp -s "$work/a.data" "$work/c.data"; then bad "the order makes no difference"; else good; fi
run 0 "$work/a.data" --unit m --stats; sed -n 2,4p "$work/out" >"$work/a.box"
run 0 "$work/b.data" --unit m --stats; sed -n 2,4p "$work/out" >"$work/b.box"; equal "$work/a.box" "$work/b.box"

claim "every step changes hair, and repeated steps add up"
# step A B: the steps A and B give the same hair, which is not that of the file.
step() {
    # shellcheck disable=SC2086 # they are words
    run 0 $curls --unit m -q $1 -o "$work/a.data"
    # shellcheck disable=SC2086
    run 0 $curls --unit m -q $2 -o "$work/b.data"; equal "$work/a.data" "$work/b.data"
    if cmp -s "$work/a.data" "$work/direct.data"; then bad "$1 does nothing"; else good; fi
}
step "--smooth 3" "--smooth 1 --smooth 2"
step "--nth 6" "--nth 2 --nth 3"
step "--min-length 0.2" "--min-length 0.1 --min-length 0.2"
step "--resample 9" "--resample 9 --min-length 0.0001"
step "--resample-spline 9" "--resample-spline 9 --min-length 0.0001"
step "--spacing 0.01" "--spacing 0.01 --min-length 0.0001"
step "--scale 8" "--scale 2 --scale 4"
step "--translate 4,2,1" "--translate 4,2,1 --translate 0,0,0"
step "--rotate y,90" "--rotate y,90 --scale 1"
step "--reverse" "--reverse --reverse --reverse"
step "--subsample 50%" "--subsample 0.5"

claim "strands and vertices become as many as asked for"
run 0 $curls --nth 3 --resample 7 --stats; says "vertices                     7           7"
strands=$(sed -n '1s/ .*//p' "$work/out")
run 0 $curls --nth 3 -o "$x.tfx"; run 0 "$x.tfx"; says "strands   $strands usable of $strands"
run 0 $curls --subsample 10% --seed 5 -q -o "$work/a.data"
run 0 $curls --subsample 0.1 --seed 5 -q -o "$work/b.data"; equal "$work/a.data" "$work/b.data"
run 0 $curls --subsample 0.1 --seed 6 -q -o "$work/b.data"
if cmp -s "$work/a.data" "$work/b.data"; then bad "the seed makes no difference"; else good; fi
run 0 $curls --reverse --reverse --unit m -q -o "$work/b.data"; equal "$work/b.data" "$work/direct.data"
run 0 $curls --resample-spline 40 --smooth 3 --spacing 0.01 --min-length 0.001 -q -o "$x.hair"
run 1 $curls --min-length 50 -o "$work/none.hair"; says "--min-length 50: no strand is that long"; one_line; none "$work/none.hair"
run 1 $curls --min-length 0.0001 --spacing 0.000001 -o "$work/none.hair"; says "at most 65535"; one_line; none "$work/none.hair"

claim "several files become one; what only some have is reported"
run 0 $curls $fur --unit m -o "$work/both.data"
run 0 $curls -q -o "$x.tfx"; run 0 $fur -q -o "$work/y.hair"
run 0 "$x.tfx" "$work/y.hair" -o "$work/z.usda"; says "leaves out: texture coordinates of strands"; one_line

claim "dirty files are mended and reported; --strict refuses them"
cat >"$work/dirty.tfx" <<'END'
numStrands 5
is sorted 1
strand 0 numVerts 3 texcoord 0 0
0 0 0
0 0 0
0 1 0
strand 1 numVerts 2 texcoord 0 0
1 0 0
1 -1.#INF 0
strand 2 numVerts 2 texcoord 0 0
2 0 0
2 0 0
strand 3 numVerts 2 texcoord nan 0
3 0 0
3 1 0
strand 4 numVerts 2 texcoord 0 0
4 0 0
4 1 0
END
run 0 "$work/dirty.tfx" --unit m -o "$work/clean.tfx"
says "dirty.tfx:9: 1 strand with a coordinate that is NaN, infinite or beyond 1000 km"; says "dirty.tfx:10: 1 strand of fewer than two"
says "dirty.tfx:5: 1 vertex that coincides"; says "1 attribute value that is not a finite number"
run 0 "$work/clean.tfx" --strict; says "strands   3 usable of 3"; silent err
run 3 "$work/dirty.tfx" --strict -o "$work/none.tfx"; says "refused because of --strict"; one_line; none "$work/none.tfx"

claim "- is standard input and standard output, and then all messages go to standard error"
"$program" - -q --unit m -o - --format data <$curls >"$work/again.data" 2>"$work/err"; silent err; equal "$work/again.data" "$work/direct.data"
"$bin/tractrix-gen" --kind straight --count 50 -o - 2>"$work/err" | "$program" - --stats >"$work/out"; says "50 strands"; says "-: 50 strands of"
"$program" - -o - --format usda <$curls 2>"$work/err" >"$work/x.usda"; says "-: USD (.usda)"; run 0 "$work/x.usda"; says "300 usable"
"$program" - --stats -o - --format hair <$curls 2>"$work/err" >"$work/x.hair"; says "300 strands"; run 0 "$work/x.hair"; says "300 usable"
"$program" - - --stats <$curls >"$work/out" 2>"$work/err"; says "can be read only once"; one_line
run 2 $curls -o -; says "expected --format"; one_line
"$bin/tractrix-render" - --check <$curls >"$work/out" 2>"$work/err"; says "300 usable of 300"; silent err
run 3 - --stats; says "-: byte 0: the file is empty"; one_line

claim "output is appended whole to a file that is there"
run 0 $curls -q -o "$x.abc"
echo kept >"$work/appended"
"$program" $curls -q -o - --format abc >>"$work/appended" 2>"$work/err"; silent err
tail -c +6 "$work/appended" >"$work/again.abc"; equal "$x.abc" "$work/again.abc"

claim "a pipe with a name is read like a file; a device, which may never end, is refused"
mkfifo "$work/named"
cat assets/fur.tfx >"$work/named" &
run 0 "$work/named" -o "$work/named.tfx"; equal "$work/named.tfx" assets/fur.tfx
wait
run 3 /dev/zero; one_line; says "/dev/zero: is a device"
run 3 /dev/zero -o "$work/zero.tfx"; one_line; none "$work/zero.tfx"

claim "cubic curves below transforms are read, and all their times"
cat >"$work/cubic.usda" <<'END'
#usda 1.0
(
    metersPerUnit = 1
)
def Xform "head"
{
    double3 xformOp:translate.timeSamples = {
        1: (0, 0, 0),
        3: (0, 0, 4),
    }
    uniform token[] xformOpOrder = ["xformOp:translate"]
    def BasisCurves "hair"
    {
        uniform token basis = "bspline"
        uniform token wrap = "pinned"
        int[] curveVertexCounts = [4]
        point3f[] points.timeSamples = { 2: [(0, 0, 0), (0, 1, 0), (0, 2, 0), (0, 3, 0)] }
    }
}
END
run 0 "$work/cubic.usda" -o "$work/linear.usda"; says "3 frames"
in_file "$work/linear.usda" "        3: [(0, 0, 4), (0, 0.5, 4), (0, 1, 4), (0, 1.5, 4), (0, 2, 4), (0, 2.5, 4), (0, 3, 4)],"
run 0 "$work/cubic.usda" --points-per-strand 4 -o "$work/linear.obj"; says "only the first of 3 time samples is read"; in_file "$work/linear.obj" "v 0 2 0"

claim "lists of points need no more than how many make a strand"
run 0 $curls -q --unit m -o "$x.ply" --format ply-text
sed '/^element strand/,/^end_header/d; s/^property float z$/&\nend_header/' "$x.ply" | head -n 14408 >"$work/cloud.ply"
run 0 "$work/cloud.ply" --unit m -o "$work/again.data"; says "cloud.ply: 48 points per strand, found from gaps between points"; equal "$work/again.data" "$work/direct.data"
run 0 "$work/cloud.ply" --unit m --points-per-strand 48 -o "$work/again.data"; silent err; equal "$work/again.data" "$work/direct.data"
run 3 "$work/cloud.ply" --points-per-strand 49; says "14400 points cannot be divided into strands of 49"; one_line
run 2 $curls --points-per-strand 48; says "has no effect"; one_line
run 2 $curls --array x; says "has no effect"; one_line

claim "statistics compare weight and curl with the stiffness of real hair"
# L_gb = (3.5e9 * 35e-6^2 / (4 * 1300 * 9.81))^(1/3) = 0.0438037 m, Gamma = (0.2/L_gb)^3 = 95.1827, and a right angle
# between segments of 0.1 m is a curvature of 10 pi/2 1/m: times L_gb 0.688067.
printf 'v %s\n' '0 0 0' '0 0.1 0' '0.1 0.1 0' >"$work/bent.obj"; echo 'l 1 2 3' >>"$work/bent.obj"
run 0 "$work/bent.obj" --unit m --stats --json "$work/x.json"; says "L_gb 0.0438 m (3.5 GPa, radius 35 um, 1300 kg/m3)"
says "Gamma                   95.183      95.183"; says "curvature * L_gb       0.68807     0.68807"
in_file "$work/x.json" '"gravito_bending_length_m": 0.04380'; in_file "$work/x.json" '"gamma": {'; in_file "$work/x.json" '"curvature_l_gb": {'

claim "figures go to JSON"
run 0 "$work/dirty.tfx" --unit m --json "$work/x.json"; silent out
for part in '"kind": "not_finite"' '"first_place": 9' '"curvature": {' '"root_spacing": {' '"sizes": [' '"unit_m": 1'; do
    in_file "$work/x.json" "$part"
done
run 0 $curls --json "$work/x.json" -q -o "$x.obj"; in_file "$work/x.json" '"left_out": "texture coordinates of strands"'
run 0 $curls --json "$work/none/x.json"; is_file "$work/none/x.json"
run 1 $curls --json "$work/none/x.json/y.json"; says "Not a directory"; one_line

claim "numbered files are frames"
for i in 0 1 2 3; do run 0 $fur --unit m --subsample 1% -q --translate "0,$i,0" -o "$work/f_0$i.tfx"; done
run 0 "$work/f_%02d.tfx" -o "$work/anim.usda" --fps 24; says "anim.usda: USD (.usda), 4 frames"
in_file "$work/anim.usda" "endTimeCode = 3"; in_file "$work/anim.usda" "timeCodesPerSecond = 24"; in_file "$work/anim.usda" "        3: [("
run 0 "$work/anim.usda" -o "$work/h.data"; says "anim.usda: only the first of 4 time samples is read"
run 0 "$work/f_00.tfx" --unit m -q -o "$work/g_0.data"; equal "$work/h.data" "$work/g_0.data"; rm "$work/g_0.data"
run 0 "$work/f_%02d.tfx"; says "frames    4, 0 to 3, 60 a second"
run 0 "$work/f_%02d.tfx" --first 1 --every 2 -q -o "$work/g_%d.data"; none "$work/g_0.data"; none "$work/g_2.data"
run 0 "$work/f_03.tfx" --unit m -q -o "$work/h.data"
run 0 "$work/f_%02d.tfx" --unit m --first 3 -q -o "$work/g_%d.data"; equal "$work/g_3.data" "$work/h.data"
run 0 "$work/f_%02d.tfx" --unit m -q -o "$work/anim.npz" --fps 24; run 0 "$work/anim.npz" -q -o "$work/anim2.usda"; run 0 "$work/f_%02d.tfx" --unit m -q -o "$work/anim3.usda" --fps 24; equal "$work/anim2.usda" "$work/anim3.usda"
run 0 "$work/anim.npz" --first 2 --last 3 -q -o "$work/h_%d.data"; run 0 "$work/f_03.tfx" --unit m -q -o "$work/h.data"; equal "$work/h_3.data" "$work/h.data"; none "$work/h_1.data"
run 3 "$work/anim.npz" --first 4 -o "$work/none.usda"; says "no frame 4: the file has frames 0 to 3"; one_line; none "$work/none.usda"
run 2 "$work/f_%02d.tfx" -o "$work/one.data"; says "one file name for 4 frames"; one_line; none "$work/one.data"
run 3 "$work/f_%02d.tfx" --first 7; says "no file for frame 7"; one_line
run 3 "$work/f_%02d.tfx" --last 4 -o "$work/none.usda"; says "f_04.tfx"; one_line; none "$work/none.usda"
run 0 $curls --subsample 1% -q -o "$work/f_04.tfx"
run 1 "$work/f_%02d.tfx" -o "$work/none.usda"; says "the strands of frame 4 differ from those of frame 0"; one_line; none "$work/none.usda"

claim "a cache becomes a USD file with the points that tractrix-render writes"
"$bin/tractrix-render" assets/curls.tfx assets/demo.tfx --frames 4 -q --cache "$work/a.cache" --export "$work/render.usda" || bad "tractrix-render fails"
run 0 "$work/a.cache"; says "a cache"; says "of 2 sections"; says "frames    4, 0 to 3, 60 a second"
run 0 "$work/a.cache" -o "$work/cache.usda"; says "4 frames"
for file in render cache; do sed -n '/points.timeSamples/,/^    }/p' "$work/$file.usda" >"$work/$file.points"; done
equal "$work/render.points" "$work/cache.points"; in_file "$work/cache.usda" "primvars:section"
run 0 "$work/a.cache" --first 2 --last 2 --nth 10 -q -o "$work/frame.hair"; run 0 "$work/frame.hair"; says HAIR
run 3 "$work/a.cache" --last 9 -o "$work/none.usda"; says "no frame 9"; one_line; none "$work/none.usda"
head -c 300000 "$work/a.cache" >"$work/cut.cache"
run 3 "$work/cut.cache" --last 3; says "no frame 3"; one_line
head -c 40 "$work/a.cache" >"$work/cut.cache"; run 3 "$work/cut.cache"; one_line
run 2 "$work/a.cache" $curls; says "cannot be joined with other files"; one_line

claim "frames that are cut off or missing are not lost in silence"
head -c "$(($(wc -c <"$work/a.cache") * 3 / 4))" "$work/a.cache" >"$work/cut.cache"
run 0 "$work/cut.cache"; says "unfinished or cut off"
run 1 "$work/cut.cache" -o "$work/cut.usda"; says "--partial"; one_line; none "$work/cut.usda"
run 0 "$work/cut.cache" -o "$work/cut.usda" --partial; is_file "$work/cut.usda"
run 0 "$work/cut.cache" -o "$work/cut.usda" --last 1; says "2 frames"
for number in 0 1 3; do cp assets/fur.tfx "$work/gap_$number.tfx"; done
run 1 "$work/gap_%d.tfx" -o "$work/gap.usda"; says "no file for frame 2, but one for frame 3"; one_line; none "$work/gap.usda"
run 0 "$work/gap_%d.tfx" -o "$work/gap.usda" --partial; says "2 frames"
rm "$work/gap_3.tfx"
run 0 "$work/gap_%d.tfx" -o "$work/gap.usda"; says "2 frames"

claim "no output takes the place of an input or of another output"
cp assets/fur.tfx "$work/own.tfx"
run 2 "$work/own.tfx" --json "$work/own.tfx"; says "--json"; one_line
run 2 "$work/own.tfx" -o "$work/own.tfx" --scale 2; says "-o"; one_line
run 2 "$work/own.tfx" -o "$work/same.tfx" --json "$work/same.tfx"; says "--json"; one_line; none "$work/same.tfx"
run 2 "$work/gap_%d.tfx" -o "$work/gap_%d.tfx"; one_line
equal "$work/own.tfx" assets/fur.tfx

claim "an interrupted export leaves no USD file, nor a part of one"
mkdir "$work/broken"
"$bin/tractrix-render" $curls --frames 1000000 -q --export "$work/broken/x.usda" >"$work/out" 2>"$work/err" &
pid=$!
for _ in $(seq 100); do [ -n "$(ls -A "$work/broken")" ] && break; sleep 0.1; done
sleep 0.3; kill -INT $pid; wait $pid
status=$?
if [ $status = 130 ] && [ -z "$(ls -A "$work/broken")" ]; then good; else bad "status $status, $(ls -A "$work/broken")"; fi

claim "what can't be read is status 3 and one line with the place"
printf 'hello\n' >"$work/text"; : >"$work/empty"; head -c 5000 $curls >"$work/cut.tfx"; printf 'v 0 0 0\nl 1 2\n' >"$work/bad.obj"
for file in "$work/text" "$work/empty" "$work/cut.tfx" "$work/bad.obj" "$work/missing.tfx" "$work" assets/head.obj; do
    run 3 "$file" -o "$work/none.hair"; one_line; says "$file"; silent out; none "$work/none.hair"
done

run 3 $curls "$work/new.hair"; one_line; says "expected -o $work/new.hair for an output"; silent out; none "$work/new.hair"

claim "what can't be written is status 1"
run 1 $curls -o /proc/x.hair; one_line
run 1 $curls $fur --format tfx4 -o "$work/none.tfx"; says "expected equal numbers in a binary TressFX file"; one_line; none "$work/none.tfx"

claim "wrong usage is status 2 and one line"
for words in "" "--nth 0 $curls --stats" "--nth 1.5 $curls --stats" "--subsample 0 $curls --stats" "--subsample 101% $curls --stats" \
    "--resample 1 $curls --stats" "--resample 65536 $curls --stats" "--scale 0 $curls --stats" "--scale -1 $curls --stats" \
    "--rotate w,9 $curls --stats" "--rotate y $curls --stats" "--rotate y,nan $curls --stats" "--translate 1,2 $curls --stats" \
    "--translate 1,2,3,4 $curls --stats" "--smooth x $curls --stats" "--min-length 0 $curls --stats" "--format png $curls" \
    "--unit furlong $curls" "--to-unit auto $curls -o $x.hair" "--up x $curls" "--to-up z $curls" "--first 1 $curls" "--fps 30 $curls" \
    "--smooth 1 $curls" "--bogus $curls" "$curls -o" "-o $work/%s.tfx $curls" "-o $work/%d_%d.tfx $curls"; do
    # shellcheck disable=SC2086
    run 2 $words; one_line; silent out
done
run 2 --resampel 3 $curls; says "did you mean '--resample'?"

claim "help and version are answered"
run 0 --help; says "--resample-spline N"; run 0 --help=man; says ".TH TRACTRIX-CONVERT 1"; run 0 --version; says "tractrix-convert "
"$program" --help >/dev/full 2>"$work/err"
if [ $? = 1 ]; then good; else bad "status with a full disk"; fi

claim "a groom is fitted to a head, and what was done is told in millimetres"
run 0 assets/bob.tfx --scale 1.3 --rotate y,20 --translate 0.3,0.2,0.1 -o "$work/elsewhere.tfx" -q
run 0 "$work/elsewhere.tfx" --mesh assets/head.obj --fit --attach --push-out 0.001 --stats --json "$work/fitted.json" -o "$work/fitted.tfx"
says "--fit: scaled by 0.768"; says "turned by 20 degrees"; says "--attach: "; says " mm"; says "--push-out: "
says "inside the mesh: 0 of "
in_file "$work/fitted.json" '"strands_inside": 0'; in_file "$work/fitted.json" '"depth_inside"'
# A box of 1 m; a strand from its top, whose other vertices are 10, 20 and 30 mm deep, and a root 5 mm above.
printf 'v %s\n' '-0.5 -0.5 -0.5' '0.5 -0.5 -0.5' '0.5 0.5 -0.5' '-0.5 0.5 -0.5' '-0.5 -0.5 0.5' '0.5 -0.5 0.5' '0.5 0.5 0.5' '-0.5 0.5 0.5' >"$work/box.obj"
printf 'f %s\n' '1 4 3 2' '5 6 7 8' '1 2 6 5' '3 4 8 7' '1 5 8 4' '2 3 7 6' >>"$work/box.obj"
printf 'v %s\n' '0 0.5 0' '0.1 0.49 0' '0.2 0.48 0' '0.3 0.47 0' >"$work/deep.obj"
echo 'l 1 2 3 4' >>"$work/deep.obj"
run 0 "$work/deep.obj" --unit m --mesh "$work/box.obj" --mesh-unit m --push-out 0.002 -o "$work/out.tfx"
says "--push-out: 3 of 4 vertices of 1 strands moved to 2 mm from the mesh; those inside were up to 30 mm deep, half of them up to 20 mm"
run 0 "$work/deep.obj" --unit m --mesh "$work/box.obj" --mesh-unit m --stats; says "inside the mesh: 3 of 4 vertices, of 1 of 1 strands"
printf 'v %s\n' '0 0.505 0' '0.1 0.6 0' >"$work/above.obj"
echo 'l 1 2' >>"$work/above.obj"
run 0 "$work/above.obj" --unit m --mesh "$work/box.obj" --mesh-unit m --attach -o "$work/out.tfx"
says "--attach: 1 roots moved onto the mesh, half of them by at most 5 mm, all by at most 5 mm"
run 2 assets/bob.tfx --attach -o "$work/unfit.tfx"; says "--attach: expected --mesh FILE with it"; one_line
run 2 assets/bob.tfx --mesh assets/head.obj -o "$work/unfit.tfx"; says "--mesh: has no effect"; one_line
run 2 assets/bob.tfx --mesh assets/head.obj --push-out -1 -o "$work/unfit.tfx"; says "--push-out: got '-1', expected a distance"; one_line
run 3 assets/bob.tfx --mesh assets/bob.tfx --attach -o "$work/unfit.tfx"; says "expected a mesh (tractrix-render takes hair without --mesh)"; one_line
run 3 assets/head.obj; says "not hair: expected hair (pass a mesh with --mesh)"; one_line
none "$work/unfit.tfx"

claim "a mesh has its own unit and axis"
# The box again, 0.96 m high, the same with z up, and in millimetres.
awk '/^v/ { $3 *= 0.96 } { print }' "$work/box.obj" >"$work/low.obj"
awk '/^v/ { print "v", $2, -$4, $3 } /^f/' "$work/low.obj" >"$work/low_z.obj"
awk '/^v/ { print "v", 1000 * $2, 1000 * $3, 1000 * $4 } /^f/' "$work/low_z.obj" >"$work/low_mm.obj"
run 0 "$work/above.obj" --unit m --mesh "$work/low.obj" --mesh-unit m --mesh-up y --attach -o "$work/a.tfx"; says "by at most 25 mm"
run 0 "$work/above.obj" --unit m --mesh "$work/low_z.obj" --mesh-unit m --mesh-up z --attach -o "$work/b.tfx"; equal "$work/a.tfx" "$work/b.tfx"
run 0 "$work/above.obj" --unit m --mesh "$work/low_mm.obj" --mesh-unit mm --mesh-up z --attach -o "$work/b.tfx"; says "by at most 25 mm"
run 0 "$work/above.obj" --unit m --mesh "$work/low.obj" --attach -o "$work/b.tfx"; equal "$work/a.tfx" "$work/b.tfx"

claim "a mesh has the unit of the hair, also of several files and of numbered ones"
run 0 assets/bob.tfx -q --unit m --mesh assets/head.obj --stats; grep "inside the mesh" "$work/out" >"$work/inside"
for number in 0 1; do cp assets/bob.tfx "$work/bob_$number.tfx"; done
run 0 "$work/bob_%d.tfx" -q --mesh assets/head.obj --stats; grep "inside the mesh" "$work/out" >"$work/again"; equal "$work/inside" "$work/again"
run 0 "$work/bob_0.tfx" "$work/bob_1.tfx" --mesh assets/head.obj --stats; says "inside the mesh: "

claim "a mesh to which hair is fitted has a unit of its own"
# Every fourth strand is enough.
run 0 assets/bob.tfx -q --nth 4 -o "$work/few.tfx"; run 0 "$work/few.tfx" -q --to-unit cm -o "$work/few_cm.tfx"
awk '/^v / { $2 *= 1000; $3 *= 1000; $4 *= 1000 } { print }' assets/head.obj >"$work/head_mm.obj"
run 0 "$work/few_cm.tfx" --mesh assets/head.obj --fit -o "$work/fitted.tfx"
says "head.obj: guessed a unit of 1 m: set --mesh-unit if this is wrong"; says "--fit: scaled by 0.99"
run 0 "$work/few.tfx" --mesh "$work/head_mm.obj" --fit -o "$work/fitted.tfx"
says "head_mm.obj: guessed a unit of 0.001 m: set --mesh-unit if this is wrong"; says "--fit: scaled by 0.99"
run 0 "$work/few.tfx" --mesh assets/head.obj --fit -o "$work/fitted.usda"; says "--fit: scaled by 0.99"; one_line
run 0 "$work/few_cm.tfx" --unit cm --mesh assets/head.obj --mesh-unit cm --fit -o "$work/fitted.usda"; says "--fit: scaled by 0.0099"; one_line

claim "meshes of PLY, NumPy and Alembic files are refused as hair, and hair as a mesh"
printf 'ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n-1 -1 -1\n1 -1 -1\n0 1 0\n0 -1 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n' >"$work/mesh.ply"
run 0 $curls --mesh "$work/mesh.ply" --mesh-unit m --stats; says "inside the mesh: "
run 3 assets/nod.npz; says "a mesh, not hair: expected hair (pass a mesh with --mesh)"; one_line
run 0 $curls --nth 20 -q -o "$work/hair.npz"; run 3 $curls --mesh "$work/hair.npz" --fit -o "$work/unfit.tfx"; says "no faces: expected a mesh (tractrix-render takes hair without --mesh)"; one_line
run 3 $curls --mesh assets/bob.tfx --fit -o "$work/unfit.tfx"; says "bob.tfx: hair (TressFX 3 binary), not a mesh: expected a mesh"; one_line
run 3 "$work/mesh.ply"; says "a mesh of 4 faces, not hair: expected hair (pass a mesh with --mesh)"; one_line
sed 's/3 0 3 2/3 0 3 9/' "$work/mesh.ply" >"$work/bad.ply"
run 3 $curls --mesh "$work/bad.ply" --stats; says "bad.ply:17: face 3 has corner 9: expected less than 4"; one_line
run 0 $curls --mesh tests/data/body.abc --stats
run 3 $curls --mesh tests/data/groom.abc --stats; says "hair and no visible mesh"; one_line

claim "groups: of Alembic, of files that become one"
run 0 tests/data/unreal.abc --unit cm --group 5 --stats; says "2 strands, "
run 0 $curls assets/fur.tfx -o "$work/two.abc" -q; run 0 "$work/two.abc" --group 1 -o "$work/one.hair" -q
run 3 "$work/two.abc" --group 7 --stats; says "--group: no strand belongs to group 7: expected a group from 0 to 1"; one_line
run 0 "$work/two.abc" $fur "$work/two.abc" -o "$work/five.usda" -q; run 3 "$work/five.usda" --group 5 --stats; says "expected a group from 0 to 4"; one_line
run 0 "$work/five.usda" --group 2 --stats; says "2000 strands, "; run 0 "$work/five.usda" --group 3 --stats; says "300 strands, "
run 0 $curls assets/fur.tfx -o "$work/two.hair"; if grep -q groups "$work/err"; then bad "groups that nobody has asked for are lost"; else good; fi

finish
