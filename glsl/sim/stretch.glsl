// SPDX-License-Identifier: MIT
// Strands with links that stretch, for solvers of particles (needs particles.glsl). They are drawn
// with their rest lengths along the links' actual directions. The fourth component of a particle's
// velocity stores the stretch of the link before it, |r|/l - 1.

// A link before the step, reconstructed from its drawn form.
vec3 link_before(vec3 drawn_from, vec3 drawn_to, float l, float stretch)
{
    vec3 r = drawn_to - drawn_from;
    return r * (l * (1.0 + stretch) * inversesqrt(max(dot(r, r), 1e-36)));
}

// Appends the link r to the drawn strand, whose end and last direction are `drawn` and `along`, and
// stores the velocity v and the stretch. `a` is the address of the particle at its end; `drawn` is
// relative to the root. A link without length continues in the last direction. `stretched` draws
// the actual length.
void draw_link(int a, Root root, vec3 r, float l, vec3 v, bool stretched, inout vec3 drawn,
               inout vec3 along)
{
    float rr = dot(r, r), inverse = inversesqrt(max(rr, 1e-36));
    along = rr > 1e-36 ? r * inverse : along;
    drawn += along * (stretched ? rr * inverse : l);
    positions[a] = relative_store(drawn, root);
    velocities[a] = vec4(v, rr * inverse / l - 1.0);
}
