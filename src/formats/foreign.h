// SPDX-License-Identifier: MIT
// Files of other kinds that users often pass as hair or as a mesh.
#pragma once

#include <stddef.h>

typedef struct ForeignFile {
    const char *begin; // the first bytes
    const char *name;
    const char *hair, *mesh; // how to convert it to hair or a mesh; FILE stands for its path
} ForeignFile;

// The kind of file that begins with these `size` bytes; NULL if unknown.
const ForeignFile *foreign_find(const void *data, size_t size);

// How to convert files that Blender opens to hair.
#define FOREIGN_BLENDER_HAIR                                                                       \
    "convert it: blender -b --python scripts/blender_hair.py -- export FILE -o x.npz (installed: " \
    "/usr/share/tractrix/blender_hair.py)"

// What a reader expected that got hair for a mesh, or a mesh for hair.
#define FOREIGN_WANTS_MESH "expected a mesh (tractrix-render takes hair without --mesh)"
#define FOREIGN_WANTS_HAIR "expected hair (pass a mesh with --mesh)"
