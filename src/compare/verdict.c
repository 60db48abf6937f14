// SPDX-License-Identifier: MIT
#include "compare/verdict.h"

#include "base/bytes.h"
#include "image/float_image.h"
#include "image/heat_map.h"
#include "image/png.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const OUTCOME_NAMES[OUTCOME_COUNT] = {"same",    "different",  "sizes",
                                                  "missing", "unreadable", "failed"};

static void set_outcome(Verdict *verdict, Outcome outcome, const Error *error)
{
    verdict->outcome = outcome;
    memcpy(verdict->text, error->text, sizeof error->text);
}

static void copy_reference(Verdict *verdict, const Pair *pair)
{
    Bytes file = {0};
    Error error;
    Result result = bytes_read_file(&file, pair->b, &error);
    if (result == RESULT_OK) result = bytes_write_file(&file, pair->a, &error);
    verdict->updated = result == RESULT_OK;
    if (result != RESULT_OK) set_outcome(verdict, OUTCOME_FAILED, &error);
    bytes_destroy(&file);
}

static Result write_heat_map(const char *path, const CompareResult *figures, const float *map,
                             Error *error)
{
    Image image;
    Result result = heat_map_create(&image, map, figures->width, figures->height, error);
    if (result == RESULT_OK) result = png_write(path, &image, error);
    image_destroy(&image);
    return result;
}

static Result write_sheet(const char *path, const Image *a, const Image *b, const float *map,
                          Error *error)
{
    Image image;
    Result result = heat_map_create_sheet(&image, a, b, map, error);
    if (result == RESULT_OK) result = png_write(path, &image, error);
    image_destroy(&image);
    return result;
}

static Result measure(Verdict *verdict, float *map, const Image *a, const Image *b,
                      const VerdictOptions *options, Error *error)
{
    Result result = compare_images(&verdict->figures, map, a, b, &options->limits, error);
    if (result != RESULT_OK) return result;
    verdict->measured = true;
    verdict->outcome = verdict->figures.same ? OUTCOME_SAME : OUTCOME_DIFFERENT;
    if (verdict->figures.same && !options->draw_same) return RESULT_OK;
    if (options->heat_map)
        result = write_heat_map(options->heat_map, &verdict->figures, map, error);
    if (result == RESULT_OK && options->sheet)
        result = write_sheet(options->sheet, a, b, map, error);
    return result;
}

static void compare_pair(Verdict *verdict, const Image *a, const Image *b,
                         const VerdictOptions *options)
{
    Error error = {{0}};
    if (a->width != b->width || a->height != b->height) {
        error_set(&error, RESULT_OK, "%d x %d and %d x %d pixels", a->width, a->height, b->width,
                  b->height);
        set_outcome(verdict, OUTCOME_SIZES, &error);
        return;
    }
    float *map = malloc((size_t)a->width * (size_t)a->height * sizeof *map);
    Result result = map ? measure(verdict, map, a, b, options, &error)
                        : error_set(&error, RESULT_FAILED, "no memory for a map");
    if (result != RESULT_OK) set_outcome(verdict, OUTCOME_FAILED, &error);
    free(map);
}

static void read_reference(Verdict *verdict, const Pair *pair, const Image *b,
                           const VerdictOptions *options)
{
    Image a;
    Error error;
    Result result = float_image_read_image(&a, pair->a, &error);
    if (result == RESULT_OK)
        compare_pair(verdict, &a, b, options);
    else
        set_outcome(verdict, result == RESULT_BAD_INPUT ? OUTCOME_UNREADABLE : OUTCOME_FAILED,
                    &error);
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
        set_outcome(verdict, result == RESULT_BAD_INPUT ? OUTCOME_UNREADABLE : OUTCOME_FAILED,
                    &error);
        return;
    }
    if (pair->has_a) read_reference(verdict, pair, &b, options);
    if (options->update && verdict->outcome != OUTCOME_SAME && verdict->outcome != OUTCOME_FAILED)
        copy_reference(verdict, pair);
    image_destroy(&b);
}

bool verdict_is_good(const Verdict *verdict)
{
    return verdict->outcome == OUTCOME_SAME || verdict->updated;
}

void verdict_print(const Verdict *verdict, const Pair *pair, FILE *stream)
{
    char figures[512] = "";
    if (verdict->measured) compare_format(figures, sizeof figures, &verdict->figures);
    bool both = verdict->measured && verdict->text[0];
    fprintf(stream, "%s: %s: %s%s%s%s\n", pair->name, OUTCOME_NAMES[verdict->outcome], figures,
            both ? "; " : "", verdict->text, verdict->updated ? "; reference updated" : "");
}
