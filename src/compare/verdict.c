// SPDX-License-Identifier: MIT
#include "compare/verdict.h"

#include "base/bytes.h"
#include "base/clock.h"
#include "base/json.h"
#include "base/outfile.h"
#include "base/quote.h"
#include "image/float_image.h"
#include "image/heat_map.h"
#include "image/mask.h"
#include "image/png.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const OUTCOME_NAMES[OUTCOME_COUNT] = {
    "same",    "within limits", "different",  "size mismatch", "new",
    "missing", "unrendered",    "unreadable", "failed"};

// --- One pair.

static bool is_passed(const Verdict *verdict)
{
    return verdict->outcome == OUTCOME_SAME || verdict->outcome == OUTCOME_WITHIN;
}

static void set_outcome(Verdict *verdict, Outcome outcome, const Error *error)
{
    verdict->outcome = outcome;
    memcpy(verdict->text, error->text, sizeof error->text);
}

// Bad input is the image's own fault (OUTCOME_UNREADABLE); any other error, such as no memory, is
// not.
static void set_unreadable(Verdict *verdict, Result result, const Error *error)
{
    set_outcome(verdict, result == RESULT_BAD_INPUT ? OUTCOME_UNREADABLE : OUTCOME_FAILED, error);
}

static void copy_reference(Verdict *verdict, const Pair *pair)
{
    Bytes file = {0};
    Error error;
    Result result = bytes_read_file(&file, pair->b, &error);
    THEN(result, bytes_write_file(&file, pair->a, &error));
    verdict->updated = result == RESULT_OK;
    if (result != RESULT_OK) set_outcome(verdict, OUTCOME_FAILED, &error);
    bytes_destroy(&file);
}

// Whether the file is an image with the same pixels. Its texts may differ.
static bool is_equal(const char *path, const Image *image)
{
    Image other;
    bool equal =
        float_image_read_image(&other, path, NULL) == RESULT_OK && image_is_equal(&other, image);
    image_destroy(&other);
    return equal;
}

static void drop_reference(Verdict *verdict, const Pair *pair)
{
    Error error;
    verdict->dropped = outfile_remove(pair->a, &error) == RESULT_OK;
    verdict->updated |= verdict->dropped && !is_passed(verdict);
    if (!verdict->dropped) set_outcome(verdict, OUTCOME_FAILED, &error);
}

// Without a fallback, B replaces a reference that differs. With a fallback that is equal to the new
// reference, A is removed instead. A reference within the limits stays the reference, so in that
// case A is compared with the fallback.
static void update(Verdict *verdict, const Pair *pair, const Image *b)
{
    bool same = is_passed(verdict);
    Image a = {0};
    bool known =
        !same || (pair->fallback && float_image_read_image(&a, pair->a, NULL) == RESULT_OK);
    if (known && pair->fallback && is_equal(pair->fallback, same ? &a : b))
        drop_reference(verdict, pair);
    else if (!same)
        copy_reference(verdict, pair);
    image_destroy(&a);
}

// Writes the heat map, or a sheet of A, B and the heat map. On success `written` gets the file's
// name.
static Result draw(char **written, const char *path, bool sheet, const Image *a, const Image *b,
                   const float *map, Error *error)
{
    Image image = {0};
    if (!path) return RESULT_OK;
    Result result = sheet ? heat_map_create_sheet(&image, a, b, map, error)
                          : heat_map_create(&image, map, a->width, a->height, error);
    THEN(result, png_write(path, &image, error));
    if (result == RESULT_OK)
        *written = strdup(path); // if memory is short, reports do not name the file
    image_destroy(&image);
    return result;
}

// Encodes the heat map in memory if any pixel differs. Rounds the values in `map` to the few
// colours of a palette.
static Result keep_map(Bytes *png, float *map, const CompareResult *figures, Error *error)
{
    Image image = {0};
    if (!png || figures->equal) return RESULT_OK;
    heat_map_round(map, (size_t)figures->width * (size_t)figures->height);
    Result result = heat_map_create(&image, map, figures->width, figures->height, error);
    THEN(result, png_encode_palette(&image, png, error));
    image_destroy(&image);
    return result;
}

// Whether the same renderer, driver and processor drew both images, as the files say.
static bool are_alike(const Pair *pair)
{
    static const char *const KEYS[] = {"Renderer", "Driver", "CPU"};
    ImageTexts texts[2] = {{0}};
    bool alike = float_image_read_texts(&texts[0], pair->a, NULL) == RESULT_OK &&
                 float_image_read_texts(&texts[1], pair->b, NULL) == RESULT_OK &&
                 image_texts_find(&texts[0], KEYS[0]);
    for (size_t i = 0; i < sizeof KEYS / sizeof *KEYS && alike; ++i) {
        const char *a = image_texts_find(&texts[0], KEYS[i]),
                   *b = image_texts_find(&texts[1], KEYS[i]);
        alike = strcmp(a ? a : "", b ? b : "") == 0;
    }
    for (int i = 0; i < 2; ++i) image_texts_destroy(&texts[i]);
    return alike;
}

static Result measure(Verdict *verdict, float *map, const Pair *pair, const Image images[2],
                      const Mask *mask, const VerdictOptions *options, Error *error)
{
    const Image *a = &images[0], *b = &images[1];
    CompareResult *figures = &verdict->figures;
    TRY(compare_images(figures, map, a, b, mask, &options->limits, error));
    verdict->exact = !figures->equal && options->exact_if_alike && are_alike(pair);
    if (verdict->exact) figures->within = false;
    verdict->measured = true;
    verdict->outcome = figures->equal    ? OUTCOME_SAME
                       : figures->within ? OUTCOME_WITHIN
                                         : OUTCOME_DIFFERENT;
    if (!figures->within || options->draw_all) {
        TRY(draw(&verdict->heat_map, options->heat_map, false, a, b, map, error));
        TRY(draw(&verdict->sheet, options->sheet, true, a, b, map, error));
    }
    return keep_map(options->map, map, figures, error);
}

// The pair's own mask or the mask of all pairs; `mask` is NULL without any. Destroy `own`.
static Result read_mask(Mask *own, const Mask **mask, const Pair *pair, const Image *a,
                        const VerdictOptions *options, Error *error)
{
    *mask = options->mask;
    if (!pair->mask) return RESULT_OK;
    if (!*mask) {
        TRY(mask_read(own, pair->mask, error));
        *mask = own;
    }
    if ((*mask)->width == a->width && (*mask)->height == a->height) return RESULT_OK;
    return error_set(error, RESULT_BAD_INPUT,
                     "%s: a mask of %d x %d pixels: expected %d x %d, the size of %s", pair->mask,
                     (*mask)->width, (*mask)->height, a->width, a->height, pair->a);
}

static void measure_all(Verdict *verdict, const Pair *pair, const Image *a, const Image *b,
                        const VerdictOptions *options)
{
    Mask own = {0};
    const Mask *mask;
    float *map = NULL;
    Error error = {{0}};
    Result result = read_mask(&own, &mask, pair, a, options, &error);
    if (result != RESULT_OK) {
        set_unreadable(verdict, result, &error);
        verdict->mask_is_wrong = true;
    } else {
        bool needs_map = options->heat_map || options->sheet || options->map;
        if (needs_map) map = malloc((size_t)a->width * (size_t)a->height * sizeof *map);
        const Image images[2] = {*a, *b};
        result = map || !needs_map ? measure(verdict, map, pair, images, mask, options, &error)
                                   : error_set(&error, RESULT_FAILED, "no memory for a map");
        if (result != RESULT_OK) set_outcome(verdict, OUTCOME_FAILED, &error);
    }
    free(map);
    mask_destroy(&own);
}

static void compare_with(Verdict *verdict, const Pair *pair, const Image *b,
                         const VerdictOptions *options)
{
    Image a;
    Error error = {{0}};
    Result result = float_image_read_image(&a, pair->a, &error);
    if (result != RESULT_OK) {
        set_unreadable(verdict, result, &error);
    } else if (a.width != b->width || a.height != b->height) {
        error_set(&error, RESULT_OK, "%d x %d and %d x %d pixels", a.width, a.height, b->width,
                  b->height);
        set_outcome(verdict, OUTCOME_SIZES, &error);
    } else {
        measure_all(verdict, pair, &a, b, options);
    }
    image_destroy(&a);
}

// Reads B first, so a file that cannot be read never becomes a reference. A reference that cannot
// be read may be replaced.
static void find(Verdict *verdict, const Pair *pair, const VerdictOptions *options)
{
    Image b;
    Error error;
    *verdict = (Verdict){.outcome = pair->has_b ? OUTCOME_NEW : OUTCOME_MISSING};
    if (pair->unrendered) {
        error_set(&error, RESULT_OK, "%s", pair->unrendered);
        set_outcome(verdict, OUTCOME_UNRENDERED, &error);
        return;
    }
    if (!pair->has_a || !pair->has_b)
        snprintf(verdict->text, sizeof verdict->text, "no %s%s", pair->has_a ? pair->b : pair->a,
                 pair->has_a || !pair->not_for_gpus
                     ? ""
                     : "; images of GPUs are compared with the golden for all platforms only if "
                       "--any-platform is given");
    if (!pair->has_b || (!pair->has_a && !options->update)) return;
    Result result = float_image_read_image(&b, pair->b, &error);
    if (result != RESULT_OK) {
        set_unreadable(verdict, result, &error);
        return;
    }
    if (pair->has_a) compare_with(verdict, pair, &b, options);
    bool may_update = verdict->outcome != OUTCOME_FAILED && !verdict->mask_is_wrong;
    if (options->update && may_update) update(verdict, pair, &b);
    image_destroy(&b);
}

void verdict_find(Verdict *verdict, const Pair *pair, const VerdictOptions *options)
{
    double start_ms = clock_ms();
    find(verdict, pair, options);
    verdict->seconds = 1e-3 * (clock_ms() - start_ms);
}

void verdict_destroy(Verdict *verdict)
{
    free(verdict->heat_map);
    free(verdict->sheet);
    *verdict = (Verdict){0};
}

bool verdict_is_good(const Verdict *verdict)
{
    return is_passed(verdict) || verdict->updated;
}

bool verdict_is_listed(const Verdict *verdict)
{
    return !is_passed(verdict);
}

const char *verdict_word(const Verdict *verdict)
{
    return OUTCOME_NAMES[verdict->outcome];
}

void verdict_print(const Verdict *verdict, const Pair *pair, FILE *stream)
{
    char figures[512] = "";
    if (verdict->measured) compare_format(figures, sizeof figures, &verdict->figures);
    bool both = verdict->measured && verdict->text[0];
    fprintf(stream, "%s: %s: %s%s%s", quote(pair->name).text, OUTCOME_NAMES[verdict->outcome],
            figures, both ? "; " : "", quote(verdict->text).text);
    if (pair->level && pair->has_a)
        fprintf(stream, "; golden: %s (%s)%s", quote(pair->a).text, LEVEL_NAMES[pair->level],
                verdict->exact ? ", from the same driver and processor: expected equal pixels"
                               : "");
    if (verdict->dropped)
        fprintf(stream, "; needs no golden of its own, because %s is equal",
                quote(pair->fallback).text);
    else if (verdict->updated)
        fputs("; reference updated", stream);
    fputc('\n', stream);
}

// --- All pairs.

static double badness(const Verdict *verdict, bool by_flip)
{
    return by_flip ? verdict->figures.flip : verdict->figures.rmse;
}

VerdictTally verdict_tally(const PairList *list, const Verdict *verdicts)
{
    VerdictTally tally = {.worst = -1, .flip_known = true};
    for (size_t i = 0; i < list->count; ++i)
        tally.flip_known &= !verdicts[i].measured || (verdicts[i].figures.figures & COMPARE_FLIP);
    for (size_t i = 0; i < list->count; ++i) {
        const Verdict *verdict = &verdicts[i];
        bool is_error =
            verdict->outcome == OUTCOME_UNREADABLE || verdict->outcome == OUTCOME_UNRENDERED;
        tally.outcomes[verdict->outcome]++;
        tally.updated += verdict->updated;
        tally.bad += !verdict_is_good(verdict);
        tally.errors += !verdict_is_good(verdict) && is_error;
        if (verdict->measured &&
            (tally.worst < 0 || badness(verdict, tally.flip_known) >
                                    badness(&verdicts[tally.worst], tally.flip_known)))
            tally.worst = (int)i;
    }
    return tally;
}

Result verdict_status(const PairList *list, const Verdict *verdicts)
{
    for (size_t i = 0; i < list->count; ++i)
        if (verdicts[i].outcome == OUTCOME_UNREADABLE && !verdicts[i].updated)
            return RESULT_BAD_INPUT;
    return verdict_tally(list, verdicts).bad ? RESULT_FAILED : RESULT_OK;
}

void verdict_print_tally(const PairList *list, const Verdict *verdicts, FILE *stream)
{
    VerdictTally tally = verdict_tally(list, verdicts);
    double worst = tally.worst < 0 ? 0 : badness(&verdicts[tally.worst], tally.flip_known);
    fprintf(stream, "%zu image%s:", list->count, list->count == 1 ? "" : "s");
    const char *between = " ";
    for (int i = 0; i < OUTCOME_COUNT; ++i) {
        if (!tally.outcomes[i]) continue;
        fprintf(stream, "%s%d %s", between, tally.outcomes[i], OUTCOME_NAMES[i]);
        between = ", ";
    }
    if (tally.updated)
        fprintf(stream, "; %d reference%s updated", tally.updated, tally.updated == 1 ? "" : "s");
    if (worst > 0)
        fprintf(stream, "; largest %s %.4g (%s)", tally.flip_known ? "FLIP" : "RMSE", worst,
                quote(list->pairs[tally.worst].name).text);
    fprintf(stream, "\n");
}

// --- JSON.

// jansson accepts only UTF-8; other names become "?".
static json_t *text_to_json(const char *text)
{
    json_t *value = json_string(text);
    return value ? value : json_string("?");
}

static void set_figures(json_t *object, const CompareResult *figures)
{
    double psnr = figures->psnr;
    json_object_set_new(object, "width", json_integer(figures->width));
    json_object_set_new(object, "height", json_integer(figures->height));
    json_object_set_new(object, "compared_pixels", json_integer((json_int_t)figures->compared));
    json_object_set_new(object, "rmse", json_real(figures->rmse));
    json_object_set_new(object, "psnr_db", isfinite(psnr) ? json_real(psnr) : json_null());
    if (figures->figures & COMPARE_SSIM)
        json_object_set_new(object, "ssim", json_real(figures->ssim));
    if (figures->figures & COMPARE_FLIP) {
        json_object_set_new(object, "flip", json_real(figures->flip));
        json_object_set_new(object, "flip_largest", json_real(figures->flip_most));
    }
    json_object_set_new(object, "largest_difference", json_real(figures->largest));
    json_object_set_new(object, "at", json_pack("[i, i]", figures->at[0], figures->at[1]));
    json_object_set_new(object, "local_difference", json_real(figures->local));
    json_object_set_new(object, "local_at",
                        json_pack("[i, i]", figures->local_at[0], figures->local_at[1]));
    json_object_set_new(object, "failing_pixels", json_integer((json_int_t)figures->failing));
}

json_t *verdict_to_json(const Verdict *verdict, const Pair *pair)
{
    json_t *object = json_object();
    json_object_set_new(object, "name", text_to_json(pair->name));
    json_object_set_new(object, "a", text_to_json(pair->a));
    json_object_set_new(object, "b", text_to_json(pair->b));
    if (pair->mask) json_object_set_new(object, "mask", text_to_json(pair->mask));
    if (pair->command) json_object_set_new(object, "command", text_to_json(pair->command));
    json_object_set_new(object, "good", json_boolean(verdict_is_good(verdict)));
    json_object_set_new(object, "outcome", json_string(OUTCOME_NAMES[verdict->outcome]));
    json_object_set_new(object, "updated", json_boolean(verdict->updated));
    if (pair->level) json_object_set_new(object, "level", json_string(LEVEL_NAMES[pair->level]));
    if (verdict->exact) json_object_set_new(object, "exact", json_true());
    if (verdict->dropped) json_object_set_new(object, "left_to", text_to_json(pair->fallback));
    if (verdict->text[0]) json_object_set_new(object, "text", text_to_json(verdict->text));
    if (verdict->measured) set_figures(object, &verdict->figures);
    return object;
}

static json_t *limits_to_json(const CompareLimits *limits)
{
    json_t *object = json_object();
    const char *number = limits->max_failing_percent ? "max_failing_percent" : "max_failing_pixels";
    if (limits->pixels_matter) {
        json_object_set_new(object, "pixel_tolerance", json_real(limits->pixel_tolerance));
        json_object_set_new(object, number, json_real(limits->max_failing));
    }
    if (limits->difference_matters)
        json_object_set_new(object, "max_difference", json_real(limits->max_difference));
    if (limits->local_matters)
        json_object_set_new(object, "max_local_difference", json_real(limits->max_local));
    if (limits->flip_matters) json_object_set_new(object, "max_flip", json_real(limits->max_flip));
    json_object_set_new(object, "pixels_per_degree", json_real(limits->pixels_per_degree));
    return object;
}

json_t *verdict_limits_to_json(const CompareLimits limits[LEVELS], const PairList *list)
{
    if (!list->by_platform) return limits_to_json(&limits[LEVEL_NONE]);
    json_t *object = json_object();
    for (Level level = LEVEL_PLATFORM; level < LEVELS; ++level)
        json_object_set_new(object, LEVEL_NAMES[level], limits_to_json(&limits[level]));
    return object;
}

Result verdict_write_json(const char *path, const PairList *list, const Verdict *verdicts,
                          const CompareLimits limits[LEVELS], bool only_failures, Error *error)
{
    VerdictTally tally = verdict_tally(list, verdicts);
    json_t *object = json_object(), *pairs = json_array();
    json_object_set_new(object, "good", json_boolean(tally.bad == 0));
    json_object_set_new(object, "limits", verdict_limits_to_json(limits, list));
    json_object_set_new(object, "images", json_integer((json_int_t)list->count));
    for (int i = 0; i < OUTCOME_COUNT; ++i)
        json_object_set_new(object, OUTCOME_NAMES[i], json_integer(tally.outcomes[i]));
    json_object_set_new(object, "updated", json_integer(tally.updated));
    for (size_t i = 0; i < list->count; ++i)
        if (!only_failures || verdict_is_listed(&verdicts[i]))
            json_array_append_new(pairs, verdict_to_json(&verdicts[i], &list->pairs[i]));
    json_object_set_new(object, "pairs", pairs);
    Result result = json_write_file(object, path, error);
    json_decref(object);
    return result;
}
