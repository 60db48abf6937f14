// SPDX-License-Identifier: MIT
// The layout is that of Alembic's own writer (lib/Alembic/Ogawa, AbcCoreOgawa). Parts stand behind
// what they name; only the header names what comes, and is filled at the end.
#include "strands/formats/abc_write.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const uint64_t DATA_BIT = UINT64_C(1) << 63;
enum { HEADER_BYTES = 16, MOST_PARTS = 24, HASH_BYTES = 32, LIBRARY_VERSION = 10800 };

// --- Bytes, little-endian.

typedef struct Block {
    uint8_t *data;
    size_t size, room;
    bool failed;
} Block;

static void add_bytes(Block *block, const void *bytes, size_t size)
{
    if (block->size + size > block->room) {
        size_t room = 2 * block->room + size + 64;
        uint8_t *more = realloc(block->data, room);
        block->failed = block->failed || !more;
        if (!more) return;
        block->data = more;
        block->room = room;
    }
    memcpy(block->data + block->size, bytes, size);
    block->size += size;
}

static void add_number(Block *block, uint64_t number, int bytes)
{
    uint8_t little[8];
    for (int i = 0; i < bytes; ++i) little[i] = (uint8_t)(number >> 8 * i);
    add_bytes(block, little, (size_t)bytes);
}

static void add_float(Block *block, float number)
{
    uint32_t bits;
    memcpy(&bits, &number, 4);
    add_number(block, bits, 4);
}

static void add_double(Block *block, double number)
{
    uint64_t bits;
    memcpy(&bits, &number, 8);
    add_number(block, bits, 8);
}

// --- The keys of data, by which readers know equal ones: MurmurHash3 (Appleby), 128 bits for x64.

static uint64_t turn(uint64_t x, int by)
{
    return x << by | x >> (64 - by);
}

static uint64_t finish_mix(uint64_t x)
{
    x = (x ^ x >> 33) * UINT64_C(0xff51afd7ed558ccd);
    x = (x ^ x >> 33) * UINT64_C(0xc4ceb9fe1a85ec53);
    return x ^ x >> 33;
}

static uint64_t little_endian(const uint8_t *from, size_t bytes)
{
    uint64_t number = 0;
    for (size_t i = 0; i < bytes; ++i) number |= (uint64_t)from[i] << 8 * i;
    return number;
}

static void find_key(const uint8_t *data, size_t size, uint32_t seed, uint64_t key[2])
{
    const uint64_t c1 = UINT64_C(0x87c37b91114253d5), c2 = UINT64_C(0x4cf5ad432745937f);
    uint64_t a = seed, b = seed;
    size_t whole = size / 16 * 16, left = size - whole;
    for (size_t i = 0; i < whole; i += 16) {
        a ^= turn(little_endian(data + i, 8) * c1, 31) * c2;
        a = (turn(a, 27) + b) * 5 + 0x52dce729;
        b ^= turn(little_endian(data + i + 8, 8) * c2, 33) * c1;
        b = (turn(b, 31) + a) * 5 + 0x38495ab5;
    }
    if (left > 8) b ^= turn(little_endian(data + whole + 8, left - 8) * c2, 33) * c1;
    if (left > 0) a ^= turn(little_endian(data + whole, left < 8 ? left : 8) * c1, 31) * c2;
    a ^= size, b ^= size;
    a += b, b += a;
    a = finish_mix(a), b = finish_mix(b);
    a += b, b += a;
    key[0] = a, key[1] = b;
}

// --- Parts: each returns its place.

static void put(AbcWriter *writer, const void *bytes, size_t size)
{
    fwrite(bytes, 1, size, writer->stream);
    writer->at += size;
}

static void put_number(AbcWriter *writer, uint64_t number)
{
    uint8_t little[8];
    for (int i = 0; i < 8; ++i) little[i] = (uint8_t)(number >> 8 * i);
    put(writer, little, sizeof little);
}

static uint64_t put_data(AbcWriter *writer, Block *block)
{
    uint64_t place = writer->at | DATA_BIT;
    writer->failed = writer->failed || block->failed;
    if (block->size == 0)
        place = DATA_BIT;
    else {
        put_number(writer, block->size);
        put(writer, block->data, block->size);
    }
    free(block->data);
    *block = (Block){0};
    return place;
}

// The same with its key in front. `pod`: bytes of one number.
static uint64_t put_sample(AbcWriter *writer, Block *block, uint32_t pod)
{
    uint64_t key[2], place = writer->at | DATA_BIT;
    writer->failed = writer->failed || block->failed;
    if (block->size == 0) return put_data(writer, block);
    find_key(block->data, block->size, pod, key);
    put_number(writer, block->size + sizeof key);
    put_number(writer, key[0]);
    put_number(writer, key[1]);
    put(writer, block->data, block->size);
    free(block->data);
    *block = (Block){0};
    return place;
}

static uint64_t put_group(AbcWriter *writer, const uint64_t *part, size_t count)
{
    uint64_t place = writer->at;
    if (count == 0) return 0;
    put_number(writer, count);
    for (size_t i = 0; i < count; ++i) put_number(writer, part[i]);
    return place;
}

// --- Properties.

typedef enum Pod {
    POD_BOOL = 0,
    POD_U8 = 1,
    POD_I16 = 4,
    POD_I32 = 6,
    POD_FLOAT = 10,
    POD_DOUBLE = 11,
    POD_STRING = 12
} Pod;

static const uint8_t POD_BYTES[] = {1, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8, 1};

// A compound as it grows: its properties' groups, and their headers.
typedef struct Compound {
    uint64_t part[MOST_PARTS];
    size_t count;
    Block headers;
} Compound;

enum {
    IS_SCALAR = 1,
    IS_ARRAY = 2,
    WIDE = 2 << 2,
    HAS_SAMPLING = 0x100,
    SAME_SIZE = 0x400,
    CONSTANT = 0x800,
    TEXT_FOLLOWS = 0xff << 20
};

static void add_text(Block *block, const char *text)
{
    add_bytes(block, text, strlen(text));
}

static void add_property(Compound *compound, const char *name, const char *meta, uint64_t group)
{
    compound->part[compound->count++] = group;
    add_number(&compound->headers, strlen(name), 4);
    add_text(&compound->headers, name);
    add_number(&compound->headers, strlen(meta), 4);
    add_text(&compound->headers, meta);
}

// Samples at places of data; scalars have no dimensions.
static void add_samples(AbcWriter *writer, Compound *to, const char *name, const char *meta,
                        bool array, Pod pod, uint32_t extent, const uint64_t *sample, size_t count)
{
    size_t parts = array ? 2 * count : count;
    uint64_t *part = calloc(parts + 1, sizeof *part);
    writer->failed = writer->failed || !part;
    if (!part) return;
    for (size_t i = 0; i < count; ++i)
        if (array)
            part[2 * i] = sample[i], part[2 * i + 1] = DATA_BIT;
        else
            part[i] = sample[i];
    uint64_t group = put_group(writer, part, parts);
    free(part);
    add_number(&to->headers,
               (array ? IS_ARRAY : IS_SCALAR) | WIDE | (uint32_t)pod << 4 | SAME_SIZE |
                   extent << 12 | TEXT_FOLLOWS | (count > 1 ? HAS_SAMPLING : CONSTANT),
               4);
    add_number(&to->headers, count, 4);
    if (count > 1) add_number(&to->headers, 1, 4); // the second sampling
    add_property(to, name, meta, group);
}

static void add_one(AbcWriter *writer, Compound *to, const char *name, const char *meta, bool array,
                    Pod pod, uint32_t extent, Block *block)
{
    uint64_t sample = put_sample(writer, block, POD_BYTES[pod]);
    add_samples(writer, to, name, meta, array, pod, extent, &sample, 1);
}

static uint64_t put_compound(AbcWriter *writer, Compound *compound)
{
    if (compound->count == 0) return 0;
    compound->part[compound->count] = put_data(writer, &compound->headers);
    return put_group(writer, compound->part, compound->count + 1);
}

static void add_compound(AbcWriter *writer, Compound *to, const char *name, const char *meta,
                         Compound *inner)
{
    if (inner->count == 0) return;
    uint64_t group = put_compound(writer, inner);
    add_number(&to->headers, WIDE | TEXT_FOLLOWS, 4);
    add_property(to, name, meta, group);
}

// --- The strands' properties.

// How many values, and how AbcGeom calls that.
static size_t count_values(const Strands *strands, CurvesRate rate)
{
    return rate == CURVES_CONSTANT  ? 1
           : rate == CURVES_UNIFORM ? strands->strand_count
                                    : strands->vertex_count;
}

static void describe(char meta[160], CurvesRate rate, const char *interpretation, uint32_t extent,
                     const char *pod)
{
    static const char *const scopes[] = {"con", "uni", "vtx"};
    snprintf(meta, 160, "arrayExtent=1;geoScope=%s;%s%s%sisGeomParam=true;podExtent=%u;podName=%s",
             scopes[rate], *interpretation ? "interpretation=" : "", interpretation,
             *interpretation ? ";" : "", extent, pod);
}

// Floats `stride` apart, each `factor` times.
static void add_floats(AbcWriter *writer, Compound *to, const char *name,
                       const char *interpretation, const float *value, CurvesRate rate,
                       uint32_t extent, uint32_t stride, double factor)
{
    Block block = {0};
    char meta[160];
    if (!value) return;
    describe(meta, rate, interpretation, extent, "float32_t");
    for (size_t i = 0; i < count_values(writer->strands, rate); ++i)
        for (uint32_t k = 0; k < extent; ++k)
            add_float(&block, factor == 1 ? value[i * stride + k]
                                          : (float)(value[i * stride + k] * factor));
    add_one(writer, to, name, meta, true, POD_FLOAT, extent, &block);
}

static void add_single(AbcWriter *writer, Compound *to, const char *name, float value)
{
    add_floats(writer, to, name, "", &value, CURVES_CONSTANT, 1, 1, 1);
}

static void add_groups(AbcWriter *writer, Compound *to)
{
    Block block = {0};
    char meta[160];
    describe(meta, CURVES_UNIFORM, "", 1, "int32_t");
    for (uint32_t s = 0; s < writer->strands->strand_count; ++s)
        add_number(&block, (uint32_t)lrintf(writer->strands->strand_group[s]), 4);
    add_one(writer, to, "groom_group_id", meta, true, POD_I32, 1, &block);
}

// One a vertex, as Unreal wants it.
static void add_color(AbcWriter *writer, Compound *to)
{
    const Strands *strands = writer->strands;
    const CurvesLook *look = &writer->options.look;
    bool transparent = false;
    if (!look->color) return;
    float(*color)[4] = calloc((size_t)strands->vertex_count + 1, sizeof *color);
    writer->failed = writer->failed || !color;
    for (uint32_t s = 0; color && s < strands->strand_count; ++s)
        for (uint32_t v = strands->first[s]; v < strands->first[s + 1]; ++v) {
            uint32_t from = look->color_rate == CURVES_CONSTANT  ? 0
                            : look->color_rate == CURVES_UNIFORM ? s
                                                                 : v;
            memcpy(color[v], look->color[from], sizeof *color);
            transparent = transparent || color[v][3] != 1.0f;
        }
    if (!color) return;
    add_floats(writer, to, "groom_color", "rgb", color[0], CURVES_VERTEX, 3, 4, 1);
    if (transparent) add_floats(writer, to, "opacity", "", &color[0][3], CURVES_VERTEX, 1, 4, 1);
    free(color);
}

static void add_version(AbcWriter *writer, Compound *to)
{
    static const struct {
        const char *name;
        uint32_t number;
    } versions[] = {{"groom_version_major", 1}, {"groom_version_minor", 5}};
    Compound user = {0};
    for (int i = 0; i < 2; ++i) {
        Block block = {0};
        add_number(&block, versions[i].number, 2);
        add_one(writer, &user, versions[i].name, "", false, POD_I16, 1, &block);
    }
    Block tool = {0};
    add_bytes(&tool, "Tractrix", sizeof "Tractrix");
    add_one(writer, &user, "groom_tool", "", false, POD_STRING, 1, &tool);
    add_compound(writer, to, ".userProperties", "", &user);
}

// What AbcGeom's schema has no place for.
static void add_arbitrary(AbcWriter *writer, Compound *to)
{
    const Strands *strands = writer->strands;
    const CurvesLook *look = &writer->options.look;
    uint32_t features = strands_features(strands);
    Compound inner = {0};
    add_floats(writer, &inner, "groom_width", "", look->width, look->width_rate, 1, 1,
               writer->options.metres_per_unit / ABC_GROOM_UNIT);
    if (features & STRANDS_HAS_STRAND_UV)
        add_floats(writer, &inner, "groom_root_uv", "vector", strands->strand_uv[0], CURVES_UNIFORM,
                   2, 2, 1);
    add_color(writer, &inner);
    if (features & STRANDS_HAS_GROUP) add_groups(writer, &inner);
    if (features & STRANDS_HAS_VERTEX_UV)
        add_floats(writer, &inner, "st1", "vector", strands->vertex_uv[0], CURVES_VERTEX, 2, 2, 1);
    add_floats(writer, &inner, "thickness", "", strands->strand_thickness, CURVES_UNIFORM, 1, 1, 1);
    if (features & STRANDS_HAS_MOBILITY)
        add_floats(writer, &inner, "mobility", "", strands->mobility, CURVES_VERTEX, 1, 1, 1);
    if (features & STRANDS_HAS_FOLLOWERS)
        add_single(writer, &inner, "followers", (float)strands->followers);
    if (features & STRANDS_HAS_FOLLOWER_RADIUS)
        add_single(writer, &inner, "followerRadius", strands->follower_radius);
    if (strands->both_ends_fixed) add_single(writer, &inner, "bothEndsFixed", 1);
    add_compound(writer, to, ".arbGeomParams", "", &inner);
}

static void add_boxes(AbcWriter *writer, Compound *to)
{
    uint64_t *sample = malloc(writer->frame_count * sizeof *sample + 1);
    writer->failed = writer->failed || !sample;
    for (size_t i = 0; sample && i < writer->frame_count; ++i) {
        Block block = {0};
        for (int k = 0; k < 6; ++k) add_double(&block, writer->boxes[i][k]);
        sample[i] = put_sample(writer, &block, 8);
    }
    if (sample)
        add_samples(writer, to, ".selfBnds", "interpretation=box", false, POD_DOUBLE, 6, sample,
                    writer->frame_count);
    free(sample);
}

static uint64_t put_curves(AbcWriter *writer)
{
    const Strands *strands = writer->strands;
    const CurvesLook *look = &writer->options.look;
    Compound geom = {0}, top = {0};
    Block sizes = {0}, kind = {0};
    for (uint32_t s = 0; s < strands->strand_count; ++s)
        add_number(&sizes, strands_size(strands, s), 4);
    add_number(&kind, 1, 4); // linear, with ends, without a basis
    add_boxes(writer, &geom);
    add_samples(writer, &geom, "P", "geoScope=vtx;interpretation=point", true, POD_FLOAT, 3,
                writer->samples, writer->frame_count);
    add_one(writer, &geom, "nVertices", "", true, POD_I32, 1, &sizes);
    add_one(writer, &geom, "curveBasisAndType", "", false, POD_U8, 4, &kind);
    if (strands_features(strands) & STRANDS_HAS_STRAND_UV)
        add_floats(writer, &geom, "uv", "vector", strands->strand_uv[0], CURVES_UNIFORM, 2, 2, 1);
    add_floats(writer, &geom, "width", "", look->width, look->width_rate, 1, 1, 1);
    add_arbitrary(writer, &geom);
    add_version(writer, &geom);
    add_compound(writer, &top, ".geom",
                 "schema=AbcGeom_Curve_v2;schemaBaseType=AbcGeom_GeomBase_v1", &geom);
    return put_compound(writer, &top);
}

static uint64_t put_transform(AbcWriter *writer)
{
    Compound own = {0}, top = {0};
    Block inherits = {0};
    add_number(&inherits, 1, 1);
    add_one(writer, &own, ".inherits", "", false, POD_BOOL, 1, &inherits);
    add_version(writer, &own);
    add_compound(writer, &top, ".xform", "schema=AbcGeom_Xform_v3", &own);
    return put_compound(writer, &top);
}

// --- Objects.

// An object of properties and at most one child. The hashes, by which readers may tell whether two
// objects differ, are the key of its places.
static uint64_t put_object(AbcWriter *writer, uint64_t properties, const char *name,
                           const char *meta, uint64_t child)
{
    Block headers = {0}, named = {0};
    uint64_t part[3] = {properties}, key[2], count = 1;
    if (child) {
        part[count++] = child;
        add_number(&headers, strlen(name), 4);
        add_text(&headers, name);
        add_number(&headers, 0xff, 1);
        add_number(&headers, strlen(meta), 4);
        add_text(&headers, meta);
    }
    add_number(&named, properties, 8);
    add_number(&named, child, 8);
    find_key(named.data, named.size, 8, key);
    for (int i = 0; i < HASH_BYTES / 8; ++i) add_number(&headers, key[i % 2], 8);
    free(named.data);
    part[count] = put_data(writer, &headers);
    return put_group(writer, part, count + 1);
}

static uint64_t put_objects(AbcWriter *writer)
{
    uint64_t curves = put_object(writer, put_curves(writer), "", "", 0);
    uint64_t transform = put_object(writer, put_transform(writer), "HairShape",
                                    "schema=AbcGeom_Curve_v2;schemaBaseType=AbcGeom_GeomBase_v1;"
                                    "schemaObjTitle=AbcGeom_Curve_v2:.geom",
                                    curves);
    return put_object(writer, 0, "Hair",
                      "schema=AbcGeom_Xform_v3;schemaObjTitle=AbcGeom_Xform_v3:.xform", transform);
}

// --- The file.

static void add_sampling(Block *block, size_t most, double cycle, double first)
{
    add_number(block, most, 4);
    add_double(block, cycle);
    add_number(block, 1, 4);
    add_double(block, first);
}

static uint64_t put_archive(AbcWriter *writer)
{
    const CurvesOptions *options = &writer->options;
    Block version = {0}, library = {0}, meta = {0}, samplings = {0}, texts = {0};
    char about[160];
    uint64_t part[6];
    add_number(&version, 0, 4);
    add_number(&library, LIBRARY_VERSION, 4);
    snprintf(about, sizeof about, "_ai_Application=Tractrix;metersPerUnit=%.17g;upAxis=%c",
             options->metres_per_unit, options->up_z ? 'Z' : 'Y');
    add_text(&meta, about);
    add_sampling(&samplings, 1, 1, 0);
    if (writer->frame_count > 1) {
        double every = (double)(writer->last - writer->first) / (double)(writer->frame_count - 1);
        add_sampling(&samplings, writer->frame_count, every / options->fps,
                     writer->first / options->fps);
    }
    part[0] = put_data(writer, &version);
    part[1] = put_data(writer, &library);
    part[2] = put_objects(writer);
    part[3] = put_data(writer, &meta);
    part[4] = put_data(writer, &samplings);
    part[5] = put_data(writer, &texts);
    return put_group(writer, part, 6);
}

static void put_header(AbcWriter *writer, bool closed, uint64_t root)
{
    const uint8_t header[8] = {'O', 'g', 'a', 'w', 'a', closed ? 0xff : 0, 0, 1};
    put(writer, header, sizeof header);
    put_number(writer, root);
}

static Result begin(AbcWriter *writer, const OutFile *file, const Strands *strands,
                    const CurvesOptions *options, Error *error)
{
    *writer =
        (AbcWriter){.file = *file, .stream = file->stream, .strands = strands, .options = *options};
    CurvesLook *look = &writer->options.look;
    if (!look->width && strands->vertex_thickness) {
        look->width = strands->vertex_thickness;
        look->width_rate = CURVES_VERTEX;
    }
    if (!look->color && strands->color) {
        look->color = (const float(*)[4])strands->color;
        look->color_rate = CURVES_VERTEX;
    }
    // Pipes cannot be gone back in.
    writer->buffered = fseek(file->stream, 0, SEEK_CUR) != 0;
    if (writer->buffered) writer->stream = open_memstream(&writer->memory, &writer->memory_size);
    if (!writer->stream) return error_set(error, RESULT_FAILED, "%s: no memory", file->path);
    put_header(writer, false, 0);
    return RESULT_OK;
}

// All but closing the file.
static Result end(AbcWriter *writer, Error *error)
{
    uint64_t root = put_archive(writer);
    FILE *stream = writer->stream;
    if (writer->failed) return error_set(error, RESULT_FAILED, "%s: no memory", writer->file.path);
    if (!writer->buffered) {
        if (fseek(stream, 0, SEEK_SET) == 0) put_header(writer, true, root);
        fseek(stream, 0, SEEK_END);
        return RESULT_OK;
    }
    // What a stream in memory ends with is where it stands.
    fflush(stream);
    size_t size = writer->memory_size;
    writer->stream = writer->file.stream;
    put_header(writer, true, root);
    fwrite(writer->memory + HEADER_BYTES, 1, size - HEADER_BYTES, writer->file.stream);
    writer->stream = stream;
    return RESULT_OK;
}

Result abc_writer_open(AbcWriter *writer, const char *path, const Strands *strands,
                       const CurvesOptions *options, Error *error)
{
    OutFile file;
    *writer = (AbcWriter){0};
    TRY(outfile_open(&file, path, error));
    Result result = begin(writer, &file, strands, options, error);
    if (result != RESULT_OK) abc_writer_discard(writer);
    return result;
}

static bool make_room(AbcWriter *writer)
{
    if (writer->frame_count < writer->room) return true;
    size_t room = 2 * writer->room + 64;
    uint64_t *samples = realloc(writer->samples, room * sizeof *samples);
    if (samples) writer->samples = samples;
    double(*boxes)[6] = realloc(writer->boxes, room * sizeof *boxes);
    if (boxes) writer->boxes = boxes;
    if (samples && boxes) writer->room = room;
    return samples && boxes;
}

Result abc_writer_add(AbcWriter *writer, int number, const float (*positions)[3], Error *error)
{
    Block block = {0};
    if (!make_room(writer))
        return error_set(error, RESULT_FAILED, "%s: no memory for a frame", writer->file.path);
    double *box = writer->boxes[writer->frame_count];
    for (int k = 0; k < 3; ++k) box[k] = INFINITY, box[3 + k] = -INFINITY;
    for (uint32_t v = 0; v < writer->strands->vertex_count; ++v)
        for (int k = 0; k < 3; ++k) {
            add_float(&block, positions[v][k]);
            box[k] = fmin(box[k], (double)positions[v][k]);
            box[3 + k] = fmax(box[3 + k], (double)positions[v][k]);
        }
    if (writer->frame_count == 0) writer->first = number;
    writer->last = number;
    writer->samples[writer->frame_count++] = put_sample(writer, &block, 4);
    if (writer->failed)
        return error_set(error, RESULT_FAILED, "%s: no memory for a frame", writer->file.path);
    return !writer->buffered && ferror(writer->stream) ? outfile_check(&writer->file, error)
                                                       : RESULT_OK;
}

static void release(AbcWriter *writer)
{
    if (writer->buffered && writer->stream) fclose(writer->stream);
    free(writer->memory);
    free(writer->samples);
    free(writer->boxes);
}

Result abc_writer_finish(AbcWriter *writer, Error *error)
{
    Result result = writer->frame_count ? end(writer, error)
                                        : error_set(error, RESULT_FAILED, "%s: no frame to write",
                                                    writer->file.path);
    THEN(result, outfile_commit(&writer->file, error));
    abc_writer_discard(writer);
    return result;
}

void abc_writer_discard(AbcWriter *writer)
{
    release(writer);
    outfile_discard(&writer->file);
    *writer = (AbcWriter){0};
}

Result abc_write_strands(OutFile *file, const Strands *strands, Error *error)
{
    AbcWriter writer;
    const CurvesOptions options = {.metres_per_unit = strands->unit > 0 ? strands->unit : 1,
                                   .up_z = strands->up_z};
    Result result = begin(&writer, file, strands, &options, error);
    THEN(result, abc_writer_add(&writer, 0, (const float(*)[3])strands->position, error));
    THEN(result, end(&writer, error));
    release(&writer);
    return result;
}
