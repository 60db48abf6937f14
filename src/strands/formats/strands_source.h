// SPDX-License-Identifier: MIT
// What a reader of one format hands on: the file's content as it stands there, neither mended nor
// converted.
#pragma once

#include "base/reader.h"
#include "strands/strands.h"

// Owned by the struct; a zeroed one is empty. Strands may have any number of vertices here.
typedef struct StrandsSource {
    Strands strands;        // the file's unit and axes
    uint64_t *place;        // [strand_count] line of the strand's head, or byte of its first vertex
    uint32_t *vertex_line;  // [vertex_count] text only, NULL for binary
    uint32_t vertex_stride; // binary: bytes from one vertex of a strand to the next
    float version;          // 0: the format has none
    bool shuffle;           // the order is by place on the head and has to be made random
    float unit;             // metres, as the file says; 0: it doesn't
    bool up_z;              // the file says that z is up
    uint32_t samples;       // in time, of which the first is here; 0: the file has no time
    bool roots_only;        // strands of one vertex are meant: roots without hair (USC-HairSalon)
    double scale;           // p' = translation + rotation * (scale * p), in the file's unit; 0 = 1
    double rotation[3];     // about x, y, z, radians; applied in the order z, x, y
    double translation[3];
    bool rotation_was_deg;    // judged by its size
    uint32_t over_limit;      // strands of more vertices than the file's own maxNumVerticesInStrand
    uint64_t over_limit_line; // of the first of them
    uint64_t unread_at;       // bytes behind all known arrays, from this one on
    uint64_t unread_bytes;
} StrandsSource;

// Makes room for strands, vertices and `place`; fails as the reader's memory failure.
Result strands_source_create(StrandsSource *source, Reader *reader, uint32_t strand_count,
                             uint64_t vertex_count);
void strands_source_destroy(StrandsSource *source);

// Fills `first` and `place` for strands of `size` vertices each, the first vertex at byte `start`.
void strands_source_lay_out(StrandsSource *source, uint32_t size, uint64_t start, uint32_t stride);

// Adds the optional array at `*array` (one of the strands' members) of `count` times `width` floats
// copied from byte `start`, which must have been checked. Fails as the reader's memory failure.
Result strands_source_copy(Reader *reader, void *array, uint64_t start, size_t count, size_t width);
