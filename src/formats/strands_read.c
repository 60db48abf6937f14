// SPDX-License-Identifier: MIT
#include "formats/strands_read.h"

#include "base/doubles.h"
#include "formats/foreign.h"
#include "formats/strands_mend.h"
#include "strands/strands_edit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

// --- Detection.

// Names the format of a zip archive. A zip archive begins with "PK" and has the name of its first
// file at byte 30.
static Result refuse_zip(Reader *reader)
{
    bool usd = memmem(reader->data, reader->size < 300 ? reader->size : 300, ".usd", 4) != NULL;
    if (usd)
        return reader_fail(reader, "not supported: a USD package (.usdz): " FOREIGN_BLENDER_HAIR);
    return reader_fail(
        reader,
        "not supported: a zip archive: unpack it (a .npz file would begin with a .npy file)");
}

// XGen files begin with a comment like those of Wavefront files.
static bool is_xgen(const Bytes *bytes)
{
    const char *text = (const char *)bytes->data;
    return text[0] == '#' && strncasecmp(text + 1 + strspn(text + 1, " "), "xgen", 4) == 0;
}

// Whether the second line of the text has at least two numbers and nothing else. The first line may
// name the columns.
static bool is_table(const Reader *reader)
{
    const char *text = (const char *)reader->data, *line = strchr(text, '\n');
    int numbers = 0;
    for (const char *at = line ? line + 1 : ""; *at && *at != '\n'; numbers++) {
        char *end;
        at += strspn(at, " \t");
        strtod(at, &end);
        if (end == at) return false;
        at = end + strspn(end, " \t,;\r");
    }
    return numbers >= 2;
}

static Result refuse_unknown(Reader *reader, bool xgen)
{
    char names[400];
    if (reader->size == 0) return reader_fail(reader, "the file is empty");
    if (xgen)
        return reader_fail(reader, "not supported: an XGen description: export its curves as "
                                   "Alembic in Maya");
    if (reader->size >= 4 && memcmp(reader->data, "PK\x03\x04", 4) == 0) return refuse_zip(reader);
    const ForeignFile *foreign = foreign_find(reader->data, reader->size);
    if (foreign) return reader_fail(reader, "not supported: %s: %s", foreign->name, foreign->hair);
    size_t head = reader->size < 4096 ? reader->size : 4096;
    if (reader->data[strspn((const char *)reader->data, " \t\r\n")] == '{' &&
        memmem(reader->data, head, "\"asset\"", 7))
        return reader_fail(reader,
                           "not supported: GLTF, a scene of triangles: it keeps no strands: export "
                           "Alembic, USD or Wavefront lines");
    if (reader->data[strspn((const char *)reader->data, " \t\r\n")] == '{' &&
        (memmem(reader->data, head, "\"sections\"", 10) ||
         memmem(reader->data, head, "\"bodies\"", 8)))
        return reader_fail(reader, "a scene file, not a hair file: tractrix-render draws it");
    if (is_table(reader))
        return reader_fail(reader,
                           "a table of numbers, not a hair file: save it with numpy as an array of "
                           "shape (strands, points, 3) (docs/formats.md#numpy)");
    format_list_names(names, sizeof names);
    return reader_fail(reader, "not a hair file: expected %s", names);
}

// --- Unit.

enum { LENGTH_SAMPLES = 1024 };
static const double HEAD_SIZE = 0.35; // m, see strands_read

// Diagonal of the bounding box of all finite vertices, in the file's unit. `with_origin` includes
// the origin in the box.
static double measure_diagonal(const FormatSource *source, bool with_origin)
{
    double scale = source->scale != 0.0 ? fabs(source->scale) : 1.0, square = 0.0;
    for (int axis = 0; axis < 3; axis++) {
        float low = with_origin ? 0.0f : INFINITY, high = with_origin ? 0.0f : -INFINITY;
        for (uint32_t v = 0; v < source->strands.vertex_count; v++) {
            float x = source->strands.position[v][axis];
            if (!isfinite(x)) continue;
            if (x < low) low = x;
            if (x > high) high = x;
        }
        if (high > low) square += ((double)high - low) * ((double)high - low);
    }
    return scale * sqrt(square);
}

static double source_length(const FormatSource *source, uint32_t s)
{
    const Strands *strands = &source->strands;
    double length = 0;
    for (uint32_t v = strands->first[s] + 1; v < strands->first[s + 1]; v++) {
        const float *a = strands->position[v - 1], *b = strands->position[v];
        double x = (double)b[0] - a[0], y = (double)b[1] - a[1], z = (double)b[2] - a[2];
        double step = sqrt(x * x + y * y + z * z);
        if (isfinite(step)) length += step;
    }
    return source->scale != 0.0 ? length * fabs(source->scale) : length;
}

// Median length of at most LENGTH_SAMPLES strands, in the file's unit.
static double median_length(const FormatSource *source)
{
    double length[LENGTH_SAMPLES] = {0};
    uint32_t count = 0, stride = source->strands.strand_count / LENGTH_SAMPLES + 1;
    for (uint32_t s = 0; s < source->strands.strand_count; s += stride)
        length[count++] = source_length(source, s);
    doubles_sort(length, count);
    return count ? length[count / 2] : 0;
}

static float guess_unit(const FormatSource *source, const Format *format)
{
    if (format->centimetres) return measure_diagonal(source, true) < 5.0 ? 1.0f : 0.01f;
    double size = sqrt(measure_diagonal(source, false) * median_length(source));
    // The limit between two units is the geometric mean of the sizes that a head has in them.
    if (size < HEAD_SIZE * sqrt(100.0)) return 1.0f;
    return size < HEAD_SIZE * sqrt(100.0 * 1000.0) || format->no_millimetres ? 0.01f : 0.001f;
}

// --- Conversion.

// The rotation of AMD's loader, DirectX's XMMatrixRotationRollPitchYaw(x, y, z): about z, then x,
// then y.
static void make_rotation(const double angle[3], double r[3][3])
{
    double cx = cos(angle[0]), sx = sin(angle[0]), cy = cos(angle[1]), sy = sin(angle[1]);
    double cz = cos(angle[2]), sz = sin(angle[2]);
    double rotation[3][3] = {
        {cy * cz + sy * sx * sz, sy * sx * cz - cy * sz, sy * cx},
        {cx * sz, cx * cz, -sx},
        {cy * sx * sz - sy * cz, sy * sz + cy * sx * cz, cy * cx},
    };
    memcpy(r, rotation, sizeof rotation);
}

// To metres, y up: p' = unit * (translation + rotation * (scale * p)), then (x, y, z) -> (x, z, -y)
// if `up_z`. Computed in double and rounded once. If nothing is to be converted, bits do not
// change.
static void convert_positions(const FormatSource *source, float (*positions)[3], size_t count,
                              double unit, bool up_z, const double origin[3])
{
    double rotation[3][3], scale = source->scale != 0.0 ? source->scale : 1.0;
    make_rotation(source->rotation, rotation);
    bool rotated =
        source->rotation[0] != 0.0 || source->rotation[1] != 0.0 || source->rotation[2] != 0.0;
    for (size_t v = 0; v < count; v++) {
        float *position = positions[v];
        double p[3] = {position[0] * scale, position[1] * scale, position[2] * scale};
        double q[3] = {p[0], p[1], p[2]};
        for (int i = 0; i < 3 && rotated; i++)
            q[i] = rotation[i][0] * p[0] + rotation[i][1] * p[1] + rotation[i][2] * p[2];
        // Adding 0 would turn -0 into 0.
        for (int i = 0; i < 3; i++)
            if (source->translation[i] != 0.0) q[i] += source->translation[i];
        for (int i = 0; i < 3; i++)
            if (source->origin[i] != 0.0) q[i] += source->origin[i];
        double to[3] = {q[0] * unit, (up_z ? q[2] : q[1]) * unit, (up_z ? -q[1] : q[2]) * unit};
        for (int i = 0; i < 3; i++)
            position[i] = (float)(origin[i] != 0.0 ? to[i] - origin[i] : to[i]);
    }
}

// The middle of the hair in whole metres, y up, if it is far from 0 compared with its size.
static void find_origin(const FormatSource *source, double unit, bool up_z, double origin[3])
{
    const Strands *strands = &source->strands;
    double middle[3] = {0}, scale = source->scale != 0.0 ? source->scale : 1.0;
    double diagonal = measure_diagonal(source, false) * unit;
    memset(origin, 0, 3 * sizeof *origin);
    if (strands->vertex_count == 0) return;
    for (int k = 0; k < 3; k++)
        middle[k] = ((double)strands->position[0][k] * scale + source->origin[k]) * unit;
    double largest = fmax(fabs(middle[0]), fmax(fabs(middle[1]), fabs(middle[2])));
    if (!(largest > 100 && largest > 20 * diagonal && largest < 1e12)) return;
    origin[0] = round(middle[0]);
    origin[1] = round(up_z ? middle[2] : middle[1]);
    origin[2] = round(up_z ? -middle[1] : middle[2]);
}

static void convert(FormatSource *source, double unit, bool up_z, const StrandsReadOptions *options)
{
    Strands *strands = &source->strands;
    if (options->recenters)
        find_origin(source, unit, up_z, strands->origin);
    else if (options->origin)
        memcpy(strands->origin, options->origin, sizeof strands->origin);
    const double *origin = strands->origin;
    double scale = source->scale != 0.0 ? source->scale : 1.0;
    double of_thickness = source->thickness_unit > 0 ? source->thickness_unit : unit;
    convert_positions(source, strands->position, strands->vertex_count, unit, up_z, origin);
    if (source->frames)
        convert_positions(source, source->frames, (size_t)source->samples * strands->vertex_count,
                          unit, up_z, origin);
    for (uint32_t v = 0; strands->vertex_thickness && v < strands->vertex_count; v++)
        strands->vertex_thickness[v] =
            (float)(strands->vertex_thickness[v] * of_thickness * fabs(scale));
    strands->follower_radius = (float)(strands->follower_radius * unit * fabs(scale));
    strands->fibre.youngs_modulus /= unit; // a mass per length and square time
    strands->fibre.density /= unit * unit * unit;
    strands->fibre.radius *= unit;
}

// --- Reading.

static void report_source(StrandsReport *report, const FormatSource *source, FormatKind kind)
{
    report->kind = kind;
    report->version = source->version;
    report->declared_strands = source->strands.strand_count;
    report->declared_vertices = source->strands.vertex_count;
    report->shuffled = source->shuffle;
    report->samples = source->samples;
    report->rotation_was_deg = source->rotation_was_deg;
    memcpy(report->note, source->note, sizeof report->note);
    report->flaws = source->flaws;
    report->contents = source->contents;
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
    if (!describe_first_defect(report, name, text, sizeof text)) {
        if (!report->flaws) return RESULT_OK;
        snprintf(text, sizeof text, "%.90s: %s", name, report->note);
    }
    return error_set(error, RESULT_BAD_INPUT, "%s (refused because of --strict)", text);
}

// The report is not printed for a file without a usable strand, so this message names the first
// defect.
static Result refuse_empty(const StrandsReport *report, const char *name, Error *error)
{
    char text[900];
    if (!describe_first_defect(report, name, text, sizeof text))
        snprintf(text, sizeof text, "%s: has only roots, no strands", name);
    return error_set(error, RESULT_BAD_INPUT, "%s (no usable strand among %u)", text,
                     report->declared_strands);
}

static Result finish(FormatSource *source, const char *name, const StrandsReadOptions *options,
                     StrandsReport *report, Error *error)
{
    const Format *format = FORMAT_TABLE[report->kind];
    float known = options->unit != 0.0f ? options->unit : source->unit;
    UpAxis up = options->up != UP_AUTO ? options->up : source->up;
    report->unit_guessed = known == 0.0f;
    report->unit_used = report->unit_guessed ? guess_unit(source, format) : known;
    report->up_guessed = up == UP_AUTO;
    report->up_z = report->up_guessed ? format->up_z : up == UP_Z;
    convert(source, (double)report->unit_used, report->up_z, options);
    TRY(strands_mend(source, name, report, error));
    const Strands *strands = &source->strands;
    if (source->shuffle && strands->strand_count > 1)
        TRY(strands_shuffle(&source->strands, options->seed, error));
    TRY(strands_report_measure(report, strands, error));
    if (options->strict) TRY(refuse_defects(report, name, error));
    return strands->strand_count ? RESULT_OK : refuse_empty(report, name, error);
}

// An option that would have no effect on this file is an error.
static Result check_wishes(const FormatSource *source, const char *name, const char *format,
                           Error *error)
{
    if (source->wishes.points_per_strand && !source->used_points)
        return error_set(
            error, RESULT_USAGE,
            "%s: --points-per-strand has no effect: this %s file itself says where strands end",
            name, format);
    if (source->wishes.array && !source->used_array)
        return error_set(error, RESULT_USAGE, "%s: --array has no effect: it is for .npz files",
                         name);
    if (source->wishes.objects && !source->used_objects)
        return error_set(error, RESULT_USAGE,
                         "%s: --object has no effect: it is for USD and Alembic files", name);
    return RESULT_OK;
}

// Reads, mends and measures. The strands stay in `source`.
static Result read_source(FormatSource *source, const char *name, const Bytes *bytes,
                          const StrandsReadOptions *options, StrandsReport *report, Error *error)
{
    bool xgen = is_xgen(bytes);
    // Every text that begins with # might be a Wavefront file.
    bool other =
        xgen || (bytes->size && bytes->data[0] == '#' && foreign_find(bytes->data, bytes->size));
    FormatKind kind = other ? FORMAT_KINDS : format_detect(bytes);
    const Format *format = kind < FORMAT_KINDS ? FORMAT_TABLE[kind] : NULL;
    Reader reader = format && format->text ? reader_begin_text(name, bytes, error)
                                           : reader_begin_binary(name, bytes, error);
    source->wishes.points_per_strand = options->points_per_strand;
    source->wishes.array = options->array && *options->array ? options->array : NULL;
    source->wishes.objects = options->objects && *options->objects ? options->objects : NULL;
    Result result = format ? format->read(source, &reader) : refuse_unknown(&reader, xgen);
    if (result != RESULT_OK || !format) return result;
    TRY(check_wishes(source, name, format->name, error));
    report_source(report, source, kind);
    return finish(source, name, options, report, error);
}

static Result read_bytes(Strands *strands, StrandsFrames *frames, const char *name,
                         const Bytes *bytes, const StrandsReadOptions *options,
                         StrandsReport *report, Error *error)
{
    StrandsReadOptions defaults = {0};
    StrandsReport unwanted;
    if (!report) report = &unwanted;
    *strands = (Strands){0};
    *report = (StrandsReport){.kind = FORMAT_KINDS};
    FormatSource source = {.wishes.all_frames = frames};
    Result result = read_source(&source, name, bytes, options ? options : &defaults, report, error);
    if (result == RESULT_OK) {
        *strands = source.strands;
        source.strands = (Strands){0};
    }
    if (result == RESULT_OK && frames && source.frames) {
        *frames = (StrandsFrames){.count = source.samples,
                                  .vertices = strands->vertex_count,
                                  .position = source.frames,
                                  .fps = source.fps,
                                  .first = source.first_frame};
        source.frames = NULL;
        report->all_samples = true;
    }
    format_source_destroy(&source);
    return result;
}

Result strands_read_bytes(Strands *strands, const char *name, const Bytes *bytes,
                          const StrandsReadOptions *options, StrandsReport *report, Error *error)
{
    return read_bytes(strands, NULL, name, bytes, options, report, error);
}

Result strands_read_frames(Strands *strands, StrandsFrames *frames, const char *path,
                           const StrandsReadOptions *options, StrandsReport *report, Error *error)
{
    *strands = (Strands){0};
    if (frames) *frames = (StrandsFrames){0};
    if (report) *report = (StrandsReport){.kind = FORMAT_KINDS};
    Bytes bytes;
    TRY(bytes_read_input(&bytes, path, error));
    // A byte order mark hides a text format from detection. Binary files are detected with it,
    // since their first number may have the same bytes.
    if (format_detect(&bytes) == FORMAT_KINDS) bytes_drop_mark(&bytes);
    Result result = read_bytes(strands, frames, path, &bytes, options, report, error);
    bytes_destroy(&bytes);
    return result;
}

Result strands_read(Strands *strands, const char *path, const StrandsReadOptions *options,
                    StrandsReport *report, Error *error)
{
    return strands_read_frames(strands, NULL, path, options, report, error);
}

void strands_frames_destroy(StrandsFrames *frames)
{
    free(frames->position);
    free(frames->first_vertex);
    *frames = (StrandsFrames){0};
}

// --- Hair in place of a mesh.

// Wavefront files are hair only if they have lines and no faces. USD, Alembic and numpy files may
// hold a mesh, too.
static void explain(const Bytes *bytes, const char *path, Error *error)
{
    FormatKind kind = format_detect(bytes);
    bool lines = memmem(bytes->data, bytes->size, "\nl ", 3) != NULL;
    bool faces = memmem(bytes->data, bytes->size, "\nf ", 3) != NULL;
    if (kind == FORMAT_KINDS || kind == FORMAT_PLY || kind == FORMAT_PLY_TEXT) return;
    if (kind == FORMAT_OBJ && (faces || !lines)) return;
    bool either =
        kind == FORMAT_USD || kind == FORMAT_ABC || kind == FORMAT_NPZ || kind == FORMAT_NPY;
    error_set(error, RESULT_BAD_INPUT,
              either ? "%s: %s, not OBJ or PLY: " FOREIGN_WANTS_MESH
                     : "%s: hair (%s), not a mesh: " FOREIGN_WANTS_MESH,
              path, FORMAT_TABLE[kind]->name);
}

Result strands_read_as_mesh(Result result, const char *path, Error *error)
{
    Bytes bytes;
    Error unread;
    // Standard input and pipes cannot be read twice.
    if (result != RESULT_BAD_INPUT || bytes_read_plain(&bytes, path, &unread) != RESULT_OK)
        return result;
    if (!foreign_find(bytes.data, bytes.size)) explain(&bytes, path, error);
    bytes_destroy(&bytes);
    return result;
}
