// SPDX-License-Identifier: MIT
// Light on the mesh, for base_draw.c.
#pragma once

#include "lanes/base.h"

// Lights the surface of `base` where it shows the mesh, into base->lit.
void base_mesh_light(const LaneBase *base, const LaneBaseScene *scene, int parts);
