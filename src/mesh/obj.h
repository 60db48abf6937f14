// SPDX-License-Identifier: MIT
// Wavefront OBJ: its statements, whether they hold a mesh or hair, and meshes in and out.
#pragma once

#include "base/reader.h"
#include "mesh/mesh.h"

#include <stdio.h>

typedef enum ObjStatement {
    OBJ_VERTEX, // v x y z
    OBJ_UV,     // vt u v
    OBJ_NORMAL, // vn x y z
    OBJ_LINE,   // l corner corner ...
    OBJ_FACE,   // f corner corner corner ...
    OBJ_OTHER,  // anything else
} ObjStatement;

// The numbers of a corner as they stand in the file: from 1, or negative from the last one read so
// far; 0: none. In the order in which files have them.
typedef struct ObjCorner {
    int64_t vertex, uv, normal;
} ObjCorner;

// Whether the content is text that begins with a statement or a comment of this format.
bool obj_matches(const Bytes *bytes);

// Steps over the next statement's word, if it is one of those above. The caller reads the rest of
// the line and ends it with reader_skip_line. False at the file's end and after a failure. The
// reader needs `continuation`.
bool obj_next_statement(Reader *reader, ObjStatement *statement);

// Whether the statement goes on before its line's end or a comment.
bool obj_goes_on(Reader *reader);

// Steps over the next corner, "v", "v/t", "v//n" or "v/t/n"; numbers are at most 2^32 - 1. False,
// and the reader stays, if something else stands there.
bool obj_take_corner(Reader *reader, ObjCorner *corner);

// Writes `word` and `count` numbers, each the shortest decimal that reads back, as a line.
void obj_put_line(FILE *stream, const char *word, const float *numbers, int count);

// Reads `v`, `vt`, `vn` and `f` statements and passes over all others: corners v, v/t, v//n or
// v/t/n, indices from 1 or negative from the last; polygons become fans around their first corner.
// Texture coordinates that no corner names are left out. A vertex has one normal: the sum of all
// normals that its corners name, or, where they name none, of the normals of its triangles by area.
// `unit` is metres per unit of the file, > 0; `up_z`: (x, y, z) -> (x, z, -y). RESULT_BAD_INPUT
// with "FILE:LINE: ..." for anything malformed, a number that is not finite, an index out of range,
// or a file without faces.
Result obj_read_mesh_bytes(Mesh *mesh, const char *path, const Bytes *bytes, float unit, bool up_z,
                           Error *error);

// Writes positions, texture coordinates and faces (no normals: reading computes them), numbers as
// the shortest of %.6g .. %.9g that reads back. RESULT_FAILED with the reason.
Result obj_write_mesh(const char *path, const Mesh *mesh, Error *error);
