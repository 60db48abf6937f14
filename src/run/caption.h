// SPDX-License-Identifier: MIT
// A line of text in the lower left corner of an image: frame, time, file, solver.
#pragma once

#include "image/image.h"
#include "scene/scene.h"

enum { CAPTION_BYTES = 240 };

// Whether `words` is empty or a comma-separated list of a caption's parts: frame, time, file,
// solver. RESULT_USAGE names the first other word.
Result caption_check(const char *words, Error *error);

// The caption of frame `frame` by run.caption (which caption_check has accepted): ASCII, truncated
// to CAPTION_BYTES. Empty if there is none.
void caption_write(char text[CAPTION_BYTES], const Scene *scene, int frame);

// Draws ASCII text, white with a black edge, a twentieth of the image high, or 12 pixels in small
// images; text that does not fit is cut off. For images of 8 or 16 bits.
void caption_draw(Image *image, const char *text);
