// SPDX-License-Identifier: MIT
// The device behind a context: its identity, which distinguishes equal GPUs, and reasons why
// hardware cannot be used.
#pragma once

#include "base/error.h"

#include <stdbool.h>
#include <stdint.h>

// A device listed by EGL. Texts are empty if unknown.
typedef struct GpuDevice {
    void *egl;     // EGLDeviceEXT
    bool software; // claims to be a CPU driver
    char node[64]; // "/dev/dri/renderD128"
    char pci[32];  // "0000:01:00.0"
} GpuDevice;

enum { GPU_MOST_DEVICES = 32 };

typedef struct GpuDevices {
    GpuDevice device[GPU_MOST_DEVICES];
    int count;
} GpuDevices;

// The identity of a current context's device.
typedef struct GpuIdentity {
    char node[64], pci[32]; // as in GpuDevice
    char uuid[40];          // by GL_EXT_memory_object; "" if unknown
    int64_t memory;         // bytes of its own memory; 0 if unknown
} GpuIdentity;

// Finds the PCI address of a character device in `sys` ("/sys"); false if there is none.
bool gpu_device_find_pci(const char *sys, unsigned major, unsigned minor, char pci[32]);

// Fills in what the system knows about the device's node.
void gpu_device_look_up(GpuDevice *device);

// The identity of a context that is current by EGL. `device` is NULL if it does not belong to a
// listed device.
GpuIdentity gpu_device_identify(const GpuDevice *device);

// Whether `name` selects the device with this number, renderer and vendor: by number, by part of
// the renderer's or vendor's name (ignoring case), by PCI address (the domain 0000: is optional),
// by node, or by at least the first 4 characters of its UUID.
bool gpu_device_is(const char *name, int number, const char *renderer, const char *vendor,
                   const GpuIdentity *identity);

// Explains why EGL does not list a GPU of the system: this user may not open a node in `dev`
// ("/dev"), or a driver is not installed. Empty if there is no sign of a GPU.
void gpu_device_explain(const char *dev, Error *why);
