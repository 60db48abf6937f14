// SPDX-License-Identifier: MIT
#include "support/body_fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { COLUMNS = 14, ROWS = 6 };
static const float CELL = 0.02f;

void body_fixture_make_sheet(Mesh *mesh)
{
    assert_int_equal(mesh_create(mesh, (COLUMNS + 1) * (ROWS + 1), 2 * COLUMNS * ROWS, NULL),
                     RESULT_OK);
    for (int j = 0, v = 0; j <= ROWS; ++j)
        for (int i = 0; i <= COLUMNS; ++i, ++v) {
            mesh->position[v][0] = CELL * (float)(i - 2);
            mesh->position[v][1] = 1.6f;
            mesh->position[v][2] = CELL * ((float)j - 0.5f * ROWS);
        }
    for (uint32_t j = 0, t = 0; j < ROWS; ++j)
        for (uint32_t i = 0; i < COLUMNS; ++i, t += 2) {
            uint32_t a = j * (COLUMNS + 1) + i, b = a + COLUMNS + 1;
            const uint32_t two[2][3] = {{a, b, a + 1}, {a + 1, b, b + 1}};
            memcpy(mesh->triangle[t], two, sizeof two);
        }
    mesh_compute_normals(mesh);
}

void body_fixture_sample(MeshSequence *sequence, const Mesh *rest, BodyMotion *motion, double rate,
                         double start, uint32_t count)
{
    *sequence = (MeshSequence){.times = {.count = count, .rate = rate, .start = start},
                               .vertex_count = rest->vertex_count};
    sequence->position = malloc((size_t)count * rest->vertex_count * sizeof *sequence->position);
    assert_non_null(sequence->position);
    for (uint32_t i = 0; i < count; ++i)
        for (uint32_t v = 0; v < rest->vertex_count; ++v) {
            double from[3], to[3];
            for (int k = 0; k < 3; ++k) from[k] = (double)rest->position[v][k];
            motion(start + i / rate, from, to);
            for (int k = 0; k < 3; ++k) mesh_sequence_at(sequence, i)[v][k] = (float)to[k];
        }
}

void body_fixture_bind(BodyFixture *fixture, BodyMotion *motion, double rate, double start,
                       uint32_t count)
{
    MeshSequence sequence;
    const Mesh none = {0};
    Error error;
    Scene *scene = &fixture->base.scene;
    rigid_track_destroy(&scene->bodies[0].head);
    body_fixture_sample(&sequence, &fixture->mesh, motion, rate, start, count);
    const BodyOptions options = {"sheet", scene->run.teleport_distance, scene->run.teleport_angle,
                                 false};
    if (body_create(&fixture->body, &sequence, &fixture->mesh, &none, &fixture->base.strands, 1,
                    &options, &error) != RESULT_OK)
        fail_msg("%s", error.text);
    scene->bodies[0].shape = &fixture->body;
    scene->bodies[0].head.samples = &fixture->body.head;
    body_middle(&fixture->body, scene->bodies[0].head.pivot);
}

void body_fixture_create(BodyFixture *fixture, const char *algo, const char *variant,
                         BodyMotion *motion, double rate, double start, uint32_t count)
{
    *fixture = (BodyFixture){0};
    simulation_fixture_create(&fixture->base, algo, variant);
    body_fixture_make_sheet(&fixture->mesh);
    body_fixture_bind(fixture, motion, rate, start, count);
}

void body_fixture_destroy(BodyFixture *fixture)
{
    simulation_fixture_destroy(&fixture->base);
    body_destroy(&fixture->body);
    mesh_destroy(&fixture->mesh);
}

float (*body_fixture_positions(BodyFixture *fixture, bool followers, size_t *count))[3]
{
    const SimulationSection *section = &fixture->base.simulation.sections[0];
    const Hair *hair = followers ? &section->follow.hair : &section->hair;
    float(*positions)[3] = malloc(hair->particle_count * sizeof *positions + 1);
    assert_non_null(positions);
    assert_int_equal(hair_read_positions(hair, positions, NULL), RESULT_OK);
    *count = hair->particle_count;
    return positions;
}
