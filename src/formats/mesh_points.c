// SPDX-License-Identifier: MIT
// Point caches, which modelling programs write beside a mesh: PC2 (the point cache of 3ds Max, also
// written by Blender) and MDD (LightWave). Neither contains faces. PC2 is little-endian:
// "POINTCACHE2", a zero byte, version, number of vertices, first frame, frames per sample, number
// of samples, positions. MDD is big-endian: number of samples, number of vertices, the samples'
// times, positions.
#include "formats/mesh_sequence.h"

#include <math.h>
#include <string.h>

static const char PC2_MAGIC[12] = "POINTCACHE2";

static bool match_pc2(const char *path, const Bytes *bytes)
{
    (void)path;
    return bytes->size >= sizeof PC2_MAGIC && memcmp(bytes->data, PC2_MAGIC, sizeof PC2_MAGIC) == 0;
}

static void read_pc2(MeshSamples *samples, Reader *reader)
{
    reader->at += sizeof PC2_MAGIC;
    uint32_t version = reader_read_u32(reader, "the version");
    samples->vertex_count = reader_read_u32(reader, "the count of vertices");
    reader_read_f32(reader, "the first frame");
    reader_read_f32(reader, "the frames a sample");
    samples->count = reader_read_u32(reader, "the count of samples");
    if (reader_ok(reader) && version != 1)
        reader_fail(reader, "version %u of PC2: expected 1", version);
    size_t at = reader->at;
    if (samples->count > 0 &&
        !reader_check_array(reader, at, samples->count * samples->vertex_count, 12,
                            "the positions"))
        return;
    if (mesh_samples_create(samples, reader))
        reader_copy_floats(reader, at, samples->position[0],
                           3 * samples->count * samples->vertex_count);
}

// MDD has no signature, so the file must have the right suffix and size.
static bool match_mdd(const char *path, const Bytes *bytes)
{
    size_t length = strlen(path);
    (void)bytes;
    return length > 4 &&
           (strcmp(path + length - 4, ".mdd") == 0 || strcmp(path + length - 4, ".MDD") == 0);
}

static uint32_t swap(uint32_t word)
{
    return word >> 24 | (word >> 8 & 0xff00) | (word << 8 & 0xff0000) | word << 24;
}

static float swapped_float(float number)
{
    uint32_t word;
    memcpy(&word, &number, 4);
    word = swap(word);
    memcpy(&number, &word, 4);
    return number;
}

static void read_mdd(MeshSamples *samples, Reader *reader)
{
    samples->count = swap(reader_read_u32(reader, "the count of samples"));
    samples->vertex_count = swap(reader_read_u32(reader, "the count of vertices"));
    size_t times = reader->at, at = times + 4 * samples->count;
    if (!reader_check_array(reader, times, samples->count, 4, "the samples' times") ||
        !reader_check_array(reader, at, samples->count * samples->vertex_count, 12,
                            "the positions"))
        return;
    if (!mesh_samples_create(samples, reader)) return;
    float first, last;
    reader_copy_floats(reader, times, &first, 1);
    reader_copy_floats(reader, at - 4, &last, 1);
    double span = (double)swapped_float(last) - (double)swapped_float(first);
    if (samples->count > 1 && span > 0 && isfinite(span))
        samples->rate = ((double)samples->count - 1) / span;
    size_t numbers = 3 * samples->count * samples->vertex_count;
    reader_copy_floats(reader, at, samples->position[0], numbers);
    float *number = samples->position[0];
    for (size_t i = 0; i < numbers; ++i) number[i] = swapped_float(number[i]);
}

const MeshSequenceFormat MESH_SEQUENCE_PC2 = {.match = match_pc2, .read = read_pc2};
const MeshSequenceFormat MESH_SEQUENCE_MDD = {.match = match_mdd, .read = read_mdd};
