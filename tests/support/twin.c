// SPDX-License-Identifier: MIT
#include "support/twin.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

double vec_dot(const Vec a, const Vec b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

double vec_norm(const Vec a)
{
    return sqrt(vec_dot(a, a));
}

void vec_copy(const Vec a, Vec r)
{
    memcpy(r, a, sizeof(Vec));
}

void vec_add_scaled(const Vec a, double s, const Vec b, Vec r)
{
    for (int k = 0; k < 3; ++k) r[k] = a[k] + s * b[k];
}

void twin_start(TwinStrand *strand, int n, const Vec *positions)
{
    *strand = (TwinStrand){.n = n};
    memcpy(strand->x, positions, (size_t)n * sizeof *positions);
    memcpy(strand->style, positions, (size_t)n * sizeof *positions);
    for (int j = 1; j < n; ++j) {
        Vec r;
        vec_add_scaled(positions[j], -1, positions[j - 1], r);
        strand->length[j] = vec_norm(r);
    }
}

static void cross(const Vec a, const Vec b, Vec r)
{
    for (int k = 0; k < 3; ++k)
        r[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

void twin_style(const TwinStrand *strand, const HeadPose *head, int j, Vec r)
{
    const double w = (double)head->rotation[3];
    Vec q, once, twice;
    for (int k = 0; k < 3; ++k) q[k] = (double)head->rotation[k];
    cross(q, strand->style[j], once);
    cross(q, once, twice);
    for (int k = 0; k < 3; ++k)
        r[k] = strand->style[j][k] + 2 * (w * once[k] + twice[k]) + (double)head->translation[k];
}

void twin_kick(Vec v, const TwinStep *step, double h)
{
    double c = step->drag, decay = exp(-c * h), gain = c > 0 ? -expm1(-c * h) / c : h;
    for (int k = 0; k < 3; ++k) v[k] = v[k] * decay + (step->gravity[k] + c * step->wind[k]) * gain;
}

void twin_pull_to_style(TwinStrand *strand, const TwinStep *step, double h, double acts,
                        const SectionParams *params)
{
    double c = step->drag, gain = c > 0 ? -expm1(-c * acts) / c : acts;
    double w = (double)params->style_stiffness * (double)params->style /
               (1 - (double)params->style) * h * gain;
    Vec root;
    twin_style(strand, &step->head, 0, root);
    for (int j = 1; j < strand->n; ++j) {
        Vec style;
        twin_style(strand, &step->head, j, style);
        for (int k = 0; k < 3; ++k)
            strand->x[j][k] =
                (strand->x[j][k] + w * (strand->x[0][k] + style[k] - root[k])) / (1 + w);
    }
}

void twin_rebuild(const TwinStrand *strand, Vec *positions)
{
    vec_copy(strand->x[0], positions[0]);
    for (int j = 1; j < strand->n; ++j) {
        Vec r;
        vec_add_scaled(strand->x[j], -1, strand->x[j - 1], r);
        vec_add_scaled(positions[j - 1], strand->length[j] / vec_norm(r), r, positions[j]);
    }
}

static void place_on_curl(Vec at, double x, double turns, double u)
{
    double angle = 6.283185307 * turns * u;
    at[0] = (double)(float)(x + 0.2 * u);
    at[1] = (double)(float)(0.02 * u * cos(angle) + 0.05 * u * u);
    at[2] = (double)(float)(0.02 * u * sin(angle));
}

void twin_make_curl(Vec *q, int n, double x, double turns)
{
    for (int j = 0; j < n; ++j) place_on_curl(q[j], x, turns, (double)j / (n - 1));
}

void twin_make_uneven_curl(Vec *q, int n, double x, double turns)
{
    for (int j = 0; j < n; ++j)
        place_on_curl(q[j], x, turns, (2 * j + j % 2) / (double)(2 * (n - 1) + (n - 1) % 2));
}

void twin_put(HairFixture *fixture, const TwinStrand *twins, int count)
{
    SolverBuffer buffers[SOLVER_MAX_BUFFERS];
    const HairBatch *batch = &fixture->hair.batches[0];
    solver_pose(&fixture->solver,
                &fixture->step.head); // otherwise the first pose would write the style
    assert_true(solver_buffers(&fixture->solver, 0, buffers) >= 2);
    assert_true(buffers[0].kind == SOLVER_POINTS && buffers[1].kind == SOLVER_VELOCITIES);
    for (int i = 0; i < 2; ++i) {
        const GpuBuffer *buffer = buffers[i].buffer;
        float(*values)[4] = gpu_buffer_read(buffer);
        assert_non_null(values);
        for (int s = 0; s < count; ++s)
            for (int j = 0; j < twins[s].n; ++j) {
                const double *from = i ? twins[s].v[j] : twins[s].x[j];
                float *to = values[hair_address(batch, (uint32_t)s, (uint32_t)j)];
                for (int k = 0; k < 3; ++k) to[k] = (float)from[k];
            }
        glBindBuffer(GL_COPY_WRITE_BUFFER, buffer->buffer);
        glBufferSubData(GL_COPY_WRITE_BUFFER, 0, (GLsizeiptr)buffer->size, values);
        free(values);
    }
}

void twin_read_strand(HairFixture *fixture, int s, Vec *q)
{
    const HairBatch *batch = &fixture->hair.batches[0];
    float(*positions)[4] = fixture_positions(fixture, 0);
    for (uint32_t j = 0; j < batch->vertex_count; ++j)
        for (int k = 0; k < 3; ++k)
            q[j][k] = (double)positions[hair_address(batch, (uint32_t)s, j)][k];
    free(positions);
}

double twin_rms(const Vec *a, const Vec *b, int n, double length)
{
    double sum = 0;
    for (int j = 1; j < n; ++j)
        for (int k = 0; k < 3; ++k) sum += (a[j][k] - b[j][k]) * (a[j][k] - b[j][k]);
    return sqrt(sum / (n - 1)) / length;
}

double twin_length_error(const TwinStrand *rest, const Vec *q)
{
    double worst = 0;
    for (int j = 1; j < rest->n; ++j) {
        Vec r;
        vec_add_scaled(q[j], -1, q[j - 1], r);
        worst = fmax(worst, fabs(vec_norm(r) / rest->length[j] - 1));
    }
    return worst;
}

enum { CURLS = 5 };

static void move_head(HeadPose *head, double time)
{
    double turn = 0.1 * sin(6.283185307 * 2 * time); // half the angle
    head->translation[0] = (float)(0.02 * (1 - cos(6.283185307 * 2 * time)));
    head->rotation[2] = (float)sin(turn);
    head->rotation[3] = (float)cos(turn);
}

static TwinStep twin_step(const HairFixture *fixture)
{
    TwinStep step = {.dt = fixture->step.dt,
                     .drag = (double)fixture->params.drag,
                     .first = fixture->step.first,
                     .head_old = fixture->step.head_old,
                     .head = fixture->step.head};
    for (int k = 0; k < 3; ++k) {
        step.gravity[k] = (double)fixture->step.gravity[k];
        step.wind[k] = (double)fixture->step.wind[0][k];
    }
    return step;
}

// The largest distance of a drawn strand from its twin.
static double find_distance(HairFixture *fixture, const TwinPair *pair, const TwinStrand *twins)
{
    const bool rebuilt = pair->rebuilt && !fixture->params.stretch_drawn;
    double worst = 0;
    for (int s = 0; s < CURLS; ++s) {
        const TwinStrand *twin = &twins[s];
        Vec drawn[TWIN_MAX], exact[TWIN_MAX];
        double length = 0;
        for (int j = 1; j < twin->n; ++j) length += twin->length[j];
        twin_read_strand(fixture, s, drawn);
        twin_rebuild(twin, exact);
        double off = twin_rms((const Vec *)drawn,
                              rebuilt ? (const Vec *)exact : (const Vec *)twin->x, twin->n, length);
        worst = off > worst || isnan(off) ? off : worst;
    }
    return worst;
}

// The largest distance after the case's steps.
static double run_case(const TwinPair *pair, const TwinCase *trial, bool uneven)
{
    static Vec start[CURLS * TWIN_MAX];
    static TwinStrand twins[CURLS];
    const int n = trial->n;
    HairFixture fixture;
    for (int s = 0; s < CURLS; ++s) {
        (uneven ? twin_make_uneven_curl : twin_make_curl)(&start[s * n], n, 0.01 * s, 1 + s);
        twin_start(&twins[s], n, (const Vec *)&start[s * n]);
    }
    fixture_create_tuned(&fixture, (const Vec *)start, CURLS, n, pair->algo, pair->variant,
                         (float)trial->style, (float)trial->drag, trial->tune);
    fixture.step.dt = 1 / trial->per_second;
    for (int i = 0; i < 4; ++i) fixture.step.wind[i][0] = 1.5f, fixture.step.wind[i][2] = 0.5f;
    for (int i = 1; i <= trial->steps; ++i) {
        move_head(&fixture.step.head, i * fixture.step.dt);
        TwinStep step = twin_step(&fixture);
        fixture_step(&fixture);
        for (int s = 0; s < CURLS; ++s) pair->twin(&twins[s], &step, &fixture.params);
    }
    double worst = find_distance(&fixture, pair, twins);
    fixture_destroy(&fixture);
    return worst;
}

static void require(const TwinPair *pair, const TwinCase *cases, int count, bool uneven)
{
    for (int i = 0; i < count; ++i) {
        const TwinCase *trial = &cases[i];
        double off = run_case(pair, trial, uneven);
        printf("%s %s, n = %d, %g steps a second: RMS %.2g of the length from the double-precision "
               "twin after %d steps%s\n",
               pair->algo, pair->variant, trial->n, trial->per_second, off, trial->steps,
               uneven ? ", uneven" : "");
        double limit = fixture_rounding() * trial->tolerance;
        if (!(off < limit)) fail_msg("case %d: %.3g exceeds %.3g", i, off, limit);
    }
}

void twin_require(const TwinPair *pair, const TwinCase *cases, int count)
{
    require(pair, cases, count, false);
}

void twin_require_uneven(const TwinPair *pair, const TwinCase *cases, int count)
{
    require(pair, cases, count, true);
}
