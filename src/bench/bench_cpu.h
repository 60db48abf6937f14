// SPDX-License-Identifier: MIT
// What the processor could do: the memory's bandwidth, and a step of split in plain C.
#pragma once

#include "bench/bench_speed.h"

// The part "memory": bytes a second of a[i] = b[i] + s c[i] over arrays far larger than caches, on
// all processors, the best of some runs; three arrays count once each. Sets speed->bandwidth.
Result cpu_run_memory(Speed *speed, Error *error);

// The part "c": cpu_split.h on each set of hair whose strands have one vertex count, scalar and
// vectorised, on one thread and on two, with its distance from the GPU's strands after a second
// (RMS over the length; stated: 1e-4).
Result cpu_run_split(Speed *speed, Error *error);
