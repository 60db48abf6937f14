// SPDX-License-Identifier: MIT
#include "compare/verdict.h"

#include "base/bytes.h"
#include "base/json.h"
#include "base/outfile.h"
#include "image/float_image.h"
#include "image/heat_map.h"
#include "image/png.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const OUTCOME_NAMES[OUTCOME_COUNT] = {"same",    "different",  "size mismatch",
                                                         "missing", "unreadable", "failed"};

// --- One pair.

static void set_outcome(Verdict *verdict, Outcome outcome, const Error *error)
{
    verdict->outcome = outcome;
    memcpy(verdict->text, error->text, sizeof error->text);
}

// An image that cannot be read has a fault of its own, or memory is short.
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

// Writes the heat map, or the sheet of A, B and the heat map.
static Result draw(const char *path, bool sheet, const Image *a, const Image *b, const float *map,
                   Error *error)
{
    Image image = {0};
    if (!path) return RESULT_OK;
    Result result = sheet ? heat_map_create_sheet(&image, a, b, map, error)
                          : heat_map_create(&image, map, a->width, a->height, error);
    THEN(result, png_write(path, &image, error));
    image_destroy(&image);
    return result;
}

static Result measure(Verdict *verdict, float *map, const Image *a, const Image *b,
                      const VerdictOptions *options, Error *error)
{
    TRY(compare_images(&verdict->figures, map, a, b, NULL, &options->limits, error));
    verdict->measured = true;
    verdict->outcome = verdict->figures.same ? OUTCOME_SAME : OUTCOME_DIFFERENT;
    if (verdict->figures.same && !options->draw_same) return RESULT_OK;
    TRY(draw(options->heat_map, false, a, b, map, error));
    return draw(options->sheet, true, a, b, map, error);
}

static void compare_with(Verdict *verdict, const Pair *pair, const Image *b,
                         const VerdictOptions *options)
{
    Image a;
    Error error = {{0}};
    float *map = NULL;
    Result result = float_image_read_image(&a, pair->a, &error);
    if (result != RESULT_OK) {
        set_unreadable(verdict, result, &error);
    } else if (a.width != b->width || a.height != b->height) {
        error_set(&error, RESULT_OK, "%d x %d and %d x %d pixels", a.width, a.height, b->width,
                  b->height);
        set_outcome(verdict, OUTCOME_SIZES, &error);
    } else {
        map = malloc((size_t)a.width * (size_t)a.height * sizeof *map);
        result = map ? measure(verdict, map, &a, b, options, &error)
                     : error_set(&error, RESULT_FAILED, "no memory for a map");
        if (result != RESULT_OK) set_outcome(verdict, OUTCOME_FAILED, &error);
    }
    free(map);
    image_destroy(&a);
}

// B first: what can't be read never becomes a reference, while an unreadable reference may be
// replaced.
void verdict_find(Verdict *verdict, const Pair *pair, const VerdictOptions *options)
{
    Image b;
    Error error;
    *verdict = (Verdict){.outcome = OUTCOME_MISSING};
    if (!pair->has_a || !pair->has_b)
        snprintf(verdict->text, sizeof verdict->text, "no %s", pair->has_a ? pair->b : pair->a);
    if (!pair->has_b || (!pair->has_a && !options->update)) return;
    Result result = float_image_read_image(&b, pair->b, &error);
    if (result != RESULT_OK) {
        set_unreadable(verdict, result, &error);
        return;
    }
    if (pair->has_a) compare_with(verdict, pair, &b, options);
    if (options->update && verdict->outcome != OUTCOME_SAME && verdict->outcome != OUTCOME_FAILED)
        copy_reference(verdict, pair);
    image_destroy(&b);
}

void verdict_print(const Verdict *verdict, const Pair *pair, FILE *stream)
{
    char figures[512] = "";
    if (verdict->measured) compare_format(figures, sizeof figures, &verdict->figures);
    bool both = verdict->measured && verdict->text[0];
    fprintf(stream, "%s: %s: %s%s%s%s\n", pair->name, OUTCOME_NAMES[verdict->outcome], figures,
            both ? "; " : "", verdict->text, verdict->updated ? "; reference updated" : "");
}

// --- All pairs.

static bool is_good(const Verdict *verdict)
{
    return verdict->outcome == OUTCOME_SAME || verdict->updated;
}

typedef struct Tally {
    int outcomes[OUTCOME_COUNT]; // those updated, too
    int updated, bad;
    int unreadable; // of the bad ones
    int worst;      // the measured pair with the largest mean of FLIP, -1: none
} Tally;

static Tally count_verdicts(const PairList *list, const Verdict *verdicts)
{
    Tally tally = {.worst = -1};
    for (size_t i = 0; i < list->count; ++i) {
        const Verdict *verdict = &verdicts[i];
        tally.outcomes[verdict->outcome]++;
        tally.updated += verdict->updated;
        tally.bad += !is_good(verdict);
        tally.unreadable += !is_good(verdict) && verdict->outcome == OUTCOME_UNREADABLE;
        if (verdict->measured &&
            (tally.worst < 0 || verdict->figures.flip > verdicts[tally.worst].figures.flip))
            tally.worst = (int)i;
    }
    return tally;
}

Result verdict_status(const PairList *list, const Verdict *verdicts)
{
    Tally tally = count_verdicts(list, verdicts);
    return tally.unreadable ? RESULT_BAD_INPUT : tally.bad ? RESULT_FAILED : RESULT_OK;
}

void verdict_print_tally(const PairList *list, const Verdict *verdicts, FILE *stream)
{
    Tally tally = count_verdicts(list, verdicts);
    double flip = tally.worst < 0 ? 0 : verdicts[tally.worst].figures.flip;
    fprintf(stream, "%zu image%s:", list->count, list->count == 1 ? "" : "s");
    const char *between = " ";
    for (int i = 0; i < OUTCOME_COUNT; ++i) {
        if (!tally.outcomes[i]) continue;
        fprintf(stream, "%s%d %s", between, tally.outcomes[i], OUTCOME_NAMES[i]);
        between = ", ";
    }
    if (tally.updated)
        fprintf(stream, "; %d reference%s updated", tally.updated, tally.updated == 1 ? "" : "s");
    if (flip > 0) fprintf(stream, "; largest FLIP %.4g (%s)", flip, list->pairs[tally.worst].name);
    fprintf(stream, "\n");
}

// --- JSON.

// jansson takes no text that is not UTF-8: a name of other bytes becomes "?" here.
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
    json_object_set_new(object, "rmse", json_real(figures->rmse));
    json_object_set_new(object, "psnr_db", isfinite(psnr) ? json_real(psnr) : json_null());
    json_object_set_new(object, "ssim", json_real(figures->ssim));
    json_object_set_new(object, "flip", json_real(figures->flip));
    json_object_set_new(object, "flip_largest", json_real(figures->flip_most));
    json_object_set_new(object, "largest_difference", json_real(figures->largest));
    json_object_set_new(object, "at", json_pack("[i, i]", figures->at[0], figures->at[1]));
    json_object_set_new(object, "failing_pixels", json_integer((json_int_t)figures->failing));
}

static json_t *pair_to_json(const Pair *pair, const Verdict *verdict)
{
    json_t *object = json_object();
    json_object_set_new(object, "name", text_to_json(pair->name));
    json_object_set_new(object, "a", text_to_json(pair->a));
    json_object_set_new(object, "b", text_to_json(pair->b));
    json_object_set_new(object, "outcome", json_string(OUTCOME_NAMES[verdict->outcome]));
    json_object_set_new(object, "updated", json_boolean(verdict->updated));
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
    if (limits->flip_matters) json_object_set_new(object, "max_flip", json_real(limits->max_flip));
    json_object_set_new(object, "pixels_per_degree", json_real(limits->pixels_per_degree));
    return object;
}

Result verdict_write_json(const char *path, const PairList *list, const Verdict *verdicts,
                          const CompareLimits *limits, Error *error)
{
    Tally tally = count_verdicts(list, verdicts);
    json_t *object = json_object(), *pairs = json_array();
    json_object_set_new(object, "good", json_boolean(tally.bad == 0));
    json_object_set_new(object, "limits", limits_to_json(limits));
    json_object_set_new(object, "images", json_integer((json_int_t)list->count));
    for (int i = 0; i < OUTCOME_COUNT; ++i)
        json_object_set_new(object, OUTCOME_NAMES[i], json_integer(tally.outcomes[i]));
    json_object_set_new(object, "updated", json_integer(tally.updated));
    for (size_t i = 0; i < list->count; ++i)
        json_array_append_new(pairs, pair_to_json(&list->pairs[i], &verdicts[i]));
    json_object_set_new(object, "pairs", pairs);
    Result result = json_write_file(object, path, error);
    json_decref(object);
    return result;
}

// --- JUnit.

// Escaped for an attribute. XML has no place for most control characters.
static void put_xml(FILE *stream, const char *text)
{
    for (; *text; ++text) {
        unsigned char c = (unsigned char)*text;
        const char *entity = c == '&'   ? "&amp;"
                             : c == '<' ? "&lt;"
                             : c == '>' ? "&gt;"
                             : c == '"' ? "&quot;"
                             : c < 0x20 ? "?"
                                        : NULL;
        if (entity)
            fputs(entity, stream);
        else
            fputc(c, stream);
    }
}

static void put_case(FILE *stream, const Pair *pair, const Verdict *verdict)
{
    char figures[512] = "";
    const char *word = verdict->outcome == OUTCOME_UNREADABLE ? "error" : "failure";
    fprintf(stream, "    <testcase classname=\"tractrix-compare\" name=\"");
    put_xml(stream, pair->name);
    if (is_good(verdict)) {
        fprintf(stream, "\"/>\n");
        return;
    }
    if (verdict->measured) compare_format(figures, sizeof figures, &verdict->figures);
    fprintf(stream, "\">\n      <%s type=\"%s\" message=\"", word, OUTCOME_NAMES[verdict->outcome]);
    put_xml(stream, figures);
    put_xml(stream, verdict->text);
    fprintf(stream, "\"/>\n    </testcase>\n");
}

Result verdict_write_junit(const char *path, const PairList *list, const Verdict *verdicts,
                           Error *error)
{
    OutFile file;
    TRY(outfile_open(&file, path, error));
    Tally tally = count_verdicts(list, verdicts);
    fprintf(file.stream, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n");
    fprintf(file.stream,
            "  <testsuite name=\"tractrix-compare\" tests=\"%zu\" failures=\"%d\" errors=\"%d\">\n",
            list->count, tally.bad - tally.unreadable, tally.unreadable);
    for (size_t i = 0; i < list->count; ++i) put_case(file.stream, &list->pairs[i], &verdicts[i]);
    fprintf(file.stream, "  </testsuite>\n</testsuites>\n");
    return outfile_commit(&file, error);
}
