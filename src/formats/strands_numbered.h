// SPDX-License-Identifier: MIT
// Numbered hair files, x_%04d.tfx, as the frames of an animation.
#pragma once

#include "formats/strands_read.h"

// Whether the path is a pattern: it has %d or %04d, and no file has this name.
bool strands_is_numbered(const char *path);

// Like strands_read_frames for the files of a pattern, which may begin at any number. The unit and
// the axis of the first file hold for all. `frames`: NULL to read the first file only.
// RESULT_BAD_INPUT for a gap, or a file with other strands than the first.
Result strands_read_numbered(Strands *strands, StrandsFrames *frames, const char *path,
                             const StrandsReadOptions *options, StrandsReport *report,
                             Error *error);
