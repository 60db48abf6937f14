// SPDX-License-Identifier: MIT
// The output files of a run's images.
#pragma once

#include "run/images.h"
#include "run/output.h"

// The form of images for the scene's output. RESULT_USAGE if the output's name is invalid.
Result images_output_form(ImagesForm *form, const RunParams *run, Error *error);

// Checks the scene's output for `frame_count` frames before anything is opened. Errors of
// output_check.
Result images_output_check(const RunParams *run, int frame_count, Error *error);

// Opens the scene's output for `frame_count` frames of these images. Errors of output_create.
Result images_output_create(Output **output, const Images *images, const Fingerprint *fingerprint,
                            int frame_count, Error *error);

// The matrices of a view for EXR files: world to camera, and world to the image, whose corners are
// (0, 0) at the top left and (1, 1).
void images_output_matrices(FrameExtra *extra, const View *view);
