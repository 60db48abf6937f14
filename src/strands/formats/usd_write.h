// SPDX-License-Identifier: MIT
// Writes `.usda`, USD's text form: one BasisCurves prim, linear and nonperiodic, with all strands,
// still or with a time sample of its points for each frame. After Pixar's "USD ASCII" grammar and
// the schema UsdGeomBasisCurves. Frames are written as they come; none is kept.
#pragma once

#include "base/outfile.h"
#include "strands/formats/curves_look.h"

typedef struct UsdWriter {
    OutFile file;
    const Strands *strands;
    CurvesOptions options;
    float half_width;  // largest, for the extent
    int *codes;        // [frame_count]
    float (*boxes)[6]; // [frame_count] the extent of each frame
    size_t frame_count, room;
} UsdWriter;

// Opens the file and writes all that does not move; the strands outlive the writer, and their
// positions are not looked at. Everything that they have (strands_features) is written: texture
// coordinates as primvars:st (of strands) and primvars:st1 (of vertices), thickness as widths if
// the look has none and as primvars:thickness, colours as displayColor likewise, mobility as
// primvars:mobility, followers and fixed ends as customData. RESULT_FAILED with path and reason.
Result usd_writer_open(UsdWriter *writer, const char *path, const Strands *strands,
                       const CurvesOptions *options, Error *error);

// Writes the frame with this time code, greater than those before; without `animated` there is just
// one. Numbers are the shortest decimals that read back as the same float32. RESULT_FAILED when
// memory is short or writing has failed.
Result usd_writer_add(UsdWriter *writer, int code, const float (*positions)[3], Error *error);

// Ends the file and gives it its name; it was not there before. RESULT_FAILED with path and reason.
// The writer is zeroed.
Result usd_writer_finish(UsdWriter *writer, Error *error);

// Removes what is there so far. A zeroed struct, too, may be discarded.
void usd_writer_discard(UsdWriter *writer);

// One still frame in metres, y up, to a file that is open and stays so (Format.write). Widths are
// those of vertices if the strands have any, colours theirs.
Result usd_write_strands(OutFile *file, const Strands *strands, Error *error);
