// SPDX-License-Identifier: MIT
// Fuzz targets: each reads data of others from bytes by one reader and checks the result against
// the reader's promises; fuzz_claim ends the process if one is broken. The fuzzer (engine.c) and
// the tests (test_fuzz_corpora.c) run the same targets.
#pragma once

#include "base/bytes.h"
#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct FuzzTarget {
    const char *name;
    void (*run)(const Bytes *bytes, int number);
    int number;
} FuzzTarget;

extern const FuzzTarget FUZZ_TARGETS[];
extern const size_t FUZZ_TARGET_COUNT;

// NULL: no target has this name.
const FuzzTarget *fuzz_find(const char *name);

// Runs a target on a zero-terminated copy of the bytes, in an empty folder.
void fuzz_run(const FuzzTarget *target, const uint8_t *data, size_t size);

// Ends the process with the message (printf style) unless `holds`.
void fuzz_claim(bool holds, const char *format, ...) __attribute__((format(printf, 2, 3)));

// Checks that an error is one line of printable text and not empty.
void fuzz_claim_error(Result result, const Error *error);

// Writes the bytes to a file in the target's folder and returns its path.
const char *fuzz_file(const char *name, const Bytes *bytes);

// A path in the target's folder. The last four results stay valid.
const char *fuzz_path(const char *name);

// --- Correct the checksums in place that a mutation breaks; otherwise readers would reject almost
// all mutations.
void fuzz_repair_png(Bytes *bytes);
void fuzz_repair_zip(Bytes *bytes);    // with stored members
void fuzz_repair_chunks(Bytes *bytes); // chunk.h
