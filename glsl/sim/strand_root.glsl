// SPDX-License-Identifier: MIT
// With LEAD 1 the head carries vertex 1 of a strand too, and that is the root that a solver sees
// (needs `rest`, shared.h).

// The root at address `base`, in the head's frame, and the strand's length from there: as `rest`
// has them for vertex 0.
vec4 strand_root(int base)
{
    vec4 root = texelFetch(rest, base - LEAD * STRAND_TILE);
#if LEAD
    vec4 segment = texelFetch(rest, base);
    root += segment.w * vec4(segment.xyz, -1.0);
#endif
    return root;
}
