// SPDX-License-Identifier: MIT
// Which device a context draws on: what tells equal GPUs apart, and why hardware cannot be used.
#pragma once

#include "base/error.h"

#include <stdbool.h>
#include <stdint.h>

// A device that EGL enumerates. Texts are empty where they are not known.
typedef struct GpuDevice {
    void *egl;     // EGLDeviceEXT
    bool software; // says of itself that it is a CPU driver
    char node[64]; // "/dev/dri/renderD128"
    char pci[32];  // "0000:01:00.0"
} GpuDevice;

enum { GPU_MOST_DEVICES = 32 };

typedef struct GpuDevices {
    GpuDevice device[GPU_MOST_DEVICES];
    int count;
} GpuDevices;

// What a current context says of its device.
typedef struct GpuIdentity {
    char node[64], pci[32]; // as GpuDevice has them
    char uuid[40];          // GL_EXT_memory_object; "": not known
    int64_t memory;         // bytes of the device's own; 0: not known
} GpuIdentity;

// The address of the PCI device behind a character device, as the folder `sys` ("/sys") has it;
// false: there is none.
bool gpu_device_find_pci(const char *sys, unsigned major, unsigned minor, char pci[32]);

// Fills in what the system says of the device's node.
void gpu_device_look_up(GpuDevice *device);

// What a context that is current by EGL says. `device` NULL: not of an enumerated one.
GpuIdentity gpu_device_identify(const GpuDevice *device);

// Whether `name` means the device of this number, renderer and vendor: its number, a part of its
// renderer's or vendor's name (case does not count), its PCI address (the domain 0000: may be left
// out), its node, or the beginning of its UUID, of 4 characters at least.
bool gpu_device_is(const char *name, int number, const char *renderer, const char *vendor,
                   const GpuIdentity *identity);

// Why a GPU that the system has is none of EGL's devices: a node of `dev` ("/dev") that this user
// may not open, a driver that is not installed. No text if there is no sign of a GPU.
void gpu_device_explain(const char *dev, Error *why);
