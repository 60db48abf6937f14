// SPDX-License-Identifier: MIT
#include "library/library.h"

#include "base/clock.h"
#include "base/quote.h"
#include "scene/effects.h"
#include "scene/scalp_guess.h"
#include "strands/follow_plan.h"

#include <epoxy/gl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// --- Lifetime.

void library_keep_simulation(TractrixSimulation *simulation)
{
    atomic_fetch_add(&simulation->users, 1);
}

static Result close_simulation(void *data, Error *error)
{
    TractrixSimulation *simulation = data;
    (void)error;
    library_end_copies(simulation);
    if (simulation->simulation.scene) simulation_destroy(&simulation->simulation);
    gpu_timer_destroy(&simulation->timer);
    return RESULT_OK;
}

static void forget_places(TractrixSimulation *simulation)
{
    for (uint32_t b = 0; b < SCENE_MAX_BODIES; ++b) {
        free(simulation->next[b].mesh);
        simulation->next[b] = (LibraryPlace){0};
    }
}

void library_drop_simulation(TractrixSimulation *simulation)
{
    Error unused;
    TractrixDevice *device = simulation->device;
    if (atomic_fetch_sub(&simulation->users, 1) > 1) return;
    if (library_on_device(device, close_simulation, simulation, &unused) == RESULT_OK) {
        forget_places(simulation);
        library_unmap(simulation);
        assets_destroy(&simulation->assets);
        scene_destroy(&simulation->scene);
        free(simulation->messages);
        free(simulation);
    }
    library_drop_device(device);
}

void tractrix_simulation_destroy(TractrixSimulation *simulation)
{
    LIBRARY_CALL;
    if (simulation) library_drop_simulation(simulation);
}

// --- Making a simulation.

static Result check(const Scene *scene, Error *error)
{
    TRY(scene_check(scene, error));
    TRY(effects_check(scene, error));
    for (uint32_t i = 0; i < scene->section_count; ++i)
        TRY(solver_check(&scene->sections[i].params, error));
    return RESULT_OK;
}

static void warn(const Scene *scene, const Assets *assets, FILE *messages)
{
    effects_warn(scene, messages);
    for (uint32_t i = 0; i < scene->section_count; ++i) {
        const Section *section = &scene->sections[i];
        const char *caution = solver_caution(&section->params);
        const Quoted name = quote(section->file);
        if (caution)
            fprintf(messages, "%s: algo %s: %s\n", name.text, section->params.algo, caution);
        if (!section->params.hidden && follow_plan_fills(&section->params, &assets->strands[i]))
            fprintf(messages, "%s: followers fill the space between %u strands\n", name.text,
                    assets->strands[i].strand_count);
    }
}

// Loads everything that needs no device.
static Result load(TractrixSimulation *simulation, const TractrixScene *from, FILE *messages,
                   Error *error)
{
    Scene *scene = &simulation->scene;
    TRY(library_copy_scene(scene, from, error));
    scene->run.sdf_cache = false; // write no files to the home folder
    TRY(check(scene, error));
    TRY(assets_load(&simulation->assets, scene, messages, false, error));
    for (uint32_t b = 0; b < scene->body_count; ++b) scene->bodies[b].given_mesh = NULL;
    for (uint32_t i = 0; i < scene->section_count; ++i) scene->sections[i].given = NULL;
    TRY(scalp_guess(scene, &simulation->assets, messages, false, error));
    warn(scene, &simulation->assets, messages);
    return RESULT_OK;
}

// Simulates the warm-up. With a TractrixProgress, the device is waited for now and then, so that
// the share is that of the steps that are done, not of those that are queued.
static Result settle(TractrixSimulation *simulation, Error *error)
{
    const TractrixDevice *device = simulation->device;
    Simulation *settled = &simulation->simulation;
    const double interval_ms = 50, whole = (double)-settled->step;
    double last_ms = clock_ms();
    int wait = 1, steps = 0; // wait: steps from one report to the next
    while (simulation_settle(settled)) {
        if (!device->progress || ++steps < wait) continue;
        glFinish();
        double now_ms = clock_ms(), took_ms = now_ms - last_ms;
        if (!device->progress(device->progress_data, 1 + (double)settled->step / whole))
            return error_set(error, RESULT_INTERRUPTED,
                             "cancelled after %.0f %% of the warm-up (preroll)",
                             100 * (1 + (double)settled->step / whole));
        wait = took_ms < interval_ms / 2 ? 2 * wait : took_ms > interval_ms ? (wait + 1) / 2 : wait;
        last_ms = clock_ms();
        steps = 0;
    }
    return RESULT_OK;
}

static Result open_simulation(void *data, Error *error)
{
    TractrixSimulation *simulation = data;
    const Gpu *gpu = &simulation->device->gpu;
    gpu_timer_create(&simulation->timer, false, gpu->software);
    TRY(simulation_create(&simulation->simulation, gpu, &simulation->timer, &simulation->scene,
                          simulation->assets.strands, simulation->assets.meshes, error));
    TRY(settle(simulation, error));
    simulation_pose(&simulation->simulation);
    return gpu_check("simulating", error);
}

static Result create(TractrixSimulation **simulation, TractrixDevice *device,
                     const TractrixScene *scene, Error *error)
{
    TractrixSimulation *made = *simulation = calloc(1, sizeof *made);
    if (!made) return error_set(error, RESULT_FAILED, "no memory for a simulation");
    library_keep_device(device);
    made->device = device;
    made->users = 1;
    FILE *messages = open_memstream(&made->messages, &made->messages_size);
    if (!messages) return error_set(error, RESULT_FAILED, "no memory for messages");
    Result result = load(made, scene, messages, error);
    if (fclose(messages) != 0)
        THEN(result, error_set(error, RESULT_FAILED, "no memory for messages"));
    made->maps = calloc(2 * (size_t)made->scene.section_count + 1, sizeof *made->maps);
    if (!made->maps) THEN(result, error_set(error, RESULT_FAILED, "no memory for positions"));
    THEN(result, library_on_device(device, open_simulation, made, error));
    return result;
}

TractrixResult tractrix_simulation_create(TractrixSimulation **simulation, TractrixDevice *device,
                                          const TractrixScene *scene, TractrixError *error)
{
    LIBRARY_CALL;
    Error why = {{0}};
    if (!simulation) return library_refuse(error, "simulation: got NULL");
    *simulation = NULL;
    if (!device || !scene) return library_refuse(error, "device or scene: got NULL");
    Result result = create(simulation, device, scene, &why);
    if (result != RESULT_OK && *simulation) {
        library_drop_simulation(*simulation);
        *simulation = NULL;
    }
    return library_end(result, &why, error);
}

const char *tractrix_simulation_messages(const TractrixSimulation *simulation)
{
    LIBRARY_CALL;
    return simulation && simulation->messages ? simulation->messages : "";
}

double tractrix_simulation_time(const TractrixSimulation *simulation)
{
    LIBRARY_CALL;
    return simulation ? simulation->simulation.time : 0;
}

// --- Stepping.

// A section whose parameters change over time has them evaluated in `now`.
static Result set_now(TractrixSimulation *simulation, int section, const ParamInfo *info,
                      const char *text, Error *error)
{
    for (uint32_t i = 0; info->scope == SCOPE_SECTION && i < simulation->scene.section_count; ++i)
        if (section < 0 || (uint32_t)section == i)
            TRY(params_parse(info, &simulation->simulation.sections[i].now, text, error));
    return RESULT_OK;
}

static Result set(TractrixSimulation *simulation, int section, const char *name, const char *text,
                  Error *error)
{
    const ParamInfo *info = library_parameter(name);
    if (!info) return library_refuse_name(name, error);
    if (!library_is_live(info))
        return error_set(error, RESULT_USAGE,
                         "%s: cannot change during a simulation: expected a live parameter, such "
                         "as wind or color (tractrix_parameter: live)",
                         name);
    int count = (int)simulation->scene.section_count;
    if (section < -1 || section >= (info->scope == SCOPE_SECTION ? count : 0))
        return error_set(error, RESULT_USAGE, "section: got %d for %s, expected -1%s", section,
                         info->name, info->scope == SCOPE_SECTION ? " or a section" : "");
    Result result = scene_set(&simulation->scene, section, info, text, error);
    THEN(result, set_now(simulation, section, info, text, error));
    if (result != RESULT_OK) return error_prefix(error, result, "%s: ", info->name);
    simulation->aims += info->group == GROUP_CAMERA;
    simulation->looks += library_is_look(info);
    simulation->exposures += strcmp(info->name, "exposure") == 0;
    return RESULT_OK;
}

TractrixResult tractrix_simulation_set(TractrixSimulation *simulation, const char *name,
                                       const char *text, TractrixError *error)
{
    LIBRARY_CALL;
    Error why = {{0}};
    if (!simulation || !name || !text)
        return library_refuse(error, "simulation, name or text: got NULL");
    return library_end(set(simulation, -1, name, text, &why), &why, error);
}

TractrixResult tractrix_simulation_set_section(TractrixSimulation *simulation, int section,
                                               const char *name, const char *text,
                                               TractrixError *error)
{
    LIBRARY_CALL;
    Error why = {{0}};
    if (!simulation || !name || !text)
        return library_refuse(error, "simulation, name or text: got NULL");
    return library_end(set(simulation, section, name, text, &why), &why, error);
}

// Moves a body to where the caller wants it at the time `after`. If the caller says nothing, it
// moves as the scene says, or stays.
static Result place(TractrixSimulation *simulation, uint32_t b, double before, double after,
                    Error *error)
{
    LibraryPlace *next = &simulation->next[b];
    simulation->is_driven[b] |= next->posed || next->mesh;
    MovingBody *moved = &simulation->simulation.bodies[b];
    if (next->posed) {
        TRY(moving_body_expect_motion(moved, &simulation->device->gpu, error));
        driven_head_move(&simulation->driven[b], &simulation->scene.bodies[b], &next->head, before,
                         after);
    }
    if (next->mesh) body_drive(&simulation->assets.bodies[b], next->mesh, before, after);
    return RESULT_OK;
}

static Result advance(void *data, Error *error)
{
    TractrixSimulation *simulation = data;
    Simulation *moved = &simulation->simulation;
    double before = moved->time,
           after = schedule_frame_time(&simulation->scene.run, moved->frame + 1.0);
    Result result = RESULT_OK;
    for (uint32_t b = 0; b < simulation->scene.body_count; ++b)
        THEN(result, place(simulation, b, before, after, error));
    forget_places(simulation);
    TRY(result);
    simulation_advance(moved);
    simulation_pose(moved);
    return gpu_check("simulating", error);
}

static Result check_body(const TractrixSimulation *simulation, uint32_t body, Error *error)
{
    if (body < simulation->scene.body_count) return RESULT_OK;
    return error_set(error, RESULT_USAGE, "body: got %u, expected 0 to %u", body,
                     simulation->scene.body_count - 1);
}

// Calls without a body are for scenes that have one.
static Result check_only(const TractrixSimulation *simulation, const char *what,
                         const char *instead, Error *error)
{
    if (simulation->scene.body_count == 1) return RESULT_OK;
    return error_set(error, RESULT_USAGE,
                     "%s: the scene has %u bodies: expected %s for each of "
                     "them",
                     what, simulation->scene.body_count, instead);
}

// Checks that a frame ends with a step and that time goes on: positions between steps would need
// the next pose.
static Result check_drive(const TractrixSimulation *simulation, Error *error)
{
    double steps = simulation->simulation.schedule.steps_per_frame;
    if (steps > 0 && steps == floor(steps)) return RESULT_OK;
    return error_set(error, RESULT_USAGE,
                     "a frame has %g steps (fps, speed, sim_rate, substeps): expected a whole "
                     "number of steps, because the caller moves the head",
                     steps);
}

static Result check_pose(const TractrixSimulation *simulation, uint32_t body,
                         const TractrixPose *head, Error *error)
{
    const double *q = head->rotation, *t = head->translation;
    double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    TRY(check_body(simulation, body, error));
    TRY(check_drive(simulation, error));
    if (simulation->scene.bodies[body].shape)
        return error_set(
            error, RESULT_USAGE,
            "head: the mesh deforms, so a pose cannot move it: expected its vertices, or no pose");
    if (!(fabs(length - 1) < 1e-3))
        return error_set(error, RESULT_USAGE, "head.rotation: has length %g, expected 1", length);
    for (int k = 0; k < 3; ++k)
        if (!(fabs(t[k]) <= RIGID_TRACK_MAX))
            return error_set(error, RESULT_USAGE, "head.translation: got %g, expected -%g to %g m",
                             t[k], RIGID_TRACK_MAX, RIGID_TRACK_MAX);
    return RESULT_OK;
}

static Result place_head(TractrixSimulation *simulation, uint32_t body, const TractrixPose *head,
                         Error *error)
{
    LibraryPlace *next = &simulation->next[body];
    TRY(check_pose(simulation, body, head, error));
    next->posed = true;
    memcpy(next->head.rotation, head->rotation, sizeof next->head.rotation);
    memcpy(next->head.translation, head->translation, sizeof next->head.translation);
    return RESULT_OK;
}

TractrixResult tractrix_simulation_place_body(TractrixSimulation *simulation, uint32_t body,
                                              const TractrixPose *head, TractrixError *error)
{
    LIBRARY_CALL;
    Error why = {{0}};
    if (!simulation || !head) return library_refuse(error, "simulation or head: got NULL");
    return library_end(place_head(simulation, body, head, &why), &why, error);
}

TractrixResult tractrix_simulation_advance(TractrixSimulation *simulation, const TractrixPose *head,
                                           TractrixError *error)
{
    LIBRARY_CALL;
    Error why = {{0}};
    Result result = RESULT_OK;
    if (!simulation) return library_refuse(error, "simulation: got NULL");
    if (head) {
        result = check_only(simulation, "head", "NULL, and tractrix_simulation_place_body", &why);
        THEN(result, place_head(simulation, 0, head, &why));
    }
    THEN(result, library_on_device(simulation->device, advance, simulation, &why));
    return library_end(result, &why, error);
}

static Result check_mesh(const TractrixSimulation *simulation, uint32_t body, const float *position,
                         uint32_t vertex_count, Error *error)
{
    TRY(check_body(simulation, body, error));
    TRY(check_drive(simulation, error));
    if (!simulation->assets.bodies[body].anchors.points)
        return error_set(error, RESULT_USAGE,
                         "position: the caller cannot move this mesh: expected a mesh from an "
                         "array with TractrixMesh.deforms");
    if (vertex_count != simulation->assets.meshes[body].vertex_count)
        return error_set(error, RESULT_USAGE, "vertex_count: got %u, expected the mesh's %u",
                         vertex_count, simulation->assets.meshes[body].vertex_count);
    for (size_t i = 0; i < 3 * (size_t)vertex_count; ++i)
        if (!(fabsf(position[i]) <= (float)RIGID_TRACK_MAX))
            return error_set(
                error, RESULT_BAD_INPUT,
                "position: a coordinate of vertex %zu is NaN, infinite or beyond 1000 km", i / 3);
    return RESULT_OK;
}

static Result place_mesh(TractrixSimulation *simulation, uint32_t body, const float *position,
                         uint32_t vertex_count, Error *error)
{
    TRY(check_mesh(simulation, body, position, vertex_count, error));
    LibraryPlace *next = &simulation->next[body];
    size_t size = vertex_count * sizeof *next->mesh;
    if (!next->mesh) next->mesh = malloc(size);
    if (!next->mesh) return error_set(error, RESULT_FAILED, "no memory for a mesh's vertices");
    memcpy(next->mesh, position, size);
    return RESULT_OK;
}

TractrixResult tractrix_simulation_place_body_mesh(TractrixSimulation *simulation, uint32_t body,
                                                   const float *position, uint32_t vertex_count,
                                                   TractrixError *error)
{
    LIBRARY_CALL;
    Error why = {{0}};
    if (!simulation || !position) return library_refuse(error, "simulation or position: got NULL");
    return library_end(place_mesh(simulation, body, position, vertex_count, &why), &why, error);
}

TractrixResult tractrix_simulation_advance_mesh(TractrixSimulation *simulation,
                                                const float *position, uint32_t vertex_count,
                                                TractrixError *error)
{
    LIBRARY_CALL;
    Error why = {{0}};
    if (!simulation || !position) return library_refuse(error, "simulation or position: got NULL");
    Result result = check_only(simulation, "position", "tractrix_simulation_place_body_mesh", &why);
    THEN(result, place_mesh(simulation, 0, position, vertex_count, &why));
    THEN(result, library_on_device(simulation->device, advance, simulation, &why));
    return library_end(result, &why, error);
}
