// SPDX-License-Identifier: MIT
// The files of a scene: hair of all sections, the mesh and the environment image.
#pragma once

#include "formats/strands_read.h"
#include "mesh/mesh.h"
#include "scene/environment.h"
#include "scene/scene.h"

typedef struct Assets {
    uint32_t section_count;
    Strands *strands;       // [section_count]
    StrandsReport *reports; // [section_count]
    StrandsFrames *frames;  // [section_count] of the sections that are played; otherwise empty
    int first_number;       // where the animated mesh or hair begins, in its file's frames; 0 if
                            // nothing says so
    uint32_t body_count;
    Mesh *meshes;            // [body_count]; empty if there is none; of a sequence: at time 0
    Body *bodies;            // [body_count], the deforming meshes; zero if there is none
    Environment environment; // empty if there is none
} Assets;

// Reads all files that the scene names. A deforming mesh becomes its body's shape and moves its
// head (SceneBody.head.samples) as long as the assets exist; strands lie on it as at time 0. The
// material in a hair file becomes the default of elastic sections (section_is_elastic). Prints what
// was mended and, if `verbose`, guessed units on `messages` (NULL: does not print). Errors of
// strands_read and mesh_read.
//
// Animated hair: with scene->plays, a section of --algo none (which is then the default of an
// animated file) is played: Section.frames has the frames, and frames and fps of the run are the
// file's unless they are given. Otherwise the hair is that of --hair-frame. Sets run.frame_number
// to first_number if it is automatic, and then run.first and run.last to places from 0.
// RESULT_USAGE if they are not among the frames; the assets may be destroyed after an error.
Result assets_load(Assets *assets, Scene *scene, FILE *messages, bool verbose, Error *error);
void assets_destroy(Assets *assets);

// Implements --check: reads the file of every section and prints its report, or the reason why it
// cannot be read, on `stream`. RESULT_OK if all are clean, RESULT_FAILED if any has defects,
// RESULT_BAD_INPUT if any cannot be read. Everything is printed, so there is no `error`.
Result assets_check(const Scene *scene, FILE *stream);
