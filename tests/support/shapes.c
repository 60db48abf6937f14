// SPDX-License-Identifier: MIT
#include "support/shapes.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <string.h>

#include <cmocka.h>

void shapes_make_sphere(Mesh *mesh, int rings, int sectors, float radius)
{
    uint32_t n = (uint32_t)(rings * sectors), t = 0;
    assert_int_equal(mesh_create(mesh, n + 2, 2 * n, NULL), RESULT_OK);
    for (int r = 0; r < rings; ++r)
        for (int s = 0; s < sectors; ++s) {
            double polar = 3.14159265358979 * (r + 1) / (rings + 1);
            double angle = 2 * 3.14159265358979 * s / sectors;
            float *at = mesh->position[r * sectors + s];
            at[0] = radius * (float)(sin(polar) * cos(angle));
            at[1] = radius * (float)cos(polar);
            at[2] = radius * (float)(-sin(polar) * sin(angle));
        }
    mesh->position[n][1] = radius, mesh->position[n + 1][1] = -radius;
    for (int r = -1; r < rings; ++r)
        for (int s = 0; s < sectors; ++s) {
            uint32_t next = (uint32_t)((s + 1) % sectors), here = (uint32_t)s;
            uint32_t a = r < 0 ? n : (uint32_t)(r * sectors) + here;
            uint32_t b = r == rings - 1 ? n + 1 : (uint32_t)((r + 1) * sectors) + here;
            uint32_t c = (uint32_t)((r + 1) * sectors) + next, d = (uint32_t)(r * sectors) + next;
            if (r < rings - 1) memcpy(mesh->triangle[t++], (uint32_t[]){a, b, c}, 12);
            if (r >= 0) memcpy(mesh->triangle[t++], (uint32_t[]){a, r == rings - 1 ? b : c, d}, 12);
        }
    mesh->triangle_count = t;
}

void shapes_make_scalp(Scalp *scalp, ScalpShape shape, uint32_t rings)
{
    assert_int_equal(scalp_make_mesh(&scalp->mesh, shape, rings, NULL), RESULT_OK);
    assert_int_equal(surface_create(&scalp->surface, &scalp->mesh, "mesh", NULL), RESULT_OK);
}

void shapes_destroy_scalp(Scalp *scalp)
{
    surface_destroy(&scalp->surface);
    mesh_destroy(&scalp->mesh);
}
