// SPDX-License-Identifier: MIT
#include "draw/fibre_lobes.h"

#include "base/simd.h"

#include "glsl/draw/draw.h"
#include "glsl/kernel/fibre.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

enum { W = ORDINATE_LANES, AZIMUTHS = SCATTER_AZIMUTHS, INCLINATIONS = SCATTER_INCLINATIONS };
enum { SHEET = AZIMUTHS * INCLINATIONS };

static float mix(float a, float b, float share)
{
    return a + share * (b - a);
}

// --- Tables.

// Interpolates one channel's plane of the table for a colour.
static void pick_color(FibreTable table, float color, float (*plane)[4])
{
    float place = fminf(fmaxf(color, 0), 1) * (SCATTER_COLORS - 1), low = floorf(place);
    low = fminf(low, SCATTER_COLORS - 2);
    const float(*a)[4] = table.values + (size_t)low * SHEET, (*b)[4] = a + SHEET;
    for (int i = 0; i < SHEET; ++i)
        for (int p = 0; p < 4; ++p) plane[i][p] = mix(a[i][p], b[i][p], place - low);
}

// Twice the integral of R + TT + TRT over the azimuths 0 .. pi, by the trapezoidal rule.
static float sum_azimuths(const float (*row)[4])
{
    double sum = 0;
    for (int i = 0; i < AZIMUTHS; ++i) {
        double weight = i == 0 || i == AZIMUTHS - 1 ? 0.5 : 1;
        for (int p = 0; p < 3; ++p) sum += weight * (double)row[i][p];
    }
    return (float)(2 * PI * sum / (AZIMUTHS - 1));
}

static void set_lobes(FibreLobes *lobes, const MaterialParams *material)
{
    for (int p = 0; p < 3; ++p) {
        lobes->variance[p] = 1 / material->lobe_sharpness[p];
        lobes->tilt_cos[p] = material->lobe_tilt_cos[p];
        lobes->tilt_sin[p] = material->lobe_tilt_sin[p];
    }
}

bool fibre_lobes_create(FibreLobes *lobes, FibreTable table, const MaterialParams *material,
                        const float color[3])
{
    static atomic_uint_fast64_t made;
    *lobes = (FibreLobes){.serial = atomic_fetch_add(&made, 1) + 1};
    set_lobes(lobes, material);
    memcpy(lobes->color, color, sizeof lobes->color);
    lobes->azimuthal = malloc(3 * SHEET * sizeof *lobes->azimuthal);
    lobes->albedo = malloc(INCLINATIONS * sizeof *lobes->albedo);
    if (!lobes->azimuthal || !lobes->albedo) {
        fibre_lobes_destroy(lobes);
        return false;
    }
    for (int c = 0; c < 3; ++c) {
        float(*plane)[4] = lobes->azimuthal + (size_t)c * SHEET;
        pick_color(table, color[c], plane);
        for (int i = 0; i < INCLINATIONS; ++i)
            lobes->albedo[i][c] = fminf(sum_azimuths((const float(*)[4])plane + i * AZIMUTHS), 1);
    }
    return true;
}

void fibre_lobes_destroy(FibreLobes *lobes)
{
    free(lobes->azimuthal);
    free(lobes->albedo);
    *lobes = (FibreLobes){0};
}

bool fibre_lobes_match(const FibreLobes *lobes, const MaterialParams *material,
                       const float color[3])
{
    FibreLobes asked = {0};
    set_lobes(&asked, material);
    return lobes->azimuthal &&
           memcmp(asked.variance, lobes->variance, sizeof asked.variance) == 0 &&
           memcmp(asked.tilt_sin, lobes->tilt_sin, sizeof asked.tilt_sin) == 0 &&
           memcmp(color, lobes->color, sizeof lobes->color) == 0;
}

void fibre_lobes_fit_albedo(FibreTable table, float fit[2])
{
    const size_t across = (size_t)(INCLINATIONS - 1) * AZIMUTHS;
    const int half = (SCATTER_COLORS - 1) / 2;
    double color = (double)half / (SCATTER_COLORS - 1),
           low = (double)sum_azimuths(table.values + across),
           middle = (double)sum_azimuths(table.values + (size_t)half * SHEET + across);
    fit[0] = (float)low;
    fit[1] = (float)(log((middle - low) / (1 - low)) / log(color));
}

// --- Scattering.

SIMD_INLINE float dot(const float t[3], const Ways *ways, int k)
{
    return t[0] * ways->axis[0][k] + t[1] * ways->axis[1][k] + t[2] * ways->axis[2][k];
}

// The angles of W pairs of directions.
typedef struct Angles {
    float sin_i[W], cos_i[W], sin_r[W], cos_r[W], turn[W];
} Angles;

SIMD_INLINE void find_angles(const float tangent[3], const Ways *out, const Ways *in,
                             Angles *angles)
{
    for (int k = 0; k < W; ++k) {
        float sin_r = simd_min(simd_max(dot(tangent, out, k), -1), 1),
              sin_i = simd_min(simd_max(dot(tangent, in, k), -1), 1);
        float cos_r = sqrtf(simd_positive(1 - sin_r * sin_r)),
              cos_i = sqrtf(simd_positive(1 - sin_i * sin_i));
        float between = out->axis[0][k] * in->axis[0][k] + out->axis[1][k] * in->axis[1][k] +
                        out->axis[2][k] * in->axis[2][k];
        float cos_phi = (between - sin_i * sin_r) / simd_max(cos_i * cos_r, 1e-6f);
        angles->sin_r[k] = sin_r;
        angles->cos_r[k] = cos_r;
        angles->sin_i[k] = sin_i;
        angles->cos_i[k] = cos_i;
        angles->turn[k] = fibre_turn(simd_min(simd_max(cos_phi, -1), 1));
    }
}

SIMD_INLINE void find_longitudinal(const FibreLobes *lobes, const Angles *a, int p, float extra,
                                   float m[W])
{
    float sharpness = 1 / (lobes->variance[p] + extra), tilt_cos = lobes->tilt_cos[p],
          tilt_sin = lobes->tilt_sin[p],
          scale = sharpness / (1 - SHARED_EXP2(-2 * (float)LOG2E * sharpness));
    for (int k = 0; k < W; ++k)
        m[k] = fibre_lobe(a->sin_i[k], a->cos_i[k], a->sin_r[k] * tilt_cos - a->cos_r[k] * tilt_sin,
                          a->cos_r[k] * tilt_cos + a->sin_r[k] * tilt_sin, sharpness, scale);
}

// The four table nodes around each lane's point.
typedef struct Nodes {
    int at[W];
    float across[W], along[W];
} Nodes;

static void find_nodes(const Angles *angles, Nodes *nodes)
{
    for (int k = 0; k < W; ++k) {
        float x = angles->turn[k] * (AZIMUTHS - 1), y = angles->cos_r[k] * (INCLINATIONS - 1);
        int i = (int)x, j = (int)y;
        i = i > AZIMUTHS - 2 ? AZIMUTHS - 2 : i;
        j = j > INCLINATIONS - 2 ? INCLINATIONS - 2 : j;
        nodes->at[k] = j * AZIMUTHS + i;
        nodes->across[k] = x - (float)i;
        nodes->along[k] = y - (float)j;
    }
}

void fibre_lobes_scatter(const FibreLobes *lobes, const float tangent[3], const Ways *out,
                         const Ways *in, float extra, float f[3][ORDINATE_LANES])
{
    Angles angles;
    Nodes nodes;
    float m[3][W];
    find_angles(tangent, out, in, &angles);
    for (int p = 0; p < 3; ++p) find_longitudinal(lobes, &angles, p, extra, m[p]);
    find_nodes(&angles, &nodes);
    for (int c = 0; c < 3; ++c)
        for (int k = 0; k < W; ++k) {
            const float(*a)[4] = (const float(*)[4])lobes->azimuthal + c * SHEET + nodes.at[k],
                  (*b)[4] = a + AZIMUTHS;
            float sum = 0, x = nodes.across[k], y = nodes.along[k];
            for (int p = 0; p < 3; ++p)
                sum += m[p][k] * mix(mix(a[0][p], a[1][p], x), mix(b[0][p], b[1][p], x), y);
            f[c][k] = sum;
        }
}

void fibre_lobes_albedo(const FibreLobes *lobes, float cosine, float albedo[3])
{
    float y = fminf(fmaxf(cosine, 0), 1) * (INCLINATIONS - 1);
    int j = (int)fminf(y, INCLINATIONS - 2);
    for (int c = 0; c < 3; ++c)
        albedo[c] = mix(lobes->albedo[j][c], lobes->albedo[j + 1][c], y - (float)j);
}
