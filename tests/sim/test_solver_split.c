// SPDX-License-Identifier: MIT
// The split solver on the GPU against its double-precision form, reference traces, and invariants
// for any hair.
#include "sim/step.h"
#include "support/reference_split.h"
#include "support/reference_traces.h"
#include "support/twin.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { MOST = REFERENCE_MAX };

static double total_length(const ReferenceStrand *strand)
{
    double sum = 0;
    for (int j = 1; j < strand->n; ++j) sum += strand->length[j];
    return sum;
}

// Each step adds rounding of about 2^-24 per particle, which adds up to sqrt(n) 2^-24 of the length
// over a strand of n; drag c reduces it within 1/(c dt) steps, over which it grows like a random
// walk. The factor 8 allows for errors that grow at kinks before drag reduces them.
static double step_tolerance(int n, double c, double dt)
{
    return 2 * sqrt((double)n / (c * dt)) * 0x1p-24;
}

enum { LONG_STEPS = 60 }; // every step is compared if there are fewer per second

// The RMS error after this number of seconds, relative to the length, as measured against the
// double-precision form: the largest of CPUs with vectors of 256 and 128 bits, AVX without FMA, and
// SSE2. Three times that is allowed, multiplied by fixture_rounding() where operations are less
// exact, or step_tolerance if that is more.
typedef struct SplitCase {
    int n;
    const char *variant;
    double style, rate, seconds, measured;
} SplitCase;

// The head's pose at a time: it moves by 4 cm at 2 Hz and rotates by 0.2 rad about the z axis.
static void move_head(HeadPose *head, double time)
{
    double turn = 0.1 * sin(6.283185307 * 2 * time); // half the angle
    head->translation[0] = (float)(0.02 * (1 - cos(6.283185307 * 2 * time)));
    head->rotation[2] = (float)sin(turn);
    head->rotation[3] = (float)cos(turn);
}

// Rotates v by the head's rotation about the z axis.
static void turn_with(const HeadPose *head, const Vec v, Vec turned)
{
    double s = (double)head->rotation[2], w = (double)head->rotation[3];
    double cosine = w * w - s * s, sine = 2 * s * w;
    const Vec r = {cosine * v[0] - sine * v[1], sine * v[0] + cosine * v[1], v[2]};
    vec_copy(r, turned);
}

// The largest distance of a drawn strand from its double-precision form, relative to the length.
static double find_distance(HairFixture *fixture, const ReferenceStrand *twins, int count,
                            const Vec *start, double style)
{
    double worst = 0;
    for (int s = 0; s < count; ++s) {
        const int n = twins[s].n;
        Vec directions[MOST], drawn[MOST], expected[MOST];
        for (int j = 1; j < n; ++j) {
            vec_add_scaled(start[s * n + j], -1, start[s * n + j - 1], directions[j]);
            for (int k = 0; k < 3; ++k) directions[j][k] /= twins[s].length[j];
            turn_with(&fixture->step.head, directions[j], directions[j]);
        }
        reference_pose(&twins[s], (const Vec *)directions, style, expected);
        twin_read_strand(fixture, s, drawn);
        double off =
            twin_rms((const Vec *)drawn, (const Vec *)expected, n, total_length(&twins[s]));
        worst = off > worst || isnan(off) ? off : worst;
    }
    return worst;
}

static void run_against_reference(const SplitCase *trial)
{
    enum { COUNT = 5 };
    const int n = trial->n, steps = (int)(trial->seconds * trial->rate);
    const char *variant = trial->variant;
    const float style = (float)trial->style;
    static Vec start[COUNT * MOST];
    static ReferenceStrand twin[COUNT];
    double worst = 0;
    HairFixture fixture;
    ReferenceStep step = *variant == 'b'   ? reference_ball_step
                         : *variant == 'd' ? reference_dragged_step
                                           : reference_thesis_step;
    for (int s = 0; s < COUNT; ++s) twin_make_curl(&start[s * n], n, 0.01 * s, 1 + s);
    fixture_create(&fixture, (const Vec *)start, COUNT, n, "split", variant, style, 1);
    for (int s = 0; s < COUNT; ++s) reference_start(&twin[s], n, (const Vec *)&start[s * n]);
    fixture.step.dt = 1 / trial->rate;
    for (int i = 0; i < 4; ++i) fixture.step.wind[i][0] = 1.5f, fixture.step.wind[i][2] = 0.5f;

    ReferenceForces forces = {.dt = fixture.step.dt,
                              .drag = 1,
                              .gravity = {0, (double)-9.81f, 0},
                              .wind = {1.5, 0, 0.5},
                              .first = true};
    for (int i = 1; i <= steps; ++i) {
        move_head(&fixture.step.head, i * fixture.step.dt);
        fixture_step(&fixture);
        for (int s = 0; s < COUNT; ++s) {
            Vec root;
            turn_with(&fixture.step.head, start[s * n], root);
            root[0] += (double)fixture.step.head.translation[0];
            step(&twin[s], root, &forces);
        }
        forces.first = false;
        if (i == steps || trial->rate < LONG_STEPS)
            worst =
                fmax(worst, find_distance(&fixture, twin, COUNT, (const Vec *)start, trial->style));
    }
    double limit = 3 * trial->measured * fixture_rounding();
    if (fixture_rounding() > 1) limit = fmax(limit, step_tolerance(n, 1, forces.dt));
    printf("split %s, n = %d, style %g, %g steps a second: RMS %.2g of the length from the "
           "double-precision twin after %d steps\n",
           variant, n, trial->style, trial->rate, worst, steps);
    if (!(worst < limit)) fail_msg("%.3g exceeds %.3g", worst, limit);
    fixture_destroy(&fixture);
}

static void run_cases(const SplitCase *cases, size_t count)
{
    for (size_t i = 0; i < count; ++i) run_against_reference(&cases[i]);
}

// With long steps the tip swings by up to a radian per step: corrections of its arc are large, and
// its string may become taut or loose within a step.
static void ball_equals_its_double_precision_twin(void **state)
{
    (void)state;
    static const SplitCase cases[] = {
        {16, "ball", 0, 60, 10, 4.2e-7}, {32, "ball", 0.5, 60, 10, 3.9e-7},
        {2, "ball", 0, 60, 10, 9.4e-7},  {16, "dragged", 0, 60, 10, 1.5e-7},
        {2, "ball", 0, 20, 2, 1.1e-6},   {16, "ball", 0, 15, 2, 3.4e-7},
        {16, "ball", 0, 10, 2, 2.4e-7},  {3, "dragged", 0, 10, 2, 2.2e-7},
    };
    run_cases(cases, sizeof cases / sizeof *cases);
}

static void thesis_equals_its_double_precision_twin(void **state)
{
    (void)state;
    static const SplitCase cases[] = {{16, "thesis", 0, 60, 10, 8.1e-7},
                                      {3, "thesis", 0.7, 60, 10, 1.7e-7}};
    run_cases(cases, sizeof cases / sizeof *cases);
}

static void strands_through_memory_equal_the_twin_too(void **state)
{
    (void)state;
    static const SplitCase cases[] = {{64, "ball", 0, 60, 10, 5.8e-7},
                                      {64, "thesis", 0, 60, 10, 2e-6}};
    run_cases(cases, sizeof cases / sizeof *cases);
}

static void dragged_equals_the_reference_traces(void **state)
{
    (void)state;
    assert_int_equal(traces_compare("ball_split", "split", "dragged", NULL), 4);
}

static void thesis_equals_the_reference_traces(void **state)
{
    (void)state;
    assert_int_equal(traces_compare("split", "split", "thesis", traces_imitate_explicit_drag), 4);
}

// Positions are float32: each coordinate errs by at most 2^-24 of its size, and the difference of
// two by twice that.
static void segment_lengths_do_not_drift_in_10000_steps(void **state)
{
    (void)state;
    enum { N = 32, COUNT = 16 };
    static Vec start[COUNT * N];
    Vec q[N];
    HairFixture fixture;
    for (int s = 0; s < COUNT; ++s) twin_make_curl(&start[s * N], N, 0.01 * s, 1 + s % 4);
    fixture_create(&fixture, (const Vec *)start, COUNT, N, "split", "", 0, 0);
    for (int i = 0; i < 10000; ++i) {
        fixture.step.head.translation[0] = (float)(0.05 * sin(0.13 * i));
        fixture_step(&fixture);
    }
    double worst = 0;
    for (int s = 0; s < COUNT; ++s) {
        ReferenceStrand rest;
        reference_start(&rest, N, (const Vec *)&start[s * N]);
        twin_read_strand(&fixture, s, q);
        for (int j = 1; j < N; ++j) {
            Vec r;
            double size = 0;
            for (int k = 0; k < 3; ++k)
                r[k] = q[j][k] - q[j - 1][k], size = fmax(size, fabs(q[j][k]));
            double length = sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
            // 4e-7: unit directions and the lengths themselves are float32
            worst = fmax(worst, fabs(length / rest.length[j] - 1) /
                                    (4e-7 + 2 * 1.8 * 0x1p-24 * size / rest.length[j]));
        }
    }
    assert_true(worst < 1);
    fixture_destroy(&fixture);
}

// One step with tips that move sideways so fast that the string turns by 0 to 85 degrees: up to the
// angle where its arc is no longer corrected, and beyond. A tip exactly at that angle may be
// rounded to either side. Bounds as above.
static void strings_that_turn_far_in_a_step_equal_the_twin(void **state)
{
    (void)state;
    enum { COUNT = 256, N = 2 };
    const double R = 0.25;
    static Vec start[COUNT * N];
    SolverBuffer buffers[SOLVER_MAX_BUFFERS];
    HairFixture fixture;
    double worst = 0;
    int others = 0;
    for (int s = 0; s < COUNT; ++s) start[s * N + 1][1] = -R;
    fixture_create(&fixture, (const Vec *)start, COUNT, N, "split", "", 0, 1);
    fixture.step.dt = 0.1;
    fixture.step.first = false;
    fixture.step.gravity[0] = 5; // across the strings
    solver_pose(&fixture.solver, &fixture.step.head);
    assert_true(solver_buffers(&fixture.solver, 0, buffers) >= 2);
    assert_int_equal(buffers[1].kind, SOLVER_TIPS);
    float(*tips)[4] = gpu_buffer_read(buffers[1].buffer);
    assert_non_null(tips);
    for (int s = 0; s < COUNT; ++s)
        tips[2 * s + 1][0] = (float)(1.2 * R / fixture.step.dt * s / COUNT);
    const ReferenceForces forces = {
        .dt = fixture.step.dt, .drag = 1, .gravity = {5, (double)-9.81f, 0}};
    glBindBuffer(GL_COPY_WRITE_BUFFER, buffers[1].buffer->buffer);
    glBufferSubData(GL_COPY_WRITE_BUFFER, 0, (GLsizeiptr)buffers[1].buffer->size, tips);
    fixture_step(&fixture);
    for (int s = 0; s < COUNT; ++s) {
        ReferenceStrand twin;
        Vec q[N];
        reference_start(&twin, N, (const Vec *)&start[s * N]);
        twin.velocity[0] = (double)tips[2 * s + 1][0];
        reference_ball_step(&twin, start[0], &forces);
        twin_read_strand(&fixture, s, q);
        double off = twin_rms((const Vec *)q, (const Vec *)twin.q, N, R);
        if (off > 1e-3)
            ++others;
        else
            worst = fmax(worst, off);
    }
    print_message("strings that turn far: %.2g off, %d otherwise\n", worst, others);
    assert_true(others <= 1);
    assert_true(worst < 3 * 2.5e-7);
    free(tips);
    fixture_destroy(&fixture);
}

// Tolerance of the length of a normalised direction as drawn: a dot product of three roundings,
// halved by the root; one rounding each for the product with the inverse root, for the product and
// the sum of the position, and for the length. The inverse root errs by half a unit, or by 2 units
// on other drivers (GLSL 4.30, 4.7.1), or by as many as are imitated.
static double length_tolerance(void)
{
    double units = fixture_rounding() > 1 ? fmax(2, fixture_gpu()->ulps) : 0.5;
    return (1.5 + 4) * 0x1p-24 + units * 0x1p-23;
}

// Directions almost opposite to the style's, within 10^-4 to 6 degrees. A quarter or three quarters
// of the way between the two is still a valid direction, although their sum consists mostly of
// rounding: of length 1 within the rounding of both and of positions, and 45 or 135 degrees from
// the style.
static void check_opposites(double style)
{
    enum { COUNT = 256 };
    static Vec start[2 * COUNT];
    SolverBuffer buffers[SOLVER_MAX_BUFFERS];
    HairFixture fixture;
    for (int s = 0; s < COUNT; ++s) start[2 * s + 1][0] = 0.48, start[2 * s + 1][1] = 0.64;
    fixture_create(&fixture, (const Vec *)start, COUNT, 2, "split", "", (float)style, 1);
    const HairBatch *batch = &fixture.hair.batches[0];
    solver_pose(&fixture.solver, &fixture.step.head);
    assert_true(solver_buffers(&fixture.solver, 0, buffers) >= 2);
    assert_int_equal(buffers[0].kind, SOLVER_DIRECTIONS);
    float(*segments)[4] = gpu_buffer_read(buffers[0].buffer);
    assert_non_null(segments);
    for (int s = 0; s < COUNT; ++s) {
        double off = M_PI / 180 * 6 * pow(6e4, -(double)s / COUNT), c = -cos(off), d = sin(off);
        float *segment = segments[hair_address(batch, (uint32_t)s, 1)];
        segment[0] = (float)(0.6 * c - 0.8 * d), segment[1] = (float)(0.8 * c + 0.6 * d);
    }
    glBindBuffer(GL_COPY_WRITE_BUFFER, buffers[0].buffer->buffer);
    glBufferSubData(GL_COPY_WRITE_BUFFER, 0, (GLsizeiptr)buffers[0].buffer->size, segments);
    free(segments);
    for (int s = 0; s < COUNT; ++s) {
        Vec q[2];
        twin_read_strand(&fixture, s, q);
        double length = vec_norm(q[1]) / 0.8, cosine = (0.6 * q[1][0] + 0.8 * q[1][1]) / 0.8;
        if (!(fabs(length - 1) < length_tolerance()))
            fail_msg("strand %d is %.8g times as long", s, length);
        if (!(fabs(cosine - cos(M_PI * (1 - style))) < 0.1))
            fail_msg("strand %d: a cosine of %g with the style", s, cosine);
    }
    fixture_destroy(&fixture);
}

static void strands_that_point_against_their_style_keep_their_lengths(void **state)
{
    (void)state;
    check_opposites(0.25);
    check_opposites(0.75);
}

static void hanging_hair_stays_at_rest(void **state)
{
    (void)state;
    Vec start[16], q[16];
    HairFixture fixture;
    for (int j = 0; j < 16; ++j) start[j][0] = 0.1, start[j][1] = 0.3 - 0.016 * j, start[j][2] = 0;
    fixture_create(&fixture, (const Vec *)start, 1, 16, "split", "", 0, 0);
    for (int i = 0; i < 600; ++i) fixture_step(&fixture);
    twin_read_strand(&fixture, 0, q);
    assert_true(twin_rms((const Vec *)q, (const Vec *)start, 16, 0.24) < 1e-6);
    fixture_destroy(&fixture);
}

// The tip is a pendulum; against the exact (elliptic) motion it has second order, 4e-4 of the
// length at 60 Hz with c = 4. This tests its period from 90 degrees, 1.183921 s for 0.25 m, by the
// time of the fourth passage through the lowest point of a strand of 2.
static void the_tip_swings_like_a_pendulum(void **state)
{
    (void)state;
    Vec start[2] = {{0, 0, 0}, {0.25, 0, 0}}, q[2];
    HairFixture fixture;
    fixture_create(&fixture, (const Vec *)start, 1, 2, "split", "", 0, 0);
    fixture.step.dt = 1.0 / 240;
    double before = 0.25, passages[4], time = 0;
    int count = 0;
    for (int i = 1; i < 1000 && count < 4; ++i) {
        fixture_step(&fixture);
        time += fixture.step.dt;
        twin_read_strand(&fixture, 0, q);
        if (before * q[1][0] < 0)
            passages[count++] = time - fixture.step.dt * q[1][0] / (q[1][0] - before);
        before = q[1][0];
    }
    assert_int_equal(count, 4);
    double period = passages[3] - passages[1];
    printf("period %.6f s, exact 1.183921 s\n", period);
    assert_true(
        fabs(period / 1.183921 - 1) <
        3e-4); // second order: (2 pi dt/period)^2/24 = 2e-5, with the passage times' rounding
    fixture_destroy(&fixture);
}

// Integrates phi'' = g/L cos(phi) - c phi', with phi downwards from the horizontal, over dt seconds
// by the fourth-order Runge-Kutta method in tiny steps (1e-4 s: 1e-12).
static void swing(double *angle, double *rate, double drag, double dt)
{
    const double ratio = 9.81 / 0.25;
    const int steps = 200;
    const double h = dt / steps, share[4] = {0, 0.5, 0.5, 1}, weight[4] = {1, 2, 2, 1};
    for (int i = 0; i < steps; ++i) {
        double a = 0, b = 0, sum_a = 0, sum_b = 0;
        for (int k = 0; k < 4; ++k) {
            double turned = *angle + share[k] * h * a, speed = *rate + share[k] * h * b;
            a = speed, b = ratio * cos(turned) - drag * speed;
            sum_a += weight[k] * a / 6, sum_b += weight[k] * b / 6;
        }
        *angle += h * sum_a, *rate += h * sum_b;
    }
}

// Released horizontally with drag 4/s, at 60 Hz for 2 s: 4e-4 of the length (RMS; with chords
// instead of arcs 9e-4).
static void the_tip_is_a_damped_pendulum(void **state)
{
    (void)state;
    enum { FRAMES = 120 };
    Vec start[2] = {{0, 0, 0}, {0.25, 0, 0}}, q[2];
    HairFixture fixture;
    double angle = 0, rate = 0, sum = 0;
    fixture_create(&fixture, (const Vec *)start, 1, 2, "split", "", 0, 4);
    for (int i = 0; i < FRAMES; ++i) {
        fixture_step(&fixture);
        swing(&angle, &rate, 4, fixture.step.dt);
        twin_read_strand(&fixture, 0, q);
        sum += pow(q[1][0] - 0.25 * cos(angle), 2) + pow(q[1][1] + 0.25 * sin(angle), 2);
    }
    double off = sqrt(sum / FRAMES) / 0.25;
    printf("tip %.2g of the length from a pendulum with drag 4/s\n", off);
    assert_true(off < 0.0008);
    fixture_destroy(&fixture);
}

static void strands_do_not_depend_on_each_other(void **state)
{
    (void)state;
    enum { N = 16, COUNT = 37 };
    static Vec start[COUNT * N];
    Vec together[N], alone[N];
    HairFixture all, one;
    for (int s = 0; s < COUNT; ++s) twin_make_curl(&start[s * N], N, 0.01 * s, 1 + s % 7);
    fixture_create(&all, (const Vec *)start, COUNT, N, "split", "", 0.3f, 1);
    fixture_create(&one, (const Vec *)&start[21 * N], 1, N, "split", "", 0.3f, 1);
    for (int i = 0; i < 50; ++i) fixture_step(&all), fixture_step(&one);
    twin_read_strand(&all, 21, together);
    twin_read_strand(&one, 0, alone);
    assert_memory_equal(together, alone, sizeof together);
    fixture_destroy(&all);
    fixture_destroy(&one);
}

// Strand, gravity and wind are rotated by 30 degrees about z. Float32 rounds the two runs
// differently, each by the tolerance of a run.
static void turning_the_whole_scene_turns_the_result(void **state)
{
    (void)state;
    enum { N = 16 };
    const double c = cos(0.5235987756), s = sin(0.5235987756);
    Vec start[N], turned[N], a[N], b[N];
    HairFixture plain, other;
    twin_make_curl(start, N, 0, 2);
    for (int j = 0; j < N; ++j)
        turned[j][0] = c * start[j][0] - s * start[j][1],
        turned[j][1] = s * start[j][0] + c * start[j][1], turned[j][2] = start[j][2];
    fixture_create(&plain, (const Vec *)start, 1, N, "split", "", 0.4f, 1);
    fixture_create(&other, (const Vec *)turned, 1, N, "split", "", 0.4f, 1);
    other.step.gravity[0] = (float)(9.81 * s), other.step.gravity[1] = (float)(-9.81 * c);
    for (int i = 0; i < 120; ++i) fixture_step(&plain), fixture_step(&other);
    twin_read_strand(&plain, 0, a);
    twin_read_strand(&other, 0, b);
    for (int j = 0; j < N; ++j) {
        Vec r = {c * a[j][0] - s * a[j][1], s * a[j][0] + c * a[j][1], a[j][2]};
        memcpy(a[j], r, sizeof r);
    }
    assert_true(twin_rms((const Vec *)a, (const Vec *)b, N, 0.25) <
                2 * step_tolerance(N, 1, 1.0 / 60));
    fixture_destroy(&plain);
    fixture_destroy(&other);
}

static void no_finite_input_gives_a_nan(void **state)
{
    (void)state;
    const float violence[][4] = {
        // gravity, wind, head jump (m), drag
        {1e6f, 0, 0, 0},      {0, 1e6f, 0, 1e6f}, {-9.81f, 0, 1e3f, 0},
        {-9.81f, 0, 1e8f, 1}, {0, 0, 1e-30f, 0},  {1e6f, 1e6f, 1e6f, 1e-6f},
    };
    enum { N = 24, COUNT = 8 };
    static Vec start[COUNT * N];
    for (int s = 0; s < COUNT; ++s) twin_make_curl(&start[s * N], N, 0.01 * s, s);
    for (size_t v = 0; v < sizeof violence / sizeof *violence; ++v)
        for (int thesis = 0; thesis < 2; ++thesis) {
            HairFixture fixture;
            fixture_create(&fixture, (const Vec *)start, COUNT, N, "split", thesis ? "thesis" : "",
                           0.5f, violence[v][3]);
            fixture.step.gravity[1] = violence[v][0];
            for (int i = 0; i < 4; ++i) fixture.step.wind[i][0] = violence[v][1];
            for (int i = 0; i < 30; ++i) {
                fixture.step.head.translation[1] = i % 2 ? violence[v][2] : 0;
                fixture_step(&fixture);
            }
            fixture_require_finite(&fixture);
            fixture_destroy(&fixture);
        }
}

static void a_flung_tip_is_cut_and_counted(void **state)
{
    (void)state;
    Vec start[8];
    HairFixture fixture;
    twin_make_curl(start, 8, 0, 1);
    fixture_create(&fixture, (const Vec *)start, 1, 8, "split", "", 0, 0);
    SolverReport report = {0};
    fixture_step(&fixture);
    solver_report(&fixture.solver, &report);
    assert_int_equal(report.moves_limited, 0);
    fixture.step.gravity[1] = -1e6f; // 1e6 / 60^2 = 278 m in a step, of a strand of 0.2 m
    fixture_step(&fixture);
    report = (SolverReport){0};
    solver_report(&fixture.solver, &report);
    assert_int_equal(report.moves_limited, 1);
    fixture_destroy(&fixture);
}

// CPU drivers end loops silently after 65,535 iterations: longer strands must be refused.
static void a_strand_beyond_the_drivers_loops_is_refused(void **state)
{
    (void)state;
    const uint32_t counts[] = {10000, 10001};
    for (int i = 0; i < 2; ++i) {
        Strands strands;
        Hair hair;
        Solver solver;
        Error error = {{0}};
        SectionParams params = {.algo = "split", .variant = "", .style = 0.5f};
        assert_int_equal(strands_create(&strands, 1, counts[i], NULL), RESULT_OK);
        strands.first[1] = counts[i];
        for (uint32_t j = 0; j < counts[i]; ++j) strands.position[j][0] = 0.001f * (float)j;
        assert_int_equal(hair_create(&hair, &strands, 0, &fixture_gpu()->limits, NULL), RESULT_OK);
        const SolverSetup setup = {.gpu = fixture_gpu(), .hair = &hair, .params = &params};
        assert_int_equal(solver_create(&solver, &setup, &error), i == 0 ? RESULT_OK : RESULT_USAGE);
        if (i == 1) assert_non_null(strstr(error.text, "10001 vertices"));
        solver_destroy(&solver);
        hair_destroy(&hair);
        strands_destroy(&strands);
    }
}

static void unknown_solvers_and_variants_name_the_nearest(void **state)
{
    (void)state;
    Error error;
    Solver solver;
    SectionParams params = {.algo = "slpit", .variant = ""};
    const Hair hair = {0};
    const SolverSetup setup = {.gpu = fixture_gpu(), .hair = &hair, .params = &params};
    assert_int_equal(solver_create(&solver, &setup, &error), RESULT_USAGE);
    assert_non_null(strstr(error.text, "did you mean 'split'"));
    params.algo = "split", params.variant = "bal";
    assert_int_equal(solver_create(&solver, &setup, &error), RESULT_USAGE);
    assert_non_null(strstr(error.text, "did you mean 'ball'"));
    solver_destroy(&solver);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ball_equals_its_double_precision_twin),
        cmocka_unit_test(thesis_equals_its_double_precision_twin),
        cmocka_unit_test(strands_through_memory_equal_the_twin_too),
        cmocka_unit_test(dragged_equals_the_reference_traces),
        cmocka_unit_test(thesis_equals_the_reference_traces),
        cmocka_unit_test(segment_lengths_do_not_drift_in_10000_steps),
        cmocka_unit_test(strings_that_turn_far_in_a_step_equal_the_twin),
        cmocka_unit_test(strands_that_point_against_their_style_keep_their_lengths),
        cmocka_unit_test(hanging_hair_stays_at_rest),
        cmocka_unit_test(the_tip_swings_like_a_pendulum),
        cmocka_unit_test(the_tip_is_a_damped_pendulum),
        cmocka_unit_test(strands_do_not_depend_on_each_other),
        cmocka_unit_test(turning_the_whole_scene_turns_the_result),
        cmocka_unit_test(no_finite_input_gives_a_nan),
        cmocka_unit_test(a_flung_tip_is_cut_and_counted),
        cmocka_unit_test(a_strand_beyond_the_drivers_loops_is_refused),
        cmocka_unit_test(unknown_solvers_and_variants_name_the_nearest),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
