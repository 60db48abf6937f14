// SPDX-License-Identifier: MIT
// Joins mesh, floor and background. Each of a pixel's samples of the mesh lies in front of the
// floor or behind it; both lie over the background.
//   MESH 1: there may be mesh in the pixel   EDGE_SAMPLES: samples of its depth
//   FLOOR: see floor_light.glsl; 0: no floor
//   BACKDROP: samples of a pixel's side if the environment is the background; 0: it is even
#include "draw/draw.h"
#include "draw/ray.glsl"
#include "kernel/edge.h"
#if FLOOR
#define MESH_TAPS 6 // as soft as the shadows of hair, whose maps are coarser
#include "draw/lights.glsl"
#include "draw/shadow_surface.glsl"
#include "draw/floor_light.glsl"
#endif

#if MESH
layout(binding = BIND_MIDDLE_DEPTH) uniform sampler2D middle_depth;
layout(binding = BIND_LIT) uniform sampler2D lit;
layout(binding = BIND_EDGE_DEPTH) uniform sampler2DMS edge_depth;
#endif
#if BACKDROP
layout(binding = BIND_BACKDROP) uniform samplerBuffer backdrop;
#endif
layout(location = 0) out vec4 base; // linear, premultiplied
// Of the pixel's rim (kernel/edge.h): rgb: its light times its share; a: its share
layout(location = 1) out vec4 rim;
layout(location = 2) out float rim_depth;

// The depth that hides hair, and the floor's depth.
float depth = EDGE_NOWHERE, floor_depth = EDGE_NOWHERE;
vec4 front = vec4(0.0), behind = vec4(0.0); // sums of all samples on either side of the floor
vec4 rim_sum = vec4(0.0);
float rim_farthest = 0.0;

#if MESH
void add_sample(vec4 color, float z)
{
    bool nearer = z < floor_depth;
    front += nearer ? color : vec4(0.0);
    behind += nearer ? vec4(0.0) : color;
}

void add_samples(ivec2 at, vec4 background)
{
    float middle = texelFetch(middle_depth, at, 0).x;
    vec4 own = middle < EDGE_NOWHERE ? texelFetch(lit, at, 0) : background;
    float z[EDGE_SAMPLES], steep = edge_steep(middle, draw_params.depth.x, draw_params.focal);
    bool edge = false;
    float farthest = middle;
    for (int i = 0; i < EDGE_SAMPLES; ++i) {
        z[i] = texelFetch(edge_depth, at, i).x;
        farthest = max(farthest, z[i]);
        edge = edge || edge_parts(z[i], middle, steep);
    }
    depth = edge ? farthest : middle;
    bool rims[EDGE_SAMPLES];
    for (int i = 0; i < EDGE_SAMPLES; ++i)
        rims[i] = edge && z[i] < floor_depth &&
                  edge_rims(z[i], depth, edge_steep(z[i], draw_params.depth.x, draw_params.focal));
    vec4 color[EDGE_SAMPLES];
    float off[EDGE_SAMPLES];
    for (int i = 0; i < EDGE_SAMPLES; ++i) {
        color[i] = z[i] < EDGE_NOWHERE ? own : background;
        off[i] = edge_off(z[i], middle);
    }
    int neighbours = edge ? 9 : 0; // a loop without turns costs nothing (see shadow_surface.glsl)
    for (int n = 0; n < neighbours; ++n) {
        ivec2 last = ivec2(draw_params.width, draw_params.height) - 1,
              there = clamp(at + ivec2(n % 3, n / 3) - 1, ivec2(0), last);
        float other = texelFetch(middle_depth, there, 0).x;
        vec4 shown = texelFetch(lit, there, 0);
        for (int i = 0; i < EDGE_SAMPLES; ++i) {
            bool better = other < EDGE_NOWHERE && abs(z[i] - other) < off[i];
            color[i] = better ? shown : color[i];
            off[i] = better ? abs(z[i] - other) : off[i];
        }
    }
    for (int i = 0; i < EDGE_SAMPLES; ++i) {
        vec4 light = color[i] / float(EDGE_SAMPLES);
        add_sample(light, z[i]);
        rim_sum += rims[i] ? vec4(light.rgb, 1.0 / float(EDGE_SAMPLES)) : vec4(0.0);
        rim_farthest = rims[i] ? max(z[i], rim_farthest) : rim_farthest;
    }
}
#endif

vec4 find_background()
{
#if BACKDROP
    ivec2 at = ivec2(gl_FragCoord.xy) / BACKDROP;
    return texelFetch(backdrop, at.y * (int(draw_params.width) / BACKDROP) + at.x);
#else
    return draw_params.background;
#endif
}

void main()
{
#if FLOOR
    vec3 way = ray_through(gl_FragCoord.xy);
    float along = (floor_middle.y - draw_params.eye.y) / way.y;
    vec3 x = draw_params.eye.xyz + along * way;
    float off = length(x.xz - floor_middle.xz),
          there = along > 0.0 ? floor_there(off, floor_reach.x, floor_reach.y) : 0.0;
    floor_depth =
        there > 0.0 ? edge_depth_at(draw_params.depth.x, draw_params.depth.y, along) : EDGE_NOWHERE;
#endif
#if MESH
    add_samples(ivec2(gl_FragCoord.xy), find_background());
#else
    behind = find_background();
#endif
    base = front + behind;
#if FLOOR
    vec4 shown = floor_shown(x, there);
#if FLOOR == 1
    bool hides = along > 0.0 && off < floor_hides(floor_reach.x, floor_reach.y);
    depth = min(depth, hides ? max(floor_depth, 0.0) : EDGE_NOWHERE);
#endif
    base = front + (1.0 - front.a) * shown + (1.0 - shown.a) * behind;
#endif
    rim = rim_sum;
    rim_depth = rim_farthest;
    gl_FragDepth = depth;
}
