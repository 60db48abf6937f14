// SPDX-License-Identifier: MIT
// Hair files of the drawn frames: one per frame, or one USD, Alembic or .npz file for all of them
// (--export).
#pragma once

#include "base/target.h"
#include "sim/simulation.h"
#include "strands/formats/frames_file.h"
#include "strands/strands_report.h"

// Arrays are owned; a zeroed struct is empty.
typedef struct SceneLook {
    CurvesLook curves; // points into the rest
    float *width;
    float (*color)[4];
} SceneLook;

typedef struct Exporter {
    Target target;
    FormatKind kind;
    const Simulation *simulation;
    Strands strands; // of all sections, one behind the other
    bool followers;  // they are among them, behind the guides of their section
    uint32_t lost;   // features (STRANDS_HAS_...) of the sections that the files do not have
    SceneLook look;  // of formats that have one, like the rest
    CurvesOptions options;
    FramesFile frames; // open if one file takes all frames
    int files;         // written so far
} Exporter;

// `text`: as format_target takes it. Files have the guides
// (with export_followers: and the followers) of all sections in the order in which they were read,
// in metres with y up, and of texture coordinates, colours and so on what all sections have; of
// several sections each is a group. USD and Alembic also have the sections' widths and colours, and
// all frames in one file, as .npz does, which keeps them in memory until the end. `frame_count`:
// how many will come; a name without a number takes one otherwise. All arguments outlive the
// exporter. RESULT_USAGE for the name, RESULT_FAILED if no file can be made there or memory is
// short. A zeroed struct may be destroyed; destroying discards a file that is not finished.
Result exporter_create(Exporter *exporter, const char *text, int frame_count,
                       const Simulation *simulation, const Strands *strands, Error *error);
void exporter_destroy(Exporter *exporter);

// Writes the positions of the current frame. Files appear complete or not at all.
Result exporter_write(Exporter *exporter, int frame, Error *error);

// After the last frame.
Result exporter_finish(Exporter *exporter, Error *error);
