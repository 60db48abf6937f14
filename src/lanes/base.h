// SPDX-License-Identifier: MIT
// Mesh and floor over the background, in C. base_layer.h does the same with shaders; both use the
// formulas of glsl/kernel/skin.h, lamp.h, floor.h and edge.h.
//
// First the mesh is rasterised: its nearest surface, and the depths of samples at its edges
// (mesh_raster.h). Then each pixel of the surface is lit once. At last mesh, floor and background
// are joined. All of this is skipped if camera, head, mesh, lights and shadows are those of the
// last image.
#pragma once

#include "base/params.h"
#include "draw/backdrop.h"
#include "lanes/block.h"
#include "lanes/light_grid.h"
#include "lanes/mesh_raster.h"
#include "lanes/shadow.h"
#include "scene/floor.h"

#include "glsl/draw/draw.h"

// Input for an image. Boxes are in samples: x, y lowest, highest; outside of them is background.
typedef struct LaneBaseScene {
    PlacedMesh mesh;       // no triangles: none
    uint64_t mesh_version; // changes when the mesh's positions or normals change in its own frame
    MeshShading shading;
    const Floor *floor;
    const LaneShadow *shadow; // shadows on mesh and floor; NULL: none
    const LightGrid *grid;    // light that hair sends onto skin; NULL: none
    const DrawParams *draw;
    const Backdrop *backdrop;  // NULL: an even background
    int samples;               // of a pixel's side
    const int *mesh_box, *box; // [4]: of the mesh, of mesh and floor
} LaneBaseScene;

// A zeroed struct is empty.
typedef struct LaneBase {
    MeshRaster raster;
    MeshSurface surface; // starts at sample `low` of the image
    int low[2];
    float *lit; // [3][lit_room / 3], owned: linear light of the surface, in rows like the surface's
    size_t lit_room;
    uint16_t (*light)[4]; // [room], owned, as `depth` and `rim`: of `shown`
    float *depth;
    BaseRim *rim;
    size_t room;
    uint16_t *rimmed; // [rimmed_room], owned
    size_t rimmed_room;
    BlockBase shown;                 // the last result
    DrawParams drawn;                // its parameters
    uint64_t mesh_version, shadowed; // for which it was drawn; `shadowed`: LaneShadow.version
    bool any;
    uint64_t version;       // incremented when anything was drawn
    uint64_t depth_version; // incremented when depths were drawn
} LaneBase;

// Draws `shown`, unless it shows this scene already. RESULT_FAILED if memory is short.
Result lane_base_draw(LaneBase *base, const LaneBaseScene *scene, Error *error);
void lane_base_destroy(LaneBase *base);
