// SPDX-License-Identifier: MIT
#include "base/nearest.h"

#include <stdbool.h>
#include <stdlib.h>

static float coordinate(const Nearest *nearest, uint32_t at, int axis)
{
    return nearest->point[nearest->order[at]][axis];
}

static void swap(uint32_t *a, uint32_t *b)
{
    uint32_t kept = *a;
    *a = *b, *b = kept;
}

// Hoare's selection: puts the element that belongs to place `middle` of begin .. end - 1 there, and
// smaller ones before it.
static void split(Nearest *nearest, uint32_t begin, uint32_t end, uint32_t middle, int axis)
{
    int64_t low = begin, high = (int64_t)end - 1;
    while (low < high) {
        float pivot = coordinate(nearest, middle, axis);
        int64_t i = low, j = high;
        while (i <= j) {
            while (coordinate(nearest, (uint32_t)i, axis) < pivot) ++i;
            while (coordinate(nearest, (uint32_t)j, axis) > pivot) --j;
            if (i <= j) swap(&nearest->order[i++], &nearest->order[j--]);
        }
        if (j < (int64_t)middle) low = i;
        if (i > (int64_t)middle) high = j;
    }
}

static void build(Nearest *nearest, uint32_t begin, uint32_t end, int axis)
{
    if (end - begin < 2) return;
    uint32_t middle = begin + (end - begin) / 2;
    split(nearest, begin, end, middle, axis);
    build(nearest, begin, middle, (axis + 1) % 3);
    build(nearest, middle + 1, end, (axis + 1) % 3);
}

Result nearest_create(Nearest *nearest, const float (*point)[3], uint32_t count, Error *error)
{
    *nearest = (Nearest){.point = point, .count = count};
    nearest->order = malloc(((size_t)count + 1) * sizeof *nearest->order);
    if (!nearest->order)
        return error_set(error, RESULT_FAILED, "no memory for a tree of %u points", count);
    for (uint32_t i = 0; i < count; ++i) nearest->order[i] = i;
    build(nearest, 0, count, 0);
    return RESULT_OK;
}

void nearest_destroy(Nearest *nearest)
{
    free(nearest->order);
    *nearest = (Nearest){0};
}

typedef struct Search {
    const Nearest *nearest;
    uint32_t self;
    const float *from;
    Neighbour *found;
    uint32_t count, most;
} Search;

static void visit(Search *search, uint32_t point)
{
    double square = 0;
    if (point == search->self) return;
    for (int k = 0; k < 3; ++k) {
        double d = (double)search->nearest->point[point][k] - (double)search->from[k];
        square += d * d;
    }
    bool full = search->count == search->most;
    if (full && square >= search->found[search->count - 1].square) return;
    uint32_t at = full ? search->count - 1 : search->count++;
    for (; at > 0 && search->found[at - 1].square > square; --at)
        search->found[at] = search->found[at - 1];
    search->found[at] = (Neighbour){point, square};
}

static void descend(Search *search, uint32_t begin, uint32_t end, int axis)
{
    if (begin >= end) return;
    uint32_t middle = begin + (end - begin) / 2;
    double off = (double)search->from[axis] - (double)coordinate(search->nearest, middle, axis);
    int next = (axis + 1) % 3;
    visit(search, search->nearest->order[middle]);
    // Search the side of the point first: then the other side is rarely near enough.
    if (off < 0)
        descend(search, begin, middle, next);
    else
        descend(search, middle + 1, end, next);
    if (search->count == search->most && off * off >= search->found[search->count - 1].square)
        return;
    if (off < 0)
        descend(search, middle + 1, end, next);
    else
        descend(search, begin, middle, next);
}

uint32_t nearest_find(const Nearest *nearest, uint32_t self, Neighbour *found, uint32_t most)
{
    Search search = {nearest, self, nearest->point[self], found, 0, most};
    if (most) descend(&search, 0, nearest->count, 0);
    return search.count;
}

uint32_t nearest_find_at(const Nearest *nearest, const float from[3], Neighbour *found,
                         uint32_t most)
{
    Search search = {nearest, UINT32_MAX, from, found, 0, most};
    if (most) descend(&search, 0, nearest->count, 0);
    return search.count;
}
