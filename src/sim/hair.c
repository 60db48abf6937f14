// SPDX-License-Identifier: MIT
#include "sim/hair.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Strand numbers sorted by vertex count, then by the number of held vertices. Strands in which both
// are equal keep the file's order.
typedef struct Order {
    uint32_t *strand;
    uint32_t count;
} Order;

// One pass of a radix sort: orders the strands by `key`, at most `most`.
static bool order_by(Order *order, const Strands *strands, uint32_t most,
                     uint32_t (*key)(const Strands *strands, uint32_t s))
{
    uint32_t *sorted = malloc(((size_t)order->count + 1) * sizeof *sorted),
             *start = calloc((size_t)most + 2, sizeof *start);
    bool good = sorted && start;
    if (good) {
        for (uint32_t s = 0; s < order->count; ++s) ++start[key(strands, s) + 1];
        for (uint32_t n = 0; n <= most; ++n) start[n + 1] += start[n];
        for (uint32_t i = 0; i < order->count; ++i)
            sorted[start[key(strands, order->strand[i])]++] = order->strand[i];
        memcpy(order->strand, sorted, order->count * sizeof *sorted);
    }
    free(start);
    free(sorted);
    return good;
}

static uint32_t size_of(const Strands *strands, uint32_t s)
{
    return strands_size(strands, s);
}

static Result order_strands(Order *order, const Strands *strands, Error *error)
{
    uint32_t most = 0;
    order->count = strands->strand_count;
    order->strand = malloc(((size_t)order->count + 1) * sizeof *order->strand);
    for (uint32_t s = 0; s < order->count && order->strand; ++s) {
        order->strand[s] = s;
        if (strands_size(strands, s) > most) most = strands_size(strands, s);
    }
    bool good = order->strand && order_by(order, strands, most, strands_held) &&
                order_by(order, strands, most, size_of);
    return good ? RESULT_OK
                : error_set(error, RESULT_FAILED, "no memory for %u strands", order->count);
}

static uint32_t slots_of(uint32_t strands)
{
    return hair_slots(&(HairBatch){.strand_count = strands});
}

// The end of the batch that begins at `begin`. A batch has one vertex count and one number of held
// vertices, and a buffer must hold what a solver stores for it.
static uint32_t batch_end(const Order *order, const Strands *strands, uint32_t begin,
                          const GpuLimits *limits)
{
    uint32_t n = strands_size(strands, order->strand[begin]),
             held = strands_held(strands, order->strand[begin]), end = begin;
    int64_t texels = limits->storage_block / (16 * HAIR_MOST_SCRATCH);
    if (limits->texture_texels < texels) texels = limits->texture_texels;
    while (end < order->count && strands_size(strands, order->strand[end]) == n &&
           strands_held(strands, order->strand[end]) == held &&
           (int64_t)slots_of(end - begin + 1) * n <= texels)
        ++end;
    return end;
}

typedef float Float4[4];

// Fills in the rest shape and the first positions of slot `slot` from the file's strand `s`.
static void fill_strand(Float4 *rest, Float4 *position, const HairBatch *batch, uint32_t slot,
                        const Strands *strands, uint32_t s)
{
    const float(*q)[3] = (const float(*)[3]) & strands->position[strands->first[s]];
    double total = 0;
    for (uint32_t j = 0; j < batch->vertex_count; ++j) {
        size_t at = hair_address(batch, slot, j);
        memcpy(position[at], q[j], sizeof q[j]);
        position[at][3] = 0;
        if (j == 0) continue;
        double r[3], length = 0;
        for (int k = 0; k < 3; ++k)
            r[k] = (double)q[j][k] - (double)q[j - 1][k], length += r[k] * r[k];
        length = sqrt(length);
        for (int k = 0; k < 3; ++k) rest[at][k] = (float)(r[k] / length);
        rest[at][3] = (float)length;
        total += (double)rest[at][3];
    }
    size_t root = hair_address(batch, slot, 0);
    memcpy(rest[root], q[0], sizeof q[0]);
    rest[root][3] = (float)total;
}

static Result upload(HairBatch *batch, const GpuLimits *limits, const void *rest,
                     const void *position, const uint32_t *ids, Error *error)
{
    int64_t size = (int64_t)batch->vertex_count * hair_slots(batch) * (int64_t)sizeof(Float4);
    TRY(gpu_buffer_create(&batch->position, limits, "hair positions", size, position, GL_RGBA32F,
                          error));
    TRY(gpu_buffer_create(&batch->rest, limits, "hair style", size, rest, GL_RGBA32F, error));
    return gpu_buffer_create(&batch->strand_id, limits, "strand numbers",
                             (int64_t)hair_slots(batch) * 4, ids, GL_R32UI, error);
}

static Result create_batch(HairBatch *batch, const Strands *strands, uint32_t first_id,
                           const GpuLimits *limits, Error *error)
{
    uint32_t slots = hair_slots(batch);
    size_t particles = (size_t)batch->vertex_count * slots;
    Float4 *rest = malloc(particles * sizeof *rest),
           *position = malloc(particles * sizeof *position);
    uint32_t *ids = malloc(slots * sizeof *ids);
    Result result = RESULT_FAILED;
    if (rest && position && ids) {
        for (uint32_t slot = 0; slot < slots; ++slot) {
            uint32_t s = batch->strand[slot < batch->strand_count ? slot : batch->strand_count - 1];
            fill_strand(rest, position, batch, slot, strands, s);
            ids[slot] = first_id + s;
        }
        result = upload(batch, limits, rest, position, ids, error);
    } else {
        error_set(error, RESULT_FAILED, "no memory for %zu particles", particles);
    }
    free(rest);
    free(position);
    free(ids);
    return result;
}

static Result create_batches(Hair *hair, const Strands *strands, const Order *order,
                             uint32_t first_id, const GpuLimits *limits, Error *error)
{
    for (uint32_t begin = 0; begin < order->count;) {
        uint32_t end = batch_end(order, strands, begin, limits),
                 n = strands_size(strands, order->strand[begin]);
        if (end == begin)
            return error_set(error, RESULT_FAILED,
                             "a strand of %u vertices exceeds the limit of this driver's buffers: "
                             "expected fewer",
                             n);
        HairBatch *more = realloc(hair->batches, (hair->batch_count + 1) * sizeof *more);
        if (!more) return error_set(error, RESULT_FAILED, "no memory for a batch of strands");
        hair->batches = more;
        HairBatch *batch = &hair->batches[hair->batch_count++];
        *batch = (HairBatch){.vertex_count = n,
                             .strand_count = end - begin,
                             .held = strands_held(strands, order->strand[begin]),
                             .strand = malloc((end - begin) * sizeof *batch->strand)};
        if (!batch->strand) return error_set(error, RESULT_FAILED, "no memory for a batch");
        memcpy(batch->strand, &order->strand[begin], (end - begin) * sizeof *batch->strand);
        TRY(create_batch(batch, strands, first_id, limits, error));
        begin = end;
    }
    return RESULT_OK;
}

static double shortest_segment(const Strands *strands, uint32_t s)
{
    double least = INFINITY; // the square
    for (uint32_t v = strands->first[s] + 1; v < strands->first[s + 1]; ++v) {
        const float *a = strands->position[v - 1], *b = strands->position[v];
        double x = (double)b[0] - (double)a[0], y = (double)b[1] - (double)a[1],
               z = (double)b[2] - (double)a[2];
        double square = x * x + y * y + z * z;
        if (square < least) least = square;
    }
    return sqrt(least);
}

static void measure_lengths(Hair *hair, const Strands *strands)
{
    double evenness = 1;
    for (uint32_t s = 0; s < strands->strand_count; ++s) {
        double length = strands_length(strands, s);
        hair->longest = fmaxf(hair->longest, (float)length);
        evenness =
            fmin(evenness, shortest_segment(strands, s) * (strands_size(strands, s) - 1) / length);
    }
    hair->evenness = (float)evenness;
}

Result hair_create(Hair *hair, const Strands *strands, uint32_t first_id, const GpuLimits *limits,
                   Error *error)
{
    *hair = (Hair){.strand_count = strands->strand_count,
                   .particle_count = strands->vertex_count,
                   .segment_count = strands->vertex_count - strands->strand_count};
    strands_bounds(strands, hair->low, hair->high);
    measure_lengths(hair, strands);
    Order order = {0};
    Result result = order_strands(&order, strands, error);
    THEN(result, create_batches(hair, strands, &order, first_id, limits, error));
    free(order.strand);
    if (result != RESULT_OK) hair_destroy(hair);
    return result;
}

void hair_destroy(Hair *hair)
{
    for (uint32_t i = 0; i < hair->batch_count; ++i) {
        free(hair->batches[i].strand);
        gpu_buffer_destroy(&hair->batches[i].position);
        gpu_buffer_destroy(&hair->batches[i].rest);
        gpu_buffer_destroy(&hair->batches[i].strand_id);
        gpu_buffer_destroy(&hair->batches[i].paint);
    }
    free(hair->batches);
    *hair = (Hair){0};
}

static Result refuse_memory(const HairBatch *batch, Error *error)
{
    return error_set(error, RESULT_FAILED, "no memory for the positions of %u strands",
                     batch->strand_count);
}

Result hair_read_positions(const Hair *hair, float (*positions)[3], Error *error)
{
    for (uint32_t i = 0; i < hair->batch_count; ++i) {
        const HairBatch *batch = &hair->batches[i];
        Float4 *read = gpu_buffer_read(&batch->position);
        if (!read) return refuse_memory(batch, error);
        for (uint32_t s = 0; s < batch->strand_count; ++s)
            for (uint32_t j = 0; j < batch->vertex_count; ++j)
                memcpy(*positions++, read[hair_address(batch, s, j)], sizeof *positions);
        free(read);
    }
    return RESULT_OK;
}

Result hair_write_positions(const Hair *hair, const float (*positions)[3], Error *error)
{
    for (uint32_t i = 0; i < hair->batch_count; ++i) {
        const HairBatch *batch = &hair->batches[i];
        Float4 *written = malloc((size_t)batch->position.size + 1);
        if (!written) return refuse_memory(batch, error);
        for (uint32_t slot = 0; slot < hair_slots(batch); ++slot) {
            uint32_t s = slot < batch->strand_count ? slot : batch->strand_count - 1;
            for (uint32_t j = 0; j < batch->vertex_count; ++j) {
                float *at = written[hair_address(batch, slot, j)];
                memcpy(at, positions[(size_t)s * batch->vertex_count + j], sizeof *positions);
                at[3] = 0;
            }
        }
        gpu_buffer_write(&batch->position, 0, written, batch->position.size);
        free(written);
        positions += (size_t)batch->strand_count * batch->vertex_count;
    }
    return RESULT_OK;
}
