// SPDX-License-Identifier: MIT
// What tractrix-convert writes: one file, a file for each frame, or one file of all frames.
#pragma once

#include "base/target.h"
#include "strands/formats/frames_file.h"
#include "strands/strands_report.h"

typedef struct ConvertOutput {
    const char *path;
    int format;      // 0: by the name, else 1 + a FormatKind
    double unit;     // metres per unit of the file
    bool up_z;       // z is up in it
    double width;    // m, of USD's and Alembic's curves; 0: by the number and size of the strands
    bool animated;   // the input has frames
    int first, last; // time codes
    double fps;
    Target target;
    FormatKind kind;
    Strands still; // of the first frame, if all go into one file
    float *widths;
    FramesFile frames;
    uint32_t lost; // features that the files do not have
    int files;     // written
} ConvertOutput;

// Whether the name, or standard output, is for one frame. `format` as above.
bool convert_output_is_still(const char *path, int format);

// Checks the name and makes its folder; everything up to `fps` is set. `frame_count`: how many
// will come. RESULT_USAGE for the name, RESULT_FAILED if no file can be made there.
Result convert_output_open(ConvertOutput *output, int frame_count, Error *error);
void convert_output_close(ConvertOutput *output);

// Writes a frame; the strands are in metres, y up, and are taken over and changed. RESULT_FAILED
// with path and reason, also if one file's strands are not those of the first frame.
Result convert_output_add(ConvertOutput *output, int frame, Strands *strands, Error *error);

// After the last frame.
Result convert_output_finish(ConvertOutput *output, Error *error);
