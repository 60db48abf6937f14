// SPDX-License-Identifier: MIT
#include "gen/fur_recipe.h"

#include <stddef.h>
#include <stdint.h>

FurRecipe fur_recipe_default(void)
{
    return (FurRecipe){.seed = 1,
                       .count = 4000,
                       .vertices = 16,
                       .root_lift = 1e-4,
                       .length = 0.03,
                       .length_variation = 0.3,
                       .lift_deg = 45.0,
                       .gravity_bend = 10.0,
                       .noise_size = 0.02,
                       .clump_profile = 0.5,
                       .curl_frequency = 40.0,
                       .curl_disorder = 0.2,
                       .frizz_frequency = 60.0,
                       .tip_thickness = 0.3};
}

Result fur_recipe_check(const FurRecipe *recipe, Error *error)
{
    double turns = recipe->curl_frequency * recipe->length;
    if (recipe->curl_radius > 0.0 && recipe->vertices - 1 < 4.0 * turns)
        return error_set(error, RESULT_USAGE,
                         "%g turns of curls over %g m need %.0f vertices, 4 a turn; there are %d",
                         turns, recipe->length, 4.0 * turns + 1.5, recipe->vertices);
    if (recipe->clumps > 0 && recipe->guides > 0 && recipe->clumps > recipe->guides)
        return error_set(error, RESULT_USAGE, "%d clumps need as many guides, there are %d",
                         recipe->clumps, recipe->guides);
    if ((recipe->clump > 0.0 || recipe->clump_root > 0.0) && !recipe->guides && !recipe->clumps)
        return error_set(error, RESULT_USAGE,
                         "hair gathers around guides: --clump needs --guides or --clumps");
    if (recipe->count > 0 && (uint64_t)recipe->count * (uint64_t)recipe->vertices > 1u << 30)
        return error_set(error, RESULT_USAGE, "%d strands of %d vertices are too many",
                         recipe->count, recipe->vertices);
    return RESULT_OK;
}
