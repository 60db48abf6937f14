// SPDX-License-Identifier: MIT
// Scratch memory of a lane: vec4s for each particle, `places` a particle (recipe.scratch). It does
// not belong to the strand: a lane that goes from strand to strand (STRANDS) uses the same memory
// again, which then stays in the cache. On a CPU driver, fetches through a buffer texture cost a
// third of fetches from a buffer (docs/notes/solvers.md). Needs hair_address.glsl, lane.glsl.
layout(std430, binding = BIND_SCRATCH) buffer Scratch { vec4 scratch[]; };
#if ORDERED
#define scratch_at(address) scratch[address]
#else
layout(binding = BIND_SCRATCH_BEFORE) uniform samplerBuffer scratch_texels;
#define scratch_at(address) texelFetch(scratch_texels, address)
#endif

// The address of a lane's first vec4, with `vertices` particles.
int scratch_base(int places, int vertices)
{
    return particle_address(lane_index(), 0, places * vertices);
}
