// SPDX-License-Identifier: MIT
#include "run/y4m.h"
#include "base/rate.h"

#include <math.h>
#include <stdlib.h>

Result y4m_create(Y4m *y4m, const char *path, int width, int height, double fps, Error *error)
{
    size_t size = 3 * (size_t)width * (size_t)height;
    long frames, seconds;
    *y4m = (Y4m){.width = width, .height = height, .planes = malloc(size)};
    if (!y4m->planes) return error_set(error, RESULT_FAILED, "%s: no memory", path);
    TRY(outfile_open(&y4m->file, path, error));
    rate_fraction(rate_snap(fps), &frames, &seconds);
    int head =
        fprintf(y4m->file.stream, "YUV4MPEG2 W%d H%d F%ld:%ld Ip A1:1 C444 XCOLORRANGE=LIMITED\n",
                width, height, frames, seconds);
    y4m->bytes = head > 0 ? (uint64_t)head : 0;
    return RESULT_OK;
}

// Conversion to Y'CbCr by ITU-R BT.709, sections 3.2 to 3.4 and 4.6, in units of 2^-16. R, G and B
// have 255 steps; luma has 219, chroma 224. The chroma of grey is exactly 128.
static void convert(const Image *image, uint8_t *planes)
{
    enum { HALF = 1 << 15, SHIFT = 16 };
    const double kr = 0.2126, kb = 0.0722, kg = 1 - kr - kb, luma = 219 / 255.0 * (1 << SHIFT),
                 blue = 224 / 255.0 / (2 * (1 - kb)) * (1 << SHIFT),
                 red = 224 / 255.0 / (2 * (1 - kr)) * (1 << SHIFT);
    const int32_t yr = (int32_t)lround(kr * luma), yb = (int32_t)lround(kb * luma),
                  yg = (int32_t)lround(luma) - yr - yb, br = (int32_t)lround(-kr * blue),
                  bg = (int32_t)lround(-kg * blue), bb = -br - bg, rb = (int32_t)lround(-kb * red),
                  rg = (int32_t)lround(-kg * red), rr = -rb - rg;
    size_t count = (size_t)image->width * (size_t)image->height;
    uint8_t *y = planes, *u = y + count, *v = u + count;
    for (size_t i = 0; i < count; ++i) {
        int32_t r = image->pixels[3 * i], g = image->pixels[3 * i + 1],
                b = image->pixels[3 * i + 2];
        y[i] = (uint8_t)((yr * r + yg * g + yb * b + (16 << SHIFT) + HALF) >> SHIFT);
        u[i] = (uint8_t)((br * r + bg * g + bb * b + (128 << SHIFT) + HALF) >> SHIFT);
        v[i] = (uint8_t)((rr * r + rg * g + rb * b + (128 << SHIFT) + HALF) >> SHIFT);
    }
}

Result y4m_write(Y4m *y4m, const Image *image, Error *error)
{
    static const char head[] = "FRAME\n";
    size_t size = 3 * (size_t)y4m->width * (size_t)y4m->height;
    convert(image, y4m->planes);
    y4m->bytes += fwrite(head, 1, sizeof head - 1, y4m->file.stream);
    y4m->bytes += fwrite(y4m->planes, 1, size, y4m->file.stream);
    return outfile_check(&y4m->file, error);
}

Result y4m_finish(Y4m *y4m, Error *error)
{
    return outfile_commit(&y4m->file, error);
}

void y4m_destroy(Y4m *y4m)
{
    outfile_discard(&y4m->file);
    free(y4m->planes);
    *y4m = (Y4m){0};
}
