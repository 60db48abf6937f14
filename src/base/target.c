// SPDX-License-Identifier: MIT
#include "base/target.h"

#include "base/outfile.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

static bool has_suffix(const char *text, const char *suffix)
{
    size_t length = strlen(text), suffix_length = strlen(suffix);
    return length > suffix_length && strcasecmp(text + length - suffix_length, suffix) == 0;
}

static bool is_folder(const char *text)
{
    struct stat status;
    size_t length = strlen(text);
    if (length > 0 && text[length - 1] == '/') return true;
    return stat(text, &status) == 0 && S_ISDIR(status.st_mode);
}

static Result fail_memory(Error *error)
{
    return error_set(error, RESULT_FAILED, "no memory for the name of the output");
}

static Result take_folder(Target *target, const char *text, Error *error)
{
    bool slash = text[strlen(text) - 1] == '/';
    if (asprintf(&target->before, "%s%sframe_", text, slash ? "" : "/") < 0) target->before = NULL;
    target->after = strdup(".png");
    target->digits = 4;
    return target->before && target->after ? RESULT_OK : fail_memory(error);
}

// Reads "d" or "0Nd" after a percent sign. Returns its length, 0 if it is something else.
static int read_conversion(const char *at, int *digits)
{
    *digits = 1;
    if (at[0] == 'd') return 1;
    if (at[0] != '0' || at[1] < '1' || at[1] > '9' || at[2] != 'd') return 0;
    *digits = at[1] - '0';
    return 3;
}

// Splits the pattern into `before` and `after`, which have room for the whole text; "%%" becomes
// "%". Returns the number of conversions, or -1 if a percent sign starts none.
static int split_pattern(Target *target, const char *text)
{
    int numbers = 0;
    char *out = target->before;
    for (const char *at = text; *at; at++) {
        if (at[0] != '%' || at[1] == '%') {
            *out++ = *at;
            at += at[0] == '%';
            continue;
        }
        int length = read_conversion(at + 1, &target->digits);
        if (length == 0) return -1;
        if (numbers++ == 0) {
            *out = 0;
            out = target->after;
        }
        at += length;
    }
    *out = 0;
    return numbers;
}

static Result take_pattern(Target *target, const char *text, Error *error)
{
    target->before = calloc(1, strlen(text) + 1);
    target->after = calloc(1, strlen(text) + 1);
    if (!target->before || !target->after) return fail_memory(error);
    int numbers = split_pattern(target, text);
    if (numbers < 0 || numbers > 1)
        return error_set(error, RESULT_USAGE,
                         "%s: a wrong or second frame number: expected one %%d or %%04d (%%%% "
                         "stands for a percent sign)",
                         text);
    if (strchr(target->after, '/'))
        return error_set(error, RESULT_USAGE,
                         "%s: the frame number must be in the file's name, not in a folder's",
                         text);
    if (numbers == 0) target->kind = TARGET_STILL;
    return RESULT_OK;
}

static Result take_one(Target *target, const char *text, TargetFormat format, Error *error)
{
    target->kind = TARGET_VIDEO;
    target->format = format;
    target->before = strdup(text);
    return target->before ? RESULT_OK : fail_memory(error);
}

// Parses "-", "-.png" and similar.
static Result take_stream(Target *target, const char *text, Error *error)
{
    static const struct {
        const char *text;
        TargetFormat format;
        TargetKind kind;
    } streams[] = {{"-", TARGET_PNG, TARGET_VIDEO},
                   {"-.png", TARGET_PNG, TARGET_VIDEO},
                   {"-.y4m", TARGET_Y4M, TARGET_VIDEO},
                   {"-.pfm", TARGET_PFM, TARGET_STILL},
                   {"-.exr", TARGET_EXR, TARGET_STILL}};
    for (size_t i = 0; i < sizeof streams / sizeof *streams; ++i) {
        if (strcasecmp(text, streams[i].text) != 0) continue;
        TRY(take_one(target, "-", streams[i].format, error));
        target->kind = streams[i].kind;
        target->stream = true;
        target->floats = target->format == TARGET_PFM || target->format == TARGET_EXR;
        return RESULT_OK;
    }
    return error_set(
        error, RESULT_USAGE,
        "%s: expected - (PNG), -.y4m, -.pfm or -.exr for standard output, or ./%s for a file", text,
        text);
}

static Result take_image(Target *target, const char *text, Error *error)
{
    static const char *const videos[] = {".mp4", ".webm", ".gif", ".y4m"};
    static const struct {
        const char *suffix;
        TargetFormat format;
    } images[] = {{".png", TARGET_PNG},
                  {".pfm", TARGET_PFM},
                  {".exr", TARGET_EXR},
                  {".jpg", TARGET_JPEG},
                  {".jpeg", TARGET_JPEG}};
    if (text[0] == '-' && (!text[1] || text[1] == '.')) return take_stream(target, text, error);
    if (is_folder(text)) return take_folder(target, text, error);
    for (size_t i = 0; i < sizeof images / sizeof *images; ++i) {
        if (!has_suffix(text, images[i].suffix)) continue;
        target->format = images[i].format;
        target->floats = target->format == TARGET_PFM || target->format == TARGET_EXR;
        return take_pattern(target, text, error);
    }
    for (size_t i = 0; i < sizeof videos / sizeof *videos; i++)
        if (has_suffix(text, videos[i]))
            return take_one(target, text, i == 3 ? TARGET_Y4M : TARGET_FFMPEG, error);
    return error_set(error, RESULT_USAGE,
                     "%s: expected a folder with a slash at its end, a name ending in .png, .pfm, "
                     ".exr, .jpg, .mp4, .webm, .gif or .y4m, or - for standard output",
                     *text ? text : "the output's name is empty");
}

Result target_parse(Target *target, const char *text, Error *error)
{
    *target = (Target){.kind = TARGET_FRAMES};
    Result result = take_image(target, text, error);
    if (result != RESULT_OK) target_destroy(target);
    return result;
}

Result target_parse_any(Target *target, const char *text, Error *error)
{
    *target = (Target){.kind = TARGET_FRAMES};
    Result result = take_pattern(target, text, error);
    if (result != RESULT_OK) target_destroy(target);
    return result;
}

void target_destroy(Target *target)
{
    free(target->before);
    free(target->after);
    *target = (Target){0};
}

char *target_name_frame(const Target *target, int frame)
{
    if (target->kind != TARGET_FRAMES) return strdup(target->before);
    char *name = NULL;
    int length = asprintf(&name, "%s%0*d%s", target->before, target->digits, frame + target->offset,
                          target->after);
    return length < 0 ? NULL : name;
}

// The part of the pattern after its folder.
static const char *find_name(const Target *target)
{
    const char *slash = strrchr(target->before, '/');
    return slash ? slash + 1 : target->before;
}

bool target_read_number(const Target *target, const char *name, int *frame)
{
    const char *before = find_name(target);
    size_t length = strlen(before);
    char *end;
    if (strncmp(name, before, length) != 0 || name[length] < '0' || name[length] > '9')
        return false;
    errno = 0;
    long number = strtol(name + length, &end, 10);
    if (errno || number > 999999999) return false;
    *frame = (int)number - target->offset;
    // Reject names with another number of digits: the number's name must be exactly this one.
    char *path = target_name_frame(target, *frame);
    bool own = path && strcmp(path + (before - target->before), name) == 0;
    free(path);
    return own;
}

TargetNumbers target_find_numbers(const Target *target)
{
    TargetNumbers found = {.last = -1};
    int frame;
    const char *name = find_name(target);
    char *folder = strndup(target->before, (size_t)(name - target->before));
    DIR *directory = folder ? opendir(*folder ? folder : ".") : NULL;
    for (const struct dirent *entry; directory && (entry = readdir(directory));)
        if (target_read_number(target, entry->d_name, &frame)) {
            if (!found.count++ || frame < found.first) found.first = frame;
            if (frame > found.last) found.last = frame;
        }
    if (directory) closedir(directory);
    free(folder);
    return found;
}

Result target_prepare(const Target *target, Error *error)
{
    char *name = target_name_frame(target, 0);
    if (!name) return fail_memory(error);
    Result result = outfile_refuse_terminal(name, error);
    THEN(result, outfile_try(name, error));
    free(name);
    return result;
}
