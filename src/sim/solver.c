// SPDX-License-Identifier: MIT
#include "sim/solver.h"
#include "base/suggest.h"
#include "gpu/gpu_uniforms.h"
#include "scene/scene.h"
#include "sim/along.h"
#include "sim/collision.h"
#include "sim/pose.h"
#include "sim/recipe.h"

#include <cglm/cglm.h>

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#define POINT_TO_SOLVER(name) &SOLVER_##name,
const SolverType *const SOLVER_TYPES[] = {SOLVERS(POINT_TO_SOLVER) NULL};

enum { MAX_WORDS = 32 };

static const SolverType *find_type(const char *name)
{
    for (const SolverType *const *type = SOLVER_TYPES; *type; ++type)
        if (strcmp((*type)->name, name) == 0) return *type;
    return NULL;
}

// The type named by parameters that passed solver_check.
static const SolverType *known_type(const SectionParams *params)
{
    const SolverType *type = find_type(params->algo);
    assert(type);
    return type;
}

static Result refuse_type(const char *name, Error *error)
{
    const char *names[MAX_WORDS];
    size_t count = 0;
    for (const SolverType *const *type = SOLVER_TYPES; *type && count < MAX_WORDS; ++type)
        names[count++] = (*type)->name;
    char words[200];
    return error_set(error, RESULT_USAGE, "--algo: no solver '%s': %s", name,
                     suggest_words(words, sizeof words, name, names, count));
}

static Result check_variant(const SolverType *type, const char *variant, Error *error)
{
    if (!*variant) return RESULT_OK;
    size_t count = 0;
    for (; type->variants[count]; ++count)
        if (strcmp(type->variants[count], variant) == 0) return RESULT_OK;
    if (count == 0)
        return error_set(error, RESULT_USAGE,
                         "--variant: got '%s', expected none, since --algo %s has no variants",
                         variant, type->name);
    char words[200];
    return error_set(error, RESULT_USAGE, "--variant: --algo %s has no variant '%s': %s",
                     type->name, variant,
                     suggest_words(words, sizeof words, variant, type->variants, count));
}

Result solver_check(const SectionParams *params, Error *error)
{
    const SolverType *type = find_type(params->algo);
    return type ? check_variant(type, params->variant, error) : refuse_type(params->algo, error);
}

const char *solver_caution(const SectionParams *params)
{
    const SolverType *type = known_type(params);
    return type->caution ? type->caution(params) : NULL;
}

float solver_most_stability(const SectionParams *params)
{
    return known_type(params)->most_stability;
}

// The index of the variant that the parameters name; 0, the default, for "".
static int find_variant(const SolverType *type, const char *variant)
{
    for (int i = 0; i < SOLVER_MAX_VARIANTS && type->variants[i]; ++i)
        if (strcmp(type->variants[i], variant) == 0) return i;
    return 0;
}

static bool is_published(const SectionParams *params)
{
    const char *published = known_type(params)->published;
    return published && strcmp(published, params->variant) == 0;
}

bool solver_keeps_groom(const SectionParams *params)
{
    bool holds = params->style > 0 || section_is_elastic(params);
    return params->rest == REST_GROOM && holds && !is_published(params);
}

typedef struct SolverState SolverState;

typedef struct SolverBatch {
    GpuBuffer state;         // a vec4 per particle: velocities or segments, see SolverStateKind
    GpuBuffer tips;          // only for SOLVER_SEGMENTS: two vec4 per strand
    GpuBuffer scratch;       // SolverRecipe.scratch
    GpuBuffer natural, held; // SolverRecipe.balance
    GpuBuffer slowed;        // SolverRecipe.counts: a number
} SolverBatch;

struct SolverState {
    const SolverRecipe *recipe; // NULL if static
    const Hair *hair;
    const SectionParams *params;
    GpuTimer *timer;
    void *own; // the solver's own block
    StepPrograms programs;
    Along along;             // parameters that differ along the strand, or empty
    SolverBatch *batches;    // one for each batch of the hair
    float rest_gravity[3];   // m/s^2, in the head's frame: the gravity under which the groom is at
                             // rest; 0 if it is not balanced
    bool keeps;              // the groom is balanced by SolverRecipe.balance
    double weight, supports; // of the groom, and of it what its own elasticity does not carry
    bool varies;             // parameters differ along the strand
    const GpuBuffer *frames; // of bound strands, or NULL
    // For animated parameters: the strength of the style at time 0, at which the groom was
    // balanced.
    bool changes;
    float held_by;       // at time 0
    Pose pose;           // of segments; with particles: of the style, as which they start and as
                         // which static hair stays
    Collision collision; // of the solver's state
    Collision drawn;     // of the drawn positions, if they are not the state
    bool posed;          // the particles have their first positions
};

static bool has_particles(const SolverState *state)
{
    return state->recipe && state->recipe->state == SOLVER_PARTICLES;
}

static bool has_segments(const SolverState *state)
{
    return state->recipe && state->recipe->state == SOLVER_SEGMENTS;
}

static void destroy(SolverState *state)
{
    for (uint32_t i = 0; state->batches && i < state->hair->batch_count; ++i) {
        gpu_buffer_destroy(&state->batches[i].state);
        gpu_buffer_destroy(&state->batches[i].tips);
        gpu_buffer_destroy(&state->batches[i].scratch);
        gpu_buffer_destroy(&state->batches[i].natural);
        gpu_buffer_destroy(&state->batches[i].held);
        gpu_buffer_destroy(&state->batches[i].slowed);
    }
    free(state->batches);
    free(state->own);
    along_destroy(&state->along);
    step_programs_destroy(&state->programs);
    pose_destroy(&state->pose);
    collision_destroy(&state->collision);
    collision_destroy(&state->drawn);
    free(state);
}

static Result check_vertices(const SolverType *type, const SolverRecipe *recipe, const Hair *hair,
                             Error *error)
{
    for (uint32_t i = 0; i < hair->batch_count; ++i)
        if (recipe->most_vertices && hair->batches[i].vertex_count > recipe->most_vertices)
            return error_set(error, RESULT_USAGE,
                             "%s: a strand of %u vertices: expected at most %u (longer strands "
                             "exceed the loop limit of a CPU driver; rope takes more)",
                             type->name, hair->batches[i].vertex_count, recipe->most_vertices);
    return RESULT_OK;
}

static Result build_programs(SolverState *state, const SolverSetup *setup, Error *error)
{
    const SolverRecipe *recipe = state->recipe;
    ShaderDefine defines[STEP_OWN_DEFINES + 1] = {0};
    if (recipe->define) recipe->define(defines, state->params);
    const StepProgramsOptions options = {
        .shader = recipe->shader,
        .shape = recipe->shape,
        .most_vertices = recipe->most_vertices,
        .lead = recipe->carried < 2 && state->params->clamped > 1,
        .carried = recipe->carried,
        .sheltered = setup->sheltered,
        .varies = has_particles(state) && state->varies,
        .styled = state->params->style > 0 && state->params->style_stiffness > 0,
        .bound = state->frames != NULL,
        .defines = defines,
    };
    return step_programs_create(&state->programs, setup->gpu, state->hair, &options, error);
}

typedef float Float4[4];

static bool is_balanced(const SolverState *state)
{
    return glm_vec3_norm2((float *)state->rest_gravity) > 0;
}

// Turns the strand's texels of `rest` into directions in the world and adds them up to the tip. If
// `hanging` (in the head's frame) is not 0, segments that the head does not carry point in its
// direction.
static void place_strand(const HairBatch *hair, uint32_t slot, const HeadPose *head, uint32_t lead,
                         const float hanging[3], Float4 *rest, Float4 tip)
{
    bool hangs = glm_vec3_norm2((float *)hanging) > 0;
    for (uint32_t j = 0; j < hair->vertex_count; ++j) {
        float *at = rest[hair_address(hair, slot, j)];
        if (hangs && j > lead) glm_vec3_copy((float *)hanging, at);
        if (head) glm_quat_rotatev((float *)head->rotation, at, at);
        if (head && j == 0) glm_vec3_add((float *)head->translation, at, at);
        for (int k = 0; k < 3; ++k) tip[k] += j == 0 ? at[k] : at[3] * at[k];
    }
}

// The direction in which a strand hangs at rest, a unit vector in the head's frame. `hanging` stays
// 0 if the strand starts in the style instead.
static void find_hanging(const SolverState *state, vec3 hanging)
{
    if (is_balanced(state)) glm_vec3_normalize_to((float *)state->rest_gravity, hanging);
}

// Creates the segments and tips at rest, at the head's pose.
static Result create_segments(SolverState *state, uint32_t i, const SolverSetup *setup,
                              Error *error)
{
    SolverBatch *batch = &state->batches[i];
    const HairBatch *hair = &state->hair->batches[i];
    vec3 hanging = {0};
    find_hanging(state, hanging);
    const GpuLimits *limits = &setup->gpu->limits;
    uint32_t slots = hair_slots(hair);
    Float4 *segments = gpu_buffer_read(&hair->rest),
           *tips = calloc(2 * (size_t)slots, sizeof *tips);
    Result result = RESULT_OK;
    if (!segments || !tips)
        result = error_set(error, RESULT_FAILED, "no memory for %u strands", slots);
    for (uint32_t slot = 0; slot < slots && result == RESULT_OK; ++slot)
        place_strand(hair, slot, setup->head, state->programs.leads[i], hanging, segments,
                     tips[2 * slot]);
    THEN(result, gpu_buffer_create(&batch->state, limits, "segments", hair->rest.size, segments,
                                   GL_RGBA32F, error));
    THEN(result, gpu_buffer_create(&batch->tips, limits, "tips",
                                   2 * (int64_t)(slots * sizeof *tips), tips, 0, error));
    free(segments);
    free(tips);
    return result;
}

// Finds the groom's shape without load.
static Result balance_batch(SolverState *state, uint32_t i, const GpuLimits *limits, Error *error)
{
    const HairBatch *hair = &state->hair->batches[i];
    SolverBatch *batch = &state->batches[i];
    int64_t size = hair->rest.size;
    Float4 *rest = gpu_buffer_read(&hair->rest), *natural = calloc(1, (size_t)size),
           *held = calloc(1, (size_t)size);
    RestBatch of = {.hair = hair,
                    .params = state->params,
                    .lead = state->programs.leads[i],
                    .gravity = state->rest_gravity,
                    .rest = (const float(*)[4])rest,
                    .natural = natural,
                    .held = held};
    Result result = RESULT_OK;
    if (!rest || !natural || !held)
        result = error_set(error, RESULT_FAILED, "no memory for the groom's balance");
    THEN(result, state->recipe->balance(&of, error));
    THEN(result, gpu_buffer_create(&batch->natural, limits, "natural shapes", size, natural,
                                   GL_RGBA32F, error));
    THEN(result, gpu_buffer_create(&batch->held, limits, "forces that hold the groom", size, held,
                                   GL_RGBA32F, error));
    state->weight += of.weight, state->supports += of.supports;
    free(rest);
    free(natural);
    free(held);
    return result;
}

static Result create_batch(SolverState *state, uint32_t i, const SolverSetup *setup, Error *error)
{
    const GpuLimits *limits = &setup->gpu->limits;
    const HairBatch *hair = &state->hair->batches[i];
    SolverBatch *batch = &state->batches[i];
    uint32_t scratch = state->recipe->scratch;
    assert(scratch <= HAIR_MOST_SCRATCH);
    if (has_segments(state)) return create_segments(state, i, setup, error);
    TRY(gpu_buffer_create(&batch->state, limits, "velocities", hair->rest.size, NULL, GL_RGBA32F,
                          error));
    gpu_buffer_clear(&batch->state, 0);
    if (state->recipe->balance && state->keeps) TRY(balance_batch(state, i, limits, error));
    if (state->recipe->counts) {
        TRY(gpu_buffer_create(&batch->slowed, limits, "a count", sizeof(uint32_t), NULL, 0, error));
        gpu_buffer_clear(&batch->slowed, 0);
    }
    if (!scratch || state->programs.in_registers) return RESULT_OK;
    uint64_t lanes = step_programs_lanes(&state->programs, hair->strand_count),
             tiles = (lanes + STRAND_TILE - 1) / STRAND_TILE;
    return gpu_buffer_create(
        &batch->scratch, limits, "a solver's scratch memory",
        (int64_t)(tiles * STRAND_TILE * hair->vertex_count * scratch * sizeof(Float4)), NULL,
        GL_RGBA32F, error);
}

static void set_rest_gravity(SolverState *state, const SolverSetup *setup)
{
    versor inverse = {0, 0, 0, 1};
    if (!solver_keeps_groom(setup->params)) return;
    if (setup->head) glm_quat_conjugate((float *)setup->head->rotation, inverse);
    glm_quat_rotatev(inverse, (float *)setup->rest_gravity, state->rest_gravity);
}

// The strength of the pull towards the style, up to a constant factor.
static float style_strength(const SectionParams *params)
{
    bool springs = strcmp(params->algo, "spring") == 0;
    return step_style_odds(params) * (springs ? params->spring_angular : params->style_stiffness);
}

static Result build(SolverState *state, const SolverSetup *setup, Error *error)
{
    const SolverRecipe *recipe = state->recipe;
    bool segments = has_segments(state);
    vec3 hanging = {0};
    find_hanging(state, hanging);
    const PoseOptions pose = {.style = segments ? setup->params->style : 1,
                              .varies = segments && state->varies,
                              .fades = segments && setup->style_changes,
                              .bound = state->frames != NULL,
                              .hanging = {hanging[0], hanging[1], hanging[2]}};
    TRY(pose_create(&state->pose, setup->gpu, &pose, error));
    if (!recipe) return RESULT_OK;
    state->batches = calloc(state->hair->batch_count + 1, sizeof *state->batches);
    state->own = calloc(1, recipe->params_size + 1);
    if (!state->batches || !state->own)
        return error_set(error, RESULT_FAILED, "no memory for a solver");
    TRY(build_programs(state, setup, error));
    if (state->varies)
        TRY(along_create(&state->along, recipe, state->hair, state->programs.leads, state->params,
                         &setup->gpu->limits, error));
    if (segments) along_fill(&state->along, &(SolverStep){.dt = 1}, state->own);
    // With a balanced groom the simulated strands hang down through the head, so only the drawn
    // positions collide.
    if (!segments || !is_balanced(state))
        TRY(collision_create(&state->collision, setup,
                             segments ? COLLISION_SEGMENTS : COLLISION_PARTICLES, recipe, error));
    if (segments) TRY(collision_create(&state->drawn, setup, COLLISION_DRAWN, recipe, error));
    for (uint32_t i = 0; i < state->hair->batch_count; ++i)
        TRY(create_batch(state, i, setup, error));
    return RESULT_OK;
}

Result solver_create(Solver *solver, const SolverSetup *setup, Error *error)
{
    *solver = (Solver){0};
    TRY(solver_check(setup->params, error));
    const SolverType *type = known_type(setup->params);
    const SolverRecipe *own = type->recipes[find_variant(type, setup->params->variant)];
    const SolverRecipe *recipe = own ? own : type->recipes[0];
    if (recipe) TRY(check_vertices(type, recipe, setup->hair, error));
    if (recipe && recipe->check) TRY(recipe->check(setup, error));
    SolverState *state = calloc(1, sizeof *state);
    if (!state) return error_set(error, RESULT_FAILED, "no memory for a solver");
    state->recipe = recipe;
    state->hair = setup->hair;
    state->params = setup->params;
    state->timer = setup->timer;
    state->frames = setup->frames;
    set_rest_gravity(state, setup);
    state->keeps = recipe && recipe->balance && solver_keeps_groom(state->params);
    state->varies = recipe && !is_published(state->params) && along_varies(recipe, state->params);
    state->changes = setup->start != NULL;
    if (setup->start) state->held_by = style_strength(setup->start);
    // The share of the style in the drawn positions is then read from the table of profiles.
    if (recipe && recipe->state == SOLVER_SEGMENTS && recipe->along && setup->style_changes)
        state->varies = true;
    Result result = build(state, setup, error);
    if (result == RESULT_OK)
        *solver = (Solver){type, state};
    else
        destroy(state);
    return result;
}

void solver_destroy(Solver *solver)
{
    if (solver->state) destroy(solver->state);
    *solver = (Solver){0};
}

int solver_buffers(const Solver *solver, uint32_t batch, SolverBuffer buffers[SOLVER_MAX_BUFFERS])
{
    const SolverState *state = solver->state;
    if (!state->recipe) return 0;
    const SolverBatch *own = &state->batches[batch];
    if (has_segments(state)) {
        buffers[0] = (SolverBuffer){&own->state, SOLVER_DIRECTIONS};
        buffers[1] = (SolverBuffer){&own->tips, SOLVER_TIPS};
    } else {
        buffers[0] = (SolverBuffer){&state->hair->batches[batch].position, SOLVER_POINTS};
        buffers[1] = (SolverBuffer){&own->state, SOLVER_VELOCITIES};
    }
    const CollisionBatch *contacts = collision_memory(&state->collision, batch);
    if (!contacts) return 2;
    buffers[2] = (SolverBuffer){&contacts->contacts, SOLVER_POINTS};
    buffers[3] = (SolverBuffer){&contacts->forces, SOLVER_DIRECTIONS};
    return contacts->forces.buffer ? 4 : 3;
}

// The force that holds the groom against gravity fades with the pull towards the style; otherwise
// loose hair would float.
static float held_share(const SolverState *state)
{
    if (!state->changes) return 1;
    float now = style_strength(state->params);
    return now < state->held_by ? now / state->held_by : (now > 0);
}

static void bind_frames(const SolverState *state, uint32_t batch)
{
    if (state->frames) gpu_buffer_bind_texture(&state->frames[batch], BIND_FRAMES);
}

static void write_batch_pose(SolverState *state, uint32_t i, const HeadPose *head)
{
    along_bind(&state->along, i);
    bind_frames(state, i);
    pose_write(&state->pose, &state->hair->batches[i],
               has_segments(state) ? &state->batches[i].state : NULL,
               has_segments(state) ? state->programs.leads[i] : 0, head);
}

static void write_pose(SolverState *state, const HeadPose *head)
{
    state->pose.held = held_share(state);
    for (uint32_t i = 0; i < state->hair->batch_count; ++i) write_batch_pose(state, i, head);
}

void solver_pose(const Solver *solver, const HeadPose *head)
{
    SolverState *state = solver->state;
    if (has_particles(state)) {
        if (!state->posed) write_pose(state, head);
        state->posed = true;
        return;
    }
    gpu_timer_begin(state->timer, "pose");
    write_pose(state, head);
    collision_push_drawn(&state->drawn, head);
    gpu_timer_end(state->timer);
}

static void dispatch(SolverState *state, uint32_t i, StepParams *uniforms, const HeadPose *head)
{
    const HairBatch *hair = &state->hair->batches[i];
    const SolverBatch *batch = &state->batches[i];
    if (hair->held == hair->vertex_count) { // the head carries whole strands
        if (has_particles(state)) write_batch_pose(state, i, head);
        return;
    }
    uniforms->strand_count = hair->strand_count;
    uniforms->vertex_count = hair->vertex_count - state->programs.leads[i];
    gpu_uniforms_set(BIND_STEP, uniforms, sizeof *uniforms);
    gpu_buffer_bind_texture(&hair->position, BIND_POSITION);
    gpu_buffer_bind_texture(&hair->rest, BIND_REST);
    gpu_buffer_bind_texture(&batch->state, BIND_STATE);
    along_bind(&state->along, i);
    bind_frames(state, i);
    if (batch->slowed.buffer) gpu_buffer_bind_storage(&batch->slowed, BIND_TIPS);
    if (batch->natural.buffer) gpu_buffer_bind_texture(&batch->natural, BIND_NATURAL);
    if (batch->held.buffer) gpu_buffer_bind_texture(&batch->held, BIND_HELD);
    gpu_buffer_bind_storage(&hair->position, BIND_POSITION_OUT);
    gpu_buffer_bind_storage(&batch->state, BIND_STATE_OUT);
    if (batch->tips.buffer) gpu_buffer_bind_storage(&batch->tips, BIND_TIPS);
    if (batch->scratch.buffer) gpu_buffer_bind_storage(&batch->scratch, BIND_SCRATCH);
    if (batch->scratch.buffer) gpu_buffer_bind_texture(&batch->scratch, BIND_SCRATCH_BEFORE);
    step_programs_dispatch(&state->programs, i, hair->strand_count);
}

// The groom is at rest under the gravity in which its author saw it: a force in the hair balances
// that gravity and turns with the head. So particles feel only the difference between gravity and
// this rest gravity. (For springs of stiffness k towards the style, this equals moving the springs'
// ends by -g/k: Twigg, Kacic-Alesic: Optimization for Sag-Free Simulations, SCA 2011.) Strands of
// segments include the balance in their pose instead.
static void hold_groom(const SolverState *state, StepParams *uniforms)
{
    vec3 held = {0};
    bool uniform = has_particles(state) && !state->keeps;
    if (uniform && state->frames)
        glm_vec3_scale((float *)state->rest_gravity,
                       held_share(state) * state->params->gravity_share, uniforms->held);
    else if (uniform)
        glm_quat_rotatev(uniforms->head_rotation, (float *)state->rest_gravity, held);
    if (state->changes) glm_vec3_scale(held, held_share(state), held);
    glm_vec3_sub(uniforms->gravity, held, uniforms->gravity);
    glm_vec3_scale(uniforms->gravity, state->params->gravity_share, uniforms->gravity);
}

// Makes one of `count` equal sub-steps.
static void step_part(SolverState *state, const SolverStep *step, int part, int count)
{
    const SolverRecipe *recipe = state->recipe;
    StepParams uniforms = step_uniforms(step, state->params);
    hold_groom(state, &uniforms);
    if (recipe->fill) {
        memset(state->own, 0, recipe->params_size);
        recipe->fill(state->own, &uniforms, step, state->params);
        gpu_uniforms_set(BIND_SOLVER, state->own, recipe->params_size);
    }
    along_fill(&state->along, step, state->own);
    int phases = recipe->phases && !state->programs.in_registers
                     ? recipe->phases(state->params, state->hair)
                     : 1;
    for (int phase = 0; phase < phases; ++phase) {
        uniforms.phase = (uint32_t)phase;
        for (uint32_t i = 0; i < state->hair->batch_count; ++i)
            dispatch(state, i, &uniforms, &step->head);
        glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
    }
    if (!collision_begin(&state->collision, step, part, count)) return;
    for (uint32_t i = 0; i < state->hair->batch_count; ++i) {
        SolverBatch *batch = &state->batches[i];
        collision_push(&state->collision, i, &batch->state,
                       batch->tips.buffer ? &batch->tips : NULL);
    }
}

void solver_step(const Solver *solver, const SolverStep *whole)
{
    SolverState *state = solver->state;
    if (!state->recipe) return;
    if (has_particles(state)) solver_pose(solver, &whole->head_old);
    gpu_timer_begin(state->timer, state->recipe->label);
    SolverStep step = *whole;
    int count = solver_substeps(solver, whole);
    step.dt = whole->dt / count;
    for (int k = 0; k < 3; ++k) step.move_lost[k] /= (float)count;
    for (int part = 1; part <= count; ++part) {
        step.head = head_between(&whole->head_old, &whole->head, (float)part / (float)count);
        step.frame_old = (float)(part - 1) / (float)count;
        step.frame_now = (float)part / (float)count;
        step_part(state, &step, part, count);
        step.head_old = step.head;
        step.first = false;
    }
    gpu_timer_end(state->timer);
}

void solver_refresh(const Solver *solver, uint64_t stamp)
{
    SolverState *state = solver->state;
    if (!state || !has_segments(state)) return;
    along_fill(&state->along, &(SolverStep){.dt = 1, .params_stamp = stamp}, state->own);
}

void solver_report(const Solver *solver, SolverReport *report)
{
    const SolverState *state = solver->state;
    collision_report(&state->collision, report);
    report->groom_weight += state->weight, report->groom_held += state->supports;
    for (uint32_t i = 0; state->batches && i < state->hair->batch_count; ++i) {
        uint32_t *slowed =
            state->batches[i].slowed.buffer ? gpu_buffer_read(&state->batches[i].slowed) : NULL;
        if (slowed) report->strands_slowed += *slowed;
        free(slowed);
    }
    for (uint32_t i = 0; has_segments(state) && i < state->hair->batch_count; ++i) {
        uint32_t count = state->hair->batches[i].strand_count;
        Float4 *tips = gpu_buffer_read(&state->batches[i].tips);
        if (!tips) return;
        for (uint32_t s = 0; s < count; ++s) report->moves_limited += (uint64_t)tips[2 * s][3];
        free(tips);
    }
}

int solver_substeps(const Solver *solver, const SolverStep *step)
{
    const SolverState *state = solver->state;
    if (!state->recipe || !state->recipe->substeps) return 1;
    return state->recipe->substeps(step, state->params, state->hair);
}

uint32_t solver_carried(const Solver *solver)
{
    const SolverState *state = solver->state;
    uint32_t carried = state->params->clamped > 1 ? 2 : state->recipe->carried;
    return carried > 1 ? carried : 1;
}

bool solver_is_static(const SolverType *type)
{
    return !type->recipes[0];
}

static void print_flags(FILE *stream, const char *name)
{
    for (size_t i = 0; i < PARAM_COUNT; ++i) {
        if (!*PARAM_TABLE[i].owner || !params_owned_by(&PARAM_TABLE[i], name)) continue;
        fputs("           --", stream);
        for (const char *c = PARAM_TABLE[i].name; *c; ++c) fputc(*c == '_' ? '-' : *c, stream);
        fprintf(stream, " (%s)\n", PARAM_TABLE[i].default_text);
    }
}

void solver_print_list(FILE *stream)
{
    for (const SolverType *const *type = SOLVER_TYPES; *type; ++type) {
        bool chosen = strcmp((*type)->name, params_find("algo")->default_text) == 0;
        fprintf(stream, "%-10s %s%s\n", (*type)->name, chosen ? "(default) " : "",
                (*type)->summary);
        fprintf(stream, "           lengths: %s; style: %s\n",
                (*type)->lengths ? (*type)->lengths : "-",
                (*type)->style ? (*type)->style : "not kept");
        for (int i = 0; (*type)->variants[i]; ++i)
            fprintf(stream, "           --variant %s%s\n", (*type)->variants[i],
                    i ? "" : " (default)");
        print_flags(stream, (*type)->name);
    }
}
