// SPDX-License-Identifier: MIT
// GL errors, told with the pass that made them.
#pragma once

#include "base/error.h"

// Takes an error that is pending as that of `pass`, a string constant, for the next gpu_check. The
// first one counts. GpuTimer's spans call it. Waits for nothing.
void gpu_error_note(const char *pass);

// Drops what is pending: it was not this program's.
void gpu_error_forget(void);

// RESULT_FAILED naming `what`, and the pass if it was noted, if a GL error has come up since the
// last call (out of memory, ...). Waits for nothing.
Result gpu_check(const char *what, Error *error);
