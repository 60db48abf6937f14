// SPDX-License-Identifier: MIT
// Which strands need not be projected: those outside the image, and those
// that lie wholly behind the mesh or the floor. Either way the image is the same to the byte.
#pragma once

#include "draw/look.h"
#include "gpu/shader.h"
#include "passes/render_target.h"
#include "sim/hair.h"

#include <stdbool.h>

// Of the strands of an image, left out: looking for them in the next one pays.
enum { CULL_SHARE = 16, CULL_TALLY_BYTES = 8 };

// What the shader that lists strands needs: something opaque is there, painted, smooth.
enum { CULL_HIDING = 1, CULL_PAINT = 2, CULL_SMOOTH = 4, CULL_VARIANTS = 8 };

// A zeroed struct is empty.
typedef struct Cull {
    const GpuLimits *limits;    // the context's, set by who makes it
    GLuint list[CULL_VARIANTS]; // programs
    GLuint hide, spread;        // programs
    GpuBuffer listed;           // of a part: how many, rows: see block_cull.comp
    GpuBuffer tally;            // of the image: strands that are listed, that are hidden
    GpuBuffer nearest, levels;  // see cull_make_levels
    int tiles[2];               // columns, rows
    uint64_t base;              // BaseLayer.depth_version that `levels` were made for; 0: none
    bool covered;               // something opaque is in this image
    bool tries;               // this image: many were left out of the last one, or the base is new
    bool off;                 // never try, so that tests can tell
    uint64_t looked_at;       // strands of this image
    uint64_t outside, hidden; // of them left out, once they are counted
} Cull;

// What is opaque in an image: its depth, of a size in samples, and a number that is another one
// whenever it has changed, from 1 on. NULL target: nothing.
typedef struct CullBase {
    const RenderTarget *target;
    uint64_t version;
} CullBase;

// Compiles the shaders for hair that needs CULL_ bits `variant`, unless they are there.
Result cull_build(Cull *cull, unsigned variant, Error *error);

// Begins an image. `many`: of the last one so many strands were left out, here or later, that it
// is worth trying. Needs the DrawParams block. RESULT_FAILED if memory is short.
Result cull_begin(Cull *cull, const CullBase *base, bool many, Error *error);

// Makes room for a list of so many strands; texture units may change. RESULT_FAILED if memory is
// short.
Result cull_make_room(Cull *cull, uint32_t strands, Error *error);

// Lists the part's strands that may be seen in BIND_LISTED, how many there are before them. Only if
// `tries`. Needs room, the uniforms of image and part, positions bound.
Result cull_list(Cull *cull, const HairBatch *batch, const MaterialParams *part, Error *error);

// Begins to count anew: another band has the same strands. Nothing if it does not try.
void cull_restart(Cull *cull);

// What `tally` has come to, CULL_TALLY_BYTES of it: fills `outside` and `hidden`. NULL: it was not
// tried.
void cull_count(Cull *cull, const uint32_t *tally);

void cull_destroy(Cull *cull);

// How far away something may be and still be seen, by tiles of the image and by larger ones.
// `nearest` and `levels` have [HIDE_LEVELS][rows][columns] floats, `tiles` of them, both counts
// >= 1. Of the first level `nearest` has a figure for each tile (block_hide.comp). In `levels`,
// tile (x, y) of level k, which has 2^k x 2^k of the first, gets the least of all that lie in it
// and in the eight around it. Where a level has no such tile nothing is written. Only queues GPU
// work. Errors of shader_build_compute.
Result cull_make_levels(Cull *cull, Error *error);
