// SPDX-License-Identifier: MIT
// Short motions of all solvers and variants, with everything that moves hair, compared with
// recorded ones (support/recorded.h).
#include "support/needed.h"
#include "support/recorded.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

enum { GROUPS = 24 };

// Adds, for each of GROUPS sets of particles, the sum of each coordinate with weights between 0.5
// and 1.5: every particle counts, and no two can change places unnoticed.
static void add_hair(const Hair *hair, RecordedNumbers *numbers)
{
    double sum[GROUPS][3] = {{0}};
    float(*position)[3] = malloc((size_t)hair->particle_count * sizeof *position);
    assert_non_null(position);
    NEEDED(hair_read_positions(hair, position, error));
    for (uint64_t i = 0; i < hair->particle_count; ++i)
        for (int k = 0; k < 3; ++k)
            sum[i % GROUPS][k] += (double)position[i][k] * (0.5 + (double)(i * 7919 % 997) / 997);
    for (int g = 0; g < GROUPS; ++g)
        for (int k = 0; k < 3; ++k)
            recorded_add(numbers, (float)(sum[g][k] * GROUPS / (double)hair->particle_count));
    free(position);
}

static void add_all(const Simulation *simulation, RecordedNumbers *numbers)
{
    for (uint32_t i = 0; i < simulation->scene->section_count; ++i) {
        const SimulationSection *section = &simulation->sections[i];
        add_hair(&section->hair, numbers);
        if (section->follow.per_guide) add_hair(&section->follow.hair, numbers);
    }
}

// The positions halfway and at the last frame.
static void move(RecordedCase *recorded, RecordedNumbers *numbers)
{
    Simulation *simulation = &recorded->simulation;
    const int last = recorded->scene.run.frames - 1;
    while (simulation->frame < last / 2) simulation_advance(simulation);
    simulation_pose(simulation);
    add_all(simulation, numbers);
    while (simulation->frame < last) simulation_advance(simulation);
    simulation_pose(simulation);
    add_all(simulation, numbers);
}

// With llvmpipe, motions with vectors of 128 bits and on a processor with SSE2 only differ from the
// recorded ones by at most 7.4e-6 of a value plus 7.4e-6 of the root mean square; these limits are
// four times that. Other drivers round otherwise, and collisions multiply the difference.
static const RecordedLimits LIMITS = {3e-5f, 3e-5f, 0.05f, 0.02f};

static void test_motion(void **state)
{
    (void)state;
    recorded_check("motion", &LIMITS, move);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_motion)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
