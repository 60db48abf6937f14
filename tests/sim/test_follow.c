// SPDX-License-Identifier: MIT
// Followers: their positions in the plan, and the GPU's positions against the plan's.
#include "base/nearest.h"
#include "base/random.h"
#include "gen/strands_make.h"
#include "sim/follow.h"
#include "strands/strands_edit.h"
#include "support/hair_fixture.h"

#include <cglm/cglm.h>

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static Strands make_curls(uint32_t count)
{
    Strands strands;
    StrandsRecipe recipe = strands_make_recipe(STRANDS_STYLE_CURLS);
    recipe.count = count, recipe.vertices = 12;
    assert_int_equal(strands_make(&strands, &recipe, NULL), RESULT_OK);
    return strands;
}

// side x side strands of 3 vertices on the plane y = 0, 1 m apart; each leans by `lean`(x).
static Strands make_lawn(int side, float (*lean)(float x))
{
    Strands strands;
    uint32_t count = (uint32_t)(side * side);
    assert_int_equal(strands_create(&strands, count, 3 * count, NULL), RESULT_OK);
    for (uint32_t s = 0; s < count; ++s) {
        float x = (float)((int)s % side), z = (float)((int)s / side);
        strands.first[s + 1] = 3 * (s + 1);
        for (int j = 0; j < 3; ++j) {
            const float at[3] = {x + (float)j * lean(x), (float)j, z};
            memcpy(strands.position[3 * s + (uint32_t)j], at, sizeof at);
        }
    }
    return strands;
}

static float upright(float x)
{
    (void)x;
    return 0;
}

static float parted(float x)
{
    return x < 2.5f ? -2 : 2;
}

static uint32_t *all_of(const Strands *strands)
{
    uint32_t *guides = malloc((strands->strand_count + 1) * sizeof *guides);
    for (uint32_t s = 0; s < strands->strand_count; ++s) guides[s] = s;
    return guides;
}

static FollowPlan make_plan(const Strands *strands, FollowOptions options)
{
    FollowPlan plan;
    uint32_t *guides = all_of(strands);
    assert_int_equal(
        follow_plan_create(&plan, strands, guides, strands->strand_count, &options, NULL),
        RESULT_OK);
    free(guides);
    return plan;
}

static void test_the_tree_finds_what_all_pairs_find(void **state)
{
    enum { COUNT = 700, MOST = 9 };
    (void)state;
    static float point[COUNT][3];
    Random random = random_create(3, 0);
    Nearest nearest;
    for (int i = 0; i < COUNT; ++i) // a third of them at the same position
        for (int k = 0; k < 3; ++k) point[i][k] = i % 3 ? (float)random_real(&random) : 0.5f;
    assert_int_equal(nearest_create(&nearest, (const float(*)[3])point, COUNT, NULL), RESULT_OK);
    for (uint32_t i = 0; i < COUNT; i += 7) {
        Neighbour found[MOST];
        assert_int_equal(nearest_find(&nearest, i, found, MOST), MOST);
        for (int f = 1; f < MOST; ++f) assert_true(found[f].square >= found[f - 1].square);
        uint32_t nearer = 0; // number of points nearer than the last one found
        for (uint32_t j = 0; j < COUNT; ++j) {
            double square = 0;
            for (int k = 0; k < 3; ++k) square += pow((double)point[j][k] - (double)point[i][k], 2);
            nearer += j != i && square < found[MOST - 1].square;
        }
        assert_true(nearer <= MOST - 1);
    }
    nearest_destroy(&nearest);
}

static void test_offsets_fill_a_disc_across_the_root(void **state)
{
    enum { PER_GUIDE = 400 };
    (void)state;
    Strands strands = make_curls(3);
    FollowPlan plan =
        make_plan(&strands, (FollowOptions){.per_guide = PER_GUIDE, .radius = 0.01f, .seed = 1});
    for (uint32_t g = 0; g < 3; ++g) {
        const float *root = strands.position[strands.first[g]], *next = root + 3;
        double squares = 0, middle[3] = {0};
        for (uint32_t i = 0; i < PER_GUIDE; ++i) {
            const Follower *follower = &plan.follower[g * PER_GUIDE + i];
            double square = 0, along = 0;
            for (int k = 0; k < 3; ++k) {
                double o = (double)follower->offset[k];
                square += o * o, along += o * (double)(next[k] - root[k]), middle[k] += o;
            }
            assert_true(square <= 1.0001e-4);
            assert_true(fabs(along) < 1e-8);
            squares += square;
        }
        // For a uniform disc, the mean of r^2 is R^2/2 with a standard deviation of R^2/sqrt(12),
        // and a coordinate's mean is 0 with R/2; for 400 followers, 5 standard deviations are 7 %
        // of R^2 and 0.13 R.
        assert_true(fabs(squares / PER_GUIDE / 1e-4 - 0.5) < 0.07);
        for (int k = 0; k < 3; ++k) assert_true(fabs(middle[k] / PER_GUIDE / 0.01) < 0.13);
    }
    follow_plan_destroy(&plan);
    strands_destroy(&strands);
}

// Moves and scales hair, in float32.
static void transform(Strands *strands, float by, float scale)
{
    for (uint32_t v = 0; v < strands->vertex_count; ++v)
        for (int k = 0; k < 3; ++k)
            strands->position[v][k] = scale * (strands->position[v][k] + by);
}

// How many followers of the second plan have another place, in the unit of the first one.
static int count_moved(const FollowPlan *a, const FollowPlan *b, uint32_t count, float scale)
{
    int moved = 0;
    for (uint32_t i = 0; i < count * a->per_guide; ++i) {
        const Follower *f = &a->follower[i], *g = &b->follower[i];
        bool same = f->id == g->id && memcmp(f->guide, g->guide, sizeof f->guide) == 0;
        for (int k = 0; k < 3; ++k)
            same = same && fabsf(f->weight[k] - g->weight[k]) < 1e-3f &&
                   fabsf(f->offset[k] - g->offset[k] / scale) < 1e-3f * 0.02f;
        moved += !same;
    }
    return moved;
}

// Roots on a lawn are regular, so that only rounding could choose between diagonals; its strands
// point along an axis. Of the curls, a follower may be at the edge of a triangle.
static void test_rounding_does_not_move_followers(void **state)
{
    enum { PER_GUIDE = 5 };
    (void)state;
    for (int test = 0; test < 4; ++test) {
        bool lawn = test >= 2;
        FollowOptions options = {PER_GUIDE, test % 2, lawn ? 1 : 0.02f, 7};
        Strands strands = lawn ? make_lawn(8, upright) : make_curls(60);
        uint32_t count = strands.strand_count;
        FollowPlan before = make_plan(&strands, options), other;
        options.seed = 8;
        other = make_plan(&strands, options);
        assert_int_not_equal(count_moved(&before, &other, count, 1), 0);
        follow_plan_destroy(&other);
        options.seed = 7;
        const float change[3][2] = {{1e-6f, 1}, {0, 1000}, {0.3f, 0.01f}}; // move, scale
        for (int i = 0; i < 3; ++i) {
            Strands changed = lawn ? make_lawn(8, upright) : make_curls(60);
            transform(&changed, change[i][0], change[i][1]);
            options.radius = (lawn ? 1 : 0.02f) * change[i][1];
            FollowPlan after = make_plan(&changed, options);
            int moved = count_moved(&before, &after, count, change[i][1]);
            if (moved > (int)count * PER_GUIDE / 100)
                fail_msg("case %d.%d: %d followers moved", test, i, moved);
            follow_plan_destroy(&after);
            strands_destroy(&changed);
        }
        follow_plan_destroy(&before);
        strands_destroy(&strands);
    }
}

// On a lawn, the roots of a guide's followers are nearer to it than to any other guide, and lie all
// around it.
static void test_interpolation_covers_the_scalp(void **state)
{
    enum { SIDE = 7, PER_GUIDE = 64 };
    (void)state;
    Strands strands = make_lawn(SIDE, upright);
    // Squares have two diagonals, both allowed in a Delaunay triangulation: small random offsets
    // decide.
    Random random = random_create(1, 1);
    for (uint32_t v = 0; v < strands.vertex_count; ++v)
        strands.position[v][0] += 0.02f * (float)random_real(&random);
    FollowPlan plan = make_plan(&strands, (FollowOptions){PER_GUIDE, true, 1, 1});
    for (uint32_t s = 0; s < SIDE * SIDE; ++s) {
        uint32_t column = s % SIDE, row = s / SIDE, quadrants = 0;
        bool inside = column > 0 && column < SIDE - 1 && row > 0 && row < SIDE - 1;
        for (uint32_t i = 0; i < PER_GUIDE; ++i) {
            const Follower *of = &plan.follower[s * PER_GUIDE + i];
            double x = 0, z = 0, sum = 0;
            for (int g = 0; g < 3; ++g) {
                const float *root = strands.position[3 * of->guide[g]];
                x += (double)(of->weight[g] * (root[0] - (float)column));
                z += (double)(of->weight[g] * (root[2] - (float)row));
                sum += (double)of->weight[g];
                assert_true(of->weight[g] >= 0 && of->weight[g] <= of->weight[0]);
            }
            assert_true(of->guide[0] == s && fabs(sum - 1) < 1e-6);
            // A third of a triangle with a right angle and legs of 1; at the rim there are thin
            // triangles.
            assert_true(!inside || (fabs(x) < 0.70 && fabs(z) < 0.70));
            quadrants |= 1u << ((x > 0) + 2 * (z > 0));
        }
        if (inside) assert_int_equal(quadrants, 15);
    }
    follow_plan_destroy(&plan);
    strands_destroy(&strands);
}

static void test_interpolation_keeps_partings(void **state)
{
    enum { SIDE = 6, PER_GUIDE = 16 };
    (void)state;
    Strands strands = make_lawn(SIDE, parted);
    FollowPlan plan = make_plan(&strands, (FollowOptions){PER_GUIDE, true, 1, 1});
    uint32_t between = 0;
    for (uint32_t i = 0; i < SIDE * SIDE * PER_GUIDE; ++i) {
        const uint32_t *guide = plan.follower[i].guide;
        for (int g = 1; g < 3; ++g)
            assert_int_equal(guide[g] % SIDE < SIDE / 2, guide[0] % SIDE < SIDE / 2);
        between += guide[1] != guide[0];
    }
    assert_int_equal(between, SIDE * SIDE * PER_GUIDE);
    follow_plan_destroy(&plan);
    // If roots are too far apart, followers stay next to their guide.
    plan = make_plan(&strands, (FollowOptions){PER_GUIDE, true, 0.1f, 1});
    for (uint32_t i = 0; i < SIDE * SIDE * PER_GUIDE; ++i)
        assert_true(plan.follower[i].weight[0] == 1);
    follow_plan_destroy(&plan);
    strands_destroy(&strands);
}

static float apart_by_55(float x)
{
    return x < 2.5f ? -0.520567f : 0.520567f; // tan(27.5 degrees)
}

static float apart_by_65(float x)
{
    return x < 2.5f ? -0.637070f : 0.637070f; // tan(32.5 degrees)
}

// Followers are interpolated between guides whose directions differ by up to 60 degrees.
static void test_a_parting_begins_at_60_degrees(void **state)
{
    enum { SIDE = 6, PER_GUIDE = 16 };
    (void)state;
    for (int parts = 0; parts < 2; ++parts) {
        Strands strands = make_lawn(SIDE, parts ? apart_by_65 : apart_by_55);
        FollowPlan plan = make_plan(&strands, (FollowOptions){PER_GUIDE, true, 1, 1});
        uint32_t bridges = 0;
        for (uint32_t i = 0; i < SIDE * SIDE * PER_GUIDE; ++i) {
            const uint32_t *guide = plan.follower[i].guide;
            for (int g = 1; g < 3; ++g)
                bridges += (guide[g] % SIDE < SIDE / 2) != (guide[0] % SIDE < SIDE / 2);
        }
        assert_true(parts ? bridges == 0 : bridges > SIDE * PER_GUIDE);
        follow_plan_destroy(&plan);
        strands_destroy(&strands);
    }
}

// The share of a triangle where no weight is greater than w.
static double share_below(double w)
{
    if (w < 1.0 / 3) return 0;
    return w < 0.5 ? (3 * w - 1) * (3 * w - 1) : 1 - 3 * (1 - w) * (1 - w);
}

static int compare_numbers(const void *a, const void *b)
{
    const float *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

// Three guides, one triangle: the largest weights are distributed like areas, by the
// Kolmogorov-Smirnov test at the level of 0.1 %. The other two are equal on average, within four
// standard deviations of their difference, sqrt(2 Var) < 0.2.
static void test_followers_lie_evenly_between_guides(void **state)
{
    enum { PER_GUIDE = 4000, COUNT = 3 * PER_GUIDE };
    static float largest[COUNT];
    (void)state;
    Strands strands = make_lawn(2, upright);
    strands.strand_count = 3; // without the fourth strand of the lawn
    FollowPlan plan = make_plan(&strands, (FollowOptions){PER_GUIDE, true, 1, 1});
    double off = 0, difference = 0;
    for (int i = 0; i < COUNT; ++i) {
        const float *weight = plan.follower[i].weight;
        largest[i] = weight[0];
        difference += (double)weight[1] - (double)weight[2];
    }
    qsort(largest, COUNT, sizeof *largest, compare_numbers);
    for (int i = 0; i < COUNT; ++i)
        off = fmax(off, fabs((i + 0.5) / COUNT - share_below((double)largest[i])));
    print_message("shares off by %.2g, expected below %.2g\n", off, 1.95 / sqrt(COUNT));
    assert_true(off < 1.95 / sqrt(COUNT));
    assert_true(fabs(difference) / COUNT < 4 * 0.2 / sqrt(COUNT));
    follow_plan_destroy(&plan);
    strands_destroy(&strands);
}

static void test_the_file_says_how_many_unless_the_user_does(void **state)
{
    (void)state;
    Strands strands = make_lawn(20, upright);
    SectionParams params;
    assert_int_equal(params_create_section(&params, NULL), RESULT_OK);
    params.followers = (AutoInt){.value = -1};
    assert_int_equal(follow_plan_options(&params, &strands, 0).per_guide, 0);
    assert_true(follow_plan_reach(&params, &strands) == 0);
    strands.followers = 6;
    assert_int_equal(follow_plan_options(&params, &strands, 0).per_guide, 6);
    // A root's share of the lawn is one square metre, a disc of radius 0.56 m; at the rim the share
    // is smaller.
    assert_true(fabsf(follow_plan_options(&params, &strands, 0).radius - 0.56f) < 0.1f);
    strands.follower_radius = 0.25f;
    params.tip_separation = 2;
    assert_true(follow_plan_reach(&params, &strands) == 0.75f);
    params.followers = (AutoInt){.value = 0};
    assert_int_equal(follow_plan_options(&params, &strands, 0).per_guide, 0);
    params_destroy_section(&params);
    strands_destroy(&strands);
}

static void test_hair_of_few_strands_is_filled(void **state)
{
    (void)state;
    SectionParams params;
    assert_int_equal(params_create_section(&params, NULL), RESULT_OK);
    const double frame = 16000; // segments that a frame costs in addition to the hair's
    for (uint32_t count = 20; count < 6000; count = count * 5 / 4) {
        Strands strands = make_curls(count);
        FollowOptions options = follow_plan_options(&params, &strands, 0);
        double segments = strands.vertex_count - strands.strand_count,
               filled = segments * (1 + options.per_guide);
        assert_int_equal(options.per_guide, follow_plan_fill(&strands));
        assert_true(filled + frame <= 3 * (segments + frame));
        bool few = count >= 32 && count < 5000;
        assert_int_equal(options.per_guide >= 2, few);
        assert_int_equal(options.interpolate, few);
        assert_int_equal(follow_plan_fills(&params, &strands), few);
        // If the user sets the radius, strands are single fibres.
        params.radius = (AutoFloat){.value = 1e-4f};
        assert_false(follow_plan_fills(&params, &strands));
        params.radius = (AutoFloat){.automatic = true};
        // A number set by the user or by the file takes precedence.
        params.followers = (AutoInt){.value = 1};
        options = follow_plan_options(&params, &strands, 0);
        assert_true(options.per_guide == 1 && !options.interpolate);
        params.followers = (AutoInt){.value = -1};
        assert_int_equal(follow_plan_options(&params, &strands, 0).per_guide, 0);
        params.followers = (AutoInt){.automatic = true};
        strands.followers = 3;
        options = follow_plan_options(&params, &strands, 0);
        assert_true(options.per_guide == 3 && !options.interpolate);
        assert_false(follow_plan_fills(&params, &strands));
        strands_destroy(&strands);
    }
    params_destroy_section(&params);
}

// Curls with two vertex counts, which give two batches.
static Strands make_mixed(void)
{
    Strands strands = make_curls(90);
    uint32_t to = 0;
    for (uint32_t s = 0; s < strands.strand_count; ++s) {
        uint32_t from = strands.first[s], size = 12 - 5 * (s & 1);
        memmove(strands.position[to], strands.position[from], size * sizeof *strands.position);
        strands.first[s] = to;
        to += size;
    }
    strands.first[strands.strand_count] = strands.vertex_count = to;
    return strands;
}

static void read_buffer(const GpuBuffer *buffer, void *data)
{
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer->buffer);
    glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)buffer->size, data);
}

typedef float Float4[4];

// The largest distance in m of a batch's followers from where the plan puts them according to the
// guides' positions.
static double distance_from_plan(const Follow *follow, uint32_t b, const FollowPlan *plan,
                                 const HeadPose *head, bool with_offset)
{
    const HairBatch *hair = &follow->hair.batches[b],
                    *guides = &follow->guides->batches[follow->batches[b].guide_batch];
    Float4 *at = malloc((size_t)hair->position.size), *of = malloc((size_t)guides->position.size);
    double worst = 0;
    read_buffer(&hair->position, at);
    read_buffer(&guides->position, of);
    for (uint32_t s = 0; s < hair->strand_count; ++s) {
        const Follower *follower = &plan->follower[s];
        vec3 offset = {0};
        memcpy(offset, follower->offset, sizeof follower->offset);
        glm_quat_rotatev((float *)head->rotation, offset, offset);
        for (uint32_t j = 0; j < hair->vertex_count; ++j)
            for (int k = 0; k < 3; ++k) {
                double x = 1 + (double)follow->tip_separation * j / (hair->vertex_count - 1);
                x *= with_offset ? (double)offset[k] : 0;
                for (int g = 0; g < 3; ++g)
                    x += (double)follower->weight[g] *
                         (double)of[hair_address(guides, follower->guide[g], j)][k];
                double gathered = (double)follow->clump * j / (hair->vertex_count - 1);
                x += gathered * ((double)of[hair_address(guides, follower->guide[0], j)][k] - x);
                worst = fmax(worst, fabs(x - (double)at[hair_address(hair, s, j)][k]));
            }
    }
    free(at);
    free(of);
    return worst;
}

static void check_gpu(int mode, float clump)
{
    Strands strands = make_mixed();
    HairFixture fixture;
    Follow follow;
    fixture_create_strands(&fixture, &strands, "chain", "", 0.5f, 1);
    fixture.params.followers = (AutoInt){.value = 3};
    fixture.params.follow = mode;
    fixture.params.tip_separation = 0.7f;
    fixture.params.clump = clump;
    assert_int_equal(follow_create(&follow, fixture_gpu(), &fixture.timer, &fixture.hair, &strands,
                                   &fixture.params, 4, NULL),
                     RESULT_OK);
    assert_int_equal(follow.hair.batch_count, 2);
    assert_int_equal(follow.hair.strand_count, 270);
    glm_quatv(fixture.step.head.rotation, 0.8f, (vec3){0.6f, 0, 0.8f});
    fixture.step.head.translation[0] = 0.1f;
    for (int i = 0; i < 5; ++i) fixture_step(&fixture);
    follow_write(&follow, &fixture.step.head);
    for (uint32_t b = 0; b < 2; ++b) {
        FollowPlan plan;
        const HairBatch *guides = &fixture.hair.batches[b];
        FollowOptions options = follow_plan_options(&fixture.params, &strands, 4);
        assert_int_equal(follow_plan_create(&plan, &strands, guides->strand, guides->strand_count,
                                            &options, NULL),
                         RESULT_OK);
        // Coordinates are below 2 m; a few operations are rounded by 2^-24 of that each.
        assert_true(distance_from_plan(&follow, b, &plan, &fixture.step.head, true) < 1e-6);
        if (mode == FOLLOW_OFFSET) // shows that the test can fail
            assert_true(distance_from_plan(&follow, b, &plan, &fixture.step.head, false) > 1e-4);
        follow_plan_destroy(&plan);
    }
    follow_destroy(&follow);
    fixture_destroy(&fixture);
    strands_destroy(&strands);
}

static void test_the_gpu_puts_followers_beside_guides(void **state)
{
    (void)state;
    check_gpu(FOLLOW_OFFSET, 0);
    check_gpu(FOLLOW_OFFSET, 0.6f);
}

static void test_the_gpu_puts_followers_between_guides(void **state)
{
    (void)state;
    check_gpu(FOLLOW_INTERPOLATE, 0);
    check_gpu(FOLLOW_INTERPOLATE, 0.6f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_tree_finds_what_all_pairs_find),
        cmocka_unit_test(test_offsets_fill_a_disc_across_the_root),
        cmocka_unit_test(test_rounding_does_not_move_followers),
        cmocka_unit_test(test_interpolation_covers_the_scalp),
        cmocka_unit_test(test_interpolation_keeps_partings),
        cmocka_unit_test(test_a_parting_begins_at_60_degrees),
        cmocka_unit_test(test_followers_lie_evenly_between_guides),
        cmocka_unit_test(test_the_file_says_how_many_unless_the_user_does),
        cmocka_unit_test(test_hair_of_few_strands_is_filled),
        cmocka_unit_test(test_the_gpu_puts_followers_beside_guides),
        cmocka_unit_test(test_the_gpu_puts_followers_between_guides),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
