#!/bin/sh
# SPDX-License-Identifier: MIT
# tractrix-bench light: bounds against path-traced cases, and messages about wrong files. No timings.
. tests/support/claims.sh
program=$bin/tractrix-bench

# field FILE.csv NAME: the column's values, one on each line.
field() { awk -F, -v name="$2" 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == name) at = i; next } { print $at }' "$1"; }
# same A B WHAT
same() { if [ "$1" = "$2" ]; then good; else bad "$3: got '$1', expected '$2'"; fi; }

claim "single scattering and all light hold their bounds: fur in the sun, blond curls in sun and sky"
run 0 light --case curls_blond_front,curls_blond_sky,fur_brown_side --way none,grid --frames 0 --csv "$work/a.csv" --json "$work/a.json"
same "$(field "$work/a.csv" verdict | grep -c holds)" 6 "rows that hold"
same "$(field "$work/a.csv" way | sort | uniq -c | tr -s ' \n' ' ')" " 4 grid 4 none " "rows, and a mean for each way"
same "$(grep -c '"mean_r"' "$work/a.json")" 8 "rows of JSON"
same "$(field "$work/a.csv" still_ms_min | grep -c .)" 0 "times that --frames 0 leaves out"
same "$(field "$work/a.csv" width | sort | uniq -c | tr -s ' ')" " 8 320" "widths, also of the means"
for way in none grid; do
    for name in coverage mean_r rel_b; do
        same "$(awk -F, -v way=$way -v name=$name '
            NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i; next }
            $at["way"] == way && $at["scene"] == "mean" { mean = $at[name]; next }
            $at["way"] == way { sum += $at[name]; ++count }
            END { print count, (sum / count / mean - 1) ^ 2 < 1e-8 }' "$work/a.csv")" "3 1" "mean $name of $way"
    done
done

claim "so do straight, parallel, dense hair against the light and under a sky"
mkdir "$work/straight"
cp tests/data/light_straight/* "$work/straight/"
"$bin/tractrix-gen" --kind straight --shape head --count 6000 --vertices 24 --length 0.35 --seed 5 -q -o "$work/straight/straight6k.tfx"
run 0 light --reference "$work/straight" --case straight_black_sky,straight_brown_back --way none,grid --frames 0 --csv "$work/straight.csv"
same "$(field "$work/straight.csv" verdict | grep -c holds)" 4 "rows of cases that hold"

# Tables of 96 paths a pixel by --way traced, since Cycles's are wrong for this hair (docs/notes/straight_light.md).
# The grid loses the shape of the light there, so rel is not asked.
claim "the mean of straight blond hair is within 0.85 to 1.15 of our own path tracer's"
mkdir "$work/blond"
cp tests/data/light_traced/* "$work/straight/straight6k.tfx" "$work/blond/"
run 1 light --reference "$work/blond" --case straight_blond_front,straight_blond_side --way grid --frames 0 --csv "$work/blond.csv"
for channel in r g b; do
    same "$(field "$work/blond.csv" mean_$channel | head -2 | awk '{ good += $1 > 0.85 && $1 < 1.15 } END { print good }')" 2 "means of $channel"
done

# Tables of 192 paths a pixel by tractrix-bench trace.
claim "wide lights and environments hold the bounds of single scattering and of all light"
run 0 light --reference tests/data/light_wide --case curls_blond_front5,curls_brown_back20,curls_blond_dusk,curls_black_dusk --way none,grid --frames 0 --csv "$work/wide.csv"
same "$(field "$work/wide.csv" verdict | grep -c holds)" 8 "rows of cases that hold"
# The rel of single scattering is 0.164, above the bound of 0.16.
run 1 light --reference "$work/blond" --case straight_brown_back20 --way none,grid --frames 0 --csv "$work/wide.csv"
for channel in r g b; do
    same "$(field "$work/wide.csv" mean_$channel | head -2 | awk '{ good += $1 > 0.92 && $1 < 1.12 } END { print good }')" 2 "means of $channel in straight hair"
done

# With 8 cells the means are off by 2.5 %, equally with both. Measured differences: up to 0.0027.
claim "both rasterisers show the same light and cover the same"
for raster in quads blocks; do
    run 0 light --case fur_brown_side --way grid --raster $raster --frames 0 --render='--scatter-cells 8' --csv "$work/$raster.csv"
    same "$(field "$work/$raster.csv" raster | head -1)" $raster "rasteriser"
done
for name in coverage mean_r mean_g mean_b; do
    same "$(for raster in quads blocks; do field "$work/$raster.csv" $name | head -1; done |
        awk '{ value[NR] = $1 } END { print NR, (value[1] > 0.9 && (value[1] - value[2]) ^ 2 < 0.005 ^ 2) }')" "2 1" "$name"
done

# A picture has two tiles of 16 x 16. The simple lights of the traced cases cost less than those of the look.
claim "a folder of one's own, with a picture of it"
mkdir "$work/own"
printf '{"sections": [{"file": "hair.tfx", "unit": "m", "algo": "none", "shading": "marschner"}], "size": [16, 16], "shadow": "dom", "sky": "#808080", "lights": [{"direction": [0, -1, 0]}]}' >"$work/own/one.json"
"$bin/tractrix-gen" --kind fur --count 40 --vertices 8 --seed 1 -q -o "$work/own/hair.tfx"
table() {
    echo column,row,one_r,one_g,one_b,all_r,all_g,all_b,coverage
    for place in 0,0 1,0 0,1 1,1; do echo "$place,$1,0.2,0.3,0.1,0.2,0.3,0.5"; done
}
table 0.1 >"$work/own/one.csv"
cp "$work/own/one.json" "$work/own/scene.json"
run 1 light --reference "$work/own" --way none --frames 1 --picture "$work/own.png" --csv "$work/own_rows.csv"
says "scene.json: not a case"; says "bounds are broken"; is_png "$work/own.png"
same "$(field "$work/own_rows.csv" scene | tr '\n' ' ')" "one mean " "cases"
same "$(field "$work/own_rows.csv" strands | head -1)" 40 "strands"
same "$(field "$work/own_rows.csv" still_ms_min | awk '{ good += $1 > 0 } END { print good }')" 2 "rows with times"
same "$(field "$work/own_rows.csv" repeat | awk '{ good += $1 < 1e-5 } END { print good }')" 2 "images that are drawn again at rest"

claim "our own path tracer draws a case only where it is named, and only hair that it knows"
cp -r "$work/own" "$work/traced"
printf '{"sections": [{"file": "hair.tfx", "unit": "m", "algo": "none", "shading": "marschner", "tip_ratio": 1, "cone_angle": 0, "color_variation": 0, "followers": 0}], "size": [16, 16], "sky": "#808080", "lights": [{"direction": [0, -1, 0]}]}' >"$work/traced/one.json"
run 0 light --reference "$work/traced" --case one --way "traced one,traced" --frames 1 --csv "$work/traced.csv"
same "$(field "$work/traced.csv" way | sort | uniq -c | tr -s ' \n' ' ')" " 2 traced 2 traced one " "rows"
same "$(field "$work/traced.csv" mean_r | awk '{ good += $1 > 0 } END { print good }')" 4 "images with light"
run 2 light --reference "$work/own" --case one --way traced --frames 1; says "the path tracer: a section has options that the path tracer does not support"; says "tip_ratio 1"
for other in "color_variation 0.1" "warmth_variation 0.1" "followers 2" "algo hybrid" "opacity 0.5"; do
    run 2 light --reference "$work/traced" --case one --way traced --frames 1 --render="--$(echo "$other" | tr _ -)"
    says "the path tracer: a section has options that the path tracer does not support"
done
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >"$work/traced/triangle.obj"
run 2 light --reference "$work/traced" --case one --way traced --frames 1 --render="--mesh $work/traced/triangle.obj"; says "expected hair only"

claim "trace writes the table of a scene, which is then a case: that of a wide light in an environment, too"
mkdir "$work/trace"
cp "$work/own/hair.tfx" tests/data/light_wide/dusk.pfm "$work/trace/"
sed 's|"lights": .*|"environment": "dusk.pfm", "lights": [{"direction": [0, -1, 0], "radius": 20}]}|; s/"sky": "#808080", //' "$work/traced/one.json" >"$work/trace/one.json"
run 0 trace "$work/trace/one.json" --frames 1; says "one.csv: 8 paths a pixel"
cp "$work/trace/one.csv" "$work/first_table.csv"
run 0 trace "$work/trace/one.json" --frames 1
same "$(cmp "$work/trace/one.csv" "$work/first_table.csv" && echo same)" same "the same table again"
# The same number of paths has the same noise; the table has four digits.
run 0 light --reference "$work/trace" --way "traced one,traced" --frames 1 --csv "$work/again.csv"
same "$(field "$work/again.csv" rel_g | awk '{ good += $1 < 1e-3 } END { print good }')" 4 "images that are the table's"
run 2 trace; says "trace: expected scene files"
run 2 trace "$work/trace/one.json" --frames 0; says "--frames: got 0"
run 2 trace "$work/trace/hair.tfx"; says "expected a scene file NAME.json"
sed 's/"size": \[16, 16\]/"size": [16, 20]/' "$work/trace/one.json" >"$work/trace/odd.json"
run 3 trace "$work/trace/odd.json"; says "the image has 16x20 pixels: expected multiples of 8"

claim "an image that is the tracer's has a mean of 1 and a rel of 0"
# The mean of the first run's image over the table gives the table's values for the image. A single block has no other
# shape.
printf '{"sections": [{"file": "hair.tfx", "unit": "m", "algo": "none", "shading": "marschner"}], "size": [8, 8], "shadow": "dom", "sky": "#808080", "lights": [{"direction": [0, -1, 0]}]}' >"$work/own/one.json"
table 0.1 | head -2 >"$work/own/one.csv"
run 1 light --reference "$work/own" --case one --way none --frames 1 --csv "$work/first.csv"
light() { field "$work/first.csv" "mean_$1" | head -1 | awk -v traced="$2" '{ printf "%.12g", $1 * traced }'; }
{ table 0 | head -1; echo "0,0,$(light r 0.1),$(light g 0.2),$(light b 0.3),0.1,0.2,0.3,0.5"; } >"$work/own/one.csv"
run 0 light --reference "$work/own" --case one --way none --frames 1 --csv "$work/second.csv"
for channel in r g b; do
    same "$(field "$work/second.csv" mean_$channel | head -1 | awk '{ print ($1 - 1) ^ 2 < 1e-12 }')" 1 "mean of $channel"
    same "$(field "$work/second.csv" rel_$channel | head -1 | awk '{ print $1 < 1e-6 }')" 1 "rel of $channel"
done

claim "files that are wrong end with 3 and one line behind that of the device"
says_once() { same "$(grep -vc 'OpenGL\|: not a case: ' "$work/err")" 1 "lines"; }
broken() { run 3 light --reference "$work/own" --case one --way none --frames 1; says "$1"; says_once; }
table 0.1 | head -4 >"$work/own/one.csv"; broken "one.csv: got 3 lines"
{ table 0.1 | head -4; echo 0,0,1,1,1,1,1,1,1; } >"$work/own/one.csv"; broken "one.csv:5: a second line for block 0, 0"
table nan >"$work/own/one.csv"; broken "one.csv:2: one_r"
table -1 >"$work/own/one.csv"; broken "one.csv:2: one_r: got -1"
table 0 >"$work/own/one.csv"; broken "one_r is 0 in every block"
table 0.1 | cut -d, -f 1-8 >"$work/own/one.csv"; broken "coverage"
table 0.1 | sed 's/^1,1,/-1,1,/' >"$work/own/one.csv"; broken "one.csv:5: column: got -1"
table 0.1 | sed '3s/,0.5$//' >"$work/own/one.csv"; broken "one.csv:3: 8 fields"
table 0.1 >"$work/own/one.csv"; broken "one.csv: 2 x 2 blocks of 8 pixels"
printf '{"sections": [' >"$work/own/one.json"; broken "one.json"
printf '{"sections": [{"file": "none.tfx"}], "size": [16, 16]}' >"$work/own/one.json"; broken "none.tfx"

claim "folders and names that there are not"
run 3 light --reference "$work/nothing"; says "$work/nothing: no such folder"; says "--reference DIR"; says_once
mkdir "$work/empty"
run 3 light --reference "$work/empty"; says "no cases"; says_once
run 2 light --case fur_brown_sid; says "no case 'fur_brown_sid'"; says_once
run 2 light --way gird; says "no way 'gird'"; says "grid"; says_once
run 2 light --case fur_brown_side --render=--no-such-flag; says "--no-such-flag"; says_once
run 2 light --case fur_brown_side --before "$work"; says "--picture"; says_once
run 2 light --case fur_brown_side --way traced --frames 0; says "--frames: got 0, expected 1 or more"; says_once

finish
