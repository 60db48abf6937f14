// SPDX-License-Identifier: MIT
// Writes `.abc`, Alembic's Ogawa form: one object of linear curves with all strands, with one
// sample or a sample for each frame, under an identity transform. The attributes are AbcGeom's (P,
// nVertices, uv, width) and those of Unreal's groom schema, version 1.5: groom_width (in
// centimetres), groom_root_uv, groom_color, groom_group_id. Frames are written as they come.
#pragma once

#include "base/outfile.h"
#include "formats/curves_look.h"
#include "formats/ogawa_write.h"

#define ABC_GROOM_UNIT 0.01 // m, unit of groom_width

typedef struct AbcWriter {
    OutFile file;
    OgawaWriter ogawa; // writes to the file, or to `memory` if the file cannot be rewound
    bool buffered;
    char *memory; // NULL if not used
    size_t memory_size;
    const Strands *strands;
    CurvesOptions options;
    uint64_t *samples; // [frame_count] file offsets of the frames' points
    double (*boxes)[6];
    int first, last; // numbers of the frames
    size_t frame_count, room;
} AbcWriter;

// Opens the file. The strands and the look must outlive the writer; the strands' positions are not
// used. Writes all their features (strands_features); width and colour come from the look if it has
// them. RESULT_FAILED with path and reason.
Result abc_writer_open(AbcWriter *writer, const char *path, const Strands *strands,
                       const CurvesOptions *options, Error *error);

// Writes the frame with this number; numbers must be evenly spaced. Without `animated` there is
// only one frame. RESULT_FAILED when memory is short or writing has failed.
Result abc_writer_add(AbcWriter *writer, int number, const float (*positions)[3], Error *error);

// Finishes the file and gives it its name. RESULT_FAILED with path and reason. Zeroes the writer.
Result abc_writer_finish(AbcWriter *writer, Error *error);

// Removes the unfinished file. A zeroed struct may be discarded, too.
void abc_writer_discard(AbcWriter *writer);

// Writes one frame in the strands' own unit to an open file, which stays open (Format.write).
Result abc_write_strands(OutFile *file, const Strands *strands, Error *error);
