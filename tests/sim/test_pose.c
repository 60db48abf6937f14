// SPDX-License-Identifier: MIT
// The pose of strands at rest against its definition in double precision.
#include "sim/pose.h"

#include "base/random.h"
#include "support/hair_fixture.h"
#include "support/needed.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { STRANDS = 40, VERTICES = 20, LEAD = 1, SLOTS = 48, TEXELS = SLOTS * VERTICES };

typedef float Float4[4];

static const double PI = 3.14159265358979323846;
static const double SHARES[] = {0.2, 0.5, 0.7};

// Angle in degrees between a segment and the direction of gravity; the last ones are in the range
// where the style's share changes.
static const double ANGLES[] = {0, 1e-3, 1, 30, 90, 120, 149, 151, 165, 178, 179.9, 180};
enum { ANGLE_COUNT = sizeof ANGLES / sizeof *ANGLES };

typedef struct Stage {
    HairBatch batch;
    GpuBuffer segments;
    Float4 *rest, *physical; // [TEXELS], owned
    HeadPose head;
    double hanging[3]; // in the world
} Stage;

static void random_unit(Random *random, double v[3])
{
    double square;
    do {
        square = 0;
        for (int k = 0; k < 3; ++k) {
            v[k] = 2 * random_real(random) - 1;
            square += v[k] * v[k];
        }
    } while (square < 0.01 || square > 1);
    for (int k = 0; k < 3; ++k) v[k] /= sqrt(square);
}

static void cross(const double a[3], const double b[3], double c[3])
{
    for (int k = 0; k < 3; ++k)
        c[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// Rotates x by the quaternion (s, c), which need not be normalised.
static void rotate(const double s[3], double c, double x[3])
{
    double t[3], u[3], square = dot(s, s) + c * c;
    cross(s, x, t);
    cross(s, t, u);
    for (int k = 0; k < 3; ++k) x[k] += 2 * (c * t[k] + u[k]) / square;
}

static void turn_head(const HeadPose *head, double x[3])
{
    const double s[3] = {(double)head->rotation[0], (double)head->rotation[1],
                         (double)head->rotation[2]};
    rotate(s, (double)head->rotation[3], x);
}

static void open_stage(Stage *stage)
{
    const Gpu *gpu = fixture_gpu();
    Random random = random_create(3, 0);
    *stage = (Stage){.batch = {.vertex_count = VERTICES, .strand_count = STRANDS},
                     .rest = calloc(TEXELS, sizeof(Float4)),
                     .physical = calloc(TEXELS, sizeof(Float4)),
                     .head = {.rotation = {0.36f, 0.48f, 0, 0.8f}, .translation = {1, 2, 3}},
                     .hanging = {0, -0.6, 0.8}};
    assert_non_null(stage->rest);
    assert_non_null(stage->physical);
    turn_head(&stage->head, stage->hanging);
    for (int i = 0; i < TEXELS; ++i) {
        double style[3], across[3], other[3], angle = ANGLES[i % ANGLE_COUNT] * PI / 180, length;
        random_unit(&random, style);
        random_unit(&random, other);
        cross(stage->hanging, other, across);
        length = sqrt(dot(across, across));
        for (int k = 0; k < 3; ++k) {
            stage->rest[i][k] = (float)style[k];
            stage->physical[i][k] =
                (float)(cos(angle) * stage->hanging[k] + sin(angle) * across[k] / length);
        }
        stage->rest[i][3] = stage->physical[i][3] = 1;
    }
    NEEDED(gpu_buffer_create(&stage->batch.rest, &gpu->limits, "rest", TEXELS * 16, stage->rest,
                             GL_RGBA32F, error));
    NEEDED(gpu_buffer_create(&stage->batch.position, &gpu->limits, "positions", TEXELS * 16, NULL,
                             GL_RGBA32F, error));
    NEEDED(gpu_buffer_create(&stage->segments, &gpu->limits, "segments", TEXELS * 16,
                             stage->physical, GL_RGBA32F, error));
}

static void close_stage(Stage *stage)
{
    gpu_buffer_destroy(&stage->batch.rest);
    gpu_buffer_destroy(&stage->batch.position);
    gpu_buffer_destroy(&stage->segments);
    free(stage->rest);
    free(stage->physical);
}

static Float4 *draw(const Stage *stage, double style)
{
    Pose pose;
    const PoseOptions options = {.style = (float)style, .hanging = {0, -0.6f, 0.8f}};
    NEEDED(pose_create(&pose, fixture_gpu(), &options, error));
    pose_write(&pose, &stage->batch, &stage->segments, LEAD, &stage->head);
    pose_destroy(&pose);
    Float4 *positions = gpu_buffer_read(&stage->batch.position);
    assert_non_null(positions);
    return positions;
}

static void get(const Float4 from, double to[3])
{
    for (int k = 0; k < 3; ++k) to[k] = (double)from[k];
}

// The style's direction d is turned by 1 - style of the angle from the hanging direction h to the
// physical segment b. If that angle is more than 150 degrees, the share fades to the nearer of 0
// and 1.
static void define(const Stage *stage, const double b[3], double style, double d[3])
{
    const double *h = stage->hanging;
    double axis[3];
    cross(h, b, axis);
    double sine = sqrt(dot(axis, axis)), share = 1 - style, half = 0.5 * atan2(sine, dot(h, b)),
           square = cos(half) * cos(half), near = fmin(square * 4 / 0.27, 1),
           kept = near * near * (3 - 2 * near), full = share < 0.5 ? 0 : half;
    double c = cos(full) + kept * (cos(share * half) - cos(full)),
           s = sin(full) + kept * (sin(share * half) - sin(full));
    for (int k = 0; k < 3; ++k) axis[k] *= sine > 0 ? s / sine : 0;
    rotate(axis, sine > 0 ? c : 1, d);
}

static double find_turned(const double b[3], const double h[3])
{
    return sqrt(fmax(0.5 + 0.5 * dot(b, h), 0));
}

// Rounding of a drawn direction, per coordinate. Positions are sums of 20 directions, within 9 m,
// so that a difference errs by 2^-21. Products and sums for the head and the rotation round about 8
// times, by 2^-24 each. A root and a division give the tangent of half the rotation, which rotates
// by as much; another division gives the rotation, with up to twice the effect. Each errs by half a
// unit, 2^-24, or by fixture_rounding() times that.
static double find_rounding(void)
{
    return (4 + fixture_rounding()) * 0x1p-22;
}

// The additional error when a segment points almost upwards. The cosine of half the angle to the
// hanging direction is the root of a sum that is rounded to 2^-24, and errs by 2^-25 divided by
// itself. That rotates what is drawn by about as much; with the axis, by less than 2^-22 / cosine.
// The share fades with the square of the cosine, times 4/0.27 (define()), and errs by the slope
// there times 2^-24.
static double find_rounding_near_axis(double cosine)
{
    double near = fmin(cosine * cosine * 4 / 0.27, 1), slope = 6 * near * (1 - near) * 4 / 0.27;
    return 0x1p-22 / cosine + slope * 0x1p-24;
}

static void hanging_hair_turns_its_style(void **state)
{
    (void)state;
    Stage stage;
    open_stage(&stage);
    for (int i = 0; i < 3; ++i) {
        Float4 *drawn = draw(&stage, SHARES[i]);
        for (uint32_t s = 0; s < STRANDS; ++s)
            for (uint32_t j = 1; j < VERTICES; ++j) {
                size_t at = hair_address(&stage.batch, s, j),
                       before = hair_address(&stage.batch, s, j - 1);
                double d[3], b[3], got[3], off = 0, length;
                get(stage.rest[at], d);
                get(stage.physical[at], b);
                turn_head(&stage.head, d);
                double cosine = find_turned(b, stage.hanging);
                if (j > LEAD) define(&stage, b, SHARES[i], d);
                for (int k = 0; k < 3; ++k) {
                    got[k] = (double)drawn[at][k] - (double)drawn[before][k];
                    off = fmax(off, fabs(got[k] - d[k]));
                }
                length = sqrt(dot(got, got));
                if (!(fabs(length - 1) < sqrt(3) * find_rounding()))
                    fail_msg("style %g: a segment's length is off by %g", SHARES[i], length - 1);
                if (cosine < 4e-4) continue; // rounding decides the axis
                double most = find_rounding() + find_rounding_near_axis(cosine);
                if (!(off < most))
                    fail_msg("style %g, %g degrees: off by %g, at most %g", SHARES[i],
                             ANGLES[at % ANGLE_COUNT], off, most);
            }
        free(drawn);
    }
    close_stage(&stage);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(hanging_hair_turns_its_style)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
