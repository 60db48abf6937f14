// SPDX-License-Identifier: MIT
#include "strands/strands.h"

#include <math.h>
#include <stdlib.h>

Result strands_create(Strands *strands, uint32_t strand_count, uint32_t vertex_count, Error *error)
{
    *strands = (Strands){.strand_count = strand_count, .vertex_count = vertex_count};
    if (strand_count == UINT32_MAX)
        return error_set(error, RESULT_FAILED, "%u strands are more than 32-bit indices hold",
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
    for (int axis = 0; axis < 3; axis++) {
        low[axis] = high[axis] = strands->vertex_count ? strands->position[0][axis] : 0.0f;
        for (uint32_t v = 1; v < strands->vertex_count; v++) {
            low[axis] = fminf(low[axis], strands->position[v][axis]);
            high[axis] = fmaxf(high[axis], strands->position[v][axis]);
        }
    }
}
