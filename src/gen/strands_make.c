// SPDX-License-Identifier: MIT
#include "gen/strands_make.h"

#include "base/activity.h"
#include "base/double3.h"
#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "base/random.h"
#include "base/suggest.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

static double ramp(double low, double high, double x)
{
    double t = fmin(fmax((x - low) / (high - low), 0.0), 1.0);
    return t * t * (3.0 - 2.0 * t);
}

// The data of one strand while it grows.
typedef struct Seedling {
    const StrandsRecipe *recipe;
    Double3 root, direction; // m; direction of the root from the origin
    Double3 normal;          // of the surface at the root
    double length, phase;
    Random random;
} Seedling;

static Seedling begin_strand(const StrandsRecipe *recipe, const ScalpRoot *root, uint32_t s)
{
    Seedling seedling = {.recipe = recipe, .random = random_create(recipe->seed, s)};
    double3_copy(root->direction, seedling.direction);
    double3_copy(root->normal, seedling.normal);
    double3_add_scaled(seedling.root, root->radius, root->direction);
    seedling.length =
        recipe->length * (1.0 - recipe->length_variation * random_real(&seedling.random));
    // The phase varies slowly over the head, so neighbours curl in step.
    const double *d = seedling.direction;
    double slow = 1.7 * sin(3.1 * d[0] + 1.0) + 1.3 * sin(4.3 * d[2]) + 1.1 * sin(3.7 * d[1] + 2.0);
    seedling.phase = slow + 2.0 * PI * recipe->curl_disorder * random_real(&seedling.random);
    return seedling;
}

// --- Random strands, as in the thesis.

static void grow_random(Seedling *seedling, Double3 *points)
{
    uint32_t count = seedling->recipe->vertices;
    double3_copy(seedling->root, points[0]);
    for (uint32_t v = 1; v < count; v++) {
        Double3 direction;
        random_direction(&seedling->random, direction);
        double3_copy(points[v - 1], points[v]);
        double3_add_scaled(points[v], seedling->length / (count - 1), direction);
    }
}

// --- Long hair.

// The direction that the comb pulls at a place: back, and from the parting in front to the sides;
// further along the strand (`share`) down and slightly outwards.
static void comb(const Seedling *seedling, const Double3 at, double share, Double3 pull)
{
    const double *root = seedling->direction;
    double fallen = ramp(0.0, 0.3, share), front = ramp(-0.7, 0.5, root[2]);
    Double3 down = {0.6 * at[0], -1.0, 0.6 * at[2] - 0.5 * ramp(0.0, 0.08, at[2])};
    Double3 back = {0.75 * front * tanh(root[0] / 0.12), -0.25, -0.8};
    for (int i = 0; i < 3; i++) pull[i] = (1.0 - fallen) * back[i] + fallen * down[i];
    double3_normalize(pull);
}

// Adds a segment of the given length from `from` along `direction`. If its end is less than `gap`
// outside the head, it is moved outwards; `direction` becomes the direction of the resulting
// segment.
static void grow_segment(const Seedling *seedling, const Double3 from, double segment, double gap,
                         Double3 direction, Double3 to)
{
    double3_copy(from, to);
    double3_add_scaled(to, segment, direction);
    scalp_lift(seedling->recipe->shape, to, gap);
    double3_subtract(to, from, direction);
    double3_normalize(direction);
    double3_copy(from, to);
    double3_add_scaled(to, segment, direction);
}

// Grows a strand of this length that starts along the normal and bends towards the comb's pull.
static void grow_combed(const Seedling *seedling, double length, Double3 *points)
{
    uint32_t count = seedling->recipe->vertices;
    double segment = length / (count - 1), lift = 0.006 + 0.010 * seedling->normal[1];
    Double3 direction;
    double3_copy(seedling->normal, direction);
    double3_copy(seedling->root, points[0]);
    for (uint32_t v = 1; v < count; v++) {
        double share = v / (double)(count - 1);
        Double3 pull;
        comb(seedling, points[v - 1], share, pull);
        // Bending over a fixed length makes the shape independent of the number of vertices.
        double3_add_scaled(direction, 1.0 - exp(-segment / 0.012), pull);
        double3_normalize(direction);
        grow_segment(seedling, points[v - 1], segment, lift * ramp(0.0, 0.03, share * length),
                     direction, points[v]);
    }
}

static double measure(const Double3 *points, uint32_t count)
{
    double length = 0.0;
    for (uint32_t v = 1; v < count; v++) length += double3_distance(points[v], points[v - 1]);
    return length;
}

// Winds a smooth strand into curls: moves each vertex sideways in a frame that is transported along
// the strand.
static void wind(const Seedling *seedling, Double3 *points)
{
    const StrandsRecipe *recipe = seedling->recipe;
    Double3 side = {seedling->normal[1], seedling->normal[2], seedling->normal[0]}, before;
    double3_copy(points[0], before);
    for (uint32_t v = 1; v < recipe->vertices; v++) {
        double share = v / (double)(recipe->vertices - 1);
        Double3 tangent, other;
        double3_subtract(points[v], before, tangent);
        double3_copy(points[v], before);
        double3_normalize(tangent);
        double3_flatten(side, tangent);
        double3_normalize(side);
        double3_cross(tangent, side, other);
        double angle = seedling->phase + 2.0 * PI * recipe->curl_turns * share;
        double radius = recipe->curl_radius * ramp(0.0, 0.6, share);
        double3_add_scaled(points[v], radius * cos(angle), side);
        double3_add_scaled(points[v], radius * sin(angle), other);
        scalp_lift(recipe->shape, points[v], 0.002 * ramp(0.0, 0.1, share));
    }
}

// Winding makes a strand longer, so the smooth strand is shortened until the wound strand has the
// wanted length.
static void grow_curls(const Seedling *seedling, Double3 *points)
{
    double smooth = seedling->length;
    for (int attempt = 0; attempt < 12; attempt++) {
        grow_combed(seedling, smooth, points);
        wind(seedling, points);
        double ratio =
            seedling->length / measure((const Double3 *)points, seedling->recipe->vertices);
        if (fabs(ratio - 1.0) < 0.002) break;
        smooth *= ratio;
    }
}

// --- Fur.

static void grow_fur(Seedling *seedling, Double3 *points)
{
    uint32_t count = seedling->recipe->vertices;
    double segment = seedling->length / (count - 1);
    Double3 direction;
    double3_copy(seedling->normal, direction);
    Double3 stray, pull = {0.0, -0.9, -0.5};
    random_direction(&seedling->random, stray);
    double3_add_scaled(direction, 0.3, stray);
    double3_copy(seedling->root, points[0]);
    for (uint32_t v = 1; v < count; v++) {
        double3_add_scaled(direction, 1.1 / (count - 1), pull);
        double3_normalize(direction);
        grow_segment(seedling, points[v - 1], segment, 0.1 * segment, direction, points[v]);
    }
}

// --- All strands.

static void grow(Seedling *seedling, Double3 *points)
{
    switch (seedling->recipe->style) {
    case STRANDS_STYLE_RANDOM:
        grow_random(seedling, points);
        break;
    case STRANDS_STYLE_STRAIGHT:
        grow_combed(seedling, seedling->length, points);
        break;
    case STRANDS_STYLE_CURLS:
        grow_curls(seedling, points);
        break;
    case STRANDS_STYLE_FUR:
        grow_fur(seedling, points);
        break;
    case STRANDS_STYLES:
        break;
    }
}

// A block of strands, grown by several threads.
enum { BLOCK = 1024 };

typedef struct Block {
    Strands *strands;
    const StrandsRecipe *recipe;
    ScalpRoot root[BLOCK];
    uint32_t first, count; // the strands of this block
    Double3 *points;       // [threads][recipe->vertices]
} Block;

static void make_strand(const Block *block, uint32_t i, Double3 *points)
{
    const StrandsRecipe *recipe = block->recipe;
    Strands *strands = block->strands;
    uint32_t s = block->first + i, first = s * recipe->vertices;
    Seedling seedling = begin_strand(recipe, &block->root[i], s);
    grow(&seedling, points);
    strands->first[s + 1] = first + recipe->vertices;
    for (uint32_t v = 0; v < recipe->vertices; v++)
        for (int k = 0; k < 3; k++) strands->position[first + v][k] = (float)points[v][k];
    const double *d = seedling.direction;
    strands->strand_uv[s][0] = (float)(0.5 + atan2(d[0], d[2]) / (2.0 * PI));
    strands->strand_uv[s][1] = (float)(0.5 + asin(fmin(fmax(d[1], -1.0), 1.0)) / PI);
}

static void make_part(void *data, int part)
{
    const Block *block = data;
    uint32_t parts = (uint32_t)parallel_threads(), at = (uint32_t)part;
    Double3 *points = block->points + (size_t)part * block->recipe->vertices;
    for (uint32_t i = block->count * at / parts; i < block->count * (at + 1) / parts; i++)
        make_strand(block, i, points);
}

// Returns RESULT_INTERRUPTED or RESULT_FAILED on errors.
static Result make_all(Strands *strands, const StrandsRecipe *recipe, Error *error)
{
    size_t threads = (size_t)parallel_threads();
    Block *block = malloc(sizeof *block);
    Double3 *points = malloc(threads * recipe->vertices * sizeof *points);
    Result result = RESULT_OK;
    if (!block || !points)
        result = error_set(error, RESULT_FAILED, "no memory for %u strands", recipe->count);
    Progress progress;
    progress_start(&progress, stderr, (int)recipe->count, activity_columns(stderr) == 0);
    ScalpRoots roots =
        scalp_roots_begin(recipe->shape, recipe->style == STRANDS_STYLE_FUR, recipe->seed);
    for (uint32_t s = 0; s < recipe->count && result == RESULT_OK; s += BLOCK) {
        block->strands = strands;
        block->recipe = recipe;
        block->points = points;
        block->first = s;
        block->count = recipe->count - s < BLOCK ? recipe->count - s : BLOCK;
        scalp_roots_take(&roots, block->root, block->count);
        parallel_run((int)threads, make_part, block);
        progress_update(&progress, (int)(s + block->count));
        if (interrupt_requested()) result = error_set(error, RESULT_INTERRUPTED, "interrupted");
    }
    progress_clear(&progress);
    free(block);
    free(points);
    return result;
}

StrandsRecipe strands_make_recipe(StrandsStyle style)
{
    StrandsRecipe recipe = {.style = style,
                            .shape = SCALP_HEAD,
                            .count = 1500,
                            .vertices = 24,
                            .length = 0.30f,
                            .length_variation = 0.2f,
                            .curl_disorder = 0.2f,
                            .seed = 1};
    if (style == STRANDS_STYLE_CURLS) {
        recipe.vertices = 32;
        recipe.curl_radius = 0.012f;
        recipe.curl_turns = 3.0f;
    }
    if (style == STRANDS_STYLE_FUR) {
        recipe.shape = SCALP_SPHERE;
        recipe.count = 4000;
        recipe.vertices = 8;
        recipe.length = 0.03f;
        recipe.length_variation = 0.4f;
    }
    if (style == STRANDS_STYLE_RANDOM) {
        recipe.shape = SCALP_SPHERE;
        recipe.count = 1000;
        recipe.vertices = 16;
        recipe.length = 0.25f;
        recipe.length_variation = 0.0f;
    }
    return recipe;
}

static Result check_range(const char *name, double value, double low, double high, Error *error)
{
    if (value >= low && value <= high) return RESULT_OK;
    return error_set(error, RESULT_USAGE, "%s %g: expected %g to %g", name, value, low, high);
}

static Result check_recipe(const StrandsRecipe *recipe, Error *error)
{
    const struct {
        const char *name;
        double value, low, high;
    } ranges[] = {
        {"count", recipe->count, 1, 1e7},
        {"vertices", recipe->vertices, 2, 65535},
        {"length", (double)recipe->length, 1e-3, 100},
        {"length variation", (double)recipe->length_variation, 0, 1},
        {"curl radius", (double)recipe->curl_radius, 0, 1},
        {"curl turns", (double)recipe->curl_turns, 0, 1000},
        {"curl disorder", (double)recipe->curl_disorder, 0, 1},
    };
    for (size_t i = 0; i < sizeof ranges / sizeof *ranges; i++)
        if (check_range(ranges[i].name, ranges[i].value, ranges[i].low, ranges[i].high, error) !=
            RESULT_OK)
            return RESULT_USAGE;
    if ((uint64_t)recipe->count * recipe->vertices >= UINT32_MAX)
        return error_set(error, RESULT_USAGE,
                         "%u strands of %u vertices: expected fewer than 2^32 - 1 vertices in all",
                         recipe->count, recipe->vertices);
    double wound = 2.0 * PI * (double)recipe->curl_radius * (double)recipe->curl_turns;
    if (recipe->style == STRANDS_STYLE_CURLS && wound > 0.9 * (double)recipe->length)
        return error_set(error, RESULT_USAGE,
                         "curls of radius %g m with %g turns do not fit into a length of %g m: "
                         "expected a smaller radius, fewer turns or longer hair",
                         (double)recipe->curl_radius, (double)recipe->curl_turns,
                         (double)recipe->length);
    return RESULT_OK;
}

Result strands_make(Strands *strands, const StrandsRecipe *recipe, Error *error)
{
    *strands = (Strands){0};
    TRY(check_recipe(recipe, error));
    Result result = strands_create(strands, recipe->count, recipe->count * recipe->vertices, error);
    if (result != RESULT_OK) return result;
    strands->strand_uv = calloc(recipe->count, sizeof *strands->strand_uv);
    result = strands->strand_uv
                 ? make_all(strands, recipe, error)
                 : error_set(error, RESULT_FAILED, "no memory for %u strands", recipe->count);
    if (result != RESULT_OK) strands_destroy(strands);
    return result;
}

Result strands_make_set(Strands *strands, const char *name, uint32_t seed, Error *error)
{
    static const char *const names[] = {"1k16", "1k32", "10k16", "10k32"};
    StrandsRecipe recipe = strands_make_recipe(STRANDS_STYLE_RANDOM);
    recipe.seed = seed;
    for (int i = 0; i < 4; i++) {
        if (strcmp(name, names[i]) != 0) continue;
        recipe.count = i < 2 ? 1000 : 10000;
        recipe.vertices = i % 2 ? 32 : 16;
        return strands_make(strands, &recipe, error);
    }
    *strands = (Strands){0};
    char words[64];
    return error_set(error, RESULT_USAGE, "no test set '%s': %s", name,
                     suggest_words(words, sizeof words, name, names, 4));
}
