// SPDX-License-Identifier: MIT
// Animated meshes as NumPy arrays: .npz with `positions` (F, V, 3), `faces` (T, 3) or (T, 4) and
// the scalars `fps`, `unit` (metres) and `up` ('y' or 'z'); .npy with only the positions. Positions
// may be integers, so that a small `unit` makes a small file.
#include "formats/mesh_sequence.h"
#include "formats/npy_array.h"
#include "formats/zip.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool match_npz(const char *path, const Bytes *bytes)
{
    (void)path;
    return bytes->size >= 4 && memcmp(bytes->data, "PK\3\4", 4) == 0;
}

static bool match_npy(const char *path, const Bytes *bytes)
{
    (void)path;
    return bytes->size >= 6 && memcmp(bytes->data, "\x93NUMPY", 6) == 0;
}

static void take_positions(MeshSamples *samples, Reader *reader, const NpyArray *array)
{
    const uint64_t *shape = array->shape;
    if (array->axes != 3 || shape[2] != 3 || !npy_array_is_number(array) || array->kind == 'b') {
        char text[200];
        npy_array_describe(array, text, sizeof text);
        reader_fail(reader, "positions have shape %s: expected (samples, vertices, 3) numbers",
                    text);
        return;
    }
    if (samples->position) return; // the archive has two arrays of this name
    samples->count = shape[0];
    samples->vertex_count = shape[1];
    if (mesh_samples_create(samples, reader)) npy_array_copy(array, samples->position[0]);
}

static void take_faces(MeshSamples *samples, Reader *reader, const NpyArray *array)
{
    uint64_t corners = array->axes == 2 ? array->shape[1] : 0, faces = array->shape[0];
    bool whole = array->kind == 'i' || array->kind == 'u';
    if (!whole || (corners != 3 && corners != 4) || faces == 0 || faces > UINT32_MAX / 16) {
        char text[200];
        npy_array_describe(array, text, sizeof text);
        reader_fail(reader, "faces have shape %s: expected (faces, 3) or (faces, 4) whole numbers",
                    text);
        return;
    }
    if (samples->triangle) return;
    samples->triangle_count = faces * (corners - 2);
    samples->triangle = reader_calloc(reader, samples->triangle_count, sizeof *samples->triangle);
    if (!samples->triangle) {
        reader_fail_memory(reader);
        return;
    }
    for (uint64_t f = 0, t = 0; f < faces && reader_ok(reader); ++f)
        for (uint64_t c = 2; c < corners; ++c, ++t) {
            const uint64_t of[3] = {0, c - 1, c};
            for (int i = 0; i < 3; ++i) {
                // In Fortran order the elements of a row are `faces` apart.
                uint64_t at = array->fortran ? of[i] * faces + f : f * corners + of[i];
                double corner = npy_array_number(array, at);
                if (!(corner >= 0 && corner < 4294967295.0))
                    reader_fail(reader, "face %llu has corner %g: expected a vertex's number",
                                (unsigned long long)f, corner);
                else
                    samples->triangle[t][i] = (uint32_t)corner;
            }
        }
}

static void take_number(double *number, Reader *reader, const NpyArray *array, const char *name)
{
    double value = npy_array_is_number(array) && array->count == 1 ? npy_array_number(array, 0) : 0;
    if (!(value >= 1e-9 && value <= 1e9))
        reader_fail(reader, "'%s': expected one number from 1e-9 to 1e9", name);
    else
        *number = value;
}

static void take_up(MeshSamples *samples, Reader *reader, const NpyArray *array)
{
    uint32_t wide = array->kind == 'U' ? 4 : 1;
    bool text = !npy_array_is_number(array) && array->count == 1 && array->item == wide;
    char c = text ? (char)array->data[array->big ? wide - 1 : 0] : 0;
    if (!c || !strchr("yzYZ", c))
        reader_fail(reader, "'up': expected 'y' or 'z'");
    else
        samples->up_z = c == 'z' || c == 'Z';
}

static void take_array(MeshSamples *samples, Reader *reader, const NpyArray *array,
                       const char *name)
{
    if (strcmp(name, "positions.npy") == 0) take_positions(samples, reader, array);
    if (strcmp(name, "faces.npy") == 0) take_faces(samples, reader, array);
    if (strcmp(name, "fps.npy") == 0) take_number(&samples->rate, reader, array, "fps");
    if (strcmp(name, "unit.npy") == 0) take_number(&samples->unit, reader, array, "unit");
    if (strcmp(name, "up.npy") == 0) take_up(samples, reader, array);
}

static bool is_known(const char *name)
{
    static const char *const names[] = {"positions.npy", "faces.npy", "fps.npy", "unit.npy",
                                        "up.npy"};
    for (size_t i = 0; i < sizeof names / sizeof *names; ++i)
        if (strcmp(name, names[i]) == 0) return true;
    return false;
}

static void read_member(MeshSamples *samples, Reader *reader, Zip *zip, const ZipFile *file)
{
    char path[1200];
    Bytes content;
    uint8_t *owned = NULL;
    NpyArray array;
    if (!is_known(file->name)) return;
    if (zip_read(zip, file, &content, &owned) != RESULT_OK) {
        free(owned);
        return;
    }
    snprintf(path, sizeof path, "%s: %s", reader->path, file->name);
    Reader inner = reader_begin_inner(reader, path, &content);
    if (npy_array_read(&array, &inner) == RESULT_OK)
        take_array(samples, &inner, &array, file->name);
    reader_end_inner(reader, &inner);
    free(owned);
}

static void read_npz(MeshSamples *samples, Reader *reader)
{
    Zip zip;
    zip_open(&zip, reader);
    for (uint32_t i = 0; i < zip.count && reader_ok(reader); ++i)
        read_member(samples, reader, &zip, &zip.file[i]);
    if (reader_ok(reader) && !samples->position)
        reader_fail(reader, "no array 'positions': expected (samples, vertices, 3)");
    zip_close(&zip);
}

static void read_npy(MeshSamples *samples, Reader *reader)
{
    NpyArray array;
    if (npy_array_read(&array, reader) == RESULT_OK) take_positions(samples, reader, &array);
}

const MeshSequenceFormat MESH_SEQUENCE_NPZ = {.match = match_npz, .read = read_npz};
const MeshSequenceFormat MESH_SEQUENCE_NPY = {.match = match_npy, .read = read_npy};
