// SPDX-License-Identifier: MIT
// Hair files of the drawn frames: one per frame, or one USD, Alembic or .npz file for all of them
// (--export).
#pragma once

#include "base/target.h"
#include "formats/frames_file.h"
#include "formats/strands_report.h"
#include "sim/simulation.h"

// Arrays are owned; a zeroed struct is empty.
typedef struct SceneLook {
    CurvesLook curves; // points into the other members
    float *width;
    float (*color)[4];
} SceneLook;

typedef struct Exporter {
    Target target;
    FormatKind kind;
    const Simulation *simulation;
    Strands strands; // of all sections, one after the other
    bool followers;  // `strands` contains followers, after the guides of their section
    uint32_t lost;   // features (STRANDS_HAS_...) of the sections that the files lack
    SceneLook look;  // for formats that store looks, like the members below
    CurvesOptions options;
    FramesFile frames; // open if one file takes all frames
    int files;         // number of files written
} Exporter;

// Checks the name before there is a simulation: a name without a number accepts one frame, or all
// of them if its format can hold them. RESULT_USAGE.
Result exporter_check(const char *text, int frame_count, Error *error);

// `text`: as for format_target. Files contain the guides (with export_followers: also the
// followers) of all sections in the order in which they were read, in metres with y up, with the
// texture coordinates, colours and other attributes that all sections have; several sections become
// groups. USD and Alembic files also contain the sections' widths and colours, USD files the
// material of their fibres if all sections have the same. They hold all frames
// in one file, as does .npz, which keeps them in memory until the end. `frame_count`: number of
// frames to come. All arguments must outlive the exporter. Errors of exporter_check, RESULT_FAILED
// if the file can't be created or memory is short. A zeroed struct may be destroyed; destroying
// discards an unfinished file.
Result exporter_create(Exporter *exporter, const char *text, int frame_count,
                       const Simulation *simulation, const Strands *strands, Error *error);
void exporter_destroy(Exporter *exporter);

// Writes the positions of the current frame. Files appear complete or not at all.
Result exporter_write(Exporter *exporter, int frame, Error *error);

// After the last frame.
Result exporter_finish(Exporter *exporter, Error *error);
