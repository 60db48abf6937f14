// SPDX-License-Identifier: MIT
// The room library: the functions of tractrix.h, for other programs. They call the other rooms and
// return results and errors as values. The library prints nothing, never ends the process, and
// leaves the host's OpenGL context as tractrix.h says.
//
// This file: the structs behind the handles, and functions that the files of this room share.
// Devices and simulations count their users: a child keeps its parent alive.
#pragma once

#include "library/tractrix.h"

#include "base/c_locale.h"
#include "base/error.h"
#include "gpu/gpu.h"
#include "run/images.h"
#include "scene/driven_head.h"
#include "scene/scene.h"
#include "sim/gather.h"

#include <pthread.h>
#include <stdatomic.h>
#include <sys/types.h>

// --- Calls.

static inline void library_leave(const locale_t *before)
{
    c_locale_leave(*before);
}

// The first statement of each public function: until the function returns, the calling thread has
// the "C" locale, whatever locale the host has chosen.
#define LIBRARY_CALL                                                                               \
    __attribute__((cleanup(library_leave), unused)) const locale_t library_before = c_locale_enter()

// --- Errors and structs of callers.

// Converts a result to the TractrixResult that a public function returns. If it is an error, copies
// its text to `to`; `to` may be NULL.
TractrixResult library_end(Result result, const Error *error, TractrixError *to);

// Returns TRACTRIX_USAGE and writes a text, printf style, to `to`; `to` may be NULL.
TractrixResult library_refuse(TractrixError *to, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

// Copies a caller's struct to `to`, which has the `size` bytes of this version. The first member of
// `from` says how many bytes `from` has; members that it lacks become 0. RESULT_USAGE, naming
// `name`, if `from` is NULL or has fewer than `least` or more than `size` bytes.
Result library_take(void *to, size_t size, const void *from, size_t least, const char *name,
                    Error *error);
// Copies a struct back to the caller's struct `to`, whose first member says how many bytes it has.
// Only the members that fit are copied; that first member is kept.
void library_give(void *to, const void *from);

// --- Images.

// Copies and checks a caller's image. Afterwards to->row_bytes is never 0. RESULT_USAGE, naming
// `name`, if a member is wrong.
Result library_take_image(TractrixImage *to, const TractrixImage *image, const char *name,
                          Error *error);
// Copies the pixels of `image` to the caller's image, which must have the same size and kind. If
// `image` has no alpha, the pixels become opaque.
void library_put_image(const TractrixImage *to, const Image *image);
// Makes an image with the caller's pixels, without an alpha channel if all pixels are opaque.
// RESULT_BAD_INPUT, naming `name`, if a float is not finite; RESULT_FAILED when memory is short.
Result library_copy_image(Image *to, const TractrixImage *from, const char *name, Error *error);

// --- Devices.

typedef Result LibraryWork(void *data, Error *error);

// Exposures that have been measured on a device, by fingerprint_of_scene. The oldest one is
// replaced.
enum { LIBRARY_EXPOSURES = 64 };
typedef struct LibraryExposure {
    uint64_t scene;
    float value; // EV
} LibraryExposure;

struct TractrixDevice {
    Gpu gpu;
    bool borrowed;
    LibraryExposure exposures[LIBRARY_EXPOSURES];
    uint32_t exposure_count;    // of all that were measured
    TractrixProgress *progress; // NULL: none
    void *progress_data;
    atomic_int users; // the handle and its children
    pid_t process;    // the process that opened the device
    // Only if the device is not borrowed: its thread, and the work that the thread is to do.
    pthread_t thread;
    pthread_mutex_t mutex;
    pthread_cond_t changed;
    LibraryWork *work; // NULL: none
    void *data;
    Error *error;
    Result result;
    bool done, ends;
};

// Calls `work` on the thread on which the device's context is current, and waits until it returns.
// RESULT_NO_GL if a borrowed device's context is gone, or in a child process after fork().
Result library_on_device(TractrixDevice *device, LibraryWork *work, void *data, Error *error);
void library_keep_device(TractrixDevice *device);
void library_drop_device(TractrixDevice *device);

// --- Parameters.

// Finds a parameter that callers may set. NULL if there is none of this name.
const ParamInfo *library_parameter(const char *name);

// RESULT_USAGE for a name without a parameter, with a similar name if there is one.
Result library_refuse_name(const char *name, Error *error);

// Whether tractrix_simulation_set may change the parameter.
bool library_is_live(const ParamInfo *info);

// Whether it is also one of drawing alone.
bool library_is_look(const ParamInfo *info);

// --- Scenes.

// Hair that a caller has passed as an array.
typedef struct LibraryArray {
    char *name;
    Strands strands;
} LibraryArray;

// A change that the caller has made to a scene. A scene keeps its changes in order, so that
// library_copy_scene can make the scene again.
typedef struct LibraryStep {
    const ParamInfo *info; // the parameter that is set; NULL: a section is added
    int section;           // if a parameter is set: as for tractrix_scene_set
    char *text;            // if a parameter is set: its value
    uint32_t array;        // if a section is added: its hair is arrays[array]
} LibraryStep;

struct TractrixScene {
    Scene scene; // the scene after all changes
    char *path, *json, *folder, *look;
    LibraryArray *arrays;
    uint32_t array_count;
    LibraryStep *steps;
    uint32_t step_count;
    GivenMesh meshes[SCENE_MAX_BODIES]; // of each body, from arrays; without vertices: none
};

// Makes a copy of the scene, which the caller must destroy, also after an error. The copy's hair
// and mesh from arrays are not copied: `from` still owns them and must outlive the copy's use of
// them.
Result library_copy_scene(Scene *scene, const TractrixScene *from, Error *error);

// --- Simulations.

// The positions of a section's guides or followers, for the caller. In `size` and `position`
// strands have the order of TractrixPositions; in `first` they have the order of the batches of
// Hair.
typedef struct LibraryMap {
    uint32_t strand_count, vertex_count;
    uint32_t *size;       // [strand_count]: vertices of each strand
    uint32_t *first;      // [strand_count]: index in `position` of each strand's first vertex
    float (*position)[4]; // [vertex_count]
    Gather gather;        // copies positions to the caller's OpenGL buffers
} LibraryMap;

// Where the caller wants a body to be at the end of the next frame.
typedef struct LibraryPlace {
    bool posed; // `head` counts
    RigidMotion head;
    float (*mesh)[3]; // [vertices of the body's mesh], owned; NULL: not given
} LibraryPlace;

struct TractrixSimulation {
    TractrixDevice *device;
    atomic_int users;
    Scene scene;
    Assets assets;
    GpuTimer timer;
    Simulation simulation;
    char *messages;
    size_t messages_size;
    LibraryMap *maps;                    // [2 * sections]: guides and followers of each section
    DrivenHead driven[SCENE_MAX_BODIES]; // heads that the caller moves
    LibraryPlace next[SCENE_MAX_BODIES];
    bool is_driven[SCENE_MAX_BODIES]; // the caller has placed the body
    uint64_t aims;                    // how often a camera parameter was changed
    uint64_t looks;                   // how often a parameter of drawing alone was changed
    uint64_t exposures;               // how often the exposure was
};

// Free the simulation's maps: library_end_copies frees the GPU's objects and needs the device's
// context; library_unmap, called after it, frees memory.
void library_end_copies(TractrixSimulation *simulation);
void library_unmap(TractrixSimulation *simulation);

void library_keep_simulation(TractrixSimulation *simulation);
void library_drop_simulation(TractrixSimulation *simulation);
