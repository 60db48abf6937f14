// SPDX-License-Identifier: MIT
// JUnit XML: https://github.com/testmoapp/junitxml. Of the attachments of a failed case, GitLab
// takes only the first; the path is relative to the project's folder (its documentation, "Unit test
// reports"). Jenkins takes all of them (plugin JUnit Attachments).
#include "compare/junit.h"

#include "base/json.h"
#include "base/outfile.h"
#include "compare/ci_path.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Escapes text for XML content and attributes. XML 1.0 cannot contain most control characters, and
// bytes that are not UTF-8 would make the whole file invalid.
static void put_xml(FILE *stream, const char *text)
{
    json_t *utf8 = json_string(text);
    for (; *text; ++text) {
        unsigned char c = (unsigned char)*text;
        const char *entity = c == '&'                           ? "&amp;"
                             : c == '<'                         ? "&lt;"
                             : c == '>'                         ? "&gt;"
                             : c == '"'                         ? "&quot;"
                             : c < 0x20 || (c >= 0x80 && !utf8) ? "?"
                                                                : NULL;
        if (entity)
            fputs(entity, stream);
        else
            fputc(c, stream);
    }
    json_decref(utf8);
}

static void put_attribute(FILE *stream, const char *name, const char *value)
{
    fprintf(stream, " %s=\"", name);
    put_xml(stream, value);
    fputc('"', stream);
}

static void put_path(FILE *stream, const char *before, const char *path, const char *after)
{
    char *name = ci_path(path);
    fputs(before, stream);
    put_xml(stream, name ? name : path);
    fputs(after, stream);
    free(name);
}

// Attaches the most informative image first, because GitLab shows only the first attachment.
static void put_attachments(FILE *stream, const Pair *pair, const Verdict *verdict)
{
    const char *const paths[] = {verdict->sheet, verdict->heat_map, pair->has_b ? pair->b : NULL,
                                 pair->has_a ? pair->a : NULL};
    bool open = false;
    for (size_t i = 0; i < sizeof paths / sizeof *paths; ++i) {
        if (!paths[i]) continue;
        if (!open) fprintf(stream, "      <system-out>\n");
        open = true;
        put_path(stream, "[[ATTACHMENT|", paths[i], "]]\n");
    }
    if (open) fprintf(stream, "</system-out>\n");
}

static void put_case(FILE *stream, const Pair *pair, const Verdict *verdict)
{
    char message[2048], figures[512] = "";
    bool is_error =
        verdict->outcome == OUTCOME_UNREADABLE || verdict->outcome == OUTCOME_UNRENDERED;
    const char *word = is_error ? "error" : "failure";
    fprintf(stream, "    <testcase classname=\"tractrix-compare\"");
    put_attribute(stream, "name", pair->name);
    put_path(stream, " file=\"", pair->a, "\"");
    fprintf(stream, " time=\"%.3f\"", verdict->seconds);
    if (verdict_is_good(verdict)) {
        fprintf(stream, "/>\n");
        return;
    }
    if (verdict->measured) compare_format(figures, sizeof figures, &verdict->figures);
    snprintf(message, sizeof message, "%s%s%s", figures, *figures && *verdict->text ? "; " : "",
             verdict->text);
    fprintf(stream, ">\n      <%s", word);
    put_attribute(stream, "type", verdict_word(verdict));
    put_attribute(stream, "message", message);
    fputc('>', stream);
    put_xml(stream, message);
    fprintf(stream, "</%s>\n", word);
    put_attachments(stream, pair, verdict);
    fprintf(stream, "    </testcase>\n");
}

Result junit_write(const char *path, const PairList *list, const Verdict *verdicts,
                   const JunitOptions *options, Error *error)
{
    OutFile file;
    char sums[200], timestamp[64];
    struct tm utc;
    TRY(outfile_open(&file, path, error));
    VerdictTally tally = verdict_tally(list, verdicts);
    size_t cases = list->count;
    for (size_t i = 0; i < list->count; ++i)
        cases -= options->only_failures && !verdict_is_listed(&verdicts[i]);
    snprintf(sums, sizeof sums,
             "name=\"tractrix-compare\" tests=\"%zu\" failures=\"%d\" errors=\"%d\" "
             "skipped=\"0\" time=\"%.3f\"",
             cases, tally.bad - tally.errors, tally.errors, options->seconds);
    strftime(timestamp, sizeof timestamp, "%Y-%m-%dT%H:%M:%S", gmtime_r(&options->started, &utc));
    fprintf(file.stream, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites %s>\n", sums);
    fprintf(file.stream, "  <testsuite %s timestamp=\"%s\">\n", sums, timestamp);
    for (size_t i = 0; i < list->count; ++i)
        if (!options->only_failures || verdict_is_listed(&verdicts[i]))
            put_case(file.stream, &list->pairs[i], &verdicts[i]);
    fprintf(file.stream, "  </testsuite>\n</testsuites>\n");
    return outfile_commit(&file, error);
}
