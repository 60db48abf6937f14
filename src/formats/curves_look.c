// SPDX-License-Identifier: MIT
#include "formats/curves_look.h"

size_t curves_look_count(const Strands *strands, CurvesRate rate)
{
    return rate == CURVES_CONSTANT  ? 1
           : rate == CURVES_UNIFORM ? strands->strand_count
                                    : strands->vertex_count;
}

void curves_look_complete(CurvesLook *look, const Strands *strands)
{
    if (!look->width && strands->vertex_thickness) {
        look->width = strands->vertex_thickness;
        look->width_rate = CURVES_VERTEX;
    }
    if (!look->color && strands->color) {
        look->color = (const float(*)[4])strands->color;
        look->color_rate = CURVES_VERTEX;
    }
}
