// SPDX-License-Identifier: MIT
#include "base/reader.h"

#include <endian.h>
#include <malloc.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

Reader reader_begin_binary(const char *path, const Bytes *bytes, Error *error)
{
    const uint64_t size = bytes->size;
    const uint64_t more = size > READER_FREE_BYTES ? size - READER_FREE_BYTES : 0;
    return (Reader){.path = path,
                    .data = bytes->data,
                    .size = bytes->size,
                    .error = error,
                    .memory = READER_MEMORY_TIMES * size + READER_MEMORY_BYTES,
                    .placed = READER_PLACED_TIMES * more,
                    .work =
                        READER_WORK_STEPS + READER_WORK_TIMES * size + READER_PLACED_STEPS * more};
}

Reader reader_begin_text(const char *path, const Bytes *bytes, Error *error)
{
    Reader reader = reader_begin_binary(path, bytes, error);
    reader.line = 1;
    return reader;
}

Result reader_fail(Reader *reader, const char *format, ...)
{
    if (!reader_ok(reader)) return reader->result;
    char text[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    reader->result = RESULT_BAD_INPUT;
    if (reader->line)
        return error_set(reader->error, RESULT_BAD_INPUT, "%s:%u: %s", reader->path, reader->line,
                         text);
    return error_set(reader->error, RESULT_BAD_INPUT, "%s: byte %zu: %s", reader->path, reader->at,
                     text);
}

Result reader_fail_memory(Reader *reader)
{
    if (reader_ok(reader))
        reader->result = error_set(reader->error, RESULT_FAILED, "%s: no memory", reader->path);
    return reader->result;
}

// --- The budget.

static void fail_budget(Reader *reader, uint64_t times, int bytes)
{
    reader_fail(reader,
                "needs more memory than a file of this size may use: expected at most %llu times "
                "its size and %d MiB",
                (unsigned long long)times, bytes >> 20);
}

// The product in bytes; UINT64_MAX if it is larger.
static uint64_t multiply(uint64_t count, uint64_t size)
{
    uint64_t bytes;
    return __builtin_mul_overflow(count, size, &bytes) ? UINT64_MAX : bytes;
}

bool reader_charge(Reader *reader, uint64_t count, uint64_t size)
{
    uint64_t bytes = multiply(count, size);
    if (!reader_ok(reader)) return false;
    if (bytes > reader->memory) {
        fail_budget(reader, READER_MEMORY_TIMES, READER_MEMORY_BYTES);
        return false;
    }
    reader->memory -= bytes;
    return true;
}

// malloc's own bytes for each block; they count where blocks are many and small.
enum { BLOCK_BYTES = 16 };

static void *check(Reader *reader, void *block)
{
    if (!block) reader_fail_memory(reader);
    return block;
}

void *reader_malloc(Reader *reader, uint64_t count, size_t size)
{
    if (!reader_charge(reader, 1, BLOCK_BYTES) || !reader_charge(reader, count, size)) return NULL;
    return check(reader, malloc(count * size + 1));
}

void *reader_calloc(Reader *reader, uint64_t count, size_t size)
{
    if (!reader_charge(reader, 1, BLOCK_BYTES) || !reader_charge(reader, count, size)) return NULL;
    return check(reader, calloc(count * size + 1, 1));
}

void *reader_realloc(Reader *reader, void *block, uint64_t count, size_t size)
{
    uint64_t bytes = multiply(count, size), before = block ? malloc_usable_size(block) : 0;
    if (!reader_charge(reader, 1, bytes > before ? bytes - before : 0) ||
        (!block && !reader_charge(reader, 1, BLOCK_BYTES)))
        return NULL;
    return check(reader, realloc(block, bytes + 1));
}

void *reader_malloc_frames(Reader *reader, uint64_t frames, uint64_t vertices)
{
    const uint64_t bytes = multiply(multiply(frames, vertices), 3 * sizeof(float));
    if (!reader_ok(reader)) return NULL;
    uint64_t placed = bytes < reader->placed ? bytes : reader->placed;
    if (bytes - placed > reader->memory) {
        reader_fail(reader,
                    "%llu frames of %llu vertices need %llu MB: more than a file of this size may "
                    "use",
                    (unsigned long long)frames, (unsigned long long)vertices,
                    (unsigned long long)(bytes / 1000000));
        return NULL;
    }
    reader->placed -= placed;
    reader->memory -= bytes - placed;
    return check(reader, malloc(bytes + 1));
}

bool reader_work(Reader *reader, uint64_t count, uint64_t steps)
{
    uint64_t all = multiply(count, steps);
    if (!reader_ok(reader)) return false;
    if (all > reader->work) {
        reader_fail(reader, "takes more time than a file of this size may take");
        return false;
    }
    reader->work -= all;
    return true;
}

Reader reader_begin_inner(Reader *outer, const char *path, const Bytes *bytes)
{
    Reader inner = reader_begin_binary(path, bytes, outer->error);
    inner.result = outer->result;
    inner.memory = outer->memory;
    inner.placed = outer->placed;
    inner.work = outer->work;
    return inner;
}

void reader_end_inner(Reader *outer, const Reader *inner)
{
    outer->result = inner->result;
    outer->memory = inner->memory;
    outer->placed = inner->placed;
    outer->work = inner->work;
}

// --- Binary.

// The next `size` bytes, or NULL after an error.
static const uint8_t *take_bytes(Reader *reader, size_t size, const char *what)
{
    if (!reader_ok(reader)) return NULL;
    if (reader_left(reader) < size) {
        reader_fail(reader, "%s needs %zu bytes, but only %zu are left in the file", what, size,
                    reader_left(reader));
        return NULL;
    }
    const uint8_t *bytes = reader->data + reader->at;
    reader->at += size;
    return bytes;
}

uint32_t reader_read_u32(Reader *reader, const char *what)
{
    const uint8_t *bytes = take_bytes(reader, 4, what);
    uint32_t value = 0;
    if (bytes) memcpy(&value, bytes, 4);
    return le32toh(value);
}

uint16_t reader_read_u16(Reader *reader, const char *what)
{
    const uint8_t *bytes = take_bytes(reader, 2, what);
    uint16_t value = 0;
    if (bytes) memcpy(&value, bytes, 2);
    return le16toh(value);
}

float reader_read_f32(Reader *reader, const char *what)
{
    uint32_t bits = reader_read_u32(reader, what);
    float value;
    memcpy(&value, &bits, 4);
    return value;
}

bool reader_check_array(Reader *reader, uint64_t start, uint64_t count, uint64_t stride,
                        const char *what)
{
    if (!reader_ok(reader)) return false;
    uint64_t room = start <= reader->size ? reader->size - start : 0;
    if (start <= reader->size && count <= room / stride) return true;
    if (start > reader->size)
        reader_fail(reader, "%s start at byte %llu, but the file ends at byte %zu", what,
                    (unsigned long long)start, reader->size);
    else
        reader_fail(
            reader,
            "%s need %llu times %llu bytes from byte %llu on, but the file has only %llu there",
            what, (unsigned long long)count, (unsigned long long)stride, (unsigned long long)start,
            (unsigned long long)room);
    return false;
}

void reader_copy_floats(const Reader *reader, uint64_t start, float *floats, size_t count)
{
    const uint8_t *from = reader->data + start;
    for (size_t i = 0; i < count; i++) {
        uint32_t bits;
        memcpy(&bits, from + 4 * i, 4);
        bits = le32toh(bits);
        memcpy(floats + i, &bits, 4);
    }
}

// --- Text.

static bool is_blank(uint8_t c)
{
    return c == ' ' || c == '\t' || c == '\r';
}

// The length of a backslash and the newline after it, or 0.
static size_t measure_continuation(const Reader *reader)
{
    const uint8_t *p = reader->data + reader->at; // zero-terminated: reading two ahead is legal
    if (!reader->continuation || p[0] != '\\') return 0;
    if (p[1] == '\n') return 2;
    return p[1] == '\r' && p[2] == '\n' ? 3 : 0;
}

static void skip_blanks(Reader *reader)
{
    for (;;) {
        while (is_blank(reader->data[reader->at])) reader->at++;
        size_t joined = measure_continuation(reader);
        if (!joined) return;
        reader->at += joined;
        reader->line++;
    }
}

bool reader_line_ended(Reader *reader)
{
    if (!reader_ok(reader)) return true;
    skip_blanks(reader);
    return reader->at >= reader->size || reader->data[reader->at] == '\n';
}

bool reader_ended(Reader *reader)
{
    while (reader_ok(reader) && reader_line_ended(reader) && reader->at < reader->size) {
        reader->at++;
        reader->line++;
    }
    return !reader_ok(reader) || reader->at >= reader->size;
}

void reader_next_line(Reader *reader)
{
    if (!reader_ok(reader)) return;
    if (!reader_line_ended(reader)) {
        reader_fail_expected(reader, "the end of the line");
        return;
    }
    reader_ended(reader);
}

void reader_skip_line(Reader *reader)
{
    if (!reader_ok(reader)) return;
    while (reader->at < reader->size && reader->data[reader->at] != '\n') {
        size_t joined = measure_continuation(reader);
        if (joined) reader->line++;
        reader->at += joined ? joined : 1;
    }
    reader_next_line(reader);
}

// The length of the word at the reader's place; 0 at the end of the line.
static size_t measure_word(Reader *reader)
{
    if (reader_line_ended(reader)) return 0;
    size_t end = reader->at;
    while (end < reader->size && !is_blank(reader->data[end]) && reader->data[end] != '\n') end++;
    return end - reader->at;
}

bool reader_take(Reader *reader, const char *word)
{
    size_t length = measure_word(reader);
    if (length == 0 || length != strlen(word)) return false;
    if (memcmp(reader->data + reader->at, word, length) != 0) return false;
    reader->at += length;
    return true;
}

bool reader_read_word(Reader *reader, char *word, size_t size)
{
    size_t length = measure_word(reader);
    if (length == 0 || length >= size) return false;
    memcpy(word, reader->data + reader->at, length);
    word[length] = 0;
    reader->at += length;
    return true;
}

void reader_expect(Reader *reader, const char *word)
{
    if (reader_ok(reader) && !reader_take(reader, word)) reader_fail_expected(reader, word);
}

Result reader_fail_expected(Reader *reader, const char *what)
{
    size_t length = measure_word(reader);
    if (length == 0)
        return reader_fail(reader, "expected %s, got the end of the %s", what,
                           reader->at >= reader->size ? "file" : "line");
    char word[33] = "";
    for (size_t i = 0; i < length && i < sizeof word - 1; i++) {
        uint8_t c = reader->data[reader->at + i];
        word[i] = c ? (char)c : '?'; // the message quotes other control characters
    }
    return reader_fail(reader, "expected %s, got '%s'%s", what, word,
                       length >= sizeof word ? "..." : "");
}

uint32_t reader_read_count(Reader *reader, const char *what)
{
    size_t length = measure_word(reader);
    uint64_t value = 0;
    bool good = length > 0;
    for (size_t i = 0; i < length && good; i++) {
        uint8_t c = reader->data[reader->at + i];
        value = value * 10 + (c - '0');
        good = c >= '0' && c <= '9' && value <= UINT32_MAX;
    }
    if (!good) {
        if (reader_ok(reader)) reader_fail_expected(reader, what);
        return 0;
    }
    reader->at += length;
    return (uint32_t)value;
}

// A parsed decimal number: (-1)^negative * digits * 10^exponent.
typedef struct Decimal {
    uint64_t digits; // the first 19 significant digits
    int exponent;
    // `cut` is set if there were more than 19 digits.
    bool negative, cut;
} Decimal;

static const uint8_t *scan_digits(const uint8_t *p, Decimal *decimal, bool fraction)
{
    for (; *p >= '0' && *p <= '9'; p++) {
        if (decimal->digits < 1000000000000000000u) {
            decimal->digits = decimal->digits * 10 + (*p - '0');
            decimal->exponent -= fraction;
        } else {
            decimal->cut = true;
            decimal->exponent += !fraction;
        }
    }
    return p;
}

// Parses the number at `p` and returns the byte after it, or `p` if there is none. The text must
// end with a byte that cannot be part of a number.
static const uint8_t *scan_decimal(const uint8_t *p, Decimal *decimal)
{
    const uint8_t *start = p;
    decimal->negative = *p == '-';
    if (*p == '-' || *p == '+') p++;
    const uint8_t *whole = p;
    p = scan_digits(p, decimal, false);
    size_t digits = (size_t)(p - whole);
    if (*p == '.') {
        const uint8_t *fraction = ++p;
        p = scan_digits(p, decimal, true);
        digits += (size_t)(p - fraction);
    }
    if (digits == 0) return start;
    if (*p != 'e' && *p != 'E') return p;
    const uint8_t *e = p + 1;
    bool minus = *e == '-';
    if (*e == '-' || *e == '+') e++;
    if (*e < '0' || *e > '9') return start;
    int exponent = 0;
    for (; *e >= '0' && *e <= '9'; e++)
        if (exponent < 100000) exponent = exponent * 10 + (*e - '0');
    decimal->exponent += minus ? -exponent : exponent;
    return e;
}

// A fast exact conversion. Digits below 2^53 and powers of ten up to 10^22 are exact doubles, so
// one multiplication or division is correctly rounded (Clinger 1990, "How to read floating point
// numbers accurately"). Rounding the double to float can only be wrong if the double is exactly the
// midpoint of two floats, where the first rounding may have put it. Returns false in that case and
// for all other numbers.
static bool convert_fast(const Decimal *decimal, float *value)
{
    static const double power[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                   1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                   1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    int e = decimal->exponent;
    if (decimal->cut || decimal->digits > (1ull << 53) || e < -22 || e > 22) return false;
    double exact = (double)decimal->digits;
    double wide = e < 0 ? exact / power[-e] : exact * power[e];
    uint64_t bits;
    memcpy(&bits, &wide, 8);
    if ((bits & 0x1fffffff) == 0x10000000) return false;
    *value = (float)(decimal->negative ? -wide : wide);
    return true;
}

// Parses "1.#INF" and its variants, and the words that strtof accepts.
static bool convert_special(const uint8_t *word, size_t length, float *value)
{
    bool negative = length > 0 && word[0] == '-';
    size_t sign = length > 0 && (word[0] == '-' || word[0] == '+');
    static const struct {
        const char *word;
        bool infinite;
    } names[] = {{"1.#INF", true}, {"1.#QNAN", false}, {"1.#SNAN", false},  {"1.#IND", false},
                 {"inf", true},    {"nan", false},     {"infinity", true},  {"nan(ind)", false},
                 {"1.#J", true},   {"1.#R", false},    {"nan(snan)", false}};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        size_t size = strlen(names[i].word);
        if (length < sign + size) continue;
        if (strncasecmp((const char *)word + sign, names[i].word, size) != 0) continue;
        // Some C libraries pad these words with zeros to the requested digits: -1.#INF00, -1.#IND0.
        size_t end = sign + size;
        while (end < length && word[end] == '0' && names[i].word[0] == '1') end++;
        if (end != length) continue;
        *value = names[i].infinite ? (negative ? -INFINITY : INFINITY) : NAN;
        return true;
    }
    return false;
}

float reader_read_number(Reader *reader, const char *what)
{
    if (!reader_ok(reader)) return 0.0f;
    skip_blanks(reader);
    const uint8_t *start = reader->data + reader->at;
    Decimal decimal = {0};
    const uint8_t *end = scan_decimal(start, &decimal);
    float value = 0.0f;
    if (end != start && (is_blank(*end) || *end == '\n' || end == reader->data + reader->size)) {
        if (!convert_fast(&decimal, &value)) value = strtof((const char *)start, NULL);
        reader->at = (size_t)(end - reader->data);
        return value;
    }
    size_t length = measure_word(reader);
    if (convert_special(start, length, &value))
        reader->at += length;
    else
        reader_fail_expected(reader, what);
    return value;
}
