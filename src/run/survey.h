// SPDX-License-Identifier: MIT
// Simulates all frames before any is drawn: to fit the camera to them, and to report how well a
// loop closes.
#pragma once

#include "gpu/gpu.h"
#include "scene/assets.h"
#include "scene/outline.h"

// How far points of hair and mesh move from one frame to another, m.
typedef struct SurveyMove {
    float most, rms;
} SurveyMove;

typedef struct SurveyReport {
    int frames;      // number of frames of the scene
    double ms;       // time taken
    SurveyMove step; // the largest `most` and the largest `rms` from one frame to the next
    SurveyMove seam; // from the last frame to the first
} SurveyReport;

// Whether the scene needs a survey: it has --framing, or a turntable with an automatic camera.
bool survey_is_wanted(const Scene *scene);

// Simulates all frames 0 .. run.frames - 1 separately (or reads run.from_cache) without writing
// anything. Moves the camera of `framing`, which outline_frame has filled in, to fit everything
// that is drawn (fit_solve): hair, with followers and radii, and the mesh, unless run.framing is
// hair only. Assumes straight segments; curves of --smooth may reach slightly beyond.
// Shows its progress on `terminal`, unless it is NULL.
// RESULT_INTERRUPTED between two frames; other errors as simulation_create and frame_source_look.
Result survey_fit_camera(Framing *framing, SurveyReport *report, const Scene *scene,
                         const Assets *assets, const Gpu *gpu, FILE *terminal, Error *error);
