// SPDX-License-Identifier: MIT
#include "formats/npy_array.h"
#include "base/half.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char MAGIC[] = "\x93NUMPY";

// --- The header, a Python dict with three keys.

typedef struct Header {
    const char *at, *end;
    bool good;
} Header;

static char peek(Header *header)
{
    while (header->at < header->end && strchr(" \t\r\n", *header->at)) header->at++;
    return header->at < header->end ? *header->at : 0;
}

static bool take(Header *header, char wanted)
{
    if (peek(header) != wanted) return false;
    header->at++;
    return true;
}

static void read_string(Header *header, char *text, size_t size)
{
    char quote = peek(header);
    size_t length = 0;
    text[0] = 0;
    header->good = header->good && (quote == '\'' || quote == '"');
    if (!header->good) return;
    for (header->at++; header->at < header->end && *header->at != quote; header->at++)
        if (length + 1 < size) text[length++] = *header->at;
    text[length] = 0;
    header->good = take(header, quote);
}

static void read_word(Header *header, char *text, size_t size)
{
    size_t length = 0;
    peek(header);
    for (; header->at < header->end && strchr("TrueFals", *header->at); header->at++)
        if (length + 1 < size) text[length++] = *header->at;
    text[length] = 0;
}

static uint64_t read_whole(Header *header)
{
    uint64_t value = 0;
    char c = peek(header);
    header->good = header->good && c >= '0' && c <= '9';
    for (; header->good && header->at < header->end && *header->at >= '0' && *header->at <= '9';
         header->at++) {
        header->good = value < UINT64_MAX / 16;
        value = value * 10 + (uint64_t)(*header->at - '0');
    }
    return value;
}

static void read_shape(Header *header, NpyArray *array)
{
    header->good = header->good && take(header, '(');
    while (header->good && !take(header, ')')) {
        if (array->axes == NPY_MOST_AXES) header->good = false;
        if (header->good) array->shape[array->axes++] = read_whole(header);
        take(header, 'L');
        if (peek(header) != ')') header->good = header->good && take(header, ',');
    }
}

// Parses a type such as "<f4". False if it is neither a plain number nor text.
static bool read_type(NpyArray *array, const char *text)
{
    const char *at = text;
    array->big = *at == '>';
    if (strchr("<>=|", *at)) at++;
    array->kind = *at ? *at++ : 0;
    char *end;
    unsigned long item = strtoul(at, &end, 10);
    if (*end || end == at || item == 0 || item > 4096) return false;
    array->item = (uint32_t)item;
    if (array->kind == 'U') array->item *= 4;
    switch (array->kind) {
    case 'f':
        return item == 2 || item == 4 || item == 8;
    case 'i':
    case 'u':
        return item == 1 || item == 2 || item == 4 || item == 8;
    case 'b':
        return item == 1;
    default:
        return array->kind == 'U' || array->kind == 'S';
    }
}

static Result refuse_type(Reader *reader, const char *type)
{
    if (strchr(type, 'O'))
        return reader_fail(reader,
                           "pickled Python objects ('%s'), which are not read because they can run "
                           "programs: expected numbers",
                           type);
    return reader_fail(reader, "elements of type '%s': expected floats '<f2', '<f4' or '<f8'",
                       *type ? type : "(several fields)");
}

static Result parse_header(NpyArray *array, Reader *reader, Header *header)
{
    char type[32] = "", key[20], word[8];
    bool fields = false, ordered = false, shaped = false;
    header->good = take(header, '{');
    while (header->good && !take(header, '}')) {
        read_string(header, key, sizeof key);
        header->good = header->good && take(header, ':');
        if (strcmp(key, "descr") == 0 && peek(header) == '[') {
            fields = true;
            break;
        } else if (strcmp(key, "descr") == 0) {
            read_string(header, type, sizeof type);
        } else if (strcmp(key, "fortran_order") == 0) {
            read_word(header, word, sizeof word);
            array->fortran = strcmp(word, "True") == 0;
            ordered = array->fortran || strcmp(word, "False") == 0;
        } else if (strcmp(key, "shape") == 0) {
            read_shape(header, array);
            shaped = true;
        } else {
            header->good = false;
        }
        if (peek(header) != '}') header->good = header->good && take(header, ',');
    }
    if (!fields && !(header->good && *type && ordered && shaped))
        return reader_fail(reader, "the array's header is damaged");
    return fields || !read_type(array, type) ? refuse_type(reader, type) : RESULT_OK;
}

static Result find_data(NpyArray *array, Reader *reader)
{
    array->count = 1;
    for (uint32_t i = 0; i < array->axes; i++) {
        if (array->shape[i] && array->count > UINT64_MAX / array->shape[i])
            return reader_fail(reader, "an array of this shape does not fit into memory");
        array->count *= array->shape[i];
    }
    if (!reader_check_array(reader, reader->at, array->count, array->item, "the array's elements"))
        return reader->result;
    array->data = reader->data + reader->at;
    array->at = reader->at;
    reader->at += array->count * array->item;
    return RESULT_OK;
}

Result npy_array_read(NpyArray *array, Reader *reader)
{
    *array = (NpyArray){0};
    if (!reader_check_array(reader, reader->at, 1, 8, "the array's header")) return reader->result;
    const uint8_t *head = reader->data + reader->at;
    if (memcmp(head, MAGIC, 6) != 0) return reader_fail(reader, "not a numpy array (.npy)");
    if (head[6] < 1 || head[6] > 3)
        return reader_fail(reader, "version %u.%u of .npy: expected 1, 2 or 3", head[6], head[7]);
    reader->at += 8;
    size_t size = head[6] == 1 ? reader_read_u16(reader, "the header's size")
                               : reader_read_u32(reader, "the header's size");
    if (!reader_check_array(reader, reader->at, size, 1, "the array's header"))
        return reader->result;
    const char *text = (const char *)reader->data + reader->at;
    Header header = {text, text + size, true};
    TRY(parse_header(array, reader, &header));
    reader->at += size;
    return find_data(array, reader);
}

void npy_array_describe(const NpyArray *array, char *text, size_t size)
{
    size_t used = (size_t)snprintf(text, size, "(");
    for (uint32_t i = 0; i < array->axes && used < size; i++)
        used += (size_t)snprintf(text + used, size - used, "%s%llu", i ? ", " : "",
                                 (unsigned long long)array->shape[i]);
    if (used < size) snprintf(text + used, size - used, array->axes == 1 ? ",)" : ")");
}

bool npy_array_is_number(const NpyArray *array)
{
    return array->kind != 'U' && array->kind != 'S';
}

// --- Elements.

double npy_array_number(const NpyArray *array, uint64_t i)
{
    const uint8_t *at = array->data + i * array->item;
    uint64_t bits = 0;
    uint32_t item = array->item;
    float single;
    double wide;
    for (uint32_t k = 0; k < item; k++)
        bits |= (uint64_t)at[array->big ? item - 1 - k : k] << (8 * k);
    uint32_t low = (uint32_t)bits;
    memcpy(&single, &low, sizeof single);
    memcpy(&wide, &bits, sizeof wide);
    if (array->kind == 'f') return item == 2 ? half_number(low) : item == 4 ? (double)single : wide;
    if (array->kind != 'i') return (double)bits;
    uint64_t sign = 1ull << (8 * item - 1);
    return (double)(int64_t)((bits ^ sign) - sign);
}

void npy_array_copy(const NpyArray *array, float *to)
{
    uint64_t place[NPY_MOST_AXES] = {0}, step[NPY_MOST_AXES] = {0}, at = 0, stride = 1;
    for (uint32_t i = 0; i < array->axes; i++) {
        uint32_t axis = array->fortran ? i : array->axes - 1 - i;
        step[axis] = stride;
        stride *= array->shape[axis];
    }
    for (uint64_t n = 0; n < array->count; n++) {
        to[n] = (float)npy_array_number(array, at);
        for (uint32_t axis = array->axes; axis-- > 0;) {
            at += step[axis];
            if (++place[axis] < array->shape[axis]) break;
            at -= step[axis] * array->shape[axis];
            place[axis] = 0;
        }
    }
}

// --- Writing.

size_t npy_array_header(char header[NPY_HEADER_SIZE], const char *type, const uint64_t *shape,
                        uint32_t axes)
{
    enum { BEFORE = 10, MULTIPLE = 64 };
    char *text = header + BEFORE;
    size_t room = NPY_HEADER_SIZE - BEFORE - MULTIPLE;
    size_t used =
        (size_t)snprintf(text, room, "{'descr': '%s', 'fortran_order': False, 'shape': (", type);
    for (uint32_t i = 0; i < axes && i < NPY_MOST_AXES; i++)
        used += (size_t)snprintf(text + used, room - used, "%s%llu%s", i ? ", " : "",
                                 (unsigned long long)shape[i], axes == 1 ? "," : "");
    used += (size_t)snprintf(text + used, room - used, "), }");
    size_t size = (BEFORE + used + 1 + MULTIPLE - 1) / MULTIPLE * MULTIPLE;
    memset(text + used, ' ', size - BEFORE - used - 1);
    header[size - 1] = '\n';
    memcpy(header, MAGIC, 6);
    header[6] = 1;
    header[7] = 0;
    header[8] = (char)((size - BEFORE) & 255);
    header[9] = (char)((size - BEFORE) >> 8);
    return size;
}
