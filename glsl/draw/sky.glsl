// SPDX-License-Identifier: MIT
// The light from everywhere on surfaces (needs lights.glsl).

// Linear RGB that a matt white surface with the unit normal n shows by the light from everywhere.
vec3 sky_reaching(vec3 n) { return draw_params.mesh_color.a * light_around(n, 1.0); }

// The same of a surface of this colour that sees the share `open` of the sky, the rest of it being
// of about the same colour and as bright: what it reflects comes in, too.
vec3 sky_reaching_into(vec3 n, float open, vec3 base)
{
    return sky_reaching(n) * open / (1.0 - base * (1.0 - open));
}
