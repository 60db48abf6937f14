// SPDX-License-Identifier: MIT
// A mesh that deforms: its vertices' positions at even times, its faces always the same.
#pragma once

#include "base/reader.h"
#include "mesh/mesh.h"
#include "mesh/sample_span.h"

typedef struct MeshSequence {
    SampleTimes times;     // count 0: there is no sequence
    uint32_t vertex_count; // of each sample
    float (*position)[3];  // [times.count * vertex_count], metres, y up
    uint32_t checksum;     // CRC-32 of the positions as they were read
    double earlier;        // shapes that mesh_sequence_push has left behind
} MeshSequence;

typedef struct MeshSequenceOptions {
    double unit, otherwise_unit; // metres per unit; 0: as the file says, else the other one
    int up_z, otherwise_up_z;    // 1: z is up, 0: y; -1: as the file says, else the other one
    const char *rest;            // OBJ file of the rest pose; "": none
    double rate, otherwise_rate; // samples a second; 0: as the file says, else the other one
    double start;                // s
    bool linear;
} MeshSequenceOptions;

// What a reader of a format fills; everything is owned. Positions as they stand in the file.
typedef struct MeshSamples {
    uint64_t count, vertex_count;
    float (*position)[3];    // [count * vertex_count]
    uint32_t (*triangle)[3]; // [triangle_count], below vertex_count; NULL: the file has no faces
    uint64_t triangle_count;
    double rate, unit; // 0: the file does not say
    int up_z;          // -1: the file does not say
} MeshSamples;

typedef struct MeshSequenceFormat {
    bool (*match)(const char *path, const Bytes *bytes);
    void (*read)(MeshSamples *samples, Reader *reader); // fails the reader
    bool text;                                          // messages name lines
} MeshSequenceFormat;

extern const MeshSequenceFormat MESH_SEQUENCE_NPZ, MESH_SEQUENCE_NPY, MESH_SEQUENCE_PC2,
    MESH_SEQUENCE_MDD, MESH_SEQUENCE_ALEMBIC, MESH_SEQUENCE_USD;

// Makes room for positions; the reader fails where memory is short or the counts are beyond it.
bool mesh_samples_create(MeshSamples *samples, Reader *reader);

// Whether `path` names a sequence by its pattern (x_%04d.obj) or its content; false for OBJ
// and PLY files, and for what cannot be read, which mesh_read then says.
bool mesh_sequence_matches(const char *path);

// Reads all samples, and into `mesh` the faces with the positions of the first sample; into `rest`
// the rest pose, if one is named, else an empty mesh. Memory: 12 bytes a vertex and sample.
// Files of a pattern are numbered from any number on without gaps. RESULT_BAD_INPUT with file and
// sample for a gap, other counts of vertices, other faces, and numbers that are not finite;
// RESULT_FAILED when memory is short. A zeroed sequence may be destroyed.
Result mesh_sequence_read(MeshSequence *sequence, Mesh *mesh, Mesh *rest, const char *path,
                          const MeshSequenceOptions *options, Error *error);
void mesh_sequence_destroy(MeshSequence *sequence);

// Sample `i`'s positions.
static inline float (*mesh_sequence_at(const MeshSequence *sequence, uint32_t i))[3]
{
    return sequence->position + (size_t)i * sequence->vertex_count;
}

// The positions at a time (s): [vertex_count].
void mesh_sequence_evaluate(const MeshSequence *sequence, double time, float (*position)[3]);

// Of two samples: the second becomes the first, at time `before`, and `position` the second, at
// `after` (s, later).
void mesh_sequence_push(MeshSequence *sequence, const float (*position)[3], double before,
                        double after);

// A number that is equal for two times only if the positions are equal to the bit: it does not
// change while the mesh rests between equal samples, or before and after them.
double mesh_sequence_shape(const MeshSequence *sequence, double time);
