// SPDX-License-Identifier: MIT
// Files of a zip archive, stored or deflated, after PKWARE's "APPNOTE.TXT - .ZIP File Format
// Specification" 6.3. Reading uses the central directory, so data descriptors and zip64 work.
// Writing stores files and is deterministic.
#pragma once

#include "base/outfile.h"
#include "base/reader.h"

enum { ZIP_NAME_SIZE = 80, ZIP_MOST_FILES = 256 };

// Deflated files in memory at the same time may have at most this many times the archive's bytes
// plus this many MiB. Processing a byte takes at most 9 bytes, so memory stays below 64 times the
// archive plus 64 MB, whatever the archive claims.
enum { ZIP_MOST_TIMES = 7 };

typedef struct ZipFile {
    char name[ZIP_NAME_SIZE]; // cut if it is too long
    uint32_t method, crc;     // method: 0 stored, 8 deflated
    uint64_t packed, size;    // packed and unpacked bytes
    uint64_t at;              // offset of the packed bytes
} ZipFile;

typedef struct Zip {
    Reader *reader;
    ZipFile *file; // [count] owned
    uint32_t count;
    uint64_t
        budget; // bytes that may still be unpacked, ZIP_MOST_TIMES the archive's and as many MiB
} Zip;

// Reads the directory. Fails the reader if it is damaged, or if a file is encrypted or outside the
// archive. Close it in any case.
Result zip_open(Zip *zip, Reader *reader);
void zip_close(Zip *zip);

// The file's content, checked against its CRC-32. The caller frees `owned`, which is NULL if the
// content is part of the archive. Fails the reader for other methods, damage, and beyond the
// budget.
Result zip_read(Zip *zip, const ZipFile *file, Bytes *content, uint8_t **owned);

typedef struct ZipWriter {
    OutFile *out;
    uint8_t *directory; // central, owned
    size_t size, room;
    uint64_t at; // bytes written
    uint32_t count;
    bool failed; // out of memory, or beyond 4 GiB
} ZipWriter;

// Adds a file made of two parts.
void zip_add(ZipWriter *writer, const char *name, const void *head, size_t head_size,
             const void *body, size_t body_size);

// Writes the directory. RESULT_FAILED when memory was short or the archive exceeds 4 GiB.
Result zip_finish(ZipWriter *writer, Error *error);
