// SPDX-License-Identifier: MIT
// The room gpu: OpenGL without windows. It takes a driver (EGL or OSMesa) and the shaders of glsl/,
// and hands on a context (this file), buffers, timers and built programs (shader.h).
//
// This file: the context, 4.3 core or better, by EGL without a window system or by OSMesa.
#pragma once

#include "base/error.h"
#include "base/params.h"
#include "gpu/gpu_egl.h"
#include "gpu/gpu_sizes.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

typedef struct GpuOptions {
    Backend backend;
    int device;            // index as `gpu_list_devices` prints it; -1: the best one
    bool software;         // only CPU drivers
    bool require_hardware; // no CPU driver
    bool assume_hardware;  // a CPU driver is treated as hardware
    bool debug;            // KHR_debug context; messages go to stderr
} GpuOptions;

// What the driver allows, and what suits it, read once after the context is made. Bytes unless said
// otherwise.
typedef struct GpuLimits {
    int64_t storage_block;   // largest SSBO range that a shader can see
    int64_t texture_texels;  // largest buffer texture, in texels
    int framebuffer_side_px; // largest width and height
    int work_groups;         // side by side in a dispatch
    GpuSizes sizes;          // by the device's kind
} GpuLimits;

// A current context. Everything else in this program calls GL only while one exists, on the thread
// that made it.
typedef struct Gpu {
    GpuLimits limits;
    bool software;            // a CPU driver, judged by GL_RENDERER
    GpuKind kind;             // what decisions go by: of `software`, unless hardware is assumed
    char renderer[256];       // GL_RENDERER
    char version[256];        // GL_VERSION
    char vendor[128];         // GL_VENDOR
    char processor[256];      // the CPU's name: images and times of a CPU driver depend on it
    char path[64];            // the way in: "EGL device 0", "EGL surfaceless", "OSMesa"
    EglContext egl;           // zeroed: not by EGL
    struct GpuOsMesa *osmesa; // NULL: not by OSMesa
} Gpu;

// Makes a context and makes it current. Order: EGL devices, hardware before software; EGL
// surfaceless; OSMesa. RESULT_NO_GL with one line that says what was tried, why it failed and which
// package helps.
Result gpu_create(Gpu *gpu, const GpuOptions *options, Error *error);
void gpu_destroy(Gpu *gpu);

// Prints one line per EGL device and per other way in: index, renderer, version, or why it can't be
// used. RESULT_NO_GL if none works.
Result gpu_list_devices(FILE *stream, Error *error);

// RESULT_FAILED naming `what` if a GL error is pending (out of memory, ...). Waits for nothing.
Result gpu_check(const char *what, Error *error);
