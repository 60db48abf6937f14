// SPDX-License-Identifier: MIT
// The file of a frame or of a contact sheet: first written, then given its name, so that files can
// be written side by side and appear in the order of their frames.
#pragma once

#include "base/outfile.h"
#include "base/target.h"
#include "image/exr_file.h"
#include "image/image.h"
#include "image/image_text.h"
#include "run/fingerprint.h"

#include <stdbool.h>
#include <stdint.h>

// What goes into the file beside the image: the scene into PNG and EXR, of PFM into a file beside
// it (record.h); the rest into EXR.
typedef struct FrameExtra {
    char scene[FINGERPRINT_BYTES]; // empty: none
    Image layers[EXR_LAYERS];      // IMAGE_FLOAT of 3 channels; without pixels where there are none
    float world_to_camera[4][4], world_to_ndc[4][4]; // see ExrFile
} FrameExtra;

typedef struct FrameFile {
    const Target *target; // outlives this
    int first, last;      // frames that the image shows, the same but for a sheet; the first is
                          // the number in the name
    bool exr_float;       // of EXR: 32 bits a channel
    OutFile file;         // zeroed at first
    uint64_t bytes;       // that were written
} FrameFile;

// Encodes and writes the image, whose file has no name yet. `texts` go into PNG and EXR, with the
// number of the frame and the scene added; NULL: neither. `extra`: NULL: of a sheet, which has
// none. RESULT_FAILED with path and reason; then only frame_file_discard may follow.
Result frame_file_write(FrameFile *file, const Image *image, ImageTexts *texts,
                        const FrameExtra *extra, Error *error);

// Gives the file its name, and adds `scene` to the record where the file cannot hold it (empty:
// none). RESULT_FAILED with path and reason.
Result frame_file_commit(FrameFile *file, const char *scene, Error *error);

// Removes a file that has no name yet. Legal at any time.
void frame_file_discard(FrameFile *file);
