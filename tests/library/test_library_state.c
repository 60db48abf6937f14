// SPDX-License-Identifier: MIT
// A host's OpenGL state: whatever it is, the library draws the same pixels in the host's context,
// and every state of OpenGL 4.3 core is as before.
#include "support/library_fixture.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define error library_error

static EGLDisplay display;
static EGLContext context;

static int make_host(void **state)
{
    static const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                        4,
                                        EGL_CONTEXT_MINOR_VERSION,
                                        3,
                                        EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                        EGL_NONE};
    (void)state;
    display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, NULL, NULL);
    assert_true(display && eglInitialize(display, NULL, NULL));
    eglBindAPI(EGL_OPENGL_API);
    context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
    assert_true(eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context));
    return 0;
}

static int drop_host(void **state)
{
    (void)state;
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display, context);
    return 0;
}

// --- What a host sees: tables 23.2 to 23.74 of the specification, apart from objects.

static const GLenum SWITCHES[] = {GL_CLIP_DISTANCE0,
                                  GL_CLIP_DISTANCE1,
                                  GL_CLIP_DISTANCE2,
                                  GL_CLIP_DISTANCE3,
                                  GL_CLIP_DISTANCE4,
                                  GL_CLIP_DISTANCE5,
                                  GL_CLIP_DISTANCE6,
                                  GL_CLIP_DISTANCE7,
                                  GL_COLOR_LOGIC_OP,
                                  GL_CULL_FACE,
                                  GL_DEPTH_CLAMP,
                                  GL_DEPTH_TEST,
                                  GL_DITHER,
                                  GL_FRAMEBUFFER_SRGB,
                                  GL_LINE_SMOOTH,
                                  GL_MULTISAMPLE,
                                  GL_POLYGON_OFFSET_FILL,
                                  GL_POLYGON_OFFSET_LINE,
                                  GL_POLYGON_OFFSET_POINT,
                                  GL_POLYGON_SMOOTH,
                                  GL_PRIMITIVE_RESTART,
                                  GL_PRIMITIVE_RESTART_FIXED_INDEX,
                                  GL_PROGRAM_POINT_SIZE,
                                  GL_RASTERIZER_DISCARD,
                                  GL_SAMPLE_ALPHA_TO_COVERAGE,
                                  GL_SAMPLE_ALPHA_TO_ONE,
                                  GL_SAMPLE_COVERAGE,
                                  GL_SAMPLE_MASK,
                                  GL_SAMPLE_SHADING,
                                  GL_STENCIL_TEST,
                                  GL_TEXTURE_CUBE_MAP_SEAMLESS};

static const GLenum NUMBERS[] = {
    GL_ACTIVE_TEXTURE,
    GL_ARRAY_BUFFER_BINDING,
    GL_ATOMIC_COUNTER_BUFFER_BINDING,
    GL_BLEND_COLOR,
    GL_CLAMP_READ_COLOR,
    GL_COLOR_CLEAR_VALUE,
    GL_COPY_READ_BUFFER_BINDING,
    GL_COPY_WRITE_BUFFER_BINDING,
    GL_CULL_FACE_MODE,
    GL_CURRENT_PROGRAM,
    GL_DEPTH_CLEAR_VALUE,
    GL_DEPTH_FUNC,
    GL_DEPTH_WRITEMASK,
    GL_DISPATCH_INDIRECT_BUFFER_BINDING,
    GL_DRAW_FRAMEBUFFER_BINDING,
    GL_DRAW_INDIRECT_BUFFER_BINDING,
    GL_ELEMENT_ARRAY_BUFFER_BINDING,
    GL_FRAGMENT_SHADER_DERIVATIVE_HINT,
    GL_FRONT_FACE,
    GL_LINE_SMOOTH_HINT,
    GL_LINE_WIDTH,
    GL_LOGIC_OP_MODE,
    GL_MIN_SAMPLE_SHADING_VALUE,
    GL_PACK_ALIGNMENT,
    GL_PACK_COMPRESSED_BLOCK_DEPTH,
    GL_PACK_COMPRESSED_BLOCK_HEIGHT,
    GL_PACK_COMPRESSED_BLOCK_SIZE,
    GL_PACK_COMPRESSED_BLOCK_WIDTH,
    GL_PACK_IMAGE_HEIGHT,
    GL_PACK_LSB_FIRST,
    GL_PACK_ROW_LENGTH,
    GL_PACK_SKIP_IMAGES,
    GL_PACK_SKIP_PIXELS,
    GL_PACK_SKIP_ROWS,
    GL_PACK_SWAP_BYTES,
    GL_PATCH_DEFAULT_INNER_LEVEL,
    GL_PATCH_DEFAULT_OUTER_LEVEL,
    GL_PATCH_VERTICES,
    GL_PIXEL_PACK_BUFFER_BINDING,
    GL_PIXEL_UNPACK_BUFFER_BINDING,
    GL_POINT_FADE_THRESHOLD_SIZE,
    GL_POINT_SIZE,
    GL_POINT_SPRITE_COORD_ORIGIN,
    GL_POLYGON_MODE,
    GL_POLYGON_OFFSET_FACTOR,
    GL_POLYGON_OFFSET_UNITS,
    GL_POLYGON_SMOOTH_HINT,
    GL_PRIMITIVE_RESTART_INDEX,
    GL_PROGRAM_PIPELINE_BINDING,
    GL_PROVOKING_VERTEX,
    GL_READ_FRAMEBUFFER_BINDING,
    GL_RENDERBUFFER_BINDING,
    GL_SAMPLE_COVERAGE_INVERT,
    GL_SAMPLE_COVERAGE_VALUE,
    GL_SHADER_STORAGE_BUFFER_BINDING,
    GL_STENCIL_BACK_FAIL,
    GL_STENCIL_BACK_FUNC,
    GL_STENCIL_BACK_PASS_DEPTH_FAIL,
    GL_STENCIL_BACK_PASS_DEPTH_PASS,
    GL_STENCIL_BACK_REF,
    GL_STENCIL_BACK_VALUE_MASK,
    GL_STENCIL_BACK_WRITEMASK,
    GL_STENCIL_CLEAR_VALUE,
    GL_STENCIL_FAIL,
    GL_STENCIL_FUNC,
    GL_STENCIL_PASS_DEPTH_FAIL,
    GL_STENCIL_PASS_DEPTH_PASS,
    GL_STENCIL_REF,
    GL_STENCIL_VALUE_MASK,
    GL_STENCIL_WRITEMASK,
    GL_TEXTURE_BUFFER_BINDING,
    GL_TEXTURE_COMPRESSION_HINT,
    GL_TRANSFORM_FEEDBACK_BINDING,
    GL_TRANSFORM_FEEDBACK_BUFFER_BINDING,
    GL_UNIFORM_BUFFER_BINDING,
    GL_UNPACK_ALIGNMENT,
    GL_UNPACK_COMPRESSED_BLOCK_SIZE,
    GL_UNPACK_IMAGE_HEIGHT,
    GL_UNPACK_LSB_FIRST,
    GL_UNPACK_ROW_LENGTH,
    GL_UNPACK_SKIP_IMAGES,
    GL_UNPACK_SKIP_PIXELS,
    GL_UNPACK_SKIP_ROWS,
    GL_UNPACK_SWAP_BYTES,
    GL_VERTEX_ARRAY_BINDING,
};

// State of an index: draw buffers, viewports, blocks, images.
static const struct {
    GLenum name;
    GLuint count;
} INDEXED[] = {
    {GL_BLEND_SRC_RGB, 8},
    {GL_BLEND_SRC_ALPHA, 8},
    {GL_BLEND_DST_RGB, 8},
    {GL_BLEND_DST_ALPHA, 8},
    {GL_BLEND_EQUATION_RGB, 8},
    {GL_BLEND_EQUATION_ALPHA, 8},
    {GL_COLOR_WRITEMASK, 8},
    {GL_VIEWPORT, 16},
    {GL_SCISSOR_BOX, 16},
    {GL_DEPTH_RANGE, 16},
    {GL_SAMPLE_MASK_VALUE, 1},
    {GL_UNIFORM_BUFFER_BINDING, 16},
    {GL_UNIFORM_BUFFER_START, 16},
    {GL_UNIFORM_BUFFER_SIZE, 16},
    {GL_SHADER_STORAGE_BUFFER_BINDING, 16},
    {GL_SHADER_STORAGE_BUFFER_START, 16},
    {GL_SHADER_STORAGE_BUFFER_SIZE, 16},
    {GL_ATOMIC_COUNTER_BUFFER_BINDING, 4},
    {GL_TRANSFORM_FEEDBACK_BUFFER_BINDING, 4},
    {GL_IMAGE_BINDING_NAME, 8},
    {GL_IMAGE_BINDING_LEVEL, 8},
    {GL_IMAGE_BINDING_LAYERED, 8},
    {GL_IMAGE_BINDING_LAYER, 8},
    {GL_IMAGE_BINDING_ACCESS, 8},
    {GL_IMAGE_BINDING_FORMAT, 8},
};

static const GLenum TARGETS[][2] = {
    {GL_TEXTURE_1D, GL_TEXTURE_BINDING_1D},
    {GL_TEXTURE_2D, GL_TEXTURE_BINDING_2D},
    {GL_TEXTURE_3D, GL_TEXTURE_BINDING_3D},
    {GL_TEXTURE_1D_ARRAY, GL_TEXTURE_BINDING_1D_ARRAY},
    {GL_TEXTURE_2D_ARRAY, GL_TEXTURE_BINDING_2D_ARRAY},
    {GL_TEXTURE_RECTANGLE, GL_TEXTURE_BINDING_RECTANGLE},
    {GL_TEXTURE_CUBE_MAP, GL_TEXTURE_BINDING_CUBE_MAP},
    {GL_TEXTURE_CUBE_MAP_ARRAY, GL_TEXTURE_BINDING_CUBE_MAP_ARRAY},
    {GL_TEXTURE_BUFFER, GL_TEXTURE_BINDING_BUFFER},
    {GL_TEXTURE_2D_MULTISAMPLE, GL_TEXTURE_BINDING_2D_MULTISAMPLE},
    {GL_TEXTURE_2D_MULTISAMPLE_ARRAY, GL_TEXTURE_BINDING_2D_MULTISAMPLE_ARRAY},
};

enum {
    COUNT_OF_SWITCHES = sizeof SWITCHES / sizeof *SWITCHES,
    COUNT_OF_NUMBERS = sizeof NUMBERS / sizeof *NUMBERS,
    COUNT_OF_INDEXED = sizeof INDEXED / sizeof *INDEXED,
    COUNT_OF_TARGETS = sizeof TARGETS / sizeof *TARGETS,
    UNITS = 32,
    ATTRIBUTES = 16,
    MOST = 4000
};

typedef struct Seen {
    int count;
    struct {
        GLenum name;
        int index;
        double value[4];
    } states[MOST];
} Seen;

static double *add(Seen *seen, GLenum name, int index)
{
    assert_true(seen->count < MOST);
    seen->states[seen->count].name = name;
    seen->states[seen->count].index = index;
    return seen->states[seen->count++].value;
}

static void see(Seen *seen)
{
    GLint unit;
    memset(seen, 0, sizeof *seen);
    for (int i = 0; i < COUNT_OF_SWITCHES; ++i)
        *add(seen, SWITCHES[i], -1) = glIsEnabled(SWITCHES[i]);
    for (int i = 0; i < COUNT_OF_NUMBERS; ++i) glGetDoublev(NUMBERS[i], add(seen, NUMBERS[i], -1));
    for (int i = 0; i < COUNT_OF_INDEXED; ++i)
        for (GLuint k = 0; k < INDEXED[i].count; ++k)
            glGetDoublei_v(INDEXED[i].name, k, add(seen, INDEXED[i].name, (int)k));
    for (GLuint i = 0; i < 8; ++i) *add(seen, GL_BLEND, (int)i) = glIsEnabledi(GL_BLEND, i);
    for (GLuint i = 0; i < 16; ++i)
        *add(seen, GL_SCISSOR_TEST, (int)i) = glIsEnabledi(GL_SCISSOR_TEST, i);
    for (GLuint i = 0; i < ATTRIBUTES; ++i)
        glGetVertexAttribdv(i, GL_CURRENT_VERTEX_ATTRIB,
                            add(seen, GL_CURRENT_VERTEX_ATTRIB, (int)i));
    glGetIntegerv(GL_ACTIVE_TEXTURE, &unit);
    for (int i = 0; i < UNITS; ++i) {
        glActiveTexture(GL_TEXTURE0 + (GLenum)i);
        for (int k = 0; k < COUNT_OF_TARGETS; ++k)
            glGetDoublev(TARGETS[k][1], add(seen, TARGETS[k][1], i));
        glGetDoublev(GL_SAMPLER_BINDING, add(seen, GL_SAMPLER_BINDING, i));
    }
    glActiveTexture((GLenum)unit);
    assert_int_equal(glGetError(), GL_NO_ERROR);
}

static void assert_as_before(const Seen *before)
{
    static Seen after;
    assert_int_equal(glGetError(), GL_NO_ERROR);
    see(&after);
    for (int i = 0; i < before->count; ++i)
        if (memcmp(&before->states[i], &after.states[i], sizeof before->states[i]) != 0)
            fail_msg("state 0x%x, index %d: %g %g is %g %g", before->states[i].name,
                     before->states[i].index, before->states[i].value[0],
                     before->states[i].value[1], after.states[i].value[0],
                     after.states[i].value[1]);
}

// --- A host that has set everything.

static GLuint make_program(void)
{
    static const char *const text = "#version 430\nvoid main() { gl_Position = vec4(0); }\n";
    GLuint shader = glCreateShader(GL_VERTEX_SHADER), program = glCreateProgram();
    glShaderSource(shader, 1, &text, NULL);
    glCompileShader(shader);
    glAttachShader(program, shader);
    glLinkProgram(program);
    return program;
}

static void set_buffers(void)
{
    static const GLenum PLAIN[] = {GL_ARRAY_BUFFER,          GL_COPY_READ_BUFFER,
                                   GL_COPY_WRITE_BUFFER,     GL_DISPATCH_INDIRECT_BUFFER,
                                   GL_DRAW_INDIRECT_BUFFER,  GL_ELEMENT_ARRAY_BUFFER,
                                   GL_PIXEL_PACK_BUFFER,     GL_PIXEL_UNPACK_BUFFER,
                                   GL_TEXTURE_BUFFER,        GL_UNIFORM_BUFFER,
                                   GL_SHADER_STORAGE_BUFFER, GL_ATOMIC_COUNTER_BUFFER};
    GLuint buffers[16];
    glGenBuffers(16, buffers);
    for (int i = 0; i < 16; ++i) {
        glBindBuffer(GL_ARRAY_BUFFER, buffers[i]);
        glBufferData(GL_ARRAY_BUFFER, 65536, NULL, GL_STATIC_DRAW);
    }
    for (GLuint i = 0; i < 16; ++i) {
        glBindBufferRange(GL_UNIFORM_BUFFER, i, buffers[i], 256 * i, 1024);
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, i, buffers[15 - i]);
    }
    for (GLuint i = 0; i < 4; ++i) glBindBufferBase(GL_ATOMIC_COUNTER_BUFFER, i, buffers[i]);
    for (size_t i = 0; i < sizeof PLAIN / sizeof *PLAIN; ++i) glBindBuffer(PLAIN[i], buffers[i]);
}

static void set_textures(void)
{
    GLuint textures[UNITS][COUNT_OF_TARGETS], samplers[UNITS], image;
    glGenSamplers(UNITS, samplers);
    for (int i = 0; i < UNITS; ++i) {
        glActiveTexture(GL_TEXTURE0 + (GLenum)i);
        glGenTextures(COUNT_OF_TARGETS, textures[i]);
        for (int k = 0; k < COUNT_OF_TARGETS; ++k) glBindTexture(TARGETS[k][0], textures[i][k]);
        glSamplerParameteri(samplers[i], GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glBindSampler((GLuint)i, samplers[i]);
    }
    glActiveTexture(GL_TEXTURE0 + 40);
    glGenTextures(1, &image);
    glBindTexture(GL_TEXTURE_2D_ARRAY, image);
    glTexStorage3D(GL_TEXTURE_2D_ARRAY, 2, GL_RGBA8, 8, 8, 4);
    for (GLuint i = 0; i < 8; ++i)
        glBindImageTexture(i, image, 1, i % 2, i % 2 ? 0 : 2, GL_READ_WRITE, GL_RGBA8);
    glActiveTexture(GL_TEXTURE0 + 7);
}

static void set_frame(void)
{
    GLuint frame[2], render, vertices, pipeline;
    glGenFramebuffers(2, frame);
    glGenRenderbuffers(1, &render);
    glBindRenderbuffer(GL_RENDERBUFFER, render);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, 16, 16);
    for (int i = 0; i < 2; ++i) {
        glBindFramebuffer(GL_FRAMEBUFFER, frame[i]);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, render);
    }
    glBindFramebuffer(GL_READ_FRAMEBUFFER, frame[0]);
    glGenVertexArrays(1, &vertices);
    glBindVertexArray(vertices);
    glGenProgramPipelines(1, &pipeline);
    glBindProgramPipeline(pipeline);
    glUseProgram(make_program());
    for (GLuint i = 1; i < ATTRIBUTES; ++i) glVertexAttrib4f(i, 0.1f * (float)i, 2, 3, 4);
}

static void set_raster(void)
{
    for (int i = 0; i < COUNT_OF_SWITCHES; ++i) {
        if (glIsEnabled(SWITCHES[i]))
            glDisable(SWITCHES[i]);
        else
            glEnable(SWITCHES[i]);
    }
    for (GLuint i = 0; i < 8; ++i) {
        if (i % 2) glEnablei(GL_BLEND, i);
        glColorMaski(i, i & 1, i & 2, i & 4, !(i & 1));
        glBlendFuncSeparatei(i, GL_ONE, GL_SRC_ALPHA, GL_DST_COLOR, GL_ZERO);
        glBlendEquationSeparatei(i, GL_FUNC_SUBTRACT, GL_MAX);
    }
    for (GLuint i = 0; i < 16; ++i) {
        if (i % 3) glEnablei(GL_SCISSOR_TEST, i);
        glViewportIndexedf(i, (float)i, 2.5f, 5 + (float)i, 7);
        glScissorIndexed(i, (int)i, 1, 3, 4);
        glDepthRangeIndexed(i, 0.25, 0.5 + 0.01 * i);
    }
    glBlendColor(0.1f, 0.2f, 0.3f, 0.4f);
    glClearColor(0.5f, 0.6f, 0.7f, 0.8f);
    glClearDepth(0.5);
    glClearStencil(3);
    glClampColor(GL_CLAMP_READ_COLOR, GL_TRUE);
    glCullFace(GL_FRONT_AND_BACK);
    glDepthFunc(GL_NEVER);
    glDepthMask(GL_FALSE);
    glFrontFace(GL_CW);
    glLogicOp(GL_XOR);
    glMinSampleShading(0.5f);
    glPatchParameteri(GL_PATCH_VERTICES, 5);
    glPointSize(3);
    glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
    glPolygonOffset(2, 3);
    glPrimitiveRestartIndex(1);
    glProvokingVertex(GL_FIRST_VERTEX_CONVENTION);
    glSampleCoverage(0.25f, GL_TRUE);
    glSampleMaski(0, 0x55555555);
    glStencilFunc(GL_GREATER, 1, 0xf);
    glStencilOp(GL_INVERT, GL_INCR, GL_ZERO);
    glStencilMask(0xf0);
    for (GLenum at = GL_UNPACK_SWAP_BYTES; at <= GL_UNPACK_ALIGNMENT; ++at)
        glPixelStorei(at, at <= GL_UNPACK_LSB_FIRST ? 1 : at == GL_UNPACK_ALIGNMENT ? 1 : 7);
    for (GLenum at = GL_PACK_SWAP_BYTES; at <= GL_PACK_ALIGNMENT; ++at)
        glPixelStorei(at, at <= GL_PACK_LSB_FIRST ? 1 : at == GL_PACK_ALIGNMENT ? 2 : 5);
    static const GLenum DEEP[] = {GL_PACK_IMAGE_HEIGHT, GL_PACK_SKIP_IMAGES, GL_UNPACK_IMAGE_HEIGHT,
                                  GL_UNPACK_SKIP_IMAGES};
    for (int i = 0; i < 4; ++i) glPixelStorei(DEEP[i], 3);
}

static void draw(TractrixDevice *device, const char *raster, uint8_t pixels[][4])
{
    const char *const parameters[] = {"raster", raster,  "shading", "marschner",
                                      "floor",  "plane", NULL};
    TractrixScene *scene = library_scene(parameters);
    TractrixSimulation *simulation;
    WELL(tractrix_simulation_create(&simulation, device, scene, &error));
    tractrix_scene_destroy(scene);
    WELL(tractrix_simulation_advance(simulation, NULL, &error));
    library_draw(simulation, NULL, pixels);
    tractrix_simulation_destroy(simulation);
}

static void any_state_draws_the_same_and_stays(void **state)
{
    static const char *const RASTERS[] = {"blocks", "compute", "quads"};
    static uint8_t usual[FIXTURE_PIXELS][4], odd[FIXTURE_PIXELS][4];
    static Seen before;
    TractrixDevice *own, *device;
    (void)state;
    WELL(tractrix_device_open(&own, NULL, &error));
    set_textures();
    set_frame();
    set_buffers();
    set_raster();
    assert_int_equal(glGetError(), GL_NO_ERROR);
    see(&before);
    WELL(tractrix_device_borrow(&device, &error));
    assert_as_before(&before);
    for (int i = 0; i < 3; ++i) {
        draw(own, RASTERS[i], usual);
        draw(device, RASTERS[i], odd);
        assert_memory_equal(usual, odd, sizeof usual);
        assert_as_before(&before);
    }
    tractrix_device_destroy(device);
    assert_as_before(&before);
    tractrix_device_destroy(own);
}

static void refuses_to_draw_into_the_hosts_query(void **state)
{
    TractrixDevice *device;
    TractrixSimulation *simulation;
    TractrixScene *scene = library_scene((const char *const[]){NULL});
    GLuint query;
    (void)state;
    WELL(tractrix_device_borrow(&device, &error));
    WELL(tractrix_simulation_create(&simulation, device, scene, &error));
    glGenQueries(1, &query);
    glBeginQuery(GL_SAMPLES_PASSED, query);
    library_refused(tractrix_simulation_advance(simulation, NULL, &error), TRACTRIX_USAGE,
                    "a query of GL_SAMPLES_PASSED active: expected none");
    glEndQuery(GL_SAMPLES_PASSED);
    WELL(tractrix_simulation_advance(simulation, NULL, &error));
    tractrix_simulation_destroy(simulation);
    tractrix_device_destroy(device);
    tractrix_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(any_state_draws_the_same_and_stays, make_host, drop_host),
        cmocka_unit_test_setup_teardown(refuses_to_draw_into_the_hosts_query, make_host, drop_host),
    };
    return cmocka_run_group_tests_name("library_state", tests, NULL, NULL);
}
