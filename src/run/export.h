// SPDX-License-Identifier: MIT
// Hair files of the drawn frames: one per frame, or one USD or .npz file for all of them
// (--export).
#pragma once

#include "base/target.h"
#include "sim/simulation.h"
#include "strands/formats/usd_write.h"
#include "strands/strands_report.h"

// Arrays are owned; a zeroed struct is empty.
typedef struct SceneLook {
    UsdLook usd; // points into the rest
    float *width;
    float (*color)[4];
    uint32_t *section;
} SceneLook;

typedef struct Exporter {
    Target target;
    FormatKind kind;
    const Simulation *simulation;
    Strands strands; // of all sections, one behind the other
    bool followers;  // they are among them, behind the guides of their section
    uint32_t lost;   // features (STRANDS_HAS_...) of the sections that the files do not have
    SceneLook look;  // USD only, like the rest
    UsdOptions options;
    UsdWriter usd;         // open if one file takes all frames
    float (*frames)[3];    // owned; of one .npz file: [room * vertices]; NULL: none
    uint32_t room, filled; // frames
    int files;             // written so far
} Exporter;

// `text`: as format_target takes it. Files have the guides
// (with export_followers: and the followers) of all sections in the order in which they were read,
// in metres with y up, and of texture coordinates, colours and so on what all sections have. USD
// also has the sections' widths and colours (usd_look.h), and frames as time codes. `frame_count`:
// how many will come; a name without a number takes one, but for USD and .npz, which keeps all of
// them in memory until the end. All arguments outlive the
// exporter. RESULT_USAGE for the name, RESULT_FAILED if no file can be made there or memory is
// short. A zeroed struct may be destroyed; destroying discards a USD file that is not finished.
Result exporter_create(Exporter *exporter, const char *text, int frame_count,
                       const Simulation *simulation, const Strands *strands, Error *error);
void exporter_destroy(Exporter *exporter);

// Writes the positions of the current frame. Files appear complete or not at all.
Result exporter_write(Exporter *exporter, int frame, Error *error);

// After the last frame.
Result exporter_finish(Exporter *exporter, Error *error);
