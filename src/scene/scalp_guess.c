// SPDX-License-Identifier: MIT
#include "scene/scalp_guess.h"

#include "mesh/stand_in.h"
#include "strands/scalp_fit.h"

#include <math.h>
#include <stdlib.h>

static const double UNLIKE = 1.4;  // ratio to a head's width from which another unit is likely
static const double LONGER = 1.02; // ratio of an axis to the shortest one from which it needs a
                                   // capsule

// The result of scalp_fit for hair on the bundled head; it is the same for demo, bob, fall and
// curls of assets/.
static const double HEAD_CENTRE[3] = {0, 0.0155, -0.013}, HEAD_RADIUS[3] = {0.0775, 0.0943, 0.0925};

// The bundled head facing +z, scaled so that its scalp becomes the fitted ellipsoid.
static Result make_mesh(Mesh *mesh, const ScalpFit *fit, Error *error)
{
    TRY(stand_in_make_mesh(mesh, error));
    for (uint32_t v = 0; v < mesh->vertex_count; ++v)
        for (int k = 0; k < 3; ++k)
            mesh->position[v][k] =
                (float)(fit->centre[k] + fit->radius[k] / HEAD_RADIUS[k] *
                                             ((double)mesh->position[v][k] - HEAD_CENTRE[k]));
    mesh_compute_normals(mesh);
    return RESULT_OK;
}

// The capsule along axis k must stay inside the ellipsoid. So the radius of its ends is at most the
// smallest radius of curvature at the tip, which is at least least^2 / radius[k].
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

// Fits the scalp to the body's visible sections. The copies in `seen` do not own their arrays.
static Result fit_sections(ScalpFit *fit, const Scene *scene, const SceneBody *body,
                           const Assets *assets, Error *error)
{
    uint32_t count = 0;
    Strands *seen = malloc((body->section_count + (size_t)1) * sizeof *seen);
    if (!seen) return error_set(error, RESULT_FAILED, "no memory to look for a scalp");
    for (uint32_t i = body->first; i < body->first + body->section_count; ++i)
        if (!scene->sections[i].params.hidden) seen[count++] = assets->strands[i];
    *fit = scalp_fit(seen, count);
    free(seen);
    return RESULT_OK;
}

// If the scalp does not have the size of a head, suggests the unit for which it would have: a named
// unit if one is near.
static void suggest_unit(FILE *messages, const char *place, const ScalpFit *fit, double unit)
{
    double wanted = unit * HEAD_RADIUS[0] / fit->radius[0];
    fprintf(messages, "%sthe scalp is %.2g m wide, a head's %.2g m: with --unit ", place,
            2 * fit->radius[0], 2 * HEAD_RADIUS[0]);
    for (int i = 0; i < LENGTH_UNIT_COUNT; ++i)
        if (fabs(log(wanted / (double)LENGTH_UNITS[i].metres)) < log(UNLIKE)) {
            fprintf(messages, "%s it is as wide\n", LENGTH_UNITS[i].word);
            return;
        }
    fprintf(messages, "%.2g it is as wide\n", wanted);
}

// `place`: of the body, before a message.
static void report(FILE *messages, const char *place, const ScalpFit *fit, double unit,
                   bool verbose)
{
    if (fit->found)
        fprintf(messages,
                "%sscalp: guessed a head of %.3g x %.3g x %.3g m at %.3g, %.3g, %.3g, %.2g mm from "
                "the roots: --scalp none leaves it out\n",
                place, 2 * fit->radius[0], 2 * fit->radius[1], 2 * fit->radius[2], fit->centre[0],
                fit->centre[1], fit->centre[2], 1e3 * fit->error);
    else if (verbose || fit->other_size)
        fprintf(messages, "%sscalp: none: %s\n", place, fit->reason);
    if (fit->around)
        fprintf(messages,
                "%sthe roots surround a body that is not drawn, and the far side shows through: "
                "expected --mesh with its shape\n",
                place);
    if ((fit->found || fit->other_size) && fabs(log(fit->radius[0] / HEAD_RADIUS[0])) > log(UNLIKE))
        suggest_unit(messages, place, fit, unit);
}

// Fits a head to the hair of a body without a mesh.
static Result guess(Scene *scene, uint32_t b, Assets *assets, FILE *messages, bool verbose,
                    Error *error)
{
    SceneBody *body = &scene->bodies[b];
    ScalpFit fit = {0};
    if (assets->meshes[b].vertex_count) return RESULT_OK;
    TRY(fit_sections(&fit, scene, body, assets, error));
    if (messages)
        report(messages, scene_body_place(scene, b, ": ").text, &fit,
               (double)assets->reports[body->first].unit_used, verbose);
    if (!fit.found) return RESULT_OK;
    TRY(make_mesh(&assets->meshes[b], &fit, error));
    if (!body->params.collide_mesh) return RESULT_OK;
    body->params.collide_mesh = false; // the shapes take over from the mesh
    return add_colliders(&body->colliders, &fit, error);
}

Result scalp_guess(Scene *scene, Assets *assets, FILE *messages, bool verbose, Error *error)
{
    if (scene->run.scalp == SCALP_NONE) return RESULT_OK;
    for (uint32_t b = 0; b < scene->body_count; ++b)
        TRY(guess(scene, b, assets, messages, verbose, error));
    return RESULT_OK;
}
