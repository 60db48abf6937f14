// SPDX-License-Identifier: MIT
// Options of a renderer, and counts of an image for the statistics.
#pragma once

#include "base/params.h"
#include "draw/shadow_frames.h"
#include "image/image.h"
#include "scene/camera.h"
#include "scene/environment.h"
#include "scene/floor.h"
#include "scene/scene.h"

typedef struct Hair Hair;         // sim/hair.h
typedef struct HeadPose HeadPose; // sim/head.h

// Level of detail. All zero: all strands are drawn. The strands of a file lie in random order, so
// the first ones represent the whole.
typedef struct LodOptions {
    float start, end; // m: between these distances of the camera from a section's middle, the share
                      // of drawn strands falls from 1 to `least`; end 0: it does not fall
    float least;      // share, 0 .. 1
    float width;      // px: thinner fibres are drawn this wide, but fewer of them; 0: unchanged
} LodOptions;

// Options of the light from fibre to fibre.
typedef struct ScatterOptions {
    Scatter kind;     // none: only direct light of the sky
    int cells;        // along the longest side of the hair, 4 .. 64; 0: 32
    int orders;       // number of orders of scattering, 1 .. 32; 0: 16
    uint32_t strands; // number of strands that represent all in the cells, at least; 0: all
    // Set by scatter_options: no light is computed; the mesh is skin, which takes the hair's light.
    bool off, skin;
} ScatterOptions;

typedef struct RendererOptions {
    Raster raster;        // auto: blocks with CPU drivers, compute otherwise
    int width, height;    // px; images larger than a framebuffer are drawn as tiles
    float background[4];  // sRGB and opacity: 0, 1, or without a tone curve between; below 1 the
                          // images have an alpha channel
    bool backdrop;        // the environment is the background (backdrop.h); `background` is opaque
    float exposure;       // EV: factor 2^exposure of all light except that of `background`
    Tone tone;            // tone curve of all light except that of `background`
    ImageKind kind;       // of the images
    Aov aov;              // auxiliary image that replaces light, on black (docs/look.md)
    float depth_range[2]; // AOV_DEPTH: m that are shown as 1 and as 0; if equal: depths in m
    int samples; // 1, 2 or 4 along each axis of a pixel, which is the mean of its samples; each
                 // sample has its own list of fragments; 0: 1. AOVs of the nearest ribbon have one
                 // sample
    uint32_t seed; // of random variations by strand
    ShadowOptions shadow;
    ScatterOptions scatter; // needs deep shadow maps
    Floor floor;            // not with an AOV
    MeshShading mesh_shading;
    LodOptions lod;
    Oit oit; // how the fragments of a pixel are blended; auto: abuffer. Others than auto make
             // raster auto choose quads
    float least_seen;    // blocks: a ribbon is shaded only if it is visible in at least this share
                         // of a pixel, 0 .. 0.5
    float ribbon_length; // blocks: longest ribbon in samples' px for which points of a strand are
                         // left out, 0 .. 64
    int oit_layers;      // abuffer: number of layers in order, 1 .. 64; 0: 8, with two samples 16
    int64_t pool_bytes;  // maximum size of the A-buffer; 0: the driver's limit
} RendererOptions;

// Options from the parameters of a run. Exposure, tone, kind, AOV, floor and the mesh's shading
// depend on more than the parameters; they stay 0.
RendererOptions renderer_options_of(const RunParams *run);

// The channels of images that are drawn with these parameters: 4 with a transparent background, 3
// otherwise. Images of an AOV are opaque.
int renderer_options_channels(const RunParams *run);

// Hair to be drawn. The material is that of its section; `radius` is the fibre radius at the root
// in metres (paint_auto_radius where the section has none). `head`: where the hair's head is; NULL:
// at the origin.
typedef struct RenderItem {
    const Hair *hair;
    const SectionParams *material;
    float radius;
    const HeadPose *head;
} RenderItem;

// Ambient light: an environment times a factor, or, where that is NULL, sRGB 0..1 from above (+y)
// and from below, interpolated between them.
typedef struct Ambient {
    float sky[3], ground[3];
    const Environment *environment;
    EnvironmentAxes axes;
    float strength;
} Ambient;

// Data that all items of an image share.
typedef struct RenderFrame {
    const View *view; // made for the renderer's width and height
    const Light *lights;
    uint32_t light_count;      // 0 .. SCENE_MAX_LIGHTS
    const Ambient *ambient;    // NULL: white
    float head_rotation[4];    // quaternion x y z w: the mesh's frame -> world
    float head_translation[3]; // m
    uint64_t revision; // changes whenever hair moves; shadows are kept while it stays the same and
                       // is not 0
} RenderFrame;

// Counts of the last image, for the statistics.
typedef struct RendererCounts {
    uint64_t segments;  // sent to the rasteriser; straight runs count as one
    uint64_t culled;    // strands outside the image, which cost no drawing
    uint64_t hidden;    // strands behind mesh or floor that were not drawn
    uint64_t fragments; // stored and blended: with quads pairs of a ribbon and a pixel; with blocks
                        // and compute pairs of a ribbon and a block or tile of pixels
    uint64_t pool_bytes; // of the A-buffer or the lists now
    uint32_t
        redraws;    // bands that were drawn again because the A-buffer or the lists were too small
    uint32_t bands; // horizontal bands that the image was drawn in
    uint64_t thinned;     // strands that are left out by level of detail
    uint32_t shadow_maps; // maps made for this image; 0 if those of the last image are reused
} RendererCounts;
