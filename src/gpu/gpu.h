// SPDX-License-Identifier: MIT
// The room gpu: OpenGL without windows. Input: a driver (EGL or OSMesa) and the shaders of glsl/.
// Output: a context (this file), buffers, timers and programs (shader.h).
//
// This file: the context, 4.3 core or better, by EGL without a window system or by OSMesa.
#pragma once

#include "base/error.h"
#include "base/params.h"
#include "base/stock.h"
#include "gpu/assume.h"
#include "gpu/gpu_device.h"
#include "gpu/gpu_egl.h"
#include "gpu/gpu_error.h"
#include "gpu/gpu_sizes.h"
#include "gpu/platform.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

typedef struct GpuOptions {
    Backend backend;
    const char *device;    // a name for gpu_device_is; NULL or "": the best device
    bool software;         // only CPU drivers
    bool require_hardware; // no CPU drivers
    FILE *debug;           // stream for the messages of a KHR_debug context; NULL: an ordinary
                           // context
} GpuOptions;

// Limits of the driver and sizes that suit it, read once after creating the context. Bytes unless
// stated otherwise.
typedef struct GpuLimits {
    int64_t storage_block;   // largest SSBO range that a shader can see
    int64_t texture_texels;  // largest buffer texture, in texels
    int framebuffer_side_px; // largest width and height
    int work_groups;         // side by side in one dispatch
    GpuSizes sizes;          // by the kind of device
} GpuLimits;

// A current context. All other functions call GL only while it exists, on the thread that created
// it; a thread has one at a time.
typedef struct Gpu {
    GpuLimits limits;
    bool software;       // a CPU driver, according to GL_RENDERER
    int ulps;            // artificial error of its maths; 0 if none
    GpuKind kind;        // kind for decisions; follows `software` unless hardware is assumed
    char renderer[256];  // GL_RENDERER
    char version[256];   // GL_VERSION
    char vendor[128];    // GL_VENDOR
    char processor[256]; // name of the CPU, which determines images and times of a CPU driver
    char path[64];       // how it was created: "EGL device 0", "EGL surfaceless", "OSMesa"
    char platform[PLATFORM_BYTES];
    // Why hardware was not used, if there are signs of it and this is a CPU driver that nobody
    // asked for; otherwise "".
    Error passed_over;
    GpuIdentity identity;
    EglContext egl;               // zeroed if not created by EGL, or borrowed
    struct GpuOsMesa *osmesa;     // NULL if not created by OSMesa
    struct GpuUniforms *uniforms; // owned
    // Owned: objects shared by scenes that are simulated and drawn in this context.
    Stock *programs; // built shaders (shader.h)
    Stock *tables;   // tables for shading (draw/scatter_tables.h)
} Gpu;

// Creates a context and makes it current, respecting the assumptions of the environment
// (gpu/assume.h). Tries EGL devices (hardware before software), then EGL surfaceless, then OSMesa.
// RESULT_NO_GL with one line that says what was tried, why it failed and which package helps.
Result gpu_create(Gpu *gpu, const GpuOptions *options, Error *error);
void gpu_destroy(Gpu *gpu);

// Like gpu_destroy, if the context and its objects no longer exist: only frees memory.
void gpu_lose(Gpu *gpu);

// Uses a context of the caller, current on this thread by EGL or GLX; the caller keeps it.
// RESULT_NO_GL if there is none, or if it offers too little.
Result gpu_borrow(Gpu *gpu, Error *error);

// For a borrowed context: between these two calls the program uses GL. gpu_enter discards pending
// errors and remembered bindings, and fails with RESULT_NO_GL if no context is current. The state
// of the context is saved and restored apart from this (gl_state.h).
Result gpu_enter(const Gpu *gpu, Error *error);
void gpu_leave(void);

// Prints each EGL device and other way to a context: number, renderer and version; below them
// vendor, PCI address, UUID, memory and node, if known; or why it cannot be used. RESULT_NO_GL if
// none works.
Result gpu_list_devices(FILE *stream, Error *error);
