// SPDX-License-Identifier: MIT
#include "compare/verdict_report.h"

#include "base/json.h"
#include "base/outfile.h"

#include <math.h>
#include <string.h>

Tally verdict_count(const Verdict *verdicts, size_t count)
{
    Tally tally = {.pairs = (int)count, .worst = -1};
    for (size_t i = 0; i < count; ++i) {
        const Verdict *verdict = &verdicts[i];
        tally.outcomes[verdict->outcome]++;
        tally.updated += verdict->updated;
        tally.good += verdict_is_good(verdict);
        if (!verdict->measured || !(tally.worst < 0 || verdict->figures.flip > tally.flip))
            continue;
        tally.worst = (int)i;
        tally.flip = verdict->figures.flip;
    }
    return tally;
}

Result verdict_status(const Verdict *verdicts, size_t count)
{
    Result result = RESULT_OK;
    for (size_t i = 0; i < count; ++i) {
        if (verdict_is_good(&verdicts[i])) continue;
        if (verdicts[i].outcome == OUTCOME_UNREADABLE) return RESULT_BAD_INPUT;
        result = RESULT_FAILED;
    }
    return result;
}

void verdict_print_tally(const Tally *tally, const PairList *list, FILE *stream)
{
    fprintf(stream, "%d picture%s:", tally->pairs, tally->pairs == 1 ? "" : "s");
    const char *between = " ";
    for (int i = 0; i < OUTCOME_COUNT; ++i) {
        if (!tally->outcomes[i]) continue;
        fprintf(stream, "%s%d %s", between, tally->outcomes[i], OUTCOME_NAMES[i]);
        between = ", ";
    }
    if (tally->updated)
        fprintf(stream, "; %d reference%s updated", tally->updated, tally->updated == 1 ? "" : "s");
    if (tally->worst >= 0 && tally->flip > 0)
        fprintf(stream, "; largest FLIP %.4g (%s)", tally->flip, list->pairs[tally->worst].name);
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
    Tally tally = verdict_count(verdicts, list->count);
    json_t *object = json_object(), *pairs = json_array();
    json_object_set_new(object, "good", json_boolean(tally.good == tally.pairs));
    json_object_set_new(object, "limits", limits_to_json(limits));
    json_object_set_new(object, "pictures", json_integer(tally.pairs));
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
    if (verdict_is_good(verdict)) {
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
    Result result = outfile_open(&file, path, error);
    if (result != RESULT_OK) return result;
    int errors = 0, bad = (int)list->count - verdict_count(verdicts, list->count).good;
    for (size_t i = 0; i < list->count; ++i)
        errors += verdicts[i].outcome == OUTCOME_UNREADABLE && !verdict_is_good(&verdicts[i]);
    fprintf(file.stream, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n");
    fprintf(file.stream,
            "  <testsuite name=\"tractrix-compare\" tests=\"%zu\" failures=\"%d\" errors=\"%d\">\n",
            list->count, bad - errors, errors);
    for (size_t i = 0; i < list->count; ++i) put_case(file.stream, &list->pairs[i], &verdicts[i]);
    fprintf(file.stream, "  </testsuite>\n</testsuites>\n");
    return outfile_commit(&file, error);
}
