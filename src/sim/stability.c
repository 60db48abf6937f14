// SPDX-License-Identifier: MIT
#include "sim/stability.h"
#include "scene/schedule.h"
#include "sim/solver.h"

#include <math.h>

double stability_number(const Strands *strands, double g, double dt)
{
    double most = 0; // of (n - 1)^2 / L
    for (uint32_t s = 0; s < strands->strand_count; ++s) {
        double links = strands_size(strands, s) - 1.0, length = strands_length(strands, s);
        if (length > 0) most = fmax(most, links * links / length);
    }
    return dt * sqrt(g * most);
}

static double norm(const float v[3])
{
    return sqrt((double)v[0] * (double)v[0] + (double)v[1] * (double)v[1] +
                (double)v[2] * (double)v[2]);
}

// Between its keys no number of a track overshoots.
static double greatest(const Keyframes *keys, const float constant[3])
{
    double most = keys->count ? 0 : norm(constant);
    for (uint32_t i = 0; i < keys->count; ++i) most = fmax(most, norm(&keys->value[3 * (size_t)i]));
    return most;
}

double stability_acceleration(const Scene *scene, const SectionParams *params)
{
    return greatest(&scene->gravity, scene->run.gravity) +
           (double)params->drag * (1 + (double)scene->run.gust) *
               greatest(&scene->wind, scene->run.wind);
}

Result stability_choose_substeps(int *substeps, const Scene *scene, const Strands *strands,
                                 Error *error)
{
    const double most_steps = params_find("substeps")->maximum;
    *substeps = 1;
    for (uint32_t i = 0; i < scene->section_count; ++i) {
        const Section *section = &scene->sections[i];
        double limit = solver_most_stability(&section->params);
        if (!(limit > 0)) continue;
        double sigma =
            stability_number(&strands[i], stability_acceleration(scene, &section->params),
                             1 / schedule_period_rate(&scene->run));
        double steps = ceil(sigma / limit);
        if (steps > most_steps)
            return error_set(error, RESULT_USAGE,
                             "%s: --substeps auto comes to %.6g, at most %.0f are taken: raise "
                             "--sim-rate or --fps, or give fewer",
                             section->file, steps, most_steps);
        if ((int)steps > *substeps) *substeps = (int)steps;
    }
    return RESULT_OK;
}
