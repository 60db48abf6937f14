// SPDX-License-Identifier: MIT
// A line of text in the lower left corner of an image: frame, time, file, solver.
#pragma once

#include "image/image.h"
#include "scene/scene.h"

enum { CAPTION_BYTES = 240 };

// Whether `words` is empty or names, with commas between them, what a caption is made of: frame,
// time, file, solver. RESULT_USAGE with the first word that is something else.
Result caption_check(const char *words, Error *error);

// The caption of frame `frame`, as run.caption has it (which caption_check has found good): ASCII,
// cut at CAPTION_BYTES. Empty if there is none.
void caption_write(char text[CAPTION_BYTES], const Scene *scene, int frame);

// Draws ASCII text, white with a black edge, as high as a twentieth of the image or, in small
// ones, 12 pixels; what does not fit is cut off. Of 8 or 16 bits.
void caption_draw(Image *image, const char *text);
