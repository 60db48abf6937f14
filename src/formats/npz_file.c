// SPDX-License-Identifier: MIT
// `.npy` and `.npz`: strands as NumPy arrays. Positions are (S, P, 3) for S strands of P points, or
// (V, 3), a list of points; in .npz, the array `sizes` (S,) then has the strands' numbers of
// points. The table ARRAYS below lists the other arrays of .npz; docs/formats.md describes them.
#include "formats/npz_file.h"

#include "formats/cloud.h"
#include "formats/foreign.h"
#include "formats/format.h"
#include "formats/npy_array.h"
#include "formats/zip.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// --- Positions.

// The strands that an array of positions describes; `vertices` is 0 if it is not one.
typedef struct Layout {
    uint64_t strands, vertices;
    uint32_t size; // points of every strand; 0 if unknown
} Layout;

static Layout layout_of(const NpyArray *array)
{
    const uint64_t *shape = array->shape;
    Layout layout = {0};
    if (array->kind != 'f' || array->count == 0 || array->axes < 2 || shape[array->axes - 1] != 3)
        return layout;
    if (array->axes == 3 && shape[1] >= 2 && shape[1] < UINT32_MAX)
        layout = (Layout){shape[0], shape[0] * shape[1], (uint32_t)shape[1]};
    if (array->axes == 2) layout = (Layout){0, shape[0], 0};
    return layout;
}

static Result refuse_shape(Reader *reader, const NpyArray *array)
{
    char text[200];
    npy_array_describe(array, text, sizeof text);
    return reader_fail(
        reader,
        "an array of %s with the shape %s: expected floats with the shape (strands, points, 3)",
        array->kind == 'f' ? "floats" : "elements that are not floats", text);
}

// Creates the source with these positions. `sizes`: [strands], or NULL. If neither `sizes` nor the
// layout tells where strands end, cloud.h finds it. `place` is the byte offset of the first point
// and `stride` the distance to the next.
static Result make_source(FormatSource *source, Reader *reader, const NpyArray *array,
                          Layout layout, const uint32_t *sizes, uint64_t place, uint32_t stride)
{
    if (layout.vertices >= UINT32_MAX || layout.strands >= UINT32_MAX)
        return reader_fail(reader, "too many points: expected fewer than 2^32 - 1");
    float(*positions)[3] = reader_malloc(reader, layout.vertices, sizeof *positions);
    if (!positions) return reader_fail_memory(reader);
    npy_array_copy(array, positions[0]);
    if (!layout.size && !sizes) {
        layout.size = cloud_find_size(source, reader, (const float(*)[3])positions,
                                      (uint32_t)layout.vertices);
        layout.strands = layout.size ? layout.vertices / layout.size : 0;
    }
    if (!reader_ok(reader) || format_source_create(source, reader, (uint32_t)layout.strands,
                                                   layout.vertices) != RESULT_OK) {
        free(positions);
        return reader->result;
    }
    free(source->strands.position);
    source->strands.position = positions;
    source->pads = !sizes;
    if (!sizes) cloud_set_strands(source, layout.size);
    for (uint32_t s = 0; sizes && s < layout.strands; s++)
        source->strands.first[s + 1] = source->strands.first[s] + sizes[s];
    source->vertex_stride = stride;
    for (uint32_t s = 0; s < layout.strands; s++)
        source->place[s] = place + (uint64_t)source->strands.first[s] * stride;
    return RESULT_OK;
}

// --- .npy

static Result read_npy(FormatSource *source, Reader *reader)
{
    NpyArray array;
    TRY(npy_array_read(&array, reader));
    Layout layout = layout_of(&array);
    reader->at = array.at;
    if (!layout.vertices) return refuse_shape(reader, &array);
    uint32_t stride = array.fortran ? 0 : 3 * array.item;
    TRY(make_source(source, reader, &array, layout, NULL, array.at, stride));
    size_t end = array.at + array.count * array.item;
    source->unread_at = end;
    source->unread_bytes = reader->size - end;
    return RESULT_OK;
}

static bool match_npy(const Bytes *bytes)
{
    return bytes->size >= 6 && memcmp(bytes->data, "\x93NUMPY", 6) == 0;
}

// --- .npz: arrays by name.

typedef struct Npz {
    Reader *reader;
    FormatSource *source;
    Zip zip;
    bool used[ZIP_MOST_FILES];
} Npz;

// An unpacked array.
typedef struct Held {
    NpyArray array;
    uint8_t *owned;
    // Byte offset in the archive: of the elements, or of the packed bytes if the array is packed.
    uint64_t place;
    bool packed;
} Held;

static bool has_name(const ZipFile *file, const char *name)
{
    size_t length = strlen(name);
    return strncmp(file->name, name, length) == 0 && strcmp(file->name + length, ".npy") == 0;
}

static int find_name(const Npz *npz, const char *name)
{
    for (uint32_t i = 0; i < npz->zip.count; i++)
        if (has_name(&npz->zip.file[i], name)) return (int)i;
    return -1;
}

static void drop(Npz *npz, Held *held)
{
    if (held->owned) npz->zip.budget += held->array.at + held->array.count * held->array.item;
    free(held->owned);
    *held = (Held){0};
}

// Reads an array of the archive; fails the archive's reader if the array is invalid. The caller
// must drop `held` in either case.
static Result hold(Npz *npz, uint32_t file, Held *held)
{
    Reader *reader = npz->reader;
    char path[1200];
    Bytes content;
    *held = (Held){0};
    TRY(zip_read(&npz->zip, &npz->zip.file[file], &content, &held->owned));
    snprintf(path, sizeof path, "%s: %s", reader->path, npz->zip.file[file].name);
    Reader inner = reader_begin_inner(reader, path, &content);
    npy_array_read(&held->array, &inner);
    reader_end_inner(reader, &inner);
    held->packed = held->owned;
    held->place = npz->zip.file[file].at + (held->packed ? 0 : held->array.at);
    npz->used[file] = true;
    return reader->result;
}

// "uv has shape (3, 4): expected (3, 2)"
static void refuse_companion(Npz *npz, const char *name, const NpyArray *array, uint64_t count,
                             uint64_t width)
{
    char text[200];
    npy_array_describe(array, text, sizeof text);
    reader_fail(npz->reader,
                width > 1 ? "'%s' has shape %s: expected (%llu, %llu) numbers"
                          : "'%s' has shape %s: expected (%llu,) numbers",
                name, text, (unsigned long long)count, (unsigned long long)width);
}

// `count` times `width` numbers as float32, which the caller frees. NULL if there is no such array,
// or after an error. An array of vertices may have separate axes for strands and points.
static float *copy_named(Npz *npz, const char *name, uint64_t count, uint64_t width)
{
    int file = find_name(npz, name);
    Held held = {0};
    float *numbers = NULL;
    if (!reader_ok(npz->reader) || file < 0) return NULL;
    if (hold(npz, (uint32_t)file, &held) == RESULT_OK) {
        const NpyArray *array = &held.array;
        bool good = npy_array_is_number(array) && array->axes > 0 && array->count == count * width;
        if (!good || (width > 1 && array->shape[array->axes - 1] != width))
            refuse_companion(npz, name, array, count, width);
        else
            numbers = reader_malloc(npz->reader, array->count, sizeof *numbers);
        if (numbers) npy_array_copy(array, numbers);
    }
    drop(npz, &held);
    return numbers;
}

// Reads a single number. `value` keeps its default if there is no such array.
static void read_scalar(Npz *npz, const char *name, double least, double *value)
{
    int file = find_name(npz, name);
    Held held = {0};
    if (!reader_ok(npz->reader) || file < 0) return;
    if (hold(npz, (uint32_t)file, &held) == RESULT_OK) {
        bool good = npy_array_is_number(&held.array) && held.array.count == 1;
        double number = good ? npy_array_number(&held.array, 0) : (double)NAN;
        if (!(number >= least && number <= 1e9))
            reader_fail(npz->reader, "'%s': expected one number from %g to 1e9", name, least);
        else
            *value = number;
    }
    drop(npz, &held);
}

static void read_up(Npz *npz)
{
    int file = find_name(npz, "up");
    Held held = {0};
    if (!reader_ok(npz->reader) || file < 0) return;
    if (hold(npz, (uint32_t)file, &held) == RESULT_OK) {
        const NpyArray *array = &held.array;
        bool text = !npy_array_is_number(array) && array->count == 1;
        uint32_t wide = array->kind == 'U' ? 4 : 1;
        char c = text ? (char)array->data[array->big ? wide - 1 : 0] : 0;
        if (array->item != wide || !c || !strchr("yzYZ", c))
            reader_fail(npz->reader, "'up': expected 'y' or 'z'");
        else
            npz->source->up = c == 'z' || c == 'Z' ? UP_Z : UP_Y;
    }
    drop(npz, &held);
}

// --- .npz: strands.

// Appends "hair (2400, 3)"; the list is cut where it does not fit.
static void add_found(char *found, size_t size, const char *name, const NpyArray *array)
{
    char shape[80];
    size_t length = strlen(found);
    const char *suffix = strrchr(name, '.');
    int letters = suffix ? (int)(suffix - name) : (int)strlen(name);
    npy_array_describe(array, shape, sizeof shape);
    snprintf(found + length, size - length, "%s%.*s %s", length ? ", " : "",
             letters < 40 ? letters : 40, name, shape);
}

// The array that --array names, or else `positions` or `points`, or else the first array with a
// suitable shape. Returns its number, or -1 after an error.
static int find_positions(Npz *npz, Held *held)
{
    static const char *const names[] = {"positions", "points"};
    const char *wanted = npz->source->wishes.array;
    int file = wanted ? find_name(npz, wanted) : -1;
    npz->source->used_array = true;
    if (wanted && file < 0) {
        reader_fail(npz->reader, "no array '%s': expected another --array", wanted);
        return -1;
    }
    for (int i = 0; i < 2 && !wanted && file < 0; i++) file = find_name(npz, names[i]);
    if (file >= 0) return hold(npz, (uint32_t)file, held) == RESULT_OK ? file : -1;
    char found[200] = "";
    for (uint32_t i = 0; i < npz->zip.count && reader_ok(npz->reader); i++) {
        if (hold(npz, i, held) != RESULT_OK) return -1;
        if (held->array.axes == 3 && layout_of(&held->array).vertices) {
            format_source_note(
                npz->source,
                "positions are taken from the array '%.40s': set --array if this is wrong",
                npz->zip.file[i].name);
            return (int)i;
        }
        add_found(found, sizeof found, npz->zip.file[i].name, &held->array);
        npz->used[i] = false;
        drop(npz, held);
    }
    reader_fail(
        npz->reader,
        "no array of floats with the shape (strands, points, 3): there is %s: expected one, "
        "or the arrays points and sizes, or --array",
        found);
    return -1;
}

// [strands] whole numbers that add up to the number of vertices; NULL after an error.
static uint32_t *read_sizes(Npz *npz, Layout *layout)
{
    int file = find_name(npz, "sizes");
    Held held = {0};
    uint32_t *sizes = NULL;
    uint64_t sum = 0;
    if (hold(npz, (uint32_t)file, &held) == RESULT_OK) {
        layout->strands = held.array.count;
        sizes = reader_malloc(npz->reader, held.array.count, sizeof *sizes);
    }
    for (uint64_t s = 0; sizes && s < layout->strands; s++) {
        double size = npy_array_is_number(&held.array) ? npy_array_number(&held.array, s) : -1;
        if (!(size >= 1 && size <= (double)(layout->vertices - sum) && size == floor(size))) {
            reader_fail(npz->reader,
                        "'sizes': expected %llu whole numbers from 1 up that add up to %llu points",
                        (unsigned long long)layout->strands, (unsigned long long)layout->vertices);
            break;
        }
        sizes[s] = (uint32_t)size;
        sum += sizes[s];
    }
    if (reader_ok(npz->reader) && sum != layout->vertices)
        reader_fail(npz->reader, "'sizes' add up to %llu points: expected %llu",
                    (unsigned long long)sum, (unsigned long long)layout->vertices);
    drop(npz, &held);
    return sizes;
}

static void read_strands(Npz *npz)
{
    Reader *reader = npz->reader;
    Held held = {0};
    uint32_t *sizes = NULL;
    bool mesh = find_name(npz, "faces") >= 0 && find_name(npz, "sizes") < 0;
    if (!npz->source->wishes.array && mesh)
        reader_fail(reader, "a mesh, not hair: " FOREIGN_WANTS_HAIR);
    else if (find_positions(npz, &held) >= 0) {
        Layout layout = layout_of(&held.array);
        if (!layout.vertices) refuse_shape(reader, &held.array);
        if (reader_ok(reader) && !layout.size && find_name(npz, "sizes") >= 0)
            sizes = read_sizes(npz, &layout);
        uint32_t stride = held.packed || held.array.fortran ? 0 : 3 * held.array.item;
        if (reader_ok(reader))
            make_source(npz->source, reader, &held.array, layout, sizes, held.place, stride);
    }
    free(sizes);
    drop(npz, &held);
}

// The arrays besides positions: name, member of Strands, numbers per record, member with the number
// of records, feature.
#define ARRAYS(X)                                                                                  \
    X(uv, strand_uv, 2, strand_count, STRANDS_HAS_STRAND_UV)                                       \
    X(vertex_uv, vertex_uv, 2, vertex_count, STRANDS_HAS_VERTEX_UV)                                \
    X(thickness, strand_thickness, 1, strand_count, STRANDS_HAS_STRAND_THICKNESS)                  \
    X(group, strand_group, 1, strand_count, STRANDS_HAS_GROUP)                                     \
    X(radius, vertex_thickness, 1, vertex_count, STRANDS_HAS_VERTEX_THICKNESS)                     \
    X(color, color, 4, vertex_count, STRANDS_HAS_COLOR)                                            \
    X(mobility, mobility, 1, vertex_count, STRANDS_HAS_MOBILITY)

static void read_companions(Npz *npz)
{
    FormatSource *source = npz->source;
    Strands *strands = &source->strands;
    double unit = 0, fps = 0, first = 0, followers = 0, radius = 0, fixed = 0;
#define READ(name, member, width, of, feature)                                                     \
    {                                                                                              \
        float *numbers = copy_named(npz, #name, strands->of, width);                               \
        memcpy(&strands->member, &numbers, sizeof numbers);                                        \
    }
    ARRAYS(READ)
#undef READ
    for (uint32_t v = 0; strands->vertex_thickness && v < strands->vertex_count; v++)
        strands->vertex_thickness[v] *= 2;
    read_scalar(npz, "unit", 1e-9, &unit);
    read_scalar(npz, "fps", 1e-3, &fps);
    read_scalar(npz, "first", 0, &first);
    read_scalar(npz, "followers", 0, &followers);
    read_scalar(npz, "follower_radius", 0, &radius);
    read_scalar(npz, "fixed_ends", 0, &fixed);
    read_up(npz);
    source->unit = (float)unit;
    source->fps = fps;
    source->first_frame = first < 9999999 ? (int)first : 9999999;
    strands->followers = (uint32_t)fmin(followers, UINT32_MAX);
    strands->follower_radius = (float)radius;
    strands->both_ends_fixed = fixed != 0;
}

// Frames are (F, S, P, 3) or (F, V, 3). Reads them if the caller wants all frames; otherwise only
// counts them.
static void read_frames(Npz *npz)
{
    FormatSource *source = npz->source;
    int file = find_name(npz, "frames");
    uint64_t each = 3 * (uint64_t)source->strands.vertex_count;
    Held held = {0};
    if (!reader_ok(npz->reader) || file < 0) return;
    if (hold(npz, (uint32_t)file, &held) == RESULT_OK) {
        const NpyArray *array = &held.array;
        uint64_t count = array->axes ? array->shape[0] : 0;
        bool good = array->kind == 'f' && array->axes >= 3 && count > 0 && count < 10000000 &&
                    array->count == count * each && array->shape[array->axes - 1] == 3;
        if (!good)
            reader_fail(npz->reader, "'frames': expected %u points in each frame",
                        source->strands.vertex_count);
        source->samples = good ? (uint32_t)count : 0;
        if (good && source->wishes.all_frames) {
            source->frames = reader_malloc(npz->reader, array->count, sizeof(float));
            if (source->frames) npy_array_copy(array, source->frames[0]);
        }
    }
    drop(npz, &held);
}

static void note_unused(Npz *npz)
{
    char names[120] = "";
    size_t used = 0;
    for (uint32_t i = 0; i < npz->zip.count && used < sizeof names; i++)
        if (!npz->used[i])
            used += (size_t)snprintf(names + used, sizeof names - used, "%s%.30s", used ? ", " : "",
                                     npz->zip.file[i].name);
    if (*names) format_source_note(npz->source, "not read: %s", names);
}

static Result read_npz(FormatSource *source, Reader *reader)
{
    Npz npz = {.reader = reader, .source = source};
    if (zip_open(&npz.zip, reader) == RESULT_OK) {
        read_strands(&npz);
        if (reader_ok(reader)) read_companions(&npz);
        if (reader_ok(reader)) read_frames(&npz);
        if (reader_ok(reader)) note_unused(&npz);
    }
    zip_close(&npz.zip);
    return reader->result;
}

// Detects a zip archive whose first file is a NumPy array.
static bool match_npz(const Bytes *bytes)
{
    const uint8_t *at = bytes->data;
    if (bytes->size < 30 || memcmp(at, "PK\x03\x04", 4) != 0) return false;
    size_t length = at[26] | (size_t)at[27] << 8;
    return length > 4 && bytes->size >= 30 + length && memcmp(at + 30 + length - 4, ".npy", 4) == 0;
}

// --- Writing.

static const bool HOST_IS_BIG = __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__;

// `type` has no byte order: "f4".
static void add(ZipWriter *writer, const char *name, const char *type, const uint64_t *shape,
                uint32_t axes, const void *data, size_t size)
{
    char header[NPY_HEADER_SIZE], full[8], file[ZIP_NAME_SIZE];
    snprintf(full, sizeof full, "%c%s", HOST_IS_BIG ? '>' : '<', type);
    snprintf(file, sizeof file, "%s.npy", name);
    size_t head = npy_array_header(header, full, shape, axes);
    zip_add(writer, file, header, head, data, size);
}

static void add_scalar(ZipWriter *writer, const char *name, double value)
{
    add(writer, name, "f8", NULL, 0, &value, sizeof value);
}

// The number of vertices of every strand; 0 if it is not the same for all.
static uint32_t even_size(const Strands *strands)
{
    uint32_t size = strands_size(strands, 0);
    for (uint32_t s = 1; s < strands->strand_count; s++)
        if (strands_size(strands, s) != size) return 0;
    return size;
}

static void add_positions(ZipWriter *writer, const Strands *strands)
{
    uint32_t size = even_size(strands);
    size_t bytes = (size_t)strands->vertex_count * sizeof *strands->position;
    if (size) {
        const uint64_t shape[] = {strands->strand_count, size, 3};
        add(writer, "positions", "f4", shape, 3, strands->position, bytes);
        return;
    }
    const uint64_t shape[] = {strands->vertex_count, 3}, count = strands->strand_count;
    uint32_t *sizes = malloc((size_t)count * sizeof *sizes);
    writer->failed = writer->failed || !sizes;
    for (uint32_t s = 0; sizes && s < count; s++) sizes[s] = strands_size(strands, s);
    add(writer, "points", "f4", shape, 2, strands->position, bytes);
    if (sizes) add(writer, "sizes", "i4", &count, 1, sizes, (size_t)count * sizeof *sizes);
    free(sizes);
}

static void add_radius(ZipWriter *writer, const Strands *strands)
{
    const uint64_t count = strands->vertex_count;
    float *radius = malloc((size_t)count * sizeof *radius);
    writer->failed = writer->failed || !radius;
    if (!radius) return;
    for (uint32_t v = 0; v < count; v++) radius[v] = strands->vertex_thickness[v] / 2;
    add(writer, "radius", "f4", &count, 1, radius, (size_t)count * sizeof *radius);
    free(radius);
}

static void add_companions(ZipWriter *writer, const Strands *strands)
{
    uint32_t features = strands_features(strands);
#define ADD(name, member, width, of, feature)                                                      \
    if ((features & feature) && strcmp(#name, "radius") != 0) {                                    \
        const uint64_t shape[] = {strands->of, width};                                             \
        add(writer, #name, "f4", shape, width > 1 ? 2 : 1, strands->member,                        \
            (size_t)strands->of * sizeof *strands->member);                                        \
    }
    ARRAYS(ADD)
#undef ADD
    if (strands->vertex_thickness) add_radius(writer, strands);
    if (features & STRANDS_HAS_FOLLOWERS) add_scalar(writer, "followers", strands->followers);
    if (features & STRANDS_HAS_FOLLOWER_RADIUS)
        add_scalar(writer, "follower_radius", (double)strands->follower_radius);
    if (features & STRANDS_HAS_FIXED_ENDS) add_scalar(writer, "fixed_ends", 1);
    add_scalar(writer, "unit", strands->unit > 0 ? strands->unit : 1);
    uint32_t letter = strands->up_z ? 'z' : 'y';
    add(writer, "up", "U1", NULL, 0, &letter, sizeof letter);
}

Result npz_write_frames(OutFile *file, const Strands *strands, const NpzFrames *frames,
                        Error *error)
{
    ZipWriter writer = {.out = file};
    Strands first = *strands; // positions are those of the first frame
    if (frames->count) first.position = (float(*)[3])(uintptr_t)frames->position;
    add_positions(&writer, &first);
    add_companions(&writer, strands);
    if (frames->count) {
        uint32_t size = even_size(strands);
        const uint64_t even[] = {frames->count, strands->strand_count, size, 3};
        const uint64_t ragged[] = {frames->count, strands->vertex_count, 3};
        add(&writer, "frames", "f4", size ? even : ragged, size ? 4 : 3, frames->position,
            (size_t)frames->count * strands->vertex_count * sizeof *frames->position);
        add_scalar(&writer, "fps", frames->fps);
        add_scalar(&writer, "first", frames->first);
    }
    return zip_finish(&writer, error);
}

static Result write_npz(OutFile *file, const Strands *strands, Error *error)
{
    return npz_write_frames(file, strands, &(NpzFrames){0}, error);
}

static Result write_npy(OutFile *file, const Strands *strands, Error *error)
{
    char header[NPY_HEADER_SIZE] = "";
    uint32_t size = strands_size(strands, 0);
    for (uint32_t s = 1; s < strands->strand_count; s++)
        if (strands_size(strands, s) != size)
            return error_set(
                error, RESULT_FAILED,
                "%s: strand %u has %u vertices, strand 0 has %u: expected equal numbers in a .npy "
                "file (--resample N makes them equal), or a .npz file",
                file->path, s, strands_size(strands, s), size);
    const uint64_t shape[] = {strands->strand_count, size, 3};
    size_t head = npy_array_header(header, "<f4", shape, 3);
    fwrite(header, 1, head, file->stream);
    format_put_floats(file->stream, strands->position, 3 * (size_t)strands->vertex_count);
    return RESULT_OK;
}

const Format npz_format = {
    .name = "numpy arrays (.npz)",
    .suffix = ".npz",
    .features = ~(uint32_t)STRANDS_HAS_FIBRE,
    .match = match_npz,
    .read = read_npz,
    .write = write_npz,
};

const Format npy_format = {
    .name = "numpy array (.npy)",
    .suffix = ".npy",
    .equal_sizes = true,
    .match = match_npy,
    .read = read_npy,
    .write = write_npy,
};
