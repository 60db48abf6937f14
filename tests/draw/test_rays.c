// SPDX-License-Identifier: MIT
// The rays through an image's pixels, for cameras that look in any direction and are rolled.
#include "draw/rays.h"

#include "base/random.h"

#include <cglm/cglm.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { WIDTH = 640, HEIGHT = 360 };

// A point of a ray is drawn at the pixel of the ray, and the ray ends one metre in front of the
// eye. The matrix has 24 bits, which moves a point by about 1e-7 of the 4 m to the world's origin,
// and of half the image's width of 320 px: 2e-4 px at 1 m.
static void a_ray_is_drawn_at_its_pixel(void **state)
{
    (void)state;
    Random random = random_create(4, 0);
    for (int i = 0; i < 100; ++i) {
        mat4 view, projection;
        vec3 eye, way, up;
        DrawParams draw = {.width = WIDTH, .height = HEIGHT};
        for (int k = 0; k < 3; ++k) {
            eye[k] = (float)(4 * random_real(&random) - 2);
            way[k] = (float)(2 * random_real(&random) - 1);
            up[k] = (float)(2 * random_real(&random) - 1);
        }
        glm_look(eye, way, up, view);
        glm_perspective(0.7f, (float)WIDTH / HEIGHT, 0.1f, 10, projection);
        glm_mat4_mul(projection, view, projection);
        memcpy(draw.clip_from_world, projection, sizeof draw.clip_from_world);
        const Rays rays = rays_find(&draw);
        const double x = WIDTH * random_real(&random), y = HEIGHT * random_real(&random);
        double clip[4];
        for (int row = 0; row < 4; ++row) {
            clip[row] = (double)projection[3][row];
            for (int k = 0; k < 3; ++k)
                clip[row] +=
                    (double)projection[k][row] * ((double)eye[k] + x * (double)rays.across[k] +
                                                  y * (double)rays.down[k] + (double)rays.from[k]);
        }
        assert_true(fabs(clip[3] - 1) < 1e-5);
        assert_true(fabs((clip[0] / clip[3] + 1) / 2 * WIDTH - x) < 2e-3);
        assert_true(fabs((clip[1] / clip[3] + 1) / 2 * HEIGHT - y) < 2e-3);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_ray_is_drawn_at_its_pixel)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
