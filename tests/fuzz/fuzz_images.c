// SPDX-License-Identifier: MIT
// Images: PNG, PFM and EXR.
#include "fuzz/fuzz.h"
#include "image/exr_file.h"
#include "image/pfm.h"
#include "image/png.h"

#include <math.h>
#include <string.h>

void fuzz_png(const Bytes *bytes, int unused);
void fuzz_pfm(const Bytes *bytes, int unused);
void fuzz_exr(const Bytes *bytes, int unused);

static void claim_image(const Image *image)
{
    fuzz_claim(image->width > 0 && image->height > 0, "%d x %d pixels", image->width,
               image->height);
    fuzz_claim(image->channels == 3 || image->channels == 4, "%d channels", image->channels);
    if (image->kind != IMAGE_FLOAT) return;
    const float *level = (const void *)image->pixels;
    for (size_t i = 0; i < image_size(image) / sizeof *level; ++i)
        fuzz_claim(isfinite(level[i]), "a level of %g", (double)level[i]);
}

static void claim_same(const Image *a, const Image *b)
{
    fuzz_claim(a->width == b->width && a->height == b->height && a->channels == b->channels &&
                   a->kind == b->kind && memcmp(a->pixels, b->pixels, image_size(a)) == 0,
               "written, the image reads back another");
}

void fuzz_png(const Bytes *bytes, int unused)
{
    (void)unused;
    Bytes copy = *bytes, again = {0};
    Image image = {0}, second = {0};
    ImageTexts texts = {0};
    Error error = {{0}};
    fuzz_repair_png(&copy);
    Result result = png_decode_texts(&texts, &copy, "x.png", &error);
    fuzz_claim_error(result, &error);
    result = png_decode_deep(&image, &copy, "x.png", &error);
    fuzz_claim_error(result, &error);
    if (result == RESULT_OK) {
        claim_image(&image);
        result = png_encode(&image, &texts, &again, &error);
        THEN(result, png_decode_deep(&second, &again, "again.png", &error));
        fuzz_claim(result == RESULT_OK, "written, but not read back: %s", error.text);
        claim_same(&image, &second);
    }
    image_texts_destroy(&texts);
    image_destroy(&image);
    image_destroy(&second);
    bytes_destroy(&again);
}

void fuzz_pfm(const Bytes *bytes, int unused)
{
    (void)unused;
    Image image = {0}, second = {0};
    Bytes again = {0};
    Error error = {{0}};
    Result result = pfm_decode(&image, bytes, "x.pfm", &error);
    fuzz_claim_error(result, &error);
    if (result == RESULT_OK) {
        claim_image(&image);
        result = pfm_encode(&image, &again, &error);
        THEN(result, pfm_decode(&second, &again, "again.pfm", &error));
        fuzz_claim(result == RESULT_OK, "written, but not read back: %s", error.text);
        claim_same(&image, &second);
    }
    image_destroy(&image);
    image_destroy(&second);
    bytes_destroy(&again);
}

// Written files have blocks of 16 rows. For an image much wider than high, the library needs more
// memory than such a small file may cause.
enum { WIDEST_WRITTEN = 65536 };

void fuzz_exr(const Bytes *bytes, int unused)
{
    (void)unused;
    Image image = {0}, second = {0};
    ImageTexts texts = {0};
    Bytes again = {0};
    Error error = {{0}};
    Result result = exr_file_decode_texts(&texts, bytes, "x.exr", &error);
    fuzz_claim_error(result, &error);
    result = exr_file_decode(&image, bytes, "x.exr", &error);
    fuzz_claim_error(result, &error);
    if (result == RESULT_OK) claim_image(&image);
    if (result == RESULT_OK && image.width <= WIDEST_WRITTEN) {
        const ExrFile file = {.image = &image, .floats = true};
        result = exr_file_encode(&file, &again, &error);
        THEN(result, exr_file_decode(&second, &again, "again.exr", &error));
        fuzz_claim(result == RESULT_OK, "written, but not read back: %s", error.text);
        claim_same(&image, &second);
    }
    image_texts_destroy(&texts);
    image_destroy(&image);
    image_destroy(&second);
    bytes_destroy(&again);
}
