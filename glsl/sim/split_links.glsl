// SPDX-License-Identifier: MIT
// The links of a lane's strands, and pulls along them (needs tractrix.glsl, hair_address.glsl).
// IN_REGISTERS 1: the strand has VERTICES vertices and stays in registers for the whole step; loops
// are unrolled. 0: any length, in memory.
// segments_before reads the buffer as it is at the step's start.
layout(std430, binding = BIND_STATE_OUT) buffer Segments { vec4 segments[]; };
#if ORDERED // see particles.glsl
#define segments_before(address) segments[address]
#else
layout(binding = BIND_STATE) uniform samplerBuffer segment_texels;
#define segments_before(address) texelFetch(segment_texels, address)
#endif

const float SAFE_MOVE = 1e15; // m; keeps squares finite whatever the head does

#if IN_REGISTERS
const int LINKS = VERTICES - 1;
vec4 links[STRANDS][LINKS]; // link 0 is the first to be pulled: direction head -> tail, length
#else
#define LINKS int(step_params.vertex_count - 1u)
#endif

// Fetches the links of strand k, whose root is at `address`. Returns the vector from the root to
// its end.
vec3 open_links(int k, int address)
{
    vec3 span = vec3(0.0);
    for (int i = 0; i < LINKS; ++i) {
        vec4 segment = segments_before(address + (LINKS - i) * STRAND_TILE);
        span += segment.w * segment.xyz;
#if IN_REGISTERS
        links[k][i] = vec4(-segment.xyz, segment.w);
#endif
    }
    return span;
}

// Pulls one end of each strand by `move`, which becomes the displacement of the other end. The next
// pull starts from that end; reversing the order and negating the directions lets both use the same
// loop.
void pull_links(int address[STRANDS], inout vec3 move[STRANDS], bool from_tip)
{
    for (int k = 0; k < STRANDS; ++k) move[k] = clamp(move[k], -SAFE_MOVE, SAFE_MOVE);
#if IN_REGISTERS
    vec4 turned[STRANDS][LINKS];
    for (int i = 0; i < LINKS; ++i)
        for (int k = 0; k < STRANDS; ++k) {
            vec4 link = links[k][i];
            turned[k][LINKS - 1 - i] = vec4(-tractrix_turn(link.xyz, link.w, move[k]), link.w);
        }
    links = turned;
#else
    for (int i = 0; i < LINKS; ++i)
        for (int k = 0; k < STRANDS; ++k) {
            int a = address[k] + (from_tip ? LINKS - i : 1 + i) * STRAND_TILE;
            vec4 segment = segments[a];
            vec3 d = tractrix_turn(from_tip ? -segment.xyz : segment.xyz, segment.w, move[k]);
            segments[a] = vec4(from_tip ? -d : d, segment.w);
        }
#endif
}

// Stores the links of strand k with unit directions, after an even number of pulls.
void close_links(int k, int address)
{
    for (int i = 0; i < LINKS; ++i) {
        int a = address + (LINKS - i) * STRAND_TILE;
#if IN_REGISTERS
        vec4 segment = vec4(-links[k][i].xyz, links[k][i].w);
#else
        vec4 segment = segments[a];
#endif
        segments[a] = vec4(tractrix_renormalise(segment.xyz), segment.w);
    }
}
