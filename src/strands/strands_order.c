// SPDX-License-Identifier: MIT
#include "strands/strands_order.h"

#include "base/random.h"

#include <stdlib.h>
#include <string.h>

// Makes room in `to`, whose counts are set, for the optional arrays that `from` has.
static bool allocate_like(Strands *to, const Strands *from)
{
    size_t strands = (size_t)to->strand_count + 1, vertices = (size_t)to->vertex_count + 1;
    bool good = true;
#define ALLOCATE(array, count)                                                                     \
    if (from->array) good = (to->array = malloc((count) * sizeof *to->array)) != NULL && good;
#define OF_VERTICES(array, width, mended) ALLOCATE(array, vertices)
#define OF_STRANDS(array, width, mended)  ALLOCATE(array, strands)
    STRANDS_ARRAYS_OF_VERTICES(OF_VERTICES)
    STRANDS_ARRAYS_OF_STRANDS(OF_STRANDS)
#undef OF_VERTICES
#undef OF_STRANDS
#undef ALLOCATE
    return good;
}

// Copies strand s of `from` to be strand t of `to`, whose first[t] is set.
static void copy_strand(Strands *to, uint32_t t, const Strands *from, uint32_t s)
{
    uint32_t a = to->first[t], b = from->first[s], size = strands_size(from, s);
    to->first[t + 1] = a + size;
    memcpy(to->position + a, from->position + b, size * sizeof *to->position);
#define COPY(array, at, source, count)                                                             \
    if (from->array) memcpy(&to->array[at], &from->array[source], (count) * sizeof *to->array);
#define OF_VERTICES(array, width, mended) COPY(array, a, b, size)
#define OF_STRANDS(array, width, mended)  COPY(array, t, s, 1)
    STRANDS_ARRAYS_OF_VERTICES(OF_VERTICES)
    STRANDS_ARRAYS_OF_STRANDS(OF_STRANDS)
#undef OF_VERTICES
#undef OF_STRANDS
#undef COPY
}

Result strands_pick(Strands *strands, const uint32_t *which, uint32_t count, Error *error)
{
    Strands other;
    uint64_t vertices = 0;
    for (uint32_t i = 0; i < count; i++) vertices += strands_size(strands, which[i]);
    if (vertices >= UINT32_MAX)
        return error_set(error, RESULT_FAILED, "more vertices than 32-bit indices hold");
    Result result = strands_create(&other, count, (uint32_t)vertices, error);
    if (result != RESULT_OK) return result;
    if (!allocate_like(&other, strands)) {
        strands_destroy(&other);
        return error_set(error, RESULT_FAILED, "no memory to pick %u strands", count);
    }
    for (uint32_t i = 0; i < count; i++) copy_strand(&other, i, strands, which[i]);
    other.followers = strands->followers;
    other.follower_radius = strands->follower_radius;
    other.both_ends_fixed = strands->both_ends_fixed;
    strands_destroy(strands);
    *strands = other;
    return RESULT_OK;
}

Result strands_reorder(Strands *strands, const uint32_t *order, Error *error)
{
    return strands_pick(strands, order, strands->strand_count, error);
}

static int compare_numbers(const void *a, const void *b)
{
    uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

Result strands_thin(Strands *strands, double share, uint32_t seed, Error *error)
{
    uint32_t *order = malloc(((size_t)strands->strand_count + 1) * sizeof *order);
    if (!order)
        return error_set(error, RESULT_FAILED, "no memory to pick %u strands",
                         strands->strand_count);
    uint32_t count = (uint32_t)(share * strands->strand_count + 0.5);
    if (count == 0 && strands->strand_count) count = 1;
    Random random = random_create(seed, 0x7468696e); // "thin"
    random_permutation(&random, order, strands->strand_count);
    qsort(order, count, sizeof *order, compare_numbers);
    Result result = strands_pick(strands, order, count, error);
    free(order);
    return result;
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
