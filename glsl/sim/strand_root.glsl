// SPDX-License-Identifier: MIT
// With LEAD 1 the head also carries vertex 1 of a strand, which is then the solver's root (needs
// `rest`, shared.h).

// The root at address `base` in the head's frame, and the strand's length from there, in the form
// that `rest` has for vertex 0.
vec4 strand_root(int base)
{
    vec4 root = texelFetch(rest, base - LEAD * STRAND_TILE);
#if LEAD
    vec4 segment = texelFetch(rest, base);
    root += segment.w * vec4(segment.xyz, -1.0);
#endif
    return root;
}
