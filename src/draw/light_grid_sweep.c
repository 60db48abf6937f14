// SPDX-License-Identifier: MIT
// Light goes through the cells of a light grid: slice by slice along the main axis of its
// direction, from between the cells of the slice before (bilinear), on each thread the directions
// of some groups.
#include "draw/light_grid_state.h"

#include <math.h>
#include <string.h>

enum { GROUP_WIDE = 3 * GRID_LANES, TAPS = 3 };

typedef struct Sweep {
    LightGridState *state;
    const GridScene *scene;
    bool sky, fresh, sourceless;
    int parts;
} Sweep;

// What a group's directions have in common.
typedef struct GroupWay {
    int main, across[2]; // axes
    bool forward;
    float taps[2][TAPS][GRID_LANES]; // weights of the cells before, by the axes across
    float sky[GROUP_WIDE];
} GroupWay;

// From above (+y of the world) comes the sky, from below the ground, evenly between them.
static void find_sky(const Sweep *sweep, int group, float sky[GROUP_WIDE])
{
    const DrawParams *draw = sweep->scene->draw;
    const LightLattice *lattice = &sweep->state->lattice;
    for (int l = 0; l < GRID_LANES; ++l) {
        float up = 0;
        for (int k = 0; k < 3; ++k) up -= lattice->turn[k][1] * ORDINATE[k][group * GRID_LANES + l];
        for (int c = 0; c < 3; ++c)
            sky[c * GRID_LANES + l] =
                sweep->sky ? draw->ground[c] + (0.5f + 0.5f * up) * (draw->sky[c] - draw->ground[c])
                           : 0;
    }
}

static void find_way(const Sweep *sweep, int group, GroupWay *way)
{
    way->main = group / 2;
    way->forward = group % 2;
    way->across[0] = (way->main + 1) % 3;
    way->across[1] = (way->main + 2) % 3;
    for (int l = 0; l < GRID_LANES; ++l) {
        int d = group * GRID_LANES + l;
        float main = fabsf(ORDINATE[way->main][d]);
        for (int k = 0; k < 2; ++k) {
            float shift = ORDINATE[way->across[k]][d] / main;
            way->taps[k][0][l] = fmaxf(shift, 0);
            way->taps[k][1][l] = 1 - fabsf(shift);
            way->taps[k][2][l] = fmaxf(-shift, 0);
        }
    }
    find_sky(sweep, group, way->sky);
}

// Added to all radiance: what thick hair leaves of it would else become so small that processors
// need a hundred cycles for each operation with it (denormal numbers).
#define LEAST_LIGHT 1e-30f

// The weighted sum of three neighbours, `stride` floats apart; the mesh lets the share `low` of the
// first one through, `high` of the last.
SIMD_INLINE void blend(const float taps[TAPS][GRID_LANES], float low, float high, const float *from,
                       size_t stride, float *out)
{
    const Lanes first = low * *(const Lanes *)taps[0], middle = *(const Lanes *)taps[1],
                last = high * *(const Lanes *)taps[2];
    for (int c = 0; c < 3; ++c) {
        const float *at = from + c * GRID_LANES;
        *(Lanes *)(out + c * GRID_LANES) = first * *(const Lanes *)at +
                                           middle * *(const Lanes *)(at + stride) +
                                           last * *(const Lanes *)(at + 2 * stride) + LEAST_LIGHT;
    }
}

// Share that the mesh lets through between the cell at `at`, which may lie beside the lattice, and
// the one before it on an axis.
static float passed_before(const Sweep *sweep, int axis, const int at[3])
{
    const LightLattice *lattice = &sweep->state->lattice;
    if (!sweep->scene->blocks) return 1;
    for (int k = 0; k < 3; ++k)
        if (at[k] < 0 || at[k] >= lattice->count[k]) return 1;
    size_t cell =
        ((size_t)at[2] * (size_t)lattice->count[1] + (size_t)at[1]) * (size_t)lattice->count[0] +
        (size_t)at[0];
    return sweep->scene->blocks->open[(size_t)axis * light_lattice_cells(lattice) + cell];
}

// The same between the cell and the one behind it.
static float passed_behind(const Sweep *sweep, int axis, const int at[3])
{
    int next[3] = {at[0], at[1], at[2]};
    ++next[axis];
    return passed_before(sweep, axis, next);
}

// Of a row of the slice before, which lies at `at`, blended along the first axis across.
SIMD_INLINE void blend_row(const Sweep *sweep, const GroupWay *way, int at[3], const float *before,
                           int wide, float *row)
{
    int axis = way->across[0];
    bool blocks = sweep->scene->blocks != NULL;
    for (int x = 0; x < wide; ++x) {
        at[axis] = x;
        float low = blocks ? passed_before(sweep, axis, at) : 1,
              high = blocks ? passed_behind(sweep, axis, at) : 1;
        blend(way->taps[0], low, high, before + (size_t)x * GROUP_WIDE, GROUP_WIDE,
              row + (size_t)x * GROUP_WIDE);
    }
}

// out = S + (in - S) exp(-tau), in the mean S + (in - S)(1 - exp(-tau)) / tau.
SIMD_INLINE void pass_cell(const Sweep *sweep, int group, int slot, float *io, float *mean)
{
    const LightGridState *state = sweep->state;
    size_t lane = (size_t)slot * ORDINATES + (size_t)group * GRID_LANES,
           wide = (size_t)slot * GRID_WIDE + (size_t)group * GROUP_WIDE;
    const Lanes left = *(const Lanes *)(state->left + lane),
                share = *(const Lanes *)(state->mean + lane);
    const float given = sweep->sourceless ? 0 : 1, *source = state->source + wide;
    for (int c = 0; c < 3; ++c) {
        Lanes *at = (Lanes *)(io + c * GRID_LANES);
        const Lanes s = given * *(const Lanes *)(source + c * GRID_LANES), in = *at - s;
        *(Lanes *)(mean + c * GRID_LANES) = s + in * share;
        *at = s + in * left;
    }
}

SIMD_INLINE void keep(const Sweep *sweep, int group, int slot, const float *mean, double sum[3])
{
    LightGridState *state = sweep->state;
    size_t wide = (size_t)slot * GRID_WIDE + (size_t)group * GROUP_WIDE;
    for (int c = 0; c < 3; ++c) {
        const Lanes here = *(const Lanes *)(mean + c * GRID_LANES);
        Lanes *light = (Lanes *)(state->light + wide + c * GRID_LANES);
        *(Lanes *)(state->order + wide + c * GRID_LANES) = here;
        if (sweep->fresh)
            *light = here;
        else
            *light += here;
        if (slot >= state->filled) continue;
        const Lanes met = here * *(const Lanes *)(state->depth + (size_t)slot * ORDINATES +
                                                  (size_t)group * GRID_LANES);
        sum[c] += (double)(((met[0] + met[1]) + (met[2] + met[3])) +
                           ((met[4] + met[5]) + (met[6] + met[7])));
    }
}

// What comes from the side of the mesh is what that sends back.
SIMD_INLINE void meet_mesh(const Sweep *sweep, const GroupWay *way, const int at[3], int slot,
                           float *io)
{
    const LightGridState *state = sweep->state;
    float passed =
        way->forward ? passed_before(sweep, way->main, at) : passed_behind(sweep, way->main, at);
    for (int c = 0; c < 3; ++c) {
        float glow = slot >= 0 && slot < state->filled ? state->glow[3 * slot + c] : 0;
        Lanes *lanes = (Lanes *)(io + c * GRID_LANES);
        *lanes = passed * *lanes + (1 - passed) * glow;
    }
}

// A cell on the way of the group: what comes in becomes what goes out.
SIMD_INLINE void cross_cell(const Sweep *sweep, int group, int slot, float *io, double sum[3])
{
    if (slot < 0) return;
    if (slot >= sweep->state->filled) {
        keep(sweep, group, slot, io, sum);
        return;
    }
    float mean[GROUP_WIDE];
    pass_cell(sweep, group, slot, io, mean);
    keep(sweep, group, slot, mean, sum);
}

// `rows`: three rows of the slice before, of which one is made anew for each row of cells.
SIMD_INLINE void sweep_slice(const Sweep *sweep, const GroupWay *way, int group, int slice,
                             const float *before, float *after, float *rows, double sum[3])
{
    const int *n = sweep->state->lattice.count;
    const size_t strides[3] = {1, (size_t)n[0], (size_t)n[0] * (size_t)n[1]};
    int at[3], from[3], wide = n[way->across[0]], tall = n[way->across[1]], axis = way->across[1];
    bool blocks = sweep->scene->blocks != NULL;
    size_t row = ((size_t)wide + 2) * GROUP_WIDE, used = (size_t)wide * GROUP_WIDE,
           step = strides[way->across[0]];
    at[way->main] = slice;
    from[way->main] = way->forward ? slice - 1 : slice + 1;
    // Rows lie at y % 3 and, so that three in their order are one piece, once more behind them.
    for (int y = 0; y < tall + 2; ++y) {
        float *own = rows + (size_t)(y % 3) * used;
        from[axis] = y - 1;
        blend_row(sweep, way, from, before + (size_t)y * row, wide, own);
        memcpy(own + 3 * used, own, used * sizeof *own);
        if (y < 2) continue;
        at[axis] = y - 2;
        const float *first = rows + (size_t)((y - 2) % 3) * used;
        float *out = after + (size_t)(y - 1) * row + GROUP_WIDE;
        const int *slot = sweep->state->slot + (size_t)slice * strides[way->main] +
                          (size_t)(y - 2) * strides[axis];
        for (int x = 0; x < wide; ++x, first += GROUP_WIDE, out += GROUP_WIDE, slot += step) {
            at[way->across[0]] = x;
            float low = blocks ? passed_before(sweep, axis, at) : 1,
                  high = blocks ? passed_behind(sweep, axis, at) : 1;
            blend(way->taps[1], low, high, first, used, out);
            if (blocks) meet_mesh(sweep, way, at, *slot, out);
            cross_cell(sweep, group, *slot, out, sum);
        }
    }
}

static void fill_plane(float *plane, size_t floats, const float sky[GROUP_WIDE])
{
    for (size_t i = 0; i < floats; i += GROUP_WIDE)
        memcpy(plane + i, sky, GROUP_WIDE * sizeof *sky);
}

SIMD_INLINE void sweep_group(const Sweep *sweep, int group)
{
    LightGridState *state = sweep->state;
    GroupWay way;
    find_way(sweep, group, &way);
    int slices = state->lattice.count[way.main];
    float *planes[2] = {state->planes + (size_t)(3 * group) * state->plane,
                        state->planes + (size_t)(3 * group + 1) * state->plane},
          *rows = state->planes + (size_t)(3 * group + 2) * state->plane;
    double *sum = state->sums[1][group];
    memset(sum, 0, sizeof state->sums[1][group]);
    size_t used = ((size_t)state->lattice.count[way.across[0]] + 2) *
                  ((size_t)state->lattice.count[way.across[1]] + 2) * GROUP_WIDE;
    for (int k = 0; k < 2; ++k) fill_plane(planes[k], used, way.sky);
    for (int i = 0; i < slices; ++i)
        sweep_slice(sweep, &way, group, way.forward ? i : slices - 1 - i, planes[i % 2],
                    planes[(i + 1) % 2], rows, sum);
}

SIMD_INLINE void sweep_groups(const Sweep *sweep, int part)
{
    for (int group = part; group < ORDINATE_GROUPS; group += sweep->parts)
        sweep_group(sweep, group);
}

SIMD_STAGE(sweep_groups, Sweep)

void light_grid_sweep(LightGridState *state, const GridScene *scene, bool sky, bool fresh,
                      bool sourceless)
{
    int parts = state->parts < ORDINATE_GROUPS ? state->parts : ORDINATE_GROUPS;
    memcpy(state->sums[0], state->sums[1], sizeof state->sums[0]);
    Sweep sweep = {state, scene, sky, fresh, sourceless, parts};
    run_sweep_groups(&sweep, parts);
}

// --- Scattering.

// The lanes of one channel, in the order of cells' floats.
SIMD_INLINE void scatter_channel(const float (*rows)[ORDINATES], const float *in, int channel,
                                 float tint, float *out)
{
    float sum[ORDINATES];
    for (int d = 0; d < ORDINATES; ++d) sum[d] = 0;
    for (int g = 0; g < ORDINATE_GROUPS; ++g)
        for (int l = 0; l < GRID_LANES; ++l) {
            float from = in[g * GROUP_WIDE + channel * GRID_LANES + l];
            const float *row = rows[g * GRID_LANES + l];
            for (int d = 0; d < ORDINATES; ++d) sum[d] += from * row[d];
        }
    for (int g = 0; g < ORDINATE_GROUPS; ++g)
        for (int l = 0; l < GRID_LANES; ++l)
            out[g * GROUP_WIDE + channel * GRID_LANES + l] = tint * sum[g * GRID_LANES + l];
}

// Of the last order the mesh sends back its colour's share, alike to all sides.
SIMD_INLINE void reflect(const LightGridState *state, int f)
{
    const float *in = state->order + (size_t)f * GRID_WIDE;
    for (int c = 0; c < 3; ++c) {
        float sum = 0;
        for (int g = 0; g < ORDINATE_GROUPS; ++g)
            for (int l = 0; l < GRID_LANES; ++l) sum += in[g * GROUP_WIDE + c * GRID_LANES + l];
        state->glow[3 * f + c] = state->mesh_color[c] * sum * (1.f / ORDINATES);
    }
}

SIMD_INLINE void scatter(const LightGridState *state, int part)
{
    int first = (int)((int64_t)state->filled * part / state->parts),
        end = (int)((int64_t)state->filled * (part + 1) / state->parts);
    for (int f = first; f < end; ++f) {
        const GridKind *kind = &state->kinds[state->class[f] / TANGENTS];
        const float *in = state->order + (size_t)f * GRID_WIDE;
        float *out = state->source + (size_t)f * GRID_WIDE;
        for (int c = 0; c < 3; ++c)
            scatter_channel((const float(*)[ORDINATES])kind->scatter[state->class[f] % TANGENTS][c],
                            in, c, state->tint[3 * f + c], out);
        reflect(state, f);
    }
}

SIMD_STAGE(scatter, LightGridState)

void light_grid_scatter(LightGridState *state)
{
    run_scatter(state, state->parts);
}

// --- The orders that are not swept.

// Of two orders after each other what hair meets falls by this factor.
static double falling(const LightGridState *state, int channel)
{
    double before = 0, last = 0;
    for (int g = 0; g < ORDINATE_GROUPS; ++g) {
        before += state->sums[0][g][channel];
        last += state->sums[1][g][channel];
    }
    return before > 0 ? fmin(last / before, 0.95) : 0;
}

bool light_grid_needs_more(const LightGridState *state, double all[3])
{
    const double most_left = 0.05;
    bool more = false;
    for (int c = 0; c < 3; ++c) {
        double last = 0, ratio = falling(state, c);
        for (int g = 0; g < ORDINATE_GROUPS; ++g) last += state->sums[1][g][c];
        all[c] += last;
        double left = last * ratio / (1 - ratio);
        more |= left > most_left * (all[c] + left);
    }
    return more;
}

SIMD_INLINE void close_lights(const LightGridState *state, int part)
{
    float more[3];
    for (int c = 0; c < 3; ++c) {
        double ratio = falling(state, c);
        more[c] = (float)(ratio / (1 - ratio));
    }
    int first = (int)((int64_t)state->active * part / state->parts),
        end = (int)((int64_t)state->active * (part + 1) / state->parts);
    for (size_t s = (size_t)first; s < (size_t)end; ++s)
        for (int g = 0; g < ORDINATE_GROUPS; ++g)
            for (int c = 0; c < 3; ++c) {
                size_t at = s * GRID_WIDE + (size_t)(g * 3 + c) * GRID_LANES;
                for (int l = 0; l < GRID_LANES; ++l)
                    state->light[at + (size_t)l] += more[c] * state->order[at + (size_t)l];
            }
}

SIMD_STAGE(close_lights, LightGridState)

void light_grid_close(LightGridState *state)
{
    run_close_lights(state, state->parts);
}
