// SPDX-License-Identifier: MIT
#include "gen/fur_roots.h"

#include "base/nearest.h"
#include "base/random.h"

#include <stdlib.h>

// --- Random points by area.

typedef struct Dice {
    const Surface *surface;
    double *sum; // [triangle_count]: area of all triangles up to and with this one
    Random random;
} Dice;

static bool begin_dice(Dice *dice, const Surface *surface, uint64_t seed)
{
    double total = 0.0;
    *dice = (Dice){.surface = surface, .random = random_create(seed, 0x6675726f6f74)}; // "furoot"
    dice->sum = malloc(surface->triangle_count * sizeof *dice->sum);
    for (uint32_t i = 0; dice->sum && i < surface->triangle_count; i++) {
        Double3 normal;
        total += surface_triangle(surface->mesh, surface->triangle[i], normal);
        dice->sum[i] = total;
    }
    return dice->sum != NULL;
}

// Picks a triangle with probability proportional to its area, then a uniformly distributed point in
// it: with uniform s and t, the barycentric weights 1 - sqrt(s) and t sqrt(s) (Turk 1990,
// "Generating random points in triangles").
static SurfacePoint throw_dice(Dice *dice)
{
    uint32_t low = 0, high = dice->surface->triangle_count - 1;
    double pick = random_real(&dice->random) * dice->sum[high];
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (dice->sum[middle] > pick)
            high = middle;
        else
            low = middle + 1;
    }
    double root = sqrt(random_real(&dice->random)), t = random_real(&dice->random);
    return surface_at(dice->surface, dice->surface->triangle[low],
                      (Double3){1.0 - root, root * (1.0 - t), root * t});
}

static Result fail_density(double value, const SurfacePoint *at, const char *name, Error *error)
{
    return error_set(error, RESULT_USAGE,
                     "--density: %g at %.3g, %.3g, %.3g on %s: expected a finite number", value,
                     at->place[0], at->place[1], at->place[2], name);
}

// Samples the density at random points of the surface. Returns its largest value and its mean.
static Result find_densest(Dice *dice, const FurMap *density, const char *name, double *most,
                           double *mean, Error *error)
{
    enum { PROBES = 20000 };
    *most = *mean = 0.0;
    for (int i = 0; i < PROBES; i++) {
        SurfacePoint point = throw_dice(dice);
        double value = fur_map_at(density, dice->surface, &point);
        if (!isfinite(value)) return fail_density(value, &point, name, error);
        *most = fmax(*most, value);
        *mean += fmax(value, 0.0) / PROBES;
    }
    if (*most > 0.0) return RESULT_OK;
    return error_set(error, RESULT_USAGE,
                     "--density: nowhere above 0 on %s: expected a number above 0 in some places",
                     name);
}

Result fur_roots_measure(const Surface *surface, const FurMap *density, uint32_t seed,
                         const char *name, double *area, Error *error)
{
    Dice dice;
    double most, mean;
    if (!begin_dice(&dice, surface, seed))
        return error_set(error, RESULT_FAILED, "%s: no memory", name);
    Result result = find_densest(&dice, density, name, &most, &mean, error);
    *area = surface->area * mean;
    free(dice.sum);
    return result;
}

// --- Sample elimination (Yuksel 2015).

typedef struct Crowd {
    uint32_t count;
    float (*point)[3]; // the points in the k-d tree
    double *reach;     // half the distance to neighbours in an even distribution
    double *weight;    // crowding, -1 for eliminated points
    uint32_t *heap;    // the most crowded first
    uint32_t *place;   // index of each point in the heap
    Nearest nearest;
} Crowd;

enum { NEIGHBOURS = 20 }; // within twice the reach there are 14.5 of four times as many candidates

static void crowd_destroy(Crowd *crowd)
{
    free(crowd->point);
    free(crowd->reach);
    free(crowd->weight);
    free(crowd->heap);
    free(crowd->place);
    nearest_destroy(&crowd->nearest);
}

// The weight of a neighbour at the distance d: (1 - d / (2 r))^8, where r is the mean reach of both
// points.
static double crowding(const Crowd *crowd, uint32_t a, const Neighbour *b)
{
    double share = 1.0 - sqrt(b->square) / (crowd->reach[a] + crowd->reach[b->point]);
    if (share <= 0.0) return 0.0;
    share *= share;
    share *= share;
    return share * share;
}

static bool goes_first(const Crowd *crowd, uint32_t a, uint32_t b)
{
    if (crowd->weight[a] != crowd->weight[b]) return crowd->weight[a] > crowd->weight[b];
    return a < b;
}

static void put(Crowd *crowd, uint32_t at, uint32_t item)
{
    crowd->heap[at] = item;
    crowd->place[item] = at;
}

static void sink(Crowd *crowd, uint32_t at, uint32_t count)
{
    uint32_t item = crowd->heap[at];
    for (uint32_t child; (child = 2 * at + 1) < count; at = child) {
        if (child + 1 < count && goes_first(crowd, crowd->heap[child + 1], crowd->heap[child]))
            child++;
        if (!goes_first(crowd, crowd->heap[child], item)) break;
        put(crowd, at, crowd->heap[child]);
    }
    put(crowd, at, item);
}

// Removes the point with the largest weight until `left` points remain. Removing a point can only
// reduce the weights of others, so heap items only sink.
static void eliminate(Crowd *crowd, uint32_t left)
{
    Neighbour found[NEIGHBOURS];
    for (uint32_t i = 0; i < crowd->count; i++) {
        uint32_t count = nearest_find(&crowd->nearest, i, found, NEIGHBOURS);
        for (uint32_t k = 0; k < count; k++) crowd->weight[i] += crowding(crowd, i, &found[k]);
        put(crowd, i, i);
    }
    for (uint32_t i = crowd->count / 2; i-- > 0;) sink(crowd, i, crowd->count);
    for (uint32_t count = crowd->count; count > left;) {
        uint32_t gone = crowd->heap[0];
        put(crowd, 0, crowd->heap[--count]);
        sink(crowd, 0, count);
        crowd->weight[gone] = -1.0;
        uint32_t around = nearest_find(&crowd->nearest, gone, found, NEIGHBOURS);
        for (uint32_t k = 0; k < around; k++) {
            uint32_t other = found[k].point;
            if (crowd->weight[other] < 0.0) continue;
            crowd->weight[other] =
                fmax(crowd->weight[other] - crowding(crowd, gone, &found[k]), 0.0);
            sink(crowd, crowd->place[other], count);
        }
    }
}

static bool crowd_create(Crowd *crowd, const SurfacePoint *points, uint32_t count)
{
    *crowd = (Crowd){.count = count};
    crowd->point = malloc(count * sizeof *crowd->point);
    crowd->reach = malloc(count * sizeof *crowd->reach);
    crowd->weight = calloc(count, sizeof *crowd->weight);
    crowd->heap = malloc(count * sizeof *crowd->heap);
    crowd->place = malloc(count * sizeof *crowd->place);
    if (!crowd->point || !crowd->reach || !crowd->weight || !crowd->heap || !crowd->place)
        return false;
    for (uint32_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++) crowd->point[i][k] = (float)points[i].place[k];
    return nearest_create(&crowd->nearest, (const float(*)[3])crowd->point, count, NULL) ==
           RESULT_OK;
}

// Estimates half the distance between neighbours if `left` points remain, evenly distributed. An
// even point has six neighbours; their distances grow with the square root of count / left.
static void guess_reach(Crowd *crowd, uint32_t left)
{
    for (uint32_t i = 0; i < crowd->count; i++) {
        Neighbour found[6];
        double sum = 0.0;
        uint32_t count = nearest_find(&crowd->nearest, i, found, 6);
        for (uint32_t k = 0; k < count; k++) sum += sqrt(found[k].square) / count;
        crowd->reach[i] = 0.5 * sum * sqrt((double)crowd->count / left);
    }
}

// Moves the remaining points to the front.
static void part(const Crowd *crowd, SurfacePoint *points)
{
    for (uint32_t i = 0, front = 0; i < crowd->count; i++) {
        if (crowd->weight[i] < 0.0) continue;
        SurfacePoint kept = points[front];
        points[front++] = points[i];
        points[i] = kept;
    }
}

static void shuffle(SurfacePoint *points, uint32_t count, Random *random)
{
    for (uint32_t i = count; i > 1; i--) {
        uint32_t j = random_below(random, i);
        SurfacePoint kept = points[i - 1];
        points[i - 1] = points[j];
        points[j] = kept;
    }
}

Result fur_roots_order(SurfacePoint *roots, uint32_t count, uint32_t first, uint32_t seed,
                       Error *error)
{
    Random random = random_create(seed, 0x6f72646572); // "order"
    // Keep a quarter of the points in each round. Neighbours are looked up once a round, so some of
    // them must still exist at its end.
    for (uint32_t now = count, left; first > 0 && now > first; now = left) {
        Crowd crowd;
        left = now / 4 > first ? now / 4 : first;
        bool good = crowd_create(&crowd, roots, now);
        if (good) {
            guess_reach(&crowd, left);
            eliminate(&crowd, left);
            part(&crowd, roots);
        }
        crowd_destroy(&crowd);
        if (!good) return error_set(error, RESULT_FAILED, "no memory for %u roots", count);
    }
    shuffle(roots, first, &random);
    shuffle(roots + first, count - first, &random);
    return RESULT_OK;
}

// --- Roots.

// Picks random points with probability proportional to the density (rejection sampling).
static Result pick(SurfacePoint *points, double *value, uint32_t count, Dice *dice,
                   const FurMap *density, double most, const char *name, Error *error)
{
    for (uint32_t i = 0; i < count;) {
        points[i] = throw_dice(dice);
        double here = fur_map_at(density, dice->surface, &points[i]);
        if (!isfinite(here)) return fail_density(here, &points[i], name, error);
        value[i] = fmin(here, most);
        if (random_real(&dice->random) * most < value[i]) i++;
    }
    return RESULT_OK;
}

enum { CANDIDATES = 4 };

// In a hexagonal grid with the area A for each root, neighbours are at the distance sqrt(2 A /
// sqrt(3)). The reach is half of it.
static Result thin(SurfacePoint *points, double *value, uint32_t count, double area, Error *error)
{
    Crowd crowd;
    bool good = crowd_create(&crowd, points, CANDIDATES * count);
    for (uint32_t i = 0; good && i < crowd.count; i++)
        crowd.reach[i] = 0.5 * sqrt(2.0 / sqrt(3.0) * area / (value[i] * count));
    if (good) {
        eliminate(&crowd, count);
        part(&crowd, points);
    }
    crowd_destroy(&crowd);
    return good ? RESULT_OK : error_set(error, RESULT_FAILED, "no memory for %u roots", count);
}

Result fur_roots_make(SurfacePoint *roots, uint32_t count, const Surface *surface,
                      const FurMap *density, uint32_t seed, const char *name, Error *error)
{
    Dice dice;
    double most = 0.0, mean = 0.0;
    SurfacePoint *points = malloc(CANDIDATES * (size_t)count * sizeof *points);
    double *value = malloc(CANDIDATES * (size_t)count * sizeof *value);
    Result result = RESULT_OK;
    if (!begin_dice(&dice, surface, seed) || !points || !value)
        result = error_set(error, RESULT_FAILED, "no memory for %u roots", count);
    THEN(result, find_densest(&dice, density, name, &most, &mean, error));
    THEN(result, pick(points, value, CANDIDATES * count, &dice, density, most, name, error));
    THEN(result, thin(points, value, count, surface->area * mean, error));
    if (result == RESULT_OK) memcpy(roots, points, count * sizeof *roots);
    free(dice.sum);
    free(value);
    free(points);
    return result;
}
