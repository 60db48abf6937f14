// SPDX-License-Identifier: MIT
// Runs a call whose last argument is `error`; the test fails with its message.
#pragma once

#include "base/error.h"

#define NEEDED(call)                                                                               \
    do {                                                                                           \
        Error error_ = {{0}};                                                                      \
        Error *error = &error_;                                                                    \
        if ((call) != RESULT_OK) fail_msg("%s", error_.text);                                      \
    } while (0)
