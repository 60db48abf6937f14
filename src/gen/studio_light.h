// SPDX-License-Identifier: MIT
// The light of a photographer's studio, to be used as an environment: a dim grey room with a warm
// floor, a large soft box on the left in front, above the head, a weaker one on the right, and one
// behind on the right.
#pragma once

#include "base/error.h"

enum { STUDIO_LIGHT_HEIGHT = 32 }; // px; twice as wide

// Writes it as .pfm in steps of 1/1024, so that the bytes are equal on every machine. RESULT_FAILED
// with the reason.
Result studio_light_write(const char *path, Error *error);
