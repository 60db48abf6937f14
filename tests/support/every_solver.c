// SPDX-License-Identifier: MIT
#include "support/every_solver.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// Exceptions: the solver, the number of particles from which on it breaks the promise, and the
// reason. `variant` NULL: all variants.
static const struct {
    const char *algo, *variant;
    unsigned lacks;
    int from;
    const char *why;
} EXCEPTIONS[] = {
    {"split", NULL, ENERGY, 0, "only its tip has mass (test_solver_split): the strand follows"},
    {"emulation", "thesis", REST | ENERGY | TURN, 0, "unstable without much drag, as published"},
    {"spring", NULL, RIGID, 0, "its segments are springs"},
    {"rope", NULL, RIGID, 0, "its iterations leave it stretched"},
    {"tressfx", "tressfx4", LENGTHS | REST | RIGID, 0,
     "two passes leave it stretched under gravity"},
};

unsigned every_solver_promises(const SolverType *type, const char *variant, int n)
{
    unsigned all = LENGTHS | REST | ENERGY | UNIT | ORDER | TURN | RIGID;
    for (size_t i = 0; i < sizeof EXCEPTIONS / sizeof *EXCEPTIONS; ++i)
        if (strcmp(EXCEPTIONS[i].algo, type->name) == 0 && n >= EXCEPTIONS[i].from &&
            (!EXCEPTIONS[i].variant || strcmp(EXCEPTIONS[i].variant, variant) == 0))
            all &= ~EXCEPTIONS[i].lacks;
    return all;
}

void every_solver_run(SolverCheck check, unsigned needed)
{
    const char *only = getenv("TEST_ALGO");
    for (const SolverType *const *type = SOLVER_TYPES; *type; ++type)
        for (int v = 0; !solver_is_static(*type) && (v == 0 || (*type)->variants[v]); ++v) {
            const char *variant = (*type)->variants[v] ? (*type)->variants[v] : "";
            if (only && strcmp(only, (*type)->name) != 0) continue;
            if ((every_solver_promises(*type, variant, 0) & needed) == needed)
                check(*type, variant);
        }
}

void every_solver_require(bool holds, const SolverType *type, const char *variant,
                          const char *format, double value)
{
    char text[128];
    snprintf(text, sizeof text, format, value);
    if (!holds) fail_msg("%s %s: %s", type->name, variant, text);
}

// A coordinate's error is at most 2^-24 of its size. So a difference has at most twice this error,
// and a length sqrt(3) times as much.
double every_solver_length_error(const Vec *style, const Vec *q, int n)
{
    double worst = 0;
    for (int j = 1; j < n; ++j) {
        Vec before, now;
        double size = 0;
        for (int k = 0; k < 3; ++k) {
            before[k] = (double)(float)style[j][k] - (double)(float)style[j - 1][k];
            now[k] = q[j][k] - q[j - 1][k];
            size = fmax(size, fabs(q[j][k]));
        }
        double length = vec_norm(before), rounding = 2 * 1.8 * 0x1p-24 * size;
        worst = fmax(worst, (fabs(vec_norm(now) - length) - rounding) / length);
    }
    return worst;
}
