// SPDX-License-Identifier: MIT
// Colours, thickness and opacity by particle, beside hair on the GPU.
#pragma once

#include "sim/hair.h"
#include "strands/paint.h"

// Gives every batch the paint of its strands, which `paint` has for all of the file's. Nothing for
// a paint that is zeroed. RESULT_FAILED if memory is short.
Result hair_paint_upload(Hair *hair, const Strands *strands, const Paint *paint,
                         const GpuLimits *limits, Error *error);
