// SPDX-License-Identifier: MIT
// Statements of Wavefront OBJ files, whether they hold a mesh or hair. A reader of such text needs
// `continuation`.
#pragma once

#include "base/reader.h"

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
bool obj_text_matches(const Bytes *bytes);

// Steps over the next statement's word, if it is one of those above. What stands behind it on the
// line is left to the caller, who ends it with reader_skip_line. False at the file's end and after
// a failure.
bool obj_text_next(Reader *reader, ObjStatement *statement);

// Whether the statement goes on before its line's end or a comment.
bool obj_text_goes_on(Reader *reader);

// Steps over the next corner, "v", "v/t", "v//n" or "v/t/n"; numbers are at most 2^32 - 1. False,
// and the reader stays, if something else stands there.
bool obj_text_take_corner(Reader *reader, ObjCorner *corner);

// Writes `word` and `count` numbers, each the shortest decimal that reads back, as a line.
void obj_text_put(FILE *stream, const char *word, const float *numbers, int count);
