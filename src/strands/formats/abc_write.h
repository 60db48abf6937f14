// SPDX-License-Identifier: MIT
// Writes `.abc`, Alembic's Ogawa form: one object of linear curves with all strands, still or with
// a sample of its points for each frame, under a transform that does nothing. Attributes are
// AbcGeom's (P, nVertices, uv, width) and those of Unreal's groom schema, version 1.5: groom_width,
// which is in centimetres, groom_root_uv, groom_color, groom_group_id. Frames are written as they
// come.
#pragma once

#include "base/ogawa_write.h"
#include "base/outfile.h"
#include "strands/formats/curves_look.h"

#define ABC_GROOM_UNIT 0.01 // m, of groom_width

typedef struct AbcWriter {
    OutFile file;
    OgawaWriter ogawa; // to the file, or to `memory` where that is a device, a pipe or appended to
    bool buffered;
    char *memory; // NULL: none
    size_t memory_size;
    const Strands *strands;
    CurvesOptions options;
    uint64_t *samples; // [frame_count] places of the frames' points
    double (*boxes)[6];
    int first, last; // numbers of the frames
    size_t frame_count, room;
} AbcWriter;

// Opens the file; the strands and the look outlive the writer, and positions are not looked at.
// Everything that they have (strands_features) is written; width and colour are those of the look
// if it has some. RESULT_FAILED with path and reason.
Result abc_writer_open(AbcWriter *writer, const char *path, const Strands *strands,
                       const CurvesOptions *options, Error *error);

// Writes the frame of this number, as far behind the one before as all others; without `animated`
// there is just one. RESULT_FAILED when memory is short or writing has failed.
Result abc_writer_add(AbcWriter *writer, int number, const float (*positions)[3], Error *error);

// Ends the file and gives it its name. RESULT_FAILED with path and reason. The writer is zeroed.
Result abc_writer_finish(AbcWriter *writer, Error *error);

// Removes what is there so far. A zeroed struct, too, may be discarded.
void abc_writer_discard(AbcWriter *writer);

// One still frame in the strands' own unit, to a file that is open and stays so (Format.write).
Result abc_write_strands(OutFile *file, const Strands *strands, Error *error);
