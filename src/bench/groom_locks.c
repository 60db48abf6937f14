// SPDX-License-Identifier: MIT
#include "bench/groom_locks.h"
#include "base/nearest.h"

#include <math.h>
#include <stdlib.h>

enum { LEVELS = 3, NEIGHBOURS = 8 };
static const double STILL = 2; // in spacings of strands

// A height level: the vertex of each strand at this height, its position and its neighbours.
typedef struct Level {
    uint32_t *vertex;
    float (*point)[3];
    Neighbour (*found)[NEIGHBOURS];
    double *farthest; // squared distance to the last neighbour
    Nearest tree;
} Level;

static void destroy_level(Level *level)
{
    nearest_destroy(&level->tree);
    free(level->vertex);
    free(level->point);
    free(level->found);
    free(level->farthest);
}

static Result create_level(Level *level, size_t count, Error *error)
{
    *level = (Level){.vertex = calloc(count, sizeof *level->vertex),
                     .point = calloc(count, sizeof *level->point),
                     .found = calloc(count, sizeof *level->found),
                     .farthest = calloc(count, sizeof *level->farthest)};
    if (level->vertex && level->point && level->found && level->farthest) return RESULT_OK;
    return error_set(error, RESULT_FAILED, "no memory for the neighbours of %zu strands", count);
}

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static Result add_level(GroomLocks *locks, Level *level, uint32_t count, Error *error)
{
    uint32_t found = count - 1 < NEIGHBOURS ? count - 1 : NEIGHBOURS;
    TRY(nearest_create(&level->tree, (const float(*)[3])level->point, count, error));
    for (uint32_t s = 0; s < count; ++s) {
        nearest_find(&level->tree, s, level->found[s], found);
        level->farthest[s] = level->found[s][found - 1].square;
    }
    qsort(level->farthest, count, sizeof *level->farthest, compare);
    double most = level->farthest[count / 2];
    for (uint32_t s = 0; s < count; ++s)
        for (uint32_t i = 0; i < found && level->found[s][i].square <= most; ++i)
            locks->bond[locks->bond_count++] = (Bond){
                {level->vertex[s], level->vertex[level->found[s][i].point]},
                (float)(STILL * sqrt(most)),
            };
    nearest_destroy(&level->tree);
    return RESULT_OK;
}

Result groom_locks_create(GroomLocks *locks, const float (*point)[3], const uint32_t *first,
                          uint32_t strand_count, Error *error)
{
    Level level;
    *locks = (GroomLocks){0};
    if (strand_count < 2) return RESULT_OK;
    Result result = create_level(&level, strand_count, error);
    locks->bond = calloc((size_t)strand_count * LEVELS * NEIGHBOURS, sizeof *locks->bond);
    if (!locks->bond && result == RESULT_OK)
        result = error_set(error, RESULT_FAILED, "no memory for the neighbours of %u strands",
                           strand_count);
    for (uint32_t height = 1; height <= LEVELS && result == RESULT_OK; ++height) {
        for (uint32_t s = 0; s < strand_count; ++s) {
            level.vertex[s] = first[s] + (first[s + 1] - first[s] - 1) * height / LEVELS;
            for (int k = 0; k < 3; ++k) level.point[s][k] = point[level.vertex[s]][k];
        }
        result = add_level(locks, &level, strand_count, error);
    }
    destroy_level(&level);
    return result;
}

void groom_locks_destroy(GroomLocks *locks)
{
    free(locks->bond);
    *locks = (GroomLocks){0};
}

double groom_locks_kept(const GroomLocks *locks, const float (*point)[3])
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < locks->bond_count; ++i) {
        const Bond *bond = &locks->bond[i];
        const float *a = point[bond->vertex[0]], *b = point[bond->vertex[1]];
        kept += hypot(hypot((double)a[0] - (double)b[0], (double)a[1] - (double)b[1]),
                      (double)a[2] - (double)b[2]) <= (double)bond->reach;
    }
    return kept / (double)locks->bond_count;
}
