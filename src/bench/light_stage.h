// SPDX-License-Identifier: MIT
// Draws a scene like the first frame of tractrix-render, but as linear light.
#pragma once

#include "run/images.h"

// light_stage_create fills some members; the others are zeroed.
typedef struct LightStage {
    char *words; // words of the flags
    Scene scene;
    Assets assets;
    Framing framing;
    GpuTimer timer;
    Simulation simulation;
    Images images;
    View view;
    Image image; // IMAGE_FLOAT: the drawn image, at exposure 0 without tone curve
} LightStage;

// Reads a scene file, or hair, with flags of tractrix-render: three texts of words separated by
// blanks. Errors of all parts of a run; may be destroyed in either case.
Result light_stage_create(LightStage *stage, const Gpu *gpu, const char *file,
                          const char *const flags[3], Error *error);
void light_stage_destroy(LightStage *stage);

// Draws into stage->image and waits for it. `moved`: as if the hair had moved, so that nothing of
// the previous image is reused. RESULT_INTERRUPTED after an interrupt.
Result light_stage_draw(LightStage *stage, bool moved, Error *error);
