// SPDX-License-Identifier: MIT
// Workflow commands:
// https://docs.github.com/en/actions/reference/workflow-commands-for-github-actions
#include "compare/github.h"

#include "base/outfile.h"
#include "base/utf8.h"
#include "compare/ci_path.h"

#include <stdlib.h>
#include <string.h>

// GitHub drops errors beyond ten a step, and summaries beyond 1 MiB.
enum { MOST_ERRORS = 10, MOST_ROWS = 1000 };

// --- Annotations.

// Writes the next character of a text, or an escape such as \x1b if it is not visible, and steps
// over it: logs are read in terminals, too.
static void put_character(FILE *stream, const char **text)
{
    size_t length = utf8_visible(*text, strnlen(*text, 4));
    if (length)
        fwrite(*text, 1, length, stream);
    else
        fprintf(stream, "\\x%02x", (unsigned)(unsigned char)**text);
    *text += length ? length : 1;
}

// Escapes text for a workflow command, which must be one line. In a property, ':' and ',' are
// escaped, too.
static void put_data(FILE *stream, const char *text, bool is_property)
{
    while (*text) {
        bool is_special = strchr("%\r\n", *text) || (is_property && strchr(":,", *text));
        if (is_special)
            fprintf(stream, "%%%02X", (unsigned)(unsigned char)*text++);
        else
            put_character(stream, &text);
    }
}

static void put_error(FILE *stream, const Pair *pair, const Verdict *verdict)
{
    char figures[512] = "", *file = ci_path(pair->a);
    const char *between = "";
    if (verdict->measured) compare_format(figures, sizeof figures, &verdict->figures);
    fputs("::error file=", stream);
    put_data(stream, file ? file : pair->a, true);
    fputs(",title=", stream);
    put_data(stream, pair->name, true);
    fprintf(stream, "%%3A %s::", verdict_word(verdict));
    const char *const parts[] = {figures, verdict->text};
    for (int i = 0; i < 2; ++i) {
        if (!*parts[i]) continue;
        fputs(between, stream);
        put_data(stream, parts[i], false);
        between = "; ";
    }
    fputc('\n', stream);
    free(file);
}

void github_print_annotations(const PairList *list, const Verdict *verdicts, FILE *stream)
{
    int bad = verdict_tally(list, verdicts).bad, printed = 0;
    int most = bad > MOST_ERRORS ? MOST_ERRORS - 1 : MOST_ERRORS;
    for (size_t i = 0; i < list->count && printed < most; ++i) {
        if (verdict_is_good(&verdicts[i])) continue;
        put_error(stream, &list->pairs[i], &verdicts[i]);
        ++printed;
    }
    if (printed < bad)
        fprintf(stream, "::error title=tractrix-compare::%d more images failed: see the summary\n",
                bad - printed);
}

// --- The summary.

// Writes text as code that can stand in a cell of a Markdown table.
static void put_code(FILE *stream, const char *text)
{
    fputc('`', stream);
    while (*text) {
        if (*text == '|') fputc('\\', stream);
        if (*text == '`')
            fputc('\'', stream), ++text;
        else
            put_character(stream, &text);
    }
    fputc('`', stream);
}

static void put_row(FILE *stream, const Pair *pair, const Verdict *verdict)
{
    const CompareResult *figures = &verdict->figures;
    fputs("| ", stream);
    put_code(stream, pair->name);
    fprintf(stream, " | %s%s%s%s%s | ", verdict_word(verdict), verdict->updated ? ", updated" : "",
            pair->level && pair->has_a ? " (" : "",
            pair->level && pair->has_a ? LEVEL_NAMES[pair->level] : "",
            pair->level && pair->has_a ? ")" : "");
    char flip[32] = "";
    if (figures->figures & COMPARE_FLIP) snprintf(flip, sizeof flip, "%.4g", figures->flip);
    if (verdict->measured)
        fprintf(stream, "%s | %.4g | %.4g | %llu (%.3g %%) | ", flip, figures->rmse, figures->local,
                (unsigned long long)figures->failing,
                100 * (double)figures->failing / (double)figures->compared);
    else
        fputs("| | | | ", stream);
    if (verdict->text[0]) put_code(stream, verdict->text);
    char *sheet = verdict->sheet ? ci_path(verdict->sheet) : NULL;
    if (sheet) put_code(stream, sheet);
    fputs(" |\n", stream);
    free(sheet);
}

static void put_limits(FILE *stream, const char *level, const CompareLimits *limits)
{
    const char *unit = limits->max_failing_percent ? " %" : "", *between = "";
    const struct {
        bool matters;
        const char *name;
        double most;
    } others[] = {{limits->difference_matters, "largest difference", limits->max_difference},
                  {limits->local_matters, "local difference", limits->max_local},
                  {limits->flip_matters, "FLIP", limits->max_flip}};
    fprintf(stream, "\nLimits%s%s:", *level ? " of the " : "", level);
    if (limits->pixels_matter) {
        fprintf(stream, " pixel tolerance %g, failing pixels %g%s", limits->pixel_tolerance,
                limits->max_failing, unit);
        between = ",";
    }
    for (size_t i = 0; i < sizeof others / sizeof *others; ++i) {
        if (!others[i].matters) continue;
        fprintf(stream, "%s %s %g", between, others[i].name, others[i].most);
        between = ",";
    }
    fputs(".\n", stream);
}

static void put_summary(FILE *stream, const PairList *list, const Verdict *verdicts,
                        const CompareLimits limits[LEVELS])
{
    VerdictTally tally = verdict_tally(list, verdicts);
    int rows = 0, wanted = tally.bad + tally.updated;
    fprintf(stream, "### Images: %d of %zu failed\n\n", tally.bad, list->count);
    verdict_print_tally(list, verdicts, stream);
    Level first = list->by_platform ? LEVEL_PLATFORM : LEVEL_NONE;
    for (Level level = first; level < (list->by_platform ? LEVELS : LEVEL_PLATFORM); ++level)
        put_limits(stream, LEVEL_NAMES[level], &limits[level]);
    fputc('\n', stream);
    if (wanted)
        fputs("| image | result | FLIP | RMSE | local difference | failing pixels | |\n"
              "| --- | --- | ---: | ---: | ---: | ---: | --- |\n",
              stream);
    for (size_t i = 0; i < list->count && rows < MOST_ROWS; ++i) {
        if (!verdict_is_listed(&verdicts[i])) continue;
        put_row(stream, &list->pairs[i], &verdicts[i]);
        ++rows;
    }
    if (rows < wanted) fprintf(stream, "\n%d more images are not listed.\n", wanted - rows);
    if (wanted) fputc('\n', stream);
}

Result github_append_summary(const PairList *list, const Verdict *verdicts,
                             const CompareLimits limits[LEVELS], Error *error)
{
    const char *path = getenv("GITHUB_STEP_SUMMARY");
    if (!path || !*path) return RESULT_OK;
    char *text = NULL;
    size_t size;
    FILE *stream = open_memstream(&text, &size);
    if (!stream) return error_set(error, RESULT_FAILED, "%s: no memory for the summary", path);
    put_summary(stream, list, verdicts, limits);
    bool whole = fclose(stream) == 0;
    Result result = whole ? outfile_append(path, text, error)
                          : error_set(error, RESULT_FAILED, "%s: no memory for the summary", path);
    free(text);
    return result;
}
