// SPDX-License-Identifier: MIT
#include "strands/strands_edit.h"

#include <math.h>
#include <string.h>

// --- Order and smoothness.

static void swap(void *a, void *b, size_t size)
{
    char kept[sizeof(float[4])];
    memcpy(kept, a, size);
    memcpy(a, b, size);
    memcpy(b, kept, size);
}

void strands_reverse(Strands *strands)
{
    for (uint32_t s = 0; s < strands->strand_count; s++)
        for (uint32_t a = strands->first[s], b = strands->first[s + 1] - 1; a < b; a++, b--) {
            swap(strands->position[a], strands->position[b], sizeof *strands->position);
            if (strands->vertex_uv)
                swap(strands->vertex_uv[a], strands->vertex_uv[b], sizeof *strands->vertex_uv);
            if (strands->vertex_thickness)
                swap(&strands->vertex_thickness[a], &strands->vertex_thickness[b], sizeof(float));
            if (strands->color) swap(strands->color[a], strands->color[b], sizeof *strands->color);
        }
}

static void smooth_once(float (*position)[3], uint32_t size)
{
    float before[3];
    memcpy(before, position[0], sizeof before);
    for (uint32_t v = 1; v + 1 < size; v++)
        for (int i = 0; i < 3; i++) {
            float here = position[v][i];
            position[v][i] = (float)(0.25 * before[i] + 0.5 * here + 0.25 * position[v + 1][i]);
            before[i] = here;
        }
}

void strands_smooth(Strands *strands, uint32_t passes)
{
    for (uint32_t s = 0; s < strands->strand_count; s++)
        for (uint32_t pass = 0; pass < passes; pass++)
            smooth_once(strands->position + strands->first[s], strands_size(strands, s));
}

// --- Similarities.

StrandsMove strands_move_none(void)
{
    return (StrandsMove){.scale = 1, .rotation = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
}

StrandsMove strands_move_rotation(int axis, double angle_deg)
{
    static const double turn = 6.283185307179586;
    StrandsMove move = strands_move_none();
    double quarters = angle_deg / 90, c = cos(angle_deg * turn / 360),
           s = sin(angle_deg * turn / 360);
    if (quarters == rint(quarters)) c = rint(c), s = rint(s); // exactly
    int a = (axis + 1) % 3, b = (axis + 2) % 3;
    move.rotation[a][a] = move.rotation[b][b] = c;
    move.rotation[a][b] = -s;
    move.rotation[b][a] = s;
    return move;
}

// Terms that are 0 are left out, so that no -0 becomes 0.
static double turned(const double row[3], const float p[3])
{
    double sum = -0.0;
    for (int i = 0; i < 3; i++)
        if (row[i] != 0) sum += row[i] * p[i];
    return sum;
}

static void scale_sizes(Strands *strands, double scale)
{
    for (uint32_t v = 0; strands->vertex_thickness && v < strands->vertex_count; v++)
        strands->vertex_thickness[v] = (float)(strands->vertex_thickness[v] * scale);
    strands->follower_radius = (float)(strands->follower_radius * scale);
}

void strands_move(Strands *strands, const StrandsMove *move)
{
    for (uint32_t v = 0; v < strands->vertex_count; v++) {
        float p[3];
        memcpy(p, strands->position[v], sizeof p);
        for (int i = 0; i < 3; i++) {
            double x = move->scale * turned(move->rotation[i], p);
            if (move->translation[i] != 0) x += move->translation[i];
            strands->position[v][i] = (float)x;
        }
    }
    scale_sizes(strands, move->scale);
}

void strands_to_unit(Strands *strands, double metres, bool up_z)
{
    for (uint32_t v = 0; v < strands->vertex_count; v++) {
        const float *p = strands->position[v];
        double y = up_z ? -(double)p[2] : (double)p[1], z = up_z ? (double)p[1] : (double)p[2];
        float to[3] = {(float)(p[0] / metres), (float)(y / metres), (float)(z / metres)};
        memcpy(strands->position[v], to, sizeof to);
    }
    scale_sizes(strands, 1 / metres);
}
