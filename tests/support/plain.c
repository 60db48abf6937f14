// SPDX-License-Identifier: MIT
#include "support/plain.h"
#include "support/needed.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

void plain_section(SectionParams *params)
{
    const Presets plain = {.look = "plain"};
    NEEDED(params_create_section(params, error));
    NEEDED(scene_apply_presets(&plain, SCOPE_SECTION, params, error));
}
