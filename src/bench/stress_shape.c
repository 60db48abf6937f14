// SPDX-License-Identifier: MIT
// Strands of stress_case.h.
#include "bench/stress_case.h"

#include "base/double3.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

// The way from particle j - 1 to j along the strand, before it is made `length` long; `main` is a
// unit vector, `side` one across it.
static void link_of(const StressCase *stress, int j, const double main[3], const double side[3],
                    Random *random, double link[3])
{
    double turn = 2 * PI * 3 * j / stress->value[STRESS_n], along = 1, across = 0, over = 0;
    switch ((enum StressShape)stress->value[STRESS_shape]) {
    case STRESS_CURL:
        along = 0.5, across = cos(turn), over = sin(turn);
        break;
    case STRESS_ZIGZAG:
        along = j % 2 ? 1 : -1;
        break;
    case STRESS_UNEVEN:
        along = pow(1e4, random_real(random));
        break;
    case STRESS_WALK:
    case STRESS_NEARLY_ZERO:
        random_direction(random, link);
        for (int k = 0; k < 3 && stress->value[STRESS_shape] == STRESS_NEARLY_ZERO; ++k)
            link[k] *= j % 2 ? 1 : 1e-12;
        return;
    case STRESS_STRAIGHT:
    case STRESS_SHAPES:
        break;
    }
    Double3 third;
    double3_cross(main, side, third);
    for (int k = 0; k < 3; ++k) link[k] = along * main[k] + across * side[k] + over * third[k];
}

void stress_case_make_strand(const StressCase *stress, float (*points)[3])
{
    enum { MOST = 64 };
    int n = (int)stress->value[STRESS_n];
    double tilt = stress->value[STRESS_tilt] * PI / 180, length = stress->value[STRESS_length],
           arm = stress->value[STRESS_arm], total = 0, links[MOST][3], x[3] = {0, arm, 0};
    const double main[3] = {sin(tilt), -cos(tilt), 0}, side[3] = {cos(tilt), sin(tilt), 0};
    Random random = random_create((uint64_t)stress->value[STRESS_shape_seed], 0);
    for (int j = 1; j < n; ++j) {
        link_of(stress, j, main, side, &random, links[j]);
        total += double3_length(links[j]);
    }
    // Reading leaves apart what is by more than 1e-7 of the largest coordinate, after rounding.
    double least = fmax(1.1e-9, 4e-7 * (arm + length));
    for (int j = 0; j < n; ++j) {
        double size = j ? double3_length(links[j]) : 1,
               scaled = j ? fmax(size * length / total, least) / size : 0;
        for (int k = 0; k < 3; ++k) points[j][k] = (float)(x[k] += j ? scaled * links[j][k] : 0);
    }
}
