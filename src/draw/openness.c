// SPDX-License-Identifier: MIT
#include "draw/openness.h"

#include "draw/light_blocks.h"
#include "draw/ordinates.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SMOOTHINGS = 4 };

typedef struct Field {
    LightLattice lattice; // aligned with the mesh's frame
    LightBlocks blocks;
    float *depth;                // [cells]: optical depth of hair over the length of a side
    float (*seen)[ORDINATES][2]; // [cells]: share of the light that arrives from the opposite of
                                 // each ordinate, past hair and mesh, and past the mesh alone; < 0:
                                 // not computed yet
} Field;

static void widen(float low[3], float high[3], const float x[3])
{
    for (int k = 0; k < 3; ++k) {
        low[k] = fminf(low[k], x[k]);
        high[k] = fmaxf(high[k], x[k]);
    }
}

// Places the lattice around mesh and hair, with a spare cell on each side.
static void place_lattice(LightLattice *lattice, const Mesh *mesh, const OpennessHair *hair,
                          uint32_t hair_count)
{
    float low[3], high[3], longest = 0;
    mesh_bounds(mesh, low, high);
    for (uint32_t i = 0; i < hair_count; ++i)
        for (uint32_t v = 0; v < hair[i].strands->vertex_count; ++v)
            widen(low, high, hair[i].strands->position[v]);
    for (int k = 0; k < 3; ++k) longest = fmaxf(longest, high[k] - low[k]);
    lattice->side = fmaxf(longest, 1e-6f) / (OPENNESS_CELLS - 2);
    for (int k = 0; k < 3; ++k) {
        lattice->turn[k][k] = 1;
        lattice->count[k] = (int)ceilf((high[k] - low[k]) / lattice->side) + 2;
        lattice->low[k] = 0.5f * (low[k] + high[k] - (float)lattice->count[k] * lattice->side);
    }
}

static size_t cell_at(const LightLattice *lattice, const int cell[3])
{
    return ((size_t)cell[2] * (size_t)lattice->count[1] + (size_t)cell[1]) *
               (size_t)lattice->count[0] +
           (size_t)cell[0];
}

static bool is_inside(const LightLattice *lattice, const int cell[3])
{
    for (int k = 0; k < 3; ++k)
        if (cell[k] < 0 || cell[k] >= lattice->count[k]) return false;
    return true;
}

// Adds the optical depth of hair over the length of a side h of a cell: the sum of 2 r length
// sin(angle) / h^2. The sine is replaced by its mean over all directions, pi / 4.
static void fill_hair(Field *field, const OpennessHair *hair)
{
    const LightLattice *lattice = &field->lattice;
    const Strands *strands = hair->strands;
    float factor = 0.7854f * 2 * hair->radius * hair->each / (lattice->side * lattice->side);
    for (uint32_t s = 0; s < strands->strand_count; ++s)
        for (uint32_t v = strands->first[s]; v + 1 < strands->first[s + 1]; ++v) {
            const float *a = strands->position[v], *b = strands->position[v + 1];
            float square = 0;
            for (int k = 0; k < 3; ++k) square += (b[k] - a[k]) * (b[k] - a[k]);
            float length = sqrtf(square);
            int pieces = 1 + (int)(length / lattice->side), cell[3];
            for (int i = 0; i < pieces; ++i) {
                float share = ((float)i + 0.5f) / (float)pieces;
                for (int k = 0; k < 3; ++k)
                    cell[k] = (int)floorf((a[k] + share * (b[k] - a[k]) - lattice->low[k]) /
                                          lattice->side);
                if (is_inside(lattice, cell))
                    field->depth[cell_at(lattice, cell)] += factor * length / (float)pieces;
            }
        }
}

static Result fill(Field *field, const Mesh *mesh, const OpennessHair *hair, uint32_t hair_count,
                   Error *error)
{
    place_lattice(&field->lattice, mesh, hair, hair_count);
    size_t cells = light_lattice_cells(&field->lattice);
    field->depth = calloc(cells, sizeof *field->depth);
    field->seen = malloc(cells * sizeof *field->seen);
    if (!field->depth || !field->seen)
        return error_set(error, RESULT_FAILED, "no memory for %zu cells of the sky", cells);
    for (size_t i = 0; i < cells; ++i) field->seen[i][0][0] = -1;
    for (uint32_t i = 0; i < hair_count; ++i) fill_hair(field, &hair[i]);
    field->blocks.mesh = (LightMesh){.vertices = (const float(*)[3])mesh->position,
                                     .triangles = (const uint32_t(*)[3])mesh->triangle,
                                     .vertex_count = mesh->vertex_count,
                                     .triangle_count = mesh->triangle_count,
                                     .rotation = {0, 0, 0, 1}};
    return light_blocks_find(&field->blocks, &field->lattice, error);
}

// The transmittance of hair from the centre of a cell along the unit vector `way`.
static float pass_hair(const Field *field, const int cell[3], const float way[3])
{
    float main = fmaxf(fmaxf(fabsf(way[0]), fabsf(way[1])), fabsf(way[2])), depth = 0;
    int at[3] = {cell[0], cell[1], cell[2]};
    for (int step = 1; is_inside(&field->lattice, at); ++step) {
        depth += (step == 1 ? 0.5f : 1.0f) * field->depth[cell_at(&field->lattice, at)] / main;
        for (int k = 0; k < 3; ++k) at[k] = cell[k] + (int)lroundf((float)step * way[k] / main);
    }
    return expf(-depth);
}

static const float (*see(Field *field, const int cell[3]))[2]
{
    float(*seen)[2] = field->seen[cell_at(&field->lattice, cell)];
    if (seen[0][0] >= 0) return (const float(*)[2])seen;
    for (int o = 0; o < ORDINATES; ++o) {
        const float way[3] = {-ORDINATE[0][o], -ORDINATE[1][o], -ORDINATE[2][o]};
        float past = light_blocks_march(&field->blocks, &field->lattice, cell, way, INFINITY);
        seen[o][1] = past;
        seen[o][0] = past > 0 ? past * pass_hair(field, cell, way) : 0;
    }
    return (const float(*)[2])seen;
}

// The openness of a surface with the unit normal n in a cell. False if no light reaches the cell
// from any direction, as inside the mesh.
static bool see_from(Field *field, const int cell[3], const float n[3], float open[2])
{
    open[0] = open[1] = 1;
    if (!is_inside(&field->lattice, cell)) return true;
    const float(*seen)[2] = see(field, cell);
    float sum[2] = {0}, whole = 0, any = 0;
    for (int o = 0; o < ORDINATES; ++o) {
        float c = -(n[0] * ORDINATE[0][o] + n[1] * ORDINATE[1][o] + n[2] * ORDINATE[2][o]);
        any += seen[o][0];
        if (c <= 0) continue;
        for (int k = 0; k < 2; ++k) sum[k] += c * seen[o][k];
        whole += c;
    }
    for (int k = 0; k < 2; ++k) open[k] = sum[k] / whole;
    return any > 0;
}

// Interpolates between the centres of the eight cells around the point that is one side h above the
// surface. Cells without light are left out.
static void see_at(Field *field, const float x[3], const float n[3], float open[2])
{
    const LightLattice *lattice = &field->lattice;
    float share[3], sum[2] = {0}, weights = 0;
    int first[3];
    for (int k = 0; k < 3; ++k) {
        float at = (x[k] + lattice->side * n[k] - lattice->low[k]) / lattice->side - 0.5f;
        first[k] = (int)floorf(at);
        share[k] = at - floorf(at);
    }
    for (int corner = 0; corner < 8; ++corner) {
        int cell[3];
        float weight = 1;
        for (int k = 0; k < 3; ++k) {
            int on = corner >> k & 1;
            cell[k] = first[k] + on;
            weight *= on ? share[k] : 1 - share[k];
        }
        float seen[2];
        if (!(weight > 0) || !see_from(field, cell, n, seen)) continue;
        for (int k = 0; k < 2; ++k) sum[k] += weight * seen[k];
        weights += weight;
    }
    for (int k = 0; k < 2; ++k) open[k] = weights > 0 ? sum[k] / weights : 0;
}

// Replaces each vertex's values by the means of its own and its neighbours' values.
static Result smooth(float (*open)[2], const Mesh *mesh, Error *error)
{
    float(*sum)[3] =
        malloc((size_t)mesh->vertex_count * sizeof *sum); // both values, and their number
    if (!sum)
        return error_set(error, RESULT_FAILED, "no memory for %u vertices", mesh->vertex_count);
    for (int turn = 0; turn < SMOOTHINGS; ++turn) {
        for (uint32_t v = 0; v < mesh->vertex_count; ++v)
            sum[v][0] = open[v][0], sum[v][1] = open[v][1], sum[v][2] = 1;
        for (uint32_t t = 0; t < mesh->triangle_count; ++t)
            for (int k = 0; k < 3; ++k) {
                uint32_t v = mesh->triangle[t][k], other = mesh->triangle[t][(k + 1) % 3];
                for (int n = 0; n < 2; ++n)
                    sum[v][n] += open[other][n], sum[other][n] += open[v][n];
                ++sum[v][2], ++sum[other][2];
            }
        for (uint32_t v = 0; v < mesh->vertex_count; ++v)
            for (int n = 0; n < 2; ++n) open[v][n] = sum[v][n] / sum[v][2];
    }
    free(sum);
    return RESULT_OK;
}

Result openness_find(float (*open)[2], const Mesh *mesh, const OpennessHair *hair,
                     uint32_t hair_count, Error *error)
{
    Field field = {0};
    Result result = fill(&field, mesh, hair, hair_count, error);
    for (uint32_t v = 0; v < mesh->vertex_count && result == RESULT_OK; ++v)
        see_at(&field, mesh->position[v], mesh->normal[v], open[v]);
    THEN(result, smooth(open, mesh, error));
    light_blocks_destroy(&field.blocks);
    free(field.depth);
    free(field.seen);
    return result;
}
