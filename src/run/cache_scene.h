// SPDX-License-Identifier: MIT
// What a simulation depends on. Caches and saved states record it so that they are not used with
// another scene. Formats: docs/cache.md.
#pragma once

#include "base/bytes.h"
#include "sim/simulation.h"

// The scene's values that move the guides, as JSON: those of the groups Simulation and Forces, the
// head, keyed forces, colliders, a checksum of the mesh that hair collides with, and the program
// that made it. Not files (their contents are recorded below), the camera, looks, followers and the
// number of frames. RESULT_FAILED when memory is short.
Result cache_scene_describe(Bytes *text, const Simulation *simulation, Error *error);

// The program and driver that simulated: "made_by" in the text, or "unknown" in caches of early
// versions. To be freed; NULL when memory is short. The comparison below ignores it.
char *cache_scene_maker(const Bytes *text);

// The same for this process, whose context is current. Valid until the next call.
const char *cache_scene_own_maker(void);

// Compares such a text with the scene: RESULT_BAD_INPUT with `path`, the first key that differs,
// and both values.
Result cache_scene_compare(const Bytes *text, const Simulation *simulation, const char *path,
                           Error *error);

// The same comparison before there is a simulation. It leaves out what needs one: the meshes and
// whether hair collides with them.
Result cache_scene_compare_values(const Bytes *text, const Scene *scene, const char *path,
                                  Error *error);

// For each section: number of strands, a checksum of their vertices as loaded, runs of equal vertex
// counts, and the strands' numbers in their file, in the order of frames. Free with bytes_destroy.
// RESULT_FAILED when memory is short.
Result cache_scene_describe_hair(Bytes *bytes, const Simulation *simulation, const Strands *strands,
                                 Error *error);

// Compares such bytes with the simulation's hair: RESULT_BAD_INPUT with `path` and the first
// section's file that differs.
Result cache_scene_compare_hair(const Bytes *bytes, const Simulation *simulation,
                                const Strands *strands, const char *path, Error *error);

// The same comparison before there is a simulation. It leaves out what needs one: the order of the
// strands.
Result cache_scene_compare_strands(const Bytes *bytes, const Scene *scene, const Strands *strands,
                                   const char *path, Error *error);
