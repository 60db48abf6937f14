// SPDX-License-Identifier: MIT
// The output of tractrix-convert: one file, a file for each frame, or one file for all frames.
#pragma once

#include "base/target.h"
#include "formats/frames_file.h"
#include "formats/strands_report.h"

typedef struct ConvertOutput {
    const char *path;
    int format;      // 0: by the name, otherwise 1 + a FormatKind
    double unit;     // metres per unit of the file
    bool up_z;       // z is up in the file
    double width;    // m, of USD's and Alembic's curves; 0: by the number and size of the strands
    bool animated;   // the input has frames
    int first, last; // time codes
    double fps;
    Target target;
    FormatKind kind;
    Strands still; // of the first frame, if one file holds all frames
    float *widths;
    FramesFile frames;
    uint32_t lost; // features that the files lack
    int files;     // number written
} ConvertOutput;

// Whether the name, or standard output, is for a single frame. `format` as above.
bool convert_output_is_still(const char *path, int format);

// Checks the name and creates its folder; all members up to `fps` must be set. `frame_count`:
// number of frames to come. RESULT_USAGE for the name, RESULT_FAILED if the file can't be created.
Result convert_output_open(ConvertOutput *output, int frame_count, Error *error);
void convert_output_close(ConvertOutput *output);

// Writes a frame; the strands are in metres, y up, and are taken over and changed. RESULT_FAILED
// with path and reason, also if the strands of a file with several frames differ from the first
// frame's.
Result convert_output_add(ConvertOutput *output, int frame, Strands *strands, Error *error);

// After the last frame.
Result convert_output_finish(ConvertOutput *output, Error *error);
