// SPDX-License-Identifier: MIT
#include "gen/fur_cut.h"

// Where the curve is first `step` away from where it was at s, beyond s: in small steps, the last
// one by its share. A curve that never is that far away ends the search.
static double find_next(const FurWeave *weave, double s, double step)
{
    Double3 from, to;
    double small = step / 5.0, turns = fabs(weave->frequency), end = s + 40.0 * step;
    double before, now = 0.0;
    if (weave->radius > 0.0 && small * turns > 1.0 / 16.0) small = 1.0 / (16.0 * turns);
    fur_weave_at(weave, s, from);
    do {
        s += small;
        before = now;
        fur_weave_at(weave, s, to);
        now = double3_distance(from, to);
    } while (now < step && s < end);
    return now > before ? s - small * fmax(now - step, 0.0) / (now - before) : s;
}

typedef struct Walk {
    const Surface *surface;
    double gap, step;
    double clear;       // m: at least so far is the last vertex from the surface
    SurfacePoint under; // near the last vertex
} Walk;

static void aim(const Double3 from, const Double3 at, double step, Double3 to)
{
    Double3 direction;
    double3_subtract(at, from, direction);
    double3_normalize(direction);
    double3_copy(from, to);
    double3_add_scaled(to, step, direction);
}

// How far `at` would have to move for its height to be `least`, and in which direction.
static double find_lack(Walk *walk, const Double3 at, double least, Double3 away, double *height)
{
    *height = surface_nearest(walk->surface, at, &walk->under);
    if (*height >= least) return 0.0;
    double3_subtract(at, walk->under.place, away);
    if (double3_normalize(away) < 1e-9)
        surface_normal(walk->surface, &walk->under, away);
    else if (*height < 0.0)
        for (int i = 0; i < 3; i++) away[i] = -away[i];
    return least - *height;
}

// Whether the end of the step and its middle are outside; else a goal for the next attempt.
static bool is_outside(Walk *walk, const Double3 from, const Double3 to, Double3 goal)
{
    Double3 middle, away = {0};
    double height;
    double lack = find_lack(walk, to, walk->gap, away, &walk->clear);
    if (lack <= 0.0 && walk->clear > walk->step) return true; // so is the middle
    double3_copy(to, goal);
    double3_add_scaled(goal, 1.02 * lack, away);
    if (lack > 0.0) return false;
    double3_mix(from, to, 0.5, middle);
    lack = find_lack(walk, middle, 0.3 * walk->gap, away, &height);
    double3_add_scaled(goal, 2.04 * lack, away);
    return lack <= 0.0;
}

// Turns the step from `from` to `to` until it is outside: by as little as that takes or, in a fold
// of the surface where one side pushes it into the other, more and more upright.
static bool keep_out(Walk *walk, const Double3 from, Double3 to)
{
    enum { ATTEMPTS = 12, UPRIGHT = 8 };
    Double3 goal, up = {0}, first;
    double height;
    double3_copy(to, first);
    for (int attempt = 0; attempt < ATTEMPTS; attempt++) {
        if (is_outside(walk, from, to, goal)) return true;
        aim(from, goal, walk->step, to);
    }
    find_lack(walk, from, INFINITY, up, &height);
    double3_add_scaled(up, 1.0, from);
    for (int k = 1; k <= UPRIGHT; k++) {
        Double3 end;
        aim(from, up, walk->step, end);
        double3_mix(first, end, k / (double)UPRIGHT, goal);
        aim(from, goal, walk->step, to);
        if (is_outside(walk, from, to, goal)) return true;
    }
    return false;
}

uint32_t fur_cut(const FurWeave *weave, const Surface *surface, const SurfacePoint *root,
                 double gap, double length, Double3 *vertex, uint32_t count)
{
    Walk walk = {
        .surface = surface, .gap = gap, .step = length / (count - 1), .under = *root, .clear = 0.0};
    uint32_t stuck = 0;
    double s = 0.0;
    fur_weave_at(weave, 0.0, vertex[0]);
    for (uint32_t v = 1; v < count; v++) {
        Double3 at;
        s = find_next(weave, s, walk.step);
        fur_weave_at(weave, s, at);
        aim(vertex[v - 1], at, walk.step, vertex[v]);
        // Distances change by no more than the way.
        walk.clear -= walk.step;
        if (walk.clear < gap && !keep_out(&walk, vertex[v - 1], vertex[v])) stuck++;
    }
    return stuck;
}
