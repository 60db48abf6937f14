// SPDX-License-Identifier: MIT
// A scene that is drawn here and now, as tractrix-render draws its first frame, but to linear
// light.
#pragma once

#include "run/images.h"

// Zeroed but for what light_stage_create fills.
typedef struct LightStage {
    char *words; // of the flags
    Scene scene;
    Assets assets;
    Framing framing;
    GpuTimer timer;
    Simulation simulation;
    Images images;
    View view;
    Image image; // IMAGE_FLOAT: what has been drawn, at exposure 0 and without a tone curve
} LightStage;

// Reads a scene file, or hair, with flags of tractrix-render: three texts of words with blanks
// between them. Errors of all that a run consists of; may be destroyed in either case.
Result light_stage_create(LightStage *stage, const Gpu *gpu, const char *file,
                          const char *const flags[3], Error *error);
void light_stage_destroy(LightStage *stage);

// Draws into stage->image and waits for it. `moved`: as if the hair had, so that nothing of the
// image before is used again. RESULT_INTERRUPTED if that was asked for.
Result light_stage_draw(LightStage *stage, bool moved, Error *error);
