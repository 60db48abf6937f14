// SPDX-License-Identifier: MIT
#include "scene/forces.h"
#include "base/double3.h"
#include "scene/schedule.h"

#include <cglm/cglm.h>

#include <math.h>
#include <string.h>

static bool blows(const Scene *scene)
{
    const float *w = scene->run.wind;
    return track_is_given(&scene->wind) || w[0] != 0 || w[1] != 0 || w[2] != 0;
}

// Three sines whose common period is 100 times the first one's, run.gust_period, so that gusts do
// not repeat soon. The weights add up to 1. With run.gust_repeat each rate is moved to the nearest
// one that has a whole number of periods in that time.
static double gust_at(const RunParams *run, double time)
{
    static const struct {
        double rate, weight, phase;
    } SINES[] = {{1, 0.5, 0}, {2.31, 0.3, 1.3}, {5.17, 0.2, 2.1}};
    double gust = 0, repeat = (double)run->gust_repeat;
    for (int i = 0; i < 3; ++i) {
        double rate = SINES[i].rate / (double)run->gust_period; // 1/s
        if (repeat > 0) rate = fmax(1, round(rate * repeat)) / repeat;
        gust += SINES[i].weight * sin(2 * 3.14159265358979323846 * rate * time + SINES[i].phase);
    }
    return gust;
}

// Two unit vectors perpendicular to `main` and to each other.
static void perpendiculars(const vec3 main, vec3 a, vec3 b)
{
    vec3 n;
    glm_vec3_normalize_to((float *)main, n);
    glm_vec3_cross(n, fabsf(n[1]) < 0.9f ? (vec3){0, 1, 0} : (vec3){1, 0, 0}, a);
    glm_vec3_normalize(a);
    glm_vec3_cross(n, a, b);
}

// Turns the main wind by the spread to four sides. strand_wind (forces.glsl) mixes wind 0 with 1, 2
// with 3, and then both results; 0 and 3 are opposite corners of the square. A wind turned by t
// keeps cos t of its speed in the main direction, so it is divided by cos t to keep the mean.
static void spread_wind(Forces *forces, const vec3 main, float spread_deg)
{
    vec3 a = {0}, b = {0};
    float side = glm_vec3_norm((float *)main) * tanf(glm_rad(fminf(spread_deg, 89.0f)));
    perpendiculars(main, a, b);
    for (int i = 0; i < 4; ++i) {
        float sign_a = i & 1 ? 1 : -1, sign_b = i & 2 ? 1 : -1;
        for (int k = 0; k < 3; ++k)
            forces->wind[i][k] = main[k] + side * 0.70710678f * (sign_a * a[k] + sign_b * b[k]);
    }
}

void forces_evaluate(Forces *forces, const Scene *scene, double time)
{
    const double begun = fmax(time, 0); // the scene's clock stands while the hair settles
    *forces = (Forces){0};
    track_evaluate_or(&scene->gravity, scene->run.gravity, begun, forces->gravity);
    if (!blows(scene)) return;
    vec3 main = {0};
    track_evaluate_or(&scene->wind, scene->run.wind, begun, main);
    glm_vec3_scale(main, (float)(1 + (double)scene->run.gust * gust_at(&scene->run, time)), main);
    if (glm_vec3_norm2(main) > 0) spread_wind(forces, main, scene->run.wind_spread);
}

static double greatest_length(const RunParams *run, const Track *track, const float constant[3])
{
    if (track_is_given(track))
        return track_extremes(track, run->frames + 1, schedule_frame_time(run, run->frames)).length;
    Double3 vector;
    double3_from_float(constant, vector);
    return double3_length(vector);
}

ForcesMost forces_most(const Scene *scene)
{
    const RunParams *run = &scene->run;
    double wind = greatest_length(run, &scene->wind, run->wind);
    return (ForcesMost){.gravity = greatest_length(run, &scene->gravity, run->gravity),
                        .wind = (1 + (double)run->gust) * wind};
}

bool forces_are_constant(const Scene *scene)
{
    return track_is_still(&scene->gravity) && track_is_still(&scene->wind) &&
           (!blows(scene) || scene->run.gust == 0);
}
