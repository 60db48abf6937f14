// SPDX-License-Identifier: MIT
#include "draw/light_dual.h"

#include "draw/fibre_lobe.h"

#include "glsl/common/shared_math.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { W = STRAND_TILE, INCLINATIONS = SCATTER_INCLINATIONS, TURNS = SCATTER_AZIMUTHS };

// Of one inclination: a_f, a_b, v_f, v_b of each channel.
typedef struct DualShares {
    float forward[3], back[3], forward_variance[3], back_variance[3];
} DualShares;

// What a kind of fibres needs.
typedef struct DualTable {
    FibreLobes lobes; // that it was made for: arrays are not owned
    DualShares shares[INCLINATIONS];
    // Of light that comes evenly from the half circle about the light's azimuth: R, TT, TRT.
    float around[3][INCLINATIONS][TURNS][4];
} DualTable;

// --- Tables.

// The weight of azimuth i on the side away from the light.
static double weight_beyond(int i)
{
    double middle = 0.5 * (TURNS - 1), off = i - middle;
    return fmin(fmax(off + 0.5, 0), 1) * (i == 0 || i == TURNS - 1 ? 0.5 : 1);
}

static void make_shares(const FibreLobes *lobes, int inclination, DualShares *shares)
{
    const double step = 2 * PI / (TURNS - 1);
    for (int c = 0; c < 3; ++c) {
        const float(*row)[4] = (const float(*)[4])lobes->azimuthal +
                               ((size_t)c * INCLINATIONS + (size_t)inclination) * TURNS;
        double energy[2] = {0}, spread[2] = {0};
        for (int i = 0; i < TURNS; ++i) {
            double beyond = weight_beyond(i), whole = i == 0 || i == TURNS - 1 ? 0.5 : 1;
            for (int p = 0; p < 3; ++p)
                for (int side = 0; side < 2; ++side) {
                    double part = (side ? whole - beyond : beyond) * step * (double)row[i][p];
                    energy[side] += part;
                    spread[side] += part * (double)lobes->variance[p];
                }
        }
        shares->forward[c] = (float)fmin(energy[0], 0.999);
        shares->back[c] = (float)energy[1];
        shares->forward_variance[c] = (float)(spread[0] / fmax(energy[0], 1e-9));
        shares->back_variance[c] = (float)(spread[1] / fmax(energy[1], 1e-9));
    }
}

// The mean over half a turn about each azimuth, of the row mirrored at both its ends.
static void make_around(const float (*row)[4], float (*around)[4])
{
    const int half = (TURNS - 1) / 2, most = TURNS - 1;
    double sums[3 * TURNS][3] = {{0}};
    for (int i = 1; i < 3 * TURNS; ++i) {
        int from = i - 1 - most; // of -most .. 2 most, mirrored
        int at = from < 0 ? -from : from > most ? 2 * most - from : from;
        for (int p = 0; p < 3; ++p)
            sums[i][p] = sums[i - 1][p] + (at >= 0 ? (double)row[at][p] : 0);
    }
    for (int i = 0; i < TURNS; ++i) {
        int low = i - half + most, high = i + half + 1 + most;
        for (int p = 0; p < 3; ++p)
            around[i][p] = (float)((sums[high][p] - sums[low][p]) / (high - low));
        around[i][3] = 0;
    }
}

static void make_table(DualTable *table, const FibreLobes *lobes)
{
    table->lobes = *lobes;
    for (int i = 0; i < INCLINATIONS; ++i) {
        make_shares(lobes, i, &table->shares[i]);
        for (int c = 0; c < 3; ++c)
            make_around((const float(*)[4])lobes->azimuthal +
                            ((size_t)c * INCLINATIONS + (size_t)i) * TURNS,
                        table->around[c][i]);
    }
}

static Result make_tables(LightDual *dual, const GridScene *scene, Error *error)
{
    if (!dual->tables) dual->tables = calloc(LIGHT_GRID_KINDS, sizeof *dual->tables);
    if (!dual->tables) return error_set(error, RESULT_FAILED, "no memory for dual scattering");
    for (int k = 0; k < scene->kind_count; ++k)
        if (dual->tables[k].lobes.serial != scene->kinds[k].serial)
            make_table(&dual->tables[k], &scene->kinds[k]);
    return RESULT_OK;
}

// --- Particles.

typedef struct Find {
    const LightDual *dual;
    const GridScene *scene;
    bool add;
    int parts;
} Find;

// One particle of each strand of a tile, and how light and eye lie to it.
typedef struct Lit {
    float x[3][W], t[3][W], to_eye[3][W];
    float sin_i[W], cos_i[W], sin_r[W], cos_r[W], turn[W];
    float sent[W]; // of the light, by distance and cone
} Lit;

SIMD_INLINE void set_particles(const GridScene *scene, const GridHair *hair, int tile, int j,
                               Lit *lit)
{
    const MaterialParams *m = &hair->caster.material;
    int last = (int)m->vertex_count - 1;
    const float(*x)[4] = hair->caster.position + ((size_t)tile * m->vertex_count + (size_t)j) * W;
    const float(*before)[4] = j > 0 ? x - W : x, (*after)[4] = j < last ? x + W : x;
    float length[W], away[W];
    for (int i = 0; i < W; ++i) length[i] = away[i] = 1e-20f;
    for (int k = 0; k < 3; ++k) {
        float eye = scene->draw->eye[k];
        for (int i = 0; i < W; ++i) {
            lit->x[k][i] = x[i][k];
            lit->t[k][i] = after[i][k] - before[i][k];
            lit->to_eye[k][i] = eye - x[i][k];
            length[i] += lit->t[k][i] * lit->t[k][i];
            away[i] += lit->to_eye[k][i] * lit->to_eye[k][i];
        }
    }
    for (int k = 0; k < 3; ++k)
        for (int i = 0; i < W; ++i) {
            lit->t[k][i] /= sqrtf(length[i]);
            lit->to_eye[k][i] /= sqrtf(away[i]);
        }
}

// As light_sent of lights.glsl.
SIMD_INLINE void set_light(const DrawParams *draw, int l, Lit *lit)
{
    const float *place = draw->light_place[l], *axis = draw->light_axis[l],
                *cone = draw->light_cone[l];
    for (int i = 0; i < W; ++i) {
        float x = place[0] - place[3] * lit->x[0][i], y = place[1] - place[3] * lit->x[1][i],
              z = place[2] - place[3] * lit->x[2][i];
        float square = simd_max(x * x + y * y + z * z, 1e-12f), scale = 1 / sqrtf(square);
        x *= scale, y *= scale, z *= scale;
        float cosine = axis[0] * x + axis[1] * y + axis[2] * z,
              inside = simd_min(simd_max(cone[0] - cone[1] * cosine, 0), 1),
              far = simd_min(axis[3] / square, 1e6f) * inside * inside;
        lit->sent[i] = place[3] == 0 ? 1 : far;
        float si = x * lit->t[0][i] + y * lit->t[1][i] + z * lit->t[2][i],
              sr = lit->to_eye[0][i] * lit->t[0][i] + lit->to_eye[1][i] * lit->t[1][i] +
                   lit->to_eye[2][i] * lit->t[2][i],
              between = lit->to_eye[0][i] * x + lit->to_eye[1][i] * y + lit->to_eye[2][i] * z;
        si = simd_min(simd_max(si, -1), 1);
        sr = simd_min(simd_max(sr, -1), 1);
        float ci = sqrtf(simd_positive(1 - si * si)), cr = sqrtf(simd_positive(1 - sr * sr));
        float cos_phi = (between - si * sr) / simd_max(ci * cr, 1e-6f);
        lit->sin_i[i] = si, lit->cos_i[i] = ci, lit->sin_r[i] = sr, lit->cos_r[i] = cr;
        lit->turn[i] = fibre_turn(simd_min(simd_max(cos_phi, -1), 1));
    }
}

// What tables have for the lanes, of one channel.
typedef struct Looked {
    float forward[W], back[W], forward_variance[W], back_variance[W], around[3][W];
} Looked;

static float mix(float a, float b, float share)
{
    return a + share * (b - a);
}

static void look_up(const DualTable *table, const Lit *lit, int c, Looked *looked)
{
    for (int i = 0; i < W; ++i) {
        float at = lit->cos_i[i] * (INCLINATIONS - 1), row = lit->cos_r[i] * (INCLINATIONS - 1),
              turn = lit->turn[i] * (TURNS - 1);
        int k = (int)at < INCLINATIONS - 2 ? (int)at : INCLINATIONS - 2,
            r = (int)row < INCLINATIONS - 2 ? (int)row : INCLINATIONS - 2,
            t = (int)turn < TURNS - 2 ? (int)turn : TURNS - 2;
        const DualShares *a = &table->shares[k], *b = a + 1;
        float share = at - (float)k;
        looked->forward[i] = mix(a->forward[c], b->forward[c], share);
        looked->back[i] = mix(a->back[c], b->back[c], share);
        looked->forward_variance[i] = mix(a->forward_variance[c], b->forward_variance[c], share);
        looked->back_variance[i] = mix(a->back_variance[c], b->back_variance[c], share);
        const float(*low)[4] = &table->around[c][r][t], (*high)[4] = &table->around[c][r + 1][t];
        float u = turn - (float)t, v = row - (float)r;
        for (int p = 0; p < 3; ++p)
            looked->around[p][i] =
                mix(mix(low[0][p], low[1][p], u), mix(high[0][p], high[1][p], u), v);
    }
}

SIMD_INLINE float exp_of(float x)
{
    return simd_exp2(simd_max((float)LOG2E * simd_min(x, 0), -60));
}

SIMD_INLINE void add_channel(const FibreLobes *lobes, const Lit *lit, const Looked *looked,
                             const float *left, const float *behind, float color, float sum[W])
{
    for (int i = 0; i < W; ++i) {
        float af = simd_min(simd_max(looked->forward[i], 1e-3f), 0.999f), ab = looked->back[i],
              vf = looked->forward_variance[i], vb = looked->back_variance[i];
        float direct = simd_max(left[i], 1e-6f), n = minus_log(simd_min(direct, 0.999999f));
        float square = af * af, x = 1 - square, cube = ab * ab * ab,
              e = 1 - simd_exp2(simd_max(-2 * (float)LOG2E * behind[i] * minus_log(af), -60));
        float back = ab * square / x * e + cube * square / (x * x * x) * e * e * e;
        float sent = simd_positive(exp_of(-n * (1 - af)) - left[i]),
              spread = vf * n * af / (1 - exp_of(-simd_max(n * af, 1e-6f)));
        float root = (ab * sqrtf(2 * vf + vb) + cube * sqrtf(2 * vf + 3 * vb)) /
                     simd_max(ab + cube * (2 * sqrtf(vf) + 3 * sqrtf(vb)), 1e-9f) *
                     (1 + 0.7f * square),
              v = root * root;
        float si = lit->sin_i[i], ci = lit->cos_i[i], sr = lit->sin_r[i], cr = lit->cos_r[i];
        float seen = back * (float)(1 / PI) *
                     (left[i] * fibre_lobe(v, si, ci, sr, cr) +
                      sent * fibre_lobe(v + spread, si, ci, sr, cr));
        for (int p = 0; p < 3; ++p) {
            float tilt_cos = lobes->tilt_cos[p], tilt_sin = lobes->tilt_sin[p];
            seen += sent * looked->around[p][i] *
                    fibre_lobe(lobes->variance[p] + spread, si, ci, sr * tilt_cos - cr * tilt_sin,
                               cr * tilt_cos + sr * tilt_sin);
        }
        sum[i] += (float)PI * color * lit->sent[i] * seen;
    }
}

SIMD_INLINE void find_particles(const Find *find, const GridHair *hair, int tile, int j,
                                float sum[3][W])
{
    const GridScene *scene = find->scene;
    const MaterialParams *m = &hair->caster.material;
    const DualTable *table = &find->dual->tables[hair->kind];
    size_t points = (size_t)(m->vertex_count - 1) * m->smooth_parts + 1,
           at = ((size_t)tile * points + (size_t)j * m->smooth_parts) * W;
    Lit lit;
    Looked looked;
    memset(sum, 0, 3 * sizeof *sum);
    set_particles(scene, hair, tile, j, &lit);
    for (int l = 0; l < scene->draw->light_count; ++l) {
        if (scene->map_of[l] < 0) continue;
        size_t map = (size_t)scene->map_of[l] * hair->points + at;
        set_light(scene->draw, l, &lit);
        for (int c = 0; c < 3; ++c) {
            look_up(table, &lit, c, &looked);
            add_channel(&table->lobes, &lit, &looked, hair->left + map, hair->behind + map,
                        scene->draw->light_color[l][c], sum[c]);
        }
    }
}

// The points of the curves from one particle on to another, but for the last.
static void fill_between(const Find *find, const GridHair *hair, int tile, int from, int to,
                         const float a[3][W], const float b[3][W])
{
    size_t parts = hair->caster.material.smooth_parts,
           points = (hair->caster.material.vertex_count - 1) * parts + 1,
           first = ((size_t)tile * points + (size_t)from * parts) * W,
           between = (size_t)(to - from) * parts;
    for (size_t k = 0; k < (between ? between : 1); ++k) {
        float share = between ? (float)k / (float)between : 0;
        for (size_t i = 0; i < W; ++i) {
            float *seen = hair->seen[first + k * W + i];
            for (int c = 0; c < 3; ++c)
                seen[c] = (find->add ? seen[c] : 0) + mix(a[c][i], b[c][i], share);
        }
    }
}

// Every third particle: such light changes slowly along a strand.
SIMD_INLINE void find_tile(const Find *find, const GridHair *hair, int tile)
{
    enum { STEP = 3 };
    int last = (int)hair->caster.material.vertex_count - 1;
    float sums[2][3][W];
    find_particles(find, hair, tile, 0, sums[0]);
    for (int from = 0, turn = 1; from < last; ++turn) {
        int to = from + STEP < last ? from + STEP : last;
        find_particles(find, hair, tile, to, sums[turn % 2]);
        fill_between(find, hair, tile, from, to, (const float(*)[W])sums[(turn + 1) % 2],
                     (const float(*)[W])sums[turn % 2]);
        from = to;
        if (to == last)
            fill_between(find, hair, tile, to, to, (const float(*)[W])sums[turn % 2],
                         (const float(*)[W])sums[turn % 2]);
    }
}

SIMD_INLINE void find_hair(const Find *find, int part)
{
    for (uint32_t h = 0; h < find->scene->hair_count; ++h) {
        const GridHair *hair = &find->scene->hair[h];
        int64_t tiles = ((int64_t)hair->caster.material.drawn_strands + W - 1) / W;
        int first = (int)(tiles * part / find->parts),
            end = (int)(tiles * (part + 1) / find->parts);
        for (int tile = first; tile < end && hair->seen; ++tile) find_tile(find, hair, tile);
    }
}

SIMD_STAGE(find_hair, Find)

Result light_dual_find(LightDual *dual, const GridScene *scene, bool add, Error *error)
{
    TRY(make_tables(dual, scene, error));
    Find find = {dual, scene, add, parallel_threads()};
    run_find_hair(&find, find.parts);
    return RESULT_OK;
}

void light_dual_destroy(LightDual *dual)
{
    free(dual->tables);
    *dual = (LightDual){0};
}
