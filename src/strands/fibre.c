// SPDX-License-Identifier: MIT
#include "strands/fibre.h"

#include <math.h>

bool fibre_is_known(const Fibre *fibre)
{
    return fibre->youngs_modulus > 0 || fibre->density > 0 || fibre->radius > 0;
}

bool fibre_equals(const Fibre *a, const Fibre *b)
{
    return a->youngs_modulus == b->youngs_modulus && a->poisson == b->poisson &&
           a->density == b->density && a->radius == b->radius;
}

void fibre_fill(Fibre *fibre, const Fibre *from)
{
    if (from->youngs_modulus > 0) fibre->youngs_modulus = from->youngs_modulus;
    if (from->youngs_modulus > 0 && from->poisson > -1) fibre->poisson = from->poisson;
    if (from->density > 0) fibre->density = from->density;
    if (from->radius > 0) fibre->radius = from->radius;
}

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
