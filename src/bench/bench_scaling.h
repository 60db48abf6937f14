// SPDX-License-Identifier: MIT
// How a step's time grows, and what starting costs.
#pragma once

#include "bench/bench_speed.h"

// The part "strands": 1,000 to 1,000,000 strands of 16; the part "vertices": 10,000 strands of 4 to
// 64. Ends with a row for each method with the exponent of least time by count.
Result scaling_run_strands(Speed *speed, Error *error);
Result scaling_run_vertices(Speed *speed, Error *error);

// The part "threads": 10k32 (or the hair that is asked for) with one and with two threads of Mesa's
// CPU driver (LP_NUM_THREADS), each in a process of its own, and the exponent. Not on other
// drivers.
Result scaling_run_threads(Speed *speed, Error *error);

// The part "start": processes that make one step of 1k16 (or the hair that is asked for): with an
// empty shader cache of Mesa ("cold") and with what that one left there ("warm"). first_ms is the
// first step with its compilation, process_ms the whole process.
Result scaling_run_start(Speed *speed, Error *error);
