// SPDX-License-Identifier: MIT
#include "formats/cloud.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static int compare_floats(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

// Marks each index i for which point i + 1 is far from point i (4 times the median distance) and
// returns how many there are. `sorted` has room for 2 `count` numbers.
static uint32_t mark_jumps(const float (*p)[3], uint32_t count, float *sorted, uint8_t *jump)
{
    const float far = 4;
    uint32_t jumps = 0;
    for (uint32_t i = 0; i + 1 < count; i++) {
        double x = (double)p[i + 1][0] - p[i][0], y = (double)p[i + 1][1] - p[i][1];
        double z = (double)p[i + 1][2] - p[i][2], step = sqrt(x * x + y * y + z * z);
        sorted[i] = isfinite(step) ? (float)step : 0;
    }
    float *steps = sorted + count;
    memcpy(steps, sorted, (count - 1) * sizeof *steps);
    qsort(sorted, count - 1, sizeof *sorted, compare_floats);
    float limit = far * sorted[(count - 1) / 2];
    for (uint32_t i = 0; i + 1 < count; i++) {
        jump[i] = steps[i] > limit;
        jumps += jump[i];
    }
    return jumps;
}

// Whether the points jump where strands of `size` points would end; 90 % of both must agree.
static bool fits(const uint8_t *jump, uint32_t jumps, uint32_t count, uint32_t size)
{
    uint32_t ends = count / size - 1, hits = 0;
    for (uint32_t i = size - 1; i + 1 < count; i += size) hits += jump[i];
    return 10 * (uint64_t)hits >= 9 * (uint64_t)ends && 10 * (uint64_t)hits >= 9 * (uint64_t)jumps;
}

static uint32_t guess(FormatSource *source, Reader *reader, const float (*positions)[3],
                      uint32_t count)
{
    float *steps = reader_malloc(reader, 2 * (size_t)count, sizeof *steps);
    uint8_t *jump = reader_malloc(reader, count, 1);
    uint32_t size = 0;
    if (!steps || !jump) {
        reader_fail_memory(reader);
    } else {
        uint32_t jumps = mark_jumps(positions, count, steps, jump);
        for (uint32_t p = 2; p <= count / 2 && jumps && !size; p++)
            if (count % p == 0 && fits(jump, jumps, count, p)) size = p;
        if (!size)
            reader_fail(reader,
                        "the file does not say where its strands end, and the gaps between its %u "
                        "points do not show it (%u gaps): expected --points-per-strand N",
                        count, jumps);
    }
    free(steps);
    free(jump);
    if (size)
        format_source_note(source,
                           "%u points per strand, found from gaps between points: set "
                           "--points-per-strand if this is wrong",
                           size);
    return size;
}

uint32_t cloud_find_size(FormatSource *source, Reader *reader, const float (*positions)[3],
                         uint32_t count)
{
    uint32_t size = source->wishes.points_per_strand;
    if (!reader_ok(reader)) return 0;
    source->used_points = true;
    if (size == 1 || (size && count % size))
        reader_fail(reader,
                    "%u points cannot be divided into strands of %u points: expected another "
                    "--points-per-strand",
                    count, size);
    if (size == 0 && count < 4)
        reader_fail(reader,
                    "the file does not say where its strands end (%u points): expected "
                    "--points-per-strand N",
                    count);
    if (!reader_ok(reader)) return 0;
    return size ? size : guess(source, reader, positions, count);
}

void cloud_set_strands(FormatSource *source, uint32_t size)
{
    for (uint32_t s = 0; s <= source->strands.strand_count; s++)
        source->strands.first[s] = s * size;
}
