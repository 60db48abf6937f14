// SPDX-License-Identifier: MIT
#include "formats/ply_write.h"

#include "base/decimal.h"
#include "formats/format.h"
#include "image/image.h"

#include <endian.h>
#include <math.h>

static uint8_t level_of(double value)
{
    return (uint8_t)lround(255 * fmin(fmax(value, 0), 1));
}

static void put_header(FILE *stream, const Strands *strands, const char *format)
{
    fprintf(stream,
            "ply\nformat %s 1.0\ncomment Tractrix\nelement vertex %u\nproperty float x\n"
            "property float y\nproperty float z\n",
            format, strands->vertex_count);
    if (strands->color)
        fputs("property uchar red\nproperty uchar green\nproperty uchar blue\n"
              "property uchar alpha\n",
              stream);
    if (strands->vertex_thickness) fputs("property float thickness\n", stream);
    fprintf(stream,
            "element strand %u\nproperty ushort nsegs\nelement edge %u\nproperty int vertex1\n"
            "property int vertex2\nend_header\n",
            strands->strand_count, strands->vertex_count - strands->strand_count);
}

static void find_levels(const float color[4], uint8_t level[4])
{
    for (int k = 0; k < 3; k++) level[k] = level_of(image_srgb_from_linear((double)color[k]));
    level[3] = level_of((double)color[3]);
}

static Result check_sizes(const OutFile *file, const Strands *strands, Error *error)
{
    for (uint32_t s = 0; s < strands->strand_count; s++)
        if (strands_size(strands, s) > 65536)
            return error_set(error, RESULT_FAILED,
                             "%s: strand %u has %u vertices: .ply files hold at most 65536",
                             file->path, s, strands_size(strands, s));
    return RESULT_OK;
}

Result ply_write(OutFile *file, const Strands *strands, Error *error)
{
    FILE *stream = file->stream;
    TRY(check_sizes(file, strands, error));
    put_header(stream, strands, "binary_little_endian");
    for (uint32_t v = 0; v < strands->vertex_count; v++) {
        format_put_floats(stream, strands->position[v], 3);
        uint8_t level[4];
        if (strands->color) find_levels(strands->color[v], level);
        if (strands->color) fwrite(level, 1, 4, stream);
        if (strands->vertex_thickness) format_put_floats(stream, &strands->vertex_thickness[v], 1);
    }
    for (uint32_t s = 0; s < strands->strand_count; s++) {
        uint16_t segments = htole16((uint16_t)(strands_size(strands, s) - 1));
        fwrite(&segments, 2, 1, stream);
    }
    for (uint32_t s = 0; s < strands->strand_count; s++)
        for (uint32_t v = strands->first[s]; v + 1 < strands->first[s + 1]; v++) {
            format_put_u32(stream, v);
            format_put_u32(stream, v + 1);
        }
    return RESULT_OK;
}

Result ply_write_text(OutFile *file, const Strands *strands, Error *error)
{
    FILE *stream = file->stream;
    TRY(check_sizes(file, strands, error));
    put_header(stream, strands, "ascii");
    for (uint32_t v = 0; v < strands->vertex_count; v++) {
        uint8_t level[4];
        for (int k = 0; k < 3; k++) decimal_put(stream, k ? " " : "", strands->position[v][k]);
        if (strands->color) find_levels(strands->color[v], level);
        for (int k = 0; k < 4 && strands->color; k++) fprintf(stream, " %u", level[k]);
        if (strands->vertex_thickness) decimal_put(stream, " ", strands->vertex_thickness[v]);
        fputc('\n', stream);
    }
    for (uint32_t s = 0; s < strands->strand_count; s++)
        fprintf(stream, "%u\n", strands_size(strands, s) - 1);
    for (uint32_t s = 0; s < strands->strand_count; s++)
        for (uint32_t v = strands->first[s]; v + 1 < strands->first[s + 1]; v++)
            fprintf(stream, "%u %u\n", v, v + 1);
    return RESULT_OK;
}
