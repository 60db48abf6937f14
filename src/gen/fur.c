// SPDX-License-Identifier: MIT
#include "gen/fur.h"

#include "base/activity.h"
#include "base/progress.h"
#include "gen/fur_roots.h"
#include "gen/fur_weave.h"

#include <stdlib.h>

typedef struct Farm {
    const FurRecipe *recipe;
    const char *name;
    Surface surface;
    FurMap density, length;
    FurComb comb;
    FurGuides guides;
    SurfacePoint *roots; // [count]; the roots of guides come first
    uint32_t count;
    Double3 *vertices; // [recipe->vertices], of one strand
} Farm;

static void farm_destroy(Farm *farm)
{
    surface_destroy(&farm->surface);
    fur_map_destroy(&farm->density);
    fur_map_destroy(&farm->length);
    fur_map_destroy_comb(&farm->comb);
    fur_guides_destroy(&farm->guides);
    free(farm->roots);
    free(farm->vertices);
}

static Result read_maps(Farm *farm, const Mesh *mesh, Error *error)
{
    const FurRecipe *recipe = farm->recipe;
    farm->density.number = farm->length.number = 1.0;
    if (recipe->density)
        TRY(fur_map_create(&farm->density, "--density", recipe->density, mesh, error));
    if (recipe->length_map)
        TRY(fur_map_create(&farm->length, "--length-map", recipe->length_map, mesh, error));
    if (recipe->comb) TRY(fur_map_create_comb(&farm->comb, "--comb", recipe->comb, mesh, error));
    return RESULT_OK;
}

static Result count_strands(Farm *farm, Error *error)
{
    const FurRecipe *recipe = farm->recipe;
    const uint32_t seed = (uint32_t)recipe->seed;
    double area, count = recipe->count;
    if (recipe->per_cm2 > 0.0) {
        TRY(fur_roots_measure(&farm->surface, &farm->density, seed, farm->name, &area, error));
        count = floor(recipe->per_cm2 * area * 1e4 + 0.5);
    }
    if (!(count >= 1.0 && count <= 2e6 && count * recipe->vertices < (double)(1u << 30)))
        return error_set(error, RESULT_USAGE,
                         "%.0f strands of %d vertices on %s: expected 1 to 2000000 strands with at "
                         "most 2^30 vertices in all",
                         count, recipe->vertices, farm->name);
    farm->count = (uint32_t)count;
    return RESULT_OK;
}

static Result plant(Farm *farm, Error *error)
{
    const FurRecipe *recipe = farm->recipe;
    const uint32_t seed = (uint32_t)recipe->seed;
    uint32_t guides = recipe->guides > 0 ? (uint32_t)recipe->guides : farm->count;
    if (guides > farm->count) guides = farm->count;
    farm->roots = malloc(farm->count * sizeof *farm->roots);
    farm->vertices = malloc((size_t)recipe->vertices * sizeof *farm->vertices);
    if (!farm->roots || !farm->vertices)
        return error_set(error, RESULT_FAILED, "no memory for %u roots", farm->count);
    uint32_t clumps = recipe->clumps > 0 ? (uint32_t)recipe->clumps : guides;
    TRY(fur_roots_make(farm->roots, farm->count, &farm->surface, &farm->density, seed, farm->name,
                       error));
    TRY(fur_roots_order(farm->roots, farm->count, guides, seed, error));
    if (clumps < guides) TRY(fur_roots_order(farm->roots, guides, clumps, seed, error));
    return fur_guides_create(&farm->guides, recipe, &farm->surface, &farm->comb, farm->roots,
                             guides, error);
}

static Result make_room(Farm *farm, Strands *strands, Error *error)
{
    const FurRecipe *recipe = farm->recipe;
    uint32_t vertices = (uint32_t)recipe->vertices;
    TRY(strands_create(strands, farm->count, farm->count * vertices, error));
    if (farm->surface.mesh->uv)
        strands->strand_uv = calloc(farm->count, sizeof *strands->strand_uv);
    if (recipe->thickness > 0.0)
        strands->vertex_thickness =
            calloc(strands->vertex_count, sizeof *strands->vertex_thickness);
    strands->followers = (uint32_t)recipe->followers;
    if ((!farm->surface.mesh->uv || strands->strand_uv) &&
        (recipe->thickness <= 0.0 || strands->vertex_thickness))
        return RESULT_OK;
    return error_set(error, RESULT_FAILED, "no memory for %u strands", farm->count);
}

static void store(const Farm *farm, Strands *strands, uint32_t s, const SurfacePoint *root)
{
    const FurRecipe *recipe = farm->recipe;
    uint32_t count = (uint32_t)recipe->vertices, first = s * count;
    double uv[2];
    strands->first[s + 1] = first + count;
    for (uint32_t v = 0; v < count; v++) {
        double share = v / (double)(count - 1);
        for (int i = 0; i < 3; i++) strands->position[first + v][i] = (float)farm->vertices[v][i];
        if (strands->vertex_thickness)
            strands->vertex_thickness[first + v] =
                (float)(recipe->thickness * (1.0 - share * (1.0 - recipe->tip_thickness)));
    }
    surface_uv(&farm->surface, root, uv);
    for (int i = 0; i < 2 && strands->strand_uv; i++) strands->strand_uv[s][i] = (float)uv[i];
}

// The length of a strand at this root, m. NaN if the length map is not a number there.
static double find_length(const Farm *farm, const SurfacePoint *root, Random *random)
{
    const FurRecipe *recipe = farm->recipe;
    double factor = fur_map_at(&farm->length, &farm->surface, root);
    double share = 1.0 - recipe->length_variation * random_real(random);
    return isnan(factor) ? factor : recipe->length * share * fmin(fmax(factor, 0.0), 1.0);
}

static Result grow_all(Farm *farm, Strands *strands, FurReport *report, Error *error)
{
    const FurRecipe *recipe = farm->recipe;
    uint32_t grown = 0;
    Progress progress;
    progress_start(&progress, stderr, (int)farm->count, activity_columns(stderr) == 0);
    for (uint32_t s = 0; s < farm->count; s++) {
        const SurfacePoint *root = &farm->roots[s];
        Random random = random_create((uint64_t)recipe->seed, 0x737472616e640000u + s); // "strand"
        if (s % 1024 == 0) progress_update(&progress, (int)s);
        Double3 normal;
        FurWeave weave;
        double length = find_length(farm, root, &random);
        if (isnan(length))
            return error_set(error, RESULT_USAGE,
                             "--length-map: not a number at %.3g, %.3g, %.3g: expected 0 to 1",
                             root->place[0], root->place[1], root->place[2]);
        if (length < 1e-3 * recipe->length) continue;
        surface_normal(&farm->surface, root, normal);
        fur_weave_create(&weave, recipe, &farm->guides, s < farm->guides.count ? s : FUR_NO_GUIDE,
                         root, normal, length, &random);
        report->stuck += fur_weave_cut(&weave, &farm->surface, root, recipe->root_lift, length,
                                       farm->vertices, (uint32_t)recipe->vertices);
        store(farm, strands, grown++, root);
    }
    progress_clear(&progress);
    strands->strand_count = grown;
    strands->vertex_count = grown * (uint32_t)recipe->vertices;
    if (grown > 0) return RESULT_OK;
    return error_set(error, RESULT_USAGE,
                     "--length-map: leaves no hair on %s: expected more than 0.001 in some places",
                     farm->name);
}

Result fur_grow(Strands *strands, const FurRecipe *recipe, const Mesh *mesh, const char *name,
                FurReport *report, Error *error)
{
    Farm farm = {.recipe = recipe, .name = name};
    *strands = (Strands){0};
    *report = (FurReport){0};
    Result result = fur_recipe_check(recipe, error);
    THEN(result, surface_create(&farm.surface, mesh, name, error));
    THEN(result, read_maps(&farm, mesh, error));
    THEN(result, count_strands(&farm, error));
    THEN(result, plant(&farm, error));
    THEN(result, make_room(&farm, strands, error));
    THEN(result, grow_all(&farm, strands, report, error));
    report->guides = farm.guides.count;
    report->flat_triangles = farm.surface.flat_count;
    if (result != RESULT_OK) strands_destroy(strands);
    farm_destroy(&farm);
    return result;
}
