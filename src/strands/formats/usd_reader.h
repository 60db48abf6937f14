// SPDX-License-Identifier: MIT
// Reads `.usda`: all BasisCurves prims of type linear, by their points' value or first time sample.
#pragma once

#include "strands/formats/strands_source.h"

// Whether the content begins as such a file, with "#usda".
bool usd_reader_matches(const Bytes *bytes);

// Reads everything that usd_file.h writes, and such curves from other programs. Layers, prims and
// properties of other kinds are passed over. `source->unit` and `up_z` are set. Attributes have one
// value, or one for each strand or vertex, which their number tells; of several prims those are
// kept that all have. Fails at a transform of curves or above them, at cubic or periodic curves and
// at indexed primvars, since passing over these would give other hair.
Result usd_reader_read(StrandsSource *source, Reader *reader);
