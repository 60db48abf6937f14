// SPDX-License-Identifier: MIT
// The room library: Tractrix for other programs. It takes calls of tractrix.h and hands on what the
// other rooms make of them, as values: no output, no exit, nothing of the host's changed.
//
// This file: what the handles are. Each is counted: a child keeps its parent.
#pragma once

#include "library/tractrix.h"

#include "base/error.h"
#include "gpu/gpu.h"
#include "run/images.h"
#include "scene/driven_head.h"
#include "scene/scene.h"
#include "sim/gather.h"

#include <pthread.h>
#include <stdatomic.h>
#include <sys/types.h>

// --- Errors and structs of callers.

// What a function returns: the result, its line in `to`.
TractrixResult library_end(Result result, const Error *error, TractrixError *to);

// TRACTRIX_USAGE in the words of printf.
TractrixResult library_refuse(TractrixError *to, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

// A caller's struct as this version has it: `from` has as many bytes as its first member says, and
// what it lacks is 0. RESULT_USAGE with `name` if it is NULL, or its size is less than `least` or
// more than `size`.
Result library_take(void *to, size_t size, const void *from, size_t least, const char *name,
                    Error *error);
// The struct given back to a caller who knows as much of it as `size` says.
void library_give(void *to, const void *from);

// --- Images.

// A caller's image, checked; row_bytes is not 0 then. RESULT_USAGE with `name`.
Result library_take_image(TractrixImage *to, const TractrixImage *image, const char *name,
                          Error *error);
// The pixels of an image of the same size and kind, opaque where it has no alpha.
void library_put_image(const TractrixImage *to, const Image *image);
// The pixels as an image, without alpha if all are opaque. RESULT_FAILED when memory is short.
Result library_copy_image(Image *to, const TractrixImage *from, Error *error);

// --- Devices.

typedef Result LibraryWork(void *data, Error *error);

struct TractrixDevice {
    Gpu gpu;
    bool borrowed;
    atomic_int users; // the handle and its children
    pid_t process;    // that opened it
    // Of an own device: its thread, and what it is to do.
    pthread_t thread;
    pthread_mutex_t mutex;
    pthread_cond_t changed;
    LibraryWork *work; // NULL: nothing
    void *data;
    Error *error;
    Result result;
    bool done, ends;
};

// Calls `work` where the device's context is current, and waits for it. RESULT_NO_GL if there is
// none, or after fork().
Result library_on_device(TractrixDevice *device, LibraryWork *work, void *data, Error *error);
void library_keep_device(TractrixDevice *device);
void library_drop_device(TractrixDevice *device);

// --- Parameters.

// The row of a parameter that callers may set; NULL: there is none.
const ParamInfo *library_parameter(const char *name);
bool library_is_live(const ParamInfo *info);

// --- Scenes.

// Hair or a mesh that a caller has handed over.
typedef struct LibraryArray {
    char *name;
    Strands strands;
} LibraryArray;

// What has been done to a scene, in order, so that it can be made again.
typedef struct LibraryStep {
    const ParamInfo *info; // scene_set; NULL: a section is added, of ...
    int section;
    char *text;
    uint32_t array; // ... arrays[array]
} LibraryStep;

struct TractrixScene {
    Scene scene; // as it is now
    char *path, *json, *folder, *look;
    LibraryArray *arrays;
    uint32_t array_count;
    LibraryStep *steps;
    uint32_t step_count;
    GivenMesh mesh; // empty: none
};

// The scene once more, all of it the caller's but for what is handed over, which stays the scene's.
// May be destroyed in either case.
Result library_copy_scene(Scene *scene, const TractrixScene *from, Error *error);

// --- Simulations.

// Positions that are mapped: of a section's guides or followers.
typedef struct LibraryMap {
    uint32_t strand_count, vertex_count;
    uint32_t *size;       // [strand_count], vertices, in the order that callers know
    uint32_t *first;      // [strand_count]: where the strands of the batches, one behind the other,
                          // begin in ...
    float (*position)[4]; // ... [vertex_count]
    Gather gather;        // to the caller's buffers
} LibraryMap;

struct TractrixSimulation {
    TractrixDevice *device;
    atomic_int users;
    Scene scene;
    Assets assets;
    GpuTimer timer;
    Simulation simulation;
    char *messages;
    size_t messages_size;
    LibraryMap *maps;  // [2 * sections]
    DrivenHead driven; // by callers
    uint64_t aims;     // changes of the camera's parameters
};

// Frees what maps hold: where the context is current what is the GPU's, then the rest.
void library_end_copies(TractrixSimulation *simulation);
void library_unmap(TractrixSimulation *simulation);

void library_keep_simulation(TractrixSimulation *simulation);
void library_drop_simulation(TractrixSimulation *simulation);
