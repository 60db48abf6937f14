// SPDX-License-Identifier: MIT
// The OpenGL state of a host that lends its context: saved before the library works in it, set to
// the defaults that the library relies on, and restored afterwards.
#pragma once

#include "base/error.h"

#include <epoxy/gl.h>
#include <stdbool.h>

// The state that the library changes or relies on, as counted in gl_state.c. All other state of
// OpenGL 4.3 core is neither changed nor relied on. Of the compatibility profile, the alpha test
// and the two polygon modes are handled, too.
enum {
    GL_STATE_SWITCHES = 32,
    GL_STATE_STORES = 20, // pixel storage
    GL_STATE_BUFFERS = 12,
    GL_STATE_UNITS = 16,  // texture units, BIND_... in glsl/draw
    GL_STATE_TARGETS = 4, // of textures
    GL_STATE_BLOCKS = 16, // of uniforms and of storage
    GL_STATE_IMAGES = 8,
    GL_STATE_DRAWN = 8,     // draw buffers
    GL_STATE_VIEWS = 16,    // viewports
    GL_STATE_ATTRIBUTES = 8 // the first, which the compatibility profile lacks, is left alone
};

typedef struct GlBlock {
    GLint buffer;
    GLint64 start, size;
} GlBlock;

typedef struct GlState {
    int version; // as epoxy_gl_version
    int views, drawn;
    bool compatible; // the compatibility profile
    bool alpha_test; // of that profile
    bool switches[GL_STATE_SWITCHES], blend[GL_STATE_DRAWN], scissor[GL_STATE_VIEWS];
    GLint stores[GL_STATE_STORES];
    GLint depth_function, polygon_mode[2], front_face, provoking, clamp_read, clip[2];
    GLboolean depth_mask, color_mask[GL_STATE_DRAWN][4];
    GLfloat viewport[GL_STATE_VIEWS][4];
    GLint scissor_box[GL_STATE_VIEWS][4];
    GLdouble depth_range[GL_STATE_VIEWS][2];
    GLint program, vertices, draw_frame, read_frame, unit;
    GLint buffers[GL_STATE_BUFFERS];
    GLint textures[GL_STATE_UNITS][GL_STATE_TARGETS], samplers[GL_STATE_UNITS];
    GlBlock uniforms[GL_STATE_BLOCKS], storage[GL_STATE_BLOCKS];
    struct {
        GLint texture, level, layer, access, format;
        GLboolean layered;
    } images[GL_STATE_IMAGES];
    GLfloat attributes[GL_STATE_ATTRIBUTES][4];
} GlState;

// Saves the state of the current context and sets the defaults. RESULT_USAGE, and nothing has
// changed, while the host has a query or transform feedback active, into which the library would
// draw.
Result gl_state_take(GlState *state, Error *error);

// Restores what gl_state_take has saved.
void gl_state_restore(const GlState *state);
