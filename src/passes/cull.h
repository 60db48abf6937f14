// SPDX-License-Identifier: MIT
// Finds the strands that need not be projected: those outside the image and those that lie wholly
// behind mesh or floor. The image is the same to the byte as with them.
#pragma once

#include "draw/look.h"
#include "gpu/shader.h"
#include "passes/render_target.h"
#include "sim/hair.h"

#include <stdbool.h>

// If more than 1 / CULL_SHARE of an image's strands were left out, strands of the next image are
// tested.
enum { CULL_SHARE = 16, CULL_TALLY_BYTES = 8 };

// Variants of the shader that lists strands: something is opaque, hair has paint, hair is drawn as
// curves.
enum { CULL_HIDING = 1, CULL_PAINT = 2, CULL_SMOOTH = 4, CULL_VARIANTS = 8 };

// A zeroed struct is empty.
typedef struct Cull {
    const GpuLimits *limits;    // the context's, set by the owner
    GLuint list[CULL_VARIANTS]; // programs
    GLuint hide, spread;        // programs
    GpuBuffer listed;           // of a part: number of strands, rows: see block_cull.comp
    GpuBuffer tally;            // of the image: numbers of listed strands and of hidden strands
    GpuBuffer nearest, levels;  // see cull_make_levels
    int tiles[2];               // columns, rows
    uint64_t base;              // BaseLayer.depth_version that `levels` were made for; 0: none
    bool covered;               // something opaque is in this image
    bool tries; // tests strands of this image: many of the last image were culled, or the base is
                // new
    bool off;   // never tests strands; for tests
    uint64_t looked_at;       // number of strands tested in this image
    uint64_t outside, hidden; // numbers of culled strands, after counting
} Cull;

// The opaque surfaces of an image: their depth, in samples, and a version >= 1 that differs
// whenever the depth has changed. NULL target: none.
typedef struct CullBase {
    const RenderTarget *target;
    uint64_t version;
} CullBase;

// Compiles the shaders for hair with the CULL_ bits `variant`, unless they are there.
Result cull_build(Cull *cull, unsigned variant, Error *error);

// Begins an image. `many`: so many strands of the last image were culled that testing is worth its
// time. Needs the DrawParams block. RESULT_FAILED if memory is short.
Result cull_begin(Cull *cull, const CullBase *base, bool many, Error *error);

// Makes room for a list of this many strands; texture units may change. RESULT_FAILED if memory is
// short.
Result cull_make_room(Cull *cull, uint32_t strands, Error *error);

// Lists the part's strands that may be seen in BIND_LISTED; the first word is their number. Only if
// `tries`. Needs cull_make_room, the uniforms of image and part, and the bound positions.
Result cull_list(Cull *cull, const HairBatch *batch, const MaterialParams *part, Error *error);

// Sets the counts to zero, for another band with the same strands. Does nothing unless `tries`.
void cull_restart(Cull *cull);

// Fills in `outside` and `hidden` from CULL_TALLY_BYTES of `tally`. NULL: strands were not tested.
void cull_count(Cull *cull, const uint32_t *tally);

void cull_destroy(Cull *cull);

// Computes from which depth on hair is hidden, for tiles of the image and for larger ones.
// `nearest` and `levels` have [HIDE_LEVELS][rows][columns] floats; `tiles` has the columns and
// rows, both >= 1. On the first level `nearest` has a value for each tile (block_hide.comp). A tile
// of level k covers 2^k x 2^k tiles of the first level. In `levels` it gets the least value of all
// tiles in it and in the eight tiles around it. Tiles that a level does not have are not written.
// Only queues work. Errors are those of shader_build_compute.
Result cull_make_levels(Cull *cull, Error *error);
