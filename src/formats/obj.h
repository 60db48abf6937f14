// SPDX-License-Identifier: MIT
// Wavefront OBJ: its statements, whether a file holds a mesh or hair, reading and writing meshes.
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

// The indices of a corner as in the file: from 1, or negative from the last one read so far; 0 if
// absent. In the order of the file format.
typedef struct ObjCorner {
    int64_t vertex, uv, normal;
} ObjCorner;

// Whether the content is text that begins with a statement or a comment of this format.
bool obj_matches(const Bytes *bytes);

// Steps over the word of the next known statement. The caller reads the rest of the line and ends
// it with reader_skip_line. False at the file's end and after an error. The reader needs
// `continuation`.
bool obj_next_statement(Reader *reader, ObjStatement *statement);

// Whether the statement has more words before the end of the line or a comment.
bool obj_goes_on(Reader *reader);

// Steps over the next corner, "v", "v/t", "v//n" or "v/t/n", with numbers up to 2^32 - 1. If there
// is no corner, returns false and the reader stays.
bool obj_take_corner(Reader *reader, ObjCorner *corner);

// Writes a line with `word` and `count` numbers, each as the shortest decimal that reads back.
void obj_put_line(FILE *stream, const char *word, const float *numbers, int count);

// Reads `v`, `vt`, `vn` and `f` statements and skips all others. Corners are v, v/t, v//n or v/t/n,
// with indices from 1, or negative from the last. Polygons become triangle fans around their first
// corner. Unused texture coordinates are dropped. A vertex has one normal: the sum of all normals
// that its corners refer to or, if there are none, the area-weighted sum of its triangles' normals.
// `unit` is metres per unit of the file, > 0; `up_z`: (x, y, z) -> (x, z, -y). RESULT_BAD_INPUT
// with "FILE:LINE: ..." for malformed content, a number that is not finite, an index out of range,
// or a file without faces.
Result obj_read_mesh_bytes(Mesh *mesh, const char *path, const Bytes *bytes, float unit, bool up_z,
                           Error *error);

// Writes positions, texture coordinates and faces (not normals, which reading computes). Numbers
// are the shortest of %.6g .. %.9g that reads back. RESULT_FAILED with the reason.
Result obj_write_mesh(const char *path, const Mesh *mesh, Error *error);
