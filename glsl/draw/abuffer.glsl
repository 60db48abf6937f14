// SPDX-License-Identifier: MIT
// The A-buffer: every fragment of a pixel in a linked list (Yang et al. 2010).
//
// A node is: number of the next node + 1 or 0, depth, colour. The depth is 1/w as float bits, which
// as an int grows towards the eye. The colour is linear RGB times alpha and alpha, as four halves.
//
// Atomics order a list differently in every run. So readers sort by (depth, colour). Two nodes that
// are equal in both can be exchanged, so the picture depends only on which nodes there are.

ivec3 abuffer_pack(float inverse_w, vec3 color, float alpha)
{
    vec4 premultiplied = vec4(color * alpha, alpha);
    return ivec3(floatBitsToInt(inverse_w), packHalf2x16(premultiplied.rg),
                 packHalf2x16(premultiplied.ba));
}

vec4 abuffer_color(ivec3 node)
{
    return vec4(unpackHalf2x16(uint(node.y)), unpackHalf2x16(uint(node.z)));
}

bool abuffer_nearer(ivec3 a, ivec3 b)
{
    return a.x > b.x || (a.x == b.x && (a.y > b.y || (a.y == b.y && a.z > b.z)));
}
