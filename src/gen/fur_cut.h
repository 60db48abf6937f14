// SPDX-License-Identifier: MIT
// A strand's vertices along its way: equal segments, outside the surface.
#pragma once

#include "gen/fur_weave.h"

// Walks along the curve with steps of `length` / (count - 1), as with dividers, so that the
// vertices' polyline has that length within rounding. A step that would end nearer to the surface
// than `gap` (m), or whose middle would be inside, is turned away from it; then the strand comes
// back to its curve. The first vertex is the curve's beginning. Returns how many steps no turning
// brought outside.
uint32_t fur_cut(const FurWeave *weave, const Surface *surface, const SurfacePoint *root,
                 double gap, double length, Double3 *vertex, uint32_t count);
