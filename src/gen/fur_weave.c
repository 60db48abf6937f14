// SPDX-License-Identifier: MIT
#include "gen/fur_weave.h"

#include "base/portable.h"

static double smooth(double low, double high, double x)
{
    double t = fmin(fmax((x - low) / (high - low), 0.0), 1.0);
    return t * t * (3.0 - 2.0 * t);
}

// Maps 0..1 to 0..1 with the value b at t = 0.5: Schlick 1994, "Fast alternatives to Perlin's bias
// and gain functions".
static double bias(double b, double t)
{
    return t / ((1.0 / b - 2.0) * (1.0 - t) + 1.0);
}

// Whether two guides point in directions less than 60 degrees apart. If not, a parting lies between
// them and they are not blended.
static bool lead_alike(const FurGuides *guides, uint32_t a, uint32_t b)
{
    enum { ALONG = FUR_STEPS / 4 };
    Double3 u, v;
    double3_subtract(guides->line[a][ALONG], guides->line[a][0], u);
    double3_subtract(guides->line[b][ALONG], guides->line[b][0], v);
    return double3_dot(u, v) > 0.5 * double3_length(u) * double3_length(v);
}

// --- Between guides.

// Blends the lines of the nearest guides, relative to their roots, with the weights (1 - d/D)^2: d
// is the distance to a guide's root, D the distance to the first guide that is not used. So a
// guide's weight is 0 where it enters or leaves the set.
static void blend(FurWeave *weave, const FurGuides *guides, const float at[3], Double3 start)
{
    enum { BLENDED = 4 };
    Neighbour found[BLENDED + 1];
    uint32_t count = nearest_find_at(&guides->nearest, at, found, BLENDED + 1);
    double weight[BLENDED + 1], sum = 0.0, far = sqrt(found[count - 1].square);
    for (uint32_t i = 0; i < count; i++) {
        double share = count > 1 && far > 0.0 ? 1.0 - sqrt(found[i].square) / far : i == 0;
        bool alike = lead_alike(guides, found[0].point, found[i].point);
        weight[i] = alike ? share * share : 0.0;
        sum += weight[i];
    }
    if (!(sum > 0.0)) weight[0] = sum = 1.0;
    for (int j = 0; j <= FUR_STEPS; j++) {
        double3_copy(start, weave->line[j]);
        for (uint32_t i = 0; i < count; i++) {
            const Double3 *line = (const Double3 *)guides->line[found[i].point];
            double3_add_scaled(weave->line[j], weight[i] / sum, line[j]);
            double3_add_scaled(weave->line[j], -weight[i] / sum, line[0]);
        }
    }
}

// The nearest centre of a clump whose direction is like that of the nearest guide.
static uint32_t find_clump(const FurGuides *guides, const float at[3])
{
    enum { TRIED = 6 };
    Neighbour guide = {0}, found[TRIED] = {0};
    nearest_find_at(&guides->nearest, at, &guide, 1);
    uint32_t count = nearest_find_at(&guides->centers, at, found, TRIED);
    for (uint32_t i = 0; i < count; i++)
        if (lead_alike(guides, guide.point, found[i].point)) return found[i].point;
    return found[0].point;
}

static void gather(FurWeave *weave, const FurRecipe *recipe, const Double3 *center, double share)
{
    for (int j = 0; j <= FUR_STEPS; j++) {
        double along = fmin(j * weave->step / weave->length, 1.0);
        double tip = bias(recipe->clump_profile, along);
        double amount = recipe->clump_root + (recipe->clump - recipe->clump_root) * tip;
        double3_mix(weave->line[j], center[j], share * amount, weave->line[j]);
    }
}

// Adds a random direction at the root. Its effect on the line's direction decays over the length
// `reach`, so that the strand then follows its neighbours.
static void scatter(FurWeave *weave, double amount, double reach, const Double3 normal,
                    Random *random)
{
    Double3 stray;
    random_direction(random, stray);
    double inward = double3_dot(stray, normal);
    if (inward < 0.0) double3_add_scaled(stray, -2.0 * inward, normal);
    for (int j = 0; j <= FUR_STEPS; j++) {
        double s = j * weave->step;
        double3_add_scaled(weave->line[j], amount * s * reach / (s + reach), stray);
    }
}

// --- Curls.

// Carries a side vector along the line (parallel transport): each step removes its part along the
// tangent.
static void carry_side(FurWeave *weave, const Double3 reference)
{
    Double3 side, tangent;
    double3_copy(reference, side);
    for (int j = 0; j <= FUR_STEPS; j++) {
        int from = j < FUR_STEPS ? j : j - 1;
        double3_subtract(weave->line[from + 1], weave->line[from], tangent);
        double3_normalize(tangent);
        double3_flatten(side, tangent);
        if (double3_normalize(side) < 1e-6) {
            Double3 other = {tangent[1], tangent[2], tangent[0]};
            double3_flatten(other, tangent);
            double3_normalize(other);
            double3_copy(other, side);
        }
        double3_copy(side, weave->side[j]);
    }
}

// Strands of a clump share the first side vector, the phase and the handedness of curls, so they
// stay together.
static void set_curl(FurWeave *weave, const FurRecipe *recipe, const FurGuides *guides,
                     uint32_t clump, Random *random)
{
    Random common = random_create((uint64_t)recipe->seed, 0x636c756d70000000u + clump); // "clump"
    Double3 along, across = {0.36, 0.48, 0.8}, reference;
    double3_subtract(guides->line[clump][FUR_STEPS / 8], guides->line[clump][0], along);
    double3_cross(along, across, reference);
    double3_normalize(reference);
    carry_side(weave, reference);
    weave->radius = recipe->curl_radius * (0.8 + 0.4 * random_real(&common));
    weave->frequency = recipe->curl_frequency;
    if (random_real(&common) < 0.5) weave->frequency = -weave->frequency;
    weave->phase = random_real(&common) + recipe->curl_disorder * random_real(random);
}

static void set_frizz(FurWeave *weave, const FurRecipe *recipe, double share, Random *random)
{
    weave->frizz = share * recipe->frizz;
    for (int i = 0; i < 4; i++) {
        weave->wave[i / 2][i % 2][0] =
            recipe->frizz_frequency * (0.5 + random_real(random)) * (1 + i % 2);
        weave->wave[i / 2][i % 2][1] = random_real(random);
    }
}

void fur_weave_create(FurWeave *weave, const FurRecipe *recipe, const FurGuides *guides,
                      uint32_t own_guide, const SurfacePoint *root, const Double3 normal,
                      double length, Random *random)
{
    Double3 start;
    float at[3];
    double3_copy(root->place, start);
    double3_add_scaled(start, recipe->root_lift, normal);
    for (int i = 0; i < 3; i++) at[i] = (float)root->place[i];
    *weave = (FurWeave){.step = guides->step, .length = length};
    bool flies = random_real(random) < recipe->flyaways;
    uint32_t clump = find_clump(guides, at);
    if (own_guide != FUR_NO_GUIDE)
        memcpy(weave->line, guides->line[own_guide], sizeof weave->line);
    else
        blend(weave, guides, at, start);
    if (recipe->scatter > 0.0)
        scatter(weave, recipe->scatter, fmin(0.5 * length, 0.02), normal, random);
    if (recipe->clump > 0.0 || recipe->clump_root > 0.0)
        gather(weave, recipe, (const Double3 *)guides->line[clump], flies ? 0.2 : 1.0);
    set_curl(weave, recipe, guides, clump, random);
    set_frizz(weave, recipe, flies ? 3.0 : 1.0, random);
}

void fur_weave_at(const FurWeave *weave, double s, Double3 place)
{
    Double3 side, other, behind, ahead, tangent;
    fur_guides_line_at(weave->line, weave->step, s, place);
    double share = s / weave->length;
    double radius = weave->radius * smooth(0.0, 0.5, share);
    double frizz = weave->frizz * smooth(0.0, 1.0, share);
    if (radius <= 0.0 && frizz <= 0.0) return;
    double at = fmin(s, FUR_STEPS * weave->step);
    fur_guides_line_at(weave->side, weave->step, at, side);
    fur_guides_line_at(weave->line, weave->step, s - 0.5 * weave->step, behind);
    fur_guides_line_at(weave->line, weave->step, s + 0.5 * weave->step, ahead);
    double3_subtract(ahead, behind, tangent);
    double3_normalize(tangent);
    double3_cross(tangent, side, other);
    double turns = weave->phase + weave->frequency * s, across[2];
    across[0] = radius * portable_cosine(turns);
    across[1] = radius * portable_sine(turns);
    for (int i = 0; i < 2; i++) {
        const double(*w)[2] = weave->wave[i];
        across[i] += frizz * (0.7 * portable_sine(w[0][0] * s + w[0][1]) +
                              0.3 * portable_sine(w[1][0] * s + w[1][1]));
    }
    double3_add_scaled(place, across[0], side);
    double3_add_scaled(place, across[1], other);
}

// --- Vertices.

// The first s beyond the given one where the curve is `step` away from its place at s: marches in
// small steps and interpolates the last one. Gives up after 40 steps if the curve never gets that
// far.
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
    double clear;       // m: lower bound of the last vertex's distance to the surface
    SurfacePoint under; // the point of the surface near the last vertex
} Walk;

static void aim(const Double3 from, const Double3 at, double step, Double3 to)
{
    Double3 direction;
    double3_subtract(at, from, direction);
    double3_normalize(direction);
    double3_copy(from, to);
    double3_add_scaled(to, step, direction);
}

// How far `at` must move to have the height `least`, and in which direction.
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

// Whether the end and the middle of the step are outside the surface. If not, `goal` is where the
// next attempt should aim.
static bool is_outside(Walk *walk, const Double3 from, const Double3 to, Double3 goal)
{
    Double3 middle, away = {0};
    double height;
    double lack = find_lack(walk, to, walk->gap, away, &walk->clear);
    if (lack <= 0.0 && walk->clear > walk->step) return true; // then the middle is outside, too
    double3_copy(to, goal);
    double3_add_scaled(goal, 1.02 * lack, away);
    if (lack > 0.0) return false;
    double3_mix(from, to, 0.5, middle);
    lack = find_lack(walk, middle, 0.3 * walk->gap, away, &height);
    double3_add_scaled(goal, 2.04 * lack, away);
    return lack <= 0.0;
}

// Turns the step from `from` to `to` until it is outside the surface. First it turns as little as
// possible. In a fold, where one side pushes the step into the other side, it then turns more and
// more towards the normal. False if nothing helped.
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

uint32_t fur_weave_cut(const FurWeave *weave, const Surface *surface, const SurfacePoint *root,
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
        // A distance to the surface changes by at most the length of the step.
        walk.clear -= walk.step;
        if (walk.clear < gap && !keep_out(&walk, vertex[v - 1], vertex[v])) stuck++;
    }
    return stuck;
}
