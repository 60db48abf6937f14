// SPDX-License-Identifier: MIT
// Shades 16 points at a time, one for each lane, all of one batch.
#include "lanes/shade.h"

#include "base/room.h"

#include "lanes/lamp.h"
#include "lanes/light_grid_show.h"

#include "glsl/common/hash.h"
#include "glsl/kernel/fibre.h"

#include <stdlib.h>

enum { W = STRAND_TILE };

Result shades_begin(Shades *shades, size_t points, Error *error)
{
    bool begins = shades->room < points || shades->image == UINT16_MAX;
    if (!room_make(&shades->points, &shades->room, points, sizeof *shades->points))
        return error_set(error, RESULT_FAILED, "no memory to shade %zu points", points);
    if (begins) {
        memset((void *)shades->points, 0, shades->room * sizeof *shades->points);
        shades->image = 0;
    }
    ++shades->image;
    return RESULT_OK;
}

void shades_destroy(Shades *shades)
{
    free((void *)shades->points);
    *shades = (Shades){0};
}

// --- The places of 16 points.

typedef struct SIMD_ALIGNED Spots {
    uint32_t strand[W], point[W]; // index of the strand in the batch, of the point on the strand
    float x[3][W], tangent[3][W], to_eye[3][W];
    float radius[W], opacity[W]; // m; opacity for light
    float color[3][W];           // the strand's colour at the point
    uint32_t hash[W];            // decides the strand's brightness
    const LaneHair *hair;
    int count; // lanes behind it repeat the last point
} Spots;

SIMD_INLINE void find_spots(const LaneHair *hair, const uint32_t *points, int count, Spots *s)
{
    float here[W][3], before[W][3], after[W][3];
    s->hair = hair;
    s->count = count;
    for (int i = 0; i < W; ++i) {
        uint32_t at = points[i < count ? i : count - 1] - (uint32_t)hair->first_point,
                 strand = at / hair->points, k = at % hair->points;
        s->strand[i] = strand, s->point[i] = k;
        lane_hair_point(hair, strand, k, here[i]);
        lane_hair_point(hair, strand, k > 0 ? k - 1 : 0, before[i]);
        lane_hair_point(hair, strand, k + 1 < hair->points ? k + 1 : k, after[i]);
    }
    for (int c = 0; c < 3; ++c)
        for (int i = 0; i < W; ++i) {
            s->x[c][i] = here[i][c];
            s->tangent[c][i] = after[i][c] - before[i][c];
        }
}

// Normalises the vectors. A vector without length becomes the y axis.
SIMD_INLINE void make_unit(float v[3][W])
{
    for (int i = 0; i < W; ++i) {
        float square = v[0][i] * v[0][i] + v[1][i] * v[1][i] + v[2][i] * v[2][i],
              scale = 1 / sqrtf(simd_max(square, 1e-36f));
        v[0][i] = square > 0 ? v[0][i] * scale : 0;
        v[1][i] = square > 0 ? v[1][i] * scale : 1;
        v[2][i] = square > 0 ? v[2][i] * scale : 0;
    }
}

// Finds thickness, opacity and colour, as paint.glsl does.
SIMD_INLINE void find_strands(const LaneLight *light, Spots *s)
{
    const LaneHair *hair = s->hair;
    const MaterialParams *m = &hair->caster.material;
    uint32_t parts = m->smooth_parts;
    float thinning = (1 - m->tip_ratio) / (float)(m->vertex_count - 1);
    for (int i = 0; i < W; ++i) {
        uint32_t id = hair->ids[s->strand[i]] ^ light->draw->seed;
        s->hash[i] = hash_bits(id);
        float own = s->strand[i] == m->last_strand ? m->last_share : 1,
              brightness = 1 + m->color_variation * hash_signed(id),
              warmth = m->warmth_variation * hash_signed(id + 0x9e3779b9u);
        s->radius[i] =
            simd_max(m->radius * own * (1 - thinning * ((float)s->point[i] / (float)parts)), 1e-9f);
        s->opacity[i] = m->shadow_opacity;
        s->color[0][i] = brightness * (1 + warmth);
        s->color[1][i] = brightness;
        s->color[2][i] = brightness * (1 - warmth);
    }
    if (!hair->caster.paint) {
        for (int c = 0; c < 3; ++c)
            for (int i = 0; i < W; ++i) s->color[c][i] *= m->color[c];
        return;
    }
    for (int i = 0; i < W; ++i) {
        uint32_t j = s->point[i] / parts, next = s->point[i] % parts ? 1 : 0,
                 root = (uint32_t)((size_t)(s->strand[i] / W) * m->vertex_count * W) +
                        s->strand[i] % W;
        const uint32_t *paint = hair->caster.paint[root + j * W],
                       *after = hair->caster.paint[root + (j + next) * W];
        float on = (float)(s->point[i] % parts) / (float)parts, here = simd_float_of(paint[2]),
              there = simd_float_of(after[2]),
              own = s->strand[i] == m->last_strand ? m->last_share : 1;
        s->radius[i] = simd_max(m->radius * own * (here + on * (there - here)), 1e-9f);
        s->opacity[i] *= (float)(hair->caster.paint[root][1] >> 16) / 65535;
        s->color[0][i] *= (float)(paint[0] & 0xffff) / 65535;
        s->color[1][i] *= (float)(paint[0] >> 16) / 65535;
        s->color[2][i] *= (float)(paint[1] & 0xffff) / 65535;
    }
}

// --- Light.

// The light from one lamp at 16 points: unit vectors towards the lamp, and the share of its colour
// that arrives.
typedef struct SIMD_ALIGNED Coming {
    float way[3][W], share[W];
} Coming;

SIMD_INLINE float dot3(float a[3][W], float b[3][W], int i)
{
    return a[0][i] * b[0][i] + a[1][i] * b[1][i] + a[2][i] * b[2][i];
}

// Sine and cosine of the eye's inclination, and the same tilted for each lobe.
typedef struct SIMD_ALIGNED Eye {
    float sine[W], cosine[W];
    float tilted_sine[3][W], tilted_cosine[3][W]; // theta_r tilted for R, TT, TRT
} Eye;

SIMD_INLINE void find_eye(const MaterialParams *m, Spots *s, Eye *eye)
{
    for (int i = 0; i < W; ++i) {
        float sine = simd_min(simd_max(dot3(s->tangent, s->to_eye, i), -1), 1);
        eye->sine[i] = sine;
        eye->cosine[i] = fibre_sine_of(sine);
    }
    for (int p = 0; p < 3; ++p)
        for (int i = 0; i < W; ++i) {
            eye->tilted_sine[p][i] =
                eye->sine[i] * m->lobe_tilt_cos[p] - eye->cosine[i] * m->lobe_tilt_sin[p];
            eye->tilted_cosine[p][i] =
                eye->cosine[i] * m->lobe_tilt_cos[p] + eye->sine[i] * m->lobe_tilt_sin[p];
        }
}

// What an environment adds to it: light_around_fibre of lights.glsl.
SIMD_INLINE void add_around(const DrawParams *draw, Spots *s, const Eye *eye, float color[3][W])
{
    const float(*a)[4] = (const float(*)[4])draw->around;
    for (int i = 0; i < W; ++i) {
        float side[3], tangent[3], square = 0;
        for (int c = 0; c < 3; ++c) {
            tangent[c] = s->tangent[c][i];
            side[c] = s->to_eye[c][i] - eye->sine[i] * tangent[c];
            square += side[c] * side[c];
        }
        float unit = 1 / sqrtf(simd_max(square, 1e-12f)), x = unit * side[0], y = unit * side[1],
              z = unit * side[2];
        for (int c = 0; c < 3; ++c) {
            float bent = lamp_bent(a[2][c], a[3][c], a[4][c], a[5][c], a[6][c], x, y, z) -
                         lamp_bent(a[2][c], a[3][c], a[4][c], a[5][c], a[6][c], tangent[0],
                                   tangent[1], tangent[2]);
            color[c][i] =
                simd_max(color[c][i] + FLOAT(0.25 * PI) * lamp_aside(a[0][c], a[1][c], x, z) +
                             FLOAT(1.0 / 3.0) * bent,
                         0);
        }
    }
}

// The mean ambient light on the visible side of a fibre.
SIMD_INLINE void find_around(const DrawParams *draw, Spots *s, const Eye *eye, float color[3][W])
{
    for (int i = 0; i < W; ++i) {
        float side[3], square = 0;
        for (int c = 0; c < 3; ++c) {
            side[c] = s->to_eye[c][i] - eye->sine[i] * s->tangent[c][i];
            square += side[c] * side[c];
        }
        float up = 0.5f + 0.125f * (float)PI * side[1] / sqrtf(simd_max(square, 1e-12f));
        for (int c = 0; c < 3; ++c)
            color[c][i] = draw->ground[c] + up * (draw->sky[c] - draw->ground[c]);
    }
    if (draw->around[0][3] > 0) add_around(draw, s, eye, color);
}

// The share of each light that reaches the points, [light][lane].
SIMD_INLINE void find_left(const LaneLight *light, const Spots *s, float left[MAX_LIGHTS][W])
{
    const LaneShadow *shadow = light->shadow;
    for (int l = 0; l < light->draw->light_count; ++l) {
        if (shadow && shadow->map_of[l] >= 0)
            lane_shadow_left_of(shadow, shadow->map_of[l], (const float(*)[W])s->x, s->radius,
                                s->opacity, left[l]);
        else
            for (int i = 0; i < W; ++i) left[l][i] = 1;
    }
}

// --- Marschner's model.

// The geometry of a light and the eye at 16 points: the longitudinal factors, and the place in the
// azimuthal table.
typedef struct SIMD_ALIGNED Beams {
    float along[3][W];    // longitudinal factor M of R, TT, TRT
    float azimuth[W];     // 0 .. 1 for 0 .. pi
    float inclination[W]; // cosine of theta_d
} Beams;

enum { AZIMUTHS = SCATTER_AZIMUTHS, NODES = SCATTER_AZIMUTHS * SCATTER_INCLINATIONS };

// The four table nodes around each place, and their weights.
typedef struct SIMD_ALIGNED Nodes {
    int first[W];
    float share[4][W]; // first, next azimuth, and the same two at the next inclination
} Nodes;

SIMD_INLINE void find_nodes(const Beams *beams, Nodes *nodes)
{
    for (int i = 0; i < W; ++i) {
        float x = beams->azimuth[i] * (SCATTER_AZIMUTHS - 1),
              y = beams->inclination[i] * (SCATTER_INCLINATIONS - 1);
        int column = (int)x, row = (int)y;
        column = column < SCATTER_AZIMUTHS - 2 ? column : SCATTER_AZIMUTHS - 2;
        row = row < SCATTER_INCLINATIONS - 2 ? row : SCATTER_INCLINATIONS - 2;
        float u = x - (float)column, v = y - (float)row;
        nodes->first[i] = row * AZIMUTHS + column;
        nodes->share[0][i] = (1 - u) * (1 - v), nodes->share[1][i] = u * (1 - v);
        nodes->share[2][i] = (1 - u) * v, nodes->share[3][i] = u * v;
    }
}

// The slice of the section's table for each strand, and the strand's colour over the slice's.
typedef struct SIMD_ALIGNED Tints {
    int slice[W];
    float through[3][W];
} Tints;

SIMD_INLINE void find_tints(const MaterialParams *m, const TintTable *table, const Spots *s,
                            Tints *tints)
{
    float last = (float)(table->slices - 1);
    for (int i = 0; i < W; ++i) {
        float uniform = (float)(int)(s->hash[i] >> 8) * (2.0f / 16777215.0f) - 1,
              which = (float)(int)((0.5f + 0.5f * uniform) * last + 0.5f),
              brightness = 1 + m->color_variation * (2 * which / simd_max(last, 1) - 1);
        tints->slice[i] = (int)which * NODES;
        for (int c = 0; c < 3; ++c)
            tints->through[c][i] = simd_max(simd_min(s->color[c][i], 1), 1e-3f) /
                                   simd_max(simd_min(m->color[c] * brightness, 1), 1e-3f);
    }
}

typedef float Four __attribute__((vector_size(16)));
// 0 .. 2^31: signed integers convert to floats in one instruction
typedef int32_t FourWords __attribute__((vector_size(16)));

// Interpolates the section's table (tint_table.h). Words of a texel: R | TT of red << 16, TT of
// green | TT of blue << 16, TRT of red | TRT of green << 16, TRT of blue.
SIMD_INLINE void sum_tints(const TintTable *table, const Tints *tints, const Nodes *nodes,
                           const Beams *beams, float sent[3][W])
{
    static const int NEXT[4] = {0, 1, AZIMUTHS, AZIMUTHS + 1};
    Four low[W], high[W]; // per lane: the words of a texel are read at once
    for (int i = 0; i < W; ++i) {
        const uint32_t *texel = table->texels[tints->slice[i] + nodes->first[i]];
        low[i] = high[i] = (Four){0};
        for (int n = 0; n < 4; ++n) {
            FourWords words;
            memcpy(&words, texel + 4 * NEXT[n], sizeof words);
            low[i] += nodes->share[n][i] * __builtin_convertvector(words & 0xffff, Four);
            high[i] += nodes->share[n][i] * __builtin_convertvector(words >> 16 & 0xffff, Four);
        }
    }
    for (int i = 0; i < W; ++i) {
        float r = beams->along[0][i] * table->unit[0] * low[i][0],
              tt = beams->along[1][i] * table->unit[1], trt = beams->along[2][i] * table->unit[2];
        const float a = tints->through[0][i], b = tints->through[1][i], c = tints->through[2][i];
        sent[0][i] = r + a * (tt * high[i][0] + a * (trt * low[i][2]));
        sent[1][i] = r + b * (tt * low[i][1] + b * (trt * high[i][2]));
        sent[2][i] = r + c * (tt * high[i][1] + c * (trt * low[i][3]));
    }
}

// Interpolates the table for all colours.
SIMD_INLINE void sum_colors(const float (*table)[4], const Spots *s, const Nodes *nodes,
                            const Beams *beams, float sent[3][W])
{
    static const int NEXT[4] = {0, 1, AZIMUTHS, AZIMUTHS + 1};
    for (int c = 0; c < 3; ++c)
        for (int i = 0; i < W; ++i) {
            float place = simd_min(simd_max(s->color[c][i], 0), 1) * (SCATTER_COLORS - 1);
            int which = (int)simd_min(place, SCATTER_COLORS - 2);
            float on = place - (float)which, sum = 0;
            for (int n = 0; n < 4; ++n) {
                const float *a = table[which * NODES + nodes->first[i] + NEXT[n]],
                            *b = a + 4 * (ptrdiff_t)NODES;
                for (int p = 0; p < 3; ++p)
                    sum += nodes->share[n][i] * beams->along[p][i] * (a[p] + on * (b[p] - a[p]));
            }
            sent[c][i] = sum;
        }
}

SIMD_INLINE void find_beams(const MaterialParams *m, LaneModel model, Spots *s, const Eye *eye,
                            Coming *coming, float wide, Beams *beams)
{
    float sine[W], cosine[W], angle[W];
    for (int i = 0; i < W; ++i) {
        float sin_i = simd_min(simd_max(dot3(s->tangent, coming->way, i), -1), 1),
              cos_i = fibre_sine_of(sin_i);
        sine[i] = sin_i, cosine[i] = cos_i;
        beams->azimuth[i] = fibre_turn(fibre_cos_phi(dot3(s->to_eye, coming->way, i), sin_i, cos_i,
                                                     eye->sine[i], eye->cosine[i]));
        beams->inclination[i] = model == LANE_GAUSS
                                    ? fibre_cos_d(sin_i, cos_i, eye->sine[i], eye->cosine[i])
                                    : eye->cosine[i];
    }
    for (int i = 0; i < W && model == LANE_GAUSS; ++i) // theta_i + theta_r, from arc cosines
        angle[i] = (float)PI * (1 - fibre_turn(sine[i]) - fibre_turn(eye->sine[i]));
    for (int p = 0; p < 3; ++p) {
        float sharp = m->lobe_sharpness[p], scale = m->lobe_scale[p],
              tilt = (float)PI * (0.5f - fibre_turn(m->lobe_tilt_sin[p]));
        if (wide > 0) {
            float shift = fibre_wide_shift(wide);
            sharp = fibre_wide_sharpness(sharp, wide);
            scale = fibre_lobe_scale(sharp);
            for (int i = 0; i < W; ++i)
                beams->along[p][i] =
                    model == LANE_GAUSS
                        ? fibre_gauss_pair(angle[i] - tilt, sharp, cosine[i], beams->inclination[i],
                                           shift)
                        : fibre_lobe_pair(sine[i], cosine[i], eye->tilted_sine[p][i],
                                          eye->tilted_cosine[p][i], sharp, scale, shift);
            continue;
        }
        for (int i = 0; i < W; ++i)
            beams->along[p][i] =
                model == LANE_GAUSS
                    ? fibre_gauss(angle[i] - tilt, sharp, cosine[i], beams->inclination[i])
                    : fibre_lobe(sine[i], cosine[i], eye->tilted_sine[p][i],
                                 eye->tilted_cosine[p][i], sharp, scale);
    }
}

SIMD_INLINE void shade_marschner(const Shader *shader, LaneModel model, Spots *s, float color[3][W])
{
    const LaneLight *light = shader->light;
    const LaneLook *look = s->hair->look;
    const MaterialParams *m = &s->hair->caster.material;
    float left[MAX_LIGHTS][W], sent[3][W];
    Eye eye;
    Coming coming;
    Beams beams;
    Nodes nodes;
    Tints tints;
    find_eye(m, s, &eye);
    if (light->grid) {
        light_grid_show(light->grid, look->kind, (const float(*)[W])s->x,
                        (const float(*)[W])s->tangent, s->count, color);
        for (int c = 0; c < 3; ++c)
            for (int i = 0; i < W; ++i) color[c][i] /= m->mean_albedo[c];
    } else {
        find_around(light->draw, s, &eye, color);
    }
    for (int c = 0; c < 3; ++c)
        for (int i = 0; i < W; ++i)
            color[c][i] *= fibre_albedo(s->color[c][i], m->albedo[0], m->albedo[1]);
    find_left(light, s, left);
    if (look->tints) find_tints(m, look->tints, s, &tints);
    for (int l = 0; l < light->draw->light_count; ++l) {
        lamp_find(light->draw, l, (const float(*)[W])s->x, coming.way, coming.share);
        find_beams(m, model, s, &eye, &coming, light->draw->light_color[l][3], &beams);
        find_nodes(&beams, &nodes);
        if (look->tints)
            sum_tints(look->tints, &tints, &nodes, &beams, sent);
        else
            sum_colors(look->table, s, &nodes, &beams, sent);
        for (int c = 0; c < 3; ++c)
            for (int i = 0; i < W; ++i)
                color[c][i] += (float)PI * light->draw->light_color[l][c] * coming.share[i] *
                               left[l][i] * sent[c][i];
    }
}

// --- Kajiya and Kay's model.

SIMD_INLINE void shade_kajiya(const Shader *shader, Spots *s, float color[3][W])
{
    const LaneLight *light = shader->light;
    const MaterialParams *m = &s->hair->caster.material;
    float left[MAX_LIGHTS][W];
    Eye eye;
    Coming coming;
    find_eye(m, s, &eye);
    find_around(light->draw, s, &eye, color);
    for (int c = 0; c < 3; ++c)
        for (int i = 0; i < W; ++i) color[c][i] *= m->ambient * s->color[c][i];
    find_left(light, s, left);
    for (int l = 0; l < light->draw->light_count; ++l) {
        lamp_find(light->draw, l, (const float(*)[W])s->x, coming.way, coming.share);
        for (int i = 0; i < W; ++i) {
            float cosine = simd_min(simd_max(dot3(s->tangent, coming.way, i), -1), 1),
                  sine = fibre_sine_of(cosine),
                  first = fibre_highlight(cosine, sine, eye.sine[i], eye.cosine[i], m->shift1_cos,
                                          m->shift1_sin),
                  second = fibre_highlight(cosine, sine, eye.sine[i], eye.cosine[i], m->shift2_cos,
                                           m->shift2_sin),
                  white = m->specular1 * SHARED_POW(simd_min(first, 1), m->exponent1),
                  tinted = m->diffuse * sine +
                           m->specular2 * SHARED_POW(simd_min(second, 1), m->exponent2);
            // cppcheck-suppress uninitvar ; lamp_find sets it
            float reaching = coming.share[i] * left[l][i];
            for (int c = 0; c < 3; ++c)
                color[c][i] +=
                    light->draw->light_color[l][c] * reaching * (white + tinted * s->color[c][i]);
        }
    }
}

// --- All models.

static void show_strands(const Spots *s, float color[3][W])
{
    for (int i = 0; i < W; ++i) {
        uint32_t bits = hash_bits(s->hair->ids[s->strand[i]]) & 0xffffff;
        bits = bits ? bits : 1; // black means that there is no strand
        for (int c = 0; c < 3; ++c) color[c][i] = (float)(bits >> (8 * c) & 255) / 255;
    }
}

SIMD_INLINE void shade_spots(const Shader *shader, Spots *s, float color[3][W])
{
    LaneModel model = s->hair->look->model;
    if (model == LANE_MARSCHNER)
        shade_marschner(shader, LANE_MARSCHNER, s, color);
    else if (model == LANE_GAUSS)
        shade_marschner(shader, LANE_GAUSS, s, color);
    else if (model == LANE_KAJIYA)
        shade_kajiya(shader, s, color);
    else if (model == LANE_STRAND)
        show_strands(s, color);
    else
        for (int c = 0; c < 3; ++c)
            for (int i = 0; i < W; ++i)
                color[c][i] = model == LANE_WHITE ? 1 : 0.5f + 0.5f * s->tangent[c][i];
}

SIMD_INLINE void shade_group(const Shader *shader, const LaneHair *hair, const uint32_t *points,
                             int count)
{
    const float *eye = shader->light->draw->eye;
    uint64_t image = (uint64_t)shader->shades->image << 48;
    float color[3][W];
    Spots s;
    find_spots(hair, points, count, &s);
    for (int c = 0; c < 3; ++c)
        for (int i = 0; i < W; ++i) s.to_eye[c][i] = eye[c] - s.x[c][i];
    make_unit(s.tangent);
    make_unit(s.to_eye);
    find_strands(shader->light, &s);
    shade_spots(shader, &s, color);
    for (int i = 0; i < count; ++i)
        atomic_store_explicit(&shader->shades->points[points[i]],
                              (uint64_t)pack_level(color[0][i]) |
                                  (uint64_t)pack_level(color[1][i]) << 16 |
                                  (uint64_t)pack_level(color[2][i]) << 32 | image,
                              memory_order_relaxed);
}

// Splits the points by batch and shades them in groups.
SIMD_INLINE void shade_points(const Shader *shader, const uint32_t *points, int count)
{
    for (uint32_t h = 0; h < shader->hairs->count && count > 0; ++h) {
        const LaneHair *hair = &shader->hairs->list[h];
        size_t begin = hair->first_point, end = begin + hair->tiles * W * hair->points;
        uint32_t group[W];
        int n = 0;
        // The last group is shaded in the loop, too: a second call would double a large function.
        for (int i = 0; i < count; ++i) {
            group[n] = points[i];
            n += (points[i] >= begin) & (points[i] < end);
            if (n < W && (i + 1 < count || n == 0)) continue;
            shade_group(shader, hair, group, n);
            n = 0;
        }
    }
}

SIMD_FOR_ANY static void shade_points_any(const Shader *shader, const uint32_t *points, int count)
{
    shade_points(shader, points, count);
}
SIMD_FOR_AVX2 static void shade_points_avx2(const Shader *shader, const uint32_t *points, int count)
{
    shade_points(shader, points, count);
}
SIMD_WITH_AVX512(SIMD_FOR_AVX512 static void shade_points_avx512(const Shader *shader,
                                                                 const uint32_t *points,
                                                                 int count) {
    shade_points(shader, points, count);
})

ShadePoints *const shade_points_on[SIMD_LEVELS] = {shade_points_any, shade_points_avx2,
                                                   SIMD_AVX512_OF(shade_points)};
