// SPDX-License-Identifier: MIT
// States of simulations, to which they can return.
#include "library/library.h"

#include "sim/simulation_state.h"

#include <stdlib.h>
#include <string.h>

struct TractrixState {
    Bytes bytes;
};

static Result create(TractrixState **state, Error *error)
{
    *state = calloc(1, sizeof **state);
    return *state ? RESULT_OK : error_set(error, RESULT_FAILED, "no memory for a state");
}

void tractrix_state_destroy(TractrixState *state)
{
    LIBRARY_CALL;
    if (!state) return;
    bytes_destroy(&state->bytes);
    free(state);
}

const void *tractrix_state_bytes(const TractrixState *state, size_t *size)
{
    LIBRARY_CALL;
    if (size) *size = state ? state->bytes.size : 0;
    return state ? state->bytes.data : NULL;
}

// A body that the caller moves is at a place that the state does not hold.
static Result check_driven(const TractrixSimulation *simulation, Error *error)
{
    for (uint32_t b = 0; b < simulation->scene.body_count; ++b)
        if (simulation->is_driven[b])
            return error_set(error, RESULT_USAGE,
                             "the caller moves body %u: expected a simulation whose bodies move as "
                             "the scene says",
                             b);
    return RESULT_OK;
}

typedef struct Saving {
    TractrixSimulation *simulation;
    Bytes *bytes;
} Saving;

// Saving shows the positions of the last step, so the hair is posed again.
static Result save(void *data, Error *error)
{
    Saving *saving = data;
    Simulation *simulation = &saving->simulation->simulation;
    TRY(simulation_state_save(simulation, saving->bytes, error));
    simulation_pose(simulation);
    return gpu_check("saving the state", error);
}

static Result restore(void *data, Error *error)
{
    Saving *saving = data;
    Simulation *simulation = &saving->simulation->simulation;
    TRY(simulation_state_restore(simulation, saving->bytes, error));
    simulation_pose(simulation);
    ++simulation->changes;
    return gpu_check("restoring the state", error);
}

static Result save_all(TractrixState **state, TractrixSimulation *simulation, Error *error)
{
    TRY(check_driven(simulation, error));
    TRY(create(state, error));
    Saving saving = {simulation, &(*state)->bytes};
    return library_on_device(simulation->device, save, &saving, error);
}

TractrixResult tractrix_simulation_save(TractrixState **state, TractrixSimulation *simulation,
                                        TractrixError *error)
{
    LIBRARY_CALL;
    Error why = {{0}};
    if (!state) return library_refuse(error, "state: got NULL");
    *state = NULL;
    if (!simulation) return library_refuse(error, "simulation: got NULL");
    Result result = save_all(state, simulation, &why);
    if (result != RESULT_OK) {
        tractrix_state_destroy(*state);
        *state = NULL;
    }
    return library_end(result, &why, error);
}

TractrixResult tractrix_state_create(TractrixState **state, const void *bytes, size_t size,
                                     TractrixError *error)
{
    LIBRARY_CALL;
    Error why = {{0}};
    if (!state) return library_refuse(error, "state: got NULL");
    *state = NULL;
    if (!bytes) return library_refuse(error, "bytes: got NULL");
    Result result = create(state, &why);
    if (result == RESULT_OK) {
        (*state)->bytes = (Bytes){.data = malloc(size + 1), .size = size};
        if ((*state)->bytes.data)
            memcpy((*state)->bytes.data, bytes, size);
        else
            result = error_set(&why, RESULT_FAILED, "no memory for a state");
    }
    if (result != RESULT_OK) {
        tractrix_state_destroy(*state);
        *state = NULL;
    }
    return library_end(result, &why, error);
}

TractrixResult tractrix_simulation_restore(TractrixSimulation *simulation,
                                           const TractrixState *state, TractrixError *error)
{
    LIBRARY_CALL;
    Error why = {{0}};
    if (!simulation || !state) return library_refuse(error, "simulation or state: got NULL");
    Bytes bytes = state->bytes;
    Saving saving = {simulation, &bytes};
    Result result = check_driven(simulation, &why);
    THEN(result, library_on_device(simulation->device, restore, &saving, &why));
    return library_end(result, &why, error);
}
