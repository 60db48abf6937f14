// SPDX-License-Identifier: MIT
// Hair for tests of the library, and helpers for calls that must succeed or fail.
#pragma once

#include "library/tractrix.h"

enum { FIXTURE_STRANDS = 5, FIXTURE_VERTICES = 2 + 5 + 3 + 5 + 4, FIXTURE_PIXELS = 48 * 32 };

// The last message.
extern TractrixError library_error;

// Fails the test with the message if a call fails.
#define WELL(call)                                                                                 \
    do {                                                                                           \
        if ((call) != TRACTRIX_OK) fail_msg("%s", library_error.text);                             \
    } while (0)

// Fails unless a call's result is `expected` and its message is a single line that contains `part`.
void library_refused(TractrixResult result, TractrixResult expected, const char *part);

// Strands of 2, 5, 3, 5 and 4 vertices that hang from a plane, 2 cm apart, roots first.
extern const uint32_t library_sizes[FIXTURE_STRANDS];
void library_positions(float position[FIXTURE_VERTICES][3]);

// These strands in a scene with the plain look and these parameters: name, text, ..., NULL.
TractrixScene *library_scene(const char *const *parameters);

// A sheet of 4 vertices and 2 triangles on this plane. `deforms`: whether it is a deforming mesh.
extern const float library_sheet[4][3];
void library_set_sheet(TractrixScene *scene, bool deforms);

// Draws a picture of 48 x 32 px.
void library_draw(TractrixSimulation *simulation, const TractrixView *view,
                  uint8_t pixels[FIXTURE_PIXELS][4]);
