// SPDX-License-Identifier: MIT
// The inputs of a solver of particles (recipe.h): the positions and velocities of the step before,
// which the solver overwrites, the style, and the root's position on the head.
//
// Macros: GROUP_SIZE: lanes per group. STRANDS: strands per lane, GROUP_SIZE apart. IN_REGISTERS
// and VERTICES: the strand has VERTICES vertices and may be stored in arrays, whose loops are
// unrolled; otherwise strands have any length, step_params.vertex_count. LEAD: vertices before the
// solver's root, which the head carries.
#include "sim/step_params.h"
#include "common/hair_address.glsl"
#include "common/rigid.glsl"
#include "sim/frame.glsl"
#include "sim/forces.glsl"
#include "sim/relative.glsl"

layout(local_size_x = GROUP_SIZE) in;
#include "common/lane.glsl"
layout(binding = BIND_REST) uniform samplerBuffer rest; // the style: see hair.h
#include "sim/strand_root.glsl"
layout(std430, binding = BIND_POSITION_OUT) buffer Positions { vec4 positions[]; };
layout(std430, binding = BIND_STATE_OUT) buffer Velocities { vec4 velocities[]; };

// A particle at the step's start: xyz, m and m/s; positions as in relative.glsl. A lane fetches
// only particles of its own strand, and each of them before it stores to that particle. If loads
// and stores to the same memory keep their order, that is enough: ORDERED 1 reads the buffers
// themselves. CPU drivers read the same memory through textures; a GPU's compiler could move such
// reads behind a store.
#if ORDERED
#define position_before(address) positions[address]
#define velocity_before(address) velocities[address]
#else
layout(binding = BIND_POSITION) uniform samplerBuffer position_texels;
layout(binding = BIND_STATE) uniform samplerBuffer velocity_texels;
#define position_before(address) texelFetch(position_texels, address)
#define velocity_before(address) texelFetch(velocity_texels, address)
#endif

// The lane's first strand. Lanes beyond the last strand do nothing.
int first_strand() { return group_index() * GROUP_SIZE * STRANDS + int(gl_LocalInvocationID.x); }

// The head also carries vertices 1 to LEAD, the last of which is the solver's root: the solver sees
// vertices 0 .. vertex_count - 1 from strand_base on.
int strand_base(int strand)
{
#if IN_REGISTERS
    return particle_address(strand, LEAD, VERTICES + LEAD);
#else
    return particle_address(strand, LEAD, int(step_params.vertex_count) + LEAD);
#endif
}

// The next particle of the style, as carried by the head, relative to the root.
vec3 next_style(vec3 before, vec4 rest, vec4 rotation)
{
    return before + rest.w * rotate(rotation, rest.xyz);
}

// Writes the vertices before the solver's root.
void carry_lead(int base)
{
    vec3 x = LEAD > 0 ? texelFetch(rest, base - LEAD * STRAND_TILE).xyz : vec3(0.0);
    for (int i = LEAD; i > 0; --i) {
        positions[base - i * STRAND_TILE] = vec4(frame_root(x), 0.0);
        vec4 segment = texelFetch(rest, base - (i - 1) * STRAND_TILE);
        x += segment.w * segment.xyz;
    }
}
