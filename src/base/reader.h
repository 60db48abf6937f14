// SPDX-License-Identifier: MIT
// Reads bytes or words from the content of a file. Errors are sticky: after the first one, every
// function returns 0 and changes nothing, so a parser can check once after a series of reads. The
// message names the place: "FILE:LINE: ..." in text, "FILE: byte N: ..." in binary content.
//
// A reader has a budget of memory and of work, so that a small file cannot exhaust either: all
// memory of a parser comes from reader_malloc and its like (tests/project/check_budget), and loops
// that are not bounded by the file's bytes or by that memory call reader_work.
#pragma once

#include "base/bytes.h"
#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

typedef struct Reader {
    const char *path;    // for messages
    const uint8_t *data; // not owned; data[size] is 0
    size_t size;
    size_t at;         // next byte
    uint32_t line;     // text: of `at`, from 1; binary: 0
    bool continuation; // text: a backslash at the end of a line joins the next line (Wavefront OBJ)
    Result result;     // RESULT_OK until the first failure
    Error *error;
    uint64_t memory, placed, work; // what is left of the budget; see below
} Reader;

// `bytes` and `path` must outlive the reader.
Reader reader_begin_binary(const char *path, const Bytes *bytes, Error *error);
Reader reader_begin_text(const char *path, const Bytes *bytes, Error *error);

// Fails at the current place with RESULT_BAD_INPUT and a line (printf style, without the place);
// keeps an earlier error. Returns the reader's result.
Result reader_fail(Reader *reader, const char *format, ...) __attribute__((format(printf, 2, 3)));

// Fails with RESULT_FAILED: no memory.
Result reader_fail_memory(Reader *reader);

// --- The budget. The whole program may use 64 times the file's size plus 64 MiB; half of this is
// for the parser, the other half for what becomes of its output. Memory is not given back to the
// budget when it is freed.
enum { READER_MEMORY_TIMES = 32, READER_MEMORY_BYTES = 32 << 20 };
// In steps of about 1 ns: half a second, and 0.3 us for each byte.
enum { READER_WORK_TIMES = 300, READER_WORK_STEPS = 500000000 };
// Each byte beyond the first MiB allows more: transforms may make many frames of few bytes, and
// then need memory for these and time.
enum { READER_FREE_BYTES = 1 << 20, READER_PLACED_TIMES = 1024, READER_PLACED_STEPS = 20000 };

// Memory for `count` elements of `size` bytes, to be freed by free(); never NULL while the reader
// is well, also for 0 elements. Fails the reader, and returns NULL, if it is too much for a file of
// this size or if memory is short. reader_realloc counts only the growth, and keeps `block` if it
// fails.
void *reader_malloc(Reader *reader, uint64_t count, size_t size);
void *reader_calloc(Reader *reader, uint64_t count, size_t size);
void *reader_realloc(Reader *reader, void *block, uint64_t count, size_t size);

// Counts memory that other functions allocate for `count` elements of `size` bytes. False, and
// fails the reader, if it is too much.
bool reader_charge(Reader *reader, uint64_t count, uint64_t size);

// Memory for the positions of `vertices` vertices in each of `frames` frames, as reader_malloc, but
// with the larger limit.
void *reader_malloc_frames(Reader *reader, uint64_t frames, uint64_t vertices);

// Counts `count` times `steps` steps of work. False, and fails the reader, if it is too much.
bool reader_work(Reader *reader, uint64_t count, uint64_t steps);

// A reader for content that was unpacked from `outer`, which shares its budget; reader_end_inner
// gives it and the result back.
Reader reader_begin_inner(Reader *outer, const char *path, const Bytes *bytes);
void reader_end_inner(Reader *outer, const Reader *inner);

static inline bool reader_ok(const Reader *reader)
{
    return reader->result == RESULT_OK;
}

static inline size_t reader_left(const Reader *reader)
{
    return reader->size - reader->at;
}

// --- Binary, little-endian. `what` names the value in messages.
uint32_t reader_read_u32(Reader *reader, const char *what);
uint16_t reader_read_u16(Reader *reader, const char *what);
float reader_read_f32(Reader *reader, const char *what);

// Fails unless `count` elements of `stride` bytes from byte `start` on are within the file; safe
// against overflow. The error's place is the current one (the field that refers to the array).
// Returns whether they are.
bool reader_check_array(Reader *reader, uint64_t start, uint64_t count, uint64_t stride,
                        const char *what);

// Copies `count` floats from byte `start`, which the caller has checked.
void reader_copy_floats(const Reader *reader, uint64_t start, float *floats, size_t count);

// --- Text. Blanks are space, tab and carriage return; a word is anything between blanks.
bool reader_line_ended(Reader *reader); // skips blanks; at a newline or the file's end
bool reader_ended(Reader *reader);      // skips blanks and empty lines; at the file's end
void reader_next_line(Reader *reader);  // fails unless only blanks are left on this line
void reader_skip_line(Reader *reader);  // whatever is left on it
bool reader_take(Reader *reader,
                 const char *word); // steps over the next word of this line if it is `word`
void reader_expect(Reader *reader, const char *word); // ... and fails if it is not

// Copies the next word of this line and steps over it. False, without any change, if there is none
// or if it does not fit into `size` bytes with its zero.
bool reader_read_word(Reader *reader, char *word, size_t size);

// An integer from 0 to 2^32 - 1 on this line.
uint32_t reader_read_count(Reader *reader, const char *what);

// A decimal number on this line, correctly rounded to float32. Infinities and NaNs
// are accepted, also as printed by old Windows libraries (-1.#INF, 1.#QNAN, -1.#IND).
float reader_read_number(Reader *reader, const char *what);

// Fails with "expected WHAT, got 'the next word'", or got the end of the line or file.
Result reader_fail_expected(Reader *reader, const char *what);
