// SPDX-License-Identifier: MIT
#include "compare/pairs.h"

#include "base/bytes.h"
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
    return name[0] != '.' && dot &&
           (strcasecmp(dot, ".png") == 0 || strcasecmp(dot, ".pfm") == 0 ||
            strcasecmp(dot, ".exr") == 0);
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
    pair->frame = frame;
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
                                      : target_read_number(&side->target, entry->d_name, &frame))
            result = add_pair(list, sides, entry->d_name, frame, from, error);
    }
    closedir(directory);
    return result;
}

// --- Images that could not be made.

// Whether the pair has this name, or a number in it.
static bool is_of(const Side *named, const Pair *pair)
{
    int frame;
    return named->kind == KIND_PATTERN ? target_read_number(&named->target, pair->name, &frame)
                                       : strcmp(named->text, pair->name) == 0;
}

static Result give_reason(Pair *pair, const char *reason, Error *error)
{
    if (pair->unrendered) return RESULT_OK; // the first one counts
    pair->unrendered = strdup(reason);
    return pair->unrendered ? RESULT_OK : fail_memory(error);
}

static Result add_unrendered(PairList *list, const Side sides[2], const char *name,
                             const char *reason, Error *error)
{
    Side named = {.text = name, .kind = KIND_FILE};
    if (target_parse_any(&named.target, name, NULL) == RESULT_OK &&
        named.target.kind == TARGET_FRAMES)
        named.kind = KIND_PATTERN;
    Result result = RESULT_OK;
    bool found = false;
    for (size_t i = 0; i < list->count && result == RESULT_OK; ++i) {
        Pair *pair = &list->pairs[i];
        if (pair->has_b || !is_of(&named, pair)) continue;
        found = true;
        result = give_reason(pair, reason, error);
    }
    if (!found) {
        THEN(result, add_pair(list, sides, name, 0, -1, error));
        THEN(result, give_reason(&list->pairs[list->count - 1], reason, error));
    }
    target_destroy(&named.target);
    return result;
}

static Result read_unrendered(PairList *list, const Side sides[2], const char *path, Error *error)
{
    Bytes file;
    if (sides[0].kind != KIND_FOLDER)
        return error_set(error, RESULT_USAGE, "--unrendered is for folders: got patterns");
    TRY(bytes_read_file(&file, path, error));
    Result result = RESULT_OK;
    char *rest = NULL, *line = strtok_r((char *)file.data, "\n", &rest);
    for (; line && result == RESULT_OK; line = strtok_r(NULL, "\n", &rest)) {
        char *colon = strstr(line, ": ");
        if (!colon || colon == line) {
            result = error_set(error, RESULT_BAD_INPUT, "%s: got '%.60s', expected NAME: REASON",
                               path, line);
            break;
        }
        *colon = 0;
        result = add_unrendered(list, sides, line, colon + 2, error);
    }
    bytes_destroy(&file);
    return result;
}

// --- Masks.

// Whether the two file names are equal but for their suffixes.
static bool have_one_stem(const char *a, const char *b)
{
    const char *dot_a = strrchr(a, '.'), *dot_b = strrchr(b, '.');
    size_t length = dot_a ? (size_t)(dot_a - a) : strlen(a);
    return length == (dot_b ? (size_t)(dot_b - b) : strlen(b)) && strncmp(a, b, length) == 0;
}

static const char *file_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

// Gives the mask, a file in a folder or one of a pattern, to its pairs.
static Result give_mask(PairList *list, const Side *masks, const char *name, int frame,
                        Error *error)
{
    bool found = false;
    for (size_t i = 0; i < list->count; ++i) {
        Pair *pair = &list->pairs[i];
        if (masks->kind == KIND_PATTERN ? pair->frame != frame
                                        : !have_one_stem(name, file_name(pair->a)))
            continue;
        if (pair->mask)
            return error_set(error, RESULT_BAD_INPUT, "%s: two masks for %s: %s and %s",
                             masks->text, pair->name, file_name(pair->mask), name);
        found = true;
        pair->mask = place_of(masks, name, frame);
        if (!pair->mask) return fail_memory(error);
    }
    if (found) return RESULT_OK;
    return error_set(error, RESULT_BAD_INPUT,
                     "%s: the mask %s belongs to no image: expected the %s", masks->text, name,
                     masks->kind == KIND_PATTERN ? "number of one" : "name of one");
}

static Result give_masks(PairList *list, const Side *masks, Error *error)
{
    DIR *directory = open_folder(masks);
    if (!directory)
        return error_set(error, RESULT_BAD_INPUT, "%s: %s", masks->text, strerror(errno));
    Result result = RESULT_OK;
    const struct dirent *entry;
    size_t count = 0;
    while (result == RESULT_OK && (entry = readdir(directory))) {
        int frame = 0;
        if (masks->kind == KIND_FOLDER ? !is_image(entry->d_name)
                                       : !target_read_number(&masks->target, entry->d_name, &frame))
            continue;
        ++count;
        result = give_mask(list, masks, entry->d_name, frame, error);
    }
    closedir(directory);
    if (result == RESULT_OK && count == 0)
        return error_set(error, RESULT_BAD_INPUT, "%s: no mask there", masks->text);
    return result;
}

static Result find_masks(PairList *list, const Side sides[2], const char *text, Error *error)
{
    Side masks = {.text = text};
    find_kind(&masks);
    if (masks.kind == KIND_FILE) {
        for (size_t i = 0; i < list->count; ++i) {
            list->pairs[i].mask = strdup(text);
            if (!list->pairs[i].mask) return fail_memory(error);
        }
        return RESULT_OK;
    }
    if (masks.kind == KIND_PATTERN) {
        if (sides[0].kind != KIND_PATTERN)
            return error_set(error, RESULT_USAGE,
                             "--mask: %s is a pattern, but %s is %s: expected a file or a folder",
                             text, sides[0].text, KIND_NAMES[sides[0].kind]);
        TRY(target_parse(&masks.target, text, error));
    }
    Result result = give_masks(list, &masks, error);
    target_destroy(&masks.target);
    return result;
}

// ---

static Result pair_files(PairList *list, const Side sides[2], const char *unrendered, Error *error)
{
    if (unrendered)
        return error_set(error, RESULT_USAGE, "--unrendered is for folders: got two files");
    const char *a = sides[0].text, *b = sides[1].text;
    list->pairs = calloc(1, sizeof *list->pairs);
    if (!list->pairs) return fail_memory(error);
    list->count = 1;
    list->pairs[0] = (Pair){.name = strdup(b),
                            .a = strdup(a),
                            .b = strdup(b),
                            .has_a = !sides[0].missing,
                            .has_b = true};
    return list->pairs->name && list->pairs->a && list->pairs->b ? RESULT_OK : fail_memory(error);
}

static Result pair_many(PairList *list, Side sides[2], const char *unrendered, Error *error)
{
    list->many = true;
    for (int i = 0; i < 2; ++i)
        if (sides[i].kind == KIND_PATTERN)
            TRY(target_parse(&sides[i].target, sides[i].text, error));
    TRY(list_side(list, sides, 0, error));
    sides[0].count = list->count;
    if (list->count) qsort(list->pairs, list->count, sizeof *list->pairs, order);
    TRY(list_side(list, sides, 1, error));
    if (unrendered) TRY(read_unrendered(list, sides, unrendered, error));
    if (list->count == 0)
        return error_set(error, RESULT_BAD_INPUT, "%s and %s: no image in either", sides[0].text,
                         sides[1].text);
    qsort(list->pairs, list->count, sizeof *list->pairs, order);
    return RESULT_OK;
}

Result pairs_find(PairList *list, const char *a, const char *b, const PairOptions *options,
                  Error *error)
{
    Side sides[2] = {{.text = a}, {.text = b}};
    *list = (PairList){0};
    for (int i = 0; i < 2; ++i) find_kind(&sides[i]);
    if (options->create && sides[0].missing && sides[0].kind != KIND_PATTERN)
        sides[0].kind = sides[1].kind;
    if (!options->create) sides[0].missing = false;
    Result result;
    if (sides[0].kind != sides[1].kind)
        result = error_set(error, RESULT_USAGE, "%s is %s, but %s is %s: expected two of a kind", a,
                           KIND_NAMES[sides[0].kind], b, KIND_NAMES[sides[1].kind]);
    else if (sides[0].kind == KIND_FILE)
        result = pair_files(list, sides, options->unrendered, error);
    else
        result = pair_many(list, sides, options->unrendered, error);
    if (options->mask) THEN(result, find_masks(list, sides, options->mask, error));
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
        free(list->pairs[i].mask);
        free(list->pairs[i].unrendered);
    }
    free(list->pairs);
    *list = (PairList){0};
}
