// SPDX-License-Identifier: MIT
#include "strands/strands_features.h"

#include <string.h>

static bool is_zero(const float *values, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (values[i] != 0.0f) return false;
    return true;
}

static bool is_usual_mobility(const Strands *strands)
{
    for (uint32_t s = 0; s < strands->strand_count; s++) {
        uint32_t root = strands->first[s], tip = strands->first[s + 1] - 1;
        for (uint32_t v = root; v <= tip; v++) {
            bool fixed = v == root || (strands->both_ends_fixed && v == tip);
            if (strands->mobility[v] != (fixed ? 0.0f : 1.0f)) return false;
        }
    }
    return true;
}

uint32_t strands_features(const Strands *strands)
{
    size_t count = strands->strand_count, vertices = strands->vertex_count;
    uint32_t features = 0;
    if (strands->mobility && !is_usual_mobility(strands)) features |= STRANDS_HAS_MOBILITY;
    if (strands->strand_uv && !is_zero(strands->strand_uv[0], 2 * count))
        features |= STRANDS_HAS_STRAND_UV;
    if (strands->vertex_uv && !is_zero(strands->vertex_uv[0], 2 * vertices))
        features |= STRANDS_HAS_VERTEX_UV;
    if (strands->strand_thickness) features |= STRANDS_HAS_STRAND_THICKNESS;
    if (strands->vertex_thickness) features |= STRANDS_HAS_VERTEX_THICKNESS;
    if (strands->color) features |= STRANDS_HAS_COLOR;
    if (strands->followers) features |= STRANDS_HAS_FOLLOWERS;
    if (strands->follower_radius != 0.0f) features |= STRANDS_HAS_FOLLOWER_RADIUS;
    if (strands->both_ends_fixed) features |= STRANDS_HAS_FIXED_ENDS;
    return features;
}

uint32_t strands_kind_features(StrandsKind kind)
{
    switch (kind) {
    case STRANDS_TFX2_TEXT:
        return STRANDS_HAS_STRAND_UV | STRANDS_HAS_FOLLOWERS | STRANDS_HAS_FOLLOWER_RADIUS |
               STRANDS_HAS_FIXED_ENDS;
    case STRANDS_TFX3:
        return STRANDS_HAS_STRAND_UV | STRANDS_HAS_VERTEX_UV | STRANDS_HAS_STRAND_THICKNESS |
               STRANDS_HAS_COLOR | STRANDS_HAS_FOLLOWERS | STRANDS_HAS_FIXED_ENDS;
    case STRANDS_TFX4: // fixed ends as the mobility of tips
        return STRANDS_HAS_MOBILITY | STRANDS_HAS_STRAND_UV | STRANDS_HAS_VERTEX_UV |
               STRANDS_HAS_STRAND_THICKNESS | STRANDS_HAS_COLOR | STRANDS_HAS_FIXED_ENDS;
    case STRANDS_HAIR:
        return STRANDS_HAS_VERTEX_THICKNESS | STRANDS_HAS_COLOR;
    case STRANDS_USD:
        return UINT32_MAX;
    default:
        return 0;
    }
}

void strands_features_describe(uint32_t features, char *text, size_t size)
{
    static const char *const names[] = {"mobility of vertices",
                                        "texture coordinates of strands",
                                        "texture coordinates of vertices",
                                        "thickness of strands",
                                        "thickness of vertices",
                                        "colours",
                                        "number of followers",
                                        "radius of followers",
                                        "fixed tips"};
    text[0] = 0;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        size_t used = strlen(text);
        if (features & 1u << i)
            snprintf(text + used, size - used, "%s%s", used ? ", " : "", names[i]);
    }
}
