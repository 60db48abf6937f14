// SPDX-License-Identifier: MIT
#include "support/reference_motion.h"
#include "support/hair_fixture.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define FOLDER "tests/data/motion"

double reference_error(const char *scenario, const char *algo, const char *variant,
                       int steps_per_frame, void (*tune)(SectionParams *params))
{
    Error error = {{0}};
    Motion motion;
    SectionParams params;
    double off = NAN;
    if (trial_read_motion(&motion, FOLDER, scenario, &error) != RESULT_OK)
        fail_msg("%s", error.text);
    assert_int_equal(params_create_section(&params, &error), RESULT_OK);
    assert_int_equal(params_parse(params_find("algo"), &params, algo, &error), RESULT_OK);
    assert_int_equal(params_parse(params_find("variant"), &params, variant, &error), RESULT_OK);
    params.style = 0;
    if (tune) tune(&params);
    if (trial_error(&off, fixture_gpu(), &motion, &params, 60.0 * steps_per_frame, &error) !=
        RESULT_OK)
        fail_msg("%s", error.text);
    params_destroy_section(&params);
    trial_destroy_motion(&motion);
    return off;
}

double reference_mean_error(const char *algo, const char *variant, int steps_per_frame,
                            void (*tune)(SectionParams *params))
{
    MotionFolder folder;
    double sum = 0;
    assert_int_equal(trial_read_folder(&folder, FOLDER, NULL), RESULT_OK);
    assert_int_equal(folder.count, 13);
    for (size_t i = 0; i < folder.count; ++i)
        sum += log(reference_error(folder.motions[i].name, algo, variant, steps_per_frame, tune));
    size_t count = folder.count;
    trial_destroy_folder(&folder);
    double mean = exp(sum / (double)count);
    printf("%s %s at %d Hz: error %.3g of the length, geometric mean of %zu scenarios\n", algo,
           variant, 60 * steps_per_frame, mean, count);
    return mean;
}
