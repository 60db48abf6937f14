// SPDX-License-Identifier: MIT
#include "run/played.h"

#include "formats/strands_read.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool played_any(const Scene *scene)
{
    for (uint32_t i = 0; i < scene->section_count; ++i)
        if (scene->sections[i].frames) return true;
    return false;
}

// The file's frames around a time, and the place between them. Rates that differ by rounding count
// as equal, so that whole frames are drawn exactly.
static float find_frames(const StrandsFrames *frames, double time, uint32_t *before,
                         uint32_t *after)
{
    double at = fmin(fmax(time * frames->fps, 0), frames->count - 1), whole = round(at);
    if (fabs(at - whole) < 1e-4) at = whole;
    *before = (uint32_t)at;
    *after = *before + 1 < frames->count ? *before + 1 : *before;
    return (float)(at - *before);
}

static Result show_section(Simulation *simulation, uint32_t i, Error *error)
{
    const StrandsFrames *frames = simulation->scene->sections[i].frames;
    const Hair *hair = &simulation->sections[i].hair;
    uint32_t before, after;
    float share = find_frames(frames, simulation->time, &before, &after);
    const float(*a)[3] = (const float(*)[3])frames->position + (size_t)before * frames->vertices,
          (*b)[3] = (const float(*)[3])frames->position + (size_t)after * frames->vertices;
    float(*positions)[3] = malloc(hair->particle_count * sizeof *positions + 1),
    (*to)[3] = positions;
    if (!positions) return error_set(error, RESULT_FAILED, "no memory for a frame of hair");
    for (uint32_t k = 0; k < hair->batch_count; ++k) {
        const HairBatch *batch = &hair->batches[k];
        for (uint32_t s = 0; s < batch->strand_count; ++s) {
            uint32_t from = frames->first_vertex[batch->strand[s]];
            for (uint32_t v = from; v < from + batch->vertex_count; ++v, ++to)
                for (int c = 0; c < 3; ++c)
                    (*to)[c] = share > 0 ? a[v][c] + share * (b[v][c] - a[v][c]) : a[v][c];
        }
    }
    Result result = simulation_show_section(simulation, i, (const float(*)[3])positions, error);
    free(positions);
    return result;
}

Result played_show(Simulation *simulation, Error *error)
{
    for (uint32_t i = 0; i < simulation->scene->section_count; ++i)
        if (simulation->scene->sections[i].frames) TRY(show_section(simulation, i, error));
    return RESULT_OK;
}
