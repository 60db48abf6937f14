// SPDX-License-Identifier: MIT
// The room `reference`: what hair should look like, exactly and slowly, in double precision on the
// CPU. It takes strands and a scene and gives an image (here) and the light that reaches a point
// (shadow_reference.h). Rasterisers and shadow maps are judged by it, in tests and benchmarks.
//
// The image that a renderer should have made, by brute force on the CPU in double precision: the
// judge of every scheme that draws hair faster.
//
// A pixel is the mean over its square of side x side sub-samples in a regular grid. At each of them
// all ribbons that it hits are sorted by depth and composited with 'over', premultiplied and in
// linear light; the mean becomes sRGB with 8 bits once, at the end.
//
// A strand is a chain of ribbons that face the eye. On the screen a ribbon has straight edges at
// the half-width r f sqrt(1 + (q/f)^2) / w beside its middle line: r the fibre radius there (from
// root to tip by the number of the vertex), f the focal length in px, w the distance before the
// eye, q how far the outline lies off the optical axis (a cylinder's outline is wider there). At a
// joint the edges of both ribbons meet on the mitre; where a strand folds back by more than 139
// degrees the mitre is shortened. Depth and colour, which is that of the vertices, are linear along
// the ribbon on the screen (1/w is exactly). Opacity is that of the root. Shading is Kajiya's and
// Kay's with two highlights, or what `shade` says.
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
    uint32_t first_id;             // number of the first strand among all of the run
    const SectionParams *material; // colours, opacity, tip_ratio
    float radius;                  // fibre radius at the root, m
    const Paint *paint;            // colours, opacity and thickness by vertex; NULL: the material's
    const float *left; // [light_count][vertex_count]: the share of each light that reaches
                       // a vertex (shadow_reference_fill); NULL: all
} ReferenceItem;

// A vertex that is to be shaded, and its answer, linear RGB.
typedef struct ReferenceVertex {
    double position[3];            // m, in the world
    double tangent[3], to_eye[3];  // unit
    double base[3];                // the hair's colour there, linear
    double left[SCENE_MAX_LIGHTS]; // share of each light that shadows leave
} ReferenceVertex;

struct ReferenceScene;
typedef void ReferenceShade(const struct ReferenceScene *scene, const SectionParams *material,
                            const ReferenceVertex *vertex, double color[3]);

typedef struct ReferenceScene {
    ReferenceShade *shade; // NULL: Kajiya's and Kay's

    const View *view; // made for the image's size
    const Light *lights;
    uint32_t light_count;
    const float *sky, *ground; // [3] linear: ambient light from above and below; NULL: white
    const ReferenceItem *items;
    uint32_t item_count;
    const Mesh *mesh;    // opaque, in the world; NULL: none. It hides what lies behind it and is
    float mesh_color[4]; // drawn in one linear colour, premultiplied
    float background[4]; // sRGB and opacity 0..1
    uint32_t seed;       // of what varies by strand
    int threads;         // up to PARALLEL_MOST, the image is the same; 0: as processors are there
} ReferenceScene;

enum { REFERENCE_SIDE = 16 };

// Draws into `image`, which has a size and 3 (opaque background) or 4 channels, with `side` x
// `side` sub-samples a pixel, >= 1. Takes time with the covered sub-samples, about 0.1 us each on
// one thread, and memory with those of one row of pixels for each thread. RESULT_FAILED when memory
// is short.
Result image_reference_draw(Image *image, const ReferenceScene *scene, int side, Error *error);

// --- The shapes of a scene, which the shadows' judge (shadow_reference.h) uses as well.

// A quantity that is linear on the screen, kept between its values at the corners.
typedef struct ShapePlane {
    double base, dx, dy; // base + dx x + dy y, in px
    double low, high;
} ShapePlane;

typedef struct Shape {
    double corner[4][2]; // px, in turn
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

// A plane's value there.
double image_reference_plane(const ShapePlane *plane, double x, double y);

// Where the shape's outline crosses the horizontal line at y, ascending; gives their count. An edge
// takes its lower end but not its upper one, so that shapes with a common edge share the line.
int image_reference_cross(const Shape *shape, double y, double crossing[4]);
