// SPDX-License-Identifier: MIT
// How much of a light reaches a point (needs shadow.h).
//   SHADOW 0: all   1: approximated deep shadow map, as TressFX has it   2: deep opacity map
//   SHADOW_BY_MESH 1: the mesh throws shadows, too
//   SHADOW_FOUND 1: what hair leaves at each point of a strand has been found before
//       (shadow_light.h)
//   MESH_TEXELS 1: the mesh's maps are a buffer: CPU drivers fetch its texels in less time than
//       they gather them from a texture
//   LIGHT_COUNT, SHADOW_MAPS: how many lights and maps, so that loops over them are unrolled; 0:
//       any number
#ifndef LIGHT_COUNT
#define LIGHT_COUNT 0
#endif
#ifndef SHADOW_MAPS
#define SHADOW_MAPS 0
#endif
#ifndef MESH_TEXELS
#define MESH_TEXELS 0
#endif
#ifndef SHADOW_FOUND
#define SHADOW_FOUND 0
#endif

#if SHADOW
#if SHADOW_FOUND
layout(binding = BIND_SHADOW_LEFT) uniform samplerBuffer shadow_found;
layout(location = SHADOW_POINTS_AT) uniform int shadow_points;
#else
layout(binding = BIND_DEPTHS) uniform samplerBuffer shadow_depths;
#if SHADOW == 1
layout(binding = BIND_LAYERS) uniform usamplerBuffer shadow_first;
#else
layout(binding = BIND_LAYERS) uniform usamplerBuffer shadow_layers;
#endif
#endif
#if SHADOW_BY_MESH
#if MESH_TEXELS
layout(binding = BIND_SHADOW_TEXELS) uniform samplerBuffer shadow_mesh;
#else
layout(binding = BIND_SHADOW_MESH) uniform sampler2D shadow_mesh;
#endif
#endif

int shadow_side = shadow_params.side;

// Of the fibre that is asked for: diameter (m) and opacity to light; 0 for the mesh.
vec2 shadow_fibre = vec2(0.0);

#if SHADOW_FOUND
#elif SHADOW == 2
float mix4(float a, float b, float c, float d, vec2 share)
{
    return mix(mix(a, b, share.x), mix(c, d, share.x), share.y);
}

float texel_depth(int texel, float share)
{
    return layer_depth(texelFetch(shadow_layers, texel).x, share);
}

float light_through_hair(int map, vec2 place, float depth, vec4 of_light)
{
    vec2 from = clamp(place - 0.5, 0.0, float(shadow_side) - 1.01), whole = floor(from),
         share = from - whole;
    int row = int(whole.y) * shadow_side + int(whole.x), squares = shadow_side * shadow_side;
    int at = map * squares + row, next = at + shadow_side;
    float layer =
        layer_of(depth - mix4(texelFetch(shadow_depths, at).x, texelFetch(shadow_depths, at + 1).x,
                              texelFetch(shadow_depths, next).x,
                              texelFetch(shadow_depths, next + 1).x, share));
    float which = floor(layer), own = layer - which;
    at = (map * SHADOW_LAYERS + int(which)) * squares + row;
    next = at + shadow_side;
    float sum = mix4(texel_depth(at, own), texel_depth(at + 1, own), texel_depth(next, own),
                     texel_depth(next + 1, own), share);
    sum -= own_layer_depth(shadow_fibre.x * of_light.w, shadow_fibre.y, own);
    return exp2(-LOG2E * max(sum, 0.0));
}
#else
// Fibres stand at even distances behind the first, each letting the same share through; 5 x 5
// texels with the weights of a cone.
float light_through_hair(int map, vec2 place, float depth, vec4 of_light)
{
    float fibres = shadow_params.fibres * of_light.y, passed = shadow_params.passed, sum = 0.0,
          weights = 0.0;
    ivec2 middle = ivec2(place);
    depth = min(depth, 1.01); // farther off there is no hair
    vec2 off = place - vec2(middle) - 0.5;
    for (int y = -2; y <= 2; ++y)
        for (int x = -2; x <= 2; ++x) {
            ivec2 texel = clamp(middle + ivec2(x, y), ivec2(0), ivec2(shadow_side - 1));
            uint first = min(
                texelFetch(shadow_first, (map * shadow_side + texel.y) * shadow_side + texel.x).x,
                uint(SHADOW_DEPTHS));
            float behind = depth - float(int(first)) * (1.0 / float(SHADOW_DEPTHS));
            float weight = max(3.0 - length(vec2(x, y) - off), 0.0);
            float count =
                behind > 1e-4 && first < uint(SHADOW_DEPTHS) ? max(behind * fibres, 1.0) : 0.0;
            sum += weight * exp2(passed * count);
            weights += weight;
        }
    return sum / weights;
}
#endif

#if SHADOW_BY_MESH
// Texels each way that a point looks at: an even number, since four are fetched at once.
#ifndef MESH_TAPS
#define MESH_TAPS 2
#endif

// The depths of 2 x 2 texels of a map, the first of which is at `first`: those of the second row,
// then, from right to left, of the first, as textureGather has them.
vec4 mesh_depths(int map, ivec2 first)
{
    int side = shadow_params.mesh_side, row = map * side + first.y;
#if MESH_TEXELS
    int at = row * side + first.x, below = at + side;
    return vec4(texelFetch(shadow_mesh, below).x, texelFetch(shadow_mesh, below + 1).x,
                texelFetch(shadow_mesh, at + 1).x, texelFetch(shadow_mesh, at).x);
#else
    vec2 corner = vec2(first.x + 1, row + 1); // that the four share
    return textureGather(shadow_mesh, corner / vec2(textureSize(shadow_mesh, 0)), 0);
#endif
}

// The share of a square of MESH_TAPS - 1 texels around the point that the mesh does not stand
// before: texels at its edge count by how much of them is inside, so that it changes evenly as the
// point moves. At the map's edges nothing stands.
float light_past_mesh(int map, vec3 x)
{
    vec4 place = vec4(x, 1.0) * shadow_params.mesh_from_world[map];
    float side = float(shadow_params.mesh_side), reach = 0.5 * float(MESH_TAPS - 1);
    place.xyz /= place.w;
    float depth = min(place.z - shadow_params.place[map].z, 1.0); // what lies behind all of the map
    vec2 from = clamp(place.xy - reach, 0.0, side - float(MESH_TAPS)), first = floor(from),
         share = from - first;
    float sum = 0.0;
    for (int j = 0; j < MESH_TAPS; j += 2)
        for (int i = 0; i < MESH_TAPS; i += 2) {
            vec4 gap = mesh_depths(map, ivec2(first) + ivec2(i, j));
            vec4 lit = mix(vec4(1.0), vec4(0.0), lessThan(gap, vec4(depth)));
            vec2 column = vec2(i == 0 ? 1.0 - share.x : 1.0, i == MESH_TAPS - 2 ? share.x : 1.0);
            vec2 row = vec2(j == 0 ? 1.0 - share.y : 1.0, j == MESH_TAPS - 2 ? share.y : 1.0);
            sum += row.y * dot(column, lit.xy) + row.x * dot(column, lit.wz);
        }
    return sum * (1.0 / float((MESH_TAPS - 1) * (MESH_TAPS - 1)));
}
#endif
#endif

#if SHADOW && !SHADOW_FOUND
// What hair leaves of a map's light at x: all of it beside the map, and behind a lamp, which has
// none there.
float hair_leaves(int map, vec3 x)
{
    vec4 place = vec4(x, 1.0) * shadow_params.from_world[map];
    vec2 texel = place.xy / place.w;
    float left = light_through_hair(map, texel, place.z, shadow_params.place[map]);
    bool beside = any(lessThan(texel, vec2(0.0))) || any(greaterThan(texel, vec2(shadow_side)));
    return beside || place.w <= 0.0 ? 1.0 : left;
}
#endif

#if SHADOW
// Of each light what is left at the point of the last shadow_find; whole where it has no map.
float shadow_left[MAX_LIGHTS] = float[MAX_LIGHTS](1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0);
#if SHADOW_MAPS
const int shadow_maps = SHADOW_MAPS;
#else
int shadow_maps = shadow_params.maps;
#endif

void shadow_keep(int light, float left)
{
#if LIGHT_COUNT
    // An array whose every place is known when compiling stays in registers.
    for (int i = 0; i < LIGHT_COUNT; ++i) shadow_left[i] = i == light ? left : shadow_left[i];
#else
    shadow_left[light] = left;
#endif
}

// Finds what is left of all lights at x, where point `point` of a batch lies, a turn for each map:
// CPU drivers run both sides of every `if`, so that lights without a map would cost as much as
// those with one.
void shadow_find(int point, vec3 x)
{
    for (int map = 0; map < shadow_maps; ++map) {
#if SHADOW_FOUND
        float left = texelFetch(shadow_found, map * shadow_points + point).x;
#else
        float left = hair_leaves(map, x);
#endif
#if SHADOW_BY_MESH
        float past = light_past_mesh(map, x);
        left *= dot(vec4(x, 1.0), shadow_params.from_world[map][3]) > 0.0 ? past : 1.0;
#endif
        shadow_keep(int(shadow_params.place[map].x), left);
    }
}
#endif

// Share of light `light` that reaches the point.
float light_left(int light)
{
#if SHADOW
    return shadow_left[light];
#else
    return 1.0;
#endif
}
