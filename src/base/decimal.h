// SPDX-License-Identifier: MIT
// Numbers as text that reads back exactly.
#pragma once

#include <stdio.h>

// Writes `before` and the shortest of %.6g .. %.9g that reads back as `value`, with a point
// whatever the locale.
void decimal_put(FILE *stream, const char *before, float value);
