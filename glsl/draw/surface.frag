// SPDX-License-Identifier: MIT
// Writes the properties of the mesh's nearest surface with which each pixel is lit later, once.

in vec3 world_normal;
// xyz: normal times the share of the sky; w: distance to the eye's plane, m
layout(location = 0) out vec4 surface;

void main() { surface = vec4(world_normal, 1.0 / gl_FragCoord.w); }
