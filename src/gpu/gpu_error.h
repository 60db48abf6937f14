// SPDX-License-Identifier: MIT
// GL errors, reported with the pass that caused them.
#pragma once

#include "base/error.h"

// Attributes a pending error to `pass`, a string constant, for the next gpu_check. The first error
// counts. GpuTimer's spans call it. Does not wait.
void gpu_error_note(const char *pass);

// Discards pending errors that this program did not cause.
void gpu_error_forget(void);

// RESULT_FAILED, naming `what` and, if noted, the pass, if a GL error has occurred since the last
// call (out of memory, ...). Does not wait.
Result gpu_check(const char *what, Error *error);
