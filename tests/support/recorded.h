// SPDX-License-Identifier: MIT
// Recorded values: many small cases through the code that the programs run, each reduced to a list
// of numbers, and compared with the numbers of a file. A fault that changes any of them is noticed,
// whether or not somebody has thought of it. scripts/update-recorded records anew.
#pragma once

#include "run/images.h"

// The cases are the lines of tests/data/recorded/SET.txt: a name, then the arguments of
// tractrix-render. Their numbers are those of tests/data/recorded/SET.values: a name and the
// driver's numbers in each line.
typedef struct RecordedCase {
    const char *name;
    Scene scene; // from the arguments
    Assets assets;
    Framing framing;
    Simulation simulation; // at frame 0, settled and posed
    GpuTimer timer;
    const Gpu *gpu;
} RecordedCase;

typedef struct RecordedNumbers {
    float *value; // [count], owned
    size_t count, room;
} RecordedNumbers;

void recorded_add(RecordedNumbers *numbers, float value);

// The largest difference that counts as equal: `relative` times the recorded number, plus
// `absolute` times the root mean square of the case's numbers. The first pair is for the driver
// that recorded the numbers, on any processor; the second for other drivers.
typedef struct RecordedLimits {
    float relative, absolute;
    float other_relative, other_absolute;
} RecordedLimits;

// Calls `reduce` for each case of the set and compares. The test fails if any case differs, after
// all of them have run; each is named with its largest difference in units of its limit.
// Environment: RECORD writes the numbers instead; RECORD_ONLY: only cases with this in their name;
// RECORD_SHARES prints the largest difference and the time of every case.
void recorded_check(const char *set, const RecordedLimits *limits,
                    void (*reduce)(RecordedCase *recorded, RecordedNumbers *numbers));
