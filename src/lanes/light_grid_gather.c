// SPDX-License-Identifier: MIT
// What hair shows of the light among it: at each particle the radiance of the eight cells around it
// (trilinear), weighted by what a fibre with its tangent sends from each direction to the eye.
// Those weights are tabled for one way to the eye, by tangents on an octahedron (bilinear); a
// particle's tangent is turned as its own way to the eye is. Particles so deep in hair that they
// can hardly be seen get the mean light of their cell.
#include "lanes/light_grid_state.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { W = STRAND_TILE, ROW = GATHER_SIDE + 1 };

// --- The table.

static void find_node_tangent(int node, float t[3])
{
    float u = 2 * (float)(node % ROW) / GATHER_SIDE - 1,
          v = 2 * (float)(node / ROW) / GATHER_SIDE - 1, z = 1 - fabsf(u) - fabsf(v), length;
    t[0] = u, t[1] = v, t[2] = z;
    if (z < 0) {
        t[0] = copysignf(1 - fabsf(v), u);
        t[1] = copysignf(1 - fabsf(u), v);
    }
    length = sqrtf(t[0] * t[0] + t[1] * t[1] + t[2] * t[2]);
    for (int k = 0; k < 3; ++k) t[k] /= length;
}

// Scaled so that all directions together give the fibre's albedo.
static void make_row(const GridKind *kind, int node, float row[GRID_WIDE])
{
    float t[3], sum[3] = {0}, along = 0, albedo[3];
    Ways in, out;
    find_node_tangent(node, t);
    grid_same_ways(kind->gather_eye, 1, &out);
    for (int g = 0; g < ORDINATE_GROUPS; ++g) {
        float f[3][ORDINATE_LANES];
        grid_group_ways(g, &in);
        for (int k = 0; k < 3; ++k)
            for (int l = 0; l < GRID_LANES; ++l) in.axis[k][l] = -in.axis[k][l];
        fibre_lobes_scatter(&kind->lobes, t, &out, &in, GRID_BLUR, f);
        for (int c = 0; c < 3; ++c)
            for (int l = 0; l < GRID_LANES; ++l) {
                row[(g * 3 + c) * GRID_LANES + l] = f[c][l];
                sum[c] += f[c][l];
            }
    }
    for (int k = 0; k < 3; ++k) along += t[k] * kind->gather_eye[k];
    fibre_lobes_albedo(&kind->lobes, sqrtf(fmaxf(1 - along * along, 0)), albedo);
    for (int g = 0; g < ORDINATE_GROUPS; ++g)
        for (int c = 0; c < 3; ++c)
            for (int l = 0; l < GRID_LANES; ++l)
                row[(g * 3 + c) * GRID_LANES + l] *= albedo[c] / fmaxf(sum[c], 1e-12f);
}

typedef struct MakeGather {
    GridKind *kind;
    int parts;
} MakeGather;

static void make_rows(void *data, int part)
{
    const MakeGather *make = data;
    for (int node = part; node < GATHER_NODES; node += make->parts)
        make_row(make->kind, node, make->kind->gather[node]);
}

Result light_grid_make_gather(LightGridState *state, const GridScene *scene, Error *error)
{
    float eye[3];
    light_lattice_turn(&state->lattice, scene->to_eye, eye);
    for (int k = 0; k < scene->kind_count; ++k) {
        GridKind *kind = &state->kinds[k];
        if (!kind->gather) kind->gather = malloc(GATHER_NODES * sizeof *kind->gather);
        if (!kind->gather) return error_set(error, RESULT_FAILED, "no memory for light among hair");
        if (kind->has_gather && memcmp(kind->gather_eye, eye, sizeof eye) == 0) continue;
        memcpy(kind->gather_eye, eye, sizeof eye);
        MakeGather make = {kind, state->parts};
        parallel_run(state->parts, make_rows, &make);
        kind->has_gather = true;
        ++kind->gather_made;
    }
    return RESULT_OK;
}

typedef struct Gather {
    LightGridState *state;
    const GridScene *scene;
    float eye[3];  // m, lattice's axes
    int ordinate;  // the nearest to the way to the eye
    float opacity; // of hair to the eye over that to light: the least of all hair
} Gather;

// --- Cells that are hidden.

// Fibres between the eye and the cell, but for those of the cell and of its neighbours, beyond
// which a share of 1e-3 of hair is seen.
static const float HIDDEN_BEHIND = 7;

static bool is_hidden(const Gather *gather, const int cell[3])
{
    const LightGridState *state = gather->state;
    const LightLattice *lattice = &state->lattice;
    float way[3], length = 0, depth = 0;
    int axis = 0;
    for (int k = 0; k < 3; ++k) {
        way[k] = (gather->eye[k] - lattice->low[k]) / lattice->side - (float)cell[k] - 0.5f;
        if (fabsf(way[k]) > fabsf(way[axis])) axis = k;
        length += way[k] * way[k];
    }
    float main = fmaxf(fabsf(way[axis]), 1e-6f), step_length = sqrtf(length) / main;
    for (int step = 2; (float)step < main; ++step) {
        int at[3];
        bool inside = true;
        for (int k = 0; k < 3; ++k) {
            at[k] = (int)floorf((float)cell[k] + 0.5f + (float)step * way[k] / main);
            inside &= at[k] >= 0 && at[k] < lattice->count[k];
        }
        if (!inside) break;
        int slot = state->slot[(at[2] * lattice->count[1] + at[1]) * lattice->count[0] + at[0]];
        if (slot >= 0 && slot < state->filled)
            depth +=
                state->depth[(size_t)slot * ORDINATES + (size_t)gather->ordinate] * step_length;
        if (depth * gather->opacity > HIDDEN_BEHIND) return true;
    }
    return false;
}

SIMD_INLINE void find_hidden(const Gather *gather, int part)
{
    LightGridState *state = gather->state;
    const int *n = state->lattice.count;
    int first = (int)((int64_t)state->active * part / state->parts),
        end = (int)((int64_t)state->active * (part + 1) / state->parts);
    for (int s = first; s < end; ++s) {
        int c = state->cell_of[s], cell[3] = {c % n[0], c / n[0] % n[1], c / (n[0] * n[1])};
        const float *light = state->light + (size_t)s * GRID_WIDE;
        float *mean = state->hidden + (size_t)s * 4;
        mean[3] = is_hidden(gather, cell) ? 1 : 0;
        if (mean[3] == 0) continue;
        for (int k = 0; k < 3; ++k) {
            float sum = 0;
            for (int g = 0; g < ORDINATE_GROUPS; ++g)
                for (int l = 0; l < GRID_LANES; ++l) sum += light[(g * 3 + k) * GRID_LANES + l];
            mean[k] = sum / ORDINATES;
        }
    }
}

SIMD_STAGE(find_hidden, Gather)

// --- Particles.

// Places and tangents of one particle of each strand of a tile, along the lattice's axes.
typedef struct Particles {
    float x[3][W], t[3][W];
    int node[W];
    float share[2][W];
} Particles;

SIMD_INLINE void find_node(Particles *p)
{
    for (int i = 0; i < W; ++i) {
        float x = p->t[0][i], y = p->t[1][i], z = p->t[2][i],
              scale = 1 / simd_max(fabsf(x) + fabsf(y) + fabsf(z), 1e-12f);
        float u = x * scale, v = y * scale, a = 1 - fabsf(v), b = 1 - fabsf(u);
        float far_u = u < 0 ? -a : a, far_v = v < 0 ? -b : b;
        u = z < 0 ? far_u : u;
        v = z < 0 ? far_v : v;
        u = simd_min(simd_max((u + 1) * (GATHER_SIDE * 0.5f), 0), GATHER_SIDE - 1e-3f);
        v = simd_min(simd_max((v + 1) * (GATHER_SIDE * 0.5f), 0), GATHER_SIDE - 1e-3f);
        p->node[i] = (int)v * ROW + (int)u;
        p->share[0][i] = u - (float)(int)u;
        p->share[1][i] = v - (float)(int)v;
    }
}

// Turns tangents by the smallest rotation from the way to the eye to `axis`, which tables are for.
SIMD_INLINE void turn_tangents(const float eye[3], const float axis[3], Particles *p)
{
    for (int i = 0; i < W; ++i) {
        float x = eye[0] - p->x[0][i], y = eye[1] - p->x[1][i], z = eye[2] - p->x[2][i];
        float scale = 1 / sqrtf(simd_max(x * x + y * y + z * z, 1e-20f));
        x *= scale, y *= scale, z *= scale;
        float a = x + axis[0], b = y + axis[1], c = z + axis[2];
        float cosine = x * axis[0] + y * axis[1] + z * axis[2];
        float t = p->t[0][i], u = p->t[1][i], v = p->t[2][i];
        float between = (t * a + u * b + v * c) / simd_max(1 + cosine, 1e-3f),
              twice = 2 * (t * x + u * y + v * z);
        p->t[0][i] = t - between * a + twice * axis[0];
        p->t[1][i] = u - between * b + twice * axis[1];
        p->t[2][i] = v - between * c + twice * axis[2];
    }
}

SIMD_INLINE void find_particles(const Gather *gather, const GridHair *hair, int tile, int j,
                                Particles *p)
{
    const LightLattice *lattice = &gather->state->lattice;
    int last = (int)hair->caster.material.vertex_count - 1;
    const float(*x)[4] =
        hair->caster.position + ((size_t)tile * hair->caster.material.vertex_count + (size_t)j) * W;
    const float(*before)[4] = j > 0 ? x - W : x, (*after)[4] = j < last ? x + W : x;
    for (int k = 0; k < 3; ++k) {
        float a = lattice->turn[k][0], b = lattice->turn[k][1], c = lattice->turn[k][2];
        for (int i = 0; i < W; ++i) {
            p->x[k][i] = a * x[i][0] + b * x[i][1] + c * x[i][2];
            p->t[k][i] = a * (after[i][0] - before[i][0]) + b * (after[i][1] - before[i][1]) +
                         c * (after[i][2] - before[i][2]);
        }
    }
    turn_tangents(gather->eye, gather->state->kinds[hair->kind].gather_eye, p);
    find_node(p);
}

// Slot of the cell that particle i lies in.
SIMD_INLINE int find_slot(const LightGridState *state, const Particles *p, int i)
{
    const LightLattice *lattice = &state->lattice;
    float inverse = 1 / lattice->side;
    int at[3];
    for (int k = 0; k < 3; ++k)
        at[k] = (int)simd_min(simd_max((p->x[k][i] - lattice->low[k]) * inverse, 0),
                              (float)(lattice->count[k] - 1));
    return state->slot[(at[2] * lattice->count[1] + at[1]) * lattice->count[0] + at[0]];
}

// The eight cells around particle i and their shares.
typedef struct Around {
    const float *cell[8];
    float weight[8];
} Around;

SIMD_INLINE void find_around(const LightGridState *state, const Particles *p, int i, Around *around)
{
    const LightLattice *lattice = &state->lattice;
    float inverse = 1 / lattice->side, share[3];
    int low[3];
    for (int k = 0; k < 3; ++k) {
        float at = simd_min(simd_max((p->x[k][i] - lattice->low[k]) * inverse - 0.5f, -0.5f),
                            (float)lattice->count[k] - 0.5f);
        low[k] = (int)(at + 1) - 1;
        share[k] = at - (float)low[k];
    }
    for (int q = 0; q < 8; ++q) {
        float weight = 1;
        int at[3];
        for (int k = 0; k < 3; ++k) {
            int up = q >> k & 1, last = lattice->count[k] - 1, c = low[k] + up;
            weight *= up ? share[k] : 1 - share[k];
            at[k] = c < 0 ? 0 : c > last ? last : c;
        }
        int slot = state->slot[(at[2] * lattice->count[1] + at[1]) * lattice->count[0] + at[0]];
        around->cell[q] = state->light + (size_t)(slot < 0 ? 0 : slot) * GRID_WIDE;
        around->weight[q] = slot < 0 ? 0 : weight;
    }
}

// The radiance around a particle times what its fibre sends of it to the eye.
SIMD_INLINE void show_light(const GridKind *kind, const Particles *p, int i, const Around *around,
                            float seen[3])
{
    const float(*rows)[GRID_WIDE] = (const float(*)[GRID_WIDE])kind->gather + p->node[i];
    const float *const *cell = around->cell, *w = around->weight;
    float u = p->share[0][i], v = p->share[1][i], a = (1 - u) * (1 - v), b = u * (1 - v),
          c = (1 - u) * v, d = u * v;
    Lanes sum[3] = {{0}};
#define AT(array) (*(const Lanes *)((array) + at))
    for (int g = 0; g < ORDINATE_GROUPS; ++g)
        for (int n = 0; n < 3; ++n) {
            int at = (g * 3 + n) * GRID_LANES;
            const Lanes light = (w[0] * AT(cell[0]) + w[1] * AT(cell[1])) +
                                (w[2] * AT(cell[2]) + w[3] * AT(cell[3])) +
                                ((w[4] * AT(cell[4]) + w[5] * AT(cell[5])) +
                                 (w[6] * AT(cell[6]) + w[7] * AT(cell[7])));
            sum[n] += light * ((a * AT(rows[0]) + b * AT(rows[1])) +
                               (c * AT(rows[ROW]) + d * AT(rows[ROW + 1])));
        }
#undef AT
    for (int n = 0; n < 3; ++n) {
        float all = 0;
        for (int l = 0; l < GRID_LANES; ++l) all += sum[n][l];
        seen[n] = all;
    }
}

// Points of the curves between two particles of a tile's strands are interpolated.
static void fill_between(const GridHair *hair, int tile, int from, int to, int strands)
{
    size_t parts = hair->caster.material.smooth_parts,
           points = (hair->caster.material.vertex_count - 1) * parts + 1,
           first = ((size_t)tile * points + (size_t)from * parts) * W,
           between = (size_t)(to - from) * parts, last = first + between * W;
    for (size_t k = 1; k < between; ++k)
        for (size_t i = 0; i < (size_t)strands; ++i)
            for (int n = 0; n < 3; ++n) {
                float a = hair->seen[first + i][n], b = hair->seen[last + i][n];
                hair->seen[first + k * W + i][n] = a + (b - a) * ((float)k / (float)between);
            }
}

SIMD_INLINE void gather_particles(const Gather *gather, const GridHair *hair, int tile, int j,
                                  int strands, const Particles *p)
{
    const MaterialParams *m = &hair->caster.material;
    const GridKind *kind = &gather->state->kinds[hair->kind];
    size_t points = (size_t)(m->vertex_count - 1) * m->smooth_parts + 1;
    Around around;
    float(*seen)[3] = hair->seen + ((size_t)tile * points + (size_t)j * m->smooth_parts) * W;
    for (int i = 0; i < strands; ++i) {
        int slot = find_slot(gather->state, p, i);
        const float *hidden = gather->state->hidden + 4 * (size_t)(slot < 0 ? 0 : slot);
        if (slot >= 0 && hidden[3] > 0) {
            for (int k = 0; k < 3; ++k)
                seen[i][k] = hidden[k] * kind->lobes.albedo[SCATTER_INCLINATIONS - 1][k];
            continue;
        }
        find_around(gather->state, p, i, &around);
        show_light(kind, p, i, &around, seen[i]);
    }
}

// Whether a tile's strands hardly turn between two particles.
SIMD_INLINE bool is_straight(const Particles *a, const Particles *b)
{
    const float least = 0.985f;
    float worst = 1;
    for (int i = 0; i < W; ++i) {
        float dot = 0, p = 1e-20f, q = 1e-20f;
        for (int k = 0; k < 3; ++k) {
            dot += a->t[k][i] * b->t[k][i];
            p += a->t[k][i] * a->t[k][i];
            q += b->t[k][i] * b->t[k][i];
        }
        worst = simd_min(dot / sqrtf(p * q), worst);
    }
    return worst > least;
}

// Light changes little within a cell, and what a fibre shows of it where it hardly turns: of such
// particles each second or fourth is enough.
SIMD_INLINE void gather_tile(const Gather *gather, const GridHair *hair, int tile)
{
    const MaterialParams *m = &hair->caster.material;
    int left = (int)m->drawn_strands - tile * W, strands = left < W ? left : W,
        last = (int)m->vertex_count - 1, from = 0;
    float reach = 1.25f * gather->state->lattice.side / fmaxf(gather->state->longest, 1e-9f);
    Particles p[2];
    find_particles(gather, hair, tile, 0, &p[0]);
    gather_particles(gather, hair, tile, 0, strands, &p[0]);
    for (int turn = 1; from < last; ++turn) {
        const Particles *before = &p[(turn + 1) % 2];
        Particles *here = &p[turn % 2];
        int step = reach >= 4 ? 4 : reach >= 2 ? 2 : 1, to;
        for (;; step /= 2) {
            to = from + step < last ? from + step : last;
            find_particles(gather, hair, tile, to, here);
            if (to == from + 1 || is_straight(before, here)) break;
        }
        gather_particles(gather, hair, tile, to, strands, here);
        fill_between(hair, tile, from, to, strands);
        from = to;
    }
}

SIMD_INLINE void gather_hair(const Gather *gather, int part)
{
    for (uint32_t h = 0; h < gather->scene->hair_count; ++h) {
        const GridHair *hair = &gather->scene->hair[h];
        int64_t tiles = ((int64_t)hair->caster.material.drawn_strands + W - 1) / W;
        int first = (int)(tiles * part / gather->state->parts),
            end = (int)(tiles * (part + 1) / gather->state->parts);
        for (int turn = first; turn < end && hair->seen; ++turn)
            gather_tile(gather, hair, (int)mapped_caster_tile(&hair->caster, turn));
    }
}

SIMD_STAGE(gather_hair, Gather)

float light_grid_opacity(const GridScene *scene)
{
    float least = 1;
    for (uint32_t h = 0; h < scene->hair_count; ++h) {
        const MaterialParams *m = &scene->hair[h].caster.material;
        least = fminf(least, m->opacity / fmaxf(m->shadow_opacity, 1e-6f));
    }
    return least;
}

int light_grid_nearest(const LightLattice *lattice, const float to[3])
{
    float way[3], most = -2;
    int best = 0;
    light_lattice_turn(lattice, to, way);
    for (int d = 0; d < ORDINATES; ++d) {
        float cosine = ORDINATE[0][d] * way[0] + ORDINATE[1][d] * way[1] + ORDINATE[2][d] * way[2];
        if (cosine > most) most = cosine, best = d;
    }
    return best;
}

Result light_grid_show(LightGridState *state, const GridScene *scene, Error *error)
{
    if (!state->filled) return RESULT_OK;
    Gather gather = {.state = state, .scene = scene};
    light_lattice_turn(&state->lattice, scene->draw->eye, gather.eye);
    gather.opacity = light_grid_opacity(scene);
    gather.ordinate = light_grid_nearest(&state->lattice, scene->to_eye);
    TRY(light_grid_make_gather(state, scene, error));
    run_find_hidden(&gather, state->parts);
    run_gather_hair(&gather, state->parts);
    return RESULT_OK;
}
