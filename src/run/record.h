// SPDX-License-Identifier: MIT
// Which scene the numbered files show whose format has no room for that (PFM, hair files): a small
// text file beside them, x_.pfm.scenes for x_%04d.pfm, with a line for each file that was written:
// the frame, its fingerprint and the CRC-32 of the file. Of a frame the last line counts. Processes
// that share the frames append to the same record; a line that they garble is no line.
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

// The record's name, to be freed. NULL if the target has none (no number) or memory is short.
char *record_path(const Target *target);

// Appends the line of `frame`, whose file is complete. RESULT_FAILED with path and reason.
// Nothing for a target without a number.
Result record_add(const Target *target, int frame, const char *fingerprint, Error *error);

// Reads the lines of frames 0 .. last; a record that is missing has none. RESULT_FAILED when memory
// is short. A zeroed struct may be destroyed.
Result record_read(Record *record, const Target *target, int last, Error *error);
void record_destroy(Record *record);

// Whether the file `name` of the frame is the one that was recorded with this fingerprint.
// RESULT_FAILED with the name and why it is not.
Result record_compare(const Record *record, int frame, const char *name, const char *fingerprint,
                      Error *why);
