// SPDX-License-Identifier: MIT
#include "strands/strands.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

Result strands_create(Strands *strands, uint32_t strand_count, uint32_t vertex_count, Error *error)
{
    *strands = (Strands){.strand_count = strand_count, .vertex_count = vertex_count};
    if (strand_count == UINT32_MAX)
        return error_set(error, RESULT_FAILED, "%u strands: expected fewer than 2^32 - 1",
                         strand_count);
    strands->first = calloc((size_t)strand_count + 1, sizeof *strands->first);
    strands->position = calloc((size_t)vertex_count + 1, sizeof *strands->position);
    if (strands->first && strands->position) return RESULT_OK;
    strands_destroy(strands);
    return error_set(error, RESULT_FAILED, "no memory for %u strands of %u vertices in all",
                     strand_count, vertex_count);
}

void strands_destroy(Strands *strands)
{
    free(strands->first);
    free(strands->position);
#define FREE(array, width, mended) free(strands->array);
    STRANDS_ARRAYS_OF_VERTICES(FREE)
    STRANDS_ARRAYS_OF_STRANDS(FREE)
#undef FREE
    *strands = (Strands){0};
}

double strands_length(const Strands *strands, uint32_t s)
{
    double length = 0.0;
    for (uint32_t v = strands->first[s] + 1; v < strands->first[s + 1]; v++) {
        const float *a = strands->position[v - 1], *b = strands->position[v];
        double x = (double)b[0] - a[0], y = (double)b[1] - a[1], z = (double)b[2] - a[2];
        length += sqrt(x * x + y * y + z * z);
    }
    return length;
}

void strands_bounds(const Strands *strands, float low[3], float high[3])
{
    float least[3] = {0}, most[3] = {0}; // not the caller's arrays, so that they stay in registers
    for (int axis = 0; axis < 3 && strands->vertex_count; axis++)
        least[axis] = most[axis] = strands->position[0][axis];
    for (uint32_t v = 1; v < strands->vertex_count; v++)
        for (int axis = 0; axis < 3; axis++) {
            float x = strands->position[v][axis];
            least[axis] = x < least[axis] ? x : least[axis];
            most[axis] = x > most[axis] ? x : most[axis];
        }
    memcpy(low, least, sizeof least);
    memcpy(high, most, sizeof most);
}

// --- Features.

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

uint32_t strands_held(const Strands *strands, uint32_t s)
{
    const float *mobility = strands->mobility ? &strands->mobility[strands->first[s]] : NULL;
    uint32_t held = 1;
    while (mobility && held < strands_size(strands, s) && !(mobility[held] > 0)) ++held;
    return held;
}

uint32_t strands_held_elsewhere(const Strands *strands)
{
    uint32_t count = 0;
    for (uint32_t s = 0; strands->mobility && s < strands->strand_count; s++) {
        uint32_t end = strands->first[s + 1] - (strands->both_ends_fixed ? 1 : 0);
        uint32_t v = strands->first[s] + strands_held(strands, s);
        while (v < end && strands->mobility[v] > 0) ++v;
        count += v < end;
    }
    return count;
}

bool strands_are_opaque(const Strands *strands)
{
    for (uint32_t v = 0; strands->color && v < strands->vertex_count; v++)
        if (strands->color[v][3] != 1.0f) return false;
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
    if (strands->strand_group && !is_zero(strands->strand_group, count))
        features |= STRANDS_HAS_GROUP;
    if (fibre_is_known(&strands->fibre)) features |= STRANDS_HAS_FIBRE;
    return features;
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
                                        "fixed tips",
                                        "groups",
                                        "material of fibres"};
    text[0] = 0;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        size_t used = strlen(text);
        if (features & 1u << i)
            snprintf(text + used, size - used, "%s%s", used ? ", " : "", names[i]);
    }
}
