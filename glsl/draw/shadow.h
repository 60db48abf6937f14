// SPDX-License-Identifier: MIT
// Parameters with which shadow maps are made and read. A light's map has SHADOW_SIDE x SHADOW_SIDE
// texels across the light.
#include "common/shared_math.h"
#include "draw/draw.h"
#ifdef __STDC__
#pragma once
#endif

#define SHADOW_COARSE 4        // texels: side of a texel of the map of first depths
#define SHADOW_DEPTHS 16777215 // steps from the first depth that there can be to the last

#define BIND_SHADOW 3 // uniform block
#define BIND_CAST   4 // uniform block, in the passes that make maps

// Shader storage.
#define BIND_BOUNDS_OUT 0 // 6 int: lowest and highest place, see shadow_bounds.comp
#define BIND_FIRST_OUT  1 // uint a texel: first depth
#define BIND_SUMS_OUT   2 // uint a layer and texel
#define BIND_LAYERS_OUT 3 // uint a layer and texel: see pack_layer
#define BIND_DEPTHS_OUT 4 // float a texel: where the layers begin

// Textures.
#define BIND_FIRST       4
#define BIND_SUMS        5
#define BIND_LAYERS      11
#define BIND_DEPTHS      12
#define BIND_SHADOW_MESH 13

// Of each map the light's view, by the rows of a matrix that a point (x, y, z, 1) is multiplied
// with.
UNIFORM_BLOCK(ShadowParams, shadow_params, BIND_SHADOW)
{
    mat4 from_world[MAX_LIGHTS];      // u, v (texels of the map) times w; depth 0..1 of the hair; w
    mat4 mesh_from_world[MAX_LIGHTS]; // u, v (texels of the mesh's map), depth 0..1, all times w; w
    vec4 place[MAX_LIGHTS];           // the light's number; metres of depth; depth that the
                                      // mesh's map is moved by; texels in a metre across, about
    int maps;
    int side, mesh_side; // texels
    float fibres;        // approx: fibres in a metre along the light
    float passed;        // approx: share of the light that a fibre lets through, as a power of 2
    float mesh_lift;     // m: how far the mesh is moved along its normals where it receives light
}
END_BLOCK(ShadowParams, shadow_params);

// One light before which hair stands; what the hair is like tells material.h.
UNIFORM_BLOCK(CastParams, cast_params, BIND_CAST)
{
    mat4 from_world; // see above, of the light in turn
    int side;        // texels
    int map;         // number
    float unit;      // of sums: steps for one fibre
    float texels;    // in a metre across the light (a perspective one: at w = 1)
    float reach;     // greatest u and v that a bound may have
    float limit;     // no coordinate in the world is beyond this, m: others are broken
}
END_BLOCK(CastParams, cast_params);
