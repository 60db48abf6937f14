#!/bin/sh
# SPDX-License-Identifier: MIT
# What the automatic camera shows of the scenes in assets/: hair and head fill the picture, and motion stays in it.
. tests/support/claims.sh
program=$bin/tractrix-render
command -v ffmpeg >/dev/null || { echo "skipped: no ffmpeg"; exit 77; }

# draw SCENE OPTION...: draws it on nothing, small and cheap, in its own shape, into $work/frames.
draw() {
    scene=assets/$1.json
    shift
    rm -rf "$work/frames"
    run 0 "$scene" --size "$size" --look plain --background transparent --shadow none --no-collide-mesh --preroll 0 "$@" -q -o "$work/frames/"
}

# box: the columns and rows "X1 X2 Y1 Y2" that anything covers in some frame.
box() {
    ffmpeg -nostdin -hide_banner -pattern_type glob -i "$work/frames/*.png" -vf alphaextract,bbox=min_val=24 -f null - 2>&1 |
        sed -nE 's/.* x1:([0-9]+) x2:([0-9]+) y1:([0-9]+) y2:([0-9]+) .*/\1 \2 \3 \4/p' |
        awk 'NR == 1 { a = $1; b = $2; c = $3; d = $4 }
             { if ($1 < a) a = $1; if ($2 > b) b = $2; if ($3 < c) c = $3; if ($4 > d) d = $4 }
             END { print a, b, c, d }'
}

size=96x96
claim "the scenes are as wide as they are high, as their subjects are"
for name in bob demo fall gust shaking; do
    if grep -q '"size": "720x720"' assets/$name.json; then good; else bad "$name: other than square"; fi
done

claim "hair and head span 78 to 97 % of the picture at rest; room is left for the motion that is expected"
for name in bob demo fall shaking; do
    draw $name --last 0
    # shellcheck disable=SC2046
    set -- $(box)
    share=$(echo "$1 $2 $3 $4" | awk '{ w = $2 - $1 + 1; h = $4 - $3 + 1; print int(100 * (w > h ? w : h) / 96) }')
    if [ "$share" -ge 78 ] && [ "$share" -le 97 ]; then good; else bad "$name: $share %"; fi
done

claim "a gust that lifts hair leaves it in the picture, which it fills"
draw gust --every 5
# shellcheck disable=SC2046
set -- $(box)
if [ "$1" -ge 1 ] && [ "$2" -le 94 ] && [ "$3" -ge 1 ] && [ "$4" -le 94 ]; then good; else bad "columns $1 to $2, rows $3 to $4 of 0 to 95"; fi
if [ $(($4 - $3)) -ge 76 ] || [ $(($2 - $1)) -ge 76 ]; then good; else bad "columns $1 to $2, rows $3 to $4: the picture is not filled"; fi
finish
