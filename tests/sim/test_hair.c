// SPDX-License-Identifier: MIT
// Hair on the GPU: batches by vertex count and by the driver's limits, the rest shape, and uniform
// blocks shared with shaders.
#include "gpu/shader.h"
#include "sim/step.h"
#include "support/hair_fixture.h"

#include "glsl/sim/chain_params.h"
#include "glsl/sim/dftl_params.h"
#include "glsl/sim/emulation_params.h"
#include "glsl/sim/follow_params.h"
#include "glsl/sim/hybrid_params.h"
#include "glsl/sim/inbetween_params.h"
#include "glsl/sim/pose_params.h"
#include "glsl/sim/rod_params.h"
#include "glsl/sim/rope_params.h"
#include "glsl/sim/split_params.h"
#include "glsl/sim/spring_params.h"
#include "glsl/sim/tressfx_params.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// Strands of 2, 3, 4, 2, 3, 4 ... vertices along x, far enough apart that a position identifies
// strand and vertex.
static void make_strands(Strands *strands, uint32_t count)
{
    uint32_t vertices = 0;
    for (uint32_t s = 0; s < count; ++s) vertices += 2 + s % 3;
    assert_int_equal(strands_create(strands, count, vertices, NULL), RESULT_OK);
    for (uint32_t s = 0, at = 0; s < count; ++s) {
        strands->first[s] = at;
        for (uint32_t j = 0; j < 2 + s % 3; ++j, ++at)
            strands->position[at][0] = (float)s, strands->position[at][1] = -(float)j;
        strands->first[s + 1] = at;
    }
}

static float (*read_vectors(const GpuBuffer *buffer))[4]
{
    float(*data)[4] = malloc((size_t)buffer->size);
    assert_non_null(data);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer->buffer);
    glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)buffer->size, data);
    return data;
}

// Each strand is in exactly one batch with its number, positions and lengths.
static void check_batches(const Hair *hair, const Strands *strands, uint32_t first_id)
{
    uint8_t *seen = calloc(strands->strand_count, 1);
    for (uint32_t b = 0; b < hair->batch_count; ++b) {
        const HairBatch *batch = &hair->batches[b];
        float(*position)[4] = read_vectors(&batch->position),
        (*rest)[4] = read_vectors(&batch->rest);
        uint32_t *ids = (uint32_t *)read_vectors(&batch->strand_id);
        for (uint32_t slot = 0; slot < batch->strand_count; ++slot) {
            uint32_t s = ids[slot] - first_id;
            assert_true(s < strands->strand_count && !seen[s]++);
            assert_int_equal(batch->vertex_count, strands_size(strands, s));
            assert_true(rest[hair_address(batch, slot, 0)][3] == (float)(batch->vertex_count - 1));
            for (uint32_t j = 0; j < batch->vertex_count; ++j) {
                const float *x = position[hair_address(batch, slot, j)],
                            *r = rest[hair_address(batch, slot, j)];
                assert_true(x[0] == (float)s && x[1] == -(float)j && x[2] == 0);
                if (j > 0) assert_true(r[0] == 0 && r[1] == -1 && r[2] == 0 && r[3] == 1);
            }
        }
        free(position), free(rest), free(ids);
    }
    for (uint32_t s = 0; s < strands->strand_count; ++s) assert_true(seen[s]);
    free(seen);
}

static void strands_of_any_count_stand_in_batches_of_their_own(void **state)
{
    (void)state;
    Strands strands;
    Hair hair;
    make_strands(&strands, 100);
    assert_int_equal(hair_create(&hair, &strands, 7, &fixture_gpu()->limits, NULL), RESULT_OK);
    assert_int_equal(hair.batch_count, 3);
    assert_int_equal(hair.particle_count, strands.vertex_count);
    assert_int_equal(hair.segment_count, strands.vertex_count - 100);
    check_batches(&hair, &strands, 7);
    hair_destroy(&hair);
    strands_destroy(&strands);
}

static void hair_larger_than_a_buffer_is_split_never_cut(void **state)
{
    (void)state;
    Strands strands;
    Hair hair;
    GpuLimits limits = fixture_gpu()->limits;
    limits.storage_block = HAIR_MOST_SCRATCH * 4 * 16 * 16; // one tile of 16 strands of 4 vertices
    make_strands(&strands, 300);
    assert_int_equal(hair_create(&hair, &strands, 0, &limits, NULL), RESULT_OK);
    assert_true(hair.batch_count > 3 * 100 / 32);
    check_batches(&hair, &strands, 0);
    hair_destroy(&hair);
    Error error;
    limits.storage_block = HAIR_MOST_SCRATCH * 16 * 16; // less than that
    assert_int_equal(hair_create(&hair, &strands, 0, &limits, &error), RESULT_FAILED);
    assert_non_null(strstr(error.text, "exceeds the limit of this driver's buffers"));
    strands_destroy(&strands);
}

static GLuint build(const char *shader)
{
    GLuint program;
    const ShaderDefine defines[] = {{"GROUP_SIZE", 8},
                                    {"STRANDS", 1},
                                    {"IN_REGISTERS", 0},
                                    {"VERTICES", 4},
                                    {"SHELTER", 0},
                                    {"LEAD", 0},
                                    {"THESIS", 0},
                                    {"DRAGGED", 0},
                                    {"STYLED", 1},
                                    {"JOINTS", 1},
                                    {"BULLET", 0},
                                    {"IMPLICIT", 1},
                                    {"TRESSFX4", 0},
                                    {"GUARDED", 1},
                                    {"EQUAL", 0},
                                    {"BALANCED", 1},
                                    {0}};
    assert_int_equal(shader_build_compute(&program, shader, defines, NULL), RESULT_OK);
    return program;
}

// The buffer must be at least as large as the block.
static void assert_size(GLuint program, const char *block, size_t size)
{
    const GLenum property = GL_BUFFER_DATA_SIZE;
    GLint wanted = -1;
    GLuint index = glGetProgramResourceIndex(program, GL_UNIFORM_BLOCK, block);
    if (index == GL_INVALID_INDEX) fail_msg("the driver knows no %s", block);
    glGetProgramResourceiv(program, GL_UNIFORM_BLOCK, index, 1, &property, 1, NULL, &wanted);
    if ((size_t)wanted > size)
        fail_msg("%s has %d bytes for the driver, %zu in C", block, wanted, size);
}

#define SIZE(type)      assert_size(program, #type, sizeof(type))
#define AT(type, field) fixture_assert_offset(program, #type "." #field, offsetof(type, field))
#define SPRING_AT(type, spring)                                                                    \
    AT(type, spring.stiffness), AT(type, spring.pull), AT(type, spring.keep), AT(type, spring.draw)

static void own_blocks_of_solvers_lie_alike_in_c_and_glsl(void **state)
{
    (void)state;
    GLuint program = build("sim/split.comp");
    SIZE(SplitParams), AT(SplitParams, pulls);
    shader_release(program);
    program = build("sim/emulation.comp");
    SIZE(EmulationParams), SPRING_AT(EmulationParams, spring), AT(EmulationParams, order_seed);
    shader_release(program);
    program = build("sim/hybrid.comp");
    SIZE(HybridParams), SPRING_AT(HybridParams, spring);
    shader_release(program);
    program = build("sim/chain.comp");
    SIZE(ChainParams), SPRING_AT(ChainParams, spring);
    shader_release(program);
    program = build("sim/rod.comp");
    SIZE(RodParams), SPRING_AT(RodParams, spring), AT(RodParams, bend), AT(RodParams, twist);
    AT(RodParams, share), AT(RodParams, area);
    shader_release(program);
    program = build("sim/tressfx.comp");
    SIZE(TressfxParams), AT(TressfxParams, local_share), AT(TressfxParams, global_share);
    AT(TressfxParams, global_range), AT(TressfxParams, shock), AT(TressfxParams, shock_threshold);
    AT(TressfxParams, most_move), AT(TressfxParams, exchanged), AT(TressfxParams, local_passes);
    AT(TressfxParams, length_passes);
    shader_release(program);
    program = build("sim/spring.comp");
    SIZE(SpringParams), AT(SpringParams, coil), AT(SpringParams, angular);
    AT(SpringParams, stretch_drawn);
    shader_release(program);
    program = build("sim/rope.comp");
    SIZE(RopeParams), SPRING_AT(RopeParams, first_spring), SPRING_AT(RopeParams, spring);
    AT(RopeParams, first_decay), AT(RopeParams, first_gain), AT(RopeParams, kept);
    AT(RopeParams, softness), AT(RopeParams, small_steps), AT(RopeParams, sweeps);
    AT(RopeParams, stretch_drawn);
    shader_release(program);
    program = build("sim/dftl.comp");
    SIZE(DftlParams), SPRING_AT(DftlParams, spring), AT(DftlParams, damping);
    shader_release(program);
}

static void blocks_lie_alike_in_c_and_glsl(void **state)
{
    (void)state;
    GLuint program = build("sim/split.comp");
#define STEP(field, suffix)                                                                        \
    fixture_assert_offset(program, "StepParams." #field suffix, offsetof(StepParams, field))
    SIZE(StepParams), STEP(head_rotation_old, ""), STEP(head_translation_old, "");
    STEP(head_rotation, ""), STEP(head_translation, ""), STEP(gravity, ""), STEP(held, ""),
        STEP(wind, "[0]");
    STEP(shelter, ""), STEP(head_velocity, ""), STEP(head_pivot, ""), STEP(head_move, ""),
        STEP(dt, ""), STEP(decay, ""), STEP(gain, "");
    STEP(drag, ""), STEP(strand_count, ""), STEP(vertex_count, ""), STEP(phase, "");
    STEP(frame_old, ""), STEP(frame_now, "");
    shader_release(program);
    const ShaderDefine pose[] = {{"GROUP_SIZE", 8}, {"MIX", 2}, {0}};
    assert_int_equal(shader_build_compute(&program, "sim/pose.comp", pose, NULL), RESULT_OK);
#define POSE(field, suffix)                                                                        \
    fixture_assert_offset(program, "PoseParams." #field suffix, offsetof(PoseParams, field))
    POSE(head_rotation, ""), POSE(head_translation, ""), POSE(turn_cos, "[0]"),
        POSE(turn_sin, "[0]");
    POSE(strand_count, ""), POSE(vertex_count, ""), POSE(lead, "");
    shader_release(program);
    const ShaderDefine follow[] = {{"GROUP_SIZE", 8}, {"INTERPOLATE", 1}, {"CLUMPS", 1}, {0}};
    assert_int_equal(shader_build_compute(&program, "sim/follow.comp", follow, NULL), RESULT_OK);
#define FOLLOW(field)                                                                              \
    fixture_assert_offset(program, "FollowParams." #field, offsetof(FollowParams, field))
    FOLLOW(head_rotation), FOLLOW(tip_separation), FOLLOW(clump), FOLLOW(strand_count),
        FOLLOW(vertex_count), FOLLOW(first_guide), FOLLOW(per_guide);
    shader_release(program);
    const ShaderDefine inbetween[] = {{"GROUP_SIZE", 8}, {0}};
    assert_int_equal(shader_build_compute(&program, "sim/inbetween.comp", inbetween, NULL),
                     RESULT_OK);
#define INBETWEEN(field)                                                                           \
    fixture_assert_offset(program, "InbetweenParams." #field, offsetof(InbetweenParams, field))
    INBETWEEN(earlier_rotation), INBETWEEN(earlier_translation), INBETWEEN(later_rotation);
    INBETWEEN(later_translation), INBETWEEN(now_rotation), INBETWEEN(now_translation);
    INBETWEEN(share), INBETWEEN(strand_count), INBETWEEN(vertex_count);
    shader_release(program);
}

static void shader_errors_name_file_and_line(void **state)
{
    (void)state;
    Error error;
    GLuint program;
    // GROUP_SIZE is missing.
    assert_int_equal(shader_build_compute(&program, "sim/pose.comp",
                                          (const ShaderDefine[]){{"MIX", 0}, {0}}, &error),
                     RESULT_FAILED);
    assert_int_equal(program, 0);
    assert_true(strncmp(error.text, "glsl/sim/pose.comp:", 15) == 0);
    assert_int_equal(shader_build_compute(&program, "nothing.comp", NULL, &error), RESULT_FAILED);
    assert_string_equal(error.text, "glsl/nothing.comp: no such shader file");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(strands_of_any_count_stand_in_batches_of_their_own),
        cmocka_unit_test(hair_larger_than_a_buffer_is_split_never_cut),
        cmocka_unit_test(blocks_lie_alike_in_c_and_glsl),
        cmocka_unit_test(own_blocks_of_solvers_lie_alike_in_c_and_glsl),
        cmocka_unit_test(shader_errors_name_file_and_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
