// SPDX-License-Identifier: MIT
#include "formats/mesh_read.h"

#include "formats/foreign.h"
#include "formats/obj.h"
#include "formats/ply_mesh.h"

static Result refuse_foreign(const char *path, const Bytes *bytes, Error *error)
{
    const ForeignFile *foreign = foreign_find(bytes->data, bytes->size);
    if (!foreign) return RESULT_OK;
    return error_set(error, RESULT_BAD_INPUT, "%s: %s, not a mesh: %s", path, foreign->name,
                     foreign->mesh);
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
