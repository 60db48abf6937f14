// SPDX-License-Identifier: MIT
// The textures into which an image is drawn, and the buffers by which it comes back to the CPU. Row
// 0 is the top of the image.
#pragma once

#include "gpu/late_read.h"
#include "image/image.h"

enum { EDGE_SAMPLES = 4 }; // of the mesh's depth per sample of the hair; CPU drivers have no more

typedef struct RenderTarget {
    int width, height; // px of the image; everything else is drawn in samples, which are smaller
    int samples;       // per pixel side
    GLuint image, image_frame;     // RGBA8, RGBA16 or RGBA32F by the image's kind
    GLuint hair_frame;             // no colour; `depth` if there is a mesh
    GLuint depth;                  // hides hair: at edges the farthest of all samples
    GLuint base, base_frame;       // RGBA16F: mesh over background, linear, premultiplied; `depth`
    GLuint rim, rim_depth;         // RGBA16F and R32F, see glsl/draw/base.frag; in base_frame
    GLuint middle_depth;           // depth of the mesh at pixels' middles
    GLuint surface, surface_frame; // RGBA32F, glsl/draw/surface.frag; with `middle_depth`
    GLuint tint;                   // RGBA16F, of the same
    GLuint lit, lit_frame;         // RGBA16F, light of that surface; with `middle_depth`
    GLuint edge_depth, edge_frame; // depth of the mesh, EDGE_SAMPLES per sample
    ImageKind kind;
    LateRead sent[2]; // images on their way to the CPU, in turn
    int next;         // index of the next
} RenderTarget;

// A pixel has `samples` x `samples` samples. The driver's framebuffers must be able to hold them
// all (tiles.h). RESULT_FAILED if memory is short.
Result render_target_create(RenderTarget *target, int width, int height, int samples,
                            ImageKind kind, Error *error);
void render_target_destroy(RenderTarget *target);

// Creates what a mesh or a floor needs, if missing.
Result render_target_add_base(RenderTarget *target, Error *error);

// Begins to read the image back, and after it the first word of `flag`, unless that is NULL. One
// earlier image may still be on its way. `again`: this image replaces the last one, which was
// wrong. RESULT_FAILED if memory is short.
Result render_target_send(RenderTarget *target, const GpuBuffer *flag, bool again, Error *error);

// Waits for the image that was sent when `next` was `place`, one of the last two, and copies it
// into `image` of 3 or 4 channels, and its word into *flag. RESULT_FAILED if it does not arrive.
Result render_target_take(RenderTarget *target, int place, Image *image, uint32_t *flag,
                          Error *error);
