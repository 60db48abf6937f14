// SPDX-License-Identifier: MIT
// Contexts by EGL without a window system: the device platform, or Mesa's surfaceless platform.
#pragma once

#include "base/error.h"
#include "gpu/gpu_device.h"

#include <stdbool.h>

// EGL objects of a current context (EGLDisplay, EGLContext).
typedef struct EglContext {
    void *display, *context;
} EglContext;

// The devices listed by EGL, in its order. RESULT_NO_GL if libEGL is missing or cannot list
// devices.
Result gpu_egl_find_devices(GpuDevices *devices, Error *error);

// Creates a 4.3 core context on a device, or on the surfaceless platform if `device` is NULL, and
// makes it current without a surface. RESULT_NO_GL with the failed call and EGL's error in words.
Result gpu_egl_create(EglContext *egl, void *device, bool debug, Error *error);
// Destroys the context. The display stays initialised, because EGL shares it within the process and
// others may be using it (Mesa 22.3 has no EGL_KHR_display_reference).
void gpu_egl_destroy(EglContext *egl);
