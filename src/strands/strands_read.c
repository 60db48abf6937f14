// SPDX-License-Identifier: MIT
#include "strands/strands_read.h"

#include "mesh/obj.h"
#include "strands/formats/hair_file.h"
#include "strands/formats/obj_file.h"
#include "strands/formats/salon_file.h"
#include "strands/formats/tfx_binary.h"
#include "strands/formats/tfx_text.h"
#include "strands/formats/usd_reader.h"
#include "strands/strands_mend.h"
#include "strands/strands_order.h"

#include <math.h>
#include <string.h>

// --- Detection.

static StrandsKind detect(const Bytes *bytes)
{
    if (hair_file_matches(bytes)) return STRANDS_HAIR;
    if (tfx_text_matches(bytes)) return STRANDS_TFX2_TEXT;
    if (usd_reader_matches(bytes)) return STRANDS_USD;
    if (obj_matches(bytes)) return STRANDS_OBJ;
    float version = tfx_binary_version(bytes);
    if (version > 0.0f) return version < 4.0f ? STRANDS_TFX3 : STRANDS_TFX4;
    int floats = salon_file_match(bytes);
    if (floats == SALON_DATA_FLOATS) return STRANDS_SALON_DATA;
    return floats == SALON_BIN_FLOATS ? STRANDS_SALON_BIN : STRANDS_KINDS;
}

static Result parse(StrandsSource *source, Reader *reader, StrandsKind kind)
{
    switch (kind) {
    case STRANDS_TFX2_TEXT:
        return tfx_text_read(source, reader);
    case STRANDS_TFX3:
        return tfx3_read(source, reader);
    case STRANDS_TFX4:
        return tfx4_read(source, reader);
    case STRANDS_HAIR:
        return hair_file_read(source, reader);
    case STRANDS_SALON_DATA:
        return salon_file_read(source, reader, SALON_DATA_FLOATS);
    case STRANDS_SALON_BIN:
        return salon_file_read(source, reader, SALON_BIN_FLOATS);
    case STRANDS_OBJ:
        return obj_file_read(source, reader);
    case STRANDS_USD:
        return usd_reader_read(source, reader);
    case STRANDS_KINDS:
        break;
    }
    if (reader->size == 0) return reader_fail(reader, "the file is empty");
    return reader_fail(reader,
                       "not hair: neither TressFX 2, 3 or 4, HAIR or Wavefront lines, nor whole "
                       "strands of USC-HairSalon or CT2Hair");
}

// --- Unit.

// Diagonal of the box around all usable vertices and, if told, the origin, in the file's unit.
static double measure_diagonal(const StrandsSource *source, bool with_origin)
{
    double scale = source->scale != 0.0 ? fabs(source->scale) : 1.0, square = 0.0;
    for (int axis = 0; axis < 3; axis++) {
        float low = with_origin ? 0.0f : INFINITY, high = with_origin ? 0.0f : -INFINITY;
        for (uint32_t v = 0; v < source->strands.vertex_count; v++) {
            float x = source->strands.position[v][axis];
            if (!isfinite(x)) continue;
            low = fminf(low, x);
            high = fmaxf(high, x);
        }
        if (high > low) square += ((double)high - low) * ((double)high - low);
    }
    return scale * sqrt(square);
}

static float guess_unit(const StrandsSource *source, StrandsKind kind)
{
    if (kind == STRANDS_TFX2_TEXT) return measure_diagonal(source, true) < 5.0 ? 1.0f : 0.01f;
    double diagonal = measure_diagonal(source, false);
    // Where the ratios of two units to 0.5 m are equal: d / 0.5 = 0.5 / (0.01 d), and so on.
    return diagonal < 5.0 ? 1.0f : diagonal < 158.0 ? 0.01f : 0.001f;
}

// --- Reading.

static void report_source(StrandsReport *report, const StrandsSource *source, StrandsKind kind)
{
    report->kind = kind;
    report->version = source->version;
    report->declared_strands = source->strands.strand_count;
    report->declared_vertices = source->strands.vertex_count;
    report->shuffled = source->shuffle;
    report->samples = source->samples;
    report->rotation_was_deg = source->rotation_was_deg;
}

static bool describe_first_defect(const StrandsReport *report, const char *name, char *text,
                                  size_t size)
{
    for (int kind = 0; kind < DEFECT_KINDS; kind++) {
        if (report->defects[kind].count == 0) continue;
        strands_report_describe(report, name, (DefectKind)kind, false, text, size);
        return true;
    }
    return false;
}

static Result refuse_defects(const StrandsReport *report, const char *name, Error *error)
{
    char text[900];
    if (!describe_first_defect(report, name, text, sizeof text)) return RESULT_OK;
    return error_set(error, RESULT_BAD_INPUT, "%s (refused: --strict)", text);
}

// The report is not printed for a file that leaves nothing, so its first defect is told here.
static Result refuse_empty(const StrandsReport *report, const char *name, Error *error)
{
    char text[900];
    if (!describe_first_defect(report, name, text, sizeof text))
        snprintf(text, sizeof text, "%s: nothing but roots", name);
    return error_set(error, RESULT_BAD_INPUT, "%s (no usable strand among %u)", text,
                     report->declared_strands);
}

static Result finish(StrandsSource *source, const char *name, const StrandsReadOptions *options,
                     StrandsReport *report, Error *error)
{
    float told = options->unit != 0.0f ? options->unit : source->unit;
    report->unit_guessed = told == 0.0f;
    report->unit_used = report->unit_guessed ? guess_unit(source, report->kind) : told;
    strands_convert(source, (double)report->unit_used, options->up_z || source->up_z);
    Result result = strands_mend(source, name, report, error);
    Strands *strands = &source->strands;
    if (result == RESULT_OK && source->shuffle && strands->strand_count > 1)
        result = strands_shuffle(strands, options->seed, error);
    if (result == RESULT_OK) result = strands_report_measure(report, strands, error);
    if (result == RESULT_OK && options->strict) result = refuse_defects(report, name, error);
    if (result == RESULT_OK && strands->strand_count == 0)
        result = refuse_empty(report, name, error);
    return result;
}

Result strands_read_bytes(Strands *strands, const char *name, const Bytes *bytes,
                          const StrandsReadOptions *options, StrandsReport *report, Error *error)
{
    StrandsReadOptions defaults = {0};
    StrandsReport unwanted;
    if (!options) options = &defaults;
    if (!report) report = &unwanted;
    *strands = (Strands){0};
    *report = (StrandsReport){.kind = STRANDS_KINDS};
    StrandsKind kind = detect(bytes);
    bool is_text = kind == STRANDS_TFX2_TEXT || kind == STRANDS_OBJ || kind == STRANDS_USD;
    Reader reader =
        is_text ? reader_begin_text(name, bytes, error) : reader_begin_binary(name, bytes, error);
    StrandsSource source = {0};
    Result result = parse(&source, &reader, kind);
    reader_end(&reader);
    if (result == RESULT_OK) {
        report_source(report, &source, kind);
        result = finish(&source, name, options, report, error);
    }
    if (result == RESULT_OK) {
        *strands = source.strands;
        source.strands = (Strands){0};
    }
    strands_source_destroy(&source);
    return result;
}

Result strands_read(Strands *strands, const char *path, const StrandsReadOptions *options,
                    StrandsReport *report, Error *error)
{
    *strands = (Strands){0};
    if (report) *report = (StrandsReport){.kind = STRANDS_KINDS};
    Bytes bytes;
    Result result = bytes_read_file(&bytes, path, error);
    if (result != RESULT_OK) return result;
    result = strands_read_bytes(strands, path, &bytes, options, report, error);
    bytes_destroy(&bytes);
    return result;
}
