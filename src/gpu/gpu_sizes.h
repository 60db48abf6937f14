// SPDX-License-Identifier: MIT
// Work sizes by kind of device, in one table for all shaders.
#pragma once

// The kind of device, for decisions.
typedef enum GpuKind {
    GPU_CPU_DRIVER, // few threads, each with a vector of lanes
    GPU_HARDWARE,   // warps or waves of 32 or 64 lanes; thousands of lanes in flight
    GPU_KINDS
} GpuKind;

// Lanes per work group.
typedef struct GpuSizes {
    int strands; // shaders with one strand per lane
    int items;   // shaders with one texel, cell or triangle per lane
    int sort;    // compute_sort.comp; also the number of pairs sorted at once
    int pixels;  // compute_composite.comp: pixels per lane, 1 or 4
    int stages;  // compute_composite.comp: 1 if ribbons are unpacked into shared memory
} GpuSizes;

extern const GpuSizes GPU_SIZES[GPU_KINDS];
