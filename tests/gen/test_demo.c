// SPDX-License-Identifier: MIT
// The bundled haircuts fit the bundled head as scripts/make-assets grew them: roots lie on the
// skull, nothing is inside, and the face is free.
#include "formats/mesh_read.h"
#include "formats/strands_read.h"
#include "mesh/surface.h"

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>

typedef struct Haircut {
    Mesh head;
    Surface surface;
    Strands strands;
} Haircut;

static void read_haircut(Haircut *haircut, const char *path)
{
    StrandsReadOptions options = {.strict = true};
    Error error = {""};
    if (mesh_read(&haircut->head, "assets/head.obj", 1.0f, false, &error) != RESULT_OK ||
        surface_create(&haircut->surface, &haircut->head, "head", &error) != RESULT_OK ||
        strands_read(&haircut->strands, path, &options, NULL, &error) != RESULT_OK)
        fail_msg("%s", error.text);
}

static void destroy_haircut(Haircut *haircut)
{
    strands_destroy(&haircut->strands);
    surface_destroy(&haircut->surface);
    mesh_destroy(&haircut->head);
}

static const char *const PATHS[] = {"assets/demo.tfx", "assets/bob.tfx"};

// Roots are lifted by 0.1 mm along the interpolated normal, which may lean towards the facet, so
// that at least half of the height is left. All other vertices keep that distance, except for the
// rounding of the file's floats.
static void roots_are_on_the_head_and_nothing_is_inside(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        Haircut haircut;
        SurfacePoint nearest = {0};
        read_haircut(&haircut, PATHS[i]);
        const Strands *strands = &haircut.strands;
        for (uint32_t s = 0; s < strands->strand_count; s++)
            for (uint32_t v = strands->first[s]; v < strands->first[s + 1]; v++) {
                Double3 at;
                double3_from_float(strands->position[v], at);
                double over = surface_nearest(&haircut.surface, at, &nearest);
                assert_true(over > 0.5e-4);
                if (v == strands->first[s]) assert_true(over < 1.1e-4 && at[1] > -0.09);
            }
        destroy_haircut(&haircut);
    }
}

// Checks a cone from inside the skull that leaves it around eyes, nose and mouth.
static void the_face_is_free(void **state)
{
    (void)state;
    Double3 apex = {0, -0.02, 0}, axis = {0, -0.15, 1};
    double widest = cos(M_PI * 36.0 / 180.0);
    double3_normalize(axis);
    for (int i = 0; i < 2; i++) {
        Haircut haircut;
        read_haircut(&haircut, PATHS[i]);
        for (uint32_t v = 0; v < haircut.strands.vertex_count; v++) {
            Double3 at, way;
            double3_from_float(haircut.strands.position[v], at);
            double3_subtract(at, apex, way);
            double3_normalize(way);
            assert_true(double3_dot(way, axis) < widest);
        }
        destroy_haircut(&haircut);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(roots_are_on_the_head_and_nothing_is_inside),
        cmocka_unit_test(the_face_is_free),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
