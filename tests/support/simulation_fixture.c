// SPDX-License-Identifier: MIT
#include "support/simulation_fixture.h"
#include "support/hair_fixture.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// Makes strands with the given numbers of vertices in turn, 10 on average. `count` is a multiple of
// `kinds`.
static void make_strands(Strands *strands, uint32_t count, const uint32_t *sizes, uint32_t kinds)
{
    uint32_t at = 0;
    assert_int_equal(strands_create(strands, count, count * 10, NULL), RESULT_OK);
    for (uint32_t s = 0; s < count; ++s) {
        uint32_t n = sizes[s % kinds];
        strands->first[s] = at;
        for (uint32_t j = 0; j < n; ++j, ++at) {
            float turn = 0.7f * (float)j + (float)s;
            strands->position[at][0] = 0.01f * (float)s + 0.01f * cosf(turn);
            strands->position[at][1] = 1.6f - 0.015f * (float)j;
            strands->position[at][2] = 0.01f * (float)j + 0.01f * sinf(turn);
        }
    }
    strands->first[count] = at;
}

void simulation_fixture_create(SimulationFixture *fixture, const char *algo, const char *variant)
{
    Scene *scene = &fixture->scene;
    SectionParams params;
    *fixture = (SimulationFixture){0};
    assert_int_equal(scene_create(scene, NULL), RESULT_OK);
    assert_int_equal(params_create_section(&params, NULL), RESULT_OK);
    assert_int_equal(params_parse(params_find("algo"), &params, algo, NULL), RESULT_OK);
    assert_int_equal(params_parse(params_find("variant"), &params, variant, NULL), RESULT_OK);
    assert_int_equal(scene_add_section(scene, "curls", &params, NULL), RESULT_OK);
    params_destroy_section(&params);
    scene->run.wind[0] = 0.5f;
    const float poses[][3] = {{0, 0, 0}, {0.02f, 0, 0.01f}, {-0.01f, 0, 0}},
                turns[][3] = {{0, 0, 0}, {0, 0.3f, 0}, {0, -0.2f, 0.1f}};
    for (int i = 0; i < 3; ++i) {
        keyframes_append(&scene->bodies[0].head.translation.keys, 0.3 * i, poses[i], 3, NULL);
        keyframes_append(&scene->bodies[0].head.rotation.keys, 0.3 * i, turns[i], 3, NULL);
    }
    make_strands(&fixture->strands, 20, (const uint32_t[]){12, 8}, 2);
    gpu_timer_create(&fixture->timer, false, true);
}

void simulation_fixture_mix(SimulationFixture *fixture)
{
    strands_destroy(&fixture->strands);
    make_strands(&fixture->strands, 18, (const uint32_t[]){12, 8, 10}, 3);
}

void simulation_fixture_start(SimulationFixture *fixture)
{
    Error error;
    if (simulation_create(&fixture->simulation, fixture_gpu(), &fixture->timer, &fixture->scene,
                          &fixture->strands, NULL, &error) != RESULT_OK)
        fail_msg("%s", error.text);
    while (simulation_settle(&fixture->simulation)) continue;
    simulation_pose(&fixture->simulation);
}

void simulation_fixture_destroy(SimulationFixture *fixture)
{
    if (fixture->simulation.scene) simulation_destroy(&fixture->simulation);
    gpu_timer_destroy(&fixture->timer);
    strands_destroy(&fixture->strands);
    scene_destroy(&fixture->scene);
}

void simulation_fixture_go(SimulationFixture *fixture, int frame)
{
    while (fixture->simulation.frame < frame) simulation_advance(&fixture->simulation);
    simulation_pose(&fixture->simulation);
}

// FNV-1a hash.
static uint64_t hash_bytes(uint64_t hash, const void *data, size_t size)
{
    for (size_t i = 0; i < size; ++i)
        hash = (hash ^ ((const uint8_t *)data)[i]) * UINT64_C(0x100000001b3);
    return hash;
}

static float (*read_batch(const HairBatch *batch))[4]
{
    float(*positions)[4] = gpu_buffer_read(&batch->position);
    assert_non_null(positions);
    return positions;
}

uint64_t simulation_fixture_hash(SimulationFixture *fixture)
{
    const Simulation *simulation = &fixture->simulation;
    const Hair *hair = &simulation->sections[0].hair;
    uint64_t hash = UINT64_C(0xcbf29ce484222325);
    hash = hash_bytes(hash, simulation->bodies[0].head.rotation,
                      sizeof simulation->bodies[0].head.rotation);
    hash = hash_bytes(hash, simulation->bodies[0].head.translation,
                      sizeof simulation->bodies[0].head.translation);
    for (uint32_t i = 0; i < hair->batch_count; ++i) {
        const HairBatch *batch = &hair->batches[i];
        float(*positions)[4] = read_batch(batch);
        for (uint32_t s = 0; s < batch->strand_count; ++s)
            for (uint32_t j = 0; j < batch->vertex_count; ++j)
                hash = hash_bytes(hash, positions[hair_address(batch, s, j)], sizeof(float[3]));
        free(positions);
    }
    return hash;
}

void simulation_fixture_read(SimulationFixture *fixture, uint32_t batch, uint32_t vertex,
                             float position[3])
{
    const HairBatch *hair = &fixture->simulation.sections[0].hair.batches[batch];
    float(*positions)[4] = read_batch(hair);
    memcpy(position, positions[hair_address(hair, 0, vertex)], sizeof(float[3]));
    free(positions);
}

void simulation_fixture_each(void (*check)(const char *algo, const char *variant))
{
    const char *only = getenv("TEST_ALGO");
    for (const SolverType *const *type = SOLVER_TYPES; *type; ++type)
        for (int v = 0; v == 0 || (v < SOLVER_MAX_VARIANTS && (*type)->variants[v]); ++v)
            if (!only || strcmp(only, (*type)->name) == 0)
                check((*type)->name, (*type)->variants[v] ? (*type)->variants[v] : "");
}
