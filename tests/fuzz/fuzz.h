// SPDX-License-Identifier: MIT
// Fuzz targets: what the program reads from others, each as a function of bytes. A target calls
// one reader and holds its promises against what came out; fuzz_claim ends the process where one is
// broken. The fuzzer (engine.c) and the tests (test_fuzz_corpora.c) run the same targets.
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

// NULL: there is none of this name.
const FuzzTarget *fuzz_find(const char *name);

// Runs a target on a copy of the bytes with a zero behind it, in an empty folder of its own.
void fuzz_run(const FuzzTarget *target, const uint8_t *data, size_t size);

// Ends the process with the message (printf style) unless `holds`.
void fuzz_claim(bool holds, const char *format, ...) __attribute__((format(printf, 2, 3)));

// An error is one line of printable text that says something.
void fuzz_claim_error(Result result, const Error *error);

// Writes the bytes to a file of this name in the target's folder and gives its path.
const char *fuzz_file(const char *name, const Bytes *bytes);

// A path in the target's folder. The last four results stay valid.
const char *fuzz_path(const char *name);

// --- Checksums that a mutation breaks are made right, or little would get past them. In place.
void fuzz_repair_png(Bytes *bytes);
void fuzz_repair_zip(Bytes *bytes);    // of stored members
void fuzz_repair_chunks(Bytes *bytes); // chunk.h
