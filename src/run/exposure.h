// SPDX-License-Identifier: MIT
// --exposure auto.
#pragma once

#include "gpu/gpu.h"
#include "image/image.h"
#include "scene/assets.h"
#include "scene/outline.h"

// Whether the run leaves the exposure of such images open: light itself and AOVs have none.
bool exposure_is_wanted(const RunParams *run, ImageKind kind);

// Finds the exposure (EV) of all frames: what an exposure meter says of hair and mesh (meter.h), at
// rest with the head as at time 0, under the lights and before the camera of frame 0, drawn small.
// So it depends on the scene alone, not on which frames are drawn or where they come from.
// `framing`: final. Errors of simulation_create and of drawing.
Result exposure_find(float *exposure, const Scene *scene, const Assets *assets,
                     const Framing *framing, const Gpu *gpu, Error *error);
