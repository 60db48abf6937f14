// SPDX-License-Identifier: MIT
// The files that a run's images go to.
#pragma once

#include "run/images.h"
#include "run/output.h"

// What images the scene's output takes. RESULT_USAGE for no name of an output.
Result images_output_form(ImagesForm *form, const RunParams *run, Error *error);

// The output that the scene asks for, for `frame_count` frames of these images. Errors of
// output_create.
Result images_output_create(Output **output, const Images *images, const Fingerprint *fingerprint,
                            int frame_count, Error *error);

// The matrices of a view, as EXR files have them: world to camera, and to the image, whose corners
// are (0, 0), at the top left, and (1, 1).
void images_output_matrices(FrameExtra *extra, const View *view);
