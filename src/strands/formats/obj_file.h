// SPDX-License-Identifier: MIT
// Wavefront OBJ with lines: `v` vertices and `l` elements, each a strand from root to tip.
#pragma once

#include "strands/formats/strands_source.h"

#include <stdio.h>

// Reads `v` and `l` statements and passes over all others. Indices are from 1 or negative from the
// last vertex; corners may be v or v/t. An `l` that begins at the vertex at which the one before it
// ended goes on with that strand, as programs that write each edge for itself have it. Vertices
// that no line uses are passed over.
Result obj_file_read(StrandsSource *source, Reader *reader);

// Writes a vertex and a line for all of them, each number the shortest decimal that reads back.
void obj_file_write(FILE *stream, const Strands *strands);
