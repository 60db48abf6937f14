// SPDX-License-Identifier: MIT
#include "support/reference_traces.h"
#include "support/twin.h"

#include <jansson.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <string.h>

#include <cmocka.h>

static double number(const json_t *object, const char *name)
{
    return json_number_value(json_object_get(object, name));
}

static void read_vector(const json_t *array, Vec value)
{
    for (size_t k = 0; k < 3; ++k) value[k] = json_number_value(json_array_get(array, k));
}

static void read_positions(const json_t *array, int n, Vec *x)
{
    for (int j = 0; j < n; ++j) read_vector(json_array_get(array, (size_t)j), x[j]);
}

static void create(HairFixture *fixture, const json_t *trace, const Vec *start, const char *algo,
                   const char *variant)
{
    Vec wind;
    double stiffness = number(trace, "k_style");
    read_vector(json_object_get(trace, "wind"), wind);
    fixture_create(fixture, start, 1, (int)number(trace, "n"), algo, variant,
                   stiffness > 0 ? 0.5f : 0, (float)number(trace, "drag_c"));
    fixture->params.style_stiffness = (float)stiffness;
    fixture->step.dt = 1 / number(trace, "fps");
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 3; ++k) fixture->step.wind[i][k] = (float)wind[k];
}

static void compare_state(HairFixture *fixture, const json_t *state, int n, double length,
                          const char *what)
{
    Vec expected[TWIN_MAX], got[TWIN_MAX];
    read_positions(json_object_get(state, "positions"), n, expected);
    twin_read_strand(fixture, 0, got);
    double off = twin_rms((const Vec *)got, (const Vec *)expected, n, length);
    double allowed = 16 * fmax(number(state, "f32_rms_over_length"), 0x1p-23);
    if (!(off <= allowed)) fail_msg("%s: %.3g exceeds %.3g", what, off, allowed);
}

static void compare_trace(const json_t *trace, const char *algo, const char *variant,
                          void (*prepare)(HairFixture *fixture))
{
    const json_t *motion = json_object_get(trace, "root_motion");
    int n = (int)number(trace, "n");
    double fps = number(trace, "fps"), length = 0;
    Vec start[TWIN_MAX];
    TwinStrand rest;
    HairFixture fixture;
    read_positions(json_object_get(trace, "initial_positions"), n, start);
    twin_start(&rest, n, (const Vec *)start);
    for (int j = 1; j < n; ++j) length += rest.length[j];
    create(&fixture, trace, (const Vec *)start, algo, variant);
    if (prepare) prepare(&fixture);
    for (int i = 1; i <= 600; ++i) {
        char step[16], what[80];
        double turn = 6.283185307179586 * number(motion, "freq") * i / fps;
        fixture.step.head.translation[0] = (float)(number(motion, "amp") * (1 - cos(turn)));
        fixture_step(&fixture);
        snprintf(step, sizeof step, "%d", i);
        snprintf(what, sizeof what, "%s, trace %g, n = %d, step %d", algo, number(trace, "id"), n,
                 i);
        const json_t *state = json_object_get(json_object_get(trace, "steps"), step);
        if (state) compare_state(&fixture, state, n, length, what);
    }
    fixture_destroy(&fixture);
}

int traces_compare(const char *algorithm, const char *algo, const char *variant,
                   void (*prepare)(HairFixture *fixture))
{
    json_t *traces = json_load_file("tests/data/traces.json", 0, NULL), *trace;
    size_t i;
    int count = 0;
    assert_non_null(traces);
    json_array_foreach(json_object_get(traces, "cases"), i, trace)
    {
        if (strcmp(json_string_value(json_object_get(trace, "algorithm")), algorithm) != 0)
            continue;
        compare_trace(trace, algo, variant, prepare);
        ++count;
    }
    json_decref(traces);
    return count;
}

// Sets e^{-c' dt} = 1 - c dt, and scales forces so that they give the same velocity.
void traces_imitate_explicit_drag(HairFixture *fixture)
{
    double dt = fixture->step.dt, c = (double)fixture->params.drag;
    double other = -log1p(-c * dt) / dt, gain = -expm1(-other * dt) / other;
    fixture->params.drag = (float)other;
    for (int k = 0; k < 3; ++k) {
        fixture->step.gravity[k] *= (float)(dt / gain);
        for (int i = 0; i < 4; ++i) fixture->step.wind[i][k] *= (float)(c * dt / (other * gain));
    }
    fixture->step.first = false;
}
