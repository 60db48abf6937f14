#!/bin/sh
# SPDX-License-Identifier: MIT
# The formulas of docs/turntables.md for the place of a point in the image, against pictures of a dot of hair there.
. tests/support/claims.sh
program=$bin/tractrix-render

# formulas POINT EYE TARGET UP FOV WxH DEGREES: column, row and depth, by the formulas of the page and nothing else. Each of
# the first four is x,y,z; DEGREES is what the turntable has turned.
formulas() {
    awk -v p="$1" -v e="$2" -v t="$3" -v u="$4" -v fov="$5" -v size="$6" -v degrees="$7" '
        function dot(a, b) { return a[1] * b[1] + a[2] * b[2] + a[3] * b[3] }
        function cross(a, b, to) { to[1] = a[2] * b[3] - a[3] * b[2]; to[2] = a[3] * b[1] - a[1] * b[3]; to[3] = a[1] * b[2] - a[2] * b[1] }
        function unit(a,    l) { l = sqrt(dot(a, a)); a[1] /= l; a[2] /= l; a[3] /= l }
        BEGIN {
            split(p, P, ","); split(e, E, ","); split(t, T, ","); split(u, U, ","); split(size, S, "x")
            pi = atan2(0, -1); a = degrees * pi / 180
            for (k = 1; k <= 3; ++k) { V[k] = U[k]; B[k] = E[k] - T[k] }
            unit(V); cross(V, B, VB); along = dot(V, B)
            for (k = 1; k <= 3; ++k) E[k] = T[k] + B[k] * cos(a) + VB[k] * sin(a) + V[k] * along * (1 - cos(a))
            for (k = 1; k <= 3; ++k) { F[k] = T[k] - E[k]; D[k] = P[k] - E[k] }
            unit(F); cross(F, U, R); unit(R); cross(R, F, up)
            s = S[2] / (2 * sin(fov * pi / 360) / cos(fov * pi / 360)); z = dot(D, F)
            printf "%.4f %.4f %.4f\n", S[1] / 2 + s * dot(D, R) / z, S[2] / 2 - s * dot(D, up) / z, z
        }'
}

# drawn POINT WxH OPTION...: the same three from pictures of a strand of 2 mm whose middle is the point: the mean place of
# its coverage, and the depth at its best covered pixel.
drawn() {
    echo "$1" | awk -F, '{ printf "v %.6f %.6f %.6f\nv %.6f %.6f %.6f\nl 1 2\n", $1, $2 - 0.001, $3, $1, $2 + 0.001, $3 }' >"$work/dot.obj"
    size=$2
    shift 2
    for aov in coverage depth; do
        "$program" "$work/dot.obj" --unit m --up y --algo none --scalp none --followers 0 --radius 0.0006 --tip-ratio 1 \
            --size "$size" "$@" --aov $aov -q -o "$work/$aov.pfm" 2>>"$work/err"
        # The last W H 3 floats of the file are the pixels, each three times the same; the lowest row is the first.
        tail -c $((${size%x*} * ${size#*x} * 12)) "$work/$aov.pfm" | od -An -v -tf4 -w12 | awk '{ print $1 }' >"$work/$aov.text"
    done
    paste "$work/coverage.text" "$work/depth.text" | awk -v size="$size" '
        BEGIN { split(size, S, "x") }
        $1 > 0 { i = (NR - 1) % S[1]; j = S[2] - 1 - int((NR - 1) / S[1]); sum += $1; x += $1 * (i + 0.5); y += $1 * (j + 0.5); if ($1 > most) { most = $1; depth = $2 } }
        END { if (sum > 0) printf "%.4f %.4f %.4f\n", x / sum, y / sum, depth; else print "-9 -9 -9" }'
}

# agree FORMULAS DRAWN: within a quarter of a pixel, as the page says, and in depth within 1 mm: the strand is 2 mm long.
agree() {
    if echo "$1 $2" | awk '{ dx = $1 - $4; dy = $2 - $5; dz = $3 - $6; exit !(dx * dx < 0.0625 && dy * dy < 0.0625 && dz * dz < 1e-6) }'; then good; else bad "formulas: $1, drawn: $2"; fi
}

claim "points lie where the formulas say, in wide and high images, with any field of view and up direction"
while read -r point eye target up fov size; do
    agree "$(formulas "$point" "$eye" "$target" "$up" "$fov" "$size" 0)" "$(drawn "$point" "$size" "--eye=$eye" "--target=$target" "--camera-up=$up" --fov "$fov")"
done <<END
0.1,0.05,0 0.3,0.2,0.8 0.02,0,0 0,1,0 25 320x200
-0.12,0.15,0.1 0.3,0.2,0.8 0.02,0,0 0,1,0 40 200x320
0.05,-0.1,-0.05 -0.4,0.5,-0.6 0,0.05,0.1 0.3,1,0.2 30 240x240
0.2,0.1,0.3 0,0.1,1 0,0,0 1,0.2,0 60 300x180
END

claim "a turntable turns the eye as the formulas say"
for frame in 1 5; do
    agree "$(formulas 0.1,0.05,0 0.3,0.2,0.8 0.02,0,0 0,1,0.2 25 320x200 $((frame * 45)))" \
        "$(drawn 0.1,0.05,0 320x200 --eye=0.3,0.2,0.8 --target=0.02,0,0 --camera-up=0,1,0.2 --fov 25 --turntable --frames 8 --first $frame --last $frame)"
done

claim "--verbose prints an automatic camera, from which the same picture comes"
run 0 assets/curls.tfx --algo none --frames 1 --look plain --followers 0 --size 64x64 --verbose -o "$work/auto.png"
camera=$(sed -n 's/^camera: --/--/p' "$work/err")
# shellcheck disable=SC2086 # two words
run 0 assets/curls.tfx --algo none --frames 1 --look plain --followers 0 --size 64x64 -q $camera -o "$work/given.png"
case $camera in --eye=*' --target='*) good ;; *) bad "camera: $camera" ;; esac
same_images "$work/auto.png" "$work/given.png"
finish
