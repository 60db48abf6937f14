// SPDX-License-Identifier: MIT
// The share of a light that reaches a point (needs shadow.h).
//   SHADOW 0: all of it   1: approximated deep shadow map, as in TressFX   2: deep opacity map
//   SHADOW_BY_MESH 1: the mesh casts shadows, too
//   WIDE 1: lights may have a radius
//   LIGHT_COUNT, SHADOW_MAPS: numbers of lights and maps, so that loops over them are unrolled; 0:
//       any number
#ifndef LIGHT_COUNT
#define LIGHT_COUNT 0
#endif
#ifndef SHADOW_MAPS
#define SHADOW_MAPS 0
#endif
#ifndef WIDE
#define WIDE 0
#endif

#if SHADOW
#include "kernel/left.h"
layout(binding = BIND_DEPTHS) uniform samplerBuffer shadow_depths;
#if SHADOW == 1
layout(binding = BIND_LAYERS) uniform usamplerBuffer shadow_first;
#else
layout(binding = BIND_LAYERS) uniform usamplerBuffer shadow_layers;
#endif
#if SHADOW_BY_MESH
layout(binding = BIND_SHADOW_MESH) uniform sampler2D shadow_mesh;
#endif

int shadow_side = shadow_params.side;

// The fibre whose shadow is looked up: diameter (m) and opacity to light; 0 for the mesh.
vec2 shadow_fibre = vec2(0.0);

#if SHADOW == 2
float texel_depth(int texel, float share)
{
    return layer_depth(texelFetch(shadow_layers, texel).x, share);
}

float light_through_hair(int map, vec2 place, float depth, vec4 of_light)
{
    vec2 from = vec2(left_from(place.x, float(shadow_side), 2.0),
                     left_from(place.y, float(shadow_side), 2.0)),
         whole = floor(from), share = from - whole;
    int row = int(whole.y) * shadow_side + int(whole.x), squares = shadow_side * shadow_side;
    int at = map * squares + row, next = at + shadow_side;
    float begin = left_mix(texelFetch(shadow_depths, at).x, texelFetch(shadow_depths, at + 1).x,
                           texelFetch(shadow_depths, next).x, texelFetch(shadow_depths, next + 1).x,
                           share.x, share.y);
    float layer = layer_of(depth - begin), which = floor(layer), own = layer - which;
    at = (map * SHADOW_LAYERS + int(which)) * squares + row;
    next = at + shadow_side;
    float sum = left_mix(texel_depth(at, own), texel_depth(at + 1, own), texel_depth(next, own),
                         texel_depth(next + 1, own), share.x, share.y);
    sum -= own_layer_depth(shadow_fibre.x * of_light.w, shadow_fibre.y, own);
    return left_of_fibres(max(sum, 0.0));
}

#if WIDE
int wide_texel(int map, vec2 place)
{
    return (map * shadow_side + left_texel(place.y, shadow_side)) * shadow_side +
           left_texel(place.x, shadow_side);
}

// The same for a wide light (kernel/left.h). `surface`: the point lies on a mesh or a floor.
float light_through_wide(int map, vec2 place, float depth, vec4 of_light, bool surface)
{
    int squares = shadow_side * shadow_side;
    int rays = surface ? LEFT_SPREAD : LEFT_RAYS;
    float reach = shadow_params.wide[map].x, front = depth, left = 0.0;
    for (int r = 0; r < rays; ++r) {
        vec4 ray = surface ? shadow_params.spread[r] : shadow_params.ray[r];
        vec2 off = reach * max(depth, 0.0) * ray.xy;
        front = min(front, texelFetch(shadow_depths, wide_texel(map, place + off)).x);
    }
    float span = depth - front;
    for (int r = 0; r < rays; ++r) {
        vec4 ray = surface ? shadow_params.spread[r] : shadow_params.ray[r];
        float fibres = 0.0, share = 0.0;
        for (int slab = 0; slab < LEFT_SLABS; ++slab) {
            vec2 there = place + reach * left_slab_place(slab) * span * ray.xy + ray.zw;
            int texel = wide_texel(map, there);
            float on = surface ? left_on_map(there.x, there.y, float(shadow_side)) : 1.0;
            float begin = texelFetch(shadow_depths, texel).x, ends[2];
            ends[0] = slab > 0 ? left_slab_end(slab - 1) : 0.0;
            ends[1] = left_slab_end(slab);
            for (int e = 0; e < 2; ++e) {
                float layer = layer_of(front + ends[e] * span - begin), which = floor(layer);
                share = layer - which;
                // After all layers of the maps before, those of this map.
                int at = texel + (map * (SHADOW_LAYERS - 1) + int(which)) * squares;
                float met = texel_depth(at, share);
                fibres += e == 0 ? -on * met : on * met;
            }
        }
        fibres -= own_layer_depth(shadow_fibre.x * of_light.w, shadow_fibre.y, share);
        left += left_of_fibres(max(fibres, 0.0));
    }
    return left / float(rays);
}
#endif
#else
float light_through_hair(int map, vec2 place, float depth, vec4 of_light)
{
    float fibres = shadow_params.fibres * of_light.y, passed = shadow_params.passed, sum = 0.0,
          weights = 0.0;
    ivec2 middle = ivec2(place);
    vec2 off = place - vec2(middle) - 0.5;
    const int reach = LEFT_TAPS / 2;
    for (int y = -reach; y <= reach; ++y)
        for (int x = -reach; x <= reach; ++x) {
            ivec2 texel = clamp(middle + ivec2(x, y), ivec2(0), ivec2(shadow_side - 1));
            uint first = min(
                texelFetch(shadow_first, (map * shadow_side + texel.y) * shadow_side + texel.x).x,
                uint(SHADOW_DEPTHS));
            float count =
                left_fibres(depth, float(int(first)) * (1.0 / float(SHADOW_DEPTHS)), fibres);
            float weight = left_cone(float(x) - off.x, float(y) - off.y);
            sum += weight * exp2(passed * count);
            weights += weight;
        }
    return sum / weights;
}
#endif

#if SHADOW_BY_MESH
// Texels that a point samples along each axis: an even number, because four are fetched at once.
#ifndef MESH_TAPS
#define MESH_TAPS 2
#endif

// The depths of 2 x 2 texels of a map beginning at `first`, in the order of textureGather: the
// second row, then the first row from right to left.
vec4 mesh_depths(int map, ivec2 first)
{
    int row = map * shadow_params.mesh_side + first.y;
    vec2 corner = vec2(first.x + 1, row + 1); // the corner that the four texels share
    return textureGather(shadow_mesh, corner / vec2(textureSize(shadow_mesh, 0)), 0);
}

#if WIDE
// The depth of the mesh at a place in its map.
float mesh_depth(int map, vec2 place)
{
    int side = shadow_params.mesh_side;
    ivec2 texel = ivec2(left_texel(place.x, side), map * side + left_texel(place.y, side));
    return texelFetch(shadow_mesh, texel, 0).x;
}

// The share of a wide light that passes the mesh to a place in its map (kernel/left.h).
float wide_past_mesh(int map, vec2 place, float depth)
{
    float reach = shadow_params.wide[map].y, away = reach * max(depth, 0.0), sum = 0.0, count = 0.0,
          nearest = 0.0;
    for (int r = 0; r < LEFT_RAYS; ++r) {
        vec4 ray = shadow_params.ray[r];
        for (int step = 0; step < LEFT_STEPS; ++step) {
            float gap = mesh_depth(map, place + away * left_step(step) * ray.xy + ray.zw);
            bool before = left_in_way(step, gap, depth, length(ray.xy));
            sum += before ? gap : 0.0;
            count += before ? 1.0 : 0.0;
            nearest = before ? max(gap, nearest) : nearest;
        }
    }
    float off = reach * (depth - sum / max(count, 1.0)), limit = left_limit(depth, nearest),
          past = 0.0;
    for (int r = 0; r < LEFT_RAYS; ++r) {
        vec4 ray = shadow_params.ray[r];
        for (int turn = 0; turn < LEFT_TURNS; ++turn) {
            bool blocked = count > 0.0 && mesh_depth(map, place + off * ray.xy + ray.zw) < limit;
            past += blocked ? 0.0 : 1.0 / float(LEFT_RAYS * LEFT_TURNS);
            ray.xy = vec2(LEFT_TURN_COS * ray.x - LEFT_TURN_SIN * ray.y,
                          LEFT_TURN_SIN * ray.x + LEFT_TURN_COS * ray.y);
        }
    }
    return past;
}
#endif

// The share of light that passes the mesh (kernel/left.h).
float light_past_mesh(int map, vec3 x)
{
    vec4 place = vec4(x, 1.0) * shadow_params.mesh_from_world[map];
    float side = float(shadow_params.mesh_side), taps = float(MESH_TAPS);
    place.xyz /= place.w;
#if WIDE
    if (shadow_params.wide[map].y > 0.0)
        return wide_past_mesh(map, place.xy, place.z - shadow_params.place[map].z);
#endif
    // Points behind the map's range get its far end.
    float depth = min(place.z - shadow_params.place[map].z, 1.0);
    vec2 from = vec2(left_from(place.x, side, taps), left_from(place.y, side, taps)),
         first = floor(from), share = from - first;
    float sum = 0.0;
    for (int j = 0; j < MESH_TAPS; j += 2)
        for (int i = 0; i < MESH_TAPS; i += 2) {
            vec4 gap = mesh_depths(map, ivec2(first) + ivec2(i, j));
            vec2 column = vec2(left_inside(i, MESH_TAPS, share.x),
                               left_inside(i + 1, MESH_TAPS, share.x)),
                 row = vec2(left_inside(j, MESH_TAPS, share.y),
                            left_inside(j + 1, MESH_TAPS, share.y));
            sum += left_lit(gap.w, depth, column.x * row.x) +
                   left_lit(gap.z, depth, column.y * row.x) +
                   left_lit(gap.x, depth, column.x * row.y) +
                   left_lit(gap.y, depth, column.y * row.y);
        }
    return sum * (1.0 / float((MESH_TAPS - 1) * (MESH_TAPS - 1)));
}
#endif
#endif

#if SHADOW
#if WIDE && SHADOW == 2
#define LIGHT_THROUGH(map, place, depth, of_light, surface)                                        \
    (shadow_params.wide[map].x > 0.0 ? light_through_wide(map, place, depth, of_light, surface)    \
                                     : light_through_hair(map, place, depth, of_light))
#else
#define LIGHT_THROUGH(map, place, depth, of_light, surface)                                        \
    light_through_hair(map, place, depth, of_light)
#endif

// The share of a map's light that hair lets through to x. It is 1 outside the map and behind a
// lamp, where there is no map.
float hair_leaves(int map, vec3 x)
{
    CasterPlace place = caster_place(shadow_params.from_world[map], x.x, x.y, x.z);
    vec2 texel = vec2(place.u, place.v);
    float left = LIGHT_THROUGH(map, texel, place.z, shadow_params.place[map], false);
    bool beside = any(lessThan(texel, vec2(0.0))) || any(greaterThan(texel, vec2(shadow_side)));
    return beside ? 1.0 : left;
}

// The share of each light that reaches the point of the last shadow_find; 1 without a map.
float shadow_left[MAX_LIGHTS] = float[MAX_LIGHTS](1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0);
#if SHADOW_MAPS
const int shadow_maps = SHADOW_MAPS;
#else
int shadow_maps = shadow_params.maps;
#endif

void shadow_keep(int light, float left)
{
#if LIGHT_COUNT
    // An array that is only indexed by constants stays in registers.
    for (int i = 0; i < LIGHT_COUNT; ++i) shadow_left[i] = i == light ? left : shadow_left[i];
#else
    shadow_left[light] = left;
#endif
}

// Finds the share of all lights that reaches x, one turn for each map. CPU drivers execute both
// sides of an `if`, so a loop over lights would cost as much for lights without a map.
void shadow_find(vec3 x)
{
    for (int map = 0; map < shadow_maps; ++map) {
        float left = hair_leaves(map, x);
#if SHADOW_BY_MESH
        float past = light_past_mesh(map, x);
        left *= dot(vec4(x, 1.0), shadow_params.from_world[map][3]) > 0.0 ? past : 1.0;
#endif
        shadow_keep(int(shadow_params.place[map].x), left);
    }
}
#endif

// The share of light `light` that reaches the point.
float light_left(int light)
{
#if SHADOW
    return shadow_left[light];
#else
    return 1.0;
#endif
}
