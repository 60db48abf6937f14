// SPDX-License-Identifier: MIT
// Sizes of work by the kind of device: one table for all shaders.
#pragma once

// What decisions go by.
typedef enum GpuKind {
    GPU_CPU_DRIVER, // few threads, each with a vector of lanes
    GPU_HARDWARE,   // warps or waves of 32 or 64 lanes, thousands of lanes in flight
    GPU_KINDS
} GpuKind;

// Lanes of a work group.
typedef struct GpuSizes {
    int strands; // of shaders that give a lane a strand
    int items;   // of shaders that give a lane a texel, a cell or a triangle
    int sort;    // of compute_sort.comp: as many pairs are sorted at once
    int pixels;  // of a lane of compute_composite.comp: 1 or 4
    int stages;  // 1: that shader unpacks ribbons into shared memory
} GpuSizes;

extern const GpuSizes GPU_SIZES[GPU_KINDS];
