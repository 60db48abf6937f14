// SPDX-License-Identifier: MIT
#include "mesh/mesh_read.h"

#include "mesh/obj.h"
#include "mesh/ply_mesh.h"

#include <string.h>

#define BAKE                                                                                       \
    "bake it: blender -b --python scripts/blender_hair.py -- export FILE --mesh x.npz --frames "   \
    "scene (installed: /usr/share/tractrix/blender_hair.py)"

// Files that are often taken for meshes and how to make a mesh of them, by their first bytes.
static const struct {
    const char *begin, *name, *advice;
} FOREIGN[] = {
    {"glTF", "GLB", BAKE},
    {"Kaydara FBX", "FBX", BAKE},
    {"BLENDER", "a Blender file (.blend)", BAKE},
    {"PXR-USDC", "binary USD (.usdc)", "usdcat FILE -o x.usda"},
    {"\x89HDF", "HDF5, as in old Alembic files (.abc)", "abcconvert -toOgawa FILE x.abc"},
};

static Result refuse_foreign(const char *path, const Bytes *bytes, Error *error)
{
    for (size_t i = 0; i < sizeof FOREIGN / sizeof *FOREIGN; ++i) {
        size_t length = strlen(FOREIGN[i].begin);
        if (bytes->size >= length && memcmp(bytes->data, FOREIGN[i].begin, length) == 0)
            return error_set(error, RESULT_BAD_INPUT, "%s: %s, not a mesh: %s", path,
                             FOREIGN[i].name, FOREIGN[i].advice);
    }
    return RESULT_OK;
}

Result mesh_read(Mesh *mesh, const char *path, float unit, bool up_z, Error *error)
{
    Bytes bytes;
    *mesh = (Mesh){0};
    TRY(bytes_read_file(&bytes, path, error));
    Result result = refuse_foreign(path, &bytes, error);
    if (result != RESULT_OK) {
        bytes_destroy(&bytes);
        return result;
    }
    if (ply_mesh_matches(&bytes)) {
        result = ply_mesh_read(mesh, path, &bytes, unit, up_z, error);
    } else {
        bytes_drop_mark(&bytes);
        result = obj_read_mesh_bytes(mesh, path, &bytes, unit, up_z, error);
    }
    bytes_destroy(&bytes);
    return result;
}
