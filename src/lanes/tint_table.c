// SPDX-License-Identifier: MIT
#include "lanes/tint_table.h"

#include "base/parallel.h"

#include "glsl/draw/draw.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { TINT_SLICES = 4 }; // levels of brightness, see tint_table.h

enum { NODES = SCATTER_AZIMUTHS * SCATTER_INCLINATIONS, WORDS = 4, BEAMS = 3 };

// The two colours of the table around a colour, and the share of the second.
typedef struct Between {
    const float (*low)[BEAMS + 1], (*high)[BEAMS + 1];
    float share;
} Between;

static Between find_color(const TintTable *tints, float color)
{
    float place = fminf(color, 1) * (SCATTER_COLORS - 1);
    int first = place < SCATTER_COLORS - 2 ? (int)place : SCATTER_COLORS - 2;
    const float(*low)[BEAMS + 1] = tints->values + (size_t)first * NODES;
    return (Between){low, low + NODES, place - (float)first};
}

static uint32_t pack(float value, float unit)
{
    return (uint32_t)(value / unit + 0.5f);
}

static void fill_slice(const TintTable *tints, int slice)
{
    const float *unit = tints->unit;
    uint32_t(*texel)[WORDS] = tints->texels + (size_t)slice * NODES;
    float brightness =
        1 + tints->variation * (2 * (float)slice / fmaxf((float)(tints->slices - 1), 1) - 1);
    Between of[3];
    for (int k = 0; k < 3; ++k) of[k] = find_color(tints, tints->color[k] * brightness);
    for (int node = 0; node < NODES; ++node) {
        uint32_t through[3], back[3];
        for (int k = 0; k < 3; ++k) {
            const float *low = of[k].low[node], *high = of[k].high[node];
            through[k] = pack(low[1] + of[k].share * (high[1] - low[1]), unit[1]);
            back[k] = pack(low[2] + of[k].share * (high[2] - low[2]), unit[2]);
        }
        texel[node][0] = pack(of[0].low[node][0], unit[0]) | through[0] << 16;
        texel[node][1] = through[1] | through[2] << 16;
        texel[node][2] = back[0] | back[1] << 16;
        texel[node][3] = back[2];
    }
}

typedef struct Filling {
    const TintTable *tints;
    int parts;
} Filling;

static void fill_part(void *data, int part)
{
    const Filling *filling = data;
    for (int slice = part; slice < filling->tints->slices; slice += filling->parts)
        fill_slice(filling->tints, slice);
}

// The unit of each beam, so that the largest value of any fibre is 65535 units.
static void find_units(TintTable *tints)
{
    float most[BEAMS] = {1e-9f, 1e-9f, 1e-9f};
    for (size_t i = 0; i < (size_t)SCATTER_COLORS * NODES; ++i)
        for (int p = 0; p < BEAMS; ++p) most[p] = fmaxf(most[p], tints->values[i][p]);
    for (int p = 0; p < BEAMS; ++p) tints->unit[p] = most[p] / 65535;
}

static bool match(const TintTable *tints, FibreTable table, const float color[3], float variation)
{
    return tints->texels && tints->values == table.values && tints->variation == variation &&
           memcmp(tints->color, color, sizeof tints->color) == 0;
}

Result tint_table_make(TintTable *tints, FibreTable table, const float color[3], float variation,
                       Error *error)
{
    if (match(tints, table, color, variation)) return RESULT_OK;
    tint_table_destroy(tints);
    tints->values = table.values;
    tints->variation = variation;
    tints->slices = variation > 0 ? TINT_SLICES : 1;
    memcpy(tints->color, color, sizeof tints->color);
    find_units(tints);
    tints->texels = malloc((size_t)tints->slices * NODES * sizeof *tints->texels);
    if (!tints->texels)
        return error_set(error, RESULT_FAILED, "no memory for a table of marschner shading");
    Filling filling = {tints, parallel_threads()};
    parallel_run(filling.parts, fill_part, &filling);
    return RESULT_OK;
}

void tint_table_destroy(TintTable *tints)
{
    free(tints->texels);
    *tints = (TintTable){0};
}
