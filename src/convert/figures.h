// SPDX-License-Identifier: MIT
// Statistics of strands: measured, printed and as JSON.
#pragma once

#include "strands/fibre.h"
#include "strands/strands_mesh.h"

#include <jansson.h>
#include <stdio.h>

// Statistics of one quantity over all strands, segments, ...; all 0 if there are none.
typedef struct Figure {
    uint64_t count;
    double min, low, median, high, max; // low, high: percentiles 5 and 95
    double mean;
} Figure;

typedef enum FigureKind {
    FIGURE_SIZE,      // vertices, of strands
    FIGURE_LENGTH,    // m, of strands
    FIGURE_REACH,     // distance from root to tip relative to the length, of strands: 1 is straight
    FIGURE_SEGMENT,   // m, length of segments
    FIGURE_TURN,      // degrees between successive segments, at inner vertices
    FIGURE_CURVATURE, // 1/m, at inner vertices: the turn in radians over the mean length of the two
                      // segments
    FIGURE_GAMMA,     // (length/L_gb)^3, of strands, see gravito_bending_length
    FIGURE_CURL,      // curvature times L_gb, at inner vertices
    FIGURE_ROOTS,     // m, from a root to the nearest other root
    FIGURE_DEPTH,     // mm, of vertices inside a mesh, except roots
    FIGURE_KINDS
} FigureKind;

// A vertex count and the number of strands that have it.
typedef struct SizeCount {
    uint32_t size, strands;
} SizeCount;

typedef struct Figures {
    uint32_t strands, vertices;
    Figure figures[FIGURE_KINDS];
    double total_length;           // m
    Fibre fibre;                   // the file's material, and the default for what it does not say
    double gravito_bending_length; // m, L_gb of this fibre under default gravity (fibre.h)
    float low[3], high[3];         // box of all vertices, m
    SizeCount *sizes;              // [size_count], owned, ascending
    uint32_t size_count;
    bool has_mesh;
    uint32_t strands_inside; // number of strands with a vertex inside the mesh
} Figures;

// `surface`: of the mesh for depths; NULL: depths are not measured. RESULT_FAILED when memory is
// short. A zeroed struct may be destroyed.
Result figures_measure(Figures *figures, const Strands *strands, const Surface *surface,
                       Error *error);
void figures_destroy(Figures *figures);

// Prints a table of the statistics and of vertex counts.
void figures_print(const Figures *figures, FILE *stream);

// NULL when memory is short.
json_t *figures_to_json(const Figures *figures);
