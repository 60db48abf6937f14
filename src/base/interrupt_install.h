// SPDX-License-Identifier: MIT
// SIGINT, SIGTERM and SIGHUP as the flag of interrupt.h, and an end for programs that do not look
// at it: for programs alone, whose signals are their own.
#pragma once

// From now on the first SIGINT, SIGTERM or SIGHUP (unless that is ignored, as by nohup) only sets
// the flag, and gives all of them back their default action, so that a second one ends the program
// at once. If the calling thread does not ask for the flag within 0.3 s, or has asked and not ended
// 20 s later, temporary files and children are removed (leftovers.h) and the program ends with
// status 130. SIGPIPE and SIGXFSZ are ignored: a closed pipe or a size limit is a failed write.
void interrupt_install(void);
