// SPDX-License-Identifier: MIT
// Sections of one scene: each moves as it would alone, and a section at rest costs nothing.
#include "gen/strands_make.h"
#include "sim/simulation.h"
#include "support/hair_fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { MOST = 4, FRAMES = 40 };

// How a section is made.
typedef struct Kind {
    const char *algo;
    uint32_t strands, vertices;
    float style, drag;
    int followers;
} Kind;

typedef struct World {
    Scene scene;
    Strands strands[MOST];
    GpuTimer timer;
    Simulation simulation;
} World;

static void add_section(World *world, const Kind *kind)
{
    SectionParams params;
    StrandsRecipe recipe = strands_make_recipe(STRANDS_STYLE_CURLS);
    recipe.count = kind->strands, recipe.vertices = kind->vertices;
    assert_int_equal(strands_make(&world->strands[world->scene.section_count], &recipe, NULL),
                     RESULT_OK);
    assert_int_equal(params_create_section(&params, NULL), RESULT_OK);
    assert_int_equal(params_parse(params_find("algo"), &params, kind->algo, NULL), RESULT_OK);
    params.style = kind->style;
    params.drag = kind->drag;
    params.followers = (AutoInt){.value = kind->followers};
    params.sleep = 1e-4f;
    assert_int_equal(scene_add_section(&world->scene, kind->algo, &params, NULL), RESULT_OK);
    params_destroy_section(&params);
}

// Gusts of wind and a moving head: everything that depends on a strand's number or position.
static void create(World *world, const Kind *kinds, int count)
{
    *world = (World){0};
    assert_int_equal(scene_create(&world->scene, NULL), RESULT_OK);
    world->scene.run.wind[0] = 2;
    for (int i = 0; i < 2; ++i)
        keyframes_append(&world->scene.bodies[0].head.translation.keys, i,
                         (float[]){0.1f * (float)i, 0, 0}, 3, NULL);
    for (int i = 0; i < count; ++i) add_section(world, &kinds[i]);
    gpu_timer_create(&world->timer, false, true);
}

static void start(World *world)
{
    assert_int_equal(simulation_create(&world->simulation, fixture_gpu(), &world->timer,
                                       &world->scene, world->strands, NULL, NULL),
                     RESULT_OK);
}

static void destroy(World *world)
{
    simulation_destroy(&world->simulation);
    gpu_timer_destroy(&world->timer);
    for (int i = 0; i < MOST; ++i) strands_destroy(&world->strands[i]);
    scene_destroy(&world->scene);
}

static void *read_buffer(const GpuBuffer *buffer)
{
    void *data = malloc((size_t)buffer->size);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer->buffer);
    glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)buffer->size, data);
    return data;
}

static bool same_buffers(const GpuBuffer *a, const GpuBuffer *b)
{
    void *x = read_buffer(a), *y = read_buffer(b);
    bool same = a->size == b->size && memcmp(x, y, (size_t)a->size) == 0;
    free(x);
    free(y);
    return same;
}

static bool same_hair(const Hair *a, const Hair *b)
{
    bool same = a->batch_count == b->batch_count;
    for (uint32_t i = 0; i < a->batch_count && same; ++i)
        same = same_buffers(&a->batches[i].position, &b->batches[i].position);
    return same;
}

static void run(World *world)
{
    for (int frame = 0; frame < FRAMES; ++frame) simulation_advance(&world->simulation);
    simulation_pose(&world->simulation);
}

static void sections_move_as_if_they_were_alone(void **state)
{
    static const Kind kinds[MOST] = {{"chain", 20, 9, 0.5f, 1, 0},
                                     {"split", 33, 14, 0.3f, 2, 3},
                                     {"tressfx", 7, 9, 0.5f, 5, 1},
                                     {"none", 5, 6, 1, 1, 2}};
    (void)state;
    World together;
    create(&together, kinds, MOST);
    start(&together);
    run(&together);
    for (int i = 0; i < MOST; ++i) {
        World alone;
        create(&alone, &kinds[i], 1);
        start(&alone);
        run(&alone);
        const SimulationSection *a = &alone.simulation.sections[0],
                                *b = &together.simulation.sections[i];
        assert_true(same_hair(&a->hair, &b->hair));
        assert_true(same_hair(&a->follow.hair, &b->follow.hair));
        // Shows that the comparison can fail.
        if (i > 0) assert_false(same_hair(&a->hair, &together.simulation.sections[0].hair));
        destroy(&alone);
    }
    destroy(&together);
}

// A static section and a sleeping section are neither stepped nor posed while a third one moves.
static void still_sections_are_left_alone(void **state)
{
    // drag 0: the third swings for ever
    static const Kind kinds[] = {
        {"none", 5, 6, 1, 1, 2}, {"tressfx", 8, 8, 0.9f, 20, 0}, {"split", 4, 8, 0, 0, 0}};
    (void)state;
    World world;
    create(&world, kinds, 3);
    memset(world.scene.run.wind, 0, sizeof world.scene.run.wind);
    world.scene.bodies[0].head.translation.keys.count = 0;
    start(&world);
    Simulation *simulation = &world.simulation;
    while (!simulation->sections[1].sleep.asleep && simulation->frame < 60 * 60)
        simulation_advance(simulation);
    assert_true(simulation->sections[1].sleep.asleep);
    assert_false(simulation->sections[2].sleep.asleep);
    simulation_pose(simulation);
    uint64_t steps = simulation->steps, poses = simulation->poses,
             asleep = simulation->strand_steps_asleep;
    for (int frame = 0; frame < FRAMES; ++frame) {
        simulation_advance(simulation);
        simulation_pose(simulation);
    }
    assert_int_equal(simulation->steps - steps, FRAMES);
    assert_int_equal(simulation->poses - poses, FRAMES);
    assert_int_equal(simulation->strand_steps_asleep - asleep, FRAMES * 8);
    destroy(&world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sections_move_as_if_they_were_alone),
        cmocka_unit_test(still_sections_are_left_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
