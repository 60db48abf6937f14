// SPDX-License-Identifier: MIT
#include "gen/fur_weave.h"

#include "base/portable.h"

static double smooth(double low, double high, double x)
{
    double t = fmin(fmax((x - low) / (high - low), 0.0), 1.0);
    return t * t * (3.0 - 2.0 * t);
}

// Schlick 1994, "Fast alternatives to Perlin's bias and gain functions": from 0 to 1, with the
// value b at t = 0.5.
static double bias(double b, double t)
{
    return t / ((1.0 / b - 2.0) * (1.0 - t) + 1.0);
}

// Whether two guides lead the same way, within 60 degrees: else a parting lies between them.
static bool lead_alike(const FurGuides *guides, uint32_t a, uint32_t b)
{
    enum { ALONG = FUR_STEPS / 4 };
    Double3 u, v;
    double3_subtract(guides->line[a][ALONG], guides->line[a][0], u);
    double3_subtract(guides->line[b][ALONG], guides->line[b][0], v);
    return double3_dot(u, v) > 0.5 * double3_length(u) * double3_length(v);
}

// --- Between guides.

// The lines of the nearest guides from their roots on, by (1 - d/D)^2, d the distance of the root
// and D that of the first that does not count: it fades in and out where guides change.
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

// The nearest centre of a clump that leads the same way as the nearest guide.
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

// A strand's own direction at the root, which soon becomes that of its neighbours: within `reach`.
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

// Each step takes away what the line's direction has of the vector before it.
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

// Strands of a clump start from one side and wind by one phase and hand, so that they keep
// together.
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
        // Distances change by no more than the way.
        walk.clear -= walk.step;
        if (walk.clear < gap && !keep_out(&walk, vertex[v - 1], vertex[v])) stuck++;
    }
    return stuck;
}
