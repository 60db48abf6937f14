// SPDX-License-Identifier: MIT
#include "gen/fur_map.h"

#include "image/png.h"

#include <stdlib.h>

static Result read_image(FurMap *map, const char *name, const char *path, const Mesh *mesh,
                         Error *error)
{
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        for (int k = 0; k < 3; k++)
            if (!mesh->uv || mesh->triangle_uv[t][k] == MESH_NO_UV)
                return error_set(error, RESULT_USAGE,
                                 "%s %s: an image is placed by texture coordinates, %s: expected "
                                 "them for all triangles",
                                 name, path,
                                 mesh->uv ? "which some of the mesh's triangles lack"
                                          : "which the mesh lacks");
    Bytes bytes;
    Result result = bytes_read_file(&bytes, path, error);
    if (result != RESULT_OK) return error_prefix(error, result, "%s: ", name);
    result = png_decode_deep(&map->image, &bytes, path, error);
    bytes_destroy(&bytes);
    return result == RESULT_OK ? result : error_prefix(error, result, "%s: ", name);
}

Result fur_map_create(FurMap *map, const char *name, const char *text, const Mesh *mesh,
                      Error *error)
{
    static const char *const NAMES[] = {"x", "y", "z", "nx", "ny", "nz", "u", "v"};
    *map = (FurMap){0};
    size_t length = strlen(text);
    char *end;
    map->number = strtod(text, &end);
    if (end != text && !*end && isfinite(map->number)) return RESULT_OK;
    if (length > 4 && strcmp(text + length - 4, ".png") == 0)
        return read_image(map, name, text, mesh, error);
    Result result = formula_create_named(&map->formula, text, NAMES, 8, error);
    if (result == RESULT_OK) return result;
    return error_prefix(error, result == RESULT_BAD_INPUT ? RESULT_USAGE : result, "%s: ", name);
}

void fur_map_destroy(FurMap *map)
{
    formula_destroy(&map->formula);
    image_destroy(&map->image);
    *map = (FurMap){0};
}

static double texel(const Image *image, int64_t x, int64_t y, int channel)
{
    int64_t w = image->width, h = image->height;
    x = (x % w + w) % w, y = (y % h + h) % h;
    size_t at = (size_t)((y * w + x) * image->channels + channel);
    if (image->kind == IMAGE_16) {
        uint16_t level;
        memcpy(&level, image->pixels + 2 * at, 2);
        return level / 65535.0;
    }
    return image->pixels[at] / 255.0;
}

// Texel values are defined at the centres of texels.
static double sample(const Image *image, const double uv[2], int channel)
{
    double x = (uv[0] - floor(uv[0])) * image->width - 0.5;
    double y = (1.0 - (uv[1] - floor(uv[1]))) * image->height - 0.5;
    double s = x - floor(x), t = y - floor(y);
    int64_t i = (int64_t)floor(x), j = (int64_t)floor(y);
    double above = (1.0 - s) * texel(image, i, j, channel) + s * texel(image, i + 1, j, channel);
    double below =
        (1.0 - s) * texel(image, i, j + 1, channel) + s * texel(image, i + 1, j + 1, channel);
    return (1.0 - t) * above + t * below;
}

static double evaluate(const FurMap *map, const Surface *surface, const SurfacePoint *point)
{
    double values[8];
    double3_copy(point->place, values);
    surface_normal(surface, point, values + 3);
    surface_uv(surface, point, values + 6);
    return formula_evaluate_named(&map->formula, values);
}

// The value of an image's channel (0 to 2), between 0 and 1, bilinear. Values are used as stored,
// without conversion from sRGB.
static double read_channel(const FurMap *map, const Surface *surface, const SurfacePoint *point,
                           int channel)
{
    double uv[2];
    if (map->formula.text) return evaluate(map, surface, point);
    if (!map->image.pixels) return map->number;
    surface_uv(surface, point, uv);
    return sample(&map->image, uv, channel);
}

double fur_map_at(const FurMap *map, const Surface *surface, const SurfacePoint *point)
{
    if (!map->image.pixels) return read_channel(map, surface, point, 0);
    double sum = 0.0;
    for (int channel = 0; channel < 3; channel++) sum += read_channel(map, surface, point, channel);
    return sum / 3.0;
}

// --- Combs.

// Splits the text at commas outside parentheses. Returns the number of parts.
static int cut_text(char *text, char *part[3])
{
    int depth = 0, count = 1;
    part[0] = text;
    for (char *at = text; *at; at++) {
        depth += (*at == '(') - (*at == ')');
        if (*at != ',' || depth != 0) continue;
        *at = 0;
        if (count < 3) part[count] = at + 1;
        count++;
    }
    return count;
}

Result fur_map_create_comb(FurComb *comb, const char *name, const char *text, const Mesh *mesh,
                           Error *error)
{
    size_t length = strlen(text);
    *comb = (FurComb){.combs = true};
    comb->is_image = length > 4 && strcmp(text + length - 4, ".png") == 0;
    if (comb->is_image) return fur_map_create(&comb->axis[0], name, text, mesh, error);
    char *copy = strdup(text), *part[3];
    Result result = copy ? RESULT_OK : error_set(error, RESULT_FAILED, "out of memory");
    int count = copy ? cut_text(copy, part) : 0;
    if (copy && count != 3)
        result = error_set(
            error, RESULT_USAGE,
            "%s: got '%s', expected X,Y,Z, each a number or a formula, or a .png file", name, text);
    for (int i = 0; i < 3 && result == RESULT_OK; i++)
        result = fur_map_create(&comb->axis[i], name, part[i], mesh, error);
    free(copy);
    if (result != RESULT_OK) fur_map_destroy_comb(comb);
    return result;
}

void fur_map_destroy_comb(FurComb *comb)
{
    for (int i = 0; i < 3; i++) fur_map_destroy(&comb->axis[i]);
    *comb = (FurComb){0};
}

static void read_image_comb(const FurComb *comb, const Surface *surface, const SurfacePoint *point,
                            Double3 vector)
{
    Double3 axis[2];
    if (!surface_uv_axes(surface, point, axis[0], axis[1])) return;
    for (int i = 0; i < 2; i++) {
        double level = read_channel(&comb->axis[0], surface, point, i);
        double share = 2.0 * level - 1.0;
        // With 8 bits no level is exactly one half, so the two levels beside it count as "no
        // direction".
        double small = comb->axis[0].image.kind == IMAGE_8 ? 0.004 : 2e-5;
        if (fabs(share) > small) double3_add_scaled(vector, share, axis[i]);
    }
}

void fur_map_comb_at(const FurComb *comb, const Surface *surface, const SurfacePoint *point,
                     const Double3 normal, Double3 direction)
{
    Double3 vector = {0};
    if (comb->is_image)
        read_image_comb(comb, surface, point, vector);
    else
        for (int i = 0; i < 3 && comb->combs; i++)
            vector[i] = fur_map_at(&comb->axis[i], surface, point);
    double length = double3_length(vector);
    if (!isfinite(length)) memset(vector, 0, sizeof vector);
    if (length > 1.0) double3_normalize(vector);
    double3_flatten(vector, normal);
    length = 4.0 * double3_length(vector);
    for (int i = 0; i < 3; i++) direction[i] = 4.0 * vector[i] / fmax(length, 1.0);
}
