// SPDX-License-Identifier: MIT
#include "library/library.h"

#include "base/quote.h"
#include "scene/effects.h"
#include "scene/scalp_guess.h"
#include "strands/follow_plan.h"

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

void library_drop_simulation(TractrixSimulation *simulation)
{
    Error unused;
    TractrixDevice *device = simulation->device;
    if (atomic_fetch_sub(&simulation->users, 1) > 1) return;
    if (library_on_device(device, close_simulation, simulation, &unused) == RESULT_OK) {
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
    scene->bodies[0].given_mesh = NULL;
    for (uint32_t i = 0; i < scene->section_count; ++i) scene->sections[i].given = NULL;
    TRY(scalp_guess(scene, &simulation->assets, messages, false, error));
    warn(scene, &simulation->assets, messages);
    return RESULT_OK;
}

static Result open_simulation(void *data, Error *error)
{
    TractrixSimulation *simulation = data;
    const Gpu *gpu = &simulation->device->gpu;
    gpu_timer_create(&simulation->timer, false, gpu->software);
    TRY(simulation_create(&simulation->simulation, gpu, &simulation->timer, &simulation->scene,
                          simulation->assets.strands, simulation->assets.meshes, error));
    while (simulation_settle(&simulation->simulation)) continue;
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
    return simulation->messages ? simulation->messages : "";
}

double tractrix_simulation_time(const TractrixSimulation *simulation)
{
    return simulation->simulation.time;
}

// --- Stepping.

static Result set(TractrixSimulation *simulation, const char *name, const char *text, Error *error)
{
    const ParamInfo *info = library_parameter(name);
    if (!info || !library_is_live(info))
        return error_set(error, RESULT_USAGE,
                         "%s: expected a live parameter (tractrix_parameter: live)", name);
    Result result = scene_set(&simulation->scene, -1, info, text, error);
    if (result != RESULT_OK) return error_prefix(error, result, "%s: ", info->name);
    simulation->aims += info->group == GROUP_CAMERA;
    return RESULT_OK;
}

TractrixResult tractrix_simulation_set(TractrixSimulation *simulation, const char *name,
                                       const char *text, TractrixError *error)
{
    Error why = {{0}};
    if (!simulation || !name || !text)
        return library_refuse(error, "simulation, name or text: got NULL");
    return library_end(set(simulation, name, text, &why), &why, error);
}

// A frame for which the host gives the pose of the head or the mesh. If both are NULL, they move as
// the scene says, or stay.
typedef struct Frame {
    TractrixSimulation *simulation;
    const TractrixPose *head;
    float (*mesh)[3]; // in the world; modified
} Frame;

static Result advance(void *data, Error *error)
{
    Frame *frame = data;
    TractrixSimulation *simulation = frame->simulation;
    Simulation *moved = &simulation->simulation;
    double before = moved->time,
           after = schedule_frame_time(&simulation->scene.run, moved->frame + 1.0);
    if (frame->head) {
        RigidMotion to;
        memcpy(to.rotation, frame->head->rotation, sizeof to.rotation);
        memcpy(to.translation, frame->head->translation, sizeof to.translation);
        TRY(moving_body_expect_motion(moved->bodies, &simulation->device->gpu, error));
        driven_head_move(&simulation->driven, simulation->scene.bodies, &to, before, after);
    }
    if (frame->mesh) body_drive(simulation->assets.bodies, frame->mesh, before, after);
    simulation_advance(moved);
    simulation_pose(moved);
    return gpu_check("simulating", error);
}

// Checks that a frame ends with a step and that time goes on: positions between steps would need
// the next pose.
static Result check_drive(const TractrixSimulation *simulation, Error *error)
{
    double steps = simulation->simulation.schedule.steps_per_frame;
    if (steps > 0 && steps == floor(steps)) return RESULT_OK;
    return error_set(error, RESULT_USAGE,
                     "a frame is %g steps (fps, speed, sim_rate, substeps): expected a whole "
                     "number of them where the caller moves the head",
                     steps);
}

static bool is_driven(const TractrixSimulation *simulation)
{
    return simulation->assets.bodies[0].anchors.points;
}

static Result check_pose(const TractrixSimulation *simulation, const TractrixPose *head,
                         Error *error)
{
    const double *q = head->rotation, *t = head->translation;
    double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    TRY(check_drive(simulation, error));
    if (simulation->scene.body_count > 1)
        return error_set(
            error, RESULT_USAGE,
            "head: the scene has %u bodies, whose motion the scene gives: expected NULL",
            simulation->scene.body_count);
    if (simulation->scene.bodies[0].shape)
        return error_set(error, RESULT_USAGE,
                         "head: the mesh deforms: expected NULL, or tractrix_simulation_"
                         "advance_mesh");
    if (!(fabs(length - 1) < 1e-3))
        return error_set(error, RESULT_USAGE, "head.rotation: has length %g, expected 1", length);
    for (int k = 0; k < 3; ++k)
        if (!(fabs(t[k]) <= RIGID_TRACK_MAX))
            return error_set(error, RESULT_USAGE, "head.translation: got %g, expected -%g to %g m",
                             t[k], RIGID_TRACK_MAX, RIGID_TRACK_MAX);
    return RESULT_OK;
}

TractrixResult tractrix_simulation_advance(TractrixSimulation *simulation, const TractrixPose *head,
                                           TractrixError *error)
{
    Error why = {{0}};
    if (!simulation) return library_refuse(error, "simulation: got NULL");
    Result result = head ? check_pose(simulation, head, &why) : RESULT_OK;
    Frame frame = {.simulation = simulation, .head = head};
    THEN(result, library_on_device(simulation->device, advance, &frame, &why));
    return library_end(result, &why, error);
}

static Result check_mesh(const TractrixSimulation *simulation, const float *position,
                         uint32_t vertex_count, Error *error)
{
    const Mesh *mesh = simulation->assets.meshes;
    TRY(check_drive(simulation, error));
    if (!is_driven(simulation))
        return error_set(error, RESULT_USAGE,
                         "position: expected a mesh from an array that deforms "
                         "(TractrixMesh.deforms)");
    if (vertex_count != mesh->vertex_count)
        return error_set(error, RESULT_USAGE, "vertex_count: got %u, expected the mesh's %u",
                         vertex_count, mesh->vertex_count);
    for (size_t i = 0; i < 3 * (size_t)vertex_count; ++i)
        if (!(fabsf(position[i]) <= (float)RIGID_TRACK_MAX))
            return error_set(error, RESULT_BAD_INPUT,
                             "position: vertex %zu is not finite or beyond 1000 km", i / 3);
    return RESULT_OK;
}

TractrixResult tractrix_simulation_advance_mesh(TractrixSimulation *simulation,
                                                const float *position, uint32_t vertex_count,
                                                TractrixError *error)
{
    Error why = {{0}};
    Frame frame = {.simulation = simulation};
    if (!simulation || !position) return library_refuse(error, "simulation or position: got NULL");
    Result result = check_mesh(simulation, position, vertex_count, &why);
    if (result == RESULT_OK) {
        size_t size = vertex_count * sizeof *frame.mesh;
        frame.mesh = malloc(size);
        if (frame.mesh)
            memcpy(frame.mesh, position, size);
        else
            result = error_set(&why, RESULT_FAILED, "no memory for a mesh's vertices");
    }
    THEN(result, library_on_device(simulation->device, advance, &frame, &why));
    free(frame.mesh);
    return library_end(result, &why, error);
}
