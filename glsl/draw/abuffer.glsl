// SPDX-License-Identifier: MIT
// The A-buffer: a linked list of all fragments for each pixel (Yang et al. 2010).
//
// A node has the number of the next node + 1 (0 at the end), the depth and the colour. The depth is
// 1/w as float bits, which as an integer grows towards the eye. The colour is linear RGB times
// alpha, and alpha, as four halves.
//
// Atomic operations order a list differently in every run, so readers sort by (depth, colour).
// Nodes that are equal in both are interchangeable, so the picture depends only on the set of
// nodes.

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
