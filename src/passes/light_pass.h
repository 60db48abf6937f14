// SPDX-License-Identifier: MIT
// The single passes of the light grid's shaders: how each is compiled and dispatched.
#pragma once

#include "passes/hair_shadow.h"

typedef enum LightPass {
    LIGHT_PASS_BOX,
    LIGHT_PASS_MARK,
    LIGHT_PASS_HAIR_SLOTS,
    LIGHT_PASS_BESIDE_SLOTS,
    LIGHT_PASS_PLACES,
    LIGHT_PASS_AREAS,
    LIGHT_PASS_LIT,      // for a light with a map of hair
    LIGHT_PASS_LIT_WIDE, // for such a light with a radius
    LIGHT_PASS_LIT_ALL,  // for a light without a map
    LIGHT_PASS_FILL,
    LIGHT_PASS_GLOW,
    LIGHT_PASS_SWEEP,
    LIGHT_PASS_SWEEP_WALLED,
    LIGHT_PASS_SWEEP_ONTO, // the light that hair sends, for skin
    LIGHT_PASS_ONTO,
    LIGHT_PASS_ORDER,
    LIGHT_PASS_SCATTER,
    LIGHT_PASS_CLOSE,
    LIGHT_PASS_HIDE,
    LIGHT_PASS_GATHER,
    LIGHT_PASSES
} LightPass;

// parts of a strand that one lane processes
enum { LIGHT_PART_VERTICES = 64, LIGHT_PART_SEGMENTS = 8 };

// A struct that is zeroed except for `limits` has no programs yet.
typedef struct LightPrograms {
    const GpuLimits *limits;
    GLuint program[LIGHT_PASSES][CAST_VARIANTS];
} LightPrograms;

// light_pass_build compiles a pass for hair with the CAST_ bits `variant`, unless it is there.
// light_pass_use also makes it the current program. RESULT_FAILED with the compiler's message.
Result light_pass_build(LightPrograms *programs, LightPass pass, unsigned variant, Error *error);
Result light_pass_use(LightPrograms *programs, LightPass pass, unsigned variant, Error *error);

// Runs the current program, which must be that of `pass`, on this many cells or slots. Later passes
// wait for it.
void light_pass_run_cells(const LightPrograms *programs, LightPass pass, int count);

// Runs the current program on one of `step` strands of a caster (cell_strand). A strand has `of`
// segments or vertices, which are processed in parts of `part`. Call light_pass_end after the last
// caster.
void light_pass_run_hair(const LightPrograms *programs, const ShadowCaster *caster, uint32_t step,
                         uint32_t of, uint32_t part);

// Makes later passes wait for all previous ones.
void light_pass_end(void);

void light_pass_destroy(LightPrograms *programs);
