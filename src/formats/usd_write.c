// SPDX-License-Identifier: MIT
#include "formats/usd_write.h"
#include "strands/strands_edit.h"

#include "base/decimal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// --- Arrays: values of `width` floats in brackets. An array takes one line, as in Pixar's own
// files, because some readers need that in time samples.

static void put_value(FILE *stream, const float *value, int width)
{
    if (width > 1) fputc('(', stream);
    for (int i = 0; i < width; ++i) decimal_put(stream, i ? ", " : "", value[i]);
    if (width > 1) fputc(')', stream);
}

// Writes values that lie `stride` floats apart.
static void put_list(FILE *stream, const float *values, size_t count, int width, size_t stride)
{
    fputc('[', stream);
    for (size_t i = 0; i < count; ++i) {
        if (i) fputs(", ", stream);
        put_value(stream, values + i * stride, width);
    }
    fputc(']', stream);
}

// Writes an attribute with its interpolation; nothing if `values` is NULL.
static void put_primvar(UsdWriter *writer, const char *type_and_name, const float *values,
                        CurvesRate rate, int width, size_t stride)
{
    static const char *const names[] = {"constant", "uniform", "vertex"};
    FILE *stream = writer->file.stream;
    if (!values) return;
    fprintf(stream, "    %s = ", type_and_name);
    put_list(stream, values, curves_look_count(writer->strands, rate), width, stride);
    fprintf(stream, " (\n        interpolation = \"%s\"\n    )\n", names[rate]);
}

// --- Attributes that are not animated.

static void put_layer(FILE *stream, const CurvesOptions *options)
{
    fprintf(stream, "#usda 1.0\n(\n    defaultPrim = \"Hair\"\n    doc = \"Tractrix\"\n");
    decimal_put(stream, "    metersPerUnit = ", (float)options->metres_per_unit);
    if (options->animated) {
        fprintf(stream, "\n    startTimeCode = %d\n    endTimeCode = %d", options->first,
                options->last);
        char rate[40];
        decimal_format_double(options->fps, rate, sizeof rate);
        fprintf(stream, "\n    timeCodesPerSecond = %s\n    framesPerSecond = %s", rate, rate);
    }
    fprintf(stream, "\n    upAxis = \"%c\"\n)\n\n", options->up_z ? 'Z' : 'Y');
}

// Attributes that the schema does not define.
static void put_wishes(FILE *stream, const Strands *strands)
{
    fprintf(stream, "    customData = {\n        dictionary tractrix = {\n");
    fprintf(stream, "            bool bothEndsFixed = %d\n", strands->both_ends_fixed);
    decimal_put(stream, "            float followerRadius = ", strands->follower_radius);
    fprintf(stream, "\n            int followers = %u\n        }\n    }\n", strands->followers);
}

static void put_metadata(FILE *stream, const Strands *strands)
{
    bool wishes =
             strands->followers || strands->follower_radius != 0.0f || strands->both_ends_fixed,
         fibre = fibre_is_known(&strands->fibre);
    if (!wishes && !fibre) return;
    fprintf(stream, " (\n");
    if (fibre)
        fprintf(stream, "    prepend apiSchemas = [\"MaterialBindingAPI\", "
                        "\"PhysicsCurvesDeformableSimAPI\"]\n");
    if (wishes) put_wishes(stream, strands);
    fputc(')', stream);
}

// --- The material of the fibres, as the physics schemas for deformable curves name it, in the
// unit of the file and kilograms.

static void put_thickness(const UsdWriter *writer)
{
    FILE *stream = writer->file.stream;
    const Fibre *fibre = &writer->strands->fibre;
    if (!fibre_is_known(fibre)) return;
    fprintf(stream, "    rel material:binding:physics = </Hair/Fibre>\n");
    if (!(fibre->radius > 0)) return;
    decimal_put(stream, "    float[] physics:thicknesses = [",
                (float)(2 * fibre->radius / writer->options.metres_per_unit));
    fprintf(stream, "]\n    uniform token physics:thicknesses:elementType = \"constant\"\n");
}

static void put_known(FILE *stream, const char *type_and_name, bool known, double value)
{
    if (!known) return;
    fprintf(stream, "        %s", type_and_name);
    decimal_put(stream, " = ", (float)value);
    fputc('\n', stream);
}

static void put_material(const UsdWriter *writer)
{
    FILE *stream = writer->file.stream;
    const Fibre *fibre = &writer->strands->fibre;
    double unit = writer->options.metres_per_unit;
    bool elastic = fibre->youngs_modulus > 0;
    if (!fibre_is_known(fibre)) return;
    fprintf(stream,
            "\n    def Material \"Fibre\" (\n        prepend apiSchemas = ["
            "\"PhysicsMaterialAPI\", \"PhysicsCurvesDeformableMaterialAPI\"]\n    )\n    {\n");
    put_known(stream, "float physics:density", fibre->density > 0,
              fibre->density * unit * unit * unit);
    put_known(stream, "float physics:poissonsRatio", elastic && fibre->poisson > -1,
              fibre->poisson);
    put_known(stream, "float physics:youngsModulus", elastic, fibre->youngs_modulus * unit);
    fprintf(stream, "    }\n");
}

static void put_groups(FILE *stream, const float *group, uint32_t count)
{
    fprintf(stream, "    int[] primvars:section = [");
    for (uint32_t s = 0; s < count; ++s) fprintf(stream, s ? ", %.0f" : "%.0f", (double)group[s]);
    fprintf(stream, "] (\n        interpolation = \"uniform\"\n    )\n");
}

static void put_sizes(FILE *stream, const Strands *strands)
{
    fprintf(stream, "    int[] curveVertexCounts = [");
    for (uint32_t s = 0; s < strands->strand_count; ++s)
        fprintf(stream, s ? ", %u" : "%u", strands_size(strands, s));
    fprintf(stream, "]\n");
}

static void put_color(UsdWriter *writer, const float (*color)[4], CurvesRate rate)
{
    bool transparent = false;
    for (size_t i = 0; color && i < curves_look_count(writer->strands, rate); ++i)
        transparent = transparent || color[i][3] != 1.0f;
    if (!color) return;
    put_primvar(writer, "color3f[] primvars:displayColor", color[0], rate, 3, 4);
    if (transparent)
        put_primvar(writer, "float[] primvars:displayOpacity", &color[0][3], rate, 1, 4);
}

static void put_attributes(UsdWriter *writer)
{
    const Strands *strands = writer->strands;
    const CurvesLook *look = &writer->options.look;
    uint32_t features = strands_features(strands);
    put_sizes(writer->file.stream, strands);
    put_thickness(writer);
    put_primvar(writer, "float[] widths", look->width, look->width_rate, 1, 1);
    put_color(writer, look->color, look->color_rate);
    if (features & STRANDS_HAS_STRAND_UV)
        put_primvar(writer, "texCoord2f[] primvars:st", strands->strand_uv[0], CURVES_UNIFORM, 2,
                    2);
    if (features & STRANDS_HAS_VERTEX_UV)
        put_primvar(writer, "texCoord2f[] primvars:st1", strands->vertex_uv[0], CURVES_VERTEX, 2,
                    2);
    put_primvar(writer, "float[] primvars:thickness", strands->strand_thickness, CURVES_UNIFORM, 1,
                1);
    if (features & STRANDS_HAS_MOBILITY)
        put_primvar(writer, "float[] primvars:mobility", strands->mobility, CURVES_VERTEX, 1, 1);
    if (features & STRANDS_HAS_GROUP)
        put_groups(writer->file.stream, strands->strand_group, strands->strand_count);
}

// Writes everything that is not animated. The writer takes ownership of the file.
static void begin(UsdWriter *writer, const OutFile *file, const Strands *strands,
                  const CurvesOptions *options)
{
    *writer = (UsdWriter){.file = *file, .strands = strands, .options = *options};
    CurvesLook *look = &writer->options.look;
    FILE *stream = writer->file.stream;
    curves_look_complete(look, strands);
    for (size_t i = 0; look->width && i < curves_look_count(strands, look->width_rate); ++i)
        writer->half_width = fmaxf(writer->half_width, look->width[i] / 2);
    put_layer(stream, &writer->options);
    fprintf(stream, "def BasisCurves \"Hair\"");
    put_metadata(stream, strands);
    fprintf(stream, "\n{\n    uniform token type = \"linear\"\n"
                    "    uniform token wrap = \"nonperiodic\"\n");
    if (strands_are_far(strands)) {
        double o[3];
        char text[3][40];
        strands_find_origin(strands, options->metres_per_unit, options->up_z, o);
        for (int k = 0; k < 3; ++k) decimal_format_double(o[k], text[k], sizeof text[k]);
        fprintf(stream,
                "    double3 xformOp:translate = (%s, %s, %s)\n"
                "    uniform token[] xformOpOrder = [\"xformOp:translate\"]\n",
                text[0], text[1], text[2]);
    }
    put_attributes(writer);
}

Result usd_writer_open(UsdWriter *writer, const char *path, const Strands *strands,
                       const CurvesOptions *options, Error *error)
{
    OutFile file;
    *writer = (UsdWriter){0};
    TRY(outfile_open(&file, path, error));
    begin(writer, &file, strands, options);
    return RESULT_OK;
}

// --- Frames.

// The bounding box of all points, grown by half a strand's width, as the schema requires.
static void find_extent(const UsdWriter *writer, const float (*positions)[3], float box[6])
{
    for (int axis = 0; axis < 3; ++axis) {
        float low = INFINITY, high = -INFINITY;
        for (uint32_t v = 0; v < writer->strands->vertex_count; ++v) {
            low = fminf(low, positions[v][axis]);
            high = fmaxf(high, positions[v][axis]);
        }
        box[axis] = low - writer->half_width;
        box[3 + axis] = high + writer->half_width;
    }
}

static bool make_room(UsdWriter *writer)
{
    if (writer->frame_count < writer->room) return true;
    size_t room = 2 * writer->room + 64;
    int *codes = realloc(writer->codes, room * sizeof *codes);
    if (codes) writer->codes = codes;
    float(*boxes)[6] = realloc(writer->boxes, room * sizeof *boxes);
    if (boxes) writer->boxes = boxes;
    if (codes && boxes) writer->room = room;
    return codes && boxes;
}

Result usd_writer_add(UsdWriter *writer, int code, const float (*positions)[3], Error *error)
{
    FILE *stream = writer->file.stream;
    if (!make_room(writer))
        return error_set(error, RESULT_FAILED, "%s: no memory for a frame", writer->file.path);
    size_t frame = writer->frame_count++;
    writer->codes[frame] = code;
    find_extent(writer, positions, writer->boxes[frame]);
    if (frame == 0)
        fputs(writer->options.animated ? "    point3f[] points.timeSamples = {\n"
                                       : "    point3f[] points = ",
              stream);
    if (writer->options.animated) fprintf(stream, "        %d: ", code);
    put_list(stream, positions[0], writer->strands->vertex_count, 3, 3);
    fputs(writer->options.animated ? ",\n" : "\n", stream);
    return ferror(stream) ? outfile_check(&writer->file, error) : RESULT_OK;
}

static void put_extents(UsdWriter *writer)
{
    FILE *stream = writer->file.stream;
    bool animated = writer->options.animated;
    if (animated) fprintf(stream, "    }\n    float3[] extent.timeSamples = {\n");
    for (size_t i = 0; i < writer->frame_count; ++i) {
        if (animated)
            fprintf(stream, "        %d: ", writer->codes[i]);
        else
            fprintf(stream, "    float3[] extent = ");
        put_list(stream, writer->boxes[i], 2, 3, 3);
        fputs(animated ? ",\n" : "\n", stream);
    }
    if (animated) fputs("    }\n", stream);
    put_material(writer);
    fputs("}\n", stream);
}

Result usd_writer_finish(UsdWriter *writer, Error *error)
{
    if (writer->frame_count == 0) {
        error_set(error, RESULT_FAILED, "%s: no frame to write", writer->file.path);
        usd_writer_discard(writer);
        return RESULT_FAILED;
    }
    put_extents(writer);
    Result result = outfile_commit(&writer->file, error);
    usd_writer_discard(writer);
    return result;
}

void usd_writer_discard(UsdWriter *writer)
{
    outfile_discard(&writer->file);
    free(writer->codes);
    free(writer->boxes);
    *writer = (UsdWriter){0};
}

Result usd_write_strands(OutFile *file, const Strands *strands, Error *error)
{
    UsdWriter writer;
    begin(&writer, file, strands, &(CurvesOptions){.metres_per_unit = 1});
    Result result = usd_writer_add(&writer, 0, (const float(*)[3])strands->position, error);
    if (result == RESULT_OK) put_extents(&writer);
    writer.file = (OutFile){0}; // the caller still owns the file
    usd_writer_discard(&writer);
    return result;
}
