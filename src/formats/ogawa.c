// SPDX-License-Identifier: MIT
#include "formats/ogawa.h"
#include "base/half.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const uint64_t DATA_BIT = UINT64_C(1) << 63;
enum { DEEPEST = 64, KEY_BYTES = 16, HASH_BYTES = 32, EXPLICIT_TEXT = 0xff };

// --- Groups and data.

typedef struct Block {
    uint64_t at, size; // of data: bytes; of a group: number of children
} Block;

static uint64_t read_number(Reader *reader, uint64_t at)
{
    if (!reader_ok(reader)) return 0;
    reader->at = at < reader->size ? (size_t)at : reader->size;
    uint64_t low = reader_read_u32(reader, "a size or position");
    uint64_t number = low | (uint64_t)reader_read_u32(reader, "a size or position") << 32;
    if (reader_ok(reader)) reader->at = (size_t)at;
    return number;
}

static Block open_group(Reader *reader, uint64_t place)
{
    Block group = {place, 0};
    if (!reader_ok(reader)) return group;
    if (place & DATA_BIT) {
        reader_fail(reader, "got data, expected a group");
        return group;
    }
    if (place) group.size = read_number(reader, place);
    if (place && reader_ok(reader) &&
        !reader_check_array(reader, place + 8, group.size, 8, "a group's parts"))
        group.size = 0;
    return group;
}

static uint64_t child_of(Reader *reader, Block group, uint64_t i)
{
    return read_number(reader, group.at + 8 + 8 * i);
}

static Block open_data(Reader *reader, uint64_t place)
{
    Block data = {place & ~DATA_BIT, 0};
    if (!reader_ok(reader)) return data;
    if (!(place & DATA_BIT)) {
        reader_fail(reader, "got a group, expected data");
        return data;
    }
    if (data.at) data.size = read_number(reader, data.at);
    data.at += 8;
    if (data.size && !reader_check_array(reader, data.at, data.size, 1, "data")) data.size = 0;
    return data;
}

// Whether the group at `at` is visited for the first time; a tree contains each group once.
static bool is_new(Ogawa *file, uint64_t at)
{
    Reader *reader = file->reader;
    if (!reader_ok(reader)) return false;
    if (at >= reader->size || file->seen[at / 8] & 1u << at % 8) {
        reader->at = at < reader->size ? (size_t)at : reader->size;
        reader_fail(reader,
                    "a group contains itself or has two parents: expected a tree of groups");
        return false;
    }
    file->seen[at / 8] |= (uint8_t)(1u << at % 8);
    return true;
}

// --- Headers: sequences of numbers and texts.

typedef struct Cursor {
    Reader *reader;
    uint64_t at, end;
} Cursor;

static uint32_t take(Cursor *cursor, uint32_t bytes)
{
    Reader *reader = cursor->reader;
    uint32_t number = 0;
    if (!reader_ok(reader)) return 0;
    if (cursor->end - cursor->at < bytes) {
        reader->at = (size_t)cursor->at;
        reader_fail(reader, "a header is cut off");
        return 0;
    }
    for (uint32_t i = 0; i < bytes; ++i) number |= (uint32_t)reader->data[cursor->at++] << 8 * i;
    return number;
}

// A text within the file; NULL after an error.
static const char *take_text(Cursor *cursor, uint32_t length)
{
    Reader *reader = cursor->reader;
    if (!reader_ok(reader)) return NULL;
    if (cursor->end - cursor->at < length) {
        reader->at = (size_t)cursor->at;
        reader_fail(reader, "a header's text is cut off");
        return NULL;
    }
    cursor->at += length;
    return (const char *)reader->data + cursor->at - length;
}

// The shared text with this number; 0 is the empty text.
static const char *find_text(Ogawa *file, uint32_t number, uint32_t *length)
{
    *length = 0;
    if (number == 0) return "";
    Block data = open_data(file->reader, file->texts);
    Cursor cursor = {file->reader, data.at, data.at + data.size};
    const char *text = "";
    for (uint32_t i = 0; i < number && text; ++i) {
        *length = take(&cursor, 1);
        text = take_text(&cursor, *length);
    }
    if (!text) *length = 0;
    return text ? text : "";
}

// The metadata of an object's header: either written there, or given by the number of a shared
// text.
static const char *take_meta(Ogawa *file, Cursor *cursor, uint32_t number, uint32_t width,
                             uint32_t *length)
{
    if (number != EXPLICIT_TEXT) return find_text(file, number, length);
    *length = take(cursor, width);
    const char *text = take_text(cursor, *length);
    if (!text) *length = 0;
    return text ? text : "";
}

// The value of `key` in "key=value;..."; cut if it does not fit.
static void find_value(const char *text, uint32_t length, const char *key, char *value, size_t size)
{
    size_t known = strlen(key);
    *value = 0;
    for (uint32_t at = 0; at < length;) {
        uint32_t end = at;
        while (end < length && text[end] != ';') ++end;
        if (end - at > known && memcmp(text + at, key, known) == 0 && text[at + known] == '=') {
            snprintf(value, size, "%.*s", (int)(end - at - known - 1), text + at + known + 1);
            return;
        }
        at = end + 1;
    }
}

// --- Properties.

static void take_property(Cursor *cursor, OgawaProperty *property)
{
    uint32_t info = take(cursor, 4), width = (info >> 2 & 3) == 0   ? 1
                                             : (info >> 2 & 3) == 1 ? 2
                                                                    : 4;
    *property = (OgawaProperty){.compound = (info & 3) == 0,
                                .array = (info & 2) != 0,
                                .pod = info >> 4 & 15,
                                .extent = info >> 12 & 0xff,
                                .group = property->group};
    if (!property->compound) {
        property->samples = take(cursor, width);
        if (info & 0x200) {
            property->first = take(cursor, width);
            property->last = take(cursor, width);
        } else if (!(info & 0x800) && property->samples > 1) {
            property->first = 1;
            property->last = property->samples - 1;
        }
        if (info & 0x100) property->sampling = take(cursor, width);
        if (property->last && (property->first == 0 || property->last < property->first ||
                               property->last >= property->samples))
            reader_fail(
                cursor->reader,
                "samples %u to %u change, but there are only %u samples: expected existing samples",
                property->first, property->last, property->samples);
    }
    uint32_t length = take(cursor, width);
    const char *name = take_text(cursor, length);
    if (name)
        snprintf(property->name, sizeof property->name, "%.*s", (int)(length < 63 ? length : 63),
                 name);
    if ((info >> 20 & 0xff) == EXPLICIT_TEXT) take_text(cursor, take(cursor, width));
}

static OgawaProperties read_compound(Ogawa *file, uint64_t place)
{
    Reader *reader = file->reader;
    OgawaProperties properties = {0};
    Block group = open_group(reader, place);
    if (group.size < 2 || !reader_ok(reader)) return properties;
    uint64_t headers = child_of(reader, group, group.size - 1);
    if (!(headers & DATA_BIT)) return properties;
    Block data = open_data(reader, headers);
    if (data.size == 0 || !reader_work(reader, data.size, 10)) return properties;
    // The shortest header has 6 bytes, which bounds their number.
    uint64_t most = data.size / 6 < group.size - 1 ? data.size / 6 : group.size - 1;
    properties.property = reader_calloc(reader, (size_t)most + 1, sizeof *properties.property);
    Cursor cursor = {reader, data.at, data.at + data.size};
    while (reader_ok(reader) && cursor.at < cursor.end && properties.count < most) {
        OgawaProperty *property = &properties.property[properties.count];
        property->group = child_of(reader, group, properties.count++);
        take_property(&cursor, property);
    }
    return properties;
}

const OgawaProperty *ogawa_find(const OgawaProperties *properties, const char *name)
{
    for (uint32_t i = 0; i < properties->count; ++i)
        if (strcmp(properties->property[i].name, name) == 0) return &properties->property[i];
    return NULL;
}

OgawaProperties ogawa_compound(Ogawa *file, const OgawaProperties *of, const char *name)
{
    const OgawaProperty *property = ogawa_find(of, name);
    if (!property || !property->compound) return (OgawaProperties){0};
    return read_compound(file, property->group);
}

void ogawa_free(OgawaProperties *properties)
{
    free(properties->property);
    *properties = (OgawaProperties){0};
}

// --- Samples.

typedef struct Pod {
    char kind; // b, u, i, h (half), f; 0 if not a number
    uint8_t bytes;
} Pod;

static const Pod PODS[16] = {{'b', 1}, {'u', 1}, {'i', 1}, {'u', 2}, {'i', 2}, {'u', 4},
                             {'i', 4}, {'u', 8}, {'i', 8}, {'h', 2}, {'f', 4}, {'f', 8}};

static double number_at(const uint8_t *at, Pod pod)
{
    uint64_t bits = 0;
    for (int i = 0; i < pod.bytes; ++i) bits |= (uint64_t)at[i] << 8 * i;
    if (pod.kind == 'h') return half_number((uint32_t)bits);
    if (pod.kind == 'f' && pod.bytes == 4) {
        uint32_t word = (uint32_t)bits;
        float number;
        memcpy(&number, &word, 4);
        return (double)number;
    }
    if (pod.kind == 'f') {
        double number;
        memcpy(&number, &bits, 8);
        return number;
    }
    int unused = 64 - 8 * pod.bytes;
    if (pod.kind == 'i') return (double)((int64_t)(bits << unused) >> unused);
    return (double)bits;
}

double *ogawa_numbers(Ogawa *file, const OgawaProperty *property, uint32_t sample, size_t *count)
{
    Reader *reader = file->reader;
    Pod pod = PODS[property->pod];
    uint64_t place = 0;
    *count = 0;
    if (!reader_ok(reader)) return NULL;
    if (sample >= property->samples) sample = property->samples ? property->samples - 1 : 0;
    if (property->last && sample >= property->first)
        place = (sample < property->last ? sample : property->last) - property->first + 1;
    if (property->array) place *= 2; // a sample has two children: values and dimensions
    Block group = open_group(reader, property->group);
    if (reader_ok(reader) && (place >= group.size || property->samples == 0 || !pod.kind)) {
        reader_fail(reader, "'%s': sample %u: expected numbers", property->name, sample);
        return NULL;
    }
    Block data = open_data(reader, child_of(reader, group, place));
    uint64_t numbers = data.size > KEY_BYTES ? (data.size - KEY_BYTES) / pod.bytes : 0;
    if (property->extent > 1) numbers -= numbers % property->extent;
    double *number = reader_malloc(reader, numbers, sizeof *number);
    if (!number) return NULL;
    for (uint64_t i = 0; i < numbers; ++i)
        number[i] = number_at(reader->data + data.at + KEY_BYTES + i * pod.bytes, pod);
    *count = (size_t)numbers;
    return number;
}

char *ogawa_texts(Ogawa *file, const OgawaProperty *property, size_t *count)
{
    Reader *reader = file->reader;
    enum { STRING_POD = 12 };
    *count = 0;
    if (!reader_ok(reader) || property->pod != STRING_POD || !property->samples) return NULL;
    Block group = open_group(reader, property->group);
    if (!reader_ok(reader) || group.size == 0) return NULL;
    Block data = open_data(reader, child_of(reader, group, 0));
    if (!reader_ok(reader) || data.size <= KEY_BYTES) return NULL;
    size_t size = (size_t)(data.size - KEY_BYTES);
    char *texts = reader_malloc(reader, size + 1, 1);
    if (!texts) return NULL;
    memcpy(texts, reader->data + data.at + KEY_BYTES, size);
    texts[size] = 0;
    for (size_t i = 0; i < size; ++i) *count += !texts[i];
    *count += texts[size - 1] != 0; // a scalar has no zero
    return texts;
}

uint32_t ogawa_extent(Ogawa *file, const OgawaProperties *of, const char *name)
{
    const OgawaProperty *property = ogawa_find(of, name);
    if (!property || !property->compound) return property ? property->extent : 0;
    OgawaProperties inner = ogawa_compound(file, of, name);
    const OgawaProperty *values = ogawa_find(&inner, ".vals");
    uint32_t extent = values ? values->extent : 0;
    ogawa_free(&inner);
    return extent;
}

// Replaces indices by the items they refer to.
static double *expand(Ogawa *file, const OgawaProperty *indices, double *value, uint32_t extent,
                      size_t *count, const char *name)
{
    Reader *reader = file->reader;
    size_t items = *count / extent, wanted;
    double *index = ogawa_numbers(file, indices, 0, &wanted), *all = NULL;
    if (index) all = reader_malloc(reader, (uint64_t)wanted * extent, sizeof *all);
    for (size_t i = 0; all && i < wanted; ++i) {
        if (!(index[i] >= 0 && index[i] < (double)items)) {
            reader_fail(reader,
                        "'%s': index %g: expected a whole number below %zu, the number of values",
                        name, index[i], items);
            break;
        }
        memcpy(all + i * extent, value + (size_t)index[i] * extent, extent * sizeof *all);
    }
    free(value);
    free(index);
    if (!reader_ok(reader)) {
        free(all);
        return NULL;
    }
    *count = wanted * extent;
    return all;
}

double *ogawa_parameter(Ogawa *file, const OgawaProperties *of, const char *name, uint32_t extent,
                        size_t *count)
{
    const OgawaProperty *property = ogawa_find(of, name), *values = property;
    OgawaProperties inner = {0};
    double *value = NULL;
    *count = 0;
    if (!property || !reader_ok(file->reader)) return NULL;
    if (property->compound) {
        inner = ogawa_compound(file, of, name);
        values = ogawa_find(&inner, ".vals");
    }
    const OgawaProperty *indices = ogawa_find(&inner, ".indices");
    // A scalar property may hold one item per sample.
    bool fits = values && PODS[values->pod].kind && values->samples &&
                (values->extent == extent || values->extent == 1);
    if (fits) value = ogawa_numbers(file, values, 0, count);
    if (value && *count % extent) *count -= *count % extent;
    if (value && indices) value = expand(file, indices, value, extent, count, name);
    ogawa_free(&inner);
    return value;
}

// --- Times.

static void read_samplings(Ogawa *file, uint64_t place)
{
    Reader *reader = file->reader;
    Block data = open_data(reader, place);
    uint64_t most = data.size / 16, at = data.at, end = data.at + data.size;
    file->sampling = reader_calloc(reader, (size_t)most + 1, sizeof *file->sampling);
    while (reader_ok(reader) && end - at >= 16) {
        OgawaSampling *sampling = &file->sampling[file->sampling_count];
        sampling->cycle = number_at(reader->data + at + 4, PODS[11]);
        uint32_t count = (uint32_t)number_at(reader->data + at + 12, PODS[5]);
        at += 16;
        if (count > (end - at) / 8) {
            reader->at = (size_t)at;
            reader_fail(reader, "%u sample times: the file is too small for so many", count);
            break;
        }
        sampling->time = reader_malloc(reader, count, sizeof *sampling->time);
        if (!sampling->time) {
            reader_fail_memory(reader);
            break;
        }
        file->sampling_count++;
        for (uint32_t i = 0; i < count; ++i, at += 8) {
            double time = number_at(reader->data + at, PODS[11]);
            if (!(fabs(time) < 1e9) || (i > 0 && time <= sampling->time[i - 1])) break;
            sampling->time[sampling->count++] = time;
        }
        // Alembic marks uneven times by a huge cycle.
        if (!(sampling->cycle > 0 && sampling->cycle < 1e9)) sampling->cycle = 0;
    }
}

double ogawa_time(const Ogawa *file, uint32_t sampling, uint32_t sample)
{
    if (sampling >= file->sampling_count || file->sampling[sampling].count == 0) return sample;
    const OgawaSampling *times = &file->sampling[sampling];
    if (sample < times->count) return times->time[sample];
    double last = times->time[times->count - 1];
    if (times->cycle <= 0) return last + (sample - times->count + 1);
    return times->time[sample % times->count] + times->cycle * (sample / times->count);
}

double ogawa_around(const Ogawa *file, uint32_t sampling, uint32_t count, double time,
                    uint32_t *before, uint32_t *after)
{
    uint32_t low = 0, high = count ? count - 1 : 0;
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        *(ogawa_time(file, sampling, middle) <= time ? &low : &high) = middle;
    }
    double from = ogawa_time(file, sampling, low), to = ogawa_time(file, sampling, high);
    *before = low;
    *after = high;
    if (high == low || time <= from) return 0;
    return time >= to ? 1 : (time - from) / (to - from);
}

OgawaFrames ogawa_frames(const Ogawa *file, uint32_t sampling, uint32_t count)
{
    const OgawaSampling *times = sampling < file->sampling_count ? &file->sampling[sampling] : NULL;
    double first = ogawa_time(file, sampling, 0);
    OgawaFrames frames = {.sampling = sampling, .samples = count, .start = first, .count = count};
    if (count < 2) return frames;
    double span = ogawa_time(file, sampling, count - 1) - first;
    bool cyclic = times && times->count > 1 && times->cycle > 0 && count > times->count;
    bool uniform = times && times->count == 1 && times->cycle > 0;
    frames.rate = uniform || cyclic ? 1 / times->cycle : span > 0 ? (count - 1) / span : 0;
    if (!cyclic) return frames;
    // Several samples a frame, as for motion blur: the frames are the whole ones.
    double whole = ceil(first * frames.rate - 1e-6);
    double last = floor((first + span) * frames.rate + 1e-6);
    if (!(last >= whole && last - whole < 1e7)) return frames;
    frames.start = whole / frames.rate;
    frames.count = (uint32_t)(last - whole) + 1;
    return frames;
}

double ogawa_frame_time(const Ogawa *file, const OgawaFrames *frames, uint32_t i)
{
    uint32_t before, after;
    double time =
        frames->rate > 0 ? frames->start + i / frames->rate : ogawa_time(file, frames->sampling, i);
    if (frames->samples < 2) return time;
    ogawa_around(file, frames->sampling, frames->samples, time, &before, &after);
    double a = ogawa_time(file, frames->sampling, before),
           b = ogawa_time(file, frames->sampling, after), near = 1e-6 / frames->rate;
    return fabs(a - time) < near ? a : fabs(b - time) < near ? b : time;
}

// --- Objects.

static OgawaObject *add_object(Ogawa *file, int parent, const char *name, uint32_t length)
{
    OgawaObject *more =
        reader_realloc(file->reader, file->object, (uint64_t)file->count + 1, sizeof *more);
    if (!more) return NULL;
    file->object = more;
    OgawaObject *object = &more[file->count++];
    *object = (OgawaObject){.parent = parent};
    const char *above = parent >= 0 ? more[parent].path : "";
    int room = OGAWA_PATH_SIZE - 2 - (int)(length < 80 ? length : 80), used = (int)strlen(above);
    snprintf(object->path, sizeof object->path, "%s/%.*s", above + (used > room ? used - room : 0),
             (int)(length < 80 ? length : 80), name);
    return object;
}

int ogawa_add_copy(Ogawa *file, int of, int parent, const char *path)
{
    OgawaObject *object = add_object(file, parent, "", 0);
    if (!object) return -1;
    OgawaObject copy = file->object[of];
    copy.parent = parent;
    copy.copy = true;
    size_t length = strlen(path), most = sizeof copy.path - 1;
    snprintf(copy.path, sizeof copy.path, "%s", length > most ? path + length - most : path);
    *object = copy;
    return file->count - 1;
}

static void read_children(Ogawa *file, int parent, Block group, int depth);

static void read_object(Ogawa *file, int number, uint64_t place, int depth)
{
    Reader *reader = file->reader;
    Block group = open_group(reader, place);
    OgawaObject *object = &file->object[number];
    object->group = place;
    if (depth > DEEPEST) reader_fail(reader, "objects are nested more than %d deep", DEEPEST);
    if (group.size == 0 || !is_new(file, place)) return;
    uint64_t properties = child_of(reader, group, 0);
    if (!(properties & DATA_BIT)) {
        OgawaProperties own = read_compound(file, properties);
        file->object[number].own = own;
    }
    read_children(file, number, group, depth);
}

static void read_children(Ogawa *file, int parent, Block group, int depth)
{
    Reader *reader = file->reader;
    if (group.size < 2 || !reader_ok(reader)) return;
    uint64_t headers = child_of(reader, group, group.size - 1);
    if (!(headers & DATA_BIT)) return;
    Block data = open_data(reader, headers);
    if (data.size < HASH_BYTES || !is_new(file, data.at)) return;
    Cursor cursor = {reader, data.at, data.at + data.size - HASH_BYTES};
    for (uint64_t i = 1; i + 1 < group.size && cursor.at < cursor.end && reader_ok(reader); ++i) {
        uint32_t length = take(&cursor, 4), meta;
        const char *name = take_text(&cursor, length);
        const char *text = take_meta(file, &cursor, take(&cursor, 1), 4, &meta);
        OgawaObject *object = name ? add_object(file, parent, name, length) : NULL;
        if (!object) break;
        find_value(text, meta, "schema", object->schema, sizeof object->schema);
        read_object(file, file->count - 1, child_of(reader, group, i), depth + 1);
    }
}

// --- The file.

bool ogawa_matches(const Bytes *bytes)
{
    return bytes->size >= 5 && memcmp(bytes->data, "Ogawa", 5) == 0;
}

// Reads the unit and the up axis, which files of this program contain.
static void read_unit(Ogawa *file, uint64_t place)
{
    char value[OGAWA_NAME_SIZE];
    Block data = open_data(file->reader, place);
    const char *text = (const char *)file->reader->data + data.at;
    uint32_t length = data.size < 10000 ? (uint32_t)data.size : 10000;
    file->up_z = -1;
    find_value(text, length, "metersPerUnit", value, sizeof value);
    file->unit = strtod(value, NULL);
    if (!(file->unit >= 1e-9 && file->unit <= 1e9)) file->unit = 0;
    find_value(text, length, "upAxis", value, sizeof value);
    if (*value == 'Y' || *value == 'Z') file->up_z = *value == 'Z';
}

Result ogawa_open(Ogawa *file, Reader *reader)
{
    *file = (Ogawa){.reader = reader, .up_z = -1};
    reader->at = 5;
    if (reader->size < 16 || reader->data[5] != 0xff)
        return reader_fail(
            reader, "the program that wrote the file did not finish it: expected a complete file");
    file->seen = reader_calloc(reader, reader->size / 8 + 1, 1);
    if (!file->seen) return reader_fail_memory(reader);
    Block top = open_group(reader, read_number(reader, 8));
    if (reader_ok(reader) && top.size < 6)
        return reader_fail(reader, "%llu groups at the top level: expected 6",
                           (unsigned long long)top.size);
    read_unit(file, child_of(reader, top, 3));
    read_samplings(file, child_of(reader, top, 4));
    file->texts = child_of(reader, top, 5);
    if (!reader_ok(reader)) return reader->result;
    uint64_t root = child_of(reader, top, 2);
    Block group = open_group(reader, root);
    if (group.size && is_new(file, root)) read_children(file, -1, group, 0);
    return reader->result;
}

void ogawa_close(Ogawa *file)
{
    for (int i = 0; i < file->count; ++i)
        if (!file->object[i].copy) ogawa_free(&file->object[i].own);
    for (uint32_t i = 0; i < file->sampling_count; ++i) free(file->sampling[i].time);
    free(file->object);
    free(file->sampling);
    free(file->seen);
    *file = (Ogawa){0};
}
