// SPDX-License-Identifier: MIT
// Hair files of what is drawn, one for each frame (--export).
#pragma once

#include "simulation.h"
#include "strands_report.h"
#include "target.h"

typedef struct Exporter {
    Target target;
    StrandsKind kind;
    const Simulation *simulation;
    Strands strands; // of all sections, one behind the other
    int files;       // written so far
} Exporter;

// `text`: as target_parse_hair takes it. Files have the guides of all sections in the order in
// which they were read, in metres with y up, and of texture coordinates, colours and so on what all
// sections have. .hair: HAIR; .tfx: TressFX 4, or text where strands differ in their number of
// vertices. `frame_count`: how many will come; a name without a number takes one. All arguments
// outlive the exporter. RESULT_USAGE for the name, RESULT_FAILED if no file can be made there or
// memory is short. A zeroed struct may be destroyed.
Result exporter_create(Exporter *exporter, const char *text, int frame_count,
                       const Simulation *simulation, const Strands *strands, Error *error);
void exporter_destroy(Exporter *exporter);

// Writes the positions that are drawn now. The file appears whole or not at all.
Result exporter_write(Exporter *exporter, int frame, Error *error);
