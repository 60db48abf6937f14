// SPDX-License-Identifier: MIT
#include "passes/compute_bins.h"

#include "gpu/gpu_dispatch.h"
#include "gpu/shader.h"

#include "glsl/draw/draw.h"

enum { PAIR_BYTES = 8, FIRST_ROOM = 1 << 18 };

static int64_t smaller(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

static Result build(ComputeBins *bins, Error *error)
{
    int lanes = bins->limits->sizes.items;
    const ShaderDefine counts[] = {{"GROUP_SIZE", lanes}, {"FILL", 0}, {NULL, 0}},
                       fills[] = {{"GROUP_SIZE", lanes}, {"FILL", 1}, {NULL, 0}},
                       sorts[] = {{"GROUP_SIZE", bins->limits->sizes.sort},
                                  {"STAGED", bins->limits->sizes.stages},
                                  {NULL, 0}};
    TRY(shader_build_compute(&bins->count, "draw/compute_list.comp", counts, error));
    TRY(shader_build_compute(&bins->fill, "draw/compute_list.comp", fills, error));
    TRY(shader_build_compute(&bins->place, "draw/compute_place.comp", counts, error));
    return shader_build_compute(&bins->sort, "draw/compute_sort.comp", sorts, error);
}

static Result make_room(ComputeBins *bins, int64_t room, Error *error)
{
    bins->room = 0;
    TRY(gpu_buffer_reserve(&bins->pairs, bins->limits, "ribbons of tiles", room * PAIR_BYTES,
                           GL_RG32UI, error));
    TRY(gpu_buffer_reserve(&bins->sorted, bins->limits, "sorted ribbons", room * PAIR_BYTES,
                           GL_RG32UI, error));
    bins->room = room;
    return RESULT_OK;
}

Result compute_bins_create(ComputeBins *bins, const GpuLimits *limits, int width, int height,
                           int64_t pool_bytes, Error *error)
{
    int64_t bytes = limits->storage_block;
    if (pool_bytes) bytes = smaller(bytes, pool_bytes / 2);
    *bins = (ComputeBins){
        .limits = limits,
        .columns = (width + TILE_SIDE - 1) / TILE_SIDE,
        .rows = (height + TILE_SIDE - 1) / TILE_SIDE,
        .most_room = smaller(smaller(bytes / PAIR_BYTES, limits->texture_texels), INT32_MAX / 2)};
    if (bins->most_room < 1) bins->most_room = 1;
    int64_t tiles = (int64_t)bins->columns * bins->rows * 4;
    Result result = build(bins, error);
    THEN(result, gpu_buffer_create(&bins->counts, limits, "tiles", tiles, NULL, 0, error));
    THEN(result, gpu_buffer_create(&bins->tiles, limits, "tiles in use", tiles, NULL, 0, error));
    THEN(result, gpu_buffer_create(&bins->ends, limits, "tiles' lists", tiles, NULL, 0, error));
    THEN(result,
         gpu_buffer_create(&bins->use, limits, "use of tiles", TILE_USE_WORDS * 4, NULL, 0, error));
    THEN(result, make_room(bins, smaller(FIRST_ROOM, bins->most_room), error));
    if (result != RESULT_OK) compute_bins_destroy(bins);
    return result;
}

void compute_bins_destroy(ComputeBins *bins)
{
    const GLuint programs[] = {bins->count, bins->place, bins->fill, bins->sort};
    GpuBuffer *const buffers[] = {&bins->counts, &bins->ends,  &bins->tiles,
                                  &bins->use,    &bins->pairs, &bins->sorted};
    for (size_t i = 0; i < sizeof programs / sizeof *programs; ++i) shader_release(programs[i]);
    for (size_t i = 0; i < sizeof buffers / sizeof *buffers; ++i) gpu_buffer_destroy(buffers[i]);
    *bins = (ComputeBins){0};
}

static void list(const ComputeBins *bins, GLuint program, int64_t slots, int first, int end)
{
    glUseProgram(program);
    glUniform3i(0, bins->columns, first, end);
    glUniform1i(1, (GLint)slots);
    if (program == bins->fill) glUniform1ui(2, (GLuint)bins->room);
    gpu_dispatch(bins->limits, (uint64_t)slots, (uint64_t)bins->limits->sizes.items, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

static void place(const ComputeBins *bins, int first, int end)
{
    glUseProgram(bins->place);
    glUniform2i(0, first * bins->columns, end * bins->columns);
    gpu_dispatch(bins->limits, (uint64_t)(end - first) * (uint64_t)bins->columns,
                 (uint64_t)bins->limits->sizes.items, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void compute_bins_fill(ComputeBins *bins, const GpuBuffer *ribbons, const GpuBuffer *keys,
                       int64_t slots, int first, int end)
{
    gpu_buffer_clear(&bins->counts, 0);
    gpu_buffer_clear(&bins->use, 0);
    gpu_buffer_bind_storage(&bins->counts, BIND_TILE_COUNTS_OUT);
    gpu_buffer_bind_storage(&bins->ends, BIND_TILE_ENDS_OUT);
    gpu_buffer_bind_storage(&bins->use, BIND_TILE_USE_OUT);
    gpu_buffer_bind_storage(&bins->pairs, BIND_PAIRS_OUT);
    gpu_buffer_bind_storage(&bins->tiles, BIND_TILES_OUT);
    gpu_buffer_bind_texture(ribbons, BIND_RIBBONS);
    gpu_buffer_bind_texture(keys, BIND_KEYS);
    gpu_buffer_bind_texture(&bins->sorted, BIND_SORTED);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT); // the projection wrote the ribbons
    list(bins, bins->count, slots, first, end);
    place(bins, first, end);
    list(bins, bins->fill, slots, first, end);
}

void compute_bins_dispatch(const ComputeBins *bins)
{
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, bins->use.buffer);
    glDispatchComputeIndirect((GLintptr)TILE_USE_GROUPS * 4);
}

void compute_bins_sort(const ComputeBins *bins)
{
    glUseProgram(bins->sort);
    glUniform1ui(0, (GLuint)bins->room);
    glBindImageTexture(IMAGE_PAIRS, bins->pairs.texture, 0, GL_FALSE, 0, GL_READ_WRITE, GL_RG32UI);
    glBindImageTexture(IMAGE_SORTED, bins->sorted.texture, 0, GL_FALSE, 0, GL_READ_WRITE,
                       GL_RG32UI);
    glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
    compute_bins_dispatch(bins);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
}

ComputeUse compute_bins_use(const uint32_t *words)
{
    // cppcheck-suppress ctuArrayIndex // it does not know TILE_USE_WORDS
    uint64_t coarse = (uint64_t)words[TILE_USE_COARSE] << 10;
    ComputeUse use = {.pairs = words[TILE_USE_PAIRS], .longest = words[TILE_USE_LONGEST]};
    if (coarse > use.pairs) use.pairs = coarse; // the 32-bit count wrapped around
    return use;
}

Result compute_bins_measure(const ComputeBins *bins, ComputeUse *use, Error *error)
{
    GLuint words[TILE_USE_WORDS] = {0};
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, bins->use.buffer);
    glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof words, words);
    *use = compute_bins_use(words);
    return gpu_check("binning ribbons", error);
}

Result compute_bins_grow(ComputeBins *bins, uint64_t pairs, bool *grown, Error *error)
{
    *grown = pairs <= (uint64_t)bins->most_room;
    if (!*grown) return RESULT_OK;
    return make_room(bins, smaller((int64_t)pairs + (int64_t)pairs / 4, bins->most_room), error);
}
