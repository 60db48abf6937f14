// SPDX-License-Identifier: MIT
#include "scene/scalp_guess.h"

#include "mesh/scalp.h"
#include "strands/scalp_fit.h"

#include <math.h>
#include <stdlib.h>

enum { RINGS = 32 };
static const float DARKER = 0.6f;    // of the hair in sRGB: about 0.3 of its light
static const double LONGER = 1.02;   // axes that need a capsule besides the sphere
static const double MESH_SIZE = 0.1; // m, radius of the sphere that is stretched

static Result make_mesh(Mesh *mesh, const ScalpFit *fit, Error *error)
{
    TRY(scalp_make_mesh(mesh, SCALP_SPHERE, RINGS, error));
    for (uint32_t v = 0; v < mesh->vertex_count; ++v)
        for (int k = 0; k < 3; ++k)
            mesh->position[v][k] =
                (float)(fit->centre[k] + fit->radius[k] / MESH_SIZE * (double)mesh->position[v][k]);
    mesh_compute_normals(mesh);
    return RESULT_OK;
}

// A ball in the end of the ellipsoid along axis k that touches it there has the radius of the
// surface's greatest curvature, least^2 / radius[k] or more.
static Result add_capsule(Colliders *colliders, const ScalpFit *fit, int k, double least,
                          Error *error)
{
    Collider capsule = {.kind = COLLIDER_CAPSULE};
    double end = least * least / fit->radius[k];
    for (int i = 0; i < 3; ++i) capsule.numbers[i] = capsule.numbers[4 + i] = (float)fit->centre[i];
    capsule.numbers[k] -= (float)(fit->radius[k] - end);
    capsule.numbers[4 + k] += (float)(fit->radius[k] - end);
    capsule.numbers[3] = capsule.numbers[7] = (float)end;
    return colliders_add(colliders, &capsule, error);
}

static Result add_colliders(Colliders *colliders, const ScalpFit *fit, Error *error)
{
    double least = fmin(fit->radius[0], fmin(fit->radius[1], fit->radius[2]));
    const Collider sphere = {.kind = COLLIDER_SPHERE,
                             .numbers = {(float)fit->centre[0], (float)fit->centre[1],
                                         (float)fit->centre[2], (float)least}};
    TRY(colliders_add(colliders, &sphere, error));
    for (int k = 0; k < 3; ++k)
        if (fit->radius[k] > LONGER * least) TRY(add_capsule(colliders, fit, k, least, error));
    return RESULT_OK;
}

static void darken(Scene *scene)
{
    const SectionParams *params = &scene->sections[0].params;
    for (int k = 0; k < 3; ++k) scene->run.mesh_color[k] = DARKER * params->color[k];
    scene->run.mesh_shading = MESH_MATT;
}

// Of the sections that are seen; the copies do not own their arrays.
static Result fit_sections(ScalpFit *fit, const Scene *scene, const Assets *assets, Error *error)
{
    uint32_t count = 0;
    Strands *seen = malloc((scene->section_count + (size_t)1) * sizeof *seen);
    if (!seen) return error_set(error, RESULT_FAILED, "no memory to look for a scalp");
    for (uint32_t i = 0; i < scene->section_count; ++i)
        if (!scene->sections[i].params.hidden) seen[count++] = assets->strands[i];
    *fit = scalp_fit(seen, count);
    free(seen);
    return RESULT_OK;
}

Result scalp_guess(Scene *scene, Assets *assets, FILE *messages, bool verbose, Error *error)
{
    ScalpFit fit = {0};
    if (assets->has_mesh || scene->run.scalp == SCALP_NONE) return RESULT_OK;
    TRY(fit_sections(&fit, scene, assets, error));
    if (messages && (fit.found || verbose)) {
        fprintf(messages, "scalp: ");
        if (fit.found)
            fprintf(messages,
                    "an ellipsoid %.3g x %.3g x %.3g m at %.3g, %.3g, %.3g, off the roots by "
                    "%.2g mm: --scalp none leaves it out\n",
                    2 * fit.radius[0], 2 * fit.radius[1], 2 * fit.radius[2], fit.centre[0],
                    fit.centre[1], fit.centre[2], 1e3 * fit.error);
        else
            fprintf(messages, "none: %s\n", fit.reason);
    }
    if (!fit.found) return RESULT_OK;
    TRY(make_mesh(&assets->mesh, &fit, error));
    assets->has_mesh = true;
    darken(scene);
    if (!scene->run.collide_mesh) return RESULT_OK;
    scene->run.collide_mesh = false; // shapes do it
    return add_colliders(&scene->colliders, &fit, error);
}
