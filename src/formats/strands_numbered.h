// SPDX-License-Identifier: MIT
// Numbered hair files, x_%04d.tfx, as the frames of an animation.
#pragma once

#include "formats/strands_read.h"

// Like strands_read_frames. A path with %d or %04d that is no file stands for numbered files, which
// may begin at any number; the unit and the axis of the first one hold for all. `frames`: NULL to
// read the first frame only. RESULT_BAD_INPUT for a gap, or a file with other strands than the
// first one.
Result strands_read_any(Strands *strands, StrandsFrames *frames, const char *path,
                        const StrandsReadOptions *options, StrandsReport *report, Error *error);
