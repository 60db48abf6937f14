// SPDX-License-Identifier: MIT
// Writes `.usda`, USD's text form: one BasisCurves prim (linear, nonperiodic) with all strands,
// with one sample of its points or a sample for each frame. Follows Pixar's "USD ASCII" grammar and
// the schema UsdGeomBasisCurves. Frames are written as they come and not stored.
#pragma once

#include "base/outfile.h"
#include "formats/curves_look.h"

typedef struct UsdWriter {
    OutFile file;
    const Strands *strands;
    CurvesOptions options;
    float half_width;  // the largest, for the extent
    int *codes;        // [frame_count]
    float (*boxes)[6]; // [frame_count] the extent of each frame
    size_t frame_count, room;
} UsdWriter;

// Opens the file and writes everything that is not animated. The strands must outlive the writer;
// their positions are not used. Writes all their features (strands_features): texture coordinates
// as primvars:st (of strands) and primvars:st1 (of vertices), thickness as widths if the look has
// none and as primvars:thickness, colours as displayColor likewise, mobility as primvars:mobility,
// followers and fixed ends as customData, the fibres' material as a Material /Hair/Fibre and as
// physics:thicknesses. RESULT_FAILED with path and reason.
Result usd_writer_open(UsdWriter *writer, const char *path, const Strands *strands,
                       const CurvesOptions *options, Error *error);

// Writes the frame with this time code, which must be greater than the previous one; without
// `animated` there is only one. Numbers are the shortest decimals that read back as the same
// float32. RESULT_FAILED when memory is short or writing has failed.
Result usd_writer_add(UsdWriter *writer, int code, const float (*positions)[3], Error *error);

// Finishes the file and gives it its name. RESULT_FAILED with path and reason. Zeroes the writer.
Result usd_writer_finish(UsdWriter *writer, Error *error);

// Removes the unfinished file. A zeroed struct may be discarded, too.
void usd_writer_discard(UsdWriter *writer);

// Writes one frame in metres, y up, to an open file, which stays open (Format.write). Widths and
// colours are those of the vertices if the strands have any.
Result usd_write_strands(OutFile *file, const Strands *strands, Error *error);
