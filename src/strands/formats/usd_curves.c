// SPDX-License-Identifier: MIT
#include "strands/formats/usd_curves.h"

#include <stdlib.h>
#include <string.h>

const char *const USD_ARRAY_NAMES[USD_ARRAYS] = {
    "curveVertexCounts",       "points",      "widths",       "primvars:displayColor",
    "primvars:displayOpacity", "primvars:st", "primvars:st1", "primvars:thickness",
    "primvars:mobility"};

static void fail_count(Reader *reader, const UsdCurves *curves, int array)
{
    reader->line = curves->array[array].line;
    reader_fail(reader, "%s: %zu numbers for these curves", USD_ARRAY_NAMES[array],
                curves->array[array].count);
}

// UsdValues of `width` floats, one for each vertex: as they are, or those of the strand, or the
// only one. NULL if there are none.
static float *spread(Reader *reader, const UsdCurves *curves, int array, const Strands *strands,
                     size_t width)
{
    const UsdValues *values = &curves->array[array];
    size_t count = values->count / width;
    bool each = count == strands->vertex_count, uniform = count == strands->strand_count;
    if (!values->line || values->count == 0 || !reader_ok(reader)) return NULL;
    if (values->count % width != 0 || !(each || uniform || count == 1)) {
        fail_count(reader, curves, array);
        return NULL;
    }
    float *spread = malloc(strands->vertex_count * width * sizeof *spread + 1);
    if (!spread) reader_fail_memory(reader);
    for (uint32_t s = 0; spread && s < strands->strand_count; ++s)
        for (uint32_t v = strands->first[s]; v < strands->first[s + 1]; ++v)
            memcpy(spread + v * width,
                   values->value + (each      ? v
                                    : uniform ? s
                                              : 0) *
                                       width,
                   width * sizeof *spread);
    return spread;
}

// The values themselves, of which there must be so many.
static void *keep(Reader *reader, UsdCurves *curves, int array, size_t count)
{
    UsdValues *values = &curves->array[array];
    if (!values->line || values->count == 0 || !reader_ok(reader)) return NULL;
    if (values->count != count) fail_count(reader, curves, array);
    void *kept = values->value;
    values->value = NULL;
    return kept;
}

static void set_colors(Reader *reader, const UsdCurves *curves, Strands *strands)
{
    float *color = spread(reader, curves, USD_COLOR, strands, 3);
    float *opacity = spread(reader, curves, USD_OPACITY, strands, 1);
    bool any = color || opacity;
    if (any) strands->color = malloc(((size_t)strands->vertex_count + 1) * sizeof *strands->color);
    if (any && !strands->color) reader_fail_memory(reader);
    for (uint32_t v = 0; strands->color && v < strands->vertex_count; ++v) {
        for (int k = 0; k < 3; ++k) strands->color[v][k] = color ? color[3 * v + k] : 1;
        strands->color[v][3] = opacity ? opacity[v] : 1;
    }
    free(color);
    free(opacity);
}

static void set_attributes(Reader *reader, UsdCurves *curves, Strands *strands)
{
    size_t strand_count = strands->strand_count, vertices = strands->vertex_count;
    strands->vertex_thickness = spread(reader, curves, USD_WIDTHS, strands, 1);
    set_colors(reader, curves, strands);
    if (curves->array[USD_ST].count == 2 * vertices)
        strands->vertex_uv = keep(reader, curves, USD_ST, 2 * vertices);
    else
        strands->strand_uv = keep(reader, curves, USD_ST, 2 * strand_count);
    if (!strands->vertex_uv) strands->vertex_uv = keep(reader, curves, USD_ST1, 2 * vertices);
    strands->strand_thickness = keep(reader, curves, USD_THICKNESS, strand_count);
    strands->mobility = keep(reader, curves, USD_MOBILITY, vertices);
    strands->followers = (uint32_t)(curves->followers > 0 ? curves->followers : 0);
    strands->follower_radius = curves->follower_radius;
    strands->both_ends_fixed = curves->both_ends_fixed != 0;
}

static void set_sizes(Reader *reader, const UsdCurves *curves, Strands *strands)
{
    const UsdValues *counts = &curves->array[USD_COUNTS];
    uint64_t vertices = 0;
    for (size_t s = 0; s < counts->count && reader_ok(reader); ++s) {
        float size = counts->value[s];
        if (!(size >= 0 && size <= strands->vertex_count && size == (float)(uint32_t)size))
            fail_count(reader, curves, USD_COUNTS);
        if (reader_ok(reader)) vertices += (uint64_t)size;
        strands->first[s + 1] = (uint32_t)vertices;
        if (vertices > strands->vertex_count) break;
    }
    if (vertices != strands->vertex_count) fail_count(reader, curves, USD_POINTS);
}

static void check_kind(Reader *reader, const UsdCurves *curves)
{
    reader->line = curves->line;
    if (strcmp(curves->type, "linear") != 0)
        reader_fail(reader, "curves of type %s: only linear ones are read",
                    *curves->type ? curves->type : "cubic");
    if (strcmp(curves->wrap, "periodic") == 0)
        reader_fail(reader, "periodic curves: strands have ends");
}

Result usd_curves_make(Strands *strands, Reader *reader, UsdCurves *curves)
{
    const UsdValues *points = &curves->array[USD_POINTS];
    uint32_t line = reader->line;
    *strands = (Strands){0};
    check_kind(reader, curves);
    if (points->count % 3 || points->count >= UINT32_MAX ||
        curves->array[USD_COUNTS].count >= UINT32_MAX)
        fail_count(reader, curves, USD_POINTS);
    if (!reader_ok(reader)) return reader->result;
    if (strands_create(strands, (uint32_t)curves->array[USD_COUNTS].count,
                       (uint32_t)(points->count / 3), NULL) != RESULT_OK)
        return reader_fail_memory(reader);
    memcpy(strands->position, points->value, points->count * sizeof(float));
    set_sizes(reader, curves, strands);
    if (reader_ok(reader)) set_attributes(reader, curves, strands);
    if (reader_ok(reader)) reader->line = line;
    return reader->result;
}

void usd_curves_destroy(UsdCurves *curves)
{
    for (int i = 0; i < USD_ARRAYS; ++i) free(curves->array[i].value);
    *curves = (UsdCurves){0};
}
