// SPDX-License-Identifier: MIT
#include "compare/html.h"

#include "image/exr_file.h"
#include "image/float_image.h"
#include "image/heat_map.h"
#include "image/jpeg.h"
#include "image/png.h"
#include "report/picture.h"
#include "report/shell_words.h"

#include "version.h"

#include <stdlib.h>
#include <string.h>

// The page shows thumbnails at half of this size, for dense screens.
enum { THUMBNAIL_WIDTH = 144, THUMBNAIL_HEIGHT = 108 };

// Images of differing pairs are embedded as PNG, the worst pairs first, until they take this many
// bytes. The remaining pairs are embedded as JPEG.
enum { EXACT_BYTES = 8 << 20 };

// A pair whose images were added to the page twice, as PNG and as JPEG. Once all pairs are known,
// choose_forms keeps one of the two.
struct HtmlChoice {
    json_t *sides[2]; // the JSON objects of A and B; holds a reference to each
    int exact[2], small[2];
    bool has[2];
    size_t bytes; // of the PNG files
    double badness;
    size_t number; // in the order of the list
};

// --- A pair's files.

static void set_text(json_t *object, const char *key, const char *text)
{
    json_object_set_new(object, key, report_text(text));
}

// Chooses the PNG to embed: the file itself if browsers show it as it is, otherwise a converted
// copy.
static Result choose_png(HtmlSide *side, const Image *image, Bytes *file, Error *error)
{
    if (image->kind == IMAGE_8 && picture_is_plain(file)) {
        side->png = *file;
        *file = (Bytes){0};
        return RESULT_OK;
    }
    Image picture;
    TRY(picture_create(&picture, image, error));
    Result result = png_encode(&picture, NULL, &side->png, error);
    image_destroy(&picture);
    return result;
}

// [key, text] for each text of a PNG or EXR file, such as the name of the device. PFM files have no
// texts.
static json_t *list_texts(const Bytes *file, const char *path)
{
    ImageTexts texts;
    json_t *list = json_array();
    Result result = exr_file_is(file) ? exr_file_decode_texts(&texts, file, path, NULL)
                                      : png_decode_texts(&texts, file, path, NULL);
    if (result != RESULT_OK) return list;
    for (size_t i = 0; i < texts.count; ++i) {
        json_t *pair = json_array();
        json_array_append_new(pair, report_text(texts.list[i].key));
        json_array_append_new(pair, report_text(texts.list[i].value));
        json_array_append_new(list, pair);
    }
    image_texts_destroy(&texts);
    return list;
}

// Makes a JPEG of the image for viewing and keeps it if it is smaller than the PNG.
static Result make_small(HtmlSide *side, const Image *image, Error *error)
{
    Image picture;
    if (image->channels != 3 || !side->png.size) return RESULT_OK;
    TRY(picture_create(&picture, image, error));
    Result result = jpeg_encode(&picture, JPEG_SMALL, &side->small, error);
    if (result == RESULT_OK && side->small.size >= side->png.size) bytes_destroy(&side->small);
    image_destroy(&picture);
    return result;
}

static void read_side(HtmlSide *side, Image *image, const char *path)
{
    static const char *const DEPTHS[] = {"8 bits", "16 bits", "float"};
    Bytes file = {0};
    Error error;
    side->facts = json_object();
    *image = (Image){0};
    Result result = float_image_read_image(image, path, &error);
    THEN(result, bytes_read_file(&file, path, &error));
    if (result == RESULT_OK) {
        json_object_set_new(side->facts, "bytes", json_integer((json_int_t)file.size));
        json_object_set_new(side->facts, "width", json_integer(image->width));
        json_object_set_new(side->facts, "height", json_integer(image->height));
        json_object_set_new(side->facts, "depth", json_string(DEPTHS[image->kind]));
        json_object_set_new(side->facts, "alpha", json_boolean(image->channels == 4));
        json_object_set_new(side->facts, "texts", list_texts(&file, path));
        result = choose_png(side, image, &file, &error);
    }
    if (result != RESULT_OK) set_text(side->facts, "error", error.text);
    bytes_destroy(&file);
}

// If memory is short, the pair has no thumbnail and the page shows a placeholder.
static void make_thumbnail(HtmlPair *page, const Image *image)
{
    Image picture = {0}, small = {0};
    Error error;
    Result result = picture_create(&picture, image, &error);
    THEN(result,
         picture_create_thumbnail(&small, &picture, THUMBNAIL_WIDTH, THUMBNAIL_HEIGHT, &error));
    if (image->channels == 3)
        THEN(result, jpeg_encode(&small, JPEG_SMALL, &page->thumbnail, &error));
    else
        THEN(result, png_encode(&small, NULL, &page->thumbnail, &error));
    image_destroy(&picture);
    image_destroy(&small);
}

void html_pair_read(HtmlPair *page, const Pair *pair)
{
    const char *const paths[2] = {pair->a, pair->b};
    const bool there[2] = {pair->has_a, pair->has_b};
    Image image[2] = {{0}};
    *page = (HtmlPair){0};
    for (int i = 0; i < 2; ++i)
        if (there[i]) read_side(&page->side[i], &image[i], paths[i]);
    page->equal = image_is_equal(&image[0], &image[1]);
    for (int i = 1; i >= 0 && !page->thumbnail.size; --i)
        if (image[i].pixels) make_thumbnail(page, &image[i]);
    for (int i = 0; i < 2; ++i) {
        if (image[i].pixels && (i == 1 || !page->equal))
            make_small(&page->side[i], &image[i], NULL); // if this fails, the page has only the PNG
        image_destroy(&image[i]);
    }
}

void html_pair_destroy(HtmlPair *page)
{
    for (int i = 0; i < 2; ++i) {
        bytes_destroy(&page->side[i].png);
        bytes_destroy(&page->side[i].small);
        json_decref(page->side[i].facts);
    }
    bytes_destroy(&page->map);
    bytes_destroy(&page->thumbnail);
    *page = (HtmlPair){0};
}

// --- The page.

Result html_open(Html *html, const char *path, Error *error)
{
    *html = (Html){0};
    TRY(report_open(&html->report, path, error));
    html->pairs = json_array();
    return RESULT_OK;
}

// The command that accepts the pair: it makes B the reference or, if there is no B, removes the
// reference. NULL if no command would help, because B cannot be read, and if memory is short.
static char *accepting_command(const Pair *pair, const Verdict *verdict, const HtmlPair *page)
{
    const char *const update[] = {"tractrix-compare", "--update", "--", pair->a, pair->b, NULL};
    const char *const removal[] = {"rm", "--", pair->a, NULL};
    if (verdict_is_good(verdict) || verdict->outcome == OUTCOME_UNRENDERED) return NULL;
    if (pair->has_b && !page->side[1].png.size) return NULL;
    return shell_join(pair->has_b ? update : removal);
}

static Result add_image(Html *html, json_t *object, const char *key, const Bytes *file,
                        Error *error)
{
    int number;
    if (!file->size) return RESULT_OK;
    TRY(report_add_image(&html->report, file, &number, error));
    json_object_set_new(object, key, json_integer(number));
    return RESULT_OK;
}

static Result add_side(Html *html, json_t *side, const HtmlSide *image, struct HtmlChoice *choice,
                       int i, Error *error)
{
    int *number = &choice->exact[i];
    if (!image->png.size) return RESULT_OK;
    TRY(report_add_image(&html->report, &image->png, number, error));
    json_object_set_new(side, "image", json_integer(*number));
    choice->bytes += image->png.size;
    choice->has[i] = image->small.size > 0;
    if (!choice->has[i]) return RESULT_OK;
    return report_add_image(&html->report, &image->small, &choice->small[i], error);
}

// Adds the images of a differing pair in both forms; choose_forms drops one of the two when the
// page is closed.
static Result add_sides(Html *html, json_t *sides[2], const HtmlPair *page, const Verdict *verdict,
                        Error *error)
{
    struct HtmlChoice choice = {.badness = verdict->measured ? verdict->figures.flip : 2,
                                .number = html->choice_count};
    struct HtmlChoice *list = realloc(html->choices, (html->choice_count + 1) * sizeof *list);
    if (!list) return error_set(error, RESULT_FAILED, "no memory for the page's images");
    html->choices = list;
    for (int i = 1; i >= 0; --i) TRY(add_side(html, sides[i], &page->side[i], &choice, i, error));
    for (int i = 0; i < 2; ++i) choice.sides[i] = json_incref(sides[i]);
    list[html->choice_count++] = choice;
    return RESULT_OK;
}

static int order(const void *a, const void *b)
{
    const struct HtmlChoice *x = a, *y = b;
    if (x->badness != y->badness) return x->badness < y->badness ? 1 : -1;
    return (x->number > y->number) - (x->number < y->number);
}

// Keeps the PNG for the worst pairs, as many as fit into EXACT_BYTES.
static void choose_forms(Html *html)
{
    size_t bytes = 0;
    if (html->choice_count) qsort(html->choices, html->choice_count, sizeof *html->choices, order);
    for (size_t c = 0; c < html->choice_count; ++c) {
        const struct HtmlChoice *choice = &html->choices[c];
        bytes += choice->bytes;
        for (int i = 0; i < 2; ++i) {
            if (!choice->has[i]) continue;
            bool exact = bytes <= EXACT_BYTES;
            report_omit_image(&html->report, exact ? choice->small[i] : choice->exact[i]);
            if (exact) continue;
            json_object_set_new(choice->sides[i], "image", json_integer(choice->small[i]));
            json_object_set_new(choice->sides[i], "lossy", json_true());
        }
    }
}

Result html_add(Html *html, const Pair *pair, const Verdict *verdict, const HtmlPair *page,
                Error *error)
{
    json_t *object = verdict_to_json(verdict, pair), *sides[2];
    char *accept = accepting_command(pair, verdict, page);
    for (int i = 0; i < 2; ++i)
        sides[i] = page->side[i].facts ? json_incref(page->side[i].facts) : json_object();
    set_text(object, "name", pair->name);
    set_text(sides[0], "path", pair->a);
    set_text(sides[1], "path", pair->b);
    if (verdict->text[0]) set_text(object, "text", verdict->text);
    if (accept) set_text(object, "accept", accept);
    json_object_set_new(object, "thumbnail", report_base64(&page->thumbnail));
    json_object_set_new(object, "equal", json_boolean(page->equal));
    Result result;
    if (page->equal) {
        bool lossy = page->side[1].small.size > 0;
        result = add_image(html, sides[1], "image",
                           lossy ? &page->side[1].small : &page->side[1].png, error);
        if (lossy) json_object_set_new(sides[1], "lossy", json_true());
        json_object_set(sides[0], "image", json_object_get(sides[1], "image"));
    } else {
        result = add_sides(html, sides, page, verdict, error);
    }
    THEN(result, add_image(html, object, "map", &page->map, error));
    json_object_set_new(object, "a", sides[0]);
    json_object_set_new(object, "b", sides[1]);
    json_array_append_new(html->pairs, object);
    free(accept);
    return result;
}

// The colours of the heat map from 0 to 1 in even steps, for the page's legend.
static json_t *list_colors(void)
{
    json_t *list = json_array();
    for (int i = 0; i < HEAT_MAP_STEPS; ++i) {
        uint8_t rgb[3];
        heat_map_color(rgb, (float)i / (HEAT_MAP_STEPS - 1));
        json_array_append_new(list, json_pack("[i, i, i]", rgb[0], rgb[1], rgb[2]));
    }
    return list;
}

Result html_close(Html *html, const PairList *list, const CompareLimits limits[LEVELS],
                  const char *command, Error *error)
{
    json_t *data = json_object();
    choose_forms(html);
    set_text(data, "program", "tractrix-compare " TRACTRIX_VERSION);
    set_text(data, "command", command);
    json_object_set_new(data, "limits", verdict_limits_to_json(limits, list));
    json_object_set_new(data, "images", json_integer((json_int_t)list->count));
    json_object_set_new(data, "many", json_boolean(list->many));
    json_object_set_new(data, "colors", list_colors());
    json_object_set(data, "pairs", html->pairs);
    Result result = report_close(&html->report, "compare", data, error);
    json_decref(data);
    html_discard(html);
    return result;
}

void html_discard(Html *html)
{
    report_discard(&html->report);
    for (size_t c = 0; c < html->choice_count; ++c)
        for (int i = 0; i < 2; ++i) json_decref(html->choices[c].sides[i]);
    free(html->choices);
    json_decref(html->pairs);
    *html = (Html){0};
}
