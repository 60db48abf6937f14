// SPDX-License-Identifier: MIT
// A pixel's samples of the mesh, each in front of the floor or behind it, over the background.
//   MESH 1: there may be mesh in the pixel   EDGE_SAMPLES: samples of its depth
//   FLOOR: see floor_light.glsl; 0: none
//
// Only middles of pixels are lit. A sample at an edge, whose depth is not that of its pixel's
// middle, shows what the middle nearest to it in depth does among the nine around it.
//
// The depth left behind hides hair. Beside an edge that is the farthest of the pixel's samples:
// where background, or something farther, shows between them, hair that stands before that must
// hide it. (The nearest, or the middle's, would leave a fringe of background along a silhouette
// before hair.)
#include "draw/draw.h"
#include "draw/ray.glsl"
#if FLOOR
#define MESH_TAPS 6 // as soft as shadows of hair, whose maps are coarser
#include "draw/lights.glsl"
#include "draw/shadow_surface.glsl"
#include "draw/sky.glsl"
#include "draw/floor_light.glsl"
#endif

#if MESH
layout(binding = BIND_MIDDLE_DEPTH) uniform sampler2D middle_depth;
layout(binding = BIND_LIT) uniform sampler2D lit;
layout(binding = BIND_EDGE_DEPTH) uniform sampler2DMS edge_depth;
layout(location = 3) uniform ivec2 mesh_low; // that have been drawn
layout(location = 4) uniform ivec2 mesh_high;
#endif
layout(location = 0) out vec4 base; // linear, premultiplied

// px of depth that neighbouring samples of one surface may differ by before they are looked at
// closely
const float STEEP = 4.0;
const float NOWHERE = 1.0; // the depth of what is not there

float floor_depth = NOWHERE;
vec4 front = vec4(0.0), behind = vec4(0.0); // sums of all samples on either side of the floor

#if MESH
// What a step of one px away from the eye changes of the depth z = (1 + depth.x + depth.y / w) / 2.
float depth_step(float z)
{
    return 0.5 * abs(2.0 * z - 1.0 - draw_params.depth.x) / draw_params.focal;
}

void add_sample(vec4 color, float z)
{
    bool nearer = z < floor_depth;
    front += nearer ? color : vec4(0.0);
    behind += nearer ? vec4(0.0) : color;
}

void add_samples(ivec2 at, vec4 background)
{
    float middle = texelFetch(middle_depth, at, 0).x;
    vec4 own = middle < NOWHERE ? texelFetch(lit, at, 0) : background;
    float z[EDGE_SAMPLES], steep = STEEP * depth_step(middle);
    bool edge = false;
    float farthest = middle;
    for (int i = 0; i < EDGE_SAMPLES; ++i) {
        z[i] = texelFetch(edge_depth, at, i).x;
        farthest = max(farthest, z[i]);
        edge = edge || abs(z[i] - middle) > (z[i] < NOWHERE && middle < NOWHERE ? steep : 0.0);
    }
    gl_FragDepth = edge ? farthest : middle;
    vec4 color[EDGE_SAMPLES];
    float off[EDGE_SAMPLES];
    for (int i = 0; i < EDGE_SAMPLES; ++i) {
        color[i] = z[i] < NOWHERE ? own : background;
        off[i] = z[i] < NOWHERE ? middle < NOWHERE ? abs(z[i] - middle) : NOWHERE : 0.0;
    }
    int neighbours = edge ? 9 : 0; // none cost nothing (see shadow_surface.glsl)
    for (int n = 0; n < neighbours; ++n) {
        ivec2 there = clamp(at + ivec2(n % 3, n / 3) - 1, mesh_low, mesh_high - 1);
        float other = texelFetch(middle_depth, there, 0).x;
        vec4 shown = texelFetch(lit, there, 0);
        for (int i = 0; i < EDGE_SAMPLES; ++i) {
            bool better = other < NOWHERE && abs(z[i] - other) < off[i];
            color[i] = better ? shown : color[i];
            off[i] = better ? abs(z[i] - other) : off[i];
        }
    }
    for (int i = 0; i < EDGE_SAMPLES; ++i) add_sample(color[i] / float(EDGE_SAMPLES), z[i]);
}
#endif

void main()
{
#if FLOOR
    vec3 way = ray_through(gl_FragCoord.xy);
    float along = (floor_middle.y - draw_params.eye.y) / way.y;
    vec3 x = draw_params.eye.xyz + along * way;
    float there = along > 0.0 ? floor_there(x) : 0.0;
    floor_depth =
        there > 0.0 ? 0.5 + 0.5 * (draw_params.depth.x + draw_params.depth.y / along) : NOWHERE;
#endif
#if MESH
    add_samples(ivec2(gl_FragCoord.xy), draw_params.background);
#else
    behind = draw_params.background;
#endif
    base = front + behind;
#if FLOOR
    vec4 shown = floor_shown(x, there);
    base = front + (1.0 - front.a) * shown + (1.0 - shown.a) * behind;
#endif
}
