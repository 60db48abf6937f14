// SPDX-License-Identifier: MIT
// Writes the properties of the mesh's nearest surface with which each pixel is lit later, once.

in vec3 world_normal;
in vec4 own_tint;
// xyz: normal times the share of the sky; w: distance to the eye's plane, m
layout(location = 0) out vec4 surface;
// rgb: factors of the mesh's colour; a: the share of the sky past the mesh alone
layout(location = 1) out vec4 tint;

void main()
{
    surface = vec4(world_normal, 1.0 / gl_FragCoord.w);
    tint = own_tint;
}
