// SPDX-License-Identifier: MIT
// The light from everywhere on surfaces (needs lights.glsl).

// Linear RGB that a matt white surface at x with the unit normal n shows by the light from
// everywhere.
vec3 sky_reaching(vec3 x, vec3 n) { return draw_params.mesh_color.a * light_around(n, 1.0); }
