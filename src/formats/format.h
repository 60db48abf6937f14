// SPDX-License-Identifier: MIT
// The room formats: files of hair and of meshes. It reads them (strands_read.h, mesh_read.h,
// mesh_sequence.h), mends and reports their defects, and writes hair (format_write, frames_file.h).
// Containers that both kinds of files use: alembic.h, usd_stage.h, ply.h, npy_array.h, zip.h.
//
// This file: the table of hair file formats. Detection, --format, --export, suffixes, messages and
// help use it.
//
// To add a format: write a file in this folder with its row, `const Format my_format = {...}`, and
// add a line to the lists below.
#pragma once

#include "base/outfile.h"
#include "base/params.h"
#include "base/reader.h"
#include "base/target.h"
#include "strands/strands.h"

// X(kind, row, word of --format). The order matters twice: content belongs to the first row that
// matches it; and of the rows with a file's suffix, the first that can hold the strands is written.
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

enum {
    FORMAT_NOTE_SIZE = 800,
    FORMAT_PATH_SIZE = 96, // of an object in a file; the beginning of a longer one is cut
    FORMAT_OBJECTS = 64,   // listed by name; more are counted
    FORMAT_UNREAD_SIZE = 300,
};

typedef enum FormatKind {
#define KIND(kind, row, word) FORMAT_##kind,
    FORMATS(KIND)
#undef KIND
        FORMAT_KINDS
} FormatKind;

// "|usda|hair|...": the words of --format; word i (from 0) is that of FormatKind i.
#define FORMAT_WORD(kind, row, word) "|" word
#define FORMAT_WORDS                 FORMATS_WRITTEN(FORMAT_WORD)

// Settings of the caller for what a file does not say.
typedef struct FormatWishes {
    uint32_t points_per_strand; // for point clouds; 0: find it from jumps between points
    const char *array;          // name of the positions in .npz; NULL: see npz_file.c
    const char *objects;        // which objects of a scene file; NULL: all (format_wants_object)
    bool all_frames;            // read all frames of an animated file
} FormatWishes;

// An object of a scene file.
typedef struct FormatObject {
    char path[FORMAT_PATH_SIZE]; // "/Head/scalp"
    uint32_t strands;            // that are read
    const char *why;             // NULL if it is read; otherwise why not, a constant text
} FormatObject;

// The objects of a file and the names of attributes that are not read.
typedef struct FormatContents {
    FormatObject object[FORMAT_OBJECTS];
    uint32_t count, left_out;        // of all objects, also of those that are not listed
    char unread[FORMAT_UNREAD_SIZE]; // "name, name"; cut if there are too many
    uint32_t unread_count;
} FormatContents;

// The output of a format's reader: the file's content, neither mended nor converted. The struct
// owns everything; a zeroed struct is empty. Strands may have any number of vertices here.
typedef struct FormatSource {
    FormatWishes wishes;          // the caller's
    bool used_points, used_array; // whether this wish had an effect
    bool used_objects;            // the format has objects
    char note[FORMAT_NOTE_SIZE];  // choices and omissions of the reader; "" if none
    uint32_t flaws;               // how many of these --strict refuses
    FormatContents contents;      // of a scene file
    Strands strands;              // the file's unit and axes
    uint64_t *place;        // [strand_count] line of the strand's head, or byte of its first vertex
    uint32_t *vertex_line;  // [vertex_count] line, only for text
    uint32_t vertex_stride; // binary: bytes between successive vertices of a strand
    float version;          // 0 if the format has none
    bool shuffle;           // strands are sorted by place on the head; shuffle them
    float unit;             // metres, as the file says; 0 if it does not
    UpAxis up;              // the file's up axis; UP_AUTO if it does not say
    uint32_t samples;       // number in time, of which the first is here; 0 if not animated
    float (*frames)[3];     // [samples * vertex_count] if wishes.all_frames; otherwise NULL
    double fps;             // samples per second; 0 if the file does not say
    int first_frame;        // number of the first sample
    bool pads;              // strands lie in an array of equal sizes: what is not finite behind the
                            // last finite vertex is no part of a strand
    bool roots_only;        // strands of one vertex are intended: roots without hair
                            // (USC-HairSalon)
    double thickness_unit;  // metres, of vertex thickness; 0: that of the positions
    double scale;           // p' = translation + rotation * (scale * p), in the file's unit; 0
                            // means 1
    double rotation[3];     // about x, y, z, radians; applied in the order z, x, y
    double translation[3];
    double origin[3]; // the file's unit and axes: what the reader has taken away from positions
                      // that are far from 0, in double precision
    bool rotation_was_deg;    // guessed from its size
    uint32_t over_limit;      // strands with more vertices than the file's own
                              // maxNumVerticesInStrand
    uint64_t over_limit_line; // line of the first of them
    uint64_t unread_at;       // first byte after all known arrays
    uint64_t unread_bytes;
} FormatSource;

// A row of the table.
typedef struct Format {
    const char *name;    // "TressFX 4 binary"
    const char *suffix;  // ".tfx"
    uint32_t features;   // STRANDS_HAS_...: what the format holds besides positions
    bool text;           // places in a file are lines, otherwise bytes
    bool equal_sizes;    // all strands must have the same number of vertices
    bool animated;       // a file can hold many frames
    bool centimetres;    // default unit of the format, unless the hair is tiny
    bool no_millimetres; // guess only metres or centimetres
    bool up_z;           // default up axis is z

    // Whether the content (followed by a zero) is, or may well be, of this format.
    bool (*match)(const Bytes *bytes);

    // Reads the content from its beginning. Fails with the reader.
    Result (*read)(FormatSource *source, Reader *reader);

    // Writes at least one strand to file->stream; the caller checks the stream for errors.
    // Everything that the format holds reads back exactly with unit 1. RESULT_FAILED with the path
    // and a reason for strands that the format cannot hold. NULL if the format is only read.
    Result (*write)(OutFile *file, const Strands *strands, Error *error);
} Format;

extern const Format *const FORMAT_TABLE[FORMAT_KINDS];

// The kind of a file with this content; FORMAT_KINDS if unknown.
FormatKind format_detect(const Bytes *bytes);

// The kind to write for a name with this suffix (case-insensitive); FORMAT_KINDS if there is none.
FormatKind format_choose(const char *name, const Strands *strands);

// Parses the name of hair files: with the suffix of a writable format, with or without a frame
// number (target_parse_any). A name without a number holds all frames if its format can be animated
// (TARGET_VIDEO). RESULT_USAGE for other names, RESULT_FAILED when memory is short.
Result format_target(Target *target, const char *text, Error *error);

// Writes a file, complete or not at all, or standard output for "-"; coordinates are metres, y up.
// Data that the format cannot hold is left out (see `features`). RESULT_FAILED if there are no
// strands, for strands that the format cannot hold, for a read-only format, and with the reason if
// writing fails.
Result format_write(const char *path, FormatKind kind, const Strands *strands, Error *error);

// "a, b or c": the suffixes that are written, and the names of all formats.
void format_list_suffixes(char *text, size_t size);
void format_list_names(char *text, size_t size);

// Lists the words of --format for formats that hold all of `features`.
void format_list_holding(uint32_t features, char *text, size_t size);

// --- Helpers for the formats' own files.

// Allocates strands, vertices and `place`, and resets everything but wishes and notes. Fails like
// reader_fail_memory.
Result format_source_create(FormatSource *source, Reader *reader, uint32_t strand_count,
                            uint64_t vertex_count);
void format_source_destroy(FormatSource *source);

// Appends to the note of the source (printf style), separated by "; "; cut if it is too long.
void format_source_note(FormatSource *source, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

// The same for an omission that may give other hair than the file describes: --strict refuses it.
void format_source_flaw(FormatSource *source, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

// Lists an object. `why`: NULL if it is read; otherwise a constant text.
void format_source_list(FormatSource *source, const char *path, uint32_t strands, const char *why);

// Counts an attribute that is not read; lists each name once.
void format_source_unread(FormatSource *source, const char *name);

// Whether the wishes include an object: its path or a name in it ("/Head/scalp", "scalp", "Head")
// matches a pattern (* and ?) of the list "scalp,brows", or none of the patterns after "!".
bool format_wants_object(const FormatWishes *wishes, const char *path);

// Copies a path; cuts the beginning of one that is too long.
void format_copy_path(char to[FORMAT_PATH_SIZE], const char *path);

// Adds the optional array at `*array` (one of the strands' members) with `count` times `width`
// floats, copied from byte `start`, which the caller has checked. Fails like reader_fail_memory.
Result format_source_copy(Reader *reader, void *array, uint64_t start, size_t count, size_t width);

// Write little-endian numbers; a NULL array writes nothing.
void format_put_u32(FILE *stream, uint32_t value);
void format_put_floats(FILE *stream, const void *floats, size_t count);
