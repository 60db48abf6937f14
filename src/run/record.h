// SPDX-License-Identifier: MIT
// Records the scene of numbered files whose format can't store it (PFM, hair files): a small text
// file next to them, x_.pfm.scenes for x_%04d.pfm, with a line for each written file: the frame,
// its fingerprint and the CRC-32 of the file. The last line of a frame counts. Processes that share
// the frames append to the same record; invalid lines are ignored.
#pragma once

#include "base/target.h"
#include "run/fingerprint.h"

typedef struct RecordLine {
    char fingerprint[FINGERPRINT_BYTES]; // empty: the frame has no line
    uint32_t checksum;
} RecordLine;

typedef struct Record {
    RecordLine *lines; // [count], owned
    int count;
} Record;

// The record's file name, to be freed. NULL if the target has none (no number) or memory is short.
char *record_path(const Target *target);

// Appends the line of `frame`, whose file is complete. RESULT_FAILED with path and reason. Does
// nothing for a target without a number.
Result record_add(const Target *target, int frame, const char *fingerprint, Error *error);

// Reads the lines of frames 0 .. last; a missing record has no lines. RESULT_FAILED when memory is
// short. A zeroed struct may be destroyed.
Result record_read(Record *record, const Target *target, int last, Error *error);
void record_destroy(Record *record);

// RESULT_OK if the file `name` of the frame is the one recorded with this fingerprint; otherwise
// RESULT_FAILED with the name and the reason.
Result record_compare(const Record *record, int frame, const char *name, const char *fingerprint,
                      Error *why);
