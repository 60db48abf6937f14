// SPDX-License-Identifier: MIT
#include "base/chunk.h"
#include "fuzz/fuzz.h"

#include <libdeflate.h>
#include <string.h>

static uint32_t big32(const uint8_t *at)
{
    return (uint32_t)at[0] << 24 | (uint32_t)at[1] << 16 | (uint32_t)at[2] << 8 | at[3];
}

static uint32_t little32(const uint8_t *at)
{
    return (uint32_t)at[3] << 24 | (uint32_t)at[2] << 16 | (uint32_t)at[1] << 8 | at[0];
}

static void put_little32(uint8_t *at, uint32_t value)
{
    for (int i = 0; i < 4; ++i) at[i] = (uint8_t)(value >> 8 * i);
}

// Chunks of length, type, data and CRC after 8 bytes (ISO/IEC 15948, 5.3).
void fuzz_repair_png(Bytes *bytes)
{
    for (size_t at = 8; at + 12 <= bytes->size;) {
        size_t length = big32(bytes->data + at);
        if (length > bytes->size - at - 12) return;
        uint8_t *crc = bytes->data + at + 8 + length;
        uint32_t value = libdeflate_crc32(0, bytes->data + at + 4, length + 4);
        for (int i = 0; i < 4; ++i) crc[i] = (uint8_t)(value >> (24 - 8 * i));
        at += length + 12;
    }
}

// Entries of the central directory and their local headers (APPNOTE 4.3).
void fuzz_repair_zip(Bytes *bytes)
{
    enum { CENTRAL = 46, LOCAL = 30 };
    for (size_t at = 0; at + CENTRAL <= bytes->size; ++at) {
        uint8_t *entry = bytes->data + at;
        if (memcmp(entry, "PK\1\2", 4) != 0) continue;
        size_t size = little32(entry + 20), local = little32(entry + 42);
        if (local > bytes->size || bytes->size - local < LOCAL) continue;
        uint8_t *head = bytes->data + local;
        size_t start = local + LOCAL + head[26] + 256u * head[27] + head[28] + 256u * head[29];
        bool stored = entry[10] == 0 && entry[11] == 0;
        if (!stored || start > bytes->size || size > bytes->size - start) continue;
        uint32_t crc = libdeflate_crc32(0, bytes->data + start, size);
        put_little32(entry + 16, crc);
        put_little32(head + 14, crc);
    }
}

// Tag, number, size (8 bytes), checksum of the payload, checksum of these 20 bytes.
void fuzz_repair_chunks(Bytes *bytes)
{
    size_t at = CHUNK_FILE_HEADER_BYTES;
    while (at + CHUNK_HEADER_BYTES <= bytes->size) {
        uint8_t *header = bytes->data + at;
        size_t left = bytes->size - at - CHUNK_HEADER_BYTES;
        size_t size = little32(header + 8);
        bool whole = little32(header + 12) == 0 && size <= left;
        if (whole)
            put_little32(header + 16, libdeflate_crc32(0, header + CHUNK_HEADER_BYTES, size));
        put_little32(header + 20, libdeflate_crc32(0, header, 20));
        if (!whole) return;
        at += CHUNK_HEADER_BYTES + size;
    }
}
