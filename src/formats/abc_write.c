// SPDX-License-Identifier: MIT
// Writes the curve schema with its properties in the same order as Alembic's own writer (AbcGeom).
#include "formats/abc_write.h"
#include "strands/strands_edit.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LIBRARY_VERSION = 10800, HASH_BYTES = 32 };

// --- The strands' properties.

// AbcGeom's metadata of a property. AbcGeom calls the rates con, uni and vtx.
static void describe(char meta[160], CurvesRate rate, const char *interpretation, uint32_t extent,
                     const char *pod)
{
    static const char *const scopes[] = {"con", "uni", "vtx"};
    snprintf(meta, 160, "arrayExtent=1;geoScope=%s;%s%s%sisGeomParam=true;podExtent=%u;podName=%s",
             scopes[rate], *interpretation ? "interpretation=" : "", interpretation,
             *interpretation ? ";" : "", extent, pod);
}

// Adds floats that lie `stride` apart, each multiplied by `factor`.
static void add_floats(AbcWriter *writer, OgawaCompound *to, const char *name,
                       const char *interpretation, const float *value, CurvesRate rate,
                       uint32_t extent, uint32_t stride, double factor)
{
    OgawaBlock block = {0};
    char meta[160];
    if (!value) return;
    describe(meta, rate, interpretation, extent, "float32_t");
    for (size_t i = 0; i < curves_look_count(writer->strands, rate); ++i)
        for (uint32_t k = 0; k < extent; ++k)
            ogawa_add_float(&block, factor == 1 ? value[i * stride + k]
                                                : (float)(value[i * stride + k] * factor));
    ogawa_add_one(&writer->ogawa, to, name, meta, true, OGAWA_FLOAT, extent, &block);
}

static void add_single(AbcWriter *writer, OgawaCompound *to, const char *name, float value)
{
    add_floats(writer, to, name, "", &value, CURVES_CONSTANT, 1, 1, 1);
}

static void add_groups(AbcWriter *writer, OgawaCompound *to)
{
    OgawaBlock block = {0};
    char meta[160];
    describe(meta, CURVES_UNIFORM, "", 1, "int32_t");
    for (uint32_t s = 0; s < writer->strands->strand_count; ++s)
        ogawa_add_number(&block, (uint32_t)lrintf(writer->strands->strand_group[s]), 4);
    ogawa_add_one(&writer->ogawa, to, "groom_group_id", meta, true, OGAWA_I32, 1, &block);
}

// Unreal expects one colour for each vertex.
static void add_color(AbcWriter *writer, OgawaCompound *to)
{
    const Strands *strands = writer->strands;
    const CurvesLook *look = &writer->options.look;
    bool transparent = false;
    if (!look->color) return;
    float(*color)[4] = calloc((size_t)strands->vertex_count + 1, sizeof *color);
    writer->ogawa.failed = writer->ogawa.failed || !color;
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

static void add_version(AbcWriter *writer, OgawaCompound *to)
{
    static const struct {
        const char *name;
        uint32_t number;
    } versions[] = {{"groom_version_major", 1}, {"groom_version_minor", 5}};
    OgawaCompound user = {0};
    for (int i = 0; i < 2; ++i) {
        OgawaBlock block = {0};
        ogawa_add_number(&block, versions[i].number, 2);
        ogawa_add_one(&writer->ogawa, &user, versions[i].name, "", false, OGAWA_I16, 1, &block);
    }
    OgawaBlock tool = {0};
    ogawa_add_bytes(&tool, "Tractrix", sizeof "Tractrix");
    ogawa_add_one(&writer->ogawa, &user, "groom_tool", "", false, OGAWA_STRING, 1, &tool);
    ogawa_add_compound(&writer->ogawa, to, ".userProperties", "", &user);
}

// Attributes that are not part of AbcGeom's schema.
static void add_arbitrary(AbcWriter *writer, OgawaCompound *to)
{
    const Strands *strands = writer->strands;
    const CurvesLook *look = &writer->options.look;
    uint32_t features = strands_features(strands);
    OgawaCompound inner = {0};
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
    ogawa_add_compound(&writer->ogawa, to, ".arbGeomParams", "", &inner);
}

static void add_boxes(AbcWriter *writer, OgawaCompound *to)
{
    uint64_t *sample = malloc(writer->frame_count * sizeof *sample + 1);
    writer->ogawa.failed = writer->ogawa.failed || !sample;
    for (size_t i = 0; sample && i < writer->frame_count; ++i) {
        OgawaBlock block = {0};
        for (int k = 0; k < 6; ++k) ogawa_add_double(&block, writer->boxes[i][k]);
        sample[i] = ogawa_put_sample(&writer->ogawa, &block, 8);
    }
    if (sample)
        ogawa_add_samples(&writer->ogawa, to, ".selfBnds", "interpretation=box", false,
                          OGAWA_DOUBLE, 6, sample, writer->frame_count);
    free(sample);
}

static uint64_t put_curves(AbcWriter *writer)
{
    const Strands *strands = writer->strands;
    const CurvesLook *look = &writer->options.look;
    OgawaCompound geom = {0}, top = {0};
    OgawaBlock sizes = {0}, kind = {0};
    for (uint32_t s = 0; s < strands->strand_count; ++s)
        ogawa_add_number(&sizes, strands_size(strands, s), 4);
    ogawa_add_number(&kind, 1, 4); // linear, not periodic, no basis
    add_boxes(writer, &geom);
    ogawa_add_samples(&writer->ogawa, &geom, "P", "geoScope=vtx;interpretation=point", true,
                      OGAWA_FLOAT, 3, writer->samples, writer->frame_count);
    ogawa_add_one(&writer->ogawa, &geom, "nVertices", "", true, OGAWA_I32, 1, &sizes);
    ogawa_add_one(&writer->ogawa, &geom, "curveBasisAndType", "", false, OGAWA_U8, 4, &kind);
    if (strands_features(strands) & STRANDS_HAS_STRAND_UV)
        add_floats(writer, &geom, "uv", "vector", strands->strand_uv[0], CURVES_UNIFORM, 2, 2, 1);
    add_floats(writer, &geom, "width", "", look->width, look->width_rate, 1, 1, 1);
    add_arbitrary(writer, &geom);
    add_version(writer, &geom);
    ogawa_add_compound(&writer->ogawa, &top, ".geom",
                       "schema=AbcGeom_Curve_v2;schemaBaseType=AbcGeom_GeomBase_v1", &geom);
    return ogawa_put_compound(&writer->ogawa, &top);
}

static uint64_t put_transform(AbcWriter *writer)
{
    OgawaCompound own = {0}, top = {0};
    OgawaBlock inherits = {0}, steps = {0}, values = {0};
    if (strands_are_far(writer->strands)) {
        enum { TRANSLATE = 1 }; // AbcGeom's XformOperationType
        double o[3];
        strands_find_origin(writer->strands, writer->options.metres_per_unit, writer->options.up_z,
                            o);
        ogawa_add_number(&steps, TRANSLATE << 4, 1);
        for (int k = 0; k < 3; ++k) ogawa_add_double(&values, o[k]);
    }
    ogawa_add_number(&inherits, 1, 1);
    ogawa_add_one(&writer->ogawa, &own, ".inherits", "", false, OGAWA_BOOL, 1, &inherits);
    if (steps.size) {
        ogawa_add_one(&writer->ogawa, &own, ".ops", "", false, OGAWA_U8, 1, &steps);
        ogawa_add_one(&writer->ogawa, &own, ".vals", "", false, OGAWA_DOUBLE, 3, &values);
    }
    add_version(writer, &own);
    ogawa_add_compound(&writer->ogawa, &top, ".xform", "schema=AbcGeom_Xform_v3", &own);
    return ogawa_put_compound(&writer->ogawa, &top);
}

// --- Objects.

// Writes an object with properties and at most one child. Readers compare objects by their hashes;
// here the hash is that of the parts' file offsets, which differ between objects.
static uint64_t put_object(AbcWriter *writer, uint64_t properties, const char *name,
                           const char *meta, uint64_t child)
{
    OgawaBlock headers = {0}, named = {0};
    uint64_t part[3] = {properties}, key[2], count = 1;
    if (child) {
        part[count++] = child;
        ogawa_add_number(&headers, strlen(name), 4);
        ogawa_add_text(&headers, name);
        ogawa_add_number(&headers, 0xff, 1);
        ogawa_add_number(&headers, strlen(meta), 4);
        ogawa_add_text(&headers, meta);
    }
    ogawa_add_number(&named, properties, 8);
    ogawa_add_number(&named, child, 8);
    ogawa_find_key(named.data, named.size, 8, key);
    for (int i = 0; i < HASH_BYTES / 8; ++i) ogawa_add_number(&headers, key[i % 2], 8);
    free(named.data);
    part[count] = ogawa_put_data(&writer->ogawa, &headers);
    return ogawa_put_group(&writer->ogawa, part, count + 1);
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

static void add_sampling(OgawaBlock *block, size_t most, double cycle, double first)
{
    ogawa_add_number(block, most, 4);
    ogawa_add_double(block, cycle);
    ogawa_add_number(block, 1, 4);
    ogawa_add_double(block, first);
}

static uint64_t put_archive(AbcWriter *writer)
{
    const CurvesOptions *options = &writer->options;
    OgawaBlock version = {0}, library = {0}, meta = {0}, samplings = {0}, texts = {0};
    char about[160];
    uint64_t part[6];
    ogawa_add_number(&version, 0, 4);
    ogawa_add_number(&library, LIBRARY_VERSION, 4);
    snprintf(about, sizeof about, "_ai_Application=Tractrix;metersPerUnit=%.17g;upAxis=%c",
             options->metres_per_unit, options->up_z ? 'Z' : 'Y');
    ogawa_add_text(&meta, about);
    add_sampling(&samplings, 1, 1, 0);
    if (writer->frame_count > 1) {
        double every = (double)(writer->last - writer->first) / (double)(writer->frame_count - 1);
        add_sampling(&samplings, writer->frame_count, every / options->fps,
                     writer->first / options->fps);
    }
    part[0] = ogawa_put_data(&writer->ogawa, &version);
    part[1] = ogawa_put_data(&writer->ogawa, &library);
    part[2] = put_objects(writer);
    part[3] = ogawa_put_data(&writer->ogawa, &meta);
    part[4] = ogawa_put_data(&writer->ogawa, &samplings);
    part[5] = ogawa_put_data(&writer->ogawa, &texts);
    return ogawa_put_group(&writer->ogawa, part, 6);
}

static Result begin(AbcWriter *writer, const OutFile *file, const Strands *strands,
                    const CurvesOptions *options, Error *error)
{
    *writer = (AbcWriter){
        .file = *file, .ogawa = {.stream = file->stream}, .strands = strands, .options = *options};
    curves_look_complete(&writer->options.look, strands);
    // The root's offset in the header is only known at the end. A pipe, or a file that output is
    // appended to, cannot be rewound to write it, so the content is buffered in memory.
    writer->buffered = !file->temporary;
    if (writer->buffered)
        writer->ogawa.stream = open_memstream(&writer->memory, &writer->memory_size);
    if (!writer->ogawa.stream) return error_set(error, RESULT_FAILED, "%s: no memory", file->path);
    ogawa_put_header(&writer->ogawa, false, 0);
    return RESULT_OK;
}

// Writes everything but does not close the file.
static Result end(AbcWriter *writer, Error *error)
{
    uint64_t root = put_archive(writer);
    FILE *stream = writer->ogawa.stream;
    if (writer->ogawa.failed)
        return error_set(error, RESULT_FAILED, "%s: no memory", writer->file.path);
    if (!writer->buffered) {
        bool there = fseek(stream, 0, SEEK_SET) == 0;
        if (there) ogawa_put_header(&writer->ogawa, true, root);
        if (there && fseek(stream, 0, SEEK_END) == 0) return RESULT_OK;
        return error_set(error, RESULT_FAILED, "%s: %s", writer->file.path, strerror(errno));
    }
    // A memory stream reports its current position as its size after a flush.
    if (fflush(stream) != 0 || ferror(stream))
        return error_set(error, RESULT_FAILED, "%s: no memory", writer->file.path);
    size_t size = writer->memory_size;
    writer->ogawa.stream = writer->file.stream;
    ogawa_put_header(&writer->ogawa, true, root);
    fwrite(writer->memory + OGAWA_HEADER_BYTES, 1, size - OGAWA_HEADER_BYTES, writer->file.stream);
    writer->ogawa.stream = stream;
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
    OgawaBlock block = {0};
    if (!make_room(writer))
        return error_set(error, RESULT_FAILED, "%s: no memory for a frame", writer->file.path);
    double *box = writer->boxes[writer->frame_count];
    for (int k = 0; k < 3; ++k) box[k] = INFINITY, box[3 + k] = -INFINITY;
    for (uint32_t v = 0; v < writer->strands->vertex_count; ++v)
        for (int k = 0; k < 3; ++k) {
            ogawa_add_float(&block, positions[v][k]);
            box[k] = fmin(box[k], (double)positions[v][k]);
            box[3 + k] = fmax(box[3 + k], (double)positions[v][k]);
        }
    if (writer->frame_count == 0) writer->first = number;
    writer->last = number;
    writer->samples[writer->frame_count++] = ogawa_put_sample(&writer->ogawa, &block, 4);
    if (writer->ogawa.failed)
        return error_set(error, RESULT_FAILED, "%s: no memory for a frame", writer->file.path);
    return !writer->buffered && ferror(writer->ogawa.stream) ? outfile_check(&writer->file, error)
                                                             : RESULT_OK;
}

static void release(AbcWriter *writer)
{
    if (writer->buffered && writer->ogawa.stream) fclose(writer->ogawa.stream);
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
