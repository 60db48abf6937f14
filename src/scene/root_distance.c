// SPDX-License-Identifier: MIT
#include "scene/root_distance.h"
#include "base/doubles.h"
#include "base/quote.h"
#include "mesh/surface.h"

#include <math.h>
#include <stdlib.h>

enum { MOST_ROOTS = 500 }; // that are measured

// Distance over the diagonal of the mesh. It is at most 0.0003 in the bundled scenes and 0.004 for
// Sintel's hair on her head. For a mesh that points in another direction it is 0.024, for another
// one or another unit more than 0.1.
static const double APART = 0.02;

// Diagonal of a head with shoulders, m: the bundled one has 0.54. Of two units that may be wrong,
// the likely one leads to a mesh of about this size.
static const double USUAL_SIZE = 0.5;

// The roots to be measured.
typedef struct Roots {
    Double3 *at;
    double *distance; // room for the distances
    uint32_t count;
} Roots;

static Result collect(Roots *roots, const Scene *scene, const SceneBody *body, const Strands *all,
                      Error *error)
{
    uint64_t total = 0, number = 0;
    for (uint32_t i = body->first; i < body->first + body->section_count; ++i)
        if (!scene->sections[i].params.hidden) total += all[i].strand_count;
    uint64_t stride = total / MOST_ROOTS + 1;
    roots->at = malloc((MOST_ROOTS + 1) * sizeof *roots->at);
    roots->distance = malloc((MOST_ROOTS + 1) * sizeof *roots->distance);
    if (!roots->at || !roots->distance)
        return error_set(error, RESULT_FAILED, "no memory to measure roots");
    for (uint32_t i = body->first; i < body->first + body->section_count; ++i) {
        const Strands *strands = &all[i];
        for (uint32_t s = 0; !scene->sections[i].params.hidden && s < strands->strand_count; ++s)
            if (number++ % stride == 0)
                double3_from_float(strands->position[strands->first[s]], roots->at[roots->count++]);
    }
    return RESULT_OK;
}

// The median distance of the roots from the surface scaled by `scale` about the origin.
static double measure(Roots *roots, const Surface *surface, double scale)
{
    SurfacePoint nearest = {.triangle = surface->triangle[0]};
    for (uint32_t i = 0; i < roots->count; ++i) {
        Double3 at;
        for (int k = 0; k < 3; ++k) at[k] = roots->at[i][k] / scale;
        roots->distance[i] = scale * fabs(surface_nearest(surface, at, &nearest));
    }
    doubles_sort(roots->distance, roots->count);
    return roots->distance[roots->count / 2];
}

// Whether more than half of the roots have a vertex of the mesh within `reach`. This settles most
// meshes without a surface, which takes longer to make.
static bool has_vertices_near(const Roots *roots, const Mesh *mesh, double reach)
{
    uint32_t near = 0;
    for (uint32_t i = 0; i < roots->count; ++i)
        for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
            Double3 at;
            double3_from_float(mesh->position[v], at);
            if (double3_distance(roots->at[i], at) > reach) continue;
            ++near;
            break;
        }
    return 2 * near > roots->count;
}

// A unit with which the roots lie on the mesh.
typedef struct Hint {
    const char *option, *unit; // NULL: there is none
    double odds;               // ratio of the mesh's size to the usual one, as |log|
} Hint;

// Looks for a unit of the mesh or else of the hair, which is `unit` (m) now. `size`: of the mesh.
static void find_unit(Hint *hint, bool of_mesh, Roots *roots, const Surface *surface, double size,
                      double unit)
{
    double least = APART;
    for (int i = 0; i < LENGTH_UNIT_COUNT; ++i) {
        double metres = (double)LENGTH_UNITS[i].metres,
               scale = of_mesh ? metres / unit : unit / metres,
               share = measure(roots, surface, scale) / (scale * size),
               odds = fabs(log((of_mesh ? scale : 1) * size / USUAL_SIZE));
        if (share > least || (hint->option && odds > hint->odds)) continue;
        least = share;
        *hint = (Hint){of_mesh ? "--mesh-unit" : "--unit", LENGTH_UNITS[i].word, odds};
    }
}

static void warn(FILE *messages, const Scene *scene, const SceneBody *body, double hair_unit,
                 Roots *roots, const Surface *surface, double size)
{
    const BodyParams *params = &body->params;
    double apart = measure(roots, surface, 1);
    if (apart <= APART * size) return;
    fprintf(messages,
            "%s: half of the roots are more than %.2g m from this mesh, which is %.2g m across: ",
            quote(params->mesh).text, apart, size);
    Hint hint = {0};
    bool own = !params->mesh_unit.automatic; // otherwise the mesh has the unit of the hair
    find_unit(&hint, true, roots, surface, size, own ? (double)params->mesh_unit.value : hair_unit);
    if (own && !scene->sections[body->first].given)
        find_unit(&hint, false, roots, surface, size, hair_unit);
    if (hint.option)
        fprintf(messages, "with %s %s it fits\n", hint.option, hint.unit);
    else
        fprintf(messages, "expected the mesh on which the hair was groomed (check --mesh-unit and "
                          "--mesh-up)\n");
}

Result root_distance_warn(const Scene *scene, uint32_t b, const Mesh *mesh, const Strands *strands,
                          double hair_unit, FILE *messages, Error *error)
{
    const SceneBody *body = &scene->bodies[b];
    Roots roots = {0};
    Surface surface = {0};
    Result result = collect(&roots, scene, body, strands, error);
    double size = mesh_diagonal(mesh);
    if (result == RESULT_OK && roots.count && !has_vertices_near(&roots, mesh, APART * size)) {
        result = surface_create(&surface, mesh, body->params.mesh, error);
        if (result == RESULT_OK)
            warn(messages, scene, body, hair_unit, &roots, &surface, size);
        else if (result == RESULT_BAD_INPUT)
            result = RESULT_OK; // such a mesh can be drawn
        surface_destroy(&surface);
    }
    free(roots.at);
    free(roots.distance);
    return result;
}
