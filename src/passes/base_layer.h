// SPDX-License-Identifier: MIT
// Mesh and floor over the background, drawn by shaders.
//
// First the mesh's surface and the depth of samples at its edges are drawn. Then each pixel of the
// surface is lit once. At last mesh, floor and background are joined. All of this is skipped if
// camera, head, lights and shadows are those of the last image.
#pragma once

#include "base/params.h"
#include "draw/backdrop.h"
#include "gpu/gpu_timer.h"
#include "gpu/shader.h"
#include "passes/light_passes.h"
#include "passes/render_mesh.h"
#include "passes/shadows.h"
#include "scene/floor.h"

#include "glsl/draw/draw.h"

// A zeroed struct has no mesh.
typedef struct BaseLayer {
    RenderMesh mesh;
    MeshShading shading;        // of the mesh; does not change
    int backdrop;               // samples of a pixel's side if the environment is the background; 0
                                // if it is even; does not change
    GpuBuffer backdrop_light;   // vec4 a pixel
    uint64_t backdrop_version;  // Backdrop.version of it
    GLuint light;               // program that lights the mesh
    GLuint finish[2][3];        // programs: with a mesh, and by FloorKind
    int light_count, map_count; // numbers for which these programs were compiled
    bool wide, onto;            // the same: lights have a radius, hair sends light onto the mesh
    GLuint vertex_array;        // without attributes
    DrawParams drawn;           // the parameters of the target's surface and base
    uint64_t shadowed;          // Shadows.version of that image
    bool any;
    uint64_t version;       // incremented when anything was drawn
    uint64_t depth_version; // incremented when the target's depth was drawn
} BaseLayer;

// Input for an image. Boxes are in samples: x, y lowest, highest; outside of them is background.
typedef struct BaseScene {
    const Floor *floor;
    const Shadows *shadow;    // shadows on mesh and floor, bound
    const LightPasses *light; // light that hair sends onto the mesh; NULL: none
    const DrawParams *draw;   // uploaded
    const Backdrop *backdrop; // the environment as background
    const GpuLimits *limits;
    const int *mesh_box, *box; // [4]: of the mesh, of mesh and floor
} BaseScene;

// Whether there is a mesh, a floor or a backdrop.
bool base_layer_is_needed(const BaseLayer *base, const Floor *floor);

// Sets the number of lights and shadow maps, whether lights have a radius, and whether hair sends
// light onto the mesh. Programs for others are dropped.
void base_layer_count(BaseLayer *base, int light_count, int map_count, bool wide, bool onto);

// Compile the program that lights the mesh, and the one that joins mesh, floor and background, for
// a floor of this kind and shadows of this kind, unless they are there. `shadow` stays the same for
// a BaseLayer.
Result base_layer_build_light(BaseLayer *base, Shadow shadow, Error *error);
Result base_layer_build(BaseLayer *base, bool mesh, FloorKind floor, Shadow shadow, Error *error);

// Fills the target's depth and `base`, unless they show this scene already. Its spans are
// "draw_mesh" and, if a floor is seen, "draw_floor", which then includes joining mesh, floor and
// background. Leaves scissor and depth writes off. RESULT_FAILED if a shader does not compile.
Result base_layer_draw(BaseLayer *base, const BaseScene *scene, const RenderTarget *target,
                       GpuTimer *timer, Error *error);

void base_layer_destroy(BaseLayer *base);
