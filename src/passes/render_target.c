// SPDX-License-Identifier: MIT
#include "passes/render_target.h"

#include <string.h>

static GLuint create_texture(GLenum format, int width, int height)
{
    GLuint texture;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexStorage2D(GL_TEXTURE_2D, 1, format, width, height);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    return texture;
}

static GLuint create_edge_depth(int width, int height)
{
    GLuint texture;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D_MULTISAMPLE, texture);
    glTexStorage2DMultisample(GL_TEXTURE_2D_MULTISAMPLE, EDGE_SAMPLES, GL_DEPTH_COMPONENT32F, width,
                              height, GL_TRUE);
    return texture;
}

static GLuint create_frame(void)
{
    GLuint frame;
    glGenFramebuffers(1, &frame);
    glBindFramebuffer(GL_FRAMEBUFFER, frame);
    return frame;
}

// `depth` may be 0.
static GLuint create_color_frame(GLuint texture, GLuint depth)
{
    GLuint frame = create_frame();
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth, 0);
    return frame;
}

static Result check_frame(GLuint frame, const char *what, Error *error)
{
    glBindFramebuffer(GL_FRAMEBUFFER, frame);
    GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    // Check for errors first: an incomplete framebuffer may be caused by lack of memory.
    TRY(gpu_check(what, error));
    if (status == GL_FRAMEBUFFER_COMPLETE) return RESULT_OK;
    return error_set(error, RESULT_FAILED, "%s: framebuffer status 0x%04x", what, status);
}

Result render_target_create(RenderTarget *target, int width, int height, int samples,
                            ImageKind kind, Error *error)
{
    static const GLenum formats[] = {GL_RGBA8, GL_RGBA16, GL_RGBA32F};
    *target = (RenderTarget){.width = width, .height = height, .samples = samples, .kind = kind};
    target->image = create_texture(formats[kind], width, height);
    target->image_frame = create_color_frame(target->image, 0);
    target->hair_frame = create_frame();
    glFramebufferParameteri(GL_FRAMEBUFFER, GL_FRAMEBUFFER_DEFAULT_WIDTH, width * samples);
    glFramebufferParameteri(GL_FRAMEBUFFER, GL_FRAMEBUFFER_DEFAULT_HEIGHT, height * samples);
    glDrawBuffer(GL_NONE);
    Result result = check_frame(target->hair_frame, "hair target", error);
    THEN(result, check_frame(target->image_frame, "image", error));
    if (result != RESULT_OK) render_target_destroy(target);
    return result;
}

static Result add_edges(RenderTarget *target, int width, int height, Error *error)
{
    target->edge_depth = create_edge_depth(width, height);
    target->edge_frame = create_frame();
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D_MULTISAMPLE,
                           target->edge_depth, 0);
    glDrawBuffer(GL_NONE);
    return check_frame(target->edge_frame, "mesh edges", error);
}

Result render_target_add_base(RenderTarget *target, Error *error)
{
    if (target->depth) return RESULT_OK;
    int width = target->width * target->samples, height = target->height * target->samples;
    target->depth = create_texture(GL_DEPTH_COMPONENT32F, width, height);
    glBindFramebuffer(GL_FRAMEBUFFER, target->hair_frame);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, target->depth, 0);
    target->base = create_texture(GL_RGBA16F, width, height);
    target->base_frame = create_color_frame(target->base, target->depth);
    target->rim = create_texture(GL_RGBA16F, width, height);
    target->rim_depth = create_texture(GL_R32F, width, height);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT1, GL_TEXTURE_2D, target->rim, 0);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT2, GL_TEXTURE_2D, target->rim_depth,
                           0);
    glDrawBuffers(
        3, (const GLenum[]){GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1, GL_COLOR_ATTACHMENT2});
    target->middle_depth = create_texture(GL_DEPTH_COMPONENT32F, width, height);
    target->lit = create_texture(GL_RGBA16F, width, height);
    target->lit_frame = create_color_frame(target->lit, target->middle_depth);
    target->surface = create_texture(GL_RGBA32F, width, height);
    target->surface_frame = create_color_frame(target->surface, target->middle_depth);
    target->tint = create_texture(GL_RGBA16F, width, height);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT1, GL_TEXTURE_2D, target->tint, 0);
    glDrawBuffers(2, (const GLenum[]){GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1});
    TRY(check_frame(target->hair_frame, "hair target", error));
    TRY(check_frame(target->base_frame, "mesh target", error));
    TRY(check_frame(target->lit_frame, "mesh light", error));
    TRY(check_frame(target->surface_frame, "mesh surface", error));
    return add_edges(target, width, height, error);
}

void render_target_destroy(RenderTarget *target)
{
    const GLuint frames[] = {target->image_frame, target->hair_frame,    target->base_frame,
                             target->lit_frame,   target->surface_frame, target->edge_frame};
    const GLuint textures[] = {
        target->image,      target->depth,        target->base, target->lit, target->surface,
        target->edge_depth, target->middle_depth, target->tint, target->rim, target->rim_depth};
    if (target->image) { // without a context no GL function may be called
        glDeleteFramebuffers(6, frames);
        glDeleteTextures(10, textures);
    }
    for (int i = 0; i < 2; ++i) late_read_destroy(&target->sent[i]);
    *target = (RenderTarget){0};
}

// --- Reading back.

static int64_t rgba_bytes(const RenderTarget *target)
{
    return (int64_t)target->width * target->height * 4 * (int64_t)image_channel_size(target->kind);
}

Result render_target_send(RenderTarget *target, const GpuBuffer *flag, bool again, Error *error)
{
    static const GLenum types[] = {GL_UNSIGNED_BYTE, GL_UNSIGNED_SHORT, GL_FLOAT};
    if (again) target->next ^= 1;
    LateRead *sent = &target->sent[target->next];
    int64_t size = rgba_bytes(target);
    TRY(late_read_begin(sent, "an image read back", size + (int64_t)sizeof(uint32_t), error));
    late_read_pixels(sent, 0, target->image_frame, target->width, target->height,
                     types[target->kind]);
    if (flag) late_read_buffer(sent, size, flag, sizeof(uint32_t));
    late_read_send(sent);
    target->next ^= 1;
    return RESULT_OK;
}

// Copies RGB and leaves out alpha.
static void copy_rgb(Image *image, const uint8_t *rgba)
{
    size_t count = (size_t)image->width * (size_t)image->height,
           rgb = 3 * image_channel_size(image->kind), step = rgb / 3 * 4;
    if (image->kind != IMAGE_8) {
        for (size_t i = 0; i < count; ++i) memcpy(image->pixels + i * rgb, rgba + i * step, rgb);
        return;
    }
    for (size_t i = 0; i < count; ++i) {
        image->pixels[3 * i] = rgba[4 * i];
        image->pixels[3 * i + 1] = rgba[4 * i + 1];
        image->pixels[3 * i + 2] = rgba[4 * i + 2];
    }
}

Result render_target_take(RenderTarget *target, int place, Image *image, uint32_t *flag,
                          Error *error)
{
    LateRead *sent = &target->sent[place];
    size_t size = (size_t)rgba_bytes(target);
    const void *bytes;
    TRY(late_read_open(sent, "an image read back", &bytes, error));
    memcpy(flag, (const uint8_t *)bytes + size, sizeof *flag);
    if (image->channels == 4)
        memcpy(image->pixels, bytes, size);
    else
        copy_rgb(image, bytes);
    late_read_close(sent);
    return RESULT_OK;
}
