// SPDX-License-Identifier: MIT
// The light that points of hair send to the eye. A thread shades a point when it composites the
// first ribbon that shows the point. Other ribbons and other blocks of pixels reuse the result.
#pragma once

#include "base/error.h"
#include "base/simd.h"
#include "lanes/lane_hair.h"
#include "lanes/light_grid.h"
#include "lanes/shadow.h"
#include "lanes/tint_table.h"

#include <stdatomic.h>
#include <stdbool.h>

typedef enum LaneModel {
    LANE_KAJIYA,
    LANE_MARSCHNER, // --lobes energy
    LANE_GAUSS,     // Marschner's own lobes
    LANE_WHITE,     // instead of light: 1,
    LANE_TANGENT,   // (1 + t) / 2,
    LANE_STRAND,    // a colour of the strand's own
} LaneModel;

// How a section's hair is shaded.
typedef struct LaneLook {
    LaneModel model;
    const TintTable *tints;  // of marschner; NULL: strands differ in more than brightness
    const float (*table)[4]; // of marschner: see FibreTable
    int kind;                // of marschner: the fibres' kind in `grid`
} LaneLook;

// All light of an image.
typedef struct LaneLight {
    const DrawParams *draw;
    const LaneShadow *shadow; // NULL: none
    const LightGrid *grid;    // the light among hair; NULL: it is not computed
} LaneLight;

// The shaded points of an image. A zeroed struct is empty.
typedef struct Shades {
    _Atomic uint64_t *points; // [hairs->points], owned: three levels, and the number of the image
    size_t room;
    uint16_t image;
} Shades;

// Begins a new image of `points` points, none of which is shaded. RESULT_FAILED if memory is short.
Result shades_begin(Shades *shades, size_t points, Error *error);
void shades_destroy(Shades *shades);

// Everything that shading a point needs.
typedef struct Shader {
    const LaneHairs *hairs;
    const LaneLight *light;
    const Shades *shades;
} Shader;

// Shades points, given by their numbers among all points of the hair, with the code for a processor
// of this level.
typedef void ShadePoints(const Shader *shader, const uint32_t *points, int count);
extern ShadePoints *const shade_points_on[SIMD_LEVELS];

// The levels of a point (see low_level) in bits 0, 16 and 32; 0: it is not shaded yet.
static inline uint64_t shades_find(const Shades *shades, uint32_t point)
{
    uint64_t word = atomic_load_explicit(&shades->points[point], memory_order_relaxed);
    return word >> 48 == shades->image ? word : 0;
}
