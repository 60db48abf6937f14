// SPDX-License-Identifier: MIT
#include "report/report.h"

#include "base/json.h"
#include "base/utf8.h"

#include <errno.h>
#include <limits.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

// --- Base64 (RFC 4648, section 4).

enum { BASE64_BLOCK = 3 * 4096 }; // bytes converted at a time

// Writes 4 characters for every 3 bytes, the last group padded; returns the number of characters.
static size_t encode_base64(char *to, const uint8_t *from, size_t size)
{
    static const char DIGITS[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    char *begin = to;
    for (size_t i = 0; i < size; i += 3, to += 4) {
        unsigned second = i + 1 < size ? from[i + 1] : 0, third = i + 2 < size ? from[i + 2] : 0;
        unsigned bits = (unsigned)from[i] << 16 | second << 8 | third;
        for (int k = 0; k < 4; ++k) to[k] = DIGITS[bits >> (18 - 6 * k) & 63];
        if (i + 1 >= size) to[2] = '=';
        if (i + 2 >= size) to[3] = '=';
    }
    return (size_t)(to - begin);
}

static void put_base64(FILE *stream, const Bytes *bytes)
{
    char text[BASE64_BLOCK / 3 * 4];
    for (size_t at = 0; at < bytes->size; at += BASE64_BLOCK) {
        size_t size = bytes->size - at < BASE64_BLOCK ? bytes->size - at : BASE64_BLOCK;
        size_t length = encode_base64(text, bytes->data + at, size);
        fwrite(text, 1, length, stream);
    }
}

// --- The page.

static const ReportText *find_text(const char *kind, const char *suffix)
{
    char name[64];
    const ReportText *text = REPORT_TEXTS;
    snprintf(name, sizeof name, "%s.%s", kind, suffix);
    while (text->name && strcmp(text->name, name) != 0) ++text;
    return text;
}

// A json_dump_callback_t. Escapes each "<", so that no text can end the script block or begin a
// comment in it.
static int put_json(const char *text, size_t size, void *stream)
{
    for (size_t i = 0; i < size; ++i)
        if (text[i] == '<')
            fputs("\\u003c", stream);
        else
            fputc(text[i], stream);
    return 0;
}

static void copy(FILE *to, FILE *from, long size)
{
    char block[16384];
    while (size > 0) {
        size_t wanted = size < (long)sizeof block ? (size_t)size : sizeof block;
        size_t read = fread(block, 1, wanted, from);
        if (!read) return;
        fwrite(block, 1, read, to);
        size -= (long)read;
    }
}

static void put_images(const Report *report)
{
    long begin = 0;
    rewind(report->images);
    for (int i = 0; i < report->image_count; begin = report->list[i++].end)
        if (report->list[i].omitted)
            fseek(report->images, report->list[i].end, SEEK_SET);
        else
            copy(report->file.stream, report->images, report->list[i].end - begin);
}

static void put_policy(FILE *stream, const char *kind)
{
    fprintf(stream,
            "default-src 'none'; img-src data: blob:; style-src 'sha256-%s' 'sha256-%s'; "
            "script-src 'sha256-%s' 'sha256-%s'; base-uri 'none'; form-action 'none'",
            find_text("page", "css")->hash, find_text(kind, "css")->hash,
            find_text("page", "js")->hash, find_text(kind, "js")->hash);
}

// Writes the replacement for {{WORD}} in page.html: "page.css" stands for the text of that file,
// "kind.css" for the style sheet of KIND.
static void put_word(const Report *report, const char *word, const char *kind, const json_t *data)
{
    FILE *stream = report->file.stream;
    if (strncmp(word, "policy}", 7) == 0)
        put_policy(stream, kind);
    else if (strncmp(word, "data}", 5) == 0)
        json_dump_callback(data, put_json, stream, JSON_COMPACT | JSON_REAL_PRECISION(9));
    else if (strncmp(word, "images}", 7) == 0)
        put_images(report);
    else {
        char suffix[8];
        snprintf(suffix, sizeof suffix, "%.*s", (int)strcspn(word + 5, "}"), word + 5);
        fputs(find_text(strncmp(word, "kind.", 5) == 0 ? kind : "page", suffix)->text, stream);
    }
}

static void put_page(const Report *report, const char *kind, const json_t *data)
{
    const char *at = find_text("page", "html")->text, *open;
    while ((open = strstr(at, "{{"))) {
        fwrite(at, 1, (size_t)(open - at), report->file.stream);
        put_word(report, open + 2, kind, data);
        at = strstr(open, "}}") + 2;
    }
    fputs(at, report->file.stream);
}

Result report_open(Report *report, const char *path, Error *error)
{
    *report = (Report){0};
    TRY(outfile_open(&report->file, path, error));
    report->images = outfile_open_scratch();
    if (report->images) return RESULT_OK;
    int reason = errno;
    report_discard(report);
    return error_set(error, RESULT_FAILED, "scratch file for the images of %s: %s", path,
                     strerror(reason));
}

static Result fail_images(const Report *report, Error *error)
{
    return error_set(error, RESULT_FAILED, "scratch file for the images of %s: %s",
                     report->file.path, strerror(errno));
}

static bool make_room(Report *report)
{
    if (report->image_count < report->room) return true;
    int room = 2 * report->room + 64;
    struct ReportImage *list = realloc(report->list, (size_t)room * sizeof *list);
    if (!list) return false;
    report->list = list;
    report->room = room;
    return true;
}

Result report_add_image(Report *report, const Bytes *file, int *number, Error *error)
{
    if (!make_room(report))
        return error_set(error, RESULT_FAILED, "no memory for the images of %s", report->file.path);
    *number = report->image_count++;
    fprintf(report->images, "<script type=\"text/plain\" id=\"image-%d\">", *number);
    put_base64(report->images, file);
    fputs("</script>\n", report->images);
    report->list[*number] = (struct ReportImage){.end = ftell(report->images)};
    return ferror(report->images) ? fail_images(report, error) : RESULT_OK;
}

void report_omit_image(Report *report, int number)
{
    report->list[number].omitted = true;
}

Result report_close(Report *report, const char *kind, const json_t *data, Error *error)
{
    Result result = fflush(report->images) == 0 ? RESULT_OK : fail_images(report, error);
    if (json_memory_short())
        result = error_set(error, RESULT_FAILED, "%s: no memory for the page", report->file.path);
    if (!data) THEN(result, error_set(error, RESULT_FAILED, "no memory for the report"));
    if (result == RESULT_OK) put_page(report, kind, data);
    if (result == RESULT_OK && ferror(report->images)) result = fail_images(report, error);
    THEN(result, outfile_commit(&report->file, error));
    report_discard(report);
    return result;
}

void report_discard(Report *report)
{
    outfile_discard(&report->file);
    if (report->images) fclose(report->images);
    free(report->list);
    *report = (Report){0};
}

// --- Values.

json_t *report_text(const char *text)
{
    char *clean = utf8_clean(text, strlen(text));
    json_t *value = clean ? json_string(clean) : NULL;
    free(clean);
    return value;
}

json_t *report_base64(const Bytes *bytes)
{
    if (!bytes->size) return json_null();
    char *text = malloc(bytes->size / 3 * 4 + 8);
    if (!text) return NULL;
    json_t *value = json_stringn(text, encode_base64(text, bytes->data, bytes->size));
    free(text);
    return value;
}
