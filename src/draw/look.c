// SPDX-License-Identifier: MIT
#include "draw/look.h"

#include "sim/hair.h"

#include <math.h>

MaterialParams look_material(const Look *look, const HairBatch *batch)
{
    enum { MOST_PARTS = 65000 };
    MaterialParams material = look->material;
    uint most = MOST_PARTS / (batch->vertex_count - 1);
    double drawn = fmax((double)look->share * batch->strand_count, 1e-6),
           count = fmin(ceil(drawn), batch->strand_count);
    material.vertex_count = batch->vertex_count;
    material.drawn_strands = (uint)count;
    material.last_strand = (uint)count - 1;
    material.last_share = (float)(drawn - (count - 1));
    if (material.smooth_parts > most) material.smooth_parts = most ? most : 1;
    return material;
}

uint32_t look_points(const Look *look, const HairBatch *batch)
{
    return (batch->vertex_count - 1) * look_material(look, batch).smooth_parts + 1;
}
