// SPDX-License-Identifier: MIT
#include "gpu/gl_defaults.h"

#include <epoxy/gl.h>

typedef struct State {
    GLenum name;
    const char *text;
    GLint expected;
} State;

#define STATE(name, expected)                                                                      \
    {                                                                                              \
        name, #name, expected                                                                      \
    }

// Tables 23.5 to 23.31 of the OpenGL 4.3 core specification.
static const State STATES[] = {
    STATE(GL_BLEND, 0),
    STATE(GL_COLOR_LOGIC_OP, 0),
    STATE(GL_CULL_FACE, 0),
    STATE(GL_DEPTH_CLAMP, 0),
    STATE(GL_DEPTH_TEST, 0),
    STATE(GL_FRAMEBUFFER_SRGB, 0),
    STATE(GL_POLYGON_OFFSET_FILL, 0),
    STATE(GL_PRIMITIVE_RESTART, 0),
    STATE(GL_RASTERIZER_DISCARD, 0),
    STATE(GL_SAMPLE_ALPHA_TO_COVERAGE, 0),
    STATE(GL_SAMPLE_COVERAGE, 0),
    STATE(GL_SAMPLE_MASK, 0),
    STATE(GL_SCISSOR_TEST, 0),
    STATE(GL_STENCIL_TEST, 0),
    STATE(GL_DEPTH_FUNC, GL_LESS),
    STATE(GL_DEPTH_WRITEMASK, 1),
    STATE(GL_FRONT_FACE, GL_CCW),
    STATE(GL_LOGIC_OP_MODE, GL_COPY),
    STATE(GL_PACK_ALIGNMENT, 4),
    STATE(GL_PACK_LSB_FIRST, 0),
    STATE(GL_PACK_ROW_LENGTH, 0),
    STATE(GL_PACK_SKIP_PIXELS, 0),
    STATE(GL_PACK_SKIP_ROWS, 0),
    STATE(GL_PACK_SWAP_BYTES, 0),
    STATE(GL_UNPACK_ALIGNMENT, 4),
    STATE(GL_UNPACK_LSB_FIRST, 0),
    STATE(GL_UNPACK_ROW_LENGTH, 0),
    STATE(GL_UNPACK_SKIP_PIXELS, 0),
    STATE(GL_UNPACK_SKIP_ROWS, 0),
    STATE(GL_UNPACK_SWAP_BYTES, 0),
};

// Since OpenGL 4.5.
static const State CLIP_STATES[] = {
    STATE(GL_CLIP_ORIGIN, GL_LOWER_LEFT),
    STATE(GL_CLIP_DEPTH_MODE, GL_NEGATIVE_ONE_TO_ONE),
};

static Result check_one(const State *state, Error *error)
{
    GLint value = state->expected;
    glGetIntegerv(state->name, &value);
    if (value == state->expected) return RESULT_OK;
    return error_set(error, RESULT_USAGE, "the context's %s is 0x%x: expected 0x%x, the default",
                     state->text, (unsigned)value, (unsigned)state->expected);
}

static Result check_all(const State *states, size_t count, Error *error)
{
    for (size_t i = 0; i < count; ++i) TRY(check_one(&states[i], error));
    return RESULT_OK;
}

// States that have more than one value.
static Result check_masks(Error *error)
{
    GLboolean colors[4] = {GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE};
    GLint mode[2] = {GL_FILL, GL_FILL}; // in the compatibility profile: front and back
    glGetBooleanv(GL_COLOR_WRITEMASK, colors);
    if (!colors[0] || !colors[1] || !colors[2] || !colors[3])
        return error_set(error, RESULT_USAGE,
                         "the context's GL_COLOR_WRITEMASK is %d %d %d %d: expected 1 1 1 1, the "
                         "default",
                         colors[0], colors[1], colors[2], colors[3]);
    glGetIntegerv(GL_POLYGON_MODE, mode);
    if (mode[0] != GL_FILL || mode[1] != GL_FILL)
        return error_set(error, RESULT_USAGE,
                         "the context's GL_POLYGON_MODE is 0x%x: expected 0x%x, the default",
                         (unsigned)(mode[0] != GL_FILL ? mode[0] : mode[1]), GL_FILL);
    return RESULT_OK;
}

// A bound sampler object overrides the texture's own filters.
static Result check_samplers(Error *error)
{
    GLint active = GL_TEXTURE0, units = 0, sampler = 0;
    glGetIntegerv(GL_ACTIVE_TEXTURE, &active);
    glGetIntegerv(GL_MAX_TEXTURE_IMAGE_UNITS, &units);
    int unit = 0;
    for (; unit < units && sampler == 0; ++unit) {
        glActiveTexture(GL_TEXTURE0 + (GLenum)unit);
        glGetIntegerv(GL_SAMPLER_BINDING, &sampler);
    }
    glActiveTexture((GLenum)active);
    if (sampler == 0) return RESULT_OK;
    return error_set(error, RESULT_USAGE,
                     "the context's texture unit %d has sampler %d: expected none, the default",
                     unit - 1, sampler);
}

Result gl_defaults_check(Error *error)
{
    TRY(check_all(STATES, sizeof STATES / sizeof *STATES, error));
    if (epoxy_gl_version() >= 45)
        TRY(check_all(CLIP_STATES, sizeof CLIP_STATES / sizeof *CLIP_STATES, error));
    TRY(check_masks(error));
    return check_samplers(error);
}
