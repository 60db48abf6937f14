// SPDX-License-Identifier: MIT
#include "strands_order.h"

#include "random.h"

#include <stdlib.h>
#include <string.h>

// Makes room in `to` for the optional arrays that `from` has.
static bool allocate_like(Strands *to, const Strands *from)
{
    size_t strands = (size_t)from->strand_count + 1, vertices = (size_t)from->vertex_count + 1;
    bool good = true;
#define ALLOCATE(array, count)                                                                     \
    if (from->array) good = (to->array = malloc((count) * sizeof *to->array)) != NULL && good
    ALLOCATE(mobility, vertices);
    ALLOCATE(strand_uv, strands);
    ALLOCATE(vertex_uv, vertices);
    ALLOCATE(strand_thickness, strands);
    ALLOCATE(vertex_thickness, vertices);
    ALLOCATE(color, vertices);
#undef ALLOCATE
    return good;
}

// Copies strand s of `from` to be strand t of `to`, whose first[t] is set.
static void copy_strand(Strands *to, uint32_t t, const Strands *from, uint32_t s)
{
    uint32_t a = to->first[t], b = from->first[s], size = strands_size(from, s);
    to->first[t + 1] = a + size;
#define COPY(array, at, source, count)                                                             \
    if (from->array) memcpy(&to->array[at], &from->array[source], (count) * sizeof *to->array)
    COPY(position, a, b, size);
    COPY(mobility, a, b, size);
    COPY(vertex_uv, a, b, size);
    COPY(vertex_thickness, a, b, size);
    COPY(color, a, b, size);
    COPY(strand_uv, t, s, 1);
    COPY(strand_thickness, t, s, 1);
#undef COPY
}

Result strands_reorder(Strands *strands, const uint32_t *order, Error *error)
{
    Strands other;
    Result result = strands_create(&other, strands->strand_count, strands->vertex_count, error);
    if (result != RESULT_OK) return result;
    if (!allocate_like(&other, strands)) {
        strands_destroy(&other);
        return error_set(error, RESULT_FAILED, "no memory to reorder %u strands",
                         strands->strand_count);
    }
    for (uint32_t i = 0; i < strands->strand_count; i++) copy_strand(&other, i, strands, order[i]);
    other.followers = strands->followers;
    other.follower_radius = strands->follower_radius;
    other.both_ends_fixed = strands->both_ends_fixed;
    strands_destroy(strands);
    *strands = other;
    return RESULT_OK;
}

Result strands_shuffle(Strands *strands, uint32_t seed, Error *error)
{
    uint32_t *order = malloc(((size_t)strands->strand_count + 1) * sizeof *order);
    if (!order)
        return error_set(error, RESULT_FAILED, "no memory to reorder %u strands",
                         strands->strand_count);
    Random random = random_create(seed, 0x73687566666c65); // "shuffle"
    random_permutation(&random, order, strands->strand_count);
    Result result = strands_reorder(strands, order, error);
    free(order);
    return result;
}
