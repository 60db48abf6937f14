// SPDX-License-Identifier: MIT
#include "run/survey.h"
#include "base/clock.h"
#include "base/interrupt.h"
#include "base/progress.h"
#include "run/drawn_bodies.h"
#include "run/frame_source.h"
#include "run/stats.h"
#include "scene/fit.h"
#include "strands/paint.h"

#include <cglm/cglm.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

// A range in the array of all points of a frame: the guides or the followers of a section, or the
// mesh.
typedef struct Group {
    size_t first, count;
    float radius; // m, around each point
} Group;

typedef struct Survey {
    const Scene *scene;
    const Assets *assets;
    GpuTimer timer;
    Simulation simulation;
    FrameSource source;
    DrawnBodies bodies; // empty: they are not framed
    Fit fit;
    Group *groups;
    uint32_t group_count;
    size_t point_count;
    float (*points)[3], (*before)[3], (*first)[3];
    bool any;         // points have been read
    uint64_t changes; // simulation->changes when points were read
} Survey;

bool survey_is_wanted(const Scene *scene)
{
    if (!fit_is_free(scene)) return false; // a caller of the library may set the eye later
    if (scene->run.framing == FRAMING_AUTO) return scene->run.turntable != 0;
    return scene->run.framing != FRAMING_EXPECTED;
}

static void add_group(Survey *survey, size_t count, float radius)
{
    survey->groups[survey->group_count++] = (Group){survey->point_count, count, radius};
    survey->point_count += count;
}

static Result make_room(Survey *survey, Error *error)
{
    const Scene *scene = survey->scene;
    survey->groups = calloc(2 * (size_t)scene->section_count + 1, sizeof *survey->groups);
    for (uint32_t i = 0; survey->groups && i < scene->section_count; ++i) {
        const SimulationSection *section = &survey->simulation.sections[i];
        float radius = paint_radius(&scene->sections[i].params, &survey->assets->strands[i],
                                    section->follow.per_guide);
        add_group(survey, section->hair.particle_count, radius);
        add_group(survey, section->follow.hair.particle_count, radius);
    }
    if (scene->run.framing != FRAMING_HAIR)
        TRY(drawn_bodies_create(&survey->bodies, survey->assets, &survey->simulation, error));
    if (survey->groups && survey->bodies.mesh.vertex_count)
        add_group(survey, survey->bodies.mesh.vertex_count, 0);
    size_t size = survey->point_count * sizeof *survey->points + 1;
    survey->points = malloc(size);
    survey->before = malloc(size);
    survey->first = malloc(size);
    if (survey->groups && survey->points && survey->before && survey->first) return RESULT_OK;
    return error_set(error, RESULT_FAILED, "no memory for %zu points of a frame",
                     survey->point_count);
}

static void carry_mesh(const float (*position)[3], uint32_t vertex_count, const HeadPose *head,
                       float (*points)[3])
{
    versor rotation = {0};
    memcpy(rotation, head->rotation, sizeof rotation);
    for (uint32_t v = 0; v < vertex_count; ++v) {
        vec3 p = {0};
        memcpy(p, position[v], sizeof p);
        glm_quat_rotatev(rotation, p, points[v]);
        for (int k = 0; k < 3; ++k) points[v][k] += head->translation[k];
    }
}

static Result read_points(Survey *survey, Error *error)
{
    Result result = RESULT_OK;
    uint32_t sections = survey->scene->section_count;
    for (uint32_t i = 0; i < sections && result == RESULT_OK; ++i) {
        const SimulationSection *section = &survey->simulation.sections[i];
        const Group *guides = &survey->groups[2 * i], *followers = guides + 1;
        result = hair_read_positions(&section->hair, survey->points + guides->first, error);
        if (result == RESULT_OK && followers->count)
            result = hair_read_positions(&section->follow.hair, survey->points + followers->first,
                                         error);
    }
    if (survey->group_count > 2 * sections) {
        const Mesh *mesh = &survey->bodies.mesh;
        drawn_bodies_move(&survey->bodies);
        carry_mesh((const float(*)[3])mesh->position, mesh->vertex_count,
                   &survey->simulation.bodies[0].head,
                   survey->points + survey->groups[2 * sections].first);
    }
    return result;
}

static SurveyMove move_between(const float (*a)[3], const float (*b)[3], size_t count)
{
    float most = 0;
    double sum = 0;
    for (size_t i = 0; i < count; ++i) {
        float x = a[i][0] - b[i][0], y = a[i][1] - b[i][1], z = a[i][2] - b[i][2];
        float square = x * x + y * y + z * z;
        most = fmaxf(most, square);
        sum += (double)square;
    }
    return (SurveyMove){sqrtf(most), count ? (float)sqrt(sum / (double)count) : 0};
}

// Reads the points if they have moved since the last frame.
static Result follow_points(Survey *survey, SurveyReport *report, Error *error)
{
    if (survey->any && survey->changes == survey->simulation.changes) return RESULT_OK;
    float(*before)[3] = survey->points;
    survey->points = survey->before;
    survey->before = before;
    TRY(read_points(survey, error));
    if (survey->any) {
        SurveyMove step = move_between((const float(*)[3])survey->points,
                                       (const float(*)[3])survey->before, survey->point_count);
        report->step.most = fmaxf(report->step.most, step.most);
        report->step.rms = fmaxf(report->step.rms, step.rms);
    } else {
        memcpy(survey->first, survey->points, survey->point_count * sizeof *survey->points);
    }
    survey->changes = survey->simulation.changes;
    survey->any = true;
    return RESULT_OK;
}

static Result look_at_frame(Survey *survey, SurveyReport *report, int frame, Error *error)
{
    Result result = frame_source_go(&survey->source, frame, true, error);
    THEN(result, follow_points(survey, report, error));
    for (uint32_t i = 0; i < survey->group_count && result == RESULT_OK; ++i) {
        const Group *group = &survey->groups[i];
        fit_add(&survey->fit, frame, (const float(*)[3])survey->points + group->first, group->count,
                group->radius);
    }
    return result;
}

static Result look(Survey *survey, SurveyReport *report, FILE *terminal, Error *error)
{
    Result result = RESULT_OK;
    Progress progress = {0};
    if (terminal) progress_start(&progress, terminal, survey->scene->run.frames, false);
    for (int frame = 0; frame < survey->scene->run.frames && result == RESULT_OK; ++frame) {
        result = interrupt_requested()
                     ? error_set(error, RESULT_INTERRUPTED, "interrupted before the first frame")
                     : look_at_frame(survey, report, frame, error);
        ++report->frames;
        progress_update(&progress, frame + 1);
    }
    progress_clear(&progress);
    if (result == RESULT_OK)
        report->seam = move_between((const float(*)[3])survey->points,
                                    (const float(*)[3])survey->first, survey->point_count);
    return result;
}

static void close_survey(Survey *survey)
{
    fit_destroy(&survey->fit);
    drawn_bodies_destroy(&survey->bodies);
    frame_source_close(&survey->source);
    simulation_destroy(&survey->simulation);
    gpu_timer_destroy(&survey->timer);
    free(survey->groups);
    free(survey->points);
    free(survey->before);
    free(survey->first);
}

Result survey_fit_camera(Framing *framing, SurveyReport *report, const Scene *scene,
                         const Assets *assets, const Gpu *gpu, FILE *terminal, Error *error)
{
    Survey survey = {.scene = scene, .assets = assets};
    *report = (SurveyReport){0};
    double begin = clock_ms();
    gpu_timer_create(&survey.timer, false, gpu->software);
    Result result = simulation_create(&survey.simulation, gpu, &survey.timer, scene,
                                      assets->strands, assets->meshes, error);
    THEN(result, frame_source_look(&survey.source, &survey.simulation, assets->strands,
                                   scene->run.frames - 1, error));
    THEN(result, fit_create(&survey.fit, scene, framing, error));
    THEN(result, make_room(&survey, error));
    THEN(result, look(&survey, report, terminal, error));
    if (result == RESULT_OK) fit_solve(&survey.fit, scene, framing);
    close_survey(&survey);
    report->ms = clock_ms() - begin;
    return result;
}
