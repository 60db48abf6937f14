// SPDX-License-Identifier: MIT
// Decides whether another order of scattering is swept, and estimates the light of the orders that
// are not.
#include "draw/light.h"
#include "draw/light.glsl"

layout(local_size_x = 1) in;
layout(location = 0) uniform ivec2 sweep; // number of this sweep; number of the last possible one
layout(std430, binding = BIND_LIGHT_STATE_OUT) buffer State
{
    LightState state;
    vec4 met[];
};

vec3 met_by(int which)
{
    vec3 sum = vec3(0.0);
    for (int d = 0; d < LIGHT_ORDINATES; ++d) sum += met[which * LIGHT_ORDINATES + d].rgb;
    return sum;
}

void main()
{
    if (state.done != 0u) return;
    vec3 all = vec3(0.0), before = vec3(0.0), last = vec3(0.0);
    for (int k = 0; k <= sweep.x; ++k) {
        before = last;
        last = met_by(k);
        all += last;
    }
    bool more = false;
    vec3 further;
    for (int c = 0; c < 3; ++c) {
        float falling = cell_falling(before[c], last[c]);
        further[c] = cell_further(falling);
        more = more || cell_needs_more(all[c], last[c], falling);
    }
    state.more = vec4(sweep.y > 1 ? further : vec3(0.0), 0.0);
    state.done = sweep.x > 1 && !more ? 1u : 0u;
}
