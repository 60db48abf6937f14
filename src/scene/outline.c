// SPDX-License-Identifier: MIT
#include "scene/outline.h"

#include "base/simd.h"
#include "scene/axes.h"
#include "scene/schedule.h"
#include "strands/follow_plan.h"

#include <cglm/cglm.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Sampled times, angles and vertices. The margin allows for what lies between the samples.
enum { TIMES = 16, ANGLES = 64, VERTICES = 50000 };

// Directions on a Fibonacci spiral, which are spaced evenly over the sphere.
static void begin_outline(Outline *outline, const float point[3])
{
    const float golden = 2.39996323f;
    for (int i = 0; i < OUTLINE_DIRECTIONS; ++i) {
        float z = 1 - (2 * (float)i + 1) / OUTLINE_DIRECTIONS, r = sqrtf(1 - z * z);
        outline->direction[0][i] = r * cosf(golden * (float)i);
        outline->direction[1][i] = r * sinf(golden * (float)i);
        outline->direction[2][i] = z;
        outline->reach[i] = -INFINITY;
    }
    memcpy(outline->low, point, sizeof outline->low);
    memcpy(outline->high, point, sizeof outline->high);
    outline->any = true;
}

typedef struct Points {
    Outline *outline;
    const float (*points)[3];
    size_t count;
} Points;

enum { LANES = 16 }; // directions at a time
typedef float Reaches __attribute__((vector_size(LANES * sizeof(float))));
typedef int32_t Numbers __attribute__((vector_size(LANES * sizeof(int32_t))));

// The farthest points in LANES directions from number `first` on. Explicit vectors stay in
// registers, which compilers do not do with the same loop over arrays.
SIMD_INLINE void add_points_along(Outline *outline, const Points *points, int first)
{
    Reaches x, y, z, most;
    Numbers best = (Numbers){0} - 1;
    memcpy(&x, &outline->direction[0][first], sizeof x);
    memcpy(&y, &outline->direction[1][first], sizeof y);
    memcpy(&z, &outline->direction[2][first], sizeof z);
    memcpy(&most, &outline->reach[first], sizeof most);
    for (int32_t i = 0; i < (int32_t)points->count; ++i) {
        const float *point = points->points[i];
        Reaches reach = x * point[0] + y * point[1] + z * point[2];
        Numbers farther = reach > most;
        most = (Reaches)((farther & (Numbers)reach) | (~farther & (Numbers)most));
        best = (farther & i) | (~farther & best);
    }
    memcpy(&outline->reach[first], &most, sizeof most);
    for (int k = 0; k < LANES; ++k)
        if (best[k] >= 0) memcpy(outline->point[first + k], points->points[best[k]], sizeof(vec3));
}

SIMD_INLINE void add_points(const Points *points, int part)
{
    Outline *outline = points->outline;
    (void)part;
    for (int i = 0; i < OUTLINE_DIRECTIONS; i += LANES) add_points_along(outline, points, i);
    for (size_t i = 0; i < points->count; ++i)
        for (int k = 0; k < 3; ++k) {
            outline->low[k] = simd_min(points->points[i][k], outline->low[k]);
            outline->high[k] = simd_max(points->points[i][k], outline->high[k]);
        }
}

SIMD_CALL(add_points, Points)

void outline_add(Outline *outline, const float (*points)[3], size_t count)
{
    if (!outline->any && count) begin_outline(outline, points[0]);
    call_add_points(&(Points){outline, points, count});
}

void outline_corner(const Outline *outline, int which, float corner[3])
{
    for (int k = 0; k < 3; ++k) corner[k] = (which >> k & 1 ? outline->high : outline->low)[k];
}

static void add_outline(Outline *outline, const Outline *more)
{
    outline_add(outline, more->point, more->any ? OUTLINE_DIRECTIONS : 0);
}

// Moves all points of the outline outwards by `by` (m).
static void grow_outline(Outline *outline, float by)
{
    for (int i = 0; i < OUTLINE_DIRECTIONS && outline->any; ++i) {
        for (int k = 0; k < 3; ++k) outline->point[i][k] += by * outline->direction[k][i];
        outline->reach[i] += by;
    }
    for (int k = 0; k < 3 && outline->any; ++k) outline->low[k] -= by, outline->high[k] += by;
}

// The state of everything that moves at one time.
typedef struct Moment {
    versor rotation;
    vec3 translation, gravity, wind;
} Moment;

static void moment_at(Moment *moment, const Scene *scene, const SceneBody *body, double time)
{
    rigid_track_evaluate(&body->head, time, moment->rotation, moment->translation);
    track_evaluate_or(&scene->gravity, scene->run.gravity, time, moment->gravity);
    track_evaluate_or(&scene->wind, scene->run.wind, time, moment->wind);
}

static void carry(const Moment *moment, const float point[3], float carried[3])
{
    versor rotation = {0};
    vec3 p = {0};
    memcpy(rotation, moment->rotation, sizeof rotation);
    memcpy(p, point, sizeof p);
    glm_quat_rotatev(rotation, p, carried);
    for (int k = 0; k < 3; ++k) carried[k] += moment->translation[k];
}

// Uses every Nth strand, if each is visited `times` times.
static uint32_t strand_stride(const Strands *strands, uint32_t times)
{
    return 1 + (uint32_t)((uint64_t)strands->vertex_count * times / VERTICES);
}

static void add_style(Outline *outline, const Strands *strands)
{
    uint32_t stride = strand_stride(strands, 1), each = stride > 1 ? 1 : strands->strand_count;
    for (uint32_t s = 0; s < strands->strand_count; s += each * stride) {
        uint32_t first = strands->first[s];
        outline_add(outline, (const float(*)[3])strands->position + first,
                    strands->first[s + each] - first);
    }
}

// Adds an estimate of the strand at rest: from the root on, its directions are a mix of the
// direction of `pull` (unit) and the style's.
static void add_rest_strand(Outline *outline, const Strands *strands, uint32_t s,
                            const Moment *moment, const float pull[3], float style)
{
    vec3 x, carried = {0}, next = {0};
    carry(moment, strands->position[strands->first[s]], carried);
    glm_vec3_copy(carried, x);
    for (uint32_t v = strands->first[s] + 1; v < strands->first[s + 1]; ++v) {
        vec3 segment, mixed;
        carry(moment, strands->position[v], next);
        glm_vec3_sub(next, carried, segment);
        glm_vec3_copy(next, carried);
        float length = glm_vec3_norm(segment);
        for (int k = 0; k < 3; ++k) mixed[k] = style * segment[k] + (1 - style) * length * pull[k];
        float norm = glm_vec3_norm(mixed);
        for (int k = 0; k < 3 && norm > 0; ++k) x[k] += mixed[k] * (length / norm);
        outline_add(outline, (const float(*)[3]) & x, 1);
    }
}

static void add_rest(Outline *outline, const Strands *strands, const SectionParams *params,
                     const Moment *moment, uint32_t times)
{
    // With the default variant, a groom at rest on a still head keeps its shape; other variants may
    // not.
    bool rests = times == 1 && params->rest == REST_GROOM && !*params->variant &&
                 (params->style > 0 || section_is_elastic(params));
    vec3 pull;
    for (int k = 0; k < 3; ++k)
        pull[k] = (rests ? 0 : moment->gravity[k]) + params->drag * moment->wind[k];
    float strength = glm_vec3_norm(pull);
    if (!(strength > 0) || params->style >= 1 || strcmp(params->algo, "none") == 0) return;
    glm_vec3_scale(pull, 1 / strength, pull);
    for (uint32_t s = 0; s < strands->strand_count; s += strand_stride(strands, times))
        add_rest_strand(outline, strands, s, moment, pull, params->style);
}

static void add_carried(Outline *outline, const Outline *still, const Moment *moment)
{
    for (int i = 0; i < OUTLINE_DIRECTIONS && still->any; ++i) {
        vec3 carried = {0};
        carry(moment, still->point[i], carried);
        outline_add(outline, (const float(*)[3]) & carried, 1);
    }
}

static float farthest_follower(const Scene *scene, const Strands *strands)
{
    float farthest = 0;
    for (uint32_t i = 0; i < scene->section_count; ++i)
        farthest = fmaxf(farthest, follow_plan_reach(&scene->sections[i].params, &strands[i]));
    return farthest;
}

// How far the mesh has moved the strand's root, in the head's frame.
static void root_moved(const Body *body, uint32_t section, uint32_t s, const float (*position)[3],
                       float moved[3])
{
    const BoundPoint *point = &body->roots[section].points[s];
    for (int k = 0; k < 3; ++k) {
        double now = 0;
        for (int c = 0; c < 3; ++c) now += point->weight[c] * (double)position[point->corner[c]][k];
        moved[k] = (float)(now - point->place[k]);
    }
}

// Adds the body at a time to `shape`, and the style at the roots' positions at that time to
// `style`.
static void outline_body(Outline *style, Outline *shape, const SceneBody *of,
                         const Strands *strands, const float (*position)[3])
{
    const Body *body = of->shape;
    outline_add(shape, position, body->mesh->vertex_count);
    for (uint32_t i = 0; i < of->section_count; ++i)
        for (uint32_t s = 0; s < strands[i].strand_count; s += strand_stride(&strands[i], TIMES)) {
            float moved[3], at[3];
            root_moved(body, i, s, position, moved);
            for (uint32_t v = strands[i].first[s]; v < strands[i].first[s + 1]; ++v) {
                for (int k = 0; k < 3; ++k) at[k] = strands[i].position[v][k] + moved[k];
                outline_add(style, (const float(*)[3]) & at, 1);
            }
        }
}

static void add_body_at(Framing *framing, const SceneBody *body, const Strands *strands,
                        double time, const Moment *moment)
{
    Outline style = {0}, shape = {0};
    float(*position)[3] = malloc(body->shape->mesh->vertex_count * sizeof *position + 1);
    if (!position) return; // then the camera frames the mesh at time 0
    mesh_sequence_evaluate(&body->shape->sequence, time, position);
    outline_body(&style, &shape, body, strands, (const float(*)[3])position);
    add_carried(&framing->hair, &style, moment);
    add_carried(&framing->all, &shape, moment);
    free(position);
}

// `strands`: of the body's sections. `mesh`: NULL: none.
static void add_body(Framing *framing, const Scene *scene, const SceneBody *body,
                     const Strands *strands, const Mesh *mesh)
{
    Outline style = {0}, shape = {0};
    const Section *sections = &scene->sections[body->first];
    for (uint32_t i = 0; i < body->section_count; ++i) add_style(&style, &strands[i]);
    if (mesh) outline_add(&shape, (const float(*)[3])mesh->position, mesh->vertex_count);
    bool moves = !rigid_track_is_still(&body->head) || !track_is_still(&scene->gravity) ||
                 !track_is_still(&scene->wind);
    double duration = schedule_frame_time(&scene->run, scene->run.frames);
    uint32_t times = moves ? TIMES : 1;
    for (uint32_t t = 0; t < times; ++t) {
        Moment moment = {0};
        double time = duration * t / (TIMES - 1);
        moment_at(&moment, scene, body, time);
        add_carried(&framing->hair, &style, &moment);
        add_carried(&framing->all, &shape, &moment);
        if (body->shape) add_body_at(framing, body, strands, time, &moment);
        for (uint32_t i = 0; i < body->section_count; ++i)
            add_rest(&framing->hair, &strands[i], &sections[i].params, &moment, times);
    }
}

static void find_outlines(Framing *framing, const Scene *scene, const Strands *strands,
                          const Mesh *meshes)
{
    for (uint32_t b = 0; b < scene->body_count; ++b) {
        const SceneBody *body = &scene->bodies[b];
        add_body(framing, scene, body, &strands[body->first], meshes ? &meshes[b] : NULL);
    }
    grow_outline(&framing->hair, farthest_follower(scene, strands));
    add_outline(&framing->all, &framing->hair);
}

// The distance from the target that the camera needs to see all of `outline` in a frame enlarged by
// `scale`. tan_x, tan_y are the tangents of half the viewing angles.
static float distance_to_see(const Outline *outline, const Axes *axes, const float target[3],
                             float tan_x, float tan_y, float scale)
{
    float distance = 0;
    for (int i = 0; i < OUTLINE_DIRECTIONS; ++i) {
        vec3 p, right, top, back;
        for (int k = 0; k < 3; ++k) p[k] = outline->point[i][k] - target[k];
        glm_vec3_copy((float *)axes->right, right);
        glm_vec3_copy((float *)axes->top, top);
        glm_vec3_copy((float *)axes->back, back);
        float x = fabsf(glm_vec3_dot(p, right)) / tan_x, y = fabsf(glm_vec3_dot(p, top)) / tan_y;
        distance = fmaxf(distance, glm_vec3_dot(p, back) + scale * fmaxf(x, y));
    }
    return distance;
}

static float narrowest_fov(const Scene *scene)
{
    const RunParams *run = &scene->run;
    if (!track_is_given(&scene->fov)) return glm_rad(run->fov);
    double last = schedule_frame_time(run, run->frames - 1);
    return glm_rad(track_extremes(&scene->fov, run->frames, last).least[0]);
}

// The outline that the automatic camera frames.
static const Outline *outline_shown(const Framing *framing, const Scene *scene)
{
    bool hair_alone = framing->hair.any && scene->run.floor == FLOOR_NONE;
    return hair_alone ? &framing->hair : &framing->all;
}

static void place_eye(Framing *framing, const Scene *scene)
{
    Axes axes = {0};
    axes_find(&axes, scene->run.camera_up);
    float tan_y = tanf(narrowest_fov(scene) / 2), distance = 0;
    float tan_x = tan_y * (float)scene->run.size[0] / (float)scene->run.size[1];
    float turn = fminf(fabsf(scene->run.turntable), 360) * (scene->run.turntable < 0 ? -1 : 1);
    for (int a = 0; a < ANGLES; ++a) {
        Axes turned = axes;
        float angle = glm_rad(turn) * (float)a / (ANGLES - 1);
        glm_vec3_rotate(turned.right, angle, axes.up);
        glm_vec3_rotate(turned.top, angle, axes.up);
        glm_vec3_rotate(turned.back, angle, axes.up);
        float needed = distance_to_see(outline_shown(framing, scene), &turned, framing->target,
                                       tan_x, tan_y, 1 + scene->run.margin);
        distance = fmaxf(distance, needed);
        if (turn == 0) break;
    }
    if (!(distance > 0)) distance = 1;
    for (int k = 0; k < 3; ++k) framing->eye[k] = framing->target[k] + distance * axes.back[k];
}

void outline_frame(Framing *framing, const Scene *scene, const Strands *strands, const Mesh *meshes)
{
    memset(framing, 0, sizeof *framing);
    find_outlines(framing, scene, strands, meshes);
    const Outline *outline = outline_shown(framing, scene);
    for (int k = 0; k < 3; ++k) framing->target[k] = 0.5f * (outline->low[k] + outline->high[k]);
    if (track_is_given(&scene->target))
        track_evaluate(&scene->target, 0, framing->target);
    else if (!scene->run.target.automatic)
        memcpy(framing->target, scene->run.target.value, sizeof framing->target);
    place_eye(framing, scene);
}
