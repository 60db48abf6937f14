// SPDX-License-Identifier: MIT
#include "sim/volume.h"

#include "glsl/kernel/grain.h"

#include <cglm/cglm.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

// FINENESS: cells along the groom's longest side, per cubic root of the number of particles. ROOM:
// margin around the groom, in lengths of the longest strand. GRAIN_CELLS: length of a grain in
// cells. MOST_GRAIN: most particles of a grain.
static const double FINENESS = 1, ROOM = 0.3, GRAIN_CELLS = 3;
enum { LEAST_SIDE = 8, MOST_SIDE = 32, MOST_CELLS = 60000, MOST_GRAIN = 4, PUSHES = 2 };
// At --volume 1. FRICTION: the share of a velocity that friction removes within a dense cell in
// FRICTION_S. APART: the speed, in cells per second, at which hair leaves a dense cell.
static const double FRICTION = 0.4, FRICTION_S = 1.0 / 60, APART = 15;

// --- The grid.

static uint32_t cells_along(const Hair *hair, int axis, double room, double spacing)
{
    double size = (double)hair->high[axis] - (double)hair->low[axis];
    return (uint32_t)ceil((size + 2 * room) / spacing) + 3;
}

// Chooses the grid: as fine as the number of particles allows, with at most MOST_CELLS cells.
static void place_grid(Volume *volume)
{
    const Hair *hair = volume->hair;
    double longest = 0, room = ROOM * (double)hair->longest;
    for (int k = 0; k < 3; ++k)
        longest = fmax(longest, (double)hair->high[k] - (double)hair->low[k]);
    double side = FINENESS * cbrt((double)hair->particle_count);
    double spacing = longest / fmin(fmax(side, LEAST_SIDE), MOST_SIDE);
    uint32_t *size = volume->step.size;
    do {
        volume->cell_count = 1;
        for (int k = 0; k < 3; ++k) {
            size[k] = cells_along(hair, k, room, spacing);
            volume->cell_count *= size[k];
        }
        spacing *= 1.05;
    } while (volume->cell_count > MOST_CELLS);
    spacing /= 1.05;
    volume->step.cell_count = volume->cell_count;
    volume->step.spacing = (float)spacing;
    for (int k = 0; k < 3; ++k) {
        volume->middle[k] = (hair->low[k] + hair->high[k]) / 2;
        volume->low[k] = volume->middle[k] - (float)(spacing * (double)size[k] / 2);
    }
    double links = (double)hair->segment_count / hair->strand_count;
    double grain = GRAIN_CELLS * spacing * links / (double)hair->longest;
    volume->grain = (uint32_t)fmin(fmax(grain, 1), MOST_GRAIN);
}

// Sets the rows of the matrix from the world to cells, with the head at `head`.
static void place_axes(VolumeParams *params, const float low[3], const HeadPose *head)
{
    for (int k = 0; k < 3; ++k) {
        vec3 axis = {0};
        axis[k] = 1 / params->spacing;
        glm_quat_rotatev((float *)head->rotation, axis, axis);
        memcpy(params->axis[k], axis, sizeof axis);
        params->axis[k][3] =
            -glm_vec3_dot(axis, (float *)head->translation) - low[k] / params->spacing;
    }
}

// --- The density at rest, by the same rules as in the shaders.

typedef float Float4[4];

// The cell of the grain that begins with particle j; -1 if it is outside.
static int grain_cell(const Volume *volume, const HairBatch *batch, uint32_t s, uint32_t j,
                      const Float4 *position)
{
    int middle = grain_middle((int)j, (int)volume->grain, (int)batch->vertex_count - 1);
    const float *x = position[hair_address(batch, s, (uint32_t)middle)];
    const int size[3] = {(int)volume->step.size[0], (int)volume->step.size[1],
                         (int)volume->step.size[2]};
    float at[3];
    for (int k = 0; k < 3; ++k) at[k] = volume->step.axis[k][k] * x[k] + volume->step.axis[k][3];
    return grain_cell_at(at[0], at[1], at[2], size[0], size[1], size[2]);
}

// Vertices, from the root, that the head carries.
static uint32_t carried(const Volume *volume, const HairBatch *batch)
{
    uint32_t all = solver_carried(volume->solver);
    return batch->held > all ? batch->held : all;
}

// Visits all grains. Called once with `count` to count the particles of each cell, and once with
// `rest` to store each particle's cell value `own`.
static Result for_grains(Volume *volume, uint32_t *count, const uint32_t *own, uint32_t *rest,
                         uint32_t i, Error *error)
{
    const HairBatch *batch = &volume->hair->batches[i];
    Float4 *position = gpu_buffer_read(&batch->position);
    if (!position) return error_set(error, RESULT_FAILED, "no memory for a section's volume");
    uint32_t n = batch->vertex_count, grain = volume->grain;
    for (uint32_t s = 0; s < batch->strand_count; ++s)
        for (uint32_t j = carried(volume, batch); j < n; j += grain) {
            int cell = grain_cell(volume, batch, s, j, (const Float4 *)position);
            for (uint32_t k = j; cell >= 0 && k < j + grain && k < n; ++k) {
                if (count) ++count[cell];
                if (rest && own[cell] < VOLUME_MOST_REST)
                    rest[hair_address(batch, s, k)] = own[cell];
                else if (rest)
                    rest[hair_address(batch, s, k)] = VOLUME_MOST_REST;
            }
        }
    free(position);
    return RESULT_OK;
}

// Cells at the edge stay empty.
static void smooth(const Volume *volume, const uint32_t *count, uint32_t *own)
{
    uint32_t row = volume->step.size[0], slice = row * volume->step.size[1];
#define COUNT(cell) count[cell]
    for (uint32_t c = slice; c < volume->cell_count - slice; ++c)
        own[c] = GRAIN_SMOOTH(COUNT, c, row, slice);
#undef COUNT
}

static Result upload_rest(Volume *volume, uint32_t i, const uint32_t *own, const GpuLimits *limits,
                          Error *error)
{
    int64_t size = volume->hair->batches[i].rest.size / 4;
    uint32_t *rest = calloc((size_t)size + 1, 1);
    Result result = RESULT_OK;
    if (!rest) result = error_set(error, RESULT_FAILED, "no memory for a section's volume");
    THEN(result, for_grains(volume, NULL, own, rest, i, error));
    THEN(result, gpu_buffer_create(&volume->rest[i], limits, "densities at rest", size, rest,
                                   GL_R32UI, error));
    free(rest);
    return result;
}

static Result measure_rest(Volume *volume, const GpuLimits *limits, Error *error)
{
    const HeadPose origin = {.rotation = {0, 0, 0, 1}};
    uint32_t *count = calloc(2 * (size_t)volume->cell_count, sizeof *count);
    if (!count) return error_set(error, RESULT_FAILED, "no memory for a section's volume");
    uint32_t *own = count + volume->cell_count;
    Result result = RESULT_OK;
    place_axes(&volume->step, volume->low, &origin);
    for (uint32_t i = 0; i < volume->hair->batch_count; ++i)
        THEN(result, for_grains(volume, count, NULL, NULL, i, error));
    smooth(volume, count, own);
    for (uint32_t i = 0; i < volume->hair->batch_count; ++i)
        THEN(result, upload_rest(volume, i, own, limits, error));
    THEN(result, gpu_buffer_create(&volume->own, limits, "a groom's density",
                                   4 * (int64_t)volume->cell_count, own, GL_R32UI, error));
    free(count);
    return result;
}

// --- Creation and destruction.

static Result create_passes(Volume *volume, const Gpu *gpu, Error *error)
{
    const ShaderDefine strands[] = {
        {"SEGMENTS", volume->segments}, {"GRAIN", (int)volume->grain}, {0}};
    const ShaderDefine first[] = {{"LAST", 0}, {0}}, last[] = {{"LAST", 1}, {0}};
    TRY(step_pass_create(&volume->splat, gpu, "sim/volume_splat.comp", strands, error));
    TRY(step_pass_create(&volume->cells, gpu, "sim/volume_cells.comp", NULL, error));
    TRY(step_pass_create(&volume->push[0], gpu, "sim/volume_push.comp", first, error));
    TRY(step_pass_create(&volume->push[1], gpu, "sim/volume_push.comp", last, error));
    return step_pass_create(&volume->apply, gpu, "sim/volume_apply.comp", strands, error);
}

static Result create_cells(Volume *volume, const GpuLimits *limits, Error *error)
{
    int64_t count = volume->cell_count;
    TRY(gpu_buffer_create(&volume->sums, limits, "sums of cells", count * VOLUME_SUMS * 4, NULL,
                          GL_R32I, error));
    for (int i = 0; i < 3; ++i)
        TRY(gpu_buffer_create(&volume->velocities[i], limits, "velocities of cells", count * 16,
                              NULL, GL_RGBA32F, error));
    TRY(gpu_buffer_create(&volume->faces, limits, "faces of cells", count * 8, NULL, GL_RG32F,
                          error));
    TRY(gpu_buffer_create(&volume->changes, limits, "changes of cells", count * 16, NULL,
                          GL_RGBA32F, error));
    return gpu_buffer_create(&volume->dense, limits, "whether hair is dense", 4, NULL, 0, error);
}

Result volume_create(Volume *volume, const Gpu *gpu, GpuTimer *timer, const Hair *hair,
                     const Solver *solver, const SectionParams *params, Error *error)
{
    *volume = (Volume){0};
    if (params->volume == 0 || solver_is_static(solver->type) || !hair->batch_count)
        return RESULT_OK;
    SolverBuffer buffers[SOLVER_MAX_BUFFERS];
    solver_buffers(solver, 0, buffers);
    *volume = (Volume){.hair = hair,
                       .solver = solver,
                       .timer = timer,
                       .strength = params->volume,
                       .segments = buffers[1].kind == SOLVER_TIPS,
                       .rest = calloc(hair->batch_count + 1, sizeof *volume->rest)};
    place_grid(volume);
    Result result = RESULT_OK;
    if (!volume->rest) result = error_set(error, RESULT_FAILED, "no memory for a section's volume");
    THEN(result, measure_rest(volume, &gpu->limits, error));
    THEN(result, create_cells(volume, &gpu->limits, error));
    THEN(result, create_passes(volume, gpu, error));
    if (result != RESULT_OK) volume_destroy(volume);
    return result;
}

void volume_destroy(Volume *volume)
{
    for (uint32_t i = 0; volume->rest && i < volume->hair->batch_count; ++i)
        gpu_buffer_destroy(&volume->rest[i]);
    free(volume->rest);
    step_pass_destroy(&volume->splat);
    step_pass_destroy(&volume->cells);
    step_pass_destroy(&volume->push[0]);
    step_pass_destroy(&volume->push[1]);
    step_pass_destroy(&volume->apply);
    gpu_buffer_destroy(&volume->sums);
    gpu_buffer_destroy(&volume->own);
    for (int i = 0; i < 3; ++i) gpu_buffer_destroy(&volume->velocities[i]);
    gpu_buffer_destroy(&volume->faces);
    gpu_buffer_destroy(&volume->changes);
    gpu_buffer_destroy(&volume->dense);
    *volume = (Volume){0};
}

// --- A step.

static void barrier(void)
{
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
}

static void run_cells(Volume *volume, StepPass *pass)
{
    step_pass_run(pass, &volume->step, sizeof volume->step,
                  volume->cell_count / VOLUME_CELLS_A_LANE + (uint32_t)pass->limits->sizes.strands);
    barrier();
}

static void begin(Volume *volume, const SolverStep *step)
{
    double share = fmin(FRICTION * (double)volume->strength, 1);
    volume->step.strength = volume->strength;
    volume->step.apart = volume->strength * (float)APART * volume->step.spacing;
    volume->step.friction = (float)(1 - pow(1 - share, step->dt / FRICTION_S));
    place_axes(&volume->step, volume->low, &step->head);
    vec3 now, before;
    glm_quat_rotatev((float *)step->head.rotation, volume->middle, now);
    glm_quat_rotatev((float *)step->head_old.rotation, volume->middle, before);
    for (int k = 0; k < 3; ++k)
        volume->step.head_velocity[k] =
            (now[k] + step->head.translation[k] - before[k] - step->head_old.translation[k]) /
            (float)step->dt;
}

// Runs a pass over the strands of each batch.
static void run_strands(Volume *volume, StepPass *pass)
{
    for (uint32_t i = 0; i < volume->hair->batch_count; ++i) {
        const HairBatch *batch = &volume->hair->batches[i];
        SolverBuffer buffers[SOLVER_MAX_BUFFERS];
        solver_buffers(volume->solver, i, buffers);
        gpu_buffer_bind_texture(&batch->position, BIND_POSITION);
        gpu_buffer_bind_texture(&volume->rest[i], BIND_VOLUME_REST);
        if (volume->segments) {
            gpu_buffer_bind_storage(buffers[1].buffer, BIND_TIPS);
        } else {
            gpu_buffer_bind_texture(buffers[1].buffer, BIND_STATE);
            gpu_buffer_bind_storage(buffers[1].buffer, BIND_STATE_OUT);
        }
        volume->step.vertex_count = batch->vertex_count;
        volume->step.carried = carried(volume, batch);
        volume->step.strand_count = batch->strand_count;
        step_pass_run(pass, &volume->step, sizeof volume->step, batch->strand_count);
    }
    barrier();
}

static void push_cells(Volume *volume)
{
    for (int i = 0; i < PUSHES; ++i) {
        bool last = i + 1 == PUSHES;
        gpu_buffer_bind_texture(&volume->velocities[0], BIND_VOLUME_CELLS);
        gpu_buffer_bind_texture(&volume->velocities[i == 0 ? 0 : 1 + i % 2], BIND_VOLUME_CELLS_2);
        gpu_buffer_bind_storage(&volume->velocities[2 - i % 2], BIND_VOLUME_CELLS_OUT);
        gpu_buffer_bind_texture(&volume->faces, BIND_VOLUME_FACES);
        gpu_buffer_bind_storage(&volume->changes, BIND_VOLUME_CHANGES_OUT);
        run_cells(volume, &volume->push[last]);
    }
}

void volume_step(Volume *volume, const SolverStep *step)
{
    if (!volume->hair) return;
    if (volume->segments) solver_pose(volume->solver, &step->head);
    gpu_timer_begin(volume->timer, "volume");
    begin(volume, step);
    gpu_buffer_clear(&volume->sums, 0);
    gpu_buffer_clear(&volume->dense, 0);
    gpu_buffer_bind_storage(&volume->sums, BIND_VOLUME_SUMS_OUT);
    gpu_buffer_bind_storage(&volume->dense, BIND_VOLUME_DENSE_OUT);
    run_strands(volume, &volume->splat);
    gpu_buffer_bind_texture(&volume->sums, BIND_VOLUME_SUMS);
    gpu_buffer_bind_texture(&volume->own, BIND_VOLUME_OWN);
    gpu_buffer_bind_storage(&volume->velocities[0], BIND_VOLUME_CELLS_OUT);
    gpu_buffer_bind_storage(&volume->faces, BIND_VOLUME_FACES_OUT);
    run_cells(volume, &volume->cells);
    push_cells(volume);
    gpu_buffer_bind_texture(&volume->changes, BIND_VOLUME_CHANGES);
    run_strands(volume, &volume->apply);
    gpu_timer_end(volume->timer);
}
