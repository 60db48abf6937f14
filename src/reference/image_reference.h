// SPDX-License-Identifier: MIT
// The room `reference`: exact but slow results in double precision on the CPU. Input: strands and a
// scene. Output: an image (this file) and the light that reaches a point (shadow_reference.h).
// Tests and benchmarks compare rasterisers and shadow maps with it.
//
// This file: the exact image, by brute force, as a reference for every faster way to draw hair.
//
// A pixel is the mean over side x side sub-samples in a regular grid. At each of them, all ribbons
// that cover it are sorted by depth and composited with 'over', premultiplied and in linear light;
// the mean is converted to 8-bit sRGB once, at the end.
//
// A strand is a chain of ribbons that face the eye. On the screen, a ribbon has straight edges at
// the distance r f sqrt(1 + (q/f)^2) / w from its centre line, where r is the fibre radius
// (interpolated from root to tip by vertex number), f the focal length in px, w the distance from
// the eye's plane, and q the distance of the outline from the optical axis (a cylinder's outline is
// wider there). At a joint, the edges of both ribbons meet on the mitre; where a strand folds back
// by more than 139 degrees, the mitre is shortened. Colour, given at the vertices, and depth are
// linear along the ribbon on the screen (1/w is exactly linear). Opacity is that of the root.
// Shading is Kajiya-Kay with two highlights, or `shade`.
#pragma once

#include "draw/light_frame.h"
#include "image/image.h"
#include "mesh/mesh.h"
#include "scene/camera.h"
#include "scene/scene.h"
#include "strands/paint.h"
#include "strands/strands.h"

typedef struct ReferenceItem {
    const Strands *strands;        // positions in the world, m
    uint32_t first_id;             // number of its first strand within the run
    const SectionParams *material; // colours, opacity, tip_ratio
    float radius;                  // fibre radius at the root, m
    const Paint *paint;            // colours, opacity and thickness by vertex; NULL: the material's
    // [light_count][vertex_count], share of each light that reaches a vertex
    // (shadow_reference_fill); NULL: all of it.
    const float *left;
} ReferenceItem;

// A vertex to be shaded.
typedef struct ReferenceVertex {
    double position[3];            // m, in the world
    double tangent[3], to_eye[3];  // unit
    double base[3];                // colour of the hair, linear
    double left[SCENE_MAX_LIGHTS]; // share of each light that is not shadowed
} ReferenceVertex;

struct ReferenceScene;
typedef void ReferenceShade(const struct ReferenceScene *scene, const SectionParams *material,
                            const ReferenceVertex *vertex, double color[3]);

typedef struct ReferenceScene {
    ReferenceShade *shade; // NULL: Kajiya-Kay

    const View *view; // for the image's size
    const Light *lights;
    uint32_t light_count;
    const float *sky, *ground; // [3] linear ambient light from above and below; NULL: white
    const ReferenceItem *items;
    uint32_t item_count;
    const Mesh *mesh;    // opaque, in the world; NULL: none. It hides what lies behind it and is
    float mesh_color[4]; // drawn in one linear colour, premultiplied
    float background[4]; // sRGB and opacity 0..1
    uint32_t seed;       // for random variation between strands
    int threads;         // up to PARALLEL_MOST, without effect on the image; 0: one per processor
} ReferenceScene;

enum { REFERENCE_SIDE = 16 };

// Draws into `image`, which must have a size and 3 (opaque background) or 4 channels, with `side` x
// `side` sub-samples per pixel, >= 1. The time is about 0.1 us per covered sub-sample on one
// thread; memory is that of one row of pixels per thread. RESULT_FAILED when memory is short.
Result image_reference_draw(Image *image, const ReferenceScene *scene, int side, Error *error);

// --- The shapes of a scene, also used by shadow_reference.h.

// A quantity that is linear on the screen, clamped to its values at the corners.
typedef struct ShapePlane {
    double base, dx, dy; // base + dx x + dy y, in px
    double low, high;
} ShapePlane;

typedef struct Shape {
    double corner[4][2]; // px, in order around the shape
    int corners;         // 3 or 4
    double top, bottom;  // px, lowest and highest y
    double opacity;
    ShapePlane inverse_w; // 1/m
    ShapePlane color[3];  // linear
} Shape;

typedef struct Shapes {
    Shape *shapes; // [count], owned
    uint32_t count;
} Shapes;

// All ribbons and triangles as a light sees them, in its u and v (light_frame.h) in place of px,
// with the material's shadow_opacity and without colours. inverse_w is 1/m before a lamp, else the
// distance along the light, negative: what is nearer is greater. What lies behind a lamp is left
// out. RESULT_FAILED when memory is short.
Result image_reference_shapes(Shapes *shapes, const ReferenceScene *scene, const LightView *light,
                              Error *error);
void image_reference_destroy_shapes(Shapes *shapes);

// The value of the plane at a point.
double image_reference_plane(const ShapePlane *plane, double x, double y);

// The x at which the outline crosses the horizontal line at y, ascending; returns their number. An
// edge includes its lower end but not its upper end, so shapes with a common edge do not both cover
// a sample on it.
int image_reference_cross(const Shape *shape, double y, double crossing[4]);
