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
    fur_line_at(weave->line, weave->step, s, place);
    double share = s / weave->length;
    double radius = weave->radius * smooth(0.0, 0.5, share);
    double frizz = weave->frizz * smooth(0.0, 1.0, share);
    if (radius <= 0.0 && frizz <= 0.0) return;
    double at = fmin(s, FUR_STEPS * weave->step);
    fur_line_at(weave->side, weave->step, at, side);
    fur_line_at(weave->line, weave->step, s - 0.5 * weave->step, behind);
    fur_line_at(weave->line, weave->step, s + 0.5 * weave->step, ahead);
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
