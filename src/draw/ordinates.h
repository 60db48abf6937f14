// SPDX-License-Identifier: MIT
// The directions in which the light grid follows light (discrete ordinates), and the classes of
// tangents by which it sorts fibres.
#pragma once

#include <stdint.h>

// ORDINATE_LANES of each group have the same main axis and sign, so that they sweep the grid side
// by side: groups -x, +x, -y, +y, -z, +z.
enum { ORDINATES = 48, ORDINATE_LANES = 8, ORDINATE_GROUPS = ORDINATES / ORDINATE_LANES };

// Unit vectors, the way that light goes: 48 charges that repel each other on a sphere, turned so
// that eight have each main axis (neighbours are 29.7 to 30.1 degrees apart). [axis][ordinate].
extern const float ORDINATE[3][ORDINATES];

// The ordinate that the first light gets: downwards, as most key lights shine.
enum { ORDINATE_OF_LIGHT = 21 };

// Classes of tangents: points of a Fibonacci spiral over the whole sphere, for fibres' scales tell
// the root's end from the tip's.
enum { TANGENTS = 256 };

// Unit vector of each class, and the sine of its angle with each ordinate. These tables are there
// after ordinates_prepare.
extern float TANGENT[TANGENTS][3];
extern float TANGENT_SINE[TANGENTS][ORDINATES];

// The class of each square of the faces -x, +x, -y ... of a cube around the origin: [face][row
// along the axis two on][column along the next].
enum { ORDINATE_SQUARES = 48 };
extern uint8_t TANGENT_NEAREST[6][ORDINATE_SQUARES][ORDINATE_SQUARES];

// The nearest class of a unit vector, but for what lies within 2 degrees of another one's region.
// Needs ordinates_prepare.
int ordinates_class(const float tangent[3]);
void ordinates_prepare(void);
