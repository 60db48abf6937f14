// SPDX-License-Identifier: MIT
// The room gpu: OpenGL without windows. It takes a driver (EGL or OSMesa) and the shaders of glsl/,
// and hands on a context (this file), buffers, timers and built programs (shader.h).
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
    const char *device;    // as gpu_device_is has it; NULL or "": the best one
    bool software;         // only CPU drivers
    bool require_hardware; // no CPU driver
    FILE *debug;           // KHR_debug context, whose messages go here; NULL: an ordinary one
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

// A current context. Everything else calls GL only while one exists, on the thread that made it; a
// thread has one at a time.
typedef struct Gpu {
    GpuLimits limits;
    bool software;       // a CPU driver, judged by GL_RENDERER
    int ulps;            // by which its maths is made wrong; 0: as it is
    GpuKind kind;        // what decisions go by: of `software`, unless hardware is assumed
    char renderer[256];  // GL_RENDERER
    char version[256];   // GL_VERSION
    char vendor[128];    // GL_VENDOR
    char processor[256]; // the CPU's name: images and times of a CPU driver depend on it
    char path[64];       // the way in: "EGL device 0", "EGL surfaceless", "OSMesa"
    char platform[PLATFORM_BYTES];
    Error passed_over; // why hardware was not taken, if there are signs of any and this is a
                       // CPU driver that nobody asked for; "": no
    GpuIdentity identity;
    EglContext egl;               // zeroed: not by EGL, or borrowed
    struct GpuOsMesa *osmesa;     // NULL: not by OSMesa
    struct GpuUniforms *uniforms; // owned
    // Owned: what scenes share that are simulated and drawn one after the other, or side by side.
    Stock *programs; // shaders that are built (shader.h)
    Stock *tables;   // of shading (draw/scatter_tables.h)
} Gpu;

// Makes a context and makes it current, as the environment's assumptions have it (gpu/assume.h).
// Order: EGL devices, hardware before software; EGL surfaceless; OSMesa. RESULT_NO_GL with one line
// that says what was tried, why it failed and which package helps.
Result gpu_create(Gpu *gpu, const GpuOptions *options, Error *error);
void gpu_destroy(Gpu *gpu);

// The same where the context is gone with all that it had: frees memory alone.
void gpu_lose(Gpu *gpu);

// The same for a context of somebody else's that is current on this thread, by EGL or GLX: it stays
// his. RESULT_NO_GL if there is none, or it offers too little.
Result gpu_borrow(Gpu *gpu, Error *error);

// Of a borrowed context: what is called between them are this program's calls. gpu_enter fails with
// RESULT_NO_GL if no context is current; it forgets errors and bindings that were there.
// gpu_leave puts defaults back that drawing changes (tractrix_device_borrow).
Result gpu_enter(const Gpu *gpu, Error *error);
void gpu_leave(void);

// Prints each EGL device and other way in: number, renderer, version, and below them vendor, PCI
// address, UUID, memory and node as far as they are known; or why it can't be used. RESULT_NO_GL if
// none works.
Result gpu_list_devices(FILE *stream, Error *error);
