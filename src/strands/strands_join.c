// SPDX-License-Identifier: MIT
#include "strands/strands_join.h"

#include <stdlib.h>
#include <string.h>

// The arrays that a set may have or not.
static const struct {
    size_t offset, element;
    bool of_strands; // else of vertices
} OPTIONAL[] = {
#define OF_VERTICES(array, width, mended) {offsetof(Strands, array), sizeof(float[width]), false},
#define OF_STRANDS(array, width, mended)  {offsetof(Strands, array), sizeof(float[width]), true},
    STRANDS_ARRAYS_OF_VERTICES(OF_VERTICES) STRANDS_ARRAYS_OF_STRANDS(OF_STRANDS)
#undef OF_VERTICES
#undef OF_STRANDS
};

static char **array_at(const Strands *strands, size_t offset)
{
    return (char **)(void *)((char *)strands + offset);
}

static bool join_array(Strands *all, const Strands *sets, uint32_t count, size_t which)
{
    size_t offset = OPTIONAL[which].offset, element = OPTIONAL[which].element;
    bool of_strands = OPTIONAL[which].of_strands;
    for (uint32_t i = 0; i < count; ++i)
        if (!*array_at(&sets[i], offset)) return true;
    char *joined = malloc((of_strands ? all->strand_count : all->vertex_count) * element + 1);
    *array_at(all, offset) = joined;
    for (uint32_t i = 0; joined && i < count; ++i) {
        size_t size = (of_strands ? sets[i].strand_count : sets[i].vertex_count) * element;
        memcpy(joined, *array_at(&sets[i], offset), size);
        joined += size;
    }
    return *array_at(all, offset) != NULL;
}

static void join_positions(Strands *all, const Strands *sets, uint32_t count)
{
    uint32_t s = 0, v = 0;
    for (uint32_t i = 0; i < count; ++i) {
        for (uint32_t k = 0; k < sets[i].strand_count; ++k) all->first[s++] = v + sets[i].first[k];
        memcpy(all->position + v, sets[i].position, sets[i].vertex_count * sizeof *all->position);
        v += sets[i].vertex_count;
    }
    all->first[s] = v;
}

static void join_wishes(Strands *all, const Strands *sets, uint32_t count)
{
    bool same = count > 0, fixed = count > 0;
    for (uint32_t i = 0; i < count; ++i) {
        same = same && sets[i].followers == sets[0].followers &&
               sets[i].follower_radius == sets[0].follower_radius;
        fixed = fixed && sets[i].both_ends_fixed;
    }
    all->followers = same ? sets[0].followers : 0;
    all->follower_radius = same ? sets[0].follower_radius : 0.0f;
    all->both_ends_fixed = fixed;
}

Result strands_join(Strands *all, const Strands *sets, uint32_t count, Error *error)
{
    uint64_t strands = 0, vertices = 0;
    *all = (Strands){0};
    for (uint32_t i = 0; i < count; ++i) {
        strands += sets[i].strand_count;
        vertices += sets[i].vertex_count;
    }
    if (strands >= UINT32_MAX || vertices >= UINT32_MAX)
        return error_set(error, RESULT_FAILED, "more vertices than a hair file holds");
    Result result = strands_create(all, (uint32_t)strands, (uint32_t)vertices, error);
    if (result != RESULT_OK) return result;
    join_positions(all, sets, count);
    join_wishes(all, sets, count);
    bool good = true;
    for (size_t i = 0; i < sizeof OPTIONAL / sizeof *OPTIONAL && good; ++i)
        good = join_array(all, sets, count, i);
    if (good) return RESULT_OK;
    strands_destroy(all);
    return error_set(error, RESULT_FAILED, "no memory for %llu strands",
                     (unsigned long long)strands);
}
