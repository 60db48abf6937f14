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
    int frames;      // all of the scene
    double ms;       // that it took
    SurveyMove step; // the largest `most` and the largest `rms` from one frame to the next
    SurveyMove seam; // from the last frame to the first
} SurveyReport;

// Whether the scene asks for it: --framing, or a turntable whose camera is left to the program.
bool survey_is_wanted(const Scene *scene);

// Goes through all frames 0 .. run.frames - 1 with a simulation of its own (or run.from_cache),
// writing nothing, and moves the camera of `framing`, which outline_frame has filled in, to fit
// what is drawn there (fit_solve): hair, with its followers and radii, and the mesh, unless
// run.framing says hair only. Straight between particles; --smooth may bulge beyond.
// RESULT_INTERRUPTED between two frames; other errors as simulation_create and frame_source_look.
Result survey_fit_camera(Framing *framing, SurveyReport *report, const Scene *scene,
                         const Assets *assets, const Gpu *gpu, Error *error);
