// SPDX-License-Identifier: MIT
// What must be known of the mesh's nearest surface to light it later, once a pixel.

in vec3 world_normal;
layout(location = 0)
    out vec4 surface; // normal, as long as the share of the sky; distance before the eye's plane, m

void main() { surface = vec4(world_normal, 1.0 / gl_FragCoord.w); }
