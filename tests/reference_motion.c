// SPDX-License-Identifier: MIT
#include "reference_motion.h"

#include <jansson.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#define FOLDER "../shared/reference/dynamics/"

enum { FRAMES = 121, MOST = 32 };

static const char *const SCENARIOS[] = {
    "a_horizontal_n16_c0", "a_horizontal_n16_c1", "a_horizontal_n16_c4", "b_curly_n16_c0",
    "b_curly_n16_c1",      "b_curly_n16_c4",      "c_root2Hz_n16_c0",    "c_root2Hz_n16_c1",
    "c_root2Hz_n16_c4",    "d_wind_n16_c1",       "d_wind_n16_c4",       "a_horizontal_n32_c1",
    "bd_curly_wind_n16_c4"};

bool motion_available(void)
{
    if (access(FOLDER "a_horizontal_n16_c4.csv", R_OK) == 0) return true;
    printf("skipped: no reference motions in " FOLDER "\n");
    return false;
}

static void load_frames(const char *scenario, int n, double (*frames)[MOST][3])
{
    char path[256], *line = NULL;
    size_t size = 0;
    snprintf(path, sizeof path, FOLDER "%s.csv", scenario);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    assert_true(getline(&line, &size, file) > 0);
    for (int f = 0; f < FRAMES; ++f) {
        assert_true(getline(&line, &size, file) > 0);
        char *at = line;
        strtod(at, &at), strtod(++at, &at); // frame, time
        for (int j = 0; j < n; ++j)
            for (int k = 0; k < 3; ++k) frames[f][j][k] = strtod(++at, &at);
    }
    free(line);
    fclose(file);
}

static double number(const json_t *object, const char *name)
{
    return json_number_value(json_object_get(object, name));
}

static double square_distance(HairFixture *fixture, const double (*exact)[3], int n)
{
    float(*positions)[4] = fixture_positions(fixture, 0);
    double sum = 0;
    for (int j = 1; j < n; ++j)
        for (int k = 0; k < 3; ++k) {
            double r =
                (double)positions[hair_address(&fixture->hair.batches[0], 0, (uint32_t)j)][k] -
                exact[j][k];
            sum += r * r;
        }
    free(positions);
    return sum / (n - 1);
}

double motion_error(const char *scenario, const char *algo, const char *variant,
                    int steps_per_frame, void (*tune)(SectionParams *params))
{
    static double frames[FRAMES][MOST][3];
    char path[256];
    snprintf(path, sizeof path, FOLDER "%s.json", scenario);
    json_t *about = json_load_file(path, 0, NULL);
    assert_non_null(about);
    int n = (int)number(about, "n"), counted = 0;
    const json_t *motion = json_object_get(about, "root_motion");
    const json_t *floors = json_object_get(about, "float32_floor_rms_over_length_per_frame");
    double amplitude = number(motion, "amp"), frequency = number(motion, "freq"), sum = 0;
    HairFixture fixture;
    load_frames(scenario, n, frames);
    fixture_create(&fixture, (const double(*)[3])frames[0], 1, n, algo, variant, 0,
                   (float)number(about, "drag_c"));
    if (tune) tune(&fixture.params);
    fixture.step.dt = 1.0 / (60 * steps_per_frame);
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 3; ++k)
            fixture.step.wind[i][k] =
                (float)json_number_value(json_array_get(json_object_get(about, "wind"), (size_t)k));
    for (int f = 1; f < FRAMES; ++f) {
        for (int i = 1; i <= steps_per_frame; ++i) {
            double time = ((f - 1) * steps_per_frame + i) * fixture.step.dt;
            fixture.step.head.translation[0] =
                (float)(amplitude * (1 - cos(2 * 3.14159265358979 * frequency * time)));
            fixture_step(&fixture);
        }
        if (json_number_value(json_array_get(floors, (size_t)f)) > 1e-4) continue;
        sum += square_distance(&fixture, (const double(*)[3])frames[f], n);
        ++counted;
    }
    double error = sqrt(sum / counted) / number(about, "strand_length");
    json_decref(about);
    fixture_destroy(&fixture);
    return error;
}

double motion_mean_error(const char *algo, const char *variant, int steps_per_frame,
                         void (*tune)(SectionParams *params))
{
    enum { COUNT = sizeof SCENARIOS / sizeof *SCENARIOS };
    double sum = 0;
    for (int i = 0; i < COUNT; ++i)
        sum += log(motion_error(SCENARIOS[i], algo, variant, steps_per_frame, tune));
    double mean = exp(sum / COUNT);
    printf("%s %s at %d Hz: error %.3g of the length, geometric mean of %d scenarios\n", algo,
           variant, 60 * steps_per_frame, mean, COUNT);
    return mean;
}
