// SPDX-License-Identifier: MIT
// Raw video: the header, the planes by BT.709, and the size that is told.
#include "run/y4m.h"

#include "base/bytes.h"
#include "support/needed.h"
#include "support/temporary.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { WIDTH = 9, HEIGHT = 7, COUNT = WIDTH * HEIGHT, FRAMES = 3 };

static uint8_t colour(int frame, int pixel, int c)
{
    return (uint8_t)(pixel < 2 ? 255 * pixel : (37 * frame + 83 * pixel + 101 * c * pixel) % 256);
}

// ITU-R BT.709: luma from 16 to 235, chroma from 16 to 240.
static double expected(int plane, const double rgb[3])
{
    const double luma = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
    if (plane == 0) return 16 + 219 * luma;
    return 128 + 224 * (plane == 1 ? (rgb[2] - luma) / 1.8556 : (rgb[0] - luma) / 1.5748);
}

static Bytes write_video(const char *path, double fps)
{
    Image image;
    Y4m y4m;
    Bytes file = {0};
    NEEDED(image_create(&image, WIDTH, HEIGHT, 3, error));
    NEEDED(y4m_create(&y4m, path, WIDTH, HEIGHT, fps, error));
    for (int frame = 0; frame < FRAMES; ++frame) {
        for (int i = 0; i < 3 * COUNT; ++i) image.pixels[i] = colour(frame, i / 3, i % 3);
        NEEDED(y4m_write(&y4m, &image, error));
    }
    NEEDED(y4m_finish(&y4m, error));
    NEEDED(bytes_read_file(&file, path, error));
    assert_int_equal(y4m.bytes, file.size);
    y4m_destroy(&y4m);
    image_destroy(&image);
    return file;
}

static void frames_are_converted_and_counted(void **state)
{
    Bytes file = write_video(temporary_path(state, "a.y4m"), 24);
    const uint8_t *at = file.data;
    size_t head = (size_t)((const uint8_t *)memchr(at, '\n', file.size) + 1 - at);
    assert_int_equal(file.size, head + FRAMES * (6 + 3 * COUNT));
    at += head;
    for (int frame = 0; frame < FRAMES; ++frame) {
        assert_memory_equal(at, "FRAME\n", 6);
        at += 6;
        for (int i = 0; i < 3 * COUNT; ++i, ++at) {
            double rgb[3];
            for (int c = 0; c < 3; ++c) rgb[c] = colour(frame, i % COUNT, c) / 255.0;
            // Rounded, with factors of 16 bits.
            if (!(fabs(*at - expected(i / COUNT, rgb)) < 0.51))
                fail_msg("frame %d, byte %d: %d: expected %g", frame, i, *at,
                         expected(i / COUNT, rgb));
        }
    }
    bytes_destroy(&file);
}

static void rates_are_fractions_without_common_factors(void **state)
{
    static const struct {
        double fps;
        const char *fraction;
    } RATES[] = {
        {24, " F24:1 "}, {29.97, " F30000:1001 "}, {23.976, " F24000:1001 "}, {12.5, " F25:2 "}};
    for (size_t i = 0; i < sizeof RATES / sizeof *RATES; ++i) {
        Bytes file = write_video(temporary_path(state, "a.y4m"), RATES[i].fps);
        char head[200] = "";
        memcpy(head, file.data, file.size < sizeof head ? file.size : sizeof head - 1);
        *strchr(head, '\n') = '\0';
        assert_non_null(strstr(head, "YUV4MPEG2 W9 H7 "));
        assert_non_null(strstr(head, " C444"));
        if (!strstr(head, RATES[i].fraction)) fail_msg("%s: expected%s", head, RATES[i].fraction);
        bytes_destroy(&file);
    }
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, temporary_create, temporary_destroy)

int main(void)
{
    const struct CMUnitTest tests[] = {TEST(frames_are_converted_and_counted),
                                       TEST(rates_are_fractions_without_common_factors)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
