// SPDX-License-Identifier: MIT
#include "support/grey_frames.h"

#include "image/png.h"

#include <setjmp.h>
#include <stdarg.h>
#include <string.h>

#include <cmocka.h>

OutputOptions grey_options(const char *target, int channels)
{
    return (OutputOptions){.target = target,
                           .width = GREY_WIDTH,
                           .height = GREY_HEIGHT,
                           .channels = channels,
                           .fps = 25.0};
}

uint8_t grey_of_frame(int frame)
{
    return (uint8_t)(20 + 10 * frame);
}

void grey_fill(Image *image, int frame)
{
    memset(image->pixels, grey_of_frame(frame),
           (size_t)image->width * (size_t)image->height * (size_t)image->channels);
}

Result grey_draw(Output *output, int count, Error *error)
{
    Result result = RESULT_OK;
    for (int frame = 0; frame < count && result == RESULT_OK; frame++) {
        Image *image;
        result = output_acquire(output, &image, error);
        if (result != RESULT_OK) break;
        grey_fill(image, frame);
        result = output_submit(output, frame, image, error);
    }
    return result;
}

Result grey_write(const OutputOptions *options, int count, Error *error)
{
    Output *output;
    Result result = output_create(&output, options, error);
    if (result == RESULT_OK) result = grey_draw(output, count, error);
    if (result == RESULT_OK) result = output_finish(output, error);
    output_destroy(output);
    return result;
}

void grey_assert_frame(const char *path, int frame, int channels)
{
    Error error;
    Image image;
    assert_int_equal(png_read(&image, path, &error), RESULT_OK);
    assert_int_equal(image.width, GREY_WIDTH);
    assert_int_equal(image.height, GREY_HEIGHT);
    assert_int_equal(image.channels, channels);
    for (int i = 0; i < GREY_WIDTH * GREY_HEIGHT * channels; i++)
        assert_int_equal(image.pixels[i], grey_of_frame(frame));
    image_destroy(&image);
}

void grey_assert_line(const Error *error, const char *part)
{
    assert_null(strchr(error->text, '\n'));
    if (!strstr(error->text, part)) fail_msg("'%s' lacks '%s'", error->text, part);
}
