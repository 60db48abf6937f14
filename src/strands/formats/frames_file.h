// SPDX-License-Identifier: MIT
// One file of all frames, in any format that can hold them: USD, Alembic, .npz.
#pragma once

#include "strands/formats/abc_write.h"
#include "strands/formats/format.h"
#include "strands/formats/usd_write.h"

// A zeroed one is not open.
typedef struct FramesFile {
    FormatKind kind;
    const char *path;
    const Strands *strands; // NULL: not open
    CurvesOptions options;
    UsdWriter usd;
    AbcWriter abc;
    float (*npz)[3]; // [count * strands->vertex_count]: kept to the end
    uint32_t count, room;
    int first; // number of the first frame
} FramesFile;

// Whether files of this kind are written with widths and colours of a scene (CurvesLook).
bool frames_file_has_look(FormatKind kind);

// Path, strands and look outlive the file, which is there once it is finished. RESULT_FAILED with
// path and reason.
Result frames_file_open(FramesFile *file, FormatKind kind, const char *path, const Strands *strands,
                        const CurvesOptions *options, Error *error);

// The strands' positions in the next frame; numbers rise evenly. Errors as above.
Result frames_file_add(FramesFile *file, int number, const float (*positions)[3], Error *error);

// Writes the rest and gives the file its name; zeroes the struct. Nothing for one that is not open.
Result frames_file_finish(FramesFile *file, Error *error);

// Removes what is there so far.
void frames_file_discard(FramesFile *file);

// One frame alone, with the look of the options, of a kind that has one.
Result frames_file_write_still(FormatKind kind, const char *path, const Strands *strands,
                               const CurvesOptions *options, Error *error);
