// SPDX-License-Identifier: MIT
// Writes `.usda`, USD's text form: one BasisCurves prim, linear and nonperiodic, with all strands,
// still or with a time sample of its points for each frame. After Pixar's "USD ASCII" grammar and
// the schema UsdGeomBasisCurves. Frames are written as they come; none is kept.
#pragma once

#include "base/outfile.h"
#include "strands/strands.h"

// How many values an attribute has.
typedef enum UsdRate {
    USD_CONSTANT, // one
    USD_UNIFORM,  // one a strand
    USD_VERTEX,   // one a vertex
} UsdRate;

// What the curves look like. NULL arrays are left out; all outlive the writer.
typedef struct UsdLook {
    const float *width; // diameters in the file's unit
    UsdRate width_rate;
    const float (*color)[4]; // linear RGB and opacity; the latter is written if any is not 1
    UsdRate color_rate;
    const uint32_t *section; // [strand_count] which part of the scene a strand is of
} UsdLook;

typedef struct UsdOptions {
    double metres_per_unit; // of the positions, > 0
    bool up_z;              // else y
    bool animated;          // points are time samples, else there is one frame without a time
    double fps;             // frames, which are the time codes, a second; > 0
    int first, last;        // time codes of the sequence
    UsdLook look;
} UsdOptions;

typedef struct UsdWriter {
    OutFile file;
    const Strands *strands;
    UsdOptions options;
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
                       const UsdOptions *options, Error *error);

// Writes the frame with this time code, greater than those before; without `animated` there is just
// one. Numbers are the shortest decimals that read back as the same float32. RESULT_FAILED when
// memory is short or writing has failed.
Result usd_writer_add(UsdWriter *writer, int code, const float (*positions)[3], Error *error);

// Ends the file and gives it its name; it was not there before. RESULT_FAILED with path and reason.
// The writer is zeroed.
Result usd_writer_finish(UsdWriter *writer, Error *error);

// Removes what is there so far. A zeroed struct, too, may be discarded.
void usd_writer_discard(UsdWriter *writer);

// One still frame: all of the above. Widths are those of vertices if the strands have any, colours
// theirs.
Result usd_write_still(const char *path, const Strands *strands, const UsdOptions *options,
                       Error *error);

// The same in metres, y up, to a file that is open and stays so (Format.write).
Result usd_write_strands(OutFile *file, const Strands *strands, Error *error);
