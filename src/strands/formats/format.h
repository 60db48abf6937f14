// SPDX-License-Identifier: MIT
// The table of hair file formats. Detection, --format, --export, suffixes, messages and help take
// their knowledge from it.
//
// To add a format: write a file in this folder with its row, `const Format my_format = {...}`, and
// add a line to the lists below.
#pragma once

#include "base/outfile.h"
#include "base/params.h"
#include "base/reader.h"
#include "base/target.h"
#include "strands/strands.h"

// X(kind, row, word of --format). The order counts twice: content belongs to the first row that
// matches it, and of the rows with a file's suffix the first that can hold the strands is written.
#define FORMATS_WRITTEN(X)                                                                         \
    X(USD, usd, "usda")                                                                            \
    X(ABC, abc, "abc")                                                                             \
    X(HAIR, hair, "hair")                                                                          \
    X(OBJ, obj, "obj")                                                                             \
    X(TFX4, tfx4, "tfx4")                                                                          \
    X(TFX3, tfx3, "tfx3")                                                                          \
    X(TFX2, tfx2, "text")                                                                          \
    X(SALON_DATA, salon_data, "data")                                                              \
    X(PLY, ply, "ply")                                                                             \
    X(PLY_TEXT, ply_text, "ply-text")                                                              \
    X(NPZ, npz, "npz")                                                                             \
    X(NPY, npy, "npy")
#define FORMATS(X) FORMATS_WRITTEN(X) X(SALON_BIN, salon_bin, "")

enum { FORMAT_NOTE_SIZE = 400 };

typedef enum FormatKind {
#define KIND(kind, row, word) FORMAT_##kind,
    FORMATS(KIND)
#undef KIND
        FORMAT_KINDS
} FormatKind;

// "|usda|hair|...": the words of --format; word i, from 0, is that of FormatKind i.
#define FORMAT_WORD(kind, row, word) "|" word
#define FORMAT_WORDS                 FORMATS_WRITTEN(FORMAT_WORD)

// What the caller says where a file does not.
typedef struct FormatWishes {
    uint32_t points_per_strand; // of clouds of points; 0: found from where consecutive points jump
    const char *array;          // the name of the positions in .npz; NULL: see npz_file.c
    bool all_frames;            // of files with time
} FormatWishes;

// What a reader hands on: the file's content as it stands there, neither mended nor converted.
// Owned by the struct; a zeroed one is empty. Strands may have any number of vertices here.
typedef struct FormatSource {
    FormatWishes wishes;          // the caller's
    bool used_points, used_array; // a wish that has had its effect
    char note[FORMAT_NOTE_SIZE];  // what the reader chose or left out; "": nothing to say
    Strands strands;              // the file's unit and axes
    uint64_t *place;        // [strand_count] line of the strand's head, or byte of its first vertex
    uint32_t *vertex_line;  // [vertex_count] text only, NULL for binary
    uint32_t vertex_stride; // binary: bytes from one vertex of a strand to the next
    float version;          // 0: the format has none
    bool shuffle;           // the order is by place on the head and has to be made random
    float unit;             // metres, as the file says; 0: it doesn't
    UpAxis up;              // that the file says is up; UP_AUTO: it doesn't
    uint32_t samples;       // in time, of which the first is here; 0: the file has no time
    float (*frames)[3];     // [samples * vertex_count], of wishes.all_frames; NULL: none
    double fps;             // samples a second; 0: the file does not say
    int first_frame;        // number of the first sample
    bool roots_only;        // strands of one vertex are meant: roots without hair (USC-HairSalon)
    double thickness_unit;  // metres of the vertices' thickness; 0: as positions
    double scale;           // p' = translation + rotation * (scale * p), in the file's unit; 0 = 1
    double rotation[3];     // about x, y, z, radians; applied in the order z, x, y
    double translation[3];
    bool rotation_was_deg;    // judged by its size
    uint32_t over_limit;      // strands of more vertices than the file's own maxNumVerticesInStrand
    uint64_t over_limit_line; // of the first of them
    uint64_t unread_at;       // bytes behind all known arrays, from this one on
    uint64_t unread_bytes;
} FormatSource;

// A row of the table.
typedef struct Format {
    const char *name;    // "TressFX 4 binary"
    const char *suffix;  // ".tfx"
    uint32_t features;   // STRANDS_HAS_...: what its files hold besides positions
    bool text;           // places in a file are lines, else bytes
    bool equal_sizes;    // all strands have equally many vertices
    bool animated;       // a file can hold many frames
    bool centimetres;    // files that do not say their unit are in centimetres, unless tiny
    bool no_millimetres; // or in metres, but never in millimetres
    bool up_z;           // z is up in files that do not say

    // Whether the content (with a zero behind it) is, or may well be, of this format.
    bool (*match)(const Bytes *bytes);

    // Reads the content; the reader stands at its beginning. Fails with the reader.
    Result (*read)(FormatSource *source, Reader *reader);

    // Writes strands, at least one, to file->stream, whose errors are found by the caller. What
    // the format holds reads back to the bit with unit 1. RESULT_FAILED with the path and a reason
    // for strands that the format can't hold. NULL: such files are only read.
    Result (*write)(OutFile *file, const Strands *strands, Error *error);
} Format;

extern const Format *const FORMAT_TABLE[FORMAT_KINDS];

// The kind of a file with this content; FORMAT_KINDS if it is none.
FormatKind format_detect(const Bytes *bytes);

// The kind to write for a name with this suffix, in any case; FORMAT_KINDS if there is none.
FormatKind format_choose(const char *name, const Strands *strands);

// Takes the name of hair files: one with the suffix of a format that is written, with a frame
// number as target_parse_any takes it or without one. An animated format's name without a number
// holds all frames (TARGET_VIDEO). RESULT_USAGE for other names, RESULT_FAILED when memory is
// short.
Result format_target(Target *target, const char *text, Error *error);

// Writes a file, complete or not at all, or standard output for "-"; coordinates are metres, y up.
// What the format can't hold is left out (see `features`). RESULT_FAILED for no strands, strands
// that it can't hold, a format that is only read, and with the reason if writing fails.
Result format_write(const char *path, FormatKind kind, const Strands *strands, Error *error);

// "a, b or c": the suffixes that are written, and the names of all formats.
void format_list_suffixes(char *text, size_t size);
void format_list_names(char *text, size_t size);

// Lists the words of --format whose files hold all of `features`.
void format_list_holding(uint32_t features, char *text, size_t size);

// --- For the formats' own files.

// Makes room for strands, vertices and `place`, and resets all but wishes and notes; fails as the
// reader's memory failure.
Result format_source_create(FormatSource *source, Reader *reader, uint32_t strand_count,
                            uint64_t vertex_count);
void format_source_destroy(FormatSource *source);

// Adds to what the source notes (printf style), with "; " between two notes; cut if it is too long.
void format_source_note(FormatSource *source, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

// Adds the optional array at `*array` (one of the strands' members) of `count` times `width` floats
// copied from byte `start`, which must have been checked. Fails as the reader's memory failure.
Result format_source_copy(Reader *reader, void *array, uint64_t start, size_t count, size_t width);

// Write little-endian; a NULL array writes nothing.
void format_put_u32(FILE *stream, uint32_t value);
void format_put_floats(FILE *stream, const void *floats, size_t count);
