// SPDX-License-Identifier: MIT
// Exact distances near the surface: a work item is a triangle and a block of grid points near it.
// Two passes: the least squared distance of each point (bits of floats that are not negative sort
// as numbers do), then the first triangle that has it. The same code computes the distance in both,
// so that it is the same to the bit.
#include "field/field.glsl"
#include "field/closest.glsl"

// Triangle, first point of the block.
layout(std430, binding = 0) readonly buffer Items { uvec4 items[]; };
layout(std430, binding = 1) buffer Squares { uint squares[]; };
layout(std430, binding = 2) buffer Nearest { uint nearest[]; };

void main()
{
    uint i = item();
    if (i >= field_params.count) return;
    uvec4 work = items[i];
    vec3 a = corner(work.x, 0), b = corner(work.x, 1), c = corner(work.x, 2);
    ivec3 first = ivec3(work.yzw), size = grid_size();
    bool second = field_params.phase == 1u;
    float spacing = field_params.low.w;
    for (int k = 0; k < FIELD_BLOCK * FIELD_BLOCK * FIELD_BLOCK; ++k) {
        ivec3 at = first + ivec3(k % FIELD_BLOCK, k / FIELD_BLOCK % FIELD_BLOCK,
                                 k / (FIELD_BLOCK * FIELD_BLOCK));
        if (any(greaterThanEqual(at, size))) continue;
        vec3 p = spacing * vec3(at), to = closest_on_triangle(p, a, b, c) - p;
        uint bits = floatBitsToUint(dot(to, to));
        int address = grid_address(at);
        if (!second)
            atomicMin(squares[address], bits);
        else if (squares[address] == bits)
            atomicMin(nearest[address], work.x);
    }
}
