// SPDX-License-Identifier: MIT
// Colour, thickness and opacity of each particle (paint) on the GPU.
#pragma once

#include "sim/hair.h"
#include "strands/paint.h"

// Uploads the paint of each batch. `paint` contains that of all the file's strands; a zeroed paint
// uploads nothing. RESULT_FAILED if memory is short.
Result hair_paint_upload(Hair *hair, const Strands *strands, const Paint *paint,
                         const GpuLimits *limits, Error *error);
