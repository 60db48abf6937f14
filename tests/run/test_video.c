// SPDX-License-Identifier: MIT
// Videos by the real ffmpeg; failures of ffmpeg are tested in test_output.c.
#include "base/bytes.h"
#include "run/video.h"
#include "support/temporary.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { WIDTH = 65, HEIGHT = 33, FRAMES = 12 };

static void need_ffmpeg(void)
{
    if (system("ffmpeg -version >/dev/null 2>&1 && ffprobe -version >/dev/null 2>&1") == 0) return;
    puts("skipped: ffmpeg is not installed");
    skip();
}

// Each frame has one grey; frames differ by 20 levels, which survives any encoder.
static int grey_of_frame(int frame)
{
    return 20 + 20 * frame;
}

static void write_video(const char *path, int channels)
{
    Error error;
    Video *video;
    VideoOptions options = {
        .path = path, .width = WIDTH, .height = HEIGHT, .channels = channels, .fps = 25.0};
    Image image;
    uint64_t bytes;
    assert_int_equal(image_create(&image, WIDTH, HEIGHT, channels, &error), RESULT_OK);
    assert_int_equal(video_create(&video, &options, &error), RESULT_OK);
    for (int frame = 0; frame < FRAMES; frame++) {
        for (int i = 0; i < WIDTH * HEIGHT * channels; i++)
            image.pixels[i] = i % channels == 3 ? 128 : (uint8_t)grey_of_frame(frame);
        assert_int_equal(video_write(video, &image, &error), RESULT_OK);
    }
    assert_int_equal(video_finish(video, &bytes, &error), RESULT_OK);
    video_destroy(video);
    image_destroy(&image);
    Bytes file;
    assert_int_equal(bytes_read_file(&file, path, &error), RESULT_OK);
    assert_int_equal(file.size, bytes);
    bytes_destroy(&file);
}

// Runs a command with the file's name at its end and returns its output, size - 1 bytes at most.
static size_t run(const char *command, const char *path, const char *tail, char *text, size_t size)
{
    char line[1200];
    snprintf(line, sizeof line, "%s '%s' %s", command, path, tail);
    FILE *pipe = popen(line, "r");
    assert_non_null(pipe);
    size_t length = fread(text, 1, size - 1, pipe);
    text[length] = 0;
    assert_int_equal(pclose(pipe), 0);
    return length;
}

static void assert_streams(const char *path, const char *expected)
{
    char text[300];
    run("ffprobe -v error -count_frames -of csv=p=0 -show_entries "
        "stream=codec_name,width,height,r_frame_rate,nb_read_frames",
        path, "", text, sizeof text);
    text[strcspn(text, "\n")] = 0;
    assert_string_equal(text, expected);
}

// Players that are not told guess the matrix by the height, and small pictures change their
// colours.
static void assert_says_bt709(const char *path)
{
    char text[200];
    run("ffprobe -v error -of csv=p=0 -show_entries "
        "stream=color_range,color_space,color_transfer,color_primaries",
        path, "", text, sizeof text);
    text[strcspn(text, "\n")] = 0;
    assert_string_equal(text, "tv,bt709,bt709,bt709");
}

// Decodes to one grey byte per pixel and compares each frame's corners, including padding.
static void assert_greys(const char *path, int width, int height)
{
    size_t frame_size = (size_t)(width * height), size = frame_size * (FRAMES + 1);
    char *pixels = malloc(size + 1);
    assert_non_null(pixels);
    size_t length =
        run("ffmpeg -v error -nostdin -i", path,
            "-f rawvideo -vsync 0 -vf scale=out_range=pc -pix_fmt gray -", pixels, size);
    assert_int_equal(length, frame_size * FRAMES);
    for (int frame = 0; frame < FRAMES; frame++)
        for (int corner = 0; corner < 2; corner++) {
            size_t at = (size_t)frame * frame_size + (corner ? frame_size - 1 : 0);
            assert_in_range((uint8_t)pixels[at], grey_of_frame(frame) - 5,
                            grey_of_frame(frame) + 5);
        }
    free(pixels);
}

static void mp4_has_every_frame_in_order_at_an_even_size(void **state)
{
    need_ffmpeg();
    const char *path = temporary_path(state, "x.mp4");
    write_video(path, 3);
    assert_streams(path, "h264,66,34,25/1,12");
    assert_greys(path, 66, 34);
    assert_says_bt709(path);
    assert_int_equal(temporary_count_files(temporary_path(state, ".")), 1);
}

static void webm_has_every_frame_in_order(void **state)
{
    need_ffmpeg();
    const char *path = temporary_path(state, "x.webm");
    write_video(path, 3);
    assert_streams(path, "vp9,65,33,25/1,12");
    assert_greys(path, 65, 33);
    assert_says_bt709(path);
}

static void gif_has_every_frame_in_order(void **state)
{
    need_ffmpeg();
    const char *path = temporary_path(state, "x.gif");
    write_video(path, 3);
    assert_streams(path, "gif,65,33,25/1,12");
    assert_greys(path, 65, 33);
}

static void webm_keeps_transparency(void **state)
{
    need_ffmpeg();
    const char *path = temporary_path(state, "x.webm");
    char pixel[WIDTH * HEIGHT * 4 + 1];
    write_video(path, 4);
    run("ffmpeg -v error -nostdin -c:v libvpx-vp9 -i", path,
        "-frames:v 1 -f rawvideo -pix_fmt rgba -", pixel, sizeof pixel);
    assert_in_range((uint8_t)pixel[3], 123, 133);
}

// A column that is repeated or left alone is black; one whose chroma comes from the next row, too,
// is red.
static void the_last_of_an_odd_number_of_columns_keeps_its_colour(void **state)
{
    need_ffmpeg();
    for (int channels = 3; channels <= 4; channels++) {
        Error error;
        Video *video;
        Image image;
        uint64_t bytes;
        char pixels[WIDTH * HEIGHT * 3 + 1];
        const char *path = temporary_path(state, "red.webm");
        VideoOptions options = {
            .path = path, .width = WIDTH, .height = HEIGHT, .channels = channels, .fps = 25.0};
        assert_int_equal(image_create(&image, WIDTH, HEIGHT, channels, &error), RESULT_OK);
        for (int i = 0; i < WIDTH * HEIGHT * channels; i++)
            image.pixels[i] = i % channels == 3 || i % (WIDTH * channels) == 0 ? 255 : 0;
        assert_int_equal(video_create(&video, &options, &error), RESULT_OK);
        assert_int_equal(video_write(video, &image, &error), RESULT_OK);
        assert_int_equal(video_finish(video, &bytes, &error), RESULT_OK);
        video_destroy(video);
        image_destroy(&image);
        run("ffmpeg -v error -nostdin -i", path, "-f rawvideo -pix_fmt rgb24 -", pixels,
            sizeof pixels);
        for (int row = 0; row < HEIGHT; row++)
            assert_in_range((uint8_t)pixels[3 * ((row + 1) * WIDTH - 1)], 0, 12);
    }
}

static void the_same_frames_give_the_same_bytes(void **state)
{
    need_ffmpeg();
    static const char *const suffixes[] = {"mp4", "webm", "gif"};
    for (int i = 0; i < 3; i++) {
        char names[2][20];
        Bytes files[2];
        for (int k = 0; k < 2; k++) {
            snprintf(names[k], sizeof names[k], "%d.%s", k, suffixes[i]);
            write_video(temporary_path(state, names[k]), 3);
            assert_int_equal(bytes_read_file(&files[k], temporary_path(state, names[k]), NULL),
                             RESULT_OK);
        }
        assert_int_equal(files[0].size, files[1].size);
        assert_memory_equal(files[0].data, files[1].data, files[0].size);
        bytes_destroy(&files[0]);
        bytes_destroy(&files[1]);
    }
}

static void any_character_may_stand_in_the_name(void **state)
{
    need_ffmpeg();
    const char *path = temporary_path(state, "-a b:c%d*;$(x)\".mp4");
    write_video(path, 3);
    assert_streams(path, "h264,66,34,25/1,12");
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, temporary_create, temporary_destroy)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(mp4_has_every_frame_in_order_at_an_even_size),
        TEST(webm_has_every_frame_in_order),
        TEST(gif_has_every_frame_in_order),
        TEST(webm_keeps_transparency),
        TEST(the_last_of_an_odd_number_of_columns_keeps_its_colour),
        TEST(the_same_frames_give_the_same_bytes),
        TEST(any_character_may_stand_in_the_name),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
