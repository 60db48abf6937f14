// SPDX-License-Identifier: MIT
// The check of a host's context names each kind of state that drawing relies on if it is not the
// default, and the check changes nothing.
#include "gpu/gl_defaults.h"
#include "support/hair_fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void finds(const char *what)
{
    Error error;
    assert_int_equal(gl_defaults_check(&error), RESULT_USAGE);
    if (!strstr(error.text, what)) fail_msg("'%s' does not name %s", error.text, what);
}

static void well(void)
{
    Error error = {""};
    if (gl_defaults_check(&error) != RESULT_OK) fail_msg("%s", error.text);
    assert_int_equal(glGetError(), GL_NO_ERROR);
}

static void a_new_context_has_the_defaults(void **state)
{
    (void)state;
    fixture_gpu();
    well();
}

static void states_that_differ_are_named(void **state)
{
    (void)state;
    fixture_gpu();
    glEnable(GL_BLEND);
    finds("GL_BLEND is 0x1: expected 0x0");
    assert_true(glIsEnabled(GL_BLEND));
    glDisable(GL_BLEND);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    finds("GL_PACK_ALIGNMENT is 0x1: expected 0x4");
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glDepthFunc(GL_LEQUAL);
    finds("GL_DEPTH_FUNC");
    glDepthFunc(GL_LESS);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_FALSE);
    finds("GL_COLOR_WRITEMASK is 1 1 1 0");
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
    finds("GL_POLYGON_MODE");
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    well();
}

static void samplers_are_named_with_their_unit(void **state)
{
    GLuint sampler;
    GLint active = 0;
    (void)state;
    fixture_gpu();
    glGenSamplers(1, &sampler);
    glBindSampler(3, sampler);
    glActiveTexture(GL_TEXTURE2);
    finds("texture unit 3 has sampler");
    glGetIntegerv(GL_ACTIVE_TEXTURE, &active);
    assert_int_equal(active, GL_TEXTURE2);
    glActiveTexture(GL_TEXTURE0);
    glDeleteSamplers(1, &sampler);
    well();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_new_context_has_the_defaults),
        cmocka_unit_test(states_that_differ_are_named),
        cmocka_unit_test(samplers_are_named_with_their_unit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
