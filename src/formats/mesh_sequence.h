// SPDX-License-Identifier: MIT
// A deforming mesh: positions of its vertices at even times, with constant faces.
#pragma once

#include "base/reader.h"
#include "mesh/mesh.h"
#include "mesh/sample_span.h"

enum { MESH_NOTE_SIZE = 300 };

typedef struct MeshSequence {
    SampleTimes times;         // count 0: there is no sequence
    double first;              // number of the first sample, in the file's frames
    char note[MESH_NOTE_SIZE]; // what was chosen or left out; "" if nothing
    uint32_t vertex_count;     // per sample
    float (*position)[3];      // [times.count * vertex_count], metres, y up
    uint32_t checksum;         // CRC-32 of the positions as read
    double earlier;            // number of shapes that mesh_sequence_push has discarded
} MeshSequence;

typedef struct MeshSequenceOptions {
    double unit, otherwise_unit; // metres per unit; 0: as the file says, otherwise the second value
    int up_z, otherwise_up_z;    // 1: z is up, 0: y; -1: as the file says, otherwise the second
                                 // value
    const char *objects;         // which objects of a USD or Alembic file; NULL or "": all
                                 // (format_wants_object)
    const char *rest; // OBJ file of the rest pose; "" if none; NULL if the program takes none
    double rate, otherwise_rate; // samples per second; 0: as the file says, otherwise the second
                                 // value
    double start;                // s
    double origin[3];            // m, y up: taken away from all positions
    bool linear;
} MeshSequenceOptions;

// The output of a format's reader; everything is owned. Positions are as in the file.
typedef struct MeshSamples {
    uint64_t count, vertex_count;
    float (*position)[3];    // [count * vertex_count]
    uint32_t (*triangle)[3]; // [triangle_count], below vertex_count; NULL if the file has no faces
    uint64_t triangle_count;
    double origin[3];    // the file's unit and axes: taken away by the reader in double precision
    double rate, unit;   // 0 if the file does not say
    double first;        // number of the first sample, in frames of this rate
    int up_z;            // -1 if the file does not say
    const char *objects; // the caller's, as in MeshSequenceOptions
    char note[MESH_NOTE_SIZE];
} MeshSamples;

typedef struct MeshSequenceFormat {
    bool (*match)(const char *path, const Bytes *bytes);
    void (*read)(MeshSamples *samples, Reader *reader); // fails the reader
    bool text;                                          // messages name lines
} MeshSequenceFormat;

extern const MeshSequenceFormat MESH_SEQUENCE_NPZ, MESH_SEQUENCE_NPY, MESH_SEQUENCE_PC2,
    MESH_SEQUENCE_MDD, MESH_SEQUENCE_ALEMBIC, MESH_SEQUENCE_USD;

// Allocates the positions. Fails the reader if memory is short or the counts exceed it.
bool mesh_samples_create(MeshSamples *samples, Reader *reader);

// Sets the samples' origin to a translation in whole units if it is far from 0 (beyond 1,000).
void mesh_samples_find_origin(MeshSamples *samples, const double translation[3]);

// Appends to the note (printf style), separated by "; "; cut if it is too long.
void mesh_samples_note(MeshSamples *samples, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

// Whether `path` names a sequence by its pattern (x_%04d.obj) or its content. False for OBJ and PLY
// files, and for files that cannot be read; mesh_read then reports the error.
bool mesh_sequence_matches(const char *path);

// Reads all samples. `mesh` gets the faces and the positions of the first sample, `rest` the rest
// pose if one is given, otherwise it is empty. Memory: 12 bytes per vertex and sample. Files of a
// pattern may start at any number and have no gaps. RESULT_BAD_INPUT with file and sample for a
// gap, a different number of vertices, different faces, and numbers that are not finite;
// RESULT_FAILED when memory is short. A zeroed sequence may be destroyed.
Result mesh_sequence_read(MeshSequence *sequence, Mesh *mesh, Mesh *rest, const char *path,
                          const MeshSequenceOptions *options, Error *error);
void mesh_sequence_destroy(MeshSequence *sequence);

// The positions of sample `i`.
static inline float (*mesh_sequence_at(const MeshSequence *sequence, uint32_t i))[3]
{
    return sequence->position + (size_t)i * sequence->vertex_count;
}

// Writes the positions at a time (s), [vertex_count].
void mesh_sequence_evaluate(const MeshSequence *sequence, double time, float (*position)[3]);

// Replaces two samples: the second becomes the first, at time `before`; `position` becomes the
// second, at time `after` (s, later).
void mesh_sequence_push(MeshSequence *sequence, const float (*position)[3], double before,
                        double after);

// A stamp of the positions: equal stamps mean exactly equal positions. It does not change while the
// mesh rests between equal samples, or before and after the samples.
double mesh_sequence_shape(const MeshSequence *sequence, double time);
