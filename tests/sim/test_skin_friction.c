// SPDX-License-Identifier: MIT
// Skin that slides below hair: a ball that twists drags the strands that lie on it.
#include "support/body_fixture.h"
#include "support/hair_fixture.h"
#include "support/shapes.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const double RADIUS = 0.1, SPEED = 1; // rad/s
enum { STRANDS = 4, VERTICES = 8, FRAMES = 9 };

// The half with x > 0 turns about the x axis, the ends at different speeds; roots are on the other.
static void twist(double time, const double rest[3], double place[3])
{
    double share = fmin(fmax(rest[0] / 0.03, 0), 1), c = cos(SPEED * time * share),
           s = sin(SPEED * time * share);
    place[0] = rest[0];
    place[1] = c * rest[1] - s * rest[2];
    place[2] = s * rest[1] + c * rest[2];
}

// Arcs over the top of the ball, from x = -0.04 to 0.05, 0.5 mm above it.
static void lay_strands(Strands *strands)
{
    strands_destroy(strands);
    assert_int_equal(strands_create(strands, STRANDS, STRANDS * VERTICES, NULL), RESULT_OK);
    for (uint32_t s = 0; s <= STRANDS; ++s) strands->first[s] = s * VERTICES;
    for (uint32_t v = 0; v < STRANDS * VERTICES; ++v) {
        double along = -0.4 + 0.13 * (v % VERTICES), r = RADIUS + 5e-4; // rad
        strands->position[v][0] = (float)(r * sin(along));
        strands->position[v][1] = (float)(r * cos(along));
        strands->position[v][2] = (float)(0.003 * (v / VERTICES));
    }
}

// The way (m) along z of the first strand's tip.
static double dragged(const char *algo, float friction)
{
    BodyFixture fixture = {0};
    Error error;
    size_t count;
    simulation_fixture_create(&fixture.base, algo, "");
    Scene *scene = &fixture.base.scene;
    lay_strands(&fixture.base.strands);
    shapes_make_sphere(&fixture.mesh, 30, 40, (float)RADIUS);
    body_fixture_bind(&fixture, twist, 60, 0, FRAMES + 2);
    memset(scene->run.wind, 0, sizeof scene->run.wind);
    scene->run.sdf_resolution = 32;
    SectionParams *params = &scene->sections[0].params;
    params->friction = friction;
    params->style = 0;
    params->drag = 0;
    if (simulation_create(&fixture.base.simulation, fixture_gpu(), &fixture.base.timer, scene,
                          &fixture.base.strands, &fixture.mesh, &error) != RESULT_OK)
        fail_msg("%s", error.text);
    simulation_fixture_go(&fixture.base, FRAMES);
    float(*now)[3] = body_fixture_positions(&fixture, false, &count);
    double way = (double)now[VERTICES - 1][2];
    free(now);
    body_fixture_destroy(&fixture);
    return way;
}

static void skin_that_slides_drags_hair(void **state)
{
    (void)state;
    static const char *const algos[] = {"chain", "split"};
    // The skin below the tip. The tip is behind by (SPEED RADIUS)^2 / (2 friction g) = 0.5 mm until
    // it has the skin's speed, and the strand holds it back, whose other half lies still. Measured
    // (chain, split): 0.90 and 0.89 of the skin's way; without friction -0.12 and -0.10.
    double skin = RADIUS * cos(0.51) * sin(SPEED * FRAMES / 60.0);
    for (int i = 0; i < 2; ++i) {
        double held = dragged(algos[i], 1), loose = dragged(algos[i], 0);
        if (!(held > 0.85 * skin && held < skin && fabs(loose) < 0.15 * skin))
            fail_msg("%s: %g m with friction, %g without: the skin moves by %g", algos[i], held,
                     loose, skin);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(skin_that_slides_drags_hair),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
