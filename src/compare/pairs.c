// SPDX-License-Identifier: MIT
#include "compare/pairs.h"

#include "base/target.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

typedef enum Kind { KIND_FILE, KIND_FOLDER, KIND_PATTERN } Kind;

static const char *const KIND_NAMES[] = {"a file", "a folder", "a pattern"};

// One of the two places.
typedef struct Side {
    const char *text;
    Kind kind;
    bool missing; // and that is legal
    Target target;
    size_t count; // images found, of the first side only
} Side;

static Result fail_memory(Error *error)
{
    return error_set(error, RESULT_FAILED, "no memory for the list of images");
}

static void find_kind(Side *side)
{
    struct stat status;
    size_t length = strlen(side->text);
    bool exists = stat(side->text, &status) == 0;
    if (length > 0 && side->text[length - 1] == '/')
        side->kind = KIND_FOLDER;
    else if (exists)
        side->kind = S_ISDIR(status.st_mode) ? KIND_FOLDER : KIND_FILE;
    else
        side->kind = strchr(side->text, '%') ? KIND_PATTERN : KIND_FILE;
    side->missing = !exists;
}

// --- An image's name at each side.

// Where the image is: `name` in a folder, or number `frame` of a pattern.
static char *place_of(const Side *side, const char *name, int frame)
{
    char *path;
    size_t length = strlen(side->text);
    if (side->kind == KIND_PATTERN) return target_name_frame(&side->target, frame);
    const char *slash = length > 0 && side->text[length - 1] == '/' ? "" : "/";
    return asprintf(&path, "%s%s%s", side->text, slash, name) < 0 ? NULL : path;
}

static bool is_image(const char *name)
{
    const char *dot = strrchr(name, '.');
    return name[0] != '.' && dot && (strcasecmp(dot, ".png") == 0 || strcasecmp(dot, ".pfm") == 0);
}

// Whether the file is one of a pattern, and which: the name that its number gives must be its own.
static bool read_number(const Side *side, const char *name, int *frame)
{
    const char *slash = strrchr(side->target.before, '/');
    const char *before = slash ? slash + 1 : side->target.before;
    size_t length = strlen(before);
    char *end;
    if (strncmp(name, before, length) != 0 || name[length] < '0' || name[length] > '9')
        return false;
    errno = 0;
    long number = strtol(name + length, &end, 10);
    if (errno || number > 999999999) return false;
    *frame = (int)number;
    char *path = place_of(side, NULL, *frame);
    size_t folder = slash ? (size_t)(before - side->target.before) : 0;
    bool own = path && strcmp(path + folder, name) == 0;
    free(path);
    return own;
}

// --- The list.

// Numbers by value, so that a digit more is a later frame.
static int order(const void *a, const void *b)
{
    return strverscmp(((const Pair *)a)->a, ((const Pair *)b)->a);
}

static Result add_pair(PairList *list, const Side sides[2], const char *name, int frame, int from,
                       Error *error)
{
    char *a = place_of(&sides[0], name, frame);
    if (!a) return fail_memory(error);
    // The first side's are sorted by the time the second one's come.
    Pair key = {.a = a}, *pair = NULL;
    if (from == 1 && sides[0].count)
        pair = bsearch(&key, list->pairs, sides[0].count, sizeof *pair, order);
    if (pair) {
        pair->has_b = true;
        free(a);
        return RESULT_OK;
    }
    Pair *pairs = realloc(list->pairs, (list->count + 1) * sizeof *pairs);
    if (!pairs) {
        free(a);
        return fail_memory(error);
    }
    list->pairs = pairs;
    pairs[list->count++] = (Pair){.name = strdup(name),
                                  .a = a,
                                  .b = place_of(&sides[1], name, frame),
                                  .has_a = from == 0,
                                  .has_b = from == 1};
    pair = &pairs[list->count - 1];
    return pair->name && pair->b ? RESULT_OK : fail_memory(error);
}

static DIR *open_folder(const Side *side)
{
    const char *before = side->kind == KIND_PATTERN ? side->target.before : side->text;
    const char *slash = strrchr(before, '/');
    if (side->kind == KIND_FOLDER) return opendir(before);
    if (!slash) return opendir(".");
    char *folder = strndup(before, (size_t)(slash - before) + 1);
    DIR *directory = folder ? opendir(folder) : NULL;
    free(folder);
    return directory;
}

static Result list_side(PairList *list, const Side sides[2], int from, Error *error)
{
    const Side *side = &sides[from];
    DIR *directory = open_folder(side);
    if (!directory && errno == ENOENT && side->missing && from == 0) return RESULT_OK;
    if (!directory)
        return error_set(error, RESULT_BAD_INPUT, "%s: %s", side->text, strerror(errno));
    Result result = RESULT_OK;
    const struct dirent *entry;
    while (result == RESULT_OK && (entry = readdir(directory))) {
        int frame = 0;
        if (side->kind == KIND_FOLDER ? is_image(entry->d_name)
                                      : read_number(side, entry->d_name, &frame))
            result = add_pair(list, sides, entry->d_name, frame, from, error);
    }
    closedir(directory);
    return result;
}

static Result pair_files(PairList *list, const Side sides[2], Error *error)
{
    const char *a = sides[0].text, *b = sides[1].text;
    list->pairs = calloc(1, sizeof *list->pairs);
    if (!list->pairs) return fail_memory(error);
    list->count = 1;
    list->pairs[0] = (Pair){strdup(b), strdup(a), strdup(b), !sides[0].missing, true};
    return list->pairs->name && list->pairs->a && list->pairs->b ? RESULT_OK : fail_memory(error);
}

static Result pair_many(PairList *list, Side sides[2], Error *error)
{
    list->many = true;
    for (int i = 0; i < 2; ++i)
        if (sides[i].kind == KIND_PATTERN)
            TRY(target_parse(&sides[i].target, sides[i].text, error));
    TRY(list_side(list, sides, 0, error));
    sides[0].count = list->count;
    if (list->count) qsort(list->pairs, list->count, sizeof *list->pairs, order);
    TRY(list_side(list, sides, 1, error));
    if (list->count == 0)
        return error_set(error, RESULT_BAD_INPUT, "%s and %s: no image in either", sides[0].text,
                         sides[1].text);
    qsort(list->pairs, list->count, sizeof *list->pairs, order);
    return RESULT_OK;
}

Result pairs_find(PairList *list, const char *a, const char *b, bool create, Error *error)
{
    Side sides[2] = {{.text = a}, {.text = b}};
    *list = (PairList){0};
    for (int i = 0; i < 2; ++i) find_kind(&sides[i]);
    if (create && sides[0].missing && sides[0].kind != KIND_PATTERN) sides[0].kind = sides[1].kind;
    if (!create) sides[0].missing = false;
    Result result;
    if (sides[0].kind != sides[1].kind)
        result = error_set(error, RESULT_USAGE, "%s is %s, but %s is %s: expected two of a kind", a,
                           KIND_NAMES[sides[0].kind], b, KIND_NAMES[sides[1].kind]);
    else if (sides[0].kind == KIND_FILE)
        result = pair_files(list, sides, error);
    else
        result = pair_many(list, sides, error);
    for (int i = 0; i < 2; ++i) target_destroy(&sides[i].target);
    if (result != RESULT_OK) pairs_destroy(list);
    return result;
}

void pairs_destroy(PairList *list)
{
    for (size_t i = 0; i < list->count; ++i) {
        free(list->pairs[i].name);
        free(list->pairs[i].a);
        free(list->pairs[i].b);
    }
    free(list->pairs);
    *list = (PairList){0};
}
