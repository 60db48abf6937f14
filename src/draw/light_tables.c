// SPDX-License-Identifier: MIT
// Tables of a light field: how fibres scatter from a light to each ordinate, from one ordinate to
// another, and from the ordinates to the eye.
#include "base/parallel.h"
#include "draw/light_field.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LANES = ORDINATE_LANES, NODES_ROW = CELL_NODES_ROW };

static void find_group_ways(int group, Ways *ways)
{
    for (int k = 0; k < 3; ++k)
        for (int l = 0; l < LANES; ++l) ways->axis[k][l] = ORDINATE[k][group * LANES + l];
}

static void find_same_ways(const float way[3], float factor, Ways *ways)
{
    for (int k = 0; k < 3; ++k)
        for (int l = 0; l < LANES; ++l) ways->axis[k][l] = factor * way[k];
}

// --- From a light, and between ordinates.

// The light that a fibre of the class scatters to each ordinate from light of radiance 1 that comes
// from `way` (unit vector towards the light), times the fibre's visible width in that direction.
static void make_first_row(const FibreLobes *lobes, const float way[4], int class,
                           float row[GRID_WIDE])
{
    const float *t = TANGENT[class];
    Ways in, out;
    find_same_ways(way, 1, &in);
    for (int g = 0; g < ORDINATE_GROUPS; ++g) {
        float f[3][ORDINATE_LANES];
        find_group_ways(g, &out);
        fibre_lobes_scatter(lobes, t, &out, &in, GRID_BLUR + way[3], f);
        for (int l = 0; l < LANES; ++l) {
            float along = t[0] * out.axis[0][l] + t[1] * out.axis[1][l] + t[2] * out.axis[2][l],
                  sine = sqrtf(fmaxf(1 - along * along, 0));
            for (int c = 0; c < 3; ++c) row[(g * 3 + c) * LANES + l] = (float)M_PI * sine * f[c][l];
        }
    }
}

typedef struct MakeFirst {
    GridKind *kind;
    int light, parts;
} MakeFirst;

static void make_first(void *data, int part)
{
    const MakeFirst *make = data;
    GridKind *kind = make->kind;
    for (int class = part; class < TANGENTS; class += make->parts)
        make_first_row(&kind->lobes, kind->first_way[make->light], class,
                       kind->first[make->light][class]);
}

Result light_field_make_first(LightField *field, const GridScene *scene, Error *error)
{
    for (int k = 0; k < scene->kind_count && field->lights > 0; ++k) {
        GridKind *kind = &field->kinds[k];
        if (!kind->first) kind->first = malloc(MAX_LIGHTS * sizeof *kind->first);
        if (!kind->first) return error_set(error, RESULT_FAILED, "no memory for light among hair");
        for (int l = 0; l < field->lights; ++l) {
            if (kind->has_first[l] &&
                memcmp(kind->first_way[l], field->to_light[l], sizeof kind->first_way[l]) == 0)
                continue;
            memcpy(kind->first_way[l], field->to_light[l], sizeof kind->first_way[l]);
            MakeFirst make = {kind, l, parallel_threads()};
            parallel_run(make.parts, make_first, &make);
            kind->has_first[l] = true;
            ++kind->made[FIELD_FIRST];
        }
    }
    return RESULT_OK;
}

// Scales rows so that uniform incident light of radiance 1 leaves as the fibre's albedo.
static void make_scatter_table(const FibreLobes *lobes, int class,
                               float (*table)[ORDINATES][ORDINATES])
{
    const float *t = TANGENT[class];
    Ways in, out;
    for (int g = 0; g < ORDINATE_GROUPS; ++g) {
        float sum[3][LANES] = {{0}};
        find_group_ways(g, &out);
        for (int d = 0; d < ORDINATES; ++d) {
            float f[3][ORDINATE_LANES], from[3] = {ORDINATE[0][d], ORDINATE[1][d], ORDINATE[2][d]};
            find_same_ways(from, -1, &in);
            fibre_lobes_scatter(lobes, t, &out, &in, 2 * GRID_BLUR, f);
            for (int c = 0; c < 3; ++c)
                for (int l = 0; l < LANES; ++l) {
                    table[c][d][g * LANES + l] = f[c][l];
                    sum[c][l] += f[c][l];
                }
        }
        for (int l = 0; l < LANES; ++l) {
            float along = t[0] * out.axis[0][l] + t[1] * out.axis[1][l] + t[2] * out.axis[2][l],
                  albedo[3];
            fibre_lobes_albedo(lobes, sqrtf(fmaxf(1 - along * along, 0)), albedo);
            for (int c = 0; c < 3; ++c)
                for (int d = 0; d < ORDINATES; ++d)
                    table[c][d][g * LANES + l] *= albedo[c] / fmaxf(sum[c][l], 1e-12f);
        }
    }
}

typedef struct MakeScatter {
    LightField *field;
    uint16_t needed[LIGHT_GRID_KINDS * TANGENTS];
    int count, parts;
} MakeScatter;

static void make_scatter(void *data, int part)
{
    const MakeScatter *make = data;
    for (int n = part; n < make->count; n += make->parts) {
        GridKind *kind = &make->field->kinds[make->needed[n] / TANGENTS];
        int class = make->needed[n] % TANGENTS;
        make_scatter_table(&kind->lobes, class, kind->scatter[class]);
    }
}

// Adds a class to the list of classes of its kind whose tables must be computed.
static void need_scatter(MakeScatter *make, int class)
{
    GridKind *kind = &make->field->kinds[class / TANGENTS];
    if (kind->has_scatter[class % TANGENTS]) return;
    kind->has_scatter[class % TANGENTS] = true;
    make->needed[make->count++] = (uint16_t) class;
    ++kind->made[FIELD_SCATTER];
}

Result light_field_make_scatter(LightField *field, const GridScene *scene, const int *classes,
                                int count, Error *error)
{
    MakeScatter make = {.field = field, .parts = parallel_threads()};
    for (int k = 0; k < scene->kind_count; ++k) {
        GridKind *kind = &field->kinds[k];
        if (!kind->scatter) kind->scatter = malloc(TANGENTS * sizeof *kind->scatter);
        if (!kind->scatter)
            return error_set(error, RESULT_FAILED, "no memory for light among hair");
    }
    if (!classes) count = scene->kind_count * TANGENTS;
    for (int i = 0; i < count; ++i) need_scatter(&make, classes ? classes[i] : i);
    if (make.count) parallel_run(make.parts, make_scatter, &make);
    return RESULT_OK;
}

// --- To the eye.

static void find_node_tangent(int node, float t[3])
{
    float u = 2 * (float)(node % NODES_ROW) / CELL_SIDE - 1,
          v = 2 * (float)(node / NODES_ROW) / CELL_SIDE - 1, z = 1 - fabsf(u) - fabsf(v), length;
    t[0] = u, t[1] = v, t[2] = z;
    if (z < 0) {
        t[0] = copysignf(1 - fabsf(v), u);
        t[1] = copysignf(1 - fabsf(u), v);
    }
    length = sqrtf(t[0] * t[0] + t[1] * t[1] + t[2] * t[2]);
    for (int k = 0; k < 3; ++k) t[k] /= length;
}

// Scales the row so that all ordinates together give the fibre's albedo.
static void make_row(const GridKind *kind, int node, float row[GRID_WIDE])
{
    float t[3], sum[3] = {0}, along = 0, albedo[3];
    Ways in, out;
    find_node_tangent(node, t);
    find_same_ways(kind->gather_eye, 1, &out);
    for (int g = 0; g < ORDINATE_GROUPS; ++g) {
        float f[3][ORDINATE_LANES];
        find_group_ways(g, &in);
        for (int k = 0; k < 3; ++k)
            for (int l = 0; l < LANES; ++l) in.axis[k][l] = -in.axis[k][l];
        fibre_lobes_scatter(&kind->lobes, t, &out, &in, GRID_BLUR, f);
        for (int c = 0; c < 3; ++c)
            for (int l = 0; l < LANES; ++l) {
                row[(g * 3 + c) * LANES + l] = f[c][l];
                sum[c] += f[c][l];
            }
    }
    for (int k = 0; k < 3; ++k) along += t[k] * kind->gather_eye[k];
    fibre_lobes_albedo(&kind->lobes, sqrtf(fmaxf(1 - along * along, 0)), albedo);
    for (int g = 0; g < ORDINATE_GROUPS; ++g)
        for (int c = 0; c < 3; ++c)
            for (int l = 0; l < LANES; ++l)
                row[(g * 3 + c) * LANES + l] *= albedo[c] / fmaxf(sum[c], 1e-12f);
}

// Stores a node's row in all patches that have the node at a corner or on an edge.
static void put_row(GridKind *kind, int node, const float row[GRID_WIDE])
{
    int x = node % NODES_ROW, y = node / NODES_ROW;
    for (int down = y / CELL_PATCH_SIDE; down >= 0 && y <= (down + 1) * CELL_PATCH_SIDE; --down)
        for (int over = x / CELL_PATCH_SIDE; over >= 0 && x <= (over + 1) * CELL_PATCH_SIDE;
             --over) {
            if (down == CELL_PATCHES_ROW || over == CELL_PATCHES_ROW) continue;
            int at = (y - CELL_PATCH_SIDE * down) * CELL_PATCH_ROW + x - CELL_PATCH_SIDE * over;
            float(*patch)[CELL_PATCH_NODES] = kind->gather[down * CELL_PATCHES_ROW + over];
            for (int i = 0; i < GRID_WIDE; ++i) patch[i][at] = row[i];
        }
}

typedef struct MakeGather {
    GridKind *kind;
    int parts;
} MakeGather;

static void make_rows(void *data, int part)
{
    const MakeGather *make = data;
    float row[GRID_WIDE];
    for (int node = part; node < NODES_ROW * NODES_ROW; node += make->parts) {
        make_row(make->kind, node, row);
        put_row(make->kind, node, row);
    }
}

Result light_field_make_gather(LightField *field, const GridScene *scene, Error *error)
{
    float eye[3];
    light_lattice_turn(&field->lattice, scene->to_eye, eye);
    for (int k = 0; k < scene->kind_count; ++k) {
        GridKind *kind = &field->kinds[k];
        if (!kind->gather) kind->gather = malloc(CELL_PATCHES * sizeof *kind->gather);
        if (!kind->gather) return error_set(error, RESULT_FAILED, "no memory for light among hair");
        if (kind->has_gather && memcmp(kind->gather_eye, eye, sizeof eye) == 0) continue;
        memcpy(kind->gather_eye, eye, sizeof eye);
        MakeGather make = {kind, parallel_threads()};
        parallel_run(make.parts, make_rows, &make);
        kind->has_gather = true;
        ++kind->made[FIELD_GATHER];
    }
    return RESULT_OK;
}

// --- From lights to the eye, by parallel fibres.

static void make_cone(GridKind *kind, int light)
{
    const ConeView *view = &kind->cone_views[light];
    ConeTerms terms;
    cone_find_terms(&terms, &kind->lobes, GRID_BLUR, view->to_light[3]);
    for (int node = 0; node < CELL_NODES; ++node) {
        float t[3];
        find_node_tangent(node, t);
        cone_find_rows(&terms, view, t, kind->cone[light][node]);
    }
}

Result light_field_make_cone(LightField *field, const GridScene *scene, Error *error)
{
    ConeView view = {.to_eye = {0}};
    light_lattice_turn(&field->lattice, scene->to_eye, view.to_eye);
    for (int k = 0; k < scene->kind_count && field->lights > 0; ++k) {
        GridKind *kind = &field->kinds[k];
        if (!kind->cone) kind->cone = calloc(MAX_LIGHTS, sizeof *kind->cone);
        if (!kind->cone) return error_set(error, RESULT_FAILED, "no memory for light among hair");
        for (int l = 0; l < field->lights; ++l) {
            memcpy(view.to_light, field->to_light[l], sizeof view.to_light);
            memcpy(view.color, scene->draw->light_color[l], sizeof view.color);
            if (kind->has_cone[l] && memcmp(&kind->cone_views[l], &view, sizeof view) == 0)
                continue;
            kind->cone_views[l] = view;
            make_cone(kind, l);
            kind->has_cone[l] = true;
            ++kind->made[FIELD_CONE];
        }
    }
    return RESULT_OK;
}

static void forget_kind(GridKind *kind)
{
    memset(kind->has_scatter, 0, sizeof kind->has_scatter);
    memset(kind->has_first, 0, sizeof kind->has_first);
    memset(kind->has_cone, 0, sizeof kind->has_cone);
    kind->has_gather = false;
}

void light_field_set_kinds(LightField *field, const GridScene *scene)
{
    for (int k = 0; k < scene->kind_count; ++k) {
        GridKind *kind = &field->kinds[k];
        if (kind->lobes.serial == scene->kinds[k].serial) continue;
        kind->lobes = scene->kinds[k];
        forget_kind(kind);
    }
}

const float *light_field_table(const GridKind *kind, FieldTable table)
{
    switch (table) {
    case FIELD_FIRST:
        return (const float *)kind->first;
    case FIELD_SCATTER:
        return (const float *)kind->scatter;
    case FIELD_CONE:
        return (const float *)kind->cone;
    default:
        return (const float *)kind->gather;
    }
}
