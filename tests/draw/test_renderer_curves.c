// SPDX-License-Identifier: MIT
// Smooth strands.
#include "base/random.h"
#include "support/stage.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// The definitions of the curves by other algorithms than the shader's: the pyramid of Barry and
// Goldman for the centripetal Catmull-Rom spline, and de Boor's algorithm for the uniform cubic
// B-spline, whose knots are 1 apart.
static double interpolate(double a, double b, double from, double to, double t)
{
    return ((to - t) * a + (t - from) * b) / (to - from);
}

static void curve_at(CurveKind kind, const double p[4][3], double share, float point[3])
{
    double knot[6] = {0};
    for (int i = 1; i < 4; ++i) {
        double square = 0;
        for (int k = 0; k < 3; ++k) square += pow(p[i][k] - p[i - 1][k], 2);
        knot[i] = knot[i - 1] + pow(square, 0.25);
    }
    for (int k = 0; k < 3; ++k) {
        double x[4] = {p[0][k], p[1][k], p[2][k], p[3][k]};
        if (kind == CURVE_CATMULL_ROM) {
            double t = knot[1] + share * (knot[2] - knot[1]);
            for (int i = 0; i < 3; ++i) x[i] = interpolate(x[i], x[i + 1], knot[i], knot[i + 1], t);
            for (int i = 0; i < 2; ++i) x[i] = interpolate(x[i], x[i + 1], knot[i], knot[i + 2], t);
            point[k] = (float)interpolate(x[0], x[1], knot[1], knot[2], t);
        } else {
            double t = 2 + share; // the four points have the knots 0 .. 5
            for (int level = 1; level < 4; ++level)
                for (int i = 0; i < 4 - level; ++i)
                    x[i] = interpolate(x[i], x[i + 1], i + level - 1, i + 3, t);
            point[k] = (float)x[0];
        }
    }
}

static Strands make_curve(CurveKind kind, const Strands *from, uint32_t parts)
{
    uint32_t n = strands_size(from, 0), many = (n - 1) * parts + 1;
    float(*position)[3] = malloc((size_t)from->strand_count * many * sizeof *position);
    assert_non_null(position);
    for (uint32_t s = 0; s < from->strand_count; ++s)
        for (uint32_t i = 0; i < many; ++i) {
            uint32_t j = i / parts < n - 1 ? i / parts : n - 2;
            double p[4][3];
            for (int k = 0; k < 3; ++k) {
                for (int at = 0; at < 4; ++at) {
                    int64_t which = (int64_t)j - 1 + at;
                    if (which < 0 || which >= n) continue;
                    p[at][k] = (double)from->position[s * n + (uint32_t)which][k];
                }
                if (j == 0) p[0][k] = 2 * p[1][k] - p[2][k];
                if (j == n - 2) p[3][k] = 2 * p[2][k] - p[1][k];
            }
            curve_at(kind, (const double(*)[3])p, (double)(i - j * parts) / parts,
                     position[s * many + i]);
        }
    Strands strands = studio_strands(from->strand_count, many, (const float(*)[3])position);
    free(position);
    return strands;
}

// A curve computed in floats is within 1e-4 px of the one in doubles. The images differ only by
// rounding and by the particles that are left out on almost straight parts, where rounding may
// decide: those lie within 0.05 px of the curve.
static void smooth_strands_are_curves(void **state)
{
    (void)state;
    enum { COUNT = 20, VERTICES = 7, PARTS = 5 };
    float position[COUNT * VERTICES][3];
    Random random = random_create(11, 0);
    for (int s = 0; s < COUNT; ++s)
        for (int j = 0; j < VERTICES; ++j)
            for (int k = 0; k < 3; ++k)
                position[s * VERTICES + j][k] =
                    (float)((random_real(&random) - 0.5) * (k < 2 ? 200 : 20));
    Strands strands = studio_strands(COUNT, VERTICES, (const float(*)[3])position);
    use(&TRANSPARENT);
    for (CurveKind kind = CURVE_CATMULL_ROM; kind <= CURVE_BSPLINE; ++kind) {
        Strands curves = make_curve(kind, &strands, PARTS);
        size_t size;
        uint32_t item = studio_add(&studio, &curves, 1.5f, 0.5f);
        studio.material[item].tip_ratio = 0.2f;
        uint8_t *expected = draw_copy(&size);
        studio_clear(&studio);
        item = studio_add(&studio, &strands, 1.5f, 0.5f);
        studio.material[item].tip_ratio = 0.2f;
        studio.material[item].curve = kind;
        studio_draw(&studio);
        double straight = 0, off = 0;
        for (size_t i = 3; i < size; i += 4)
            straight += pow((double)studio.image.pixels[i] - expected[i], 2);
        studio.material[item].smooth = PARTS;
        studio_draw(&studio);
        for (size_t i = 3; i < size; i += 4) {
            if (abs(studio.image.pixels[i] - expected[i]) > 12)
                print_message("%d %d\n", studio.image.pixels[i], expected[i]);
            off += pow((double)studio.image.pixels[i] - expected[i], 2);
        }
        assert_true(off < 1e-3 * straight);
        studio_clear(&studio);
        free(expected);
        strands_destroy(&curves);
    }
    strands_destroy(&strands);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        CLAIM(smooth_strands_are_curves),
    };
    return stage_run(tests);
}
