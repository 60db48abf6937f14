// SPDX-License-Identifier: MIT
#include "pfm.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void put_little_endian(uint8_t *to, const uint8_t *from)
{
    uint32_t bits;
    memcpy(&bits, from, sizeof bits);
    for (int k = 0; k < 4; ++k) to[k] = (uint8_t)(bits >> 8 * k);
}

Result pfm_encode(const Image *image, Bytes *pfm, Error *error)
{
    assert(image->kind == IMAGE_FLOAT);
    char header[64];
    size_t head = (size_t)snprintf(header, sizeof header, "PF\n%d %d\n-1.0\n", image->width,
                                   image->height),
           width = (size_t)image->width, row = 12 * width,
           pitch = width * (size_t)image->channels * 4;
    *pfm = (Bytes){.size = head + row * (size_t)image->height};
    pfm->data = malloc(pfm->size + 1);
    if (!pfm->data) {
        *pfm = (Bytes){0};
        return error_set(error, RESULT_FAILED, "no memory to encode an image of %d x %d",
                         image->width, image->height);
    }
    memcpy(pfm->data, header, head);
    for (int y = 0; y < image->height; ++y) {
        const uint8_t *from = image->pixels + (size_t)(image->height - 1 - y) * pitch;
        uint8_t *to = pfm->data + head + (size_t)y * row;
        for (size_t i = 0; i < 3 * width; ++i)
            put_little_endian(to + 4 * i, from + 4 * (i / 3 * (size_t)image->channels + i % 3));
    }
    pfm->data[pfm->size] = 0;
    return RESULT_OK;
}
