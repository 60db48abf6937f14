// SPDX-License-Identifier: MIT
#include "gen/fur_comb.h"

#include <stdlib.h>

// Cuts the text at commas outside of parentheses; returns the number of parts.
static int cut(char *text, char *part[3])
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

Result fur_comb_create(FurComb *comb, const char *name, const char *text, const Mesh *mesh,
                       Error *error)
{
    size_t length = strlen(text);
    *comb = (FurComb){.combs = true};
    comb->is_picture = length > 4 && strcmp(text + length - 4, ".png") == 0;
    if (comb->is_picture) return fur_map_create(&comb->axis[0], name, text, mesh, error);
    char *copy = strdup(text), *part[3];
    Result result = copy ? RESULT_OK : error_set(error, RESULT_FAILED, "out of memory");
    int count = copy ? cut(copy, part) : 0;
    if (copy && count != 3)
        result = error_set(error, RESULT_USAGE,
                           "%s: expected X,Y,Z, each a number or a formula, or a .png, got '%s'",
                           name, text);
    for (int i = 0; i < 3 && result == RESULT_OK; i++)
        result = fur_map_create(&comb->axis[i], name, part[i], mesh, error);
    free(copy);
    if (result != RESULT_OK) fur_comb_destroy(comb);
    return result;
}

void fur_comb_destroy(FurComb *comb)
{
    for (int i = 0; i < 3; i++) fur_map_destroy(&comb->axis[i]);
    *comb = (FurComb){0};
}

static void read_picture(const FurComb *comb, const Surface *surface, const SurfacePoint *point,
                         Double3 vector)
{
    Double3 axis[2];
    if (!surface_uv_axes(surface, point, axis[0], axis[1])) return;
    for (int i = 0; i < 2; i++) {
        double level = fur_map_channel(&comb->axis[0], surface, point, i);
        double share = 2.0 * level - 1.0;
        // No level of 8 bits is a half: the two beside it are none.
        double small = comb->axis[0].image.kind == IMAGE_8 ? 0.004 : 2e-5;
        if (fabs(share) > small) double3_add_scaled(vector, share, axis[i]);
    }
}

void fur_comb_at(const FurComb *comb, const Surface *surface, const SurfacePoint *point,
                 const Double3 normal, Double3 direction)
{
    Double3 vector = {0};
    if (comb->is_picture)
        read_picture(comb, surface, point, vector);
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
