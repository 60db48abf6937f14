// SPDX-License-Identifier: MIT
#include "support/reference_dftl.h"

void reference_dftl_step(TwinStrand *strand, const TwinStep *step, const SectionParams *params)
{
    const int n = strand->n;
    double s = (double)params->ftl_damping;
    Vec old[TWIN_MAX], correction[TWIN_MAX + 1] = {{0}};
    for (int i = 0; i < n; ++i) vec_copy(strand->x[i], old[i]);

    for (int i = 1; i < n; ++i) {
        twin_kick(strand->v[i], step, step->first ? step->dt / 2 : step->dt);
        vec_add_scaled(old[i], step->dt, strand->v[i], strand->x[i]);
    }
    twin_style(strand, &step->head, 0, strand->x[0]);
    twin_pull_to_style(strand, step, step->dt, step->first ? step->dt / 2 : step->dt, params);
    for (int i = 1; i < n; ++i) {
        Vec predicted, r;
        vec_copy(strand->x[i], predicted);
        vec_add_scaled(predicted, -1, strand->x[i - 1], r);
        vec_add_scaled(strand->x[i - 1], strand->length[i] / vec_norm(r), r, strand->x[i]);
        vec_add_scaled(strand->x[i], -1, predicted, correction[i]);
    }
    for (int i = 1; i < n; ++i)
        for (int k = 0; k < 3; ++k)
            strand->v[i][k] =
                (strand->x[i][k] - old[i][k]) / step->dt - s * correction[i + 1][k] / step->dt;
}
