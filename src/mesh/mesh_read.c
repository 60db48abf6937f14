// SPDX-License-Identifier: MIT
#include "mesh/mesh_read.h"

#include "mesh/obj.h"
#include "mesh/ply_mesh.h"

Result mesh_read(Mesh *mesh, const char *path, float unit, bool up_z, Error *error)
{
    Bytes bytes;
    *mesh = (Mesh){0};
    TRY(bytes_read_file(&bytes, path, error));
    Result result = RESULT_OK;
    if (ply_mesh_matches(&bytes)) {
        result = ply_mesh_read(mesh, path, &bytes, unit, up_z, error);
    } else {
        bytes_drop_mark(&bytes);
        result = obj_read_mesh_bytes(mesh, path, &bytes, unit, up_z, error);
    }
    bytes_destroy(&bytes);
    return result;
}
