// SPDX-License-Identifier: MIT
// Numbers as text that reads back exactly.
#pragma once

#include <stddef.h>
#include <stdio.h>

// Writes `before` and the shortest of %.6g .. %.9g that reads back as `value`, with a decimal
// point.
void decimal_put(FILE *stream, const char *before, float value);

// Writes the shortest decimal number that reads back as `value` (finite), cut at `size`; 16
// suffice.
void decimal_format(float value, char *text, size_t size);

// The same for a double; 32 suffice.
void decimal_format_double(double value, char *text, size_t size);

// Reads a decimal number, possibly with blanks around it. Returns the rest of the text, or NULL.
// strtod alone would also accept hexadecimal numbers, infinity and NaN.
const char *decimal_read(const char *text, double *number);
