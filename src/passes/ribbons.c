// SPDX-License-Identifier: MIT
#include "passes/ribbons.h"

#include "gpu/gpu_dispatch.h"
#include "gpu/gpu_uniforms.h"

#include "glsl/draw/draw.h"

enum {
    ALIGNED = 64, // a bound range begins at a multiple of this, which all drivers allow
    RECORD_BYTES = 16 * RIBBON_TEXELS, // bytes of a slot's record
    KEY_BYTES = 4,
};

static int64_t smaller(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

// Makes room for `size` bytes. The buffer may be larger than what shaders can see at once; they see
// pieces of it.
static Result make_room(GpuBuffer *buffer, const GpuLimits *limits, const char *what, int64_t size,
                        GLenum texel_format, Error *error)
{
    if (buffer->size >= size) return RESULT_OK;
    gpu_buffer_destroy(buffer);
    return gpu_buffer_create_pieces(buffer, limits, what, size, texel_format, error);
}

static void clear(const GpuBuffer *buffer, int64_t size)
{
    const GLuint zero = 0;
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer->buffer);
    glClearBufferSubData(GL_SHADER_STORAGE_BUFFER, GL_R32UI, 0, (GLsizeiptr)size, GL_RED_INTEGER,
                         GL_UNSIGNED_INT, &zero);
}

// Maps the first `size` bytes for reading. NULL on failure.
static const void *map(const GpuBuffer *buffer, int64_t size)
{
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer->buffer);
    return glMapBufferRange(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)size, GL_MAP_READ_BIT);
}

static void unmap(const GpuBuffer *buffer)
{
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer->buffer);
    glUnmapBuffer(GL_SHADER_STORAGE_BUFFER);
}

Result ribbons_create(Ribbons *ribbons, const GpuLimits *limits, Error *error)
{
    *ribbons = (Ribbons){
        .project = {.file = "draw/block_project.comp", .group_size = limits->sizes.strands},
        .limits = limits,
        .cull = {.limits = limits},
        .skips = true};
    return gpu_buffer_create(&ribbons->counts, limits, "counts", BLOCK_COUNT_WORDS * 4, NULL, 0,
                             error);
}

void ribbons_destroy(Ribbons *ribbons)
{
    look_programs_destroy(&ribbons->project);
    cull_destroy(&ribbons->cull);
    gpu_buffer_destroy(&ribbons->records);
    gpu_buffer_destroy(&ribbons->keys);
    gpu_buffer_destroy(&ribbons->counts);
    *ribbons = (Ribbons){0};
}

Result ribbons_begin(Ribbons *ribbons, uint64_t segments, const RibbonsBase *base, Error *error)
{
    const GpuLimits *limits = ribbons->limits;
    int64_t most = smaller(RIBBONS_MOST, limits->texture_texels / RIBBON_TEXELS - 1);
    if (segments > (uint64_t)most)
        return error_set(error, RESULT_FAILED,
                         "%llu segments of hair: expected at most %lld, the limit of --raster "
                         "compute on this device, or --raster blocks, which has no limit",
                         (unsigned long long)segments, (long long)most);
    int64_t count = 1 + (int64_t)segments;
    TRY(make_room(&ribbons->records, limits, "ribbons", count * RECORD_BYTES, GL_RGBA32UI, error));
    TRY(make_room(&ribbons->keys, limits, "depths", count * KEY_BYTES, GL_R32UI, error));
    TRY(cull_begin(&ribbons->cull, &base->cull, ribbons->skips, error));
    clear(&ribbons->keys, count * KEY_BYTES);
    clear(&ribbons->counts, ribbons->counts.size);
    ribbons->base = *base;
    ribbons->slots = 0;
    ribbons->strands = 0;
    return RESULT_OK;
}

static void bind_range(const GpuBuffer *buffer, GLuint binding, int64_t begin, int64_t end,
                       size_t size)
{
    glBindBufferRange(GL_SHADER_STORAGE_BUFFER, binding, buffer->buffer,
                      (GLintptr)(begin * (int64_t)size),
                      (GLsizeiptr)((end - begin) * (int64_t)size));
}

// Projects part.drawn_strands strands beginning with part.first_strand. Their ribbons must fit into
// the range that a shader can see.
static Result project_part(Ribbons *ribbons, const HairBatch *batch, const Look *look,
                           const MaterialParams *part, int64_t slots, Error *error)
{
    int64_t first = (int64_t)ribbons->slots, begin = first / ALIGNED * ALIGNED;
    gpu_uniforms_set(BIND_MATERIAL, part, sizeof *part);
    if (ribbons->cull.tries) TRY(cull_list(&ribbons->cull, batch, part, error));
    TRY(look_programs_use(&ribbons->project, look, batch, error));
    bind_range(&ribbons->records, BIND_RIBBONS_OUT, begin, first + slots, RECORD_BYTES);
    bind_range(&ribbons->keys, BIND_KEYS_OUT, begin, first + slots, KEY_BYTES);
    glUniform1i(0, (GLint)(first - begin));
    glUniform2i(1, (GLint)part->drawn_strands, ribbons->cull.tries);
    gpu_dispatch(ribbons->limits, part->drawn_strands, (uint64_t)ribbons->limits->sizes.strands, 1);
    ribbons->slots += (size_t)slots;
    ribbons->strands += part->drawn_strands;
    return RESULT_OK;
}

Result ribbons_add(Ribbons *ribbons, const HairBatch *batch, const Look *look, Error *error)
{
    MaterialParams part = look_material(look, batch);
    TRY(cull_make_room(&ribbons->cull, part.drawn_strands, error));
    int64_t of_strand = (int64_t)(batch->vertex_count - 1) * part.smooth_parts,
            most = (ribbons->limits->storage_block / RECORD_BYTES - ALIGNED) / of_strand;
    uint strands = part.drawn_strands;
    gpu_buffer_bind_texture(&batch->position, BIND_POSITION);
    gpu_buffer_bind_texture(&batch->strand_id, BIND_STRAND_ID);
    gpu_buffer_bind_storage(&ribbons->counts, BIND_BLOCK_COUNTS_OUT);
    for (uint first = 0; first < strands; first += part.drawn_strands) {
        part.first_strand = first;
        part.drawn_strands = (uint)smaller(strands - first, most);
        int64_t slots = part.drawn_strands * of_strand;
        TRY(project_part(ribbons, batch, look, &part, slots, error));
    }
    return RESULT_OK;
}

void ribbons_take_counts(Ribbons *ribbons, const uint32_t *counts, const uint32_t *tally)
{
    cull_count(&ribbons->cull, tally);
    ribbons->segments = ribbons->culled = 0;
    for (int i = 0; i < BLOCK_COUNT_WORDS; i += 16) {
        ribbons->segments += counts[i];
        ribbons->culled += counts[i + 1];
    }
    ribbons->culled += ribbons->cull.outside;
    ribbons->skips = ribbons->culled + ribbons->cull.hidden > ribbons->strands / CULL_SHARE;
}

Result ribbons_count(Ribbons *ribbons, Error *error)
{
    bool tries = ribbons->cull.tries;
    const uint32_t *tally = tries ? map(&ribbons->cull.tally, CULL_TALLY_BYTES) : NULL,
                   *counts = map(&ribbons->counts, ribbons->counts.size);
    bool good = counts && (tally || !tries);
    if (good) ribbons_take_counts(ribbons, counts, tally);
    if (tally) unmap(&ribbons->cull.tally);
    if (counts) unmap(&ribbons->counts);
    return good ? RESULT_OK : error_set(error, RESULT_FAILED, "hair's counts cannot be read");
}
