// SPDX-License-Identifier: MIT
// A backend draws hair: it turns hair into pixels, with shadows, light and mesh. The renderer
// chooses a backend when it is created; no other code asks which driver there is. `DRAW_LANES` does
// everything in C, on vector units and threads (src/lanes). `DRAW_PASSES` uses shaders
// (src/passes). Both are given the same frame. docs/frame.md describes the passes of both.
#pragma once

#include "draw/drawing.h"
#include "draw/drawn_mesh.h"
#include "draw/renderer_options.h"

// A batch of hair to be drawn.
typedef struct DrawnHair {
    const HairBatch *batch; // on the GPU
    const Look *look;
    MaterialParams material; // complete
    // In memory, where the backend reads hair: as HairBatch lays it out.
    const float (*position)[4];
    const uint32_t (*paint)[4]; // NULL: none
    const uint32_t *ids;
} DrawnHair;

// A frame. The part of it that is being drawn is the window of `drawing->draw`.
typedef struct BackendFrame {
    Drawing *drawing;
    const DrawnHair *hair; // [hair_count]
    uint32_t hair_count;
    const RenderFrame *frame;
    const DrawnMesh *mesh;
    float middle[3]; // m, world: of the hair
} BackendFrame;

// Measures the times of passes; `timer` is the GpuTimer.
typedef struct BackendTimer {
    struct GpuTimer *timer;
    void (*begin)(struct GpuTimer *timer, const char *name);
    void (*end)(struct GpuTimer *timer);
} BackendTimer;

typedef struct BackendOptions {
    const RendererOptions *options; // for a window: they have its size and a definite `raster`, and
                                    // do not change
    const struct Gpu *gpu;
    BackendTimer timer;
} BackendOptions;

// Every function returns RESULT_FAILED if memory is short or a shader does not compile.
typedef struct DrawBackend {
    bool reads_hair; // DrawnHair must be in memory
    Result (*create)(void **state, const BackendOptions *options, Error *error);
    void (*destroy)(void *state); // NULL is legal
    // The mesh has been replaced or removed.
    Result (*set_mesh)(void *state, const DrawnMesh *mesh, Error *error);
    // only its vertices have moved; NULL: not needed
    void (*move_mesh)(void *state, const DrawnMesh *mesh);
    // A frame is drawn by these functions, in this order: shadow maps; light among hair; then for
    // each window `shade` (mesh and floor behind the hair, and its ribbons) and `composite`.
    // `image` is filled at once, or, if there is `take`, when `take` is called with the value of
    // `place` at the image's start.
    Result (*shadow)(void *state, const BackendFrame *frame, Error *error);
    Result (*scatter)(void *state, const BackendFrame *frame, Error *error);
    Result (*shade)(void *state, const BackendFrame *frame, Error *error);
    Result (*composite)(void *state, const BackendFrame *frame, Image *image, Error *error);
    void (*count)(const void *state, RendererCounts *counts); // of the last window
    // See renderer_settle, renderer_take, renderer_place; NULL: images are filled at once.
    Result (*settle)(void *state, const BackendFrame *frame, Error *error);
    Result (*take)(void *state, int place, Image *image, Error *error);
    int (*place)(const void *state);
} DrawBackend;

extern const DrawBackend DRAW_LANES, DRAW_PASSES;
