// SPDX-License-Identifier: MIT
// Light that hair scatters onto skin. Each cell of the light grid has six values: the mean light
// that hair sends to a surface in this cell which faces along an axis of the lattice, -x, +x, -y,
// +y, -z, +z. The light on other surfaces is interpolated between three of them.
#include "common/shared_math.h"
#ifdef __STDC__
#pragma once
#endif

#define ONTO_FACES 6

// A point of skin looks up the light this far above its surface, in sides of a cell, so that few of
// the eight cells around it lie below the skin. Cells below the skin have no light and are left
// out. (With 0.5 the stepped walls of the cells block 4 to 8 % more of the light.)
#define ONTO_ABOVE 1.0f
// A cell whose light is less than this share of the brightest of the eight lies below the skin.
#define ONTO_LEAST 1e-6f

// The weight of a direction of light for a surface that faces the positive side of an axis.
// `cosine`: between the direction in which the light travels and the axis. The weights of all
// directions must then be scaled to the sum 1.
SHARED_FUNCTION float onto_weight(float cosine) { return SHARED_MAX(-cosine, 0.0f); }

// The face of an axis towards which a unit normal with this component points, and the share of this
// face in the light on the surface. The shares of the three axes add up to 1 (the ambient cube of
// J. McTaggart, "Half-Life 2 / Valve Source Shading", 2004).
SHARED_FUNCTION int onto_face(int axis, float component)
{
    return 2 * axis + (component < 0.0f ? 0 : 1);
}
SHARED_FUNCTION float onto_share(float component) { return component * component; }

// Outside the lattice the light falls off like that of a patch of hair whose radius is a quarter of
// the lattice's longest side. Both in m; `away2`: square of the distance to the lattice.
SHARED_FUNCTION float onto_away(float away2, float longest)
{
    float radius2 = longest * longest * (1.0f / 16.0f);
    return radius2 / (radius2 + away2);
}
