// SPDX-License-Identifier: MIT
// Propagates light through the cells of a light grid, slice by slice along the main axis of its
// direction. Light that enters a cell is interpolated bilinearly between the cells of the slice
// before. Each thread processes the directions of some groups.
#include "lanes/light_grid_state.h"

#include <math.h>
#include <string.h>

enum { TAPS = 3 };

typedef struct Sweep {
    LightGridState *state;
    bool sky, fresh;
    int parts;
} Sweep;

// Properties that the directions of a group share.
typedef struct GroupWay {
    int main, across[2]; // axes
    bool forward;
    float taps[2][TAPS][GRID_LANES]; // weights of three cells before, for both axes across
    float sky[GROUP_WIDE];
    ptrdiff_t stride[3], step[3]; // of slots and of walls, along `main` and the axes across
    const float *walls[3];        // transmittance of the mesh along these axes; NULL without a mesh
    float face[ONTO_FACES][GRID_LANES]; // onto skin: weights of the directions on a cell's faces
} GroupWay;

static void find_strides(const LightGridState *state, GroupWay *way)
{
    const int *n = state->field.lattice.count;
    const ptrdiff_t stride[3] = {1, n[0], (ptrdiff_t)n[0] * n[1]},
                    step[3] = {1, n[0] + 2, (ptrdiff_t)(n[0] + 2) * (n[1] + 2)};
    for (int k = 0; k < 3; ++k) {
        int axis = k ? way->across[k - 1] : way->main;
        way->stride[k] = stride[axis];
        way->step[k] = step[axis];
        way->walls[k] = light_field_walls(&state->field, axis);
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
    memset(way->sky, 0, sizeof way->sky);
    if (sweep->sky)
        memcpy(way->sky, sweep->state->field.around + (size_t)group * GROUP_WIDE, sizeof way->sky);
    find_strides(sweep->state, way);
}

// Added to all radiance. Without it the light behind thick hair would become so small (denormal
// numbers) that each operation takes a hundred cycles.
#define LEAST_LIGHT 1e-30f

// The weighted sum of three neighbours. The mesh lets the share `low` of the first and `high` of
// the last through.
SIMD_INLINE void blend(const float taps[TAPS][GRID_LANES], float low, float high, const float *a,
                       const float *b, const float *c, float *out)
{
    const GridLanes first = low * *(const GridLanes *)taps[0], middle = *(const GridLanes *)taps[1],
                    last = high * *(const GridLanes *)taps[2];
    for (int k = 0; k < GROUP_WIDE; k += GRID_LANES)
        *(GridLanes *)(out + k) = first * *(const GridLanes *)(a + k) +
                                  middle * *(const GridLanes *)(b + k) +
                                  last * *(const GridLanes *)(c + k) + LEAST_LIGHT;
}

// The mesh beside a row of cells: its walls before each cell along the first axis across, and the
// cells' slots; NULL where no light is reflected (onto skin, and outside the lattice).
typedef struct RowMesh {
    const float *wall;
    const int *slot;
} RowMesh;

// Adds the light that the mesh reflects into a cell in place of what `blend` left out.
SIMD_INLINE void add_glow(const LightGridState *state, const float taps[TAPS][GRID_LANES],
                          float low, float high, int slot, float *out)
{
    if (slot < 0 || (low == 1 && high == 1)) return;
    const GridLanes blocked =
        (1 - low) * *(const GridLanes *)taps[0] + (1 - high) * *(const GridLanes *)taps[2];
    for (int c = 0; c < 3; ++c)
        *(GridLanes *)(out + c * GRID_LANES) += blocked * state->glow[3 * slot + c];
}

// Blends a row of the slice before along the first axis across.
SIMD_INLINE void blend_row(const LightGridState *state, const GroupWay *way, bool walls,
                           RowMesh mesh, const int cells[2], const float *before, float *row)
{
    for (int x = cells[0]; x < cells[1]; ++x) {
        float low = walls ? mesh.wall[x * way->step[1]] : 1,
              high = walls ? mesh.wall[(x + 1) * way->step[1]] : 1;
        const float *at = before + (size_t)x * GROUP_WIDE;
        float *out = row + (size_t)x * GROUP_WIDE;
        blend(way->taps[0], low, high, at, at + GROUP_WIDE, at + 2 * GROUP_WIDE, out);
        if (walls && mesh.slot)
            add_glow(state, way->taps[0], low, high, mesh.slot[x * way->stride[1]], out);
    }
}

// Light through a cell with the optical depth tau and the source S: out = S + (in - S) exp(-tau);
// mean = S + (in - S)(1 - exp(-tau)) / tau.
SIMD_INLINE void pass_cell(const Sweep *sweep, int group, int slot, float *io, float *mean)
{
    const LightGridState *state = sweep->state;
    const float *passage = grid_passage(state, group, slot);
    const GridLanes left = *(const GridLanes *)passage,
                    share = *(const GridLanes *)(passage + GRID_LANES);
    const float *source = grid_source(state, group, slot);
    for (int c = 0; c < 3; ++c) {
        GridLanes *at = (GridLanes *)(io + c * GRID_LANES);
        const GridLanes s = *(const GridLanes *)(source + c * GRID_LANES), in = *at - s;
        *(GridLanes *)(mean + c * GRID_LANES) = s + in * share;
        *at = s + in * left;
    }
}

SIMD_INLINE void keep(const Sweep *sweep, int group, int slot, const float *mean)
{
    const LightGridState *state = sweep->state;
    float *order = grid_lane(state, state->order, group, slot),
          *sum = grid_lane(state, state->sum, group, slot);
    for (int c = 0; c < 3; ++c) {
        const GridLanes here = *(const GridLanes *)(mean + c * GRID_LANES);
        GridLanes *light = (GridLanes *)(sum + c * GRID_LANES);
        *(GridLanes *)(order + c * GRID_LANES) = here;
        if (sweep->fresh)
            *light = here;
        else
            *light += here;
    }
}

// Adds the light that the cell's hair meets.
SIMD_INLINE void add_met(const LightGridState *state, int group, int slot, const float *mean,
                         GridLanes met[3])
{
    const GridLanes depth = *(const GridLanes *)(grid_passage(state, group, slot) + 2 * GRID_LANES);
    for (int c = 0; c < 3; ++c) met[c] += *(const GridLanes *)(mean + c * GRID_LANES) * depth;
}

// Replaces the light that the mesh blocks by the light that the mesh reflects.
SIMD_INLINE void meet_mesh(const LightGridState *state, float passed, int slot, float *io)
{
    for (int c = 0; c < 3; ++c) {
        float glow = slot >= 0 ? state->glow[3 * slot + c] : 0;
        GridLanes *lanes = (GridLanes *)(io + c * GRID_LANES);
        *lanes = passed * *lanes + (1 - passed) * glow;
    }
}

// A cell where only the light of hair is followed, onto skin.
SIMD_INLINE void cross_onto(const Sweep *sweep, const GroupWay *way, int group, ptrdiff_t cell,
                            int slot, float *io)
{
    const LightGridState *state = sweep->state;
    float mean[GROUP_WIDE];
    if (slot >= 0 && slot < state->filled)
        pass_cell(sweep, group, slot, io, mean);
    else
        memcpy(mean, io, sizeof mean);
    float(*onto)[3] =
        state->onto_groups[(size_t)group * light_lattice_cells(&state->field.lattice) +
                           (size_t)cell];
    for (int f = 0; f < ONTO_FACES; ++f)
        for (int c = 0; c < 3; ++c) {
            const GridLanes part =
                *(const GridLanes *)(mean + c * GRID_LANES) * *(const GridLanes *)way->face[f];
            float sum = 0;
            for (int l = 0; l < GRID_LANES; ++l) sum += part[l];
            onto[f][c] = sum;
        }
}

// Processes a cell on the way of the group: `io` is the incoming light, then the outgoing light.
SIMD_INLINE void cross_cell(const Sweep *sweep, int group, int slot, float *io, GridLanes met[3])
{
    if (slot < 0) return;
    if (slot >= sweep->state->filled) {
        keep(sweep, group, slot, io);
        return;
    }
    float mean[GROUP_WIDE];
    pass_cell(sweep, group, slot, io, mean);
    keep(sweep, group, slot, mean);
    add_met(sweep->state, group, slot, mean, met);
}

// Sweeps row y of a slice from three blended rows of the slice before, to `out`.
SIMD_INLINE void sweep_row(const Sweep *sweep, const GroupWay *way, int group, bool walls,
                           bool onto, int slice, int y, const int cells[2],
                           const float *const rows[3], float *out, double sum[3])
{
    const LightGridState *state = sweep->state;
    ptrdiff_t first = slice * way->stride[0] + y * way->stride[2];
    const int *slot = state->slot + first;
    ptrdiff_t at = slice * way->step[0] + y * way->step[2];
    GridLanes met[3] = {{0}};
    for (int x = cells[0]; x < cells[1]; ++x) {
        size_t column = (size_t)x * GROUP_WIDE;
        ptrdiff_t here = at + x * way->step[1];
        float low = walls ? way->walls[2][here] : 1,
              high = walls ? way->walls[2][here + way->step[2]] : 1;
        int own = slot[x * way->stride[1]];
        blend(way->taps[1], low, high, rows[0] + column, rows[1] + column, rows[2] + column,
              out + column);
        float passed = walls ? way->walls[0][here + (way->forward ? 0 : way->step[0])] : 1;
        if (!onto) add_glow(state, way->taps[1], low, high, own, out + column);
        if (passed != 1) meet_mesh(state, passed, onto ? -1 : own, out + column);
        if (onto)
            cross_onto(sweep, way, group, first + x * way->stride[1], own, out + column);
        else
            cross_cell(sweep, group, own, out + column, met);
    }
    for (int c = 0; c < 3; ++c)
        for (int l = 0; l < GRID_LANES; ++l) sum[c] += (double)met[c][l];
}

// The light of the slice before and of this slice, each with a border of one cell, and three
// blended rows.
typedef struct Planes {
    const float *before;
    float *after, *rows;
} Planes;

// Sweeps a slice. Cells in front of all hair are never written; they keep the environment's light.
SIMD_INLINE void sweep_slice(const Sweep *sweep, const GroupWay *way, int group, bool walls,
                             bool onto, int slice, const Planes *planes, double sum[3])
{
    const int *n = sweep->state->field.lattice.count;
    int wide = n[way->across[0]], tall = n[way->across[1]];
    size_t row = ((size_t)wide + 2) * GROUP_WIDE, used = (size_t)wide * GROUP_WIDE;
    const GridSpan *spans = grid_spans(sweep->state, group, slice);
    const int whole[2] = {0, wide};
    int earlier = way->forward ? slice - 1 : slice + 1;
    ptrdiff_t wall = earlier * way->step[0] - way->step[2];
    const int *slot = earlier >= 0 && earlier < n[way->main]
                          ? sweep->state->slot + earlier * way->stride[0]
                          : NULL;
    // Row y of the slice before is stored at y % 3: three rows around a row of cells are needed at
    // a time.
    for (int y = 0; y < tall + 2; ++y) {
        int blended[2] = {wide, 0};
        for (int around = y < 2 ? 0 : y - 2; around <= y && around < tall; ++around)
            grid_span_join(blended, onto ? whole : grid_span_cells(&spans[around], sweep->sky));
        RowMesh mesh = {.wall = walls ? way->walls[1] + wall + y * way->step[2] : NULL};
        if (!onto && slot && y > 0 && y <= tall) mesh.slot = slot + (y - 1) * way->stride[2];
        blend_row(sweep->state, way, walls, mesh, blended, planes->before + (size_t)y * row,
                  planes->rows + (size_t)(y % 3) * used);
        if (y < 2) continue;
        const float *const rows[3] = {planes->rows + (size_t)((y - 2) % 3) * used,
                                      planes->rows + (size_t)((y - 1) % 3) * used,
                                      planes->rows + (size_t)(y % 3) * used};
        float *out = planes->after + (size_t)(y - 1) * row + GROUP_WIDE;
        sweep_row(sweep, way, group, walls, onto, slice, y - 2,
                  onto ? whole : grid_span_cells(&spans[y - 2], sweep->sky), rows, out, sum);
    }
}

static void fill_plane(float *plane, size_t floats, const float sky[GROUP_WIDE])
{
    for (size_t i = 0; i < floats; i += GROUP_WIDE)
        memcpy(plane + i, sky, GROUP_WIDE * sizeof *sky);
}

SIMD_INLINE void sweep_slices(const Sweep *sweep, const GroupWay *way, int group, bool walls,
                              bool onto)
{
    LightGridState *state = sweep->state;
    const int *n = state->field.lattice.count;
    int slices = n[way->main];
    float *planes[2] = {state->planes + (size_t)(3 * group) * state->plane,
                        state->planes + (size_t)(3 * group + 1) * state->plane},
          *rows = state->planes + (size_t)(3 * group + 2) * state->plane;
    double *sum = state->sums[1][group];
    memset(sum, 0, sizeof state->sums[1][group]);
    size_t used = ((size_t)n[way->across[0]] + 2) * ((size_t)n[way->across[1]] + 2) * GROUP_WIDE;
    for (int k = 0; k < 2; ++k) fill_plane(planes[k], used, way->sky);
    for (int i = 0; i < slices; ++i)
        sweep_slice(sweep, way, group, walls, onto, way->forward ? i : slices - 1 - i,
                    &(Planes){planes[i % 2], planes[(i + 1) % 2], rows}, sum);
}

SIMD_INLINE void sweep_groups(const Sweep *sweep, int part)
{
    for (int group = part; group < ORDINATE_GROUPS; group += sweep->parts) {
        GroupWay way;
        find_way(sweep, group, &way);
        if (way.walls[0])
            sweep_slices(sweep, &way, group, true, false);
        else
            sweep_slices(sweep, &way, group, false, false);
    }
}

SIMD_STAGE(sweep_groups, Sweep)

SIMD_INLINE void sweep_groups_onto(const Sweep *sweep, int part)
{
    for (int group = part; group < ORDINATE_GROUPS; group += sweep->parts) {
        GroupWay way;
        find_way(sweep, group, &way);
        light_grid_find_faces(group, way.face);
        sweep_slices(sweep, &way, group, true, true);
    }
}

SIMD_STAGE(sweep_groups_onto, Sweep)

void light_grid_sweep_onto(LightGridState *state)
{
    int parts = state->parts < ORDINATE_GROUPS ? state->parts : ORDINATE_GROUPS;
    Sweep sweep = {.state = state, .parts = parts};
    run_sweep_groups_onto(&sweep, parts);
}

void light_grid_sweep(LightGridState *state, bool sky, bool fresh)
{
    int parts = state->parts < ORDINATE_GROUPS ? state->parts : ORDINATE_GROUPS;
    memcpy(state->sums[0], state->sums[1], sizeof state->sums[0]);
    Sweep sweep = {state, sky, fresh, parts};
    run_sweep_groups(&sweep, parts);
}

// --- Scattering.

// Scatters the light of one channel in cell f.
SIMD_INLINE void scatter_channel(const LightGridState *state, const float (*rows)[ORDINATES], int f,
                                 int channel, float tint)
{
    float sum[ORDINATES];
    for (int d = 0; d < ORDINATES; ++d) sum[d] = 0;
    for (int g = 0; g < ORDINATE_GROUPS; ++g)
        for (int l = 0; l < GRID_LANES; ++l) {
            float from = grid_lane(state, state->order, g, f)[channel * GRID_LANES + l];
            const float *row = rows[g * GRID_LANES + l];
            for (int d = 0; d < ORDINATES; ++d) sum[d] += from * row[d];
        }
    for (int g = 0; g < ORDINATE_GROUPS; ++g)
        for (int l = 0; l < GRID_LANES; ++l)
            grid_source(state, g, f)[channel * GRID_LANES + l] = tint * sum[g * GRID_LANES + l];
    for (int g = 0; g < ORDINATE_GROUPS && state->lights_skin; ++g)
        for (int l = channel * GRID_LANES; l < (channel + 1) * GRID_LANES; ++l) {
            const float *source = grid_source(state, g, f);
            state->sent[source + l - state->source] += source[l];
        }
}

// The mesh in a cell reflects its colour's share of the light of the last order that it receives,
// equally in all directions.
SIMD_INLINE void reflect(const LightGridState *state, int slot)
{
    int cell[3];
    float n[3], sum[3] = {0}, weights = 0;
    grid_place(state, slot, cell);
    if (!light_field_is_beside_mesh(&state->field, cell)) return;
    light_field_normal(&state->field, cell, n);
    for (int d = 0; d < ORDINATES; ++d) {
        const float *order = grid_lane(state, state->order, d / GRID_LANES, slot) + d % GRID_LANES;
        float weight =
            cell_facing(n[0], n[1], n[2], -ORDINATE[0][d], -ORDINATE[1][d], -ORDINATE[2][d]);
        for (int k = 0; k < 3; ++k) sum[k] += weight * order[k * GRID_LANES];
        weights += weight;
    }
    for (int k = 0; k < 3; ++k) state->glow[3 * slot + k] = state->mesh_color[k] * sum[k] / weights;
}

SIMD_INLINE void scatter(const LightGridState *state, int part)
{
    int first = (int)((int64_t)state->filled * part / state->parts),
        end = (int)((int64_t)state->filled * (part + 1) / state->parts);
    for (int f = first; f < end; ++f) {
        const GridKind *kind = &state->field.kinds[state->class[f] / TANGENTS];
        for (int c = 0; c < 3; ++c)
            scatter_channel(state,
                            (const float(*)[ORDINATES])kind->scatter[state->class[f] % TANGENTS][c],
                            f, c, state->tint[3 * f + c]);
    }
    first = (int)((int64_t)state->active * part / state->parts);
    end = (int)((int64_t)state->active * (part + 1) / state->parts);
    for (int slot = first; slot < end && state->field.walled; ++slot) reflect(state, slot);
}

SIMD_STAGE(scatter, LightGridState)

void light_grid_scatter(LightGridState *state)
{
    run_scatter(state, state->parts);
}
