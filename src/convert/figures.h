// SPDX-License-Identifier: MIT
// Statistics of strands: measured, printed and as JSON.
#pragma once

#include "strands/strands_mesh.h"

#include <jansson.h>
#include <stdio.h>

// Of one quantity over all strands, segments, ...; all 0 if there are none.
typedef struct Figure {
    uint64_t count;
    double min, low, median, high, max; // low, high: 5 % and 95 % are not greater
    double mean;
} Figure;

typedef enum FigureKind {
    FIGURE_SIZE,      // vertices, of strands
    FIGURE_LENGTH,    // m, of strands
    FIGURE_REACH,     // from root to tip over the length, of strands: 1 is straight
    FIGURE_SEGMENT,   // m, length of segments
    FIGURE_TURN,      // degrees between a segment and the next, at inner vertices
    FIGURE_CURVATURE, // 1/m, there: the turn in radians over the mean of the segments' lengths
    FIGURE_ROOTS,     // m, from a root to the nearest other one
    FIGURE_DEPTH,     // mm, of vertices inside a mesh, but roots
    FIGURE_KINDS
} FigureKind;

// A number of vertices and how many strands have it.
typedef struct SizeCount {
    uint32_t size, strands;
} SizeCount;

typedef struct Figures {
    uint32_t strands, vertices;
    Figure figures[FIGURE_KINDS];
    double total_length;   // m
    float low[3], high[3]; // box of all vertices, m
    SizeCount *sizes;      // [size_count], owned, by rising size
    uint32_t size_count;
    bool has_mesh;
    uint32_t strands_inside; // that have a vertex inside the mesh
} Figures;

// `surface`: of a mesh by which depth is measured; NULL: there is none, and no such figure.
// RESULT_FAILED when memory is short. A zeroed struct may be destroyed.
Result figures_measure(Figures *figures, const Strands *strands, const Surface *surface,
                       Error *error);
void figures_destroy(Figures *figures);

// Prints a table of them, and how many strands have how many vertices.
void figures_print(const Figures *figures, FILE *stream);

// NULL when memory is short.
json_t *figures_to_json(const Figures *figures);
