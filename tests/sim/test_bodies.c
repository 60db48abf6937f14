// SPDX-License-Identifier: MIT
// Several bodies in one scene: the hair of each moves as it does in a scene of its own.
#include "mesh/scalp.h"
#include "sim/simulation_state.h"
#include "support/body_fixture.h"
#include "support/hair_fixture.h"
#include "support/head_formulas.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { LAST = 8, JUMP_FRAME = 5 };
enum { HEAD, SHEET }; // the bodies; what holds for the first alone is not enough for the second

// A sheet that bends and drifts under hair that is bound to it, and a head that turns and jumps,
// with a ball as its mesh. Each has a collider of its own, too. `both` has the two as bodies and
// owns nothing.
typedef struct Stage {
    BodyFixture sheet;
    SimulationFixture head;
    Mesh ball;
    Section sections[2];
    Strands strands[2];
    Mesh meshes[2];
    Scene scene;
    Simulation both;
} Stage;

static void bend(double time, const double rest[3], double place[3])
{
    double wave = 0.03 * sin(6 * time) * sin(20 * rest[0]);
    place[0] = rest[0] + 0.1 * time;
    place[1] = rest[1] + wave;
    place[2] = rest[2] - 0.05 * time;
}

static void set_run(Scene *scene, float rate)
{
    scene->run.sim_rate = rate;
    scene->run.preroll = 0.05f;
    scene->run.wind_shelter = 1;
    scene->run.sdf_resolution = 16;
    scene->run.sdf_cache = false;
    scene->sections[0].params.rest = REST_HANGING; // what is in a collider is pushed out
    scene->sections[0].params.followers = (AutoInt){.value = 2};
}

// At 60 frames a second the jump falls into the step before JUMP_FRAME.
static void create_head(Stage *stage, const char *algo, const char *variant, float rate)
{
    Scene *scene = &stage->head.scene;
    SceneBody *body = scene->bodies;
    simulation_fixture_create(&stage->head, algo, variant);
    Strands *strands = &stage->head.strands; // shorter than those of the sheet
    for (uint32_t v = 0; v < strands->vertex_count; ++v) strands->position[v][2] *= 0.7f;
    set_run(scene, rate);
    rigid_track_destroy(&body->head);
    head_set_translation(&body->head, "t < 4.5/60 ? 0.2*t : 3", "0", "0");
    head_set_rotation(&body->head, "0", "200*t", "0");
    assert_int_equal(colliders_parse(&body->colliders, "world:sphere:0,1.5,0.1,0.02", NULL),
                     RESULT_OK);
    assert_int_equal(scalp_make_mesh(&stage->ball, SCALP_SPHERE, 8, NULL), RESULT_OK);
    float low[3], high[3];
    mesh_bounds(&stage->ball, low, high);
    for (uint32_t v = 0; v < stage->ball.vertex_count; ++v) {
        float *p = stage->ball.position[v];
        const float centre[3] = {0.1f, 1.5f, 0.05f};
        for (int k = 0; k < 3; ++k)
            p[k] = centre[k] + 0.05f * (2 * (p[k] - low[k]) / (high[k] - low[k]) - 1);
    }
}

static void start(Simulation *simulation, Stage *stage, Scene *scene, Strands *strands,
                  const Mesh *meshes)
{
    Error error;
    if (simulation_create(simulation, fixture_gpu(), &stage->head.timer, scene, strands, meshes,
                          &error) != RESULT_OK)
        fail_msg("%s", error.text);
    while (simulation_settle(simulation)) continue;
    simulation_pose(simulation);
}

static void create(Stage *stage, const char *algo, const char *variant, float rate)
{
    *stage = (Stage){0};
    body_fixture_create(&stage->sheet, algo, variant, bend, 24, 0, 8);
    Scene *sheet = &stage->sheet.base.scene;
    set_run(sheet, rate);
    assert_int_equal(
        colliders_parse(&sheet->bodies[0].colliders, "sphere:0.05,1.55,0.02,0.03", NULL),
        RESULT_OK);
    create_head(stage, algo, variant, rate);
    Scene *head = &stage->head.scene;
    stage->sections[HEAD] = head->sections[0], stage->sections[SHEET] = sheet->sections[0];
    stage->strands[HEAD] = stage->head.strands, stage->strands[SHEET] = stage->sheet.base.strands;
    stage->meshes[HEAD] = stage->ball, stage->meshes[SHEET] = stage->sheet.mesh;
    stage->scene = *head;
    stage->scene.sections = stage->sections;
    stage->scene.section_count = stage->scene.body_count = 2;
    stage->scene.bodies[SHEET] = sheet->bodies[0];
    stage->scene.bodies[SHEET].first = SHEET;
    start(&stage->head.simulation, stage, head, stage->strands, stage->meshes);
    start(&stage->sheet.base.simulation, stage, sheet, stage->strands + SHEET,
          stage->meshes + SHEET);
    start(&stage->both, stage, &stage->scene, stage->strands, stage->meshes);
}

static void destroy(Stage *stage)
{
    simulation_destroy(&stage->both);
    mesh_destroy(&stage->ball);
    simulation_fixture_destroy(&stage->head);
    body_fixture_destroy(&stage->sheet);
}

static void go(Simulation *simulation, int frame)
{
    while (simulation->frame < frame) simulation_advance(simulation);
    simulation_pose(simulation);
}

static float (*read_hair(const Hair *hair, size_t *size))[3]
{
    float(*positions)[3] = malloc(hair->particle_count * sizeof *positions + 1);
    assert_non_null(positions);
    assert_int_equal(hair_read_positions(hair, positions, NULL), RESULT_OK);
    *size = hair->particle_count * sizeof *positions;
    return positions;
}

static void assert_same_hair(const Hair *a, const Hair *b, const char *algo, const char *what)
{
    size_t size[2];
    float(*first)[3] = read_hair(a, &size[0]), (*second)[3] = read_hair(b, &size[1]);
    assert_true(size[0] > 0 && size[0] == size[1]);
    if (memcmp(first, second, size[0]) != 0) fail_msg("%s: %s differ", algo, what);
    free(first);
    free(second);
}

static void assert_same(const Simulation *a, uint32_t of_a, const Simulation *b, uint32_t of_b,
                        const char *algo)
{
    const SimulationSection *first = &a->sections[of_a], *second = &b->sections[of_b];
    assert_true(head_is_same(&first->body->head, &second->body->head));
    assert_same_hair(&first->hair, &second->hair, algo, "guides");
    assert_same_hair(&first->follow.hair, &second->follow.hair, algo, "followers");
}

static void check_alone(const char *algo, const char *variant, float rate)
{
    Stage stage;
    create(&stage, algo, variant, rate);
    for (int frame = 0; frame <= LAST; frame += 2) {
        go(&stage.sheet.base.simulation, frame);
        go(&stage.head.simulation, frame);
        go(&stage.both, frame);
        assert_same(&stage.both, HEAD, &stage.head.simulation, 0, algo);
        assert_same(&stage.both, SHEET, &stage.sheet.base.simulation, 0, algo);
    }
    assert_true(stage.both.jumps == 1 && stage.sheet.base.simulation.jumps == 0);
    destroy(&stage);
}

static void check_solver(const char *algo, const char *variant)
{
    if (!*variant) check_alone(algo, variant, 0);
}

static void hair_on_two_bodies_is_that_of_two_scenes(void **state)
{
    (void)state;
    simulation_fixture_each(check_solver);
    check_alone("split", "", 45); // frames lie between steps
}

// That equality says nothing if one of them has no effect.
static void each_collides_with_its_own_body(void **state)
{
    (void)state;
    Stage stage;
    create(&stage, "split", "", 0);
    go(&stage.both, 4);
    for (int i = 0; i < 2; ++i) {
        SolverReport report = {0};
        solver_report(&stage.both.sections[i].solver, &report);
        assert_true(report.contacts > 0);
    }
    assert_non_null(moving_body_field(&stage.both.bodies[SHEET]));
    assert_true(stage.both.bodies[SHEET].moving.builds > 1);
    assert_true(stage.both.bodies[HEAD].field.spacing > 0);
    destroy(&stage);
}

static void two_bodies_go_on_as_if_they_had_not_stopped(void **state)
{
    (void)state;
    Stage whole, broken;
    Bytes saved;
    Error error;
    create(&whole, "chain", "", 45);
    create(&broken, "chain", "", 45);
    go(&whole.both, 3);
    if (simulation_state_save(&whole.both, &saved, &error) != RESULT_OK) fail_msg("%s", error.text);
    go(&broken.both, 1); // whatever was there is overwritten
    if (simulation_state_restore(&broken.both, &saved, &error) != RESULT_OK)
        fail_msg("%s", error.text);
    for (int frame = 3; frame <= LAST; ++frame) {
        go(&whole.both, frame);
        go(&broken.both, frame);
        for (uint32_t i = 0; i < 2; ++i) assert_same(&whole.both, i, &broken.both, i, "chain");
    }
    bytes_destroy(&saved);
    destroy(&whole);
    destroy(&broken);
}

// A cache has the first body's head; the others are where simulating has them.
static void a_frame_from_elsewhere_has_the_heads_of_the_simulated_one(void **state)
{
    (void)state;
    Stage stage, shown;
    const int frames[] = {1, JUMP_FRAME, LAST};
    create(&stage, "split", "", 45);
    create(&shown, "split", "", 45);
    for (size_t i = 0; i < sizeof frames / sizeof *frames; ++i) {
        Error error;
        size_t size[2];
        go(&stage.both, frames[i]);
        const Simulation *from = &stage.both;
        float(*first)[3] = read_hair(&from->sections[0].hair, &size[0]),
        (*second)[3] = read_hair(&from->sections[1].hair, &size[1]),
        (*all)[3] = malloc(size[0] + size[1]);
        assert_non_null(all);
        memcpy(all, first, size[0]);
        memcpy((char *)all + size[0], second, size[1]);
        if (simulation_show(&shown.both, frames[i], &from->bodies[0].head, (const float(*)[3])all,
                            &error) != RESULT_OK)
            fail_msg("%s", error.text);
        for (uint32_t s = 0; s < 2; ++s) assert_same(from, s, &shown.both, s, "split");
        free(first);
        free(second);
        free(all);
    }
    destroy(&stage);
    destroy(&shown);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hair_on_two_bodies_is_that_of_two_scenes),
        cmocka_unit_test(each_collides_with_its_own_body),
        cmocka_unit_test(two_bodies_go_on_as_if_they_had_not_stopped),
        cmocka_unit_test(a_frame_from_elsewhere_has_the_heads_of_the_simulated_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
