// SPDX-License-Identifier: MIT
// Parameters for making and reading shadow maps. A light's map has SHADOW_SIDE x SHADOW_SIDE texels
// across the light.
#include "common/shared_math.h"
#include "draw/draw.h"
#include "kernel/left.h"
#ifdef __STDC__
#pragma once
#endif

#define SHADOW_COARSE 4        // texels that a texel of the map of first depths is wide
#define SHADOW_DEPTHS 16777215 // integer steps of the depth range

#define BIND_SHADOW 3 // uniform block
#define BIND_CAST   4 // uniform block, in the passes that make maps

// Shader storage.
#define BIND_BOUNDS_OUT 0 // 6 int: lowest and highest place, see shadow_bounds.comp
#define BIND_FIRST_OUT  1 // uint a texel: first depth
#define BIND_SUMS_OUT   2 // uint a layer and texel
#define BIND_LAYERS_OUT 3 // uint a layer and texel: see pack_layer
#define BIND_DEPTHS_OUT 4 // float a texel: the depth at which the layers begin

// Textures.
#define BIND_FIRST       4
#define BIND_SUMS        5
#define BIND_LAYERS      11
#define BIND_DEPTHS      12
#define BIND_SHADOW_MESH 13

// The view of each map's light, as rows of a matrix to multiply with a point (x, y, z, 1).
UNIFORM_BLOCK(ShadowParams, shadow_params, BIND_SHADOW)
{
    mat4 from_world[MAX_LIGHTS];      // u, v (texels) times w; depth 0..1 over the hair; w
    mat4 mesh_from_world[MAX_LIGHTS]; // u, v (texels of the mesh's map), depth 0..1, all times w; w
    vec4 place[MAX_LIGHTS]; // number of the light; depth range in m; depth bias of the mesh's map;
                            // texels in a metre across, approximately
    vec4
        wide[MAX_LIGHTS]; // x: how far the edge of a wide light moves what it sees across the map,
                          // in texels for each unit of depth, 0: it has no radius; y: in the mesh's
    // xy: to a part of a wide light, over its radius; zw: texels, of places
    vec4 ray[LEFT_RAYS];
    vec4 spread[LEFT_SPREAD]; // the same, of rays to hair from surfaces
    int maps;
    int side, mesh_side; // texels
    float fibres;        // approx: fibres per metre along the light
    float passed;        // approx: log2 of a fibre's transmittance
    float mesh_lift;     // m: bias of points on the mesh along their normals
}
END_BLOCK(ShadowParams, shadow_params);

// A map that hair is drawn into. material.h describes the hair.
UNIFORM_BLOCK(CastParams, cast_params, BIND_CAST)
{
    mat4 from_world; // as above, for this map's light
    int side;        // texels
    int map;         // index of the map
    float unit;      // steps of the sums for one fibre
    float texels;    // texels per metre across the light (for a lamp at w = 1)
    float reach;     // limit of |u| and |v| for bounding boxes
    float limit;     // m: positions with a larger coordinate are broken
}
END_BLOCK(CastParams, cast_params);
