// SPDX-License-Identifier: MIT
// The formulas of glsl/kernel/cell.h and grain.h in C and in a shader: both are compared with
// independent expected values, since an error in the header would affect both alike.
#include "base/random.h"
#include "gpu/gpu_buffer.h"
#include "support/needed.h"
#include "support/test_glsl.h"

#include "tests/glsl/probe_cells.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { SETS = 512, IN = PROBE_INPUTS, OUT = PROBE_RESULTS };

static float inputs[SETS][IN];

// a[0]: 0 .. 8, mostly small; a[1]: 0 .. 2, sometimes exactly 0; a[2]: 0.11 .. 2; then a tangent, a
// direction and a unit axis.
static void make_inputs(void)
{
    Random random = random_create(11, 0);
    for (int n = 0; n < SETS; ++n) {
        float *a = inputs[n], square = 0;
        a[0] = (float)(8 * pow(random_real(&random), 4));
        a[1] = n % 16 ? (float)(2 * random_real(&random)) : 0;
        a[2] = (float)(0.11 + 1.89 * random_real(&random));
        for (int k = 3; k < IN; ++k) a[k] = (float)(2 * random_real(&random) - 1);
        for (int k = 9; k < IN; ++k) square += a[k] * a[k];
        for (int k = 9; k < IN; ++k) a[k] /= sqrtf(square);
    }
}

static double dot(const float *a, const float *b)
{
    return (double)a[0] * b[0] + (double)a[1] * b[1] + (double)a[2] * b[2];
}

static void cross(const float *a, const float *b, float out[3])
{
    for (int k = 0; k < 3; ++k) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        out[k] = a[i] * b[j] - a[j] * b[i];
    }
}

static void expect_near(const char *what, int set, double got, double expected, double within)
{
    if (!(fabs(got - expected) <= within))
        fail_msg("%s, set %d: %.9g, not %.9g", what, set, got, expected);
}

// Allows for rounding in a few operations on numbers up to 8: 1e-5.
static void expect_light(const char *by, int n, const float *a, const float *r)
{
    double left = exp(-(double)a[0]), mean = a[0] > 0 ? -expm1(-(double)a[0]) / (double)a[0] : 1,
           falling = a[1] > 0 ? fmin((double)a[2] / a[1], 0.95) : 0,
           further = falling / (1 - falling), rest = a[2] * further;
    expect_near(by, n, r[0], left, 1e-6);
    expect_near(by, n, r[1], mean, 1e-4); // the rounding of a difference near 1e-3 is that large
    expect_near(by, n, r[2], falling, 1e-6);
    expect_near(by, n, r[3], further, 1e-5 * (1 + further * further));
    if (fabs(rest - 0.05 * (a[0] + rest)) > 1e-4)
        expect_near(by, n, r[4], rest > 0.05 * (a[0] + rest), 0);
}

// Checks the tangent's position among the table's nodes, which lie on an octahedron. Then checks
// the turned tangent: the rotation takes the direction to the eye to the axis and keeps the
// tangent's components along the direction and along the normal of both.
static void expect_tangent(const char *by, int n, const float *a, const float *r)
{
    int patch = (int)r[5], node = (int)r[6];
    double u = (patch % 10 * 3 + node % 4 + (double)r[7]) / 15 - 1,
           v = (patch / 10 * 3 + node / 4 + (double)r[8]) / 15 - 1, z = 1 - fabs(u) - fabs(v);
    float way[3] = {(float)u, (float)v, (float)z}, normal[3], to[3];
    if (z < 0) way[0] = (float)copysign(1 - fabs(v), u), way[1] = (float)copysign(1 - fabs(u), v);
    assert_in_range(patch, 0, 99);
    assert_true(node / 4 < 3 && node % 4 < 3);
    expect_near(by, n, dot(way, a + 3), sqrt(dot(way, way) * dot(a + 3, a + 3)), 1e-5);
    float length = sqrtf((float)dot(a + 6, a + 6));
    for (int k = 0; k < 3; ++k) to[k] = a[6 + k] / length;
    cross(to, a + 9, normal);
    if (dot(to, a + 9) < -0.9) return; // half a turn, about an axis that is not defined
    expect_near(by, n, dot(r + 9, a + 9), dot(a + 3, to), 2e-5);
    expect_near(by, n, dot(r + 9, normal), dot(a + 3, normal), 2e-5);
    expect_near(by, n, dot(r + 9, r + 9), dot(a + 3, a + 3), 5e-5);
}

static double count_at(int c)
{
    return (double)c * c;
}

static void expect_numbers(const char *by, int n, const float *a, const float *r)
{
    int lane = (int)(a[2] * 10.f);
    double square = floor(0.5 * (1.2 * (double)a[9] + 1) * 24);
    if (fabs(0.5 * (1.2 * (double)a[9] + 1) * 24 - round(0.5 * (1.2 * (double)a[9] + 1) * 24)) >
        1e-4)
        expect_near(by, n, r[12], fmin(fmax(square, 0), 23), 0);
    expect_near(by, n, r[13], 100 / lane, 0);
    assert_true(r[14] >= 3 * (float)lane && r[14] < 4 * (float)lane);
    expect_near(by, n, r[15], lane + 2 < 7 ? lane + 2 : 7, 0);
    float y = 3 * a[2];
    bool inside = a[0] >= 1 && a[0] < 4 && y >= 1 && y < 3;
    expect_near(by, n, r[16], inside ? (2 * 4 + (int)y) * 5 + (int)a[0] : -1, 0);
    expect_near(by, n, r[17],
                2 * count_at(lane) + count_at(lane - 1) + count_at(lane + 1) + count_at(lane - 3) +
                    count_at(lane + 3) + count_at(lane - 7) + count_at(lane + 7),
                0);
}

static void expect_all(const char *by, const float results[SETS][OUT])
{
    for (int n = 0; n < SETS; ++n) {
        expect_light(by, n, inputs[n], results[n]);
        expect_tangent(by, n, inputs[n], results[n]);
        expect_numbers(by, n, inputs[n], results[n]);
    }
}

static void c_finds_what_formulas_say(void **state)
{
    (void)state;
    static float results[SETS][OUT];
    for (int n = 0; n < SETS; ++n) probe_cells(inputs[n], results[n]);
    expect_all("C", (const float(*)[OUT])results);
}

static void shaders_find_what_formulas_say(void **state)
{
    (void)state;
    Gpu gpu;
    GpuBuffer in, out;
    GLuint program = 0;
    NEEDED(gpu_create(&gpu, &(GpuOptions){0}, error));
    shader_add_sources(TEST_GLSL_SOURCES);
    NEEDED(shader_build_compute(&program, "probe_cells.comp", NULL, error));
    NEEDED(gpu_buffer_create(&in, &gpu.limits, "inputs", sizeof inputs, inputs, 0, error));
    NEEDED(
        gpu_buffer_create(&out, &gpu.limits, "results", (int64_t)SETS * OUT * 4, NULL, 0, error));
    gpu_buffer_bind_storage(&in, 0);
    gpu_buffer_bind_storage(&out, 1);
    glUseProgram(program);
    glDispatchCompute(SETS / 32, 1, 1);
    float(*results)[OUT] = gpu_buffer_read(&out);
    assert_non_null(results);
    expect_all("a shader", (const float(*)[OUT])results);
    free(results);
    gpu_buffer_destroy(&in);
    gpu_buffer_destroy(&out);
    shader_release(program);
    gpu_destroy(&gpu);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(c_finds_what_formulas_say),
        cmocka_unit_test(shaders_find_what_formulas_say),
    };
    make_inputs();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
