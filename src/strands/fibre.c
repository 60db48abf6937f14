// SPDX-License-Identifier: MIT
#include "strands/fibre.h"

#include <math.h>

Fibre fibre_of(const SectionParams *params)
{
    return (Fibre){.youngs_modulus = (double)params->youngs_modulus * 1e9,
                   .poisson = (double)params->poisson,
                   .density = (double)params->hair_density,
                   .radius = (double)params->hair_radius * 1e-6};
}

Result fibre_default(Fibre *fibre, double *gravity, Error *error)
{
    SectionParams section = {0};
    RunParams run = {0};
    Result result = params_create_section(&section, error);
    THEN(result, params_create_run(&run, error));
    *fibre = fibre_of(&section);
    *gravity = sqrt((double)run.gravity[0] * (double)run.gravity[0] +
                    (double)run.gravity[1] * (double)run.gravity[1] +
                    (double)run.gravity[2] * (double)run.gravity[2]);
    params_destroy_section(&section);
    params_destroy_run(&run);
    return result;
}

double fibre_stiffness(const Fibre *fibre)
{
    return fibre->youngs_modulus * fibre->radius * fibre->radius / (4 * fibre->density);
}

double fibre_gravito_bending_length(const Fibre *fibre, double gravity)
{
    return cbrt(fibre_stiffness(fibre) / gravity);
}
