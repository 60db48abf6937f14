// SPDX-License-Identifier: MIT
#include "support/head_formulas.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

static void set(Track *track, const TrackRange *range, const char *const texts[3])
{
    for (uint32_t i = 0; i < 3; ++i)
        assert_int_equal(track_set_formula(track, i, texts[i], range, NULL), RESULT_OK);
}

void head_set_translation(RigidTrack *head, const char *x, const char *y, const char *z)
{
    set(&head->translation, &RIGID_TRACK_METRES, (const char *const[]){x, y, z});
}

void head_set_rotation(RigidTrack *head, const char *x, const char *y, const char *z)
{
    set(&head->rotation, &RIGID_TRACK_DEGREES, (const char *const[]){x, y, z});
}
