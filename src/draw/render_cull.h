// SPDX-License-Identifier: MIT
// Which strands need not be projected: those outside the picture, and those
// that lie wholly behind the mesh or the floor. Either way the picture is the same to the byte.
#pragma once

#include "draw/render_look.h"
#include "draw/render_target.h"
#include "sim/hair.h"

#include <stdbool.h>

// Of the strands of a picture, left out: looking for them in the next one pays.
enum { RENDER_CULL_SHARE = 16 };

// What the shader that lists strands needs: something opaque is there, painted, smooth.
enum { CULL_HIDING = 1, CULL_PAINT = 2, CULL_SMOOTH = 4, CULL_VARIANTS = 8 };

// A zeroed struct is empty.
typedef struct RenderCull {
    GLuint list[CULL_VARIANTS]; // programs
    GLuint hide;                // program
    GpuBuffer listed;           // how many, how many hidden, rows: see block_cull.comp
    GpuBuffer nearest;          // by tile, see block_hide.comp
    GpuBuffer levels;           // see hide_levels.h
    int tiles[2];               // columns, rows
    uint64_t base;              // RenderBase.depth_version that `levels` were made for; 0: none
    bool covered;               // something opaque is in this picture
    bool tries; // this picture: many were left out of the last one, or the base is new
    bool off;   // never try, so that tests can tell
    uint64_t outside, hidden; // strands of this picture that were left out
} RenderCull;

// What is opaque in a picture: its depth, of a size in samples, and a number that is another one
// whenever it has changed, from 1 on. NULL target: nothing.
typedef struct CullBase {
    const RenderTarget *target;
    uint64_t version;
} CullBase;

// Compiles the shaders for hair that needs CULL_ bits `variant`, unless they are there.
Result render_cull_build(RenderCull *cull, unsigned variant, Error *error);

// Begins a picture. `many`: of the last one so many strands were left out, here or later, that it
// is worth trying. Needs the DrawParams block. RESULT_FAILED if memory is short.
Result render_cull_begin(RenderCull *cull, const GpuLimits *limits, const CullBase *base, bool many,
                         Error *error);

// Makes room for a list of so many strands; texture units may change. RESULT_FAILED if memory is
// short.
Result render_cull_make_room(RenderCull *cull, const GpuLimits *limits, uint32_t strands,
                             Error *error);

// Lists the part's strands that may be seen in BIND_LISTED, and how many they are. Only if `tries`.
// Needs room, the uniforms of picture and part, positions bound. Waits.
Result render_cull_list(RenderCull *cull, const HairBatch *batch, const MaterialParams *part,
                        uint32_t *count, Error *error);

void render_cull_destroy(RenderCull *cull);
