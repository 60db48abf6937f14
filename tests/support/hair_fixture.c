// SPDX-License-Identifier: MIT
#include "support/hair_fixture.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

const Gpu *fixture_gpu(void)
{
    static Gpu gpu;
    Error error;
    if (!gpu.renderer[0] && gpu_create(&gpu, &(GpuOptions){0}, &error) != RESULT_OK)
        fail_msg("%s", error.text);
    return &gpu;
}

double fixture_rounding(void)
{
    const Gpu *gpu = fixture_gpu();
    return gpu->software && gpu->ulps == 0 ? 1 : 5;
}

void fixture_assert_offset(GLuint program, const char *name, size_t expected)
{
    const GLenum property = GL_OFFSET;
    GLint offset = -1;
    GLuint index = glGetProgramResourceIndex(program, GL_UNIFORM, name);
    if (index == GL_INVALID_INDEX) fail_msg("the driver knows no %s", name);
    glGetProgramResourceiv(program, GL_UNIFORM, index, 1, &property, 1, NULL, &offset);
    if (offset != (GLint)expected)
        fail_msg("%s is at %d for the driver, at %zu in C", name, offset, expected);
}

static void create_solver(HairFixture *fixture)
{
    Error error = {{0}};
    const SolverSetup setup = {.gpu = fixture_gpu(),
                               .timer = &fixture->timer,
                               .hair = &fixture->hair,
                               .params = &fixture->params,
                               .colliders = &fixture->colliders,
                               .field = fixture->field,
                               .sheltered = fixture->sheltered};
    if (solver_create(&fixture->solver, &setup, &error) != RESULT_OK) fail_msg("%s", error.text);
}

static void create(HairFixture *fixture, const Strands *strands, const char *algo,
                   const char *variant, float style, float drag,
                   void (*tune)(SectionParams *params))
{
    Error error = {{0}};
    *fixture = (HairFixture){
        .step = {.dt = 1.0 / 60, .first = true, .gravity = {0, -9.81f, 0}},
    };
    fixture->step.head.rotation[3] = fixture->step.head_old.rotation[3] = 1;
    assert_int_equal(params_create_section(&fixture->params, &error), RESULT_OK);
    free(fixture->params.algo);
    free(fixture->params.variant);
    fixture->params.algo = strdup(algo);
    fixture->params.variant = strdup(variant);
    fixture->params.style = style;
    fixture->params.drag = drag;
    if (tune) tune(&fixture->params);
    gpu_timer_create(&fixture->timer, false, true);
    if (hair_create(&fixture->hair, strands, 0, &fixture_gpu()->limits, &error) != RESULT_OK)
        fail_msg("%s", error.text);
    create_solver(fixture);
}

void fixture_collide(HairFixture *fixture, const char *text)
{
    Error error = {{0}};
    if (colliders_parse(&fixture->colliders, text, &error) != RESULT_OK) fail_msg("%s", error.text);
    solver_destroy(&fixture->solver);
    create_solver(fixture);
}

void fixture_create_strands(HairFixture *fixture, const Strands *strands, const char *algo,
                            const char *variant, float style, float drag)
{
    create(fixture, strands, algo, variant, style, drag, NULL);
}

void fixture_create_tuned(HairFixture *fixture, const double (*positions)[3], int count, int n,
                          const char *algo, const char *variant, float style, float drag,
                          void (*tune)(SectionParams *params))
{
    Strands strands;
    assert_int_equal(strands_create(&strands, (uint32_t)count, (uint32_t)(count * n), NULL),
                     RESULT_OK);
    for (int s = 0; s <= count; ++s) strands.first[s] = (uint32_t)(s * n);
    for (int i = 0; i < count * n; ++i)
        for (int k = 0; k < 3; ++k) strands.position[i][k] = (float)positions[i][k];
    create(fixture, &strands, algo, variant, style, drag, tune);
    strands_destroy(&strands);
}

void fixture_create(HairFixture *fixture, const double (*positions)[3], int count, int n,
                    const char *algo, const char *variant, float style, float drag)
{
    fixture_create_tuned(fixture, positions, count, n, algo, variant, style, drag, NULL);
}

void fixture_destroy(HairFixture *fixture)
{
    solver_destroy(&fixture->solver);
    hair_destroy(&fixture->hair);
    gpu_timer_destroy(&fixture->timer);
    params_destroy_section(&fixture->params);
    colliders_destroy(&fixture->colliders);
}

void fixture_solve_anew(HairFixture *fixture)
{
    solver_destroy(&fixture->solver);
    create_solver(fixture);
}

void fixture_shelter(HairFixture *fixture)
{
    fixture->sheltered = true;
    fixture_solve_anew(fixture);
}

void fixture_step(HairFixture *fixture)
{
    solver_step(&fixture->solver, &fixture->step);
    fixture->step.head_old = fixture->step.head;
    fixture->step.first = false;
    ++fixture->step.number;
}

float (*fixture_positions(HairFixture *fixture, uint32_t batch))[4]
{
    const HairBatch *hair = &fixture->hair.batches[batch];
    solver_pose(&fixture->solver, &fixture->step.head);
    float(*positions)[4] = gpu_buffer_read(&hair->position);
    assert_non_null(positions);
    for (uint32_t i = 0; i < hair->strand_count; ++i) // whichever shader has written it (hair.h)
        for (uint32_t j = 0; j < hair->vertex_count; ++j) {
            float rest = positions[hair_address(hair, i, j)][3];
            assert_true(rest == rintf(rest) && fabsf(rest) < 0x1p23f);
        }
    return positions;
}

void fixture_require_finite(HairFixture *fixture)
{
    const HairBatch *batch = &fixture->hair.batches[0];
    const size_t count = hair_slots(batch) * (size_t)batch->vertex_count;
    float(*positions)[4] = fixture_positions(fixture, 0);
    for (size_t i = 0; i < count; ++i)
        for (int k = 0; k < 3; ++k)
            if (!isfinite(positions[i][k])) fail_msg("position %zu is not finite", i);
    free(positions);
}
