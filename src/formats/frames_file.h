// SPDX-License-Identifier: MIT
// One file with all frames, in any format that can be animated: USD, Alembic, .npz.
#pragma once

#include "formats/abc_write.h"
#include "formats/format.h"
#include "formats/usd_write.h"

// A zeroed struct is not open.
typedef struct FramesFile {
    FormatKind kind;
    const char *path;
    const Strands *strands; // NULL if not open
    CurvesOptions options;
    UsdWriter usd;
    AbcWriter abc;
    float (*npz)[3]; // [count * strands->vertex_count] kept until the end
    uint32_t count, room;
    int first; // number of the first frame
} FramesFile;

// Whether files of this kind contain widths and colours for scenes (CurvesLook).
bool frames_file_has_look(FormatKind kind);

// Opens the file. Path, strands and look must outlive it. The file appears when it is finished.
// RESULT_FAILED with path and reason.
Result frames_file_open(FramesFile *file, FormatKind kind, const char *path, const Strands *strands,
                        const CurvesOptions *options, Error *error);

// Adds the positions of the next frame; numbers must be evenly spaced. Errors as above.
Result frames_file_add(FramesFile *file, int number, const float (*positions)[3], Error *error);

// Writes the rest and gives the file its name; zeroes the struct. Does nothing if the file is not
// open.
Result frames_file_finish(FramesFile *file, Error *error);

// Removes the unfinished file.
void frames_file_discard(FramesFile *file);

// Writes a single frame with the look of the options; the kind must have a look.
Result frames_file_write_still(FormatKind kind, const char *path, const Strands *strands,
                               const CurvesOptions *options, Error *error);
