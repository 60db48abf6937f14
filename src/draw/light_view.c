// SPDX-License-Identifier: MIT
#include "draw/light_view.h"

#include "base/double3.h"

#include <math.h>
#include <string.h>

LightView light_view(const Light *light, const float middle[3])
{
    LightView view = {.perspective = light->kind != LIGHT_DIRECTIONAL};
    double *way = view.axis[2];
    Double3 across = {0};
    for (int k = 0; k < 3; ++k) {
        view.origin[k] = view.perspective ? (double)light->position[k] : 0;
        way[k] =
            view.perspective ? (double)middle[k] - view.origin[k] : -(double)light->direction[k];
    }
    if (way[0] == 0 && way[1] == 0 && way[2] == 0) way[1] = -1; // a lamp in the middle
    double3_normalize(way);
    across[fabs(way[1]) < 0.9 ? 1 : 0] = 1;
    double3_cross(across, way, view.axis[0]);
    double3_normalize(view.axis[0]);
    double3_cross(way, view.axis[0], view.axis[1]);
    return view;
}

void light_view_row(const LightView *view, int k, double row[4])
{
    memset(row, 0, 4 * sizeof *row);
    if (k == 3 && !view->perspective) {
        row[3] = 1;
        return;
    }
    const double *axis = view->axis[k < 3 ? k : 2];
    for (int i = 0; i < 3; ++i) {
        row[i] = axis[i];
        row[3] -= axis[i] * view->origin[i];
    }
}

bool light_view_place(const LightView *view, const double x[3], double place[3])
{
    for (int k = 0; k < 3; ++k) {
        double row[4];
        light_view_row(view, k, row);
        place[k] = row[0] * x[0] + row[1] * x[1] + row[2] * x[2] + row[3];
    }
    if (!view->perspective) return true;
    if (place[2] <= 0) return false;
    place[0] /= place[2];
    place[1] /= place[2];
    return true;
}
