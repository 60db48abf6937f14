// SPDX-License-Identifier: MIT
#include "bench/bench_image_hair.h"
#include "gen/strands_make.h"
#include "scene/outline.h"
#include "strands/paint.h"
#include "strands/strands_read.h"

#include <stdio.h>
#include <string.h>

// The recipes of the sets that look like hair.
static bool find_recipe(const char *name, StrandsRecipe *recipe)
{
    static const struct {
        const char *name;
        StrandsStyle style;
        uint32_t count, vertices;
    } sets[] = {{"straight", STRANDS_STYLE_STRAIGHT, 10000, 32},
                {"curls", STRANDS_STYLE_CURLS, 10000, 32},
                {"curls100k", STRANDS_STYLE_CURLS, 100000, 32},
                {"fur", STRANDS_STYLE_FUR, 37747, 8}};
    for (size_t i = 0; i < sizeof sets / sizeof *sets; ++i) {
        if (strcmp(name, sets[i].name) != 0) continue;
        *recipe = strands_recipe_default(sets[i].style);
        recipe->count = sets[i].count;
        recipe->vertices = sets[i].vertices;
        return true;
    }
    return false;
}

Result image_hair_read(Strands *strands, const char *set, const char *file, Error *error)
{
    StrandsRecipe recipe;
    if (!set) return strands_read(strands, file, &(StrandsReadOptions){0}, NULL, error);
    if (find_recipe(set, &recipe)) return strands_make(strands, &recipe, error);
    return strands_make_set(strands, set, 1, error);
}

Result image_hair_create(ImageHair *hair, const Gpu *gpu, const char *set, const char *file,
                         const int size[2], Error *error)
{
    const char *name = set ? set : file, *slash = strrchr(name, '/');
    SectionParams params = {0};
    Framing framing;
    *hair = (ImageHair){.set = set, .file = file};
    snprintf(hair->name, sizeof hair->name, "%s", slash ? slash + 1 : name);
    Result result = scene_create(&hair->scene, error);
    if (result == RESULT_OK) result = params_create_section(&params, error);
    if (result == RESULT_OK) result = scene_add_section(&hair->scene, name, &params, error);
    params_destroy_section(&params);
    if (result == RESULT_OK) result = image_hair_read(&hair->strands, set, file, error);
    if (result == RESULT_OK)
        result = hair_create(&hair->hair, &hair->strands, 0, &gpu->limits, error);
    if (result != RESULT_OK) return result;
    hair->radius = paint_auto_radius(&hair->strands, 0);
    memcpy(hair->scene.run.size, size, sizeof hair->scene.run.size);
    outline_frame(&framing, &hair->scene, &hair->strands, NULL);
    camera_view(&hair->view, &hair->scene, &framing, 0);
    return RESULT_OK;
}

void image_hair_destroy(ImageHair *hair)
{
    hair_destroy(&hair->hair);
    strands_destroy(&hair->strands);
    scene_destroy(&hair->scene);
    *hair = (ImageHair){0};
}
