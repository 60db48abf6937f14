// SPDX-License-Identifier: MIT
#include "run/usd_look.h"

#include "strands/paint.h"

#include <stdlib.h>
#include <string.h>

static void set_widths(float *width, const Strands *strands, const SectionParams *params,
                       const Paint *paint)
{
    float radius = params->radius.automatic ? paint_auto_radius(strands, 0) : params->radius.value;
    for (uint32_t s = 0; s < strands->strand_count; ++s)
        for (uint32_t first = strands->first[s], j = 0; j < strands_size(strands, s); ++j) {
            float taper =
                1 - (1 - params->tip_ratio) * (float)j / (float)(strands_size(strands, s) - 1);
            width[first + j] =
                2 * radius * (paint->thickness ? paint->thickness[first + j] : taper);
        }
}

static void set_colors(float (*color)[4], const Strands *strands, const SectionParams *params,
                       const Paint *paint)
{
    float own[4] = {0, 0, 0, 1};
    paint_color(params, own);
    for (uint32_t v = 0; v < strands->vertex_count; ++v)
        memcpy(color[v], paint->color ? paint->color[v] : own, sizeof own);
}

// From a value each vertex to one each strand, where vertices do not differ, or to just one.
static UsdRate simplify(float (*color)[4], const Strands *all)
{
    bool constant = true, uniform = true;
    for (uint32_t s = 0; s < all->strand_count; ++s)
        for (uint32_t root = all->first[s], v = root; v < all->first[s + 1]; ++v) {
            uniform = uniform && memcmp(color[v], color[root], sizeof *color) == 0;
            constant = constant && memcmp(color[v], color[0], sizeof *color) == 0;
        }
    if (constant) return USD_CONSTANT;
    if (!uniform) return USD_VERTEX;
    for (uint32_t s = 0; s < all->strand_count; ++s)
        memmove(color[s], color[all->first[s]], sizeof *color);
    return USD_UNIFORM;
}

static Result look_at_section(SceneLook *look, const Section *section, const Strands *strands,
                              size_t first, Error *error)
{
    Paint paint;
    Result result = paint_create(&paint, strands, &section->params, error);
    if (result != RESULT_OK) return error_prefix(error, result, "%s: ", section->file);
    set_widths(look->width + first, strands, &section->params, &paint);
    set_colors(look->color + first, strands, &section->params, &paint);
    paint_destroy(&paint);
    return RESULT_OK;
}

Result scene_look_create(SceneLook *look, const Scene *scene, const Strands *sections,
                         const Strands *all, Error *error)
{
    size_t vertex = 0, strand = 0;
    *look = (SceneLook){.width = malloc(all->vertex_count * sizeof *look->width + 1),
                        .color = malloc(all->vertex_count * sizeof *look->color + 1),
                        .section = malloc(all->strand_count * sizeof *look->section + 1)};
    Result result = look->width && look->color && look->section
                        ? RESULT_OK
                        : error_set(error, RESULT_FAILED, "no memory for the curves' widths");
    for (uint32_t i = 0; i < scene->section_count && result == RESULT_OK; ++i) {
        result = look_at_section(look, &scene->sections[i], &sections[i], vertex, error);
        for (uint32_t s = 0; s < sections[i].strand_count; ++s) look->section[strand++] = i;
        vertex += sections[i].vertex_count;
    }
    if (result != RESULT_OK) {
        scene_look_destroy(look);
        return result;
    }
    look->usd = (UsdLook){.width = look->width,
                          .width_rate = USD_VERTEX,
                          .color = (const float(*)[4])look->color,
                          .color_rate = simplify(look->color, all),
                          .section = scene->section_count > 1 ? look->section : NULL};
    return RESULT_OK;
}

void scene_look_destroy(SceneLook *look)
{
    free(look->width);
    free(look->color);
    free(look->section);
    *look = (SceneLook){0};
}
