// SPDX-License-Identifier: MIT
// A scene's files: hair of all sections, the mesh, and the light from around.
#pragma once

#include "mesh/mesh.h"
#include "scene/environment.h"
#include "scene/scene.h"
#include "strands/strands_read.h"

typedef struct Assets {
    uint32_t section_count;
    Strands *strands;       // [section_count]
    StrandsReport *reports; // [section_count]
    Mesh mesh;              // empty if the scene has none; of a sequence: at time 0
    bool has_mesh;
    Environment environment; // empty if the scene has none
    Body *body;              // of a mesh that deforms, owned; NULL: none
} Assets;

// Reads everything that the scene names. A mesh that deforms moves the scene's head
// (scene->head.samples) and is its body, as long as the assets are there; strands lie on it as at
// time 0. What was mended, and units that were guessed (if
// `verbose`), are printed on `messages` (NULL: not). Errors as strands_read and mesh_read give
// them; the assets may be destroyed in each case.
Result assets_load(Assets *assets, Scene *scene, FILE *messages, bool verbose, Error *error);
void assets_destroy(Assets *assets);

// --check: reads every section's file and prints its report, or why it can't be read, on `stream`.
// RESULT_OK if all are clean, RESULT_FAILED if any has defects, RESULT_BAD_INPUT if any can't be
// read; everything is printed, `error` is not needed.
Result assets_check(const Scene *scene, FILE *stream);
