// SPDX-License-Identifier: MIT
// SIGINT and SIGTERM as a flag that loops look at.
#pragma once

#include <stdbool.h>

// From now on the first SIGINT or SIGTERM only sets the flag, and gives both back their default
// action, so that a second one ends the program at once. SIGPIPE and SIGXFSZ are ignored: a closed
// pipe or a size limit is a failed write.
void interrupt_install(void);

// Whether one of them has come. False for ever if nothing is installed. Any thread may ask.
bool interrupt_requested(void);
