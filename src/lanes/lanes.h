// SPDX-License-Identifier: MIT
// The room lanes draws hair in C, with vector units and threads, from positions in memory to the
// image: shadow maps (shadow.h), light among hair (scatter.h), mesh and floor (base.h), then the
// hair, which is projected (project.h), binned (bins.h) and composited block by block (raster.h).
// Points are shaded where they are seen (shade.h). The room does not know OpenGL.
#pragma once

#include "draw/backend.h"
#include "lanes/base.h"
#include "lanes/raster.h"
#include "lanes/scatter.h"
#include "lanes/shadow_points.h"

// Data of a batch that is kept from frame to frame.
typedef struct LaneBatch {
    LaneLook look;
    TintTable tints;
} LaneBatch;

typedef struct Lanes {
    BackendOptions set;
    const RendererOptions *options; // for a window
    ScatterOptions scatters;
    LaneShadow shadow;
    LaneScatter scatter;
    LaneBase base;
    Hidden hidden;
    bool draws_hidden; // also draws hidden ribbons, for tests
    ShadowPoints points;
    Projection projection;
    Shades shades;
    LaneRaster raster;
    LaneBatch *batches;    // [room], owned
    LaneHair *hair;        // [room], owned
    MappedCaster *casters; // [room], owned
    uint32_t room;
    LaneHairs hairs;
    LaneLight light;
} Lanes;
