// SPDX-License-Identifier: MIT
// The files of a zip archive, stored or deflated, after PKWARE's "APPNOTE.TXT - .ZIP File Format
// Specification" 6.3: read by the central directory, so that sizes behind the data (data
// descriptors) and zip64 make no difference; written stored, with the same bytes from run to run.
#pragma once

#include "base/outfile.h"
#include "base/reader.h"

enum { ZIP_NAME_SIZE = 80, ZIP_MOST_FILES = 256 };

// Deflated files that are held at a time have at most so many times the archive's bytes, and as
// many MiB. What becomes of a byte takes at most 9: so the memory stays below 64 times the archive
// and 64 MB, whatever it claims to hold.
enum { ZIP_MOST_TIMES = 7 };

typedef struct ZipFile {
    char name[ZIP_NAME_SIZE]; // cut if it is longer
    uint32_t method, crc;     // method: 0 stored, 8 deflated
    uint64_t packed, size;    // bytes in the archive, and unpacked
    uint64_t at;              // of the packed bytes
} ZipFile;

typedef struct Zip {
    Reader *reader;
    ZipFile *file; // [count] owned
    uint32_t count;
    uint64_t
        budget; // bytes that may still be unpacked, ZIP_MOST_TIMES the archive's and as many MiB
} Zip;

// Reads the directory. Fails the reader where it is damaged, a file is encrypted or lies outside
// the archive. May be closed in any case.
Result zip_open(Zip *zip, Reader *reader);
void zip_close(Zip *zip);

// The file's content, checked against its CRC-32. `owned` is to be freed, or NULL where the
// content lies in the archive. Fails the reader at other methods, damage, and beyond the budget.
Result zip_read(Zip *zip, const ZipFile *file, Bytes *content, uint8_t **owned);

typedef struct ZipWriter {
    OutFile *out;
    uint8_t *directory; // central, owned
    size_t size, room;
    uint64_t at; // bytes written
    uint32_t count;
    bool failed; // no memory, or beyond 4 GiB
} ZipWriter;

// A file of two parts, one behind the other.
void zip_add(ZipWriter *writer, const char *name, const void *head, size_t head_size,
             const void *body, size_t body_size);

// Writes the directory. RESULT_FAILED when memory was short or the archive is beyond 4 GiB.
Result zip_finish(ZipWriter *writer, Error *error);
