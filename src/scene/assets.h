// SPDX-License-Identifier: MIT
// A scene's files: hair of all sections, and the mesh.
#pragma once

#include "mesh/mesh.h"
#include "scene/scene.h"
#include "strands/strands_read.h"

typedef struct Assets {
    uint32_t section_count;
    Strands *strands;       // [section_count]
    StrandsReport *reports; // [section_count]
    Mesh mesh;              // empty if the scene has none
    bool has_mesh;
} Assets;

// Reads everything that the scene names. What was mended, and units that were guessed (if
// `verbose`), are printed on `messages` (NULL: not). Errors as strands_read and obj_read_mesh give
// them; the assets may be destroyed in each case.
Result assets_load(Assets *assets, const Scene *scene, FILE *messages, bool verbose, Error *error);
void assets_destroy(Assets *assets);

// --check: reads every section's file and prints its report, or why it can't be read, on `stream`.
// RESULT_OK if all are clean, RESULT_FAILED if any has defects, RESULT_BAD_INPUT if any can't be
// read; everything is printed, `error` is not needed.
Result assets_check(const Scene *scene, FILE *stream);
