// SPDX-License-Identifier: MIT
#include "gpu/gl_state.h"

#include "gpu/gpu_error.h"

// --- What there is. Tables 23.5 to 23.74 of the OpenGL 4.3 core specification.

// Switches that are off by default, apart from those that each viewport or draw buffer has.
static const GLenum SWITCHES[] = {
    GL_COLOR_LOGIC_OP,
    GL_CULL_FACE,
    GL_DEPTH_CLAMP,
    GL_DEPTH_TEST,
    GL_FRAMEBUFFER_SRGB,
    GL_POLYGON_OFFSET_FILL,
    GL_POLYGON_SMOOTH,
    GL_PRIMITIVE_RESTART,
    GL_PRIMITIVE_RESTART_FIXED_INDEX,
    GL_RASTERIZER_DISCARD,
    GL_SAMPLE_ALPHA_TO_COVERAGE,
    GL_SAMPLE_ALPHA_TO_ONE,
    GL_SAMPLE_COVERAGE,
    GL_SAMPLE_MASK,
    GL_SAMPLE_SHADING,
    GL_STENCIL_TEST,
    GL_CLIP_DISTANCE0,
    GL_CLIP_DISTANCE1,
    GL_CLIP_DISTANCE2,
    GL_CLIP_DISTANCE3,
    GL_CLIP_DISTANCE4,
    GL_CLIP_DISTANCE5,
    GL_CLIP_DISTANCE6,
    GL_CLIP_DISTANCE7,
};
enum { SWITCH_COUNT = sizeof SWITCHES / sizeof *SWITCHES };
_Static_assert((int)SWITCH_COUNT <= (int)GL_STATE_SWITCHES, "room for all");

static const struct {
    GLenum name;
    GLint initial;
} STORES[] = {
    {GL_PACK_ALIGNMENT, 4},     {GL_PACK_LSB_FIRST, 0},    {GL_PACK_ROW_LENGTH, 0},
    {GL_PACK_SKIP_PIXELS, 0},   {GL_PACK_SKIP_ROWS, 0},    {GL_PACK_SWAP_BYTES, 0},
    {GL_PACK_IMAGE_HEIGHT, 0},  {GL_PACK_SKIP_IMAGES, 0},  {GL_UNPACK_ALIGNMENT, 4},
    {GL_UNPACK_LSB_FIRST, 0},   {GL_UNPACK_ROW_LENGTH, 0}, {GL_UNPACK_SKIP_PIXELS, 0},
    {GL_UNPACK_SKIP_ROWS, 0},   {GL_UNPACK_SWAP_BYTES, 0}, {GL_UNPACK_IMAGE_HEIGHT, 0},
    {GL_UNPACK_SKIP_IMAGES, 0},
};
enum { STORE_COUNT = sizeof STORES / sizeof *STORES };
_Static_assert((int)STORE_COUNT <= (int)GL_STATE_STORES, "room for all");

typedef struct Binding {
    GLenum target, name;
    int since; // as epoxy_gl_version; 0: 4.3
} Binding;

static const Binding BUFFERS[] = {
    {GL_ARRAY_BUFFER, GL_ARRAY_BUFFER_BINDING, 0},
    {GL_ATOMIC_COUNTER_BUFFER, GL_ATOMIC_COUNTER_BUFFER_BINDING, 0},
    {GL_COPY_READ_BUFFER, GL_COPY_READ_BUFFER_BINDING, 0},
    {GL_COPY_WRITE_BUFFER, GL_COPY_WRITE_BUFFER_BINDING, 0},
    {GL_DISPATCH_INDIRECT_BUFFER, GL_DISPATCH_INDIRECT_BUFFER_BINDING, 0},
    {GL_DRAW_INDIRECT_BUFFER, GL_DRAW_INDIRECT_BUFFER_BINDING, 0},
    {GL_PIXEL_PACK_BUFFER, GL_PIXEL_PACK_BUFFER_BINDING, 0},
    {GL_PIXEL_UNPACK_BUFFER, GL_PIXEL_UNPACK_BUFFER_BINDING, 0},
    {GL_QUERY_BUFFER, GL_QUERY_BUFFER_BINDING, 44},
    {GL_SHADER_STORAGE_BUFFER, GL_SHADER_STORAGE_BUFFER_BINDING, 0},
    {GL_TEXTURE_BUFFER, GL_TEXTURE_BUFFER_BINDING, 0},
    {GL_UNIFORM_BUFFER, GL_UNIFORM_BUFFER_BINDING, 0},
};
enum { BUFFER_COUNT = sizeof BUFFERS / sizeof *BUFFERS };
_Static_assert((int)BUFFER_COUNT <= (int)GL_STATE_BUFFERS, "room for all");

static const Binding TEXTURES[GL_STATE_TARGETS] = {
    {GL_TEXTURE_2D, GL_TEXTURE_BINDING_2D, 0},
    {GL_TEXTURE_3D, GL_TEXTURE_BINDING_3D, 0},
    {GL_TEXTURE_BUFFER, GL_TEXTURE_BINDING_BUFFER, 0},
    {GL_TEXTURE_2D_MULTISAMPLE, GL_TEXTURE_BINDING_2D_MULTISAMPLE, 0},
};

static const struct {
    GLenum target;
    const char *text;
} QUERIES[] = {
    {GL_SAMPLES_PASSED, "GL_SAMPLES_PASSED"},
    {GL_ANY_SAMPLES_PASSED, "GL_ANY_SAMPLES_PASSED"},
    {GL_ANY_SAMPLES_PASSED_CONSERVATIVE, "GL_ANY_SAMPLES_PASSED_CONSERVATIVE"},
    {GL_PRIMITIVES_GENERATED, "GL_PRIMITIVES_GENERATED"},
    {GL_TIME_ELAPSED, "GL_TIME_ELAPSED"},
};

// --- Saving.

static GLint integer_of(GLenum name)
{
    GLint value = 0;
    glGetIntegerv(name, &value);
    return value;
}

static int least(GLint value, int most)
{
    return value < most ? value : most;
}

static Result check(Error *error)
{
    for (size_t i = 0; i < sizeof QUERIES / sizeof *QUERIES; ++i) {
        GLint query = 0;
        glGetQueryiv(QUERIES[i].target, GL_CURRENT_QUERY, &query);
        if (query)
            return error_set(error, RESULT_USAGE,
                             "the context has a query of %s active: expected none",
                             QUERIES[i].text);
    }
    if (!integer_of(GL_TRANSFORM_FEEDBACK_ACTIVE) || integer_of(GL_TRANSFORM_FEEDBACK_PAUSED))
        return RESULT_OK;
    return error_set(error, RESULT_USAGE,
                     "the context has transform feedback active: expected it paused");
}

static void save_raster(GlState *state)
{
    GLint mode[2] = {GL_FILL, GL_FILL}; // in the compatibility profile: front and back
    for (int i = 0; i < SWITCH_COUNT; ++i) state->switches[i] = glIsEnabled(SWITCHES[i]);
    for (int i = 0; i < STORE_COUNT; ++i) state->stores[i] = integer_of(STORES[i].name);
    for (GLuint i = 0; i < (GLuint)state->drawn; ++i) {
        state->blend[i] = glIsEnabledi(GL_BLEND, i);
        glGetBooleani_v(GL_COLOR_WRITEMASK, i, state->color_mask[i]);
    }
    for (GLuint i = 0; i < (GLuint)state->views; ++i) {
        state->scissor[i] = glIsEnabledi(GL_SCISSOR_TEST, i);
        glGetFloati_v(GL_VIEWPORT, i, state->viewport[i]);
        glGetIntegeri_v(GL_SCISSOR_BOX, i, state->scissor_box[i]);
        glGetDoublei_v(GL_DEPTH_RANGE, i, state->depth_range[i]);
    }
    glGetBooleanv(GL_DEPTH_WRITEMASK, &state->depth_mask);
    glGetIntegerv(GL_POLYGON_MODE, mode);
    state->depth_function = integer_of(GL_DEPTH_FUNC);
    state->polygon_mode[0] = mode[0], state->polygon_mode[1] = mode[1];
    state->alpha_test = state->compatible && glIsEnabled(GL_ALPHA_TEST);
    state->front_face = integer_of(GL_FRONT_FACE);
    state->provoking = integer_of(GL_PROVOKING_VERTEX);
    state->clamp_read = integer_of(GL_CLAMP_READ_COLOR);
    if (state->version < 45) return;
    state->clip[0] = integer_of(GL_CLIP_ORIGIN);
    state->clip[1] = integer_of(GL_CLIP_DEPTH_MODE);
}

static void save_blocks(GlBlock blocks[GL_STATE_BLOCKS], GLenum binding, GLenum start, GLenum size)
{
    for (GLuint i = 0; i < GL_STATE_BLOCKS; ++i) {
        blocks[i] = (GlBlock){0};
        glGetIntegeri_v(binding, i, &blocks[i].buffer);
        if (!blocks[i].buffer) continue;
        glGetInteger64i_v(start, i, &blocks[i].start);
        glGetInteger64i_v(size, i, &blocks[i].size);
    }
}

static void save_units(GlState *state)
{
    state->unit = integer_of(GL_ACTIVE_TEXTURE);
    for (int unit = 0; unit < GL_STATE_UNITS; ++unit) {
        glActiveTexture(GL_TEXTURE0 + (GLenum)unit);
        for (int i = 0; i < GL_STATE_TARGETS; ++i)
            state->textures[unit][i] = integer_of(TEXTURES[i].name);
        state->samplers[unit] = integer_of(GL_SAMPLER_BINDING);
        if (state->samplers[unit]) glBindSampler((GLuint)unit, 0);
    }
    for (GLuint i = 0; i < GL_STATE_IMAGES; ++i) {
        glGetIntegeri_v(GL_IMAGE_BINDING_NAME, i, &state->images[i].texture);
        glGetIntegeri_v(GL_IMAGE_BINDING_LEVEL, i, &state->images[i].level);
        glGetBooleani_v(GL_IMAGE_BINDING_LAYERED, i, &state->images[i].layered);
        glGetIntegeri_v(GL_IMAGE_BINDING_LAYER, i, &state->images[i].layer);
        glGetIntegeri_v(GL_IMAGE_BINDING_ACCESS, i, &state->images[i].access);
        glGetIntegeri_v(GL_IMAGE_BINDING_FORMAT, i, &state->images[i].format);
    }
}

static void save_bindings(GlState *state)
{
    state->program = integer_of(GL_CURRENT_PROGRAM);
    state->vertices = integer_of(GL_VERTEX_ARRAY_BINDING);
    state->draw_frame = integer_of(GL_DRAW_FRAMEBUFFER_BINDING);
    state->read_frame = integer_of(GL_READ_FRAMEBUFFER_BINDING);
    for (int i = 0; i < BUFFER_COUNT; ++i)
        if (state->version >= BUFFERS[i].since) state->buffers[i] = integer_of(BUFFERS[i].name);
    save_blocks(state->uniforms, GL_UNIFORM_BUFFER_BINDING, GL_UNIFORM_BUFFER_START,
                GL_UNIFORM_BUFFER_SIZE);
    save_blocks(state->storage, GL_SHADER_STORAGE_BUFFER_BINDING, GL_SHADER_STORAGE_BUFFER_START,
                GL_SHADER_STORAGE_BUFFER_SIZE);
    save_units(state);
    for (GLuint i = 1; i < GL_STATE_ATTRIBUTES; ++i)
        glGetVertexAttribfv(i, GL_CURRENT_VERTEX_ATTRIB, state->attributes[i]);
}

// --- Defaults.

static void set_defaults(const GlState *state)
{
    for (int i = 0; i < SWITCH_COUNT; ++i)
        if (state->switches[i]) glDisable(SWITCHES[i]);
    for (int i = 0; i < STORE_COUNT; ++i) glPixelStorei(STORES[i].name, STORES[i].initial);
    glDisable(GL_BLEND);
    glDisable(GL_SCISSOR_TEST);
    if (state->alpha_test) glDisable(GL_ALPHA_TEST);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDepthRange(0, 1);
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_LESS);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    glFrontFace(GL_CCW);
    glProvokingVertex(GL_LAST_VERTEX_CONVENTION);
    glClampColor(GL_CLAMP_READ_COLOR, GL_FIXED_ONLY);
    if (state->version >= 45) glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
    glUseProgram(0);
    glBindVertexArray(0);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    for (int i = 0; i < BUFFER_COUNT; ++i)
        if (state->version >= BUFFERS[i].since) glBindBuffer(BUFFERS[i].target, 0);
    glActiveTexture(GL_TEXTURE0);
}

Result gl_state_take(GlState *state, Error *error)
{
    TRY(check(error));
    *state = (GlState){.version = epoxy_gl_version()};
    state->compatible = integer_of(GL_CONTEXT_PROFILE_MASK) & GL_CONTEXT_COMPATIBILITY_PROFILE_BIT;
    state->views = least(integer_of(GL_MAX_VIEWPORTS), GL_STATE_VIEWS);
    state->drawn = least(integer_of(GL_MAX_DRAW_BUFFERS), GL_STATE_DRAWN);
    save_raster(state);
    save_bindings(state);
    set_defaults(state);
    gpu_error_forget();
    return RESULT_OK;
}

// --- Restoring.

static void set_switch(GLenum name, bool on)
{
    if (on)
        glEnable(name);
    else
        glDisable(name);
}

static void set_switch_of(GLenum name, GLuint index, bool on)
{
    if (on)
        glEnablei(name, index);
    else
        glDisablei(name, index);
}

static void restore_raster(const GlState *state)
{
    for (int i = 0; i < SWITCH_COUNT; ++i) set_switch(SWITCHES[i], state->switches[i]);
    for (int i = 0; i < STORE_COUNT; ++i) glPixelStorei(STORES[i].name, state->stores[i]);
    for (GLuint i = 0; i < (GLuint)state->drawn; ++i) {
        const GLboolean *mask = state->color_mask[i];
        set_switch_of(GL_BLEND, i, state->blend[i]);
        glColorMaski(i, mask[0], mask[1], mask[2], mask[3]);
    }
    for (GLuint i = 0; i < (GLuint)state->views; ++i) {
        set_switch_of(GL_SCISSOR_TEST, i, state->scissor[i]);
        glViewportIndexedfv(i, state->viewport[i]);
        glScissorIndexedv(i, state->scissor_box[i]);
        glDepthRangeIndexed(i, state->depth_range[i][0], state->depth_range[i][1]);
    }
    glDepthMask(state->depth_mask);
    glDepthFunc((GLenum)state->depth_function);
    glPolygonMode(GL_FRONT_AND_BACK, (GLenum)state->polygon_mode[0]);
    if (state->compatible) glPolygonMode(GL_BACK, (GLenum)state->polygon_mode[1]);
    if (state->alpha_test) glEnable(GL_ALPHA_TEST);
    glFrontFace((GLenum)state->front_face);
    glProvokingVertex((GLenum)state->provoking);
    glClampColor(GL_CLAMP_READ_COLOR, (GLenum)state->clamp_read);
    if (state->version >= 45) glClipControl((GLenum)state->clip[0], (GLenum)state->clip[1]);
}

static void restore_blocks(const GlBlock blocks[GL_STATE_BLOCKS], GLenum target)
{
    for (GLuint i = 0; i < GL_STATE_BLOCKS; ++i) {
        const GlBlock *block = &blocks[i];
        if (block->size)
            glBindBufferRange(target, i, (GLuint)block->buffer, (GLintptr)block->start,
                              (GLsizeiptr)block->size);
        else
            glBindBufferBase(target, i, (GLuint)block->buffer);
    }
}

static void restore_units(const GlState *state)
{
    for (int unit = 0; unit < GL_STATE_UNITS; ++unit) {
        glActiveTexture(GL_TEXTURE0 + (GLenum)unit);
        for (int i = 0; i < GL_STATE_TARGETS; ++i)
            glBindTexture(TEXTURES[i].target, (GLuint)state->textures[unit][i]);
        glBindSampler((GLuint)unit, (GLuint)state->samplers[unit]);
    }
    glActiveTexture((GLenum)state->unit);
    for (GLuint i = 0; i < GL_STATE_IMAGES; ++i)
        glBindImageTexture(i, (GLuint)state->images[i].texture, state->images[i].level,
                           state->images[i].layered, state->images[i].layer,
                           (GLenum)state->images[i].access, (GLenum)state->images[i].format);
}

void gl_state_restore(const GlState *state)
{
    restore_raster(state);
    restore_blocks(state->uniforms, GL_UNIFORM_BUFFER);
    restore_blocks(state->storage, GL_SHADER_STORAGE_BUFFER);
    glBindVertexArray((GLuint)state->vertices);
    for (int i = 0; i < BUFFER_COUNT; ++i)
        if (state->version >= BUFFERS[i].since)
            glBindBuffer(BUFFERS[i].target, (GLuint)state->buffers[i]);
    restore_units(state);
    for (GLuint i = 1; i < GL_STATE_ATTRIBUTES; ++i) glVertexAttrib4fv(i, state->attributes[i]);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, (GLuint)state->draw_frame);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, (GLuint)state->read_frame);
    glUseProgram((GLuint)state->program);
    gpu_error_forget(); // of objects that the host has deleted while they are bound
}
