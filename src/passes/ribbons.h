// SPDX-License-Identifier: MIT
// Projects and shades strands in compute shaders: makes the ribbons of the compute rasteriser.
#pragma once

#include "draw/drawing.h"
#include "passes/cull.h"
#include "passes/look_programs.h"

enum { RIBBONS_MOST = 1 << 24 }; // slots; fewer if shaders can access only a smaller buffer

// Mesh and floor. No target: neither.
typedef struct RibbonsBase {
    CullBase cull;
    const int *box; // samples: x, y lowest, highest; outside there is background
} RibbonsBase;

typedef struct Ribbons {
    const GpuLimits *limits;
    LookPrograms project;
    Cull cull;
    GpuBuffer records, keys; // RIBBON_TEXELS uvec4 (block.glsl) and uint a slot: its depth's bits
    GpuBuffer counts;
    RibbonsBase base; // of the image
    size_t slots;     // of the image
    bool skips;       // testing strands is worthwhile: many of the last image could be culled
    uint64_t strands; // of the image
    uint64_t segments, culled; // after counting
} Ribbons;

// `limits` must outlive the ribbons. RESULT_FAILED if memory is short.
Result ribbons_create(Ribbons *ribbons, const GpuLimits *limits, Error *error);
void ribbons_destroy(Ribbons *ribbons);

// Begins an image of at most `segments` ribbons. Needs the DrawParams block. RESULT_FAILED if
// memory is short or if there are more ribbons than shaders can address.
Result ribbons_begin(Ribbons *ribbons, uint64_t segments, const RibbonsBase *base, Error *error);

// Adds a batch. Needs the DrawParams block. RESULT_FAILED if the look's shader does not compile.
Result ribbons_add(Ribbons *ribbons, const HairBatch *batch, const Look *look, Error *error);

// Takes the values of the buffers `counts` and, if strands were tested, `cull.tally`; NULL: they
// were not.
void ribbons_take_counts(Ribbons *ribbons, const uint32_t *counts, const uint32_t *tally);

// Counts the segments and culled strands that were added. Waits for the GPU. RESULT_FAILED if the
// counts can't be read.
Result ribbons_count(Ribbons *ribbons, Error *error);
