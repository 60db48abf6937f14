// SPDX-License-Identifier: MIT
#include "strands/strands_write.h"

#include "base/decimal.h"
#include "base/outfile.h"
#include "strands/formats/hair_file.h"
#include "strands/formats/obj_file.h"
#include "strands/formats/tfx_binary.h"
#include "strands/formats/usd_file.h"

#include <endian.h>
#include <string.h>
#include <strings.h>

// --- Text.

static void put_parameters(FILE *stream, const Strands *strands)
{
    uint32_t longest = 0;
    for (uint32_t s = 0; s < strands->strand_count; s++)
        if (strands_size(strands, s) > longest) longest = strands_size(strands, s);
    fprintf(stream, "version 2.0\nscale 1.0\nrotation 0 0 0\ntranslation 0 0 0\n");
    fprintf(stream, "bothEndsImmovable %d\nmaxNumVerticesInStrand %u\n", strands->both_ends_fixed,
            longest);
    fprintf(stream, "numFollowHairsPerGuideHair %u\n", strands->followers);
    decimal_put(stream, "maxRadiusAroundGuideHair ", strands->follower_radius);
    fputc('\n', stream);
}

static void write_text(FILE *stream, const Strands *strands)
{
    if (strands->followers || strands->follower_radius != 0.0f || strands->both_ends_fixed)
        put_parameters(stream, strands);
    fprintf(stream, "numStrands %u\nis sorted 1\n", strands->strand_count);
    for (uint32_t s = 0; s < strands->strand_count; s++) {
        fprintf(stream, "strand %u numVerts %u texcoord", s, strands_size(strands, s));
        decimal_put(stream, " ", strands->strand_uv ? strands->strand_uv[s][0] : 0.0f);
        decimal_put(stream, " ", strands->strand_uv ? strands->strand_uv[s][1] : 0.0f);
        fputc('\n', stream);
        for (uint32_t v = strands->first[s]; v < strands->first[s + 1]; v++) {
            decimal_put(stream, "", strands->position[v][0]);
            decimal_put(stream, " ", strands->position[v][1]);
            decimal_put(stream, " ", strands->position[v][2]);
            fputc('\n', stream);
        }
    }
}

// --- Binary.

static void put_u32(FILE *stream, uint32_t value)
{
    value = htole32(value);
    fwrite(&value, 4, 1, stream);
}

static void put_floats(FILE *stream, const float *floats, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        uint32_t bits;
        memcpy(&bits, floats + i, 4);
        put_u32(stream, bits);
    }
}

static void put_zeros(FILE *stream, size_t bytes)
{
    while (bytes--) fputc(0, stream);
}

// The common number of vertices, or 0 with an error.
static uint32_t find_common_size(const Strands *strands, const char *path, Error *error)
{
    uint32_t size = strands->strand_count ? strands_size(strands, 0) : 0;
    for (uint32_t s = 1; s < strands->strand_count; s++) {
        if (strands_size(strands, s) == size) continue;
        error_set(error, RESULT_FAILED,
                  "%s: strand %u has %u vertices, strand 0 has %u; binary TressFX needs equal "
                  "numbers (text or HAIR take any)",
                  path, s, strands_size(strands, s), size);
        return 0;
    }
    return size;
}

// Steps `end` over an array of `count` times `floats` and returns where it starts; 0 if absent.
static uint32_t place_array(uint64_t *end, const void *array, uint64_t count, uint32_t floats)
{
    if (!array) return 0;
    uint64_t start = *end;
    *end += count * floats * 4;
    return (uint32_t)start;
}

static Result fail_too_large(const char *path, Error *error)
{
    return error_set(error, RESULT_FAILED, "%s: more than the 4 GiB that TressFX's offsets reach",
                     path);
}

static void put_counts(FILE *stream, float version, const Strands *strands, uint32_t size)
{
    put_floats(stream, &version, 1);
    put_u32(stream, strands->strand_count);
    put_u32(stream, size);
}

static void put_array(FILE *stream, const float *array, size_t count)
{
    if (array) put_floats(stream, array, count);
}

static Result write_tfx3(FILE *stream, const Strands *strands, const char *path, Error *error)
{
    uint32_t size = find_common_size(strands, path, error);
    if (size == 0) return RESULT_FAILED;
    uint64_t count = strands->vertex_count, lines = strands->strand_count, end = TFX3_HEADER_BYTES;
    uint32_t position = place_array(&end, strands->position, count, 3);
    uint32_t thickness = place_array(&end, strands->strand_thickness, lines, 1);
    uint32_t strand_uv = place_array(&end, strands->strand_uv, lines, 2);
    uint32_t color = place_array(&end, strands->color, count, 4);
    uint32_t vertex_uv = place_array(&end, strands->vertex_uv, count, 2);
    if (end > UINT32_MAX) return fail_too_large(path, error);
    put_counts(stream, 3.0f, strands, size);
    put_u32(stream, strands->followers);
    put_u32(stream, strands->both_ends_fixed);
    put_zeros(stream, 31 * 4);
    put_u32(stream, position);
    put_u32(stream, thickness);
    put_u32(stream, strand_uv);
    put_u32(stream, color);
    put_u32(stream, 0); // guide indices: all are guides
    put_u32(stream, vertex_uv);
    put_zeros(stream, 32 * 4);
    put_floats(stream, strands->position[0], 3 * count);
    put_array(stream, strands->strand_thickness, lines);
    put_array(stream, (const float *)strands->strand_uv, 2 * lines);
    put_array(stream, (const float *)strands->color, 4 * count);
    put_array(stream, (const float *)strands->vertex_uv, 2 * count);
    return RESULT_OK;
}

static void put_positions4(FILE *stream, const Strands *strands)
{
    for (uint32_t s = 0; s < strands->strand_count; s++) {
        uint32_t root = strands->first[s], tip = strands->first[s + 1] - 1;
        for (uint32_t v = root; v <= tip; v++) {
            float mobility = v != root && !(strands->both_ends_fixed && v == tip) ? 1.0f : 0.0f;
            put_floats(stream, strands->position[v], 3);
            put_floats(stream, strands->mobility ? &strands->mobility[v] : &mobility, 1);
        }
    }
}

static Result write_tfx4(FILE *stream, const Strands *strands, const char *path, Error *error)
{
    uint32_t size = find_common_size(strands, path, error);
    if (size == 0) return RESULT_FAILED;
    uint64_t count = strands->vertex_count, lines = strands->strand_count, end = TFX4_HEADER_BYTES;
    uint32_t position = place_array(&end, strands->position, count, 4);
    uint32_t strand_uv = place_array(&end, strands->strand_uv, lines, 2);
    uint32_t vertex_uv = place_array(&end, strands->vertex_uv, count, 2);
    uint32_t thickness = place_array(&end, strands->strand_thickness, lines, 1);
    uint32_t color = place_array(&end, strands->color, count, 4);
    if (end > UINT32_MAX) return fail_too_large(path, error);
    put_counts(stream, 4.0f, strands, size);
    put_u32(stream, position);
    put_u32(stream, strand_uv);
    put_u32(stream, vertex_uv);
    put_u32(stream, thickness);
    put_u32(stream, color);
    put_zeros(stream, 32 * 4);
    put_positions4(stream, strands);
    put_array(stream, (const float *)strands->strand_uv, 2 * lines);
    put_array(stream, (const float *)strands->vertex_uv, 2 * count);
    put_array(stream, strands->strand_thickness, lines);
    put_array(stream, (const float *)strands->color, 4 * count);
    return RESULT_OK;
}

// --- HAIR.

static bool has_transparency(const Strands *strands)
{
    for (uint32_t v = 0; strands->color && v < strands->vertex_count; v++)
        if (strands->color[v][3] != 1.0f) return true;
    return false;
}

static void put_hair_header(FILE *stream, const Strands *strands, bool transparent, bool uneven)
{
    uint32_t arrays = HAIR_HAS_POINTS | (uneven ? HAIR_HAS_SEGMENTS : 0u) |
                      (strands->vertex_thickness ? HAIR_HAS_THICKNESS : 0u) |
                      (transparent ? HAIR_HAS_TRANSPARENCY : 0u) |
                      (strands->color ? HAIR_HAS_COLOR : 0u);
    const float defaults[5] = {1.0f, 0.0f, 1.0f, 1.0f, 1.0f}; // thickness, transparency, colour
    char info[88] = "Tractrix";
    fwrite("HAIR", 1, 4, stream);
    put_u32(stream, strands->strand_count);
    put_u32(stream, strands->vertex_count);
    put_u32(stream, arrays);
    put_u32(stream, uneven ? 0 : strands_size(strands, 0) - 1);
    put_floats(stream, defaults, 5);
    fwrite(info, 1, sizeof info, stream);
}

static Result write_hair(FILE *stream, const Strands *strands, const char *path, Error *error)
{
    bool uneven = false, transparent = has_transparency(strands);
    for (uint32_t s = 0; s < strands->strand_count; s++) {
        uneven = uneven || strands_size(strands, s) != strands_size(strands, 0);
        if (strands_size(strands, s) - 1 > UINT16_MAX)
            return error_set(error, RESULT_FAILED,
                             "%s: strand %u has %u vertices, HAIR takes 65536", path, s,
                             strands_size(strands, s));
    }
    put_hair_header(stream, strands, transparent, uneven);
    for (uint32_t s = 0; uneven && s < strands->strand_count; s++) {
        uint16_t segments = htole16((uint16_t)(strands_size(strands, s) - 1));
        fwrite(&segments, 2, 1, stream);
    }
    put_floats(stream, strands->position[0], 3 * (size_t)strands->vertex_count);
    put_array(stream, strands->vertex_thickness, strands->vertex_count);
    for (uint32_t v = 0; transparent && v < strands->vertex_count; v++) {
        float transparency = 1.0f - strands->color[v][3];
        put_floats(stream, &transparency, 1);
    }
    for (uint32_t v = 0; strands->color && v < strands->vertex_count; v++)
        put_floats(stream, strands->color[v], 3);
    return RESULT_OK;
}

// --- USC-HairSalon.

static void write_salon(FILE *stream, const Strands *strands)
{
    put_u32(stream, strands->strand_count);
    for (uint32_t s = 0; s < strands->strand_count; s++) {
        put_u32(stream, strands_size(strands, s));
        put_floats(stream, strands->position[strands->first[s]],
                   3 * (size_t)strands_size(strands, s));
    }
}

// ---

static Result write_kind(FILE *stream, StrandsKind kind, const Strands *strands, const char *path,
                         Error *error)
{
    switch (kind) {
    case STRANDS_TFX2_TEXT:
        write_text(stream, strands);
        return RESULT_OK;
    case STRANDS_TFX3:
        return write_tfx3(stream, strands, path, error);
    case STRANDS_TFX4:
        return write_tfx4(stream, strands, path, error);
    case STRANDS_HAIR:
        return write_hair(stream, strands, path, error);
    case STRANDS_SALON_DATA:
        write_salon(stream, strands);
        return RESULT_OK;
    case STRANDS_OBJ:
        obj_file_write(stream, strands);
        return RESULT_OK;
    default:
        return error_set(error, RESULT_FAILED, "%s: %s can only be read", path,
                         strands_kind_name(kind));
    }
}

StrandsKind strands_choose_kind(const char *suffix, const Strands *strands)
{
    static const struct {
        const char *suffix;
        StrandsKind kind;
    } kinds[] = {{".hair", STRANDS_HAIR},
                 {".obj", STRANDS_OBJ},
                 {".data", STRANDS_SALON_DATA},
                 {".usda", STRANDS_USD}};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (strcasecmp(suffix, kinds[i].suffix) == 0) return kinds[i].kind;
    for (uint32_t s = 1; s < strands->strand_count; s++)
        if (strands_size(strands, s) != strands_size(strands, 0)) return STRANDS_TFX2_TEXT;
    return STRANDS_TFX4;
}

Result strands_write(const char *path, StrandsKind kind, const Strands *strands, Error *error)
{
    if (strands->strand_count == 0)
        return error_set(error, RESULT_FAILED, "%s: no strands to write", path);
    if (kind == STRANDS_USD)
        return usd_write_still(path, strands, &(UsdOptions){.metres_per_unit = 1}, error);
    OutFile file;
    Result result = outfile_open(&file, path, error);
    if (result != RESULT_OK) return result;
    result = write_kind(file.stream, kind, strands, path, error);
    if (result == RESULT_OK) return outfile_commit(&file, error);
    outfile_discard(&file);
    return result;
}
