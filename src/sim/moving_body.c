// SPDX-License-Identifier: MIT
#include "sim/moving_body.h"

#include "strands/follow_plan.h"

#include <libdeflate.h>

#include <math.h>
#include <string.h>

static bool collides(const SectionParams *params)
{
    return params->collide && strcmp(params->algo, "none") != 0;
}

static uint32_t end_of(const SceneBody *body)
{
    return body->first + body->section_count;
}

static bool any_collides(const Scene *scene, const SceneBody *body)
{
    for (uint32_t i = body->first; i < end_of(body); ++i)
        if (collides(&scene->sections[i].params)) return true;
    return false;
}

// Guides from a cache are outside the mesh already, but their followers need the field.
static bool needs_field(const Scene *scene, const SceneBody *body, const Strands *strands)
{
    if (!*scene->run.from_cache) return true;
    for (uint32_t i = body->first; i < end_of(body); ++i) {
        const SectionParams *params = &scene->sections[i].params;
        if (collides(params) && follow_plan_options(params, &strands[i], 0).per_guide > 0)
            return true;
    }
    return false;
}

const DistanceField *moving_body_field(const MovingBody *body)
{
    if (body->moving.work) return &body->moving.field;
    return body->field.spacing > 0 ? &body->field : NULL;
}

void moving_body_update_field(MovingBody *body, double before, double after)
{
    if (!body->moving.work) return;
    const BodyPose *from = bound_body_pose(&body->mesh, before),
                   *to = bound_body_pose(&body->mesh, after);
    moving_field_update(&body->moving, (const float(*)[3])from->position,
                        (const float(*)[3])to->position);
}

static Result create_moving_field(MovingBody *body, const Gpu *gpu, const Scene *scene,
                                  const Strands *strands, uint32_t resolution, Error *error)
{
    float longest = 0, margin = 0;
    for (uint32_t i = body->of->first; i < end_of(body->of); ++i) {
        const SectionParams params = schedule_greatest_params(&scene->run, &scene->sections[i]);
        if (!collides(&params)) continue;
        margin = fmaxf(margin, params.collision_margin);
        for (uint32_t s = 0; s < strands[i].strand_count; ++s)
            longest = fmaxf(longest, (float)strands_length(&strands[i], s));
    }
    TRY(moving_field_create(&body->moving, gpu, body->of->shape, longest, margin, resolution,
                            error));
    moving_body_update_field(body, 0, 0);
    return RESULT_OK;
}

static Result create_field(MovingBody *body, const Gpu *gpu, const Scene *scene,
                           const Strands *strands, const Mesh *mesh, Error *error)
{
    const RunParams *run = &scene->run;
    DistanceField *field = &body->field;
    uint32_t resolution = (uint32_t)run->sdf_resolution;
    if (!body->of->params.collide_mesh || !mesh || !mesh->triangle_count) return RESULT_OK;
    if (!any_collides(scene, body->of)) return RESULT_OK;
    uint32_t sum = libdeflate_crc32(0, mesh->position, mesh->vertex_count * sizeof *mesh->position);
    body->mesh_checksum =
        libdeflate_crc32(sum, mesh->triangle, mesh->triangle_count * sizeof *mesh->triangle);
    if (!needs_field(scene, body->of, strands)) return RESULT_OK;
    resolution = distance_field_affordable(mesh, resolution);
    if (body->mesh.body) return create_moving_field(body, gpu, scene, strands, resolution, error);
    return run->sdf_cache ? distance_field_create_cached(field, gpu, mesh, resolution, NULL, error)
                          : distance_field_create(field, gpu, mesh, resolution, error);
}

Result moving_body_expect_motion(MovingBody *body, const Gpu *gpu, Error *error)
{
    if (body->carry.program) return RESULT_OK;
    return carry_create(&body->carry, &gpu->limits, body->of->shape != NULL, error);
}

Result moving_body_create(MovingBody *body, const Gpu *gpu, const Scene *scene, uint32_t index,
                          const Strands *strands, const Mesh *mesh, Error *error)
{
    const SceneBody *of = &scene->bodies[index];
    *body = (MovingBody){.of = of, .head = head_at(&of->head, 0)};
    body->step_head = body->step_head_before = body->head;
    head_middle(body->middle, &strands[of->first], of->section_count);
    Result result = bound_body_create(&body->mesh, of->shape, error);
    THEN(result, create_field(body, gpu, scene, strands, mesh, error));
    if (!rigid_track_is_still(&of->head)) THEN(result, moving_body_expect_motion(body, gpu, error));
    if (result != RESULT_OK) moving_body_destroy(body);
    return result;
}

void moving_body_destroy(MovingBody *body)
{
    distance_field_destroy(&body->field);
    moving_field_destroy(&body->moving);
    carry_destroy(&body->carry);
    bound_body_destroy(&body->mesh);
    *body = (MovingBody){0};
}
