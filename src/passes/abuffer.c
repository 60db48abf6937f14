// SPDX-License-Identifier: MIT
#include "passes/abuffer.h"

#include "glsl/draw/draw.h"

enum { NODE_BYTES = 16, SHARD_STEP = SHARD_COUNT * SHARD_RUN, FIRST_NODES = 1 << 19 };

static int64_t smaller(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

// Rounds up so that every shard has a whole number of runs.
static int64_t round_up_nodes(int64_t nodes)
{
    return (nodes + SHARD_STEP - 1) / SHARD_STEP * SHARD_STEP;
}

static Result create_pool(ABuffer *abuffer, int64_t nodes, Error *error)
{
    gpu_buffer_destroy(&abuffer->nodes);
    return gpu_buffer_create(&abuffer->nodes, abuffer->limits, "A-buffer", nodes * NODE_BYTES, NULL,
                             GL_RGBA32UI, error);
}

static Result build_resolve(ABuffer *abuffer, int over_mesh, Error *error)
{
    const ShaderDefine defines[] = {{"LAYERS", abuffer->layers},
                                    {"BASE", over_mesh},
                                    {"RIMS", over_mesh && !abuffer->nearest},
                                    {"TONE", abuffer->tone},
                                    {"DEPTH", abuffer->depth},
                                    {"SAMPLES", abuffer->samples},
                                    {"MOST_TURNS", abuffer->most_turns},
                                    {NULL, 0}};
    return shader_build_draw(&abuffer->resolve[over_mesh], "draw/resolve.vert", "draw/resolve.frag",
                             defines, error);
}

Result abuffer_create(ABuffer *abuffer, const GpuLimits *limits, int width, int samples, int layers,
                      int tone, Aov aov, bool software, int64_t pool_bytes, Error *error)
{
    *abuffer = (ABuffer){.limits = limits,
                         .shards = SHARD_COUNT,
                         .layers = layers,
                         .width = width * samples,
                         .samples = samples,
                         .tone = tone,
                         .depth = aov == AOV_DEPTH,
                         .nearest = aov > AOV_COVERAGE,
                         .most_turns = software ? ABUFFER_MOST_TURNS : INT32_MAX};
    int64_t bytes = pool_bytes ? smaller(pool_bytes, limits->storage_block) : limits->storage_block;
    int64_t most = smaller(smaller(bytes / NODE_BYTES, limits->texture_texels), INT32_MAX);
    abuffer->most_nodes = most < SHARD_STEP ? SHARD_STEP : most / SHARD_STEP * SHARD_STEP;
    glGenVertexArrays(1, &abuffer->vertex_array);
    Result result = create_pool(abuffer, smaller(FIRST_NODES, abuffer->most_nodes), error);
    THEN(result, gpu_buffer_create(&abuffer->counters, limits, "A-buffer counters",
                                   COUNTER_WORDS * 4, NULL, 0, error));
    THEN(result, gpu_buffer_create(&abuffer->extent, limits, "hair's screen box", 16, NULL, GL_R32I,
                                   error));
    const GLuint none = 0;
    THEN(result,
         gpu_buffer_create(&abuffer->shortage, limits, "A-buffer's flag", 4, &none, 0, error));
    THEN(result, build_resolve(abuffer, 0, error));
    if (result != RESULT_OK) abuffer_destroy(abuffer);
    return result;
}

Result abuffer_add_base(ABuffer *abuffer, Error *error)
{
    return abuffer->resolve[1] ? RESULT_OK : build_resolve(abuffer, 1, error);
}

void abuffer_destroy(ABuffer *abuffer)
{
    for (int i = 0; i < 2; ++i) shader_release(abuffer->resolve[i]);
    if (abuffer->vertex_array) glDeleteVertexArrays(1, &abuffer->vertex_array);
    gpu_buffer_destroy(&abuffer->nodes);
    gpu_buffer_destroy(&abuffer->heads);
    gpu_buffer_destroy(&abuffer->counters);
    gpu_buffer_destroy(&abuffer->extent);
    gpu_buffer_destroy(&abuffer->shortage);
    late_read_destroy(&abuffer->counts);
    *abuffer = (ABuffer){0};
}

int abuffer_most_rows(const ABuffer *abuffer, int height)
{
    int64_t pixels = smaller(abuffer->limits->storage_block / 4, abuffer->limits->texture_texels);
    return (int)smaller(height, pixels / abuffer->width / abuffer->samples);
}

int abuffer_shard_nodes(const ABuffer *abuffer)
{
    return (int)(abuffer->nodes.size / NODE_BYTES / abuffer->shards);
}

static void clear(const GpuBuffer *buffer, int64_t size)
{
    const GLuint zero = 0;
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer->buffer);
    glClearBufferSubData(GL_SHADER_STORAGE_BUFFER, GL_R32UI, 0, (GLsizeiptr)size, GL_RED_INTEGER,
                         GL_UNSIGNED_INT, &zero);
}

Result abuffer_begin(ABuffer *abuffer, int rows, const int box[4], Error *error)
{
    int64_t size = (int64_t)rows * abuffer->samples * abuffer->width * 4;
    TRY(gpu_buffer_reserve(&abuffer->heads, abuffer->limits, "A-buffer heads", size, GL_R32UI,
                           error));
    clear(&abuffer->heads, size);
    clear(&abuffer->counters, abuffer->counters.size);
    gpu_buffer_write(&abuffer->extent, 0, box, 16);
    gpu_buffer_bind_storage(&abuffer->nodes, BIND_NODES_OUT);
    gpu_buffer_bind_storage(&abuffer->heads, BIND_HEADS_OUT);
    gpu_buffer_bind_storage(&abuffer->counters, BIND_COUNTERS_OUT);
    gpu_buffer_bind_storage(&abuffer->extent, BIND_EXTENT_OUT);
    return RESULT_OK;
}

enum { COUNTER_BYTES = COUNTER_WORDS * 4 };

Result abuffer_send_use(ABuffer *abuffer, const Cull *cull, Error *error)
{
    LateRead *counts = &abuffer->counts;
    TRY(late_read_begin(counts, "A-buffer counters", COUNTER_BYTES + CULL_TALLY_BYTES, error));
    late_read_buffer(counts, 0, &abuffer->counters, COUNTER_BYTES);
    if (cull->tries) late_read_buffer(counts, COUNTER_BYTES, &cull->tally, CULL_TALLY_BYTES);
    late_read_send(counts);
    return RESULT_OK;
}

Result abuffer_take_use(ABuffer *abuffer, ABufferUse *use, Cull *cull, Error *error)
{
    const void *bytes;
    TRY(late_read_open(&abuffer->counts, "A-buffer counters", &bytes, error));
    const uint32_t *counters = bytes;
    *use = (ABufferUse){.segments = counters[COUNTER_SEGMENTS], .culled = counters[COUNTER_CULLED]};
    for (int i = 0; i < SHARD_COUNT; ++i) {
        uint32_t count = counters[i * SHARD_RUN];
        use->fragments += count;
        if (count > use->fullest) use->fullest = count;
    }
    cull_count(cull, cull->tries ? counters + COUNTER_WORDS : NULL);
    late_read_close(&abuffer->counts);
    return RESULT_OK;
}

bool abuffer_holds(const ABuffer *abuffer, const ABufferUse *use)
{
    return use->fullest <= (uint32_t)abuffer_shard_nodes(abuffer);
}

Result abuffer_grow(ABuffer *abuffer, const ABufferUse *use, bool *grown, Error *error)
{
    int64_t needed = round_up_nodes((int64_t)use->fullest * abuffer->shards);
    if (needed > abuffer->most_nodes && (int64_t)use->fragments <= abuffer->most_nodes) {
        abuffer->shards = 1;
        needed = round_up_nodes((int64_t)use->fragments);
    }
    *grown = needed <= abuffer->most_nodes;
    int64_t nodes = smaller(round_up_nodes(needed + needed / 4), abuffer->most_nodes);
    return nodes * NODE_BYTES > abuffer->nodes.size ? create_pool(abuffer, nodes, error)
                                                    : RESULT_OK;
}

void abuffer_resolve(const ABuffer *abuffer, const RenderTarget *target, bool over_mesh)
{
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
    gpu_buffer_bind_texture(&abuffer->nodes, BIND_NODES);
    gpu_buffer_bind_texture(&abuffer->heads, BIND_HEADS);
    gpu_buffer_bind_texture(&abuffer->extent, BIND_EXTENT);
    gpu_buffer_bind_storage(&abuffer->shortage, BIND_SHORTAGE_OUT);
    glActiveTexture(GL_TEXTURE0 + BIND_BASE);
    glBindTexture(GL_TEXTURE_2D, target->base);
    glActiveTexture(GL_TEXTURE0 + BIND_SURFACE);
    glBindTexture(GL_TEXTURE_2D, target->depth);
    glActiveTexture(GL_TEXTURE0 + BIND_RIM);
    glBindTexture(GL_TEXTURE_2D, target->rim);
    glActiveTexture(GL_TEXTURE0 + BIND_RIM_DEPTH);
    glBindTexture(GL_TEXTURE_2D, target->rim_depth);
    glBindFramebuffer(GL_FRAMEBUFFER, target->image_frame);
    glUseProgram(abuffer->resolve[over_mesh]);
    glBindVertexArray(abuffer->vertex_array);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}
