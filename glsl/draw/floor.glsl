// SPDX-License-Identifier: MIT
// Where the floor is (m).
layout(location = 0) uniform vec3 floor_middle;
// Of the whole floor, of the last of it, of the disc that is drawn.
layout(location = 1) uniform vec3 floor_reach;
