// SPDX-License-Identifier: MIT
// The head also carries the first LEAD vertices after a strand's first one; the last of them is the
// solver's root (needs `rest`, shared.h).

// The root at address `base` in the head's frame, and the strand's length from there, in the form
// that `rest` has for vertex 0.
vec4 strand_root(int base)
{
    vec4 root = texelFetch(rest, base - LEAD * STRAND_TILE);
    for (int i = LEAD - 1; i >= 0; --i) {
        vec4 segment = texelFetch(rest, base - i * STRAND_TILE);
        root += segment.w * vec4(segment.xyz, -1.0);
    }
    return root;
}
