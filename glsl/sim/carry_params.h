// SPDX-License-Identifier: MIT
// What carry.comp is given, for one buffer of a solver's state.
#include "common/shared.h"

UNIFORM_BLOCK(CarryParams, carry_params, BIND_STEP)
{
    vec4 rotation;     // quaternion x y z w: R
    vec4 translation;  // xyz, m: T
    vec4 velocity;     // xyz, m/s, of the origin: V
    vec4 spin;         // xyz, rad/s: W
    uint count;        // elements
    uint stride;       // vec4s from one element to the next
    uint beside;       // vec4s from an element's place to its velocity's
    uint vertex_count; // of a strand: elements are particles, but for tips, one a strand
    uint directions;   // 1: elements are unit vectors, there are no points
}
END_BLOCK(CarryParams, carry_params);
