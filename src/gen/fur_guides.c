// SPDX-License-Identifier: MIT
#include "gen/fur_guides.h"

#include "base/portable.h"
#include "base/random.h"

#include <stdlib.h>

static const double EXTRA = 1.2;
static const double RISE = 100.0; // rad/m: how fast hair that lies too low turns upwards

void fur_guides_line_at(const Double3 *line, double step, double s, Double3 place)
{
    double at = s / step;
    int i = (int)fmin(fmax(floor(at), 0.0), FUR_STEPS - 1);
    double3_mix(line[i], line[i + 1], at - i, place);
}

// A guide while it grows.
typedef struct Shoot {
    const FurRecipe *recipe;
    const Surface *surface;
    const FurComb *comb;
    double step, volume;
    double height, goal; // m: distance of its end from the surface, and the wanted distance
    SurfacePoint under;  // the point on the surface nearest to its end
    Double3 direction;
} Shoot;

// Lifts the combed direction towards the normal by lift_deg. A combed direction may be shorter than
// 1; then the normal has more weight and hair stands up more.
static void set_first_direction(Shoot *shoot, const Double3 normal)
{
    Double3 combed, direction = {0};
    fur_map_comb_at(shoot->comb, shoot->surface, &shoot->under, normal, combed);
    double turns = shoot->recipe->lift_deg / 360.0;
    double3_add_scaled(direction, portable_sine(turns), normal);
    double3_add_scaled(direction, portable_cosine(turns), combed);
    if (double3_normalize(direction) < 1e-3) double3_copy(normal, direction);
    double3_copy(direction, shoot->direction);
}

// The strength of the comb at arc length s. It fades to 0 over the second half of comb_reach.
static double comb_share(const FurRecipe *recipe, double s)
{
    if (recipe->comb_reach <= 0.0) return 1.0;
    double t = fmin(fmax(2.0 * s / recipe->comb_reach - 1.0, 0.0), 1.0);
    return 1.0 - t * t * (3.0 - 2.0 * t);
}

static void add_noise(const Shoot *shoot, const Double3 at, Double3 change)
{
    const FurRecipe *recipe = shoot->recipe;
    Double3 p;
    for (int i = 0; i < 3; i++) p[i] = at[i] / recipe->noise_size + 1000.0 * recipe->seed;
    for (int i = 0; i < 3; i++)
        change[i] += recipe->noise / recipe->noise_size * shoot->step *
                     portable_noise(p[0] + 37.0 * i, p[1], p[2]);
}

static void turn(Shoot *shoot, const Double3 at, double s)
{
    const FurRecipe *recipe = shoot->recipe;
    double *d = shoot->direction;
    Double3 normal, combed, change = {0}, down = {0.0, -1.0, 0.0};
    surface_normal(shoot->surface, &shoot->under, normal);
    if (recipe->lie > 0.0) {
        fur_map_comb_at(shoot->comb, shoot->surface, &shoot->under, normal, combed);
        double share = comb_share(recipe, s) * double3_length(combed);
        double high = fmax(shoot->height - shoot->goal, 0.0);
        double3_add_scaled(combed, -fmin(high / (2.0 * recipe->lie), 1.0), normal);
        double3_subtract(combed, d, change);
        for (int i = 0; i < 3; i++) change[i] *= share * shoot->step / (shoot->step + recipe->lie);
    }
    double3_flatten(down, d);
    double3_add_scaled(change, recipe->gravity_bend * shoot->step, down);
    if (shoot->volume > 0.0 && shoot->height < shoot->goal)
        double3_add_scaled(change,
                           RISE * shoot->step * (1.0 - shoot->height / shoot->goal) *
                               (1.0 + recipe->gravity_bend * shoot->goal),
                           normal);
    if (recipe->noise > 0.0) add_noise(shoot, at, change);
    double3_add_scaled(d, 1.0, change);
    double3_normalize(d);
}

// Makes one step in the shoot's direction. If the end of the step would be inside the surface or
// clearly nearer to it than `from`, the inward part of the direction is removed and the step is
// tried again, up to four times, because the nearest point may then lie on another side. The
// direction never gains an outward part, so a shoot slides along an obstacle and does not bounce
// off.
static void step(Shoot *shoot, const Double3 from, Double3 to)
{
    double least = fmax(0.9 * fmin(shoot->height, shoot->goal), shoot->recipe->root_lift);
    Double3 way;
    double3_copy(shoot->direction, way);
    for (int attempt = 0;; attempt++) {
        Double3 away;
        double3_copy(from, to);
        double3_add_scaled(to, shoot->step, way);
        shoot->height = surface_nearest(shoot->surface, to, &shoot->under);
        if (shoot->height >= least || attempt == 3) break;
        double3_subtract(to, shoot->under.place, away);
        if (double3_normalize(away) < 1e-9)
            surface_normal(shoot->surface, &shoot->under, away);
        else if (shoot->height < 0.0)
            for (int i = 0; i < 3; i++) away[i] = -away[i];
        double3_add_scaled(to, least - shoot->height, away);
        double3_subtract(to, from, way);
        double3_normalize(way);
        if (double3_dot(shoot->direction, away) < 0.0) double3_flatten(shoot->direction, away);
    }
    if (double3_normalize(shoot->direction) < 1e-3) double3_copy(way, shoot->direction);
}

static void grow(Shoot *shoot, const SurfacePoint *root, Double3 *line)
{
    Double3 normal;
    surface_normal(shoot->surface, root, normal);
    shoot->under = *root;
    set_first_direction(shoot, normal);
    double3_copy(root->place, line[0]);
    double3_add_scaled(line[0], shoot->recipe->root_lift, normal);
    shoot->height = shoot->recipe->root_lift;
    for (int i = 0; i < FUR_STEPS; i++) {
        double s = (i + 1) * shoot->step, far = s / (s + 4.0 * shoot->volume + 1e-9);
        shoot->goal = shoot->recipe->root_lift + shoot->volume * far;
        if (i > 0) turn(shoot, line[i], s);
        step(shoot, line[i], line[i + 1]);
    }
}

Result fur_guides_create(FurGuides *guides, const FurRecipe *recipe, const Surface *surface,
                         const FurComb *comb, const SurfacePoint *roots, uint32_t count,
                         Error *error)
{
    *guides = (FurGuides){.count = count, .step = EXTRA * recipe->length / FUR_STEPS};
    guides->line = malloc(count * sizeof *guides->line);
    guides->root = malloc(count * sizeof *guides->root);
    guides->clumps = recipe->clumps > 0 ? (uint32_t)recipe->clumps : count;
    if (guides->clumps > count) guides->clumps = count;
    bool good = guides->line && guides->root;
    for (uint32_t g = 0; good && g < count; g++) {
        Random random = random_create((uint64_t)recipe->seed, 0x6775696465000000u + g); // "guide"
        Shoot shoot = {.recipe = recipe, .surface = surface, .comb = comb, .step = guides->step};
        shoot.volume = recipe->volume * (0.4 + 0.6 * random_real(&random));
        grow(&shoot, &roots[g], guides->line[g]);
        for (int i = 0; i < 3; i++) guides->root[g][i] = (float)roots[g].place[i];
    }
    const float(*root)[3] = (const float(*)[3])guides->root;
    if (good && nearest_create(&guides->nearest, root, count, NULL) == RESULT_OK &&
        nearest_create(&guides->centers, root, guides->clumps, NULL) == RESULT_OK)
        return RESULT_OK;
    fur_guides_destroy(guides);
    return error_set(error, RESULT_FAILED, "no memory for %u guides", count);
}

void fur_guides_destroy(FurGuides *guides)
{
    free(guides->line);
    free(guides->root);
    nearest_destroy(&guides->nearest);
    nearest_destroy(&guides->centers);
    *guides = (FurGuides){0};
}
