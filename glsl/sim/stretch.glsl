// SPDX-License-Identifier: MIT
// Strands whose links stretch, in solvers of particles (needs particles.glsl). They are drawn in
// their own lengths along the directions that the links really have; `w` of a particle's velocity
// keeps the stretch of the link before it, |r|/l - 1.

// A link before the step, from what was drawn.
vec3 link_before(vec3 drawn_from, vec3 drawn_to, float l, float stretch)
{
    vec3 r = drawn_to - drawn_from;
    return r * (l * (1.0 + stretch) * inversesqrt(max(dot(r, r), 1e-36)));
}

// Draws the link r behind what is drawn so far, whose end and last direction are in `drawn` and
// `along`, and keeps the velocity v and the stretch; a: address of the particle at its end. A link
// without length goes on straight. `stretched`: as long as it is.
void draw_link(int a, vec3 r, float l, vec3 v, bool stretched, inout vec3 drawn, inout vec3 along)
{
    float rr = dot(r, r), inverse = inversesqrt(max(rr, 1e-36));
    along = rr > 1e-36 ? r * inverse : along;
    drawn += along * (stretched ? rr * inverse : l);
    positions[a] = vec4(drawn, 1.0);
    velocities[a] = vec4(v, rr * inverse / l - 1.0);
}
