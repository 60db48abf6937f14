// SPDX-License-Identifier: MIT
#include "image/image_kind.h"

#include <string.h>

const char *image_kind_name(const Bytes *file)
{
    static const struct {
        const char *begin;
        size_t length, at; // `at`: where it stands
        const char *name;
    } kinds[] = {
        {"WEBP", 4, 8, "a WebP image"},
        {"\xff\xd8\xff", 3, 0, "a JPEG image"},
        {"GIF8", 4, 0, "a GIF image"},
        {"II*\0", 4, 0, "a TIFF image"},
        {"MM\0*", 4, 0, "a TIFF image"},
        {"ftypavif", 8, 4, "an AVIF image"},
        {"ftypheic", 8, 4, "a HEIC image"},
        {"8BPS", 4, 0, "a Photoshop image"},
        {"DDS ", 4, 0, "a DirectDraw image (.dds)"},
        {"\xabKTX", 4, 0, "a KTX image"},
        {"\xff\x0a", 2, 0, "a JPEG XL image"},
        {"\0\0\0\x0cJXL ", 8, 0, "a JPEG XL image"},
        {"qoif", 4, 0, "a QOI image"},
        {"#?RADIANCE", 10, 0, "a Radiance image (.hdr)"},
        {"#?RGBE", 6, 0, "a Radiance image (.hdr)"},
        {"v/1\x01", 4, 0, "an EXR image"},
        {"\x89PNG", 4, 0, "a PNG image"},
        {"BM", 2, 0, "a BMP image"},
        {"P6", 2, 0, "a PPM image"},
        {"P5", 2, 0, "a PGM image"},
    };
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; ++i)
        if (file->size >= kinds[i].at + kinds[i].length &&
            memcmp(file->data + kinds[i].at, kinds[i].begin, kinds[i].length) == 0)
            return kinds[i].name;
    return NULL;
}
