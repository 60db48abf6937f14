// SPDX-License-Identifier: MIT
// Lets SIGINT, SIGTERM and SIGHUP set the flag of interrupt.h, and ends programs that do not test
// it. Only for programs, which own their signals.
#pragma once

// From now on the first SIGINT, SIGTERM or SIGHUP (unless ignored, as by nohup) only sets the flag
// and restores the default actions, so that a second signal ends the program at once. If the
// calling thread does not test the flag within 0.3 s, or has tested it and not ended 20 s later,
// temporary files and children are removed (leftovers.h) and the program ends with status 130.
// SIGPIPE and SIGXFSZ are ignored, so that a closed pipe or a size limit appears as a failed write.
void interrupt_install(void);
