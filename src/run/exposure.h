// SPDX-License-Identifier: MIT
// --exposure auto.
#pragma once

#include "gpu/gpu.h"
#include "image/image.h"
#include "scene/assets.h"
#include "scene/outline.h"

// Whether the run must find the exposure of such images; linear light and AOVs have no exposure.
bool exposure_is_wanted(const RunParams *run, ImageKind kind);

// Finds one exposure (EV) for all frames by metering hair and mesh (meter.h), at rest with the head
// as at time 0, under the lights and with the camera of frame 0, in a small image. Thus it depends
// on the scene alone, and not on which frames are drawn or where they come from. `framing`: final.
// Errors of simulation_create and of drawing.
Result exposure_find(float *exposure, const Scene *scene, const Assets *assets,
                     const Framing *framing, const Gpu *gpu, Error *error);
