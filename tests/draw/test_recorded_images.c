// SPDX-License-Identifier: MIT
// Small images of all rasterisers, lights and looks, as means of blocks of pixels, compared with
// recorded ones (support/recorded.h).
#include "scene/camera.h"
#include "support/needed.h"
#include "support/recorded.h"

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>

enum { BLOCK = 8 };

static double value_at(const Image *image, size_t i)
{
    switch (image->kind) {
    case IMAGE_8:
        return image->pixels[i] / 255.0;
    case IMAGE_16:
        return ((const uint16_t *)(const void *)image->pixels)[i] / 65535.0;
    default:
        return (double)((const float *)(const void *)image->pixels)[i];
    }
}

static void add_means(const Image *image, RecordedNumbers *numbers)
{
    for (int y = 0; y < image->height; y += BLOCK)
        for (int x = 0; x < image->width; x += BLOCK)
            for (int c = 0; c < image->channels; ++c) {
                double sum = 0;
                for (int i = 0; i < BLOCK * BLOCK; ++i)
                    sum +=
                        value_at(image, (size_t)((y + i / BLOCK) * image->width + x + i % BLOCK) *
                                                (size_t)image->channels +
                                            (size_t)c);
                recorded_add(numbers, (float)(sum / (BLOCK * BLOCK)));
            }
}

// Draws frame 0 and, where the scene has more, the last one: as floats, or with the tone map of
// files of 16 bits (--depth 16). --exr-float: also the layers of EXR files.
static void draw(RecordedCase *recorded, RecordedNumbers *numbers)
{
    const RunParams *run = &recorded->scene.run;
    const ImagesForm form = {run->depth == 16 ? IMAGE_16 : IMAGE_FLOAT, run->exr_float};
    Images images;
    Image image = {0}, layers[EXR_LAYERS] = {{0}};
    assert_int_equal(run->size[0] % BLOCK + run->size[1] % BLOCK, 0);
    NEEDED(images_create(&images, &recorded->scene, &recorded->assets, &recorded->simulation,
                         &recorded->framing, &form, recorded->gpu, &recorded->timer, error));
    NEEDED(image_create_kind(&image, run->size[0], run->size[1],
                             renderer_channels(&images.renderer), form.kind, error));
    for (int l = 0; l < EXR_LAYERS && form.layers; ++l)
        NEEDED(image_create_kind(&layers[l], run->size[0], run->size[1], 3, IMAGE_FLOAT, error));
    for (int frame = 0;; frame = run->frames - 1) {
        View view;
        while (recorded->simulation.frame < frame) simulation_advance(&recorded->simulation);
        simulation_pose(&recorded->simulation);
        camera_view(&view, &recorded->scene, &recorded->framing, frame);
        int place = images_place(&images);
        NEEDED(images_begin(&images, frame, &view, &image, layers, error));
        NEEDED(images_settle(&images, error));
        if (images_are_late(&images)) NEEDED(images_take(&images, place, &image, layers, error));
        add_means(&image, numbers);
        for (int l = 0; l < EXR_LAYERS && form.layers; ++l) add_means(&layers[l], numbers);
        if (frame == run->frames - 1) break;
    }
    image_destroy(&image);
    for (int l = 0; l < EXR_LAYERS; ++l) image_destroy(&layers[l]);
    images_destroy(&images);
}

// With llvmpipe, images of vectors of 128 bits and of a processor with SSE2 only differ from the
// recorded ones by at most 0.043 of 1e-3 of a value and 1e-4 of the image's root mean square
// together; these limits are about five times that. Other drivers may draw an edge in another
// pixel.
static const RecordedLimits LIMITS = {2e-4f, 2e-5f, 0.05f, 0.02f};

static void test_images(void **state)
{
    (void)state;
    recorded_check("images", &LIMITS, draw);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_images)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
