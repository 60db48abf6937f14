#!/bin/sh
# SPDX-License-Identifier: MIT
# The command line of tractrix-render: exit statuses, messages, files.
. tests/support/claims.sh
program=$bin/tractrix-render
hair=assets/fur.tfx
plain="--look plain --followers 0" # for claims that are not about light: the studio light takes most of a small picture's time
small="--frames 2 --size 32x24 $plain"
# dark ARGUMENT...: runs the usual look, with its scalp and its followers, but without shadows and automatic exposure.
dark() { run 0 "$@" --shadow none --exposure 0; }

claim "frames are written and told"
# shellcheck disable=SC2086
run 0 $hair $small -o "$work/a/"
is_file "$work/a/frame_0000.png"; is_file "$work/a/frame_0001.png"; says "OpenGL"; says "2 frames in"

claim "-q says nothing"
# shellcheck disable=SC2086
run 0 $hair $small -q -o "$work/q_%03d.png"
is_file "$work/q_001.png"
if [ -s "$work/err" ]; then bad "said something"; else good; fi

claim "only the frames asked for are drawn, and they are the same as in the whole sequence"
# shellcheck disable=SC2086
# shellcheck disable=SC2086
{
run 0 $hair $plain --frames 6 --size 32x24 -q -o "$work/whole/"
run 0 $hair $plain --frames 6 --size 32x24 -q --first 1 --last 5 --every 2 -o "$work/part/"
}
if [ "$(cd "$work/part" && echo *)" = "frame_0001.png frame_0003.png frame_0005.png" ]; then good; else bad "wrong frames"; fi
if cmp -s "$work/whole/frame_0005.png" "$work/part/frame_0005.png"; then good; else bad "frame 5 differs"; fi

claim "the same command gives the same bytes, with any number of driver threads"
with_threads() { # THREADS FOLDER
    LP_NUM_THREADS=$1 run 0 assets/demo.json --followers 1 --preroll 0.1 --frames 2 --size 80x60 --scatter-cells 12 -q -o "$work/$2/"
}
with_threads 0 r0
for threads in 1 2 2; do
    with_threads $threads "again$threads"
    if diff -r "$work/r0" "$work/again$threads" >"$work/err"; then good; else bad "$threads threads: differs"; fi
done

claim "--raster blocks draws deep images, floats and AOVs as --raster auto does on a CPU driver"
if has_driver llvmpipe; then
    for what in "--depth 16" "--aov depth" "--aov coverage" "--aov tangent" "--aov strand"; do
        # shellcheck disable=SC2086
        for raster in auto blocks; do run 0 $hair $small --software $what --raster $raster -q -o "$work/${raster}_%d.png"; done
        same_images "$work/auto_1.png" "$work/blocks_1.png"
    done
    # shellcheck disable=SC2086
    for raster in auto blocks; do run 0 $hair $small --software --raster $raster -q -o "$work/${raster}_%d.pfm"; done
    if cmp -s "$work/auto_1.pfm" "$work/blocks_1.pfm"; then good; else bad ".pfm differs"; fi
else
    skip "no CPU driver"
fi

claim "--exposure auto is one number for all parts, a cache, a still and a sequence, and all rasterisers; it is told"
exposed="assets/curls.tfx $plain --shadow dom --scalp none --size 80x60 --exposure auto --frames 4"
exposure_is() { # compares the exposure of the last run
    found=$(sed -n 's/.*"exposure": \([-0-9.][-0-9.]*\).*/\1/p' "$work/stats.json")
    if [ -n "$found" ] && [ "$found" != 0.0 ] && [ "$found" = "${first:=$found}" ]; then good; else bad "exposure '$found', not '$first'"; fi
}
# shellcheck disable=SC2086
for words in "--cache $work/c.cache" "--part 2/3" "--first 3" "--frames 1" "--from-cache $work/c.cache --part 3/3" \
    "--raster quads --frames 1" "--samples 2 --frames 1" "--depth 16 --frames 1" "--floor plane --frames 1"; do
    run 0 $exposed $words --stats "$work/stats.json" -o "$work/exposed_%d.png"
    exposure_is
    says "exposure: +$first EV (--exposure auto)"
done
# shellcheck disable=SC2086
run 0 $exposed --frames 1 --size 400x300 --stats "$work/stats.json" -o "$work/large.png" # the meter draws at most 256 px
exposure_near() { sed -n 's/.*"exposure": \([-0-9.][-0-9.]*\).*/\1/p' "$work/stats.json" | awk -v near="$first" '{ exit !(($1 - near) ^ 2 < 0.1 ^ 2) }'; }
if exposure_near; then good; else bad "a large image has another exposure than $first"; fi
# shellcheck disable=SC2086
run 0 $exposed --frames 1 -o "$work/auto.png" -q
# shellcheck disable=SC2086
run 0 $exposed --frames 1 -o "$work/given.png" -q --exposure "$first"
if cmp -s "$work/auto.png" "$work/given.png"; then good; else bad "the given exposure draws another image"; fi

claim "--exposure auto leaves floats and AOVs as they are"
# shellcheck disable=SC2086
run 0 $exposed --frames 1 -q -o "$work/auto.pfm"
# shellcheck disable=SC2086
run 0 $exposed --frames 1 -q --exposure 0 -o "$work/zero.pfm"
if cmp -s "$work/auto.pfm" "$work/zero.pfm"; then good; else bad "floats are exposed"; fi
# shellcheck disable=SC2086
run 0 $exposed --frames 1 --aov coverage --stats "$work/stats.json" -o "$work/aov.png"
if grep -q '"exposure": 0.0' "$work/stats.json"; then good; else bad "an AOV is exposed"; fi

claim "what cannot be written to standard output is an error of one line"
for words in --help "--algo list" "--check $hair"; do
    # shellcheck disable=SC2086
    "$program" $words >/dev/full 2>"$work/err"
    if [ $? = 1 ]; then good; else bad "status of $words"; fi
    one_line
done
"$bin/tractrix-bench" --help >/dev/full 2>"$work/err"
if [ $? = 1 ]; then good; else bad "status of tractrix-bench --help"; fi
one_line

claim "a closed pipe ends a program quietly"
pipe() {
    { "$@" 2>"$work/err"; echo $? >"$work/status"; } | head -1 >"$work/out"
    if grep -qE '^(0|141)$' "$work/status"; then good; else bad "status $(cat "$work/status") of $*"; fi
    silent err
}
for words in "render --help all" "render --help man" "render --help bash" "gen --help man" "gen fur --help" "convert --help man" \
    "compare --help man" "bench --help man"; do
    # shellcheck disable=SC2086
    pipe "$bin"/tractrix-$words
done

claim "every program answers --help TOPIC and refuses a topic that there is not"
for name in render gen convert compare bench; do
    program=$bin/tractrix-$name
    run 0 --help help; says "--help [TOPIC]"; silent err
    run 0 --help=all; says "Usage: tractrix-$name"
    run 2 --help wibble; one_line; says "tractrix-$name: --help: no topic 'wibble': expected"
    run 2 --wibble; one_line; says "tractrix-$name: --wibble: no such option: see --help"
    run 2 --verison; one_line; says "tractrix-$name: --verison: no such option: did you mean '--version'?"
done
program=$bin/tractrix-render
run 0 --help color; says "--color COLOR"
if [ "$(grep -c '^  -' "$work/out")" = 1 ]; then good; else bad "more than one entry"; fi
run 0 --help rod; says "--youngs-modulus"

claim "a hidden section costs no drawing, casts no shadow and leaves the picture as it is without it, from a cache, too"
sections() {
    printf '{"frames": 2, "size": "80x60", "eye": [0, 0.1, 0.9], "target": [0, 0, 0], "mesh": "%s/assets/ball.obj", "look": "plain", "shadow": "dom",\n' "$PWD"
    printf '"sections": [{"file": "%s/assets/curls.tfx"}%s]}\n' "$PWD" "$1"
}
counts() { grep -E '"(segments|fragments|shadow_maps|strands_[a-z]*)":' "$1"; }
sections "" >"$work/alone.json"
sections ", {\"file\": \"$PWD/assets/fur.tfx\", \"hidden\": true, \"followers\": 1}" >"$work/hidden.json"
sections ", {\"file\": \"$PWD/assets/fur.tfx\", \"followers\": 1}" >"$work/shown.json"
for which in alone hidden shown; do
    run 0 "$work/$which.json" -q -o "$work/$which/" --stats "$work/$which.stats" --export "$work/${which}_%d.tfx"
    counts "$work/$which.stats" >"$work/$which.counts"
done
same_images "$work/alone" "$work/hidden"; equal "$work/alone.counts" "$work/hidden.counts"
if "$bin/tractrix-compare" -q "$work/alone/frame_0001.png" "$work/shown/frame_0001.png"; then bad "not shown"; else good; fi
if cmp -s "$work/hidden_1.tfx" "$work/shown_1.tfx"; then good; else bad "exported otherwise"; fi
run 0 "$work/shown.json" -q --cache "$work/layers.cache"
run 0 "$work/hidden.json" -q --from-cache "$work/layers.cache" -o "$work/layer/"
same_images "$work/alone" "$work/layer"
for raster in blocks quads compute; do
    # shellcheck disable=SC2086 # words
    for shadow in none approx dom; do run 0 $hair $plain --hidden --frames 1 --raster $raster --shadow $shadow --size 32x24 -q -o "$work/nothing.png"; done
done

claim "usage errors name the nearest valid word and end with 2"
run 2; one_line
run 2 $hair; one_line; says "-o"
run 2 $hair --background tranparent -o "$work/x/"; one_line; says "(nearest: transparent)"
run 2 $hair --caption fram -o "$work/x/"; one_line; says "(nearest: frame)"
run 2 $hair --farmes 3 -o "$work/x/"; one_line; says "frames"
run 2 $hair --frames 0 -o "$work/x/"; one_line; says "frames"
run 2 $hair --frames many -o "$work/x/"; one_line
run 2 $hair --algo splitt -o "$work/x/"; one_line; says "did you mean 'split'"
run 2 $hair --algo verlet -o "$work/x/"; one_line; says "no solver 'verlet': expected split, emulation"
run 2 $hair --rope-iterations 5 -o "$work/x/"; one_line; says "--rope-iterations: --algo hybrid has no such parameter"
run 2 $hair --look plain --shadow-size 64 -o "$work/x/"; one_line; says "--shadow-size: has no effect: --shadow is none"
printf '{"frames": 1, "size": "16x16", "look": "plain", "shadow_size": 99, "sections": [{"file": "%s/%s"}]}\n' "$PWD" "$hair" >"$work/idle.json"
run 0 "$work/idle.json" -o "$work/idle/"; says "idle.json: shadow_size: has no effect: --shadow is none"
run 0 "$work/idle.json" -o "$work/idle/" -q; silent err
printf '{"sections": [{"file": "%s/%s", "poisson": 0.3}]}\n' "$PWD" "$hair" >"$work/owner.json"
run 2 "$work/owner.json" -o "$work/x/"; one_line; says "owner.json: sections[0].poisson: algo 'hybrid' has no such parameter"
run 2 $hair --algo split --variant thesiss -o "$work/x/"; one_line; says "did you mean 'thesis'"
run 2 $hair --software --require-hardware -o "$work/x/"; one_line
run 2 $hair -o "$work/x_%d_%d.png"; one_line
run 2 $hair -o "$work/x.avi"; one_line
if [ -e "$work/x" ]; then bad "made a folder"; else good; fi

claim "bad files end with 3 and one line with file and place"
printf 'numStrands 1\nis sorted 1\nstrand 0 numVerts 2 texcoord 0 0\n1 2 3\n' >"$work/cut.tfx"
printf 'not hair\n' >"$work/text.tfx"
printf '{"frames": 3, "sectoins": []}\n' >"$work/key.json"
printf '{"frames": \n' >"$work/cut.json"
for file in missing.tfx cut.tfx text.tfx key.json cut.json; do
    run 3 "$work/$file" -o "$work/x/"
    one_line; says "$work/$file"
done
says "cut.json"
run 3 $hair --mesh "$work/missing.obj" -o "$work/x/"; one_line; says "missing.obj"

claim "dirty files are mended with a report, or refused with --strict"
printf 'numStrands 2\nis sorted 1\nstrand 0 numVerts 3 texcoord 0 0\n0 100 0\n0 100 0\n0 120 0\nstrand 1 numVerts 2 texcoord 0 0\n1 2 -1.#INF\n1 2 3\n' >"$work/dirty.tfx"
run 0 "$work/dirty.tfx" --look plain --frames 1 --size 16x16 -o "$work/d/"; says "dirty.tfx:"
run 3 "$work/dirty.tfx" --strict --frames 1 --size 16x16 -o "$work/d/"; one_line
run 1 --check "$work/dirty.tfx"; says "strands"
run 0 --check $hair; says "TressFX 4"
run 3 --check "$work/text.tfx"

claim "no usable GL ends with 4 and says what was tried"
__EGL_VENDOR_LIBRARY_FILENAMES=/dev/null
export __EGL_VENDOR_LIBRARY_FILENAMES
run 4 $hair --scalp none --backend egl --frames 1 -o "$work/x/"; one_line; says "surfaceless"; says "libgl1-mesa-dri"
unset __EGL_VENDOR_LIBRARY_FILENAMES
if has_driver llvmpipe; then
    GALLIUM_DRIVER=nonsense; export GALLIUM_DRIVER
    run 4 $hair --frames 1 -q -o "$work/x/"; says "expected llvmpipe or softpipe"
    unset GALLIUM_DRIVER
    for version in 4.2 4.3; do
        # shellcheck disable=SC2086
        MESA_GL_VERSION_OVERRIDE=$version "$program" $hair $plain --frames 1 --size 32x24 --software -o "$work/$version/" >"$work/out" 2>"$work/err"
        status=$?
        if [ "$version $status" = "4.2 4" ] || [ "$version $status" = "4.3 0" ]; then good; else bad "OpenGL $version: status $status"; fi
    done
else
    skip "no CPU driver"
fi
run 4 $hair --scalp none --device 31 --frames 1 -o "$work/x/"; one_line; says "--list-devices"

claim "OSMesa is another way in"
if has_driver osmesa; then
    # shellcheck disable=SC2086
    run 0 $hair $plain --backend osmesa --frames 1 --size 32x24 -o "$work/osmesa/"
    says "OSMesa"; is_file "$work/osmesa/frame_0000.png"
elif /sbin/ldconfig -p | grep -q "libOSMesa.so.8"; then
    bad "OSMesa is installed, but not found"
else
    skip "no OSMesa"
fi

claim "an unwritable place fails with 1 before any work, and nothing is left"
run 1 $hair --frames 1 -o "/proc/none/here/"; says "/proc/none"
printf x >"$work/plain"
run 1 $hair --frames 1 -o "$work/plain/sub/"; says "plain"

claim "an interrupt ends with 130, one line and whole files"
# shellcheck disable=SC2086
"$program" assets/demo.json $plain --preroll 0 --size 320x240 -o "$work/int/" >"$work/out" 2>"$work/err" &
pid=$!
while [ ! -e "$work/int/frame_0001.png" ] && kill -0 $pid 2>/dev/null; do sleep 0.05; done
kill -INT $pid; kill -TERM $pid 2>/dev/null
wait $pid
status=$?
# A second signal ends the program at once (128 + 15) if it arrives before the first was handled.
if [ $status = 130 ] || [ $status = 143 ]; then good; else bad "exit status $status"; fi
# shellcheck disable=SC2086
"$program" assets/demo.json $plain --preroll 0 --size 320x240 -o "$work/int2/" >"$work/out" 2>"$work/err" &
pid=$!
while [ ! -e "$work/int2/frame_0001.png" ] && kill -0 $pid 2>/dev/null; do sleep 0.05; done
kill -TERM $pid
wait $pid
status=$?
if [ $status = 130 ]; then good; else bad "exit status $status, expected 130"; fi
says "interrupted after"
mkdir "$work/clean"
for file in "$work"/int2/* "$work"/int2/.[!.]*; do
    case $file in
    *frame_0[0-9][0-9][0-9].png) ;;
    *'*'*) ;;
    *) mv "$file" "$work/clean/" ;;
    esac
done
no_files "$work/clean"

claim "statistics hold device, passes, frames and parameters"
# shellcheck disable=SC2086
run 0 $hair $small -q --seed 7 -o "$work/s/" --stats "$work/stats.json"
for word in '"renderer"' '"sim_hybrid"' '"draw_composite"' '"frames_drawn": 2' '"seed": 7' '"peak_memory_kib"' '"commit"'; do
    if grep -qF -- "$word" "$work/stats.json"; then good; else bad "no $word"; fi
done

claim "a still scene is drawn once"
# shellcheck disable=SC2086
run 0 $hair $plain --algo none --frames 5 --size 32x24 -q -o "$work/still/" --stats "$work/stats.json"
if grep -qF '"frames_repeated": 4' "$work/stats.json"; then good; else bad "was drawn again"; fi
holds "$bin/tractrix-compare" -q "$work/still/frame_0000.png" "$work/still/frame_0004.png"

claim "images say who drew them and which frame they are"
drawn_by=$(sed -n 's/.*"renderer": "\([^"]*\)".*/\1/p' "$work/stats.json" | head -n 1)
for word in Software tractrix Renderer Driver "${drawn_by:-no renderer}" Frame; do in_file "$work/still/frame_0004.png" "$word"; done
# shellcheck disable=SC2086
run 0 $hair $plain --algo none --frames 5 --size 32x24 -q -o "$work/again/"
for frame in 0 4; do equal "$work/still/frame_000$frame.png" "$work/again/frame_000$frame.png"; done

claim "the same hair in metres and in centimetres gives the same picture"
awk 'BEGIN { print "numStrands 40"; print "is sorted 1"; for (s = 0; s < 40; ++s) { print "strand", s, "numVerts 8 texcoord 0 0"
    for (j = 0; j < 8; ++j) print s * 0.5 - 10, 100 - j * 2, j * j * 0.25 } }' >"$work/cm.tfx"
awk 'NF == 3 && $1 ~ /^[-0-9]/ { print $1 * 4, $2 * 4, $3 * 4; next } { print }' "$work/cm.tfx" >"$work/other.tfx"
# shellcheck disable=SC2086
{
run 0 "$work/cm.tfx" $plain --unit 0.015625 --frames 3 --size 64x48 -q -o "$work/u1/"
run 0 "$work/other.tfx" $plain --unit 0.00390625 --frames 3 --size 64x48 -q -o "$work/u2/"
}
if diff -r "$work/u1" "$work/u2" >"$work/err"; then good; else bad "pictures differ"; fi

claim "a cache that is none, has too few frames or is of another scene, and an output that cannot hold the frames, are told before a device is opened"
run 3 assets/curls.tfx --from-cache "$work/none.cache" -o "$work/none.png"; says "none.cache"; if grep -q OpenGL "$work/err"; then bad "a device was opened"; else good; fi
run 0 assets/curls.tfx --followers 0 --frames 2 --cache "$work/two.cache" -q
run 3 assets/curls.tfx --followers 0 --frames 4 --from-cache "$work/two.cache" -o "$work/two/"; says "two.cache"; if grep -q OpenGL "$work/err"; then bad "a device was opened"; else good; fi
run 3 assets/curls.tfx --followers 0 --frames 2 --style 0.9 --from-cache "$work/two.cache" -o "$work/two/"; says "two.cache: was simulated with sections[0].style 0.5, but this scene has 0.9"; if grep -q OpenGL "$work/err"; then bad "a device was opened"; else good; fi
for words in "-o $work/two.png" "-o $work/two.mp4 --background transparent" "-o $work/two.gif --fps 2000" "-o $work/two/ --contact-sheet 2x1" "--export $work/two.tfx"; do
    # shellcheck disable=SC2086 # lists of words
    run 2 assets/curls.tfx --followers 0 --frames 2 $words; one_line; says "two"
done
none "$work/two"
# Images of an AOV are opaque, whatever the background.
run 0 assets/curls.tfx --followers 0 --frames 2 --size 32x32 --aov coverage --background transparent -q -o "$work/two.y4m"; is_file "$work/two.y4m"

claim "one .npz file takes all frames, those of one for each frame"
run 0 assets/curls.tfx --followers 0 --frames 3 --first 1 -q --export "$work/all.npz"
run 0 assets/curls.tfx --followers 0 --frames 3 --first 1 -q --export "$work/each_%04d.npz"
"$bin/tractrix-convert" "$work/all.npz" -q -o "$work/out_%04d.npz" 2>"$work/err"
for frame in 1 2; do
    if "$bin/tractrix-convert" "$work/out_000$frame.npz" -q -o "$work/a.usda" && "$bin/tractrix-convert" "$work/each_000$frame.npz" -q -o "$work/b.usda" && cmp -s "$work/a.usda" "$work/b.usda"; then good; else bad "frame $frame differs"; fi
done

claim "a scalp of another size than a head's names the unit that gives it a head"
dark assets/curls.tfx --unit 10 --followers 0 --frames 1 --size 16x16 -o "$work/head.png"; says "scalp: none: it would not be as large as a head"; says "the scalp is 1.5 m wide, a head's 0.15 m: with --unit m it is as wide"
dark assets/curls.tfx --unit 0.5 --followers 0 --frames 1 --size 16x16 -o "$work/head.png"; says "scalp: none: it would not be"; says "with --unit m it is as wide"

claim "hair on a scalp gets a head that hides and holds it; --scalp none, -q and what is no scalp are silent"
dark assets/curls.tfx --followers 0 --frames 1 --size 48x32 -o "$work/head.png" --stats "$work/stats.json"; says "scalp: guessed a head of 0.1"; in_file "$work/stats.json" '"sphere"'
dark assets/curls.tfx --followers 0 --frames 1 --size 48x32 --no-collide-mesh -o "$work/head.png" --stats "$work/stats.json"; says "scalp: guessed a head of 0.1"
if grep -q '"sphere"' "$work/stats.json"; then bad "a fitted head holds hair with --no-collide-mesh"; else good; fi
dark assets/curls.tfx --followers 0 --frames 1 --size 48x32 --scalp none -o "$work/bare.png"; if grep -q "scalp" "$work/err"; then bad "said something"; else good; fi
if cmp -s "$work/head.png" "$work/bare.png"; then bad "the same picture"; else good; fi
dark assets/fur.tfx --frames 1 --size 16x16 -v -o "$work/fur.png"; says "scalp: none: the roots are not on top"; says "the roots surround a body that is not drawn, and the far side shows through: expected --mesh with its shape"
dark assets/fur.tfx --mesh assets/ball.obj --frames 1 --size 16x16 -o "$work/fur.png"; if grep -q "surround" "$work/err"; then bad "said something"; else good; fi
dark assets/curls.tfx --followers 0 --frames 1 --size 16x16 -q -o "$work/bare.png"; silent err
run 0 assets/curls.tfx --frames 1 --size 16x16 --look plain -o "$work/bare.png"; if grep -q "scalp" "$work/err"; then bad "said something"; else good; fi
dark assets/curls.tfx --followers 0 --frames 3 --size 16x16 --cache "$work/scalp.cache"; dark assets/curls.tfx --followers 4 --frames 3 --size 16x16 --from-cache "$work/scalp.cache" -o "$work/scalp/"

claim "hair of few strands is filled, in one line, unless the user says a number"
dark assets/curls.tfx --frames 1 --size 16x16 -o "$work/fill/" --stats "$work/stats.json"; says "assets/curls.tfx: 1200 followers fill the space between 300 strands: set --followers to change their number"
in_file "$work/stats.json" '"followers": 1200'
dark assets/curls.tfx --followers 0 --frames 1 --size 16x16 -o "$work/fill/"; if grep -q "followers" "$work/err"; then bad "said something"; else good; fi
dark assets/curls.tfx --frames 1 --size 16x16 -q -o "$work/fill/"; silent err

claim "if only the fibre radius keeps hair of few strands from being filled, a line gives the options"
dark assets/curls.tfx --radius 0.0002 --frames 1 --size 16x16 -o "$work/fill/" --stats "$work/stats.json"
says "assets/curls.tfx: the space between 300 strands is not filled because --radius is given: --followers 4 --follow interpolate fills it"
in_file "$work/stats.json" '"followers": 0'
dark assets/curls.tfx --radius 0.0002 --followers 0 --frames 1 --size 16x16 -o "$work/fill/"; if grep -q "filled" "$work/err"; then bad "said something"; else good; fi
dark assets/bob.tfx --radius 0.0002 --frames 1 --size 16x16 -o "$work/fill/"; if grep -q "filled" "$work/err"; then bad "said something"; else good; fi

claim "a variant that may run away is told, unless quiet"
# shellcheck disable=SC2086
{
run 0 $hair $plain --algo emulation --variant thesis --frames 1 --size 16x16 -o "$work/e/"; says "gains energy"
run 0 $hair $plain --algo emulation --variant thesis --frames 1 --size 16x16 -q -o "$work/e/"
}
if [ -s "$work/err" ]; then bad "said something"; else good; fi

claim "slow motion, a rate of its own, and a warm-up"
# shellcheck disable=SC2086
run 0 $hair $plain --algo split --frames 2 --size 16x16 --speed 0.25 --sim-rate 100 --preroll 0.1 --substeps auto -v -o "$work/slow/"
says "steps of 10 ms"; says "10 before the first"
run 2 $hair --substeps 0 -o "$work/x/"; one_line; says "auto or a whole number"

claim "help, version and lists"
run 0 --help; says "--turntable"
run 0 --help all; says "--lod-width"; says "Exit status"
run 0 --version; says "tractrix-render"
run 0 --algo list; says "thesis"
run 0 --list-devices; says "OpenGL"
if grep 'UUID' "$work/out" | grep -qvE 'UUID [0-9a-f]{8}(-[0-9a-f]{4}){3}-[0-9a-f]{12}(,|$)'; then bad "a UUID is not whole"; else good; fi

claim "video through ffmpeg"
if command -v ffmpeg >/dev/null; then
    # shellcheck disable=SC2086
    run 0 $hair $plain --frames 4 --size 64x48 -o "$work/v.mp4"
    is_file "$work/v.mp4"
    run 1 $hair --look plain --frames 4 --size 64x48 -o "/proc/v.mp4"
else
    skip "no ffmpeg"
fi

claim "keys of a color are refused on hair that is painted once"
"$bin/tractrix-gen" --kind straight --count 20 --vertices 8 -q -o "$work/few.tfx"
printf '{"sections": [{"file": "few.tfx", "tip_length": 0.5, "color": {"keys": [{"time": 0, "value": "#ff0000"}, {"time": 1, "value": "#00ff00"}]}}]}' >"$work/keys.json"
run 2 "$work/keys.json" --look plain --algo none --frames 1 --size 32x24 -q -o "$work/keys.png"; one_line
says "few.tfx: color: cannot change over time, because the hair has tips of another color: expected one value, or --tip-length 0"
run 0 "$work/keys.json" --look plain --algo none --frames 1 --size 32x24 -q --tip-length 0 -o "$work/keys.png"

claim "exported hair has the color that it shows"
run 0 "$work/few.tfx" --algo none --frames 1 --size 32x24 -q --melanin 1.3 --export "$work/few.usda"
says_color() { if grep -a displayColor "$work/few.usda" | grep -qF "$1"; then good; else bad "no color $1"; fi; }
# red by paint.c's formula: 0.0095 + 0.435 exp(-3.35 sigma^0.59), sigma = 1.3 x 0.419
says_color "(0.0513"

claim "hair with a material goes to USD and comes back with it"
rod="--algo rod --frames 1 --size 32x24 --preroll 0"
# shellcheck disable=SC2086
{
    run 0 "$work/few.tfx" $rod -q --youngs-modulus 2.5 --hair-radius 40 --poisson 0.3 --export "$work/rod.usda"; silent err
    run 0 "$work/rod.usda" $rod --hair-density 1200 --stats "$work/rod.json" --export "$work/again.usda"
    says "rod.usda: the file has a material: 2.5 GPa, Poisson's ratio 0.3, 1200 kg/m3, radius 40 um are used"
    for part in '"youngs_modulus": 2.5' '"hair_radius": 40' '"poisson": 0.3' '"hair_density": 1200'; do in_file "$work/rod.json" "$part"; done
    in_file "$work/again.usda" "physics:density = 1200"; in_file "$work/again.usda" "physics:youngsModulus = 2.5e+09"
    "$bin/tractrix-convert" "$work/again.usda" --stats >"$work/out"; says "(2.5 GPa, radius 40 um, 1200 kg/m3)"
    run 0 "$work/rod.usda" $rod --youngs-modulus 4:1 --export "$work/again.usda"; says "--export: USD (.usda) files leave out: material of fibres"
    if grep -q physics: "$work/again.usda"; then bad "a material that varies is written"; else good; fi
}

finish
