// SPDX-License-Identifier: MIT
// The directions of the light grid (discrete ordinates), and the classes into which it sorts the
// tangents of fibres.
#pragma once

#include <stdint.h>

// The ORDINATE_LANES directions of a group have the same main axis and sign, so that they sweep the
// grid together. The groups are -x, +x, -y, +y, -z, +z.
enum { ORDINATES = 48, ORDINATE_LANES = 8, ORDINATE_GROUPS = ORDINATES / ORDINATE_LANES };

// Unit vectors in which light travels, [axis][ordinate]. They are the places of 48 charges that
// repel each other on a sphere, turned so that eight have each main axis. Neighbours are 29.7 to
// 30.1 degrees apart.
extern const float ORDINATE[3][ORDINATES];

// The lattice is turned so that the first light travels along this ordinate. It points downwards,
// as most key lights shine.
enum { ORDINATE_OF_LIGHT = 21 };

// The number of classes of tangents. They are points of a Fibonacci spiral over the whole sphere,
// because a fibre's scales make its two directions differ.
enum { TANGENTS = 256 };

// The unit vector of each class, and the sine of its angle with each ordinate. Filled in by
// ordinates_prepare.
extern float TANGENT[TANGENTS][3];
extern float TANGENT_SINE[TANGENTS][ORDINATES];

// The class of each square on the faces of a cube around the origin: [face -x, +x, -y ...][row,
// along the axis two further][column, along the next axis].
enum { ORDINATE_SQUARES = 48 };
extern uint8_t TANGENT_NEAREST[6][ORDINATE_SQUARES][ORDINATE_SQUARES];

// The class that is nearest to a unit vector. Within 2 degrees of another class's region it may be
// that class. Call ordinates_prepare first.
int ordinates_class(const float tangent[3]);
void ordinates_prepare(void);
