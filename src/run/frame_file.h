// SPDX-License-Identifier: MIT
// The file of a frame or of a contact sheet. It is written first and gets its name later, so that
// files can be written in parallel and still appear in the order of their frames.
#pragma once

#include "base/outfile.h"
#include "base/target.h"
#include "image/exr_file.h"
#include "image/image.h"
#include "image/image_text.h"
#include "run/fingerprint.h"

#include <stdbool.h>
#include <stdint.h>

// What is stored besides the image: the scene's number in PNG and EXR files, and for PFM in a file
// next to them (record.h); the rest in EXR files.
typedef struct FrameExtra {
    char scene[FINGERPRINT_BYTES]; // empty: none
    Image layers[EXR_LAYERS];      // IMAGE_FLOAT of 3 channels; without pixels if absent
    float world_to_camera[4][4], world_to_ndc[4][4]; // see ExrFile
} FrameExtra;

typedef struct FrameFile {
    const Target *target; // outlives this
    int first, last; // frames in the image, equal except for a sheet; `first` is the number in the
                     // name
    bool exr_float;  // of EXR: 32 bits per channel
    OutFile file;    // initially zeroed
    uint64_t bytes;  // number of bytes written
} FrameFile;

// Encodes and writes the image to a file without a name. PNG and EXR files get `texts`, the number
// of the frame and the scene; NULL: none of them. `extra`: NULL for a sheet. RESULT_FAILED with
// path and reason; then only frame_file_discard may follow.
Result frame_file_write(FrameFile *file, const Image *image, ImageTexts *texts,
                        const FrameExtra *extra, Error *error);

// Gives the file its name, and adds `scene` (empty: none) to the record if the file can't hold it.
// RESULT_FAILED with path and reason.
Result frame_file_commit(FrameFile *file, const char *scene, Error *error);

// Removes a file that has no name yet. May be called at any time.
void frame_file_discard(FrameFile *file);
