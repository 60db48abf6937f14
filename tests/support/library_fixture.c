// SPDX-License-Identifier: MIT
#include "support/library_fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

TractrixError library_error;

void library_refused(TractrixResult result, TractrixResult expected, const char *part)
{
    const char *text = library_error.text;
    if (result != expected || !strstr(text, part) || strchr(text, '\n'))
        fail_msg("result %d: %s: expected %d with '%s'", (int)result, text, (int)expected, part);
}

const uint32_t library_sizes[FIXTURE_STRANDS] = {2, 5, 3, 5, 4};

void library_positions(float position[FIXTURE_VERTICES][3])
{
    for (uint32_t s = 0, v = 0; s < FIXTURE_STRANDS; ++s)
        for (uint32_t j = 0; j < library_sizes[s]; ++j, ++v) {
            position[v][0] = 0.02f * (float)s;
            position[v][1] = -0.03f * (float)j;
            position[v][2] = 0.01f * (float)(j * s);
        }
}

TractrixScene *library_scene(const char *const *parameters)
{
    TractrixScene *scene;
    float position[FIXTURE_VERTICES][3];
    const TractrixStrands strands = {.size = sizeof strands,
                                     .metres_per_unit = 1,
                                     .strand_count = FIXTURE_STRANDS,
                                     .sizes = library_sizes,
                                     .position = position[0]};
    library_positions(position);
    WELL(tractrix_scene_create(&scene, "plain", &library_error));
    WELL(tractrix_scene_add_strands(scene, "five", &strands, &library_error));
    for (; *parameters; parameters += 2)
        WELL(tractrix_scene_set(scene, -1, parameters[0], parameters[1], &library_error));
    return scene;
}

const float library_sheet[4][3] = {
    {-0.02f, 0, -0.05f}, {0.12f, 0, -0.05f}, {0.12f, 0, 0.05f}, {-0.02f, 0, 0.05f}};

void library_set_sheet(TractrixScene *scene, bool deforms)
{
    static const uint32_t triangle[2][3] = {{0, 2, 1}, {0, 3, 2}};
    const TractrixMesh mesh = {.size = sizeof mesh,
                               .metres_per_unit = 1,
                               .deforms = deforms,
                               .vertex_count = 4,
                               .triangle_count = 2,
                               .position = library_sheet[0],
                               .triangle = triangle[0]};
    WELL(tractrix_scene_set_mesh(scene, &mesh, &library_error));
}

void library_draw(TractrixSimulation *simulation, const TractrixView *view,
                  uint8_t pixels[FIXTURE_PIXELS][4])
{
    TractrixRenderer *renderer;
    TractrixImage image = {.size = sizeof image, .width = 48, .height = 32, .pixels = pixels};
    WELL(tractrix_renderer_create(&renderer, simulation, 48, 32, TRACTRIX_RGBA8, &library_error));
    WELL(tractrix_render(renderer, view, &image, &library_error));
    tractrix_renderer_destroy(renderer);
}
