// SPDX-License-Identifier: MIT
// What stands behind and among the hair: mesh and floor over the background.
//
// The mesh's surface and the depth of samples at its edges are drawn first, each pixel is lit once
// by that, and then all is put together. None of this is done again for an image in which neither
// camera, head, lights nor shadows have changed.
#pragma once

#include "base/params.h"
#include "gpu/gpu_timer.h"
#include "gpu/shader.h"
#include "passes/render_mesh.h"
#include "passes/shadows.h"
#include "scene/floor.h"

#include "glsl/draw/draw.h"

// A zeroed struct has no mesh.
typedef struct BaseLayer {
    RenderMesh mesh;
    MeshShading shading;        // of the mesh; stays the same
    GLuint light;               // program of the mesh
    GLuint finish[2][3];        // programs: with a mesh, and by FloorKind
    int light_count, map_count; // that these are for
    GLuint vertex_array;        // without attributes
    DrawParams drawn;           // what the target's surface and base show
    uint64_t shadowed;          // Shadows.version of it
    bool any;
    uint64_t version;       // counts the times that anything was drawn
    uint64_t depth_version; // counts the times that the target's depth was
} BaseLayer;

// An image of it. Boxes in samples: x, y lowest, highest; outside of them is background.
typedef struct BaseScene {
    const Floor *floor;
    const Shadows *shadow;     // what mesh and floor receive, which is bound
    const DrawParams *draw;    // uploaded
    const int *mesh_box, *box; // [4]: of the mesh, of mesh and floor
} BaseScene;

// Whether there is more than background.
bool base_layer_is_needed(const BaseLayer *base, const Floor *floor);

// Says for how many lights and shadow maps programs are; those for others are forgotten.
void base_layer_count(BaseLayer *base, int light_count, int map_count);

// Compiles what lights the mesh, and what puts all together there with the floor that is seen and
// what it receives, unless it is there. The shadow stays the same for a BaseLayer.
Result base_layer_build_light(BaseLayer *base, Shadow shadow, Error *error);
Result base_layer_build(BaseLayer *base, bool mesh, FloorKind floor, Shadow shadow, Error *error);

// Fills the target's depth and its `base`, unless they show this scene already. Spans "draw_mesh"
// and "draw_floor"; where a floor is seen, the latter has what puts mesh, floor and background
// together. Leaves scissor and writing of depth off.
// RESULT_FAILED if a shader does not compile.
Result base_layer_draw(BaseLayer *base, const BaseScene *scene, const RenderTarget *target,
                       GpuTimer *timer, Error *error);

void base_layer_destroy(BaseLayer *base);
