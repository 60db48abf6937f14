// SPDX-License-Identifier: MIT
#include "formats/zip.h"

#include <libdeflate.h>
#include <stdlib.h>
#include <string.h>

enum { LOCAL_SIZE = 30, CENTRAL_SIZE = 46, END_SIZE = 22, LOCATOR_SIZE = 20, END64_SIZE = 56 };
enum { STORED = 0, DEFLATED = 8, ENCRYPTED = 1 };
static const uint32_t LOCAL = 0x04034b50, CENTRAL = 0x02014b50, END = 0x06054b50,
                      LOCATOR64 = 0x07064b50, END64 = 0x06064b50;

static uint64_t get(const uint8_t *at, int size)
{
    uint64_t value = 0;
    for (int i = 0; i < size; i++) value |= (uint64_t)at[i] << (8 * i);
    return value;
}

// --- The directory.

// The offset of the end record, which a comment may follow; the archive's size if there is none.
static size_t find_end(const Reader *reader)
{
    for (size_t back = END_SIZE; back <= reader->size && back <= END_SIZE + 65535; back++)
        if (get(reader->data + reader->size - back, 4) == END) return reader->size - back;
    return reader->size;
}

static void find_directory(Reader *reader, uint64_t *count, uint64_t *at)
{
    size_t end = find_end(reader);
    if (end == reader->size) {
        reader_fail(
            reader,
            "the zip archive has no directory: expected a complete archive, this one is cut off");
        return;
    }
    const uint8_t *record = reader->data + end;
    *count = get(record + 10, 2);
    *at = get(record + 16, 4);
    if (end < LOCATOR_SIZE || get(record - LOCATOR_SIZE, 4) != LOCATOR64) return;
    uint64_t wide = get(record - LOCATOR_SIZE + 8, 8);
    reader->at = end - LOCATOR_SIZE;
    if (!reader_check_array(reader, wide, 1, END64_SIZE, "the zip64 directory")) return;
    if (get(reader->data + wide, 4) != END64) reader_fail(reader, "the zip64 directory is damaged");
    *count = get(reader->data + wide + 32, 8);
    *at = get(reader->data + wide + 48, 8);
}

// Reads sizes and offset from the zip64 extra field. It has only those that do not fit 32 bits, in
// this order.
static void read_extra(Reader *reader, ZipFile *file, const uint8_t *extra, size_t size,
                       uint64_t *local)
{
    uint64_t *const wide[] = {&file->size, &file->packed, local};
    for (size_t at = 0; at + 4 <= size; at += 4 + get(extra + at + 2, 2)) {
        size_t end = at + 4 + get(extra + at + 2, 2), field = at + 4;
        if (get(extra + at, 2) != 1 || end > size) continue;
        for (int i = 0; i < 3; i++) {
            if (*wide[i] != UINT32_MAX) continue;
            if (field + 8 > end) {
                reader_fail(reader, "the zip64 sizes of '%s' are damaged", file->name);
                return;
            }
            *wide[i] = get(extra + field, 8);
            field += 8;
        }
        return;
    }
}

// Finds the content behind the local header, whose extra field may differ from the directory's.
static void find_content(Reader *reader, ZipFile *file, uint64_t local)
{
    if (!reader_check_array(reader, local, 1, LOCAL_SIZE, "a zipped file's header")) return;
    const uint8_t *head = reader->data + local;
    if (get(head, 4) != LOCAL) reader_fail(reader, "the header of '%s' is damaged", file->name);
    file->at = local + LOCAL_SIZE + get(head + 26, 2) + get(head + 28, 2);
    reader_check_array(reader, file->at, file->packed, 1, "a zipped file's bytes");
}

// Reads the directory entry at the reader's place and moves behind it.
static void read_entry(Reader *reader, ZipFile *file)
{
    if (!reader_check_array(reader, reader->at, 1, CENTRAL_SIZE, "the zip directory")) return;
    const uint8_t *entry = reader->data + reader->at;
    size_t name = get(entry + 28, 2), extra = get(entry + 30, 2), comment = get(entry + 32, 2);
    size_t size = CENTRAL_SIZE + name + extra + comment;
    if (get(entry, 4) != CENTRAL) reader_fail(reader, "the zip directory is damaged");
    if (!reader_check_array(reader, reader->at, 1, size, "the zip directory")) return;
    size_t kept = name < ZIP_NAME_SIZE ? name : ZIP_NAME_SIZE - 1;
    for (size_t i = 0; i < kept; i++) {
        uint8_t c = entry[CENTRAL_SIZE + i];
        file->name[i] = (char)(c >= ' ' && c < 127 ? c : '?');
    }
    file->method = (uint32_t)get(entry + 10, 2);
    file->crc = (uint32_t)get(entry + 16, 4);
    file->packed = get(entry + 20, 4);
    file->size = get(entry + 24, 4);
    uint64_t local = get(entry + 42, 4);
    if (get(entry + 8, 2) & ENCRYPTED) reader_fail(reader, "'%s' is encrypted", file->name);
    read_extra(reader, file, entry + CENTRAL_SIZE + name, extra, &local);
    find_content(reader, file, local);
    reader->at += size;
}

Result zip_open(Zip *zip, Reader *reader)
{
    uint64_t count = 0, at = 0;
    *zip =
        (Zip){.reader = reader, .budget = ZIP_MOST_TIMES * ((uint64_t)reader->size + (1u << 20))};
    find_directory(reader, &count, &at);
    if (!reader_ok(reader)) return reader->result;
    if (!reader_check_array(reader, at, count, CENTRAL_SIZE, "the zip directory"))
        return reader->result;
    if (count > ZIP_MOST_FILES)
        return reader_fail(reader, "%llu files in a zip archive: expected at most %d",
                           (unsigned long long)count, ZIP_MOST_FILES);
    zip->file = reader_calloc(reader, count + 1, sizeof *zip->file);
    if (!zip->file) return reader_fail_memory(reader);
    reader->at = at;
    for (zip->count = 0; zip->count < count && reader_ok(reader); zip->count++)
        read_entry(reader, &zip->file[zip->count]);
    return reader->result;
}

void zip_close(Zip *zip)
{
    free(zip->file);
    *zip = (Zip){0};
}

// --- Content.

static Result unpack(Zip *zip, const ZipFile *file, uint8_t *to)
{
    struct libdeflate_decompressor *decompressor = libdeflate_alloc_decompressor();
    if (!decompressor) return reader_fail_memory(zip->reader);
    size_t got = 0;
    enum libdeflate_result result = libdeflate_deflate_decompress(
        decompressor, zip->reader->data + file->at, file->packed, to, file->size, &got);
    libdeflate_free_decompressor(decompressor);
    if (result != LIBDEFLATE_SUCCESS || got != file->size)
        return reader_fail(zip->reader,
                           "'%s' does not unpack to %llu bytes, the size that the archive states",
                           file->name, (unsigned long long)file->size);
    return RESULT_OK;
}

static Result check_size(Zip *zip, const ZipFile *file)
{
    if (file->method != STORED && file->method != DEFLATED)
        return reader_fail(zip->reader,
                           "'%s' is compressed by method %u: expected deflate or no compression",
                           file->name, file->method);
    if (file->method == STORED && file->packed != file->size)
        return reader_fail(zip->reader, "'%s' has two different sizes", file->name);
    if (file->method == DEFLATED && file->size > zip->budget)
        return reader_fail(zip->reader,
                           "'%s' unpacks to %llu bytes: expected at most %d times the archive's "
                           "size plus %d MiB in all, or an uncompressed file",
                           file->name, (unsigned long long)file->size, ZIP_MOST_TIMES,
                           ZIP_MOST_TIMES);
    return RESULT_OK;
}

Result zip_read(Zip *zip, const ZipFile *file, Bytes *content, uint8_t **owned)
{
    *content = (Bytes){0};
    *owned = NULL;
    zip->reader->at = file->at;
    TRY(check_size(zip, file));
    if (!reader_work(zip->reader, file->packed + file->size, 2)) return zip->reader->result;
    if (file->method == STORED) {
        *content = (Bytes){(uint8_t *)(uintptr_t)zip->reader->data + file->at, file->size};
    } else {
        *owned = malloc(file->size + 1); // `budget` counts it
        if (!*owned) return reader_fail_memory(zip->reader);
        zip->budget -= file->size;
        *content = (Bytes){*owned, file->size};
        TRY(unpack(zip, file, *owned));
        (*owned)[file->size] = 0;
    }
    if (libdeflate_crc32(0, content->data, content->size) == file->crc) return RESULT_OK;
    return reader_fail(zip->reader, "'%s' is damaged: its checksum does not match", file->name);
}

// --- Writing.

static uint8_t *put(uint8_t *at, uint64_t value, int size)
{
    for (int i = 0; i < size; i++) *at++ = (uint8_t)(value >> (8 * i));
    return at;
}

// Writes the fields that a local header and a directory entry share, from the version on.
static uint8_t *put_shared(uint8_t *at, uint32_t crc, uint64_t size, size_t name)
{
    const uint32_t version = 20, date = 1 << 5 | 1; // 1980-01-01
    at = put(at, version, 2);
    at = put(put(put(at, 0, 2), STORED, 2), 0, 2);
    at = put(put(at, date, 2), crc, 4);
    at = put(put(at, size, 4), size, 4);
    return put(put(at, name, 2), 0, 2);
}

static uint8_t *make_room(ZipWriter *writer, size_t size)
{
    if (writer->size + size > writer->room) {
        size_t room = 2 * writer->room + size + 1024;
        uint8_t *more = realloc(writer->directory, room);
        if (!more) return NULL;
        writer->directory = more;
        writer->room = room;
    }
    writer->size += size;
    return writer->directory + writer->size - size;
}

void zip_add(ZipWriter *writer, const char *name, const void *head, size_t head_size,
             const void *body, size_t body_size)
{
    FILE *stream = writer->out->stream;
    size_t length = strlen(name), size = head_size + body_size;
    uint8_t local[LOCAL_SIZE], *entry = make_room(writer, CENTRAL_SIZE + length);
    uint64_t end = writer->at + LOCAL_SIZE + length + size;
    writer->failed = writer->failed || !entry || end > UINT32_MAX;
    if (writer->failed) return;
    uint32_t crc = libdeflate_crc32(libdeflate_crc32(0, head, head_size), body, body_size);
    put_shared(put(local, LOCAL, 4), crc, size, length);
    memset(entry, 0, CENTRAL_SIZE);
    put_shared(put(put(entry, CENTRAL, 4), 20, 2), crc, size, length);
    put(entry + 42, writer->at, 4);
    memcpy(entry + CENTRAL_SIZE, name, length);
    fwrite(local, 1, LOCAL_SIZE, stream);
    fwrite(name, 1, length, stream);
    fwrite(head, 1, head_size, stream);
    fwrite(body, 1, body_size, stream);
    writer->at = end;
    writer->count++;
}

Result zip_finish(ZipWriter *writer, Error *error)
{
    uint8_t end[END_SIZE] = {0};
    uint8_t *at = put(put(end, END, 4), 0, 4);
    at = put(put(at, writer->count, 2), writer->count, 2);
    put(put(at, writer->size, 4), writer->at, 4);
    fwrite(writer->directory, 1, writer->size, writer->out->stream);
    fwrite(end, 1, END_SIZE, writer->out->stream);
    bool failed = writer->failed || writer->at + writer->size > UINT32_MAX;
    free(writer->directory);
    const char *path = writer->out->path;
    *writer = (ZipWriter){0};
    if (!failed) return RESULT_OK;
    return error_set(error, RESULT_FAILED,
                     "%s: no memory, or more than the 4 GiB that a zip archive can hold", path);
}
