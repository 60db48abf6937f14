// SPDX-License-Identifier: MIT
// Files of other kinds that are often given for hair or for a mesh.
#pragma once

#include <stddef.h>

typedef struct ForeignFile {
    const char *begin; // the first bytes
    const char *name;
    const char *hair, *mesh; // how to make hair or a mesh of it; FILE stands for its path
} ForeignFile;

// The kind of file that begins with these `size` bytes; NULL: none that is known.
const ForeignFile *foreign_find(const void *data, size_t size);

// What makes hair of files that Blender opens.
#define FOREIGN_BLENDER_HAIR                                                                       \
    "convert it: blender -b --python scripts/blender_hair.py -- export FILE -o x.npz (installed: " \
    "/usr/share/tractrix/blender_hair.py)"
