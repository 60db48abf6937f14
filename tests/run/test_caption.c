// SPDX-License-Identifier: MIT
// The text of captions and their position in the corner.
#include "run/caption.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static void only_known_words_are_taken(void **state)
{
    (void)state;
    Error error;
    static const char *const good[] = {"", "frame", "solver,file", "frame,time,file,solver,frame"};
    static const char *const bad[] = {"frames", "frame,", ",", "frame, time", "Frame"};
    for (int i = 0; i < 4; ++i) assert_int_equal(caption_check(good[i], &error), RESULT_OK);
    for (int i = 0; i < 5; ++i) assert_int_equal(caption_check(bad[i], &error), RESULT_USAGE);
    assert_non_null(strstr(error.text, "got 'Frame'"));
}

static void every_word_says_its_part(void **state)
{
    (void)state;
    char solver[] = "split", caption[] = "frame,time,file,solver", none[] = "";
    char head[] = "a/b/head.tfx", beard[] = "b\xc3\xa4rt.hair";
    Section sections[] = {{.file = head, .params = {.algo = solver}},
                          {.file = beard, .params = {.algo = solver}}};
    Scene scene = {.sections = sections, .section_count = 2};
    scene.run.fps = 24, scene.run.speed = 0.5f;
    scene.run.caption = caption;
    char text[CAPTION_BYTES];
    caption_write(text, &scene, 36);
    assert_string_equal(text, "frame 36   0.75 s   head.tfx, b\?\?rt.hair   split");
    scene.run.caption = none;
    caption_write(text, &scene, 36);
    assert_string_equal(text, "");
}

// Counts the pixels that differ from the uniform background, and those of them outside the lowest
// 20 rows.
static void count_changed(const Image *image, int *changed, int *outside)
{
    size_t pixel = (size_t)image->channels * image_channel_size(image->kind);
    *changed = *outside = 0;
    for (int i = 0; i < image->width * image->height; ++i)
        for (size_t k = 0; k < pixel; ++k)
            if (image->pixels[(size_t)i * pixel + k] != 99) {
                ++*changed;
                *outside += i / image->width < image->height - 20;
                break;
            }
}

static void text_is_drawn_in_its_corner_and_cut_off(void **state)
{
    (void)state;
    Error error;
    char longest[CAPTION_BYTES];
    memset(longest, 'W', sizeof longest);
    longest[CAPTION_BYTES - 1] = 0;
    for (int width = 1; width < 400; width += 133)
        for (int kind = 0; kind < 4; ++kind) {
            Image image;
            int changed, outside;
            assert_int_equal(image_create_kind(&image, width, width == 1 ? 1 : 100, 3 + kind % 2,
                                               kind < 2 ? IMAGE_8 : IMAGE_16, &error),
                             RESULT_OK);
            memset(image.pixels, 99, image_size(&image));
            caption_draw(&image, "");
            count_changed(&image, &changed, &outside);
            assert_int_equal(changed, 0);
            caption_draw(&image, longest);
            count_changed(&image, &changed, &outside);
            assert_int_equal(outside, 0);
            if (width > 1) assert_true(changed > 100);
            image_destroy(&image);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(only_known_words_are_taken),
        cmocka_unit_test(every_word_says_its_part),
        cmocka_unit_test(text_is_drawn_in_its_corner_and_cut_off),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
