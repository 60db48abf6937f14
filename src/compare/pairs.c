// SPDX-License-Identifier: MIT
#include "compare/pairs.h"

#include "base/bytes.h"
#include "base/suggest.h"
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

// One of the two arguments: a file, a folder or a pattern of numbered files.
typedef struct Side {
    const char *text;
    Kind kind;
    bool missing;                      // does not exist, which is allowed for A with --update
    bool (*skips)(const char *folder); // subfolders with other images; NULL: none
    Target target;
    size_t count; // sides[0] only: pairs listed so far, sorted by name
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

// --- Names of images.

// The path of an image: `name` in a folder, or number `frame` of a pattern.
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
    // JPEG files are listed so that they are refused with a message instead of ignored.
    static const char *const SUFFIXES[] = {".png", ".pfm", ".exr", ".jpg", ".jpeg"};
    for (size_t i = 0; i < sizeof SUFFIXES / sizeof *SUFFIXES && dot; ++i)
        if (strcasecmp(dot, SUFFIXES[i]) == 0) return name[0] != '.';
    return false;
}

// --- The list.

// Compares numbers in names by value, so frame_10 comes after frame_9.
static int order(const void *a, const void *b)
{
    return strverscmp(((const Pair *)a)->a, ((const Pair *)b)->a);
}

static Result add_pair(PairList *list, const Side sides[2], const char *name, int frame, int from,
                       Error *error)
{
    char *a = place_of(&sides[0], name, frame);
    if (!a) return fail_memory(error);
    // The pairs of earlier sides are sorted; look there for the partner of this image.
    Pair key = {.a = a}, *pair = NULL;
    if (from >= 0 && sides[0].count)
        pair = bsearch(&key, list->pairs, sides[0].count, sizeof *pair, order);
    if (pair) {
        pair->has_a |= from == 0;
        pair->has_b |= from == 1;
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

// Names of images in a folder and its subfolders, relative to the folder: "walk/0001.png"; or the
// names that match a pattern, in its folder alone.
typedef struct Names {
    char **list;
    int *frames; // the numbers; of patterns
    size_t count;
} Names;

static void names_destroy(Names *names)
{
    for (size_t i = 0; i < names->count; ++i) free(names->list[i]);
    free(names->list);
    free(names->frames);
    *names = (Names){0};
}

static Result add_name(Names *names, const char *name, int frame, Error *error)
{
    char **list = realloc(names->list, (names->count + 1) * sizeof *list);
    if (list) names->list = list;
    int *frames = realloc(names->frames, (names->count + 1) * sizeof *frames);
    if (frames) names->frames = frames;
    char *copy = list && frames ? strdup(name) : NULL;
    if (!copy) return fail_memory(error);
    list[names->count] = copy;
    frames[names->count++] = frame;
    return RESULT_OK;
}

static char *folder_of(const Side *side)
{
    const char *before = side->kind == KIND_PATTERN ? side->target.before : side->text;
    const char *slash = strrchr(before, '/');
    if (side->kind == KIND_FOLDER) return strdup(before);
    return slash ? strndup(before, (size_t)(slash - before) + 1) : strdup(".");
}

static Result read_folder(Names *names, const Side *side, const char *path, const char *prefix,
                          Error *error);

// An entry of the folder `path`, whose name relative to the side begins with `prefix`.
static Result read_entry(Names *names, const Side *side, const char *path, const char *prefix,
                         const char *entry, Error *error)
{
    // Deeper folders are a loop of links.
    enum { MOST_SLASHES = 32 };
    struct stat status;
    int frame = 0, slashes = 0;
    char *name = NULL, *inner = NULL;
    if (side->kind == KIND_PATTERN)
        return target_read_number(&side->target, entry, &frame)
                   ? add_name(names, entry, frame, error)
                   : RESULT_OK;
    if (entry[0] == '.') return RESULT_OK;
    if (asprintf(&name, "%s%s", prefix, entry) < 0) return fail_memory(error);
    if (asprintf(&inner, "%s/%s", path, entry) < 0) {
        free(name);
        return fail_memory(error);
    }
    Result result = RESULT_OK;
    if (stat(inner, &status) == 0 && S_ISDIR(status.st_mode)) {
        for (const char *at = name; *at; ++at) slashes += *at == '/';
        char *deeper = NULL;
        if (slashes >= MOST_SLASHES)
            result = error_set(error, RESULT_BAD_INPUT, "%s: folders in each other: expected %d",
                               inner, MOST_SLASHES);
        else if (asprintf(&deeper, "%s/", name) < 0)
            result = fail_memory(error);
        else if (!prefix[0] && side->skips && side->skips(entry))
            result = RESULT_OK;
        else
            result = read_folder(names, side, inner, deeper, error);
        free(deeper);
    } else if (is_image(entry)) {
        result = add_name(names, name, 0, error);
    }
    free(name);
    free(inner);
    return result;
}

static Result read_folder(Names *names, const Side *side, const char *path, const char *prefix,
                          Error *error)
{
    DIR *directory = opendir(path);
    if (!directory && errno == ENOENT && side->missing && !*prefix) return RESULT_OK;
    if (!directory)
        return error_set(error, RESULT_BAD_INPUT, "%s: %s", *prefix ? path : side->text,
                         strerror(errno));
    Result result = RESULT_OK;
    const struct dirent *entry;
    while (result == RESULT_OK && (entry = readdir(directory)))
        result = read_entry(names, side, path, prefix, entry->d_name, error);
    closedir(directory);
    return result;
}

// To be destroyed, also after a failure.
static Result read_names(Names *names, const Side *side, Error *error)
{
    char *folder = folder_of(side);
    *names = (Names){0};
    Result result = folder ? read_folder(names, side, folder, "", error) : fail_memory(error);
    free(folder);
    return result;
}

// Lists the images in the folder of `side` and sorts all pairs. `from`: 0 if these images are A, 1
// if they are B, -1 for neither.
static Result list_side(PairList *list, Side sides[2], const Side *side, int from, Error *error)
{
    Names names;
    Result result = read_names(&names, side, error);
    for (size_t i = 0; i < names.count && result == RESULT_OK; ++i)
        result = add_pair(list, sides, names.list[i], names.frames[i], from, error);
    names_destroy(&names);
    sides[0].count = list->count;
    if (list->count) qsort(list->pairs, list->count, sizeof *list->pairs, order);
    return result;
}

// --- Goldens by platform.

// The folder of a level; it may not exist. Free `text`.
static Side side_of_level(const Side *goldens, Level level, const char *platform, char **text)
{
    *text = place_of(goldens, level_folder(level, platform), 0);
    return (Side){.text = *text,
                  .kind = KIND_FOLDER,
                  .missing = goldens->missing || level != LEVEL_COMMON,
                  .skips = level == LEVEL_COMMON ? level_has_folder : NULL};
}

static Result list_levels(PairList *list, Side sides[2], const PairOptions *options, Error *error)
{
    Result result = RESULT_OK;
    for (Level level = LEVEL_PLATFORM; level < LEVELS && result == RESULT_OK; ++level) {
        char *text;
        Side side = side_of_level(&sides[0], level, options->platform, &text);
        if (!text) return fail_memory(error);
        if (level_counts(level, options->platform, options->any_platform))
            result = list_side(list, sides, &side, 0, error);
        free(text);
    }
    return result;
}

// The path of the golden image with this name at this level, and whether it exists. NULL: no
// memory.
static char *golden_of(const Side *goldens, Level level, const PairOptions *options,
                       const char *name, bool *there)
{
    char *text;
    Side side = side_of_level(goldens, level, options->platform, &text);
    char *path = text ? place_of(&side, name, 0) : NULL;
    *there = path && access(path, F_OK) == 0;
    free(text);
    return path;
}

// Sets A to the golden image that applies, or to the path of a new one. The fallback is the next
// golden image that would apply without A.
static Result choose_golden(Pair *pair, const Side *goldens, const PairOptions *options,
                            Error *error)
{
    free(pair->a);
    pair->a = NULL;
    pair->has_a = false;
    for (Level level = options->update ? options->update : LEVEL_PLATFORM; level < LEVELS;
         ++level) {
        bool there;
        char *path = golden_of(goldens, level, options, pair->name, &there);
        if (!path) return fail_memory(error);
        bool counts = there && level_counts(level, options->platform, options->any_platform);
        pair->not_for_gpus |= there && !counts;
        if (!pair->a && (counts || options->update)) {
            pair->a = path, pair->has_a = there, pair->level = level;
        } else if (pair->a && !pair->fallback && counts) {
            pair->fallback = path;
        } else {
            free(path);
        }
    }
    if (pair->a) return RESULT_OK;
    pair->level = level_of_new(options->platform);
    pair->a = golden_of(goldens, pair->level, options, pair->name, &pair->has_a);
    pair->has_a = false;
    return pair->a ? RESULT_OK : fail_memory(error);
}

// --- Files with lines about images: --unrendered (why an image is missing), --commands (what makes
// it).

// The name of one image, or a pattern such as frame_%d.png for several. To be destroyed.
static Side side_of_name(const char *name)
{
    Side named = {.text = name, .kind = KIND_FILE};
    if (target_parse_any(&named.target, name, NULL) == RESULT_OK &&
        named.target.kind == TARGET_FRAMES)
        named.kind = KIND_PATTERN;
    return named;
}

// Whether `named` means this pair.
static bool is_of(const Side *named, const Pair *pair)
{
    int frame;
    if (named->kind != KIND_PATTERN) return strcmp(named->text, pair->name) == 0;
    const char *before = named->target.before, *slash = strrchr(before, '/');
    size_t folder = slash ? (size_t)(slash - before) + 1 : 0;
    return strncmp(pair->name, before, folder) == 0 &&
           target_read_number(&named->target, pair->name + folder, &frame);
}

static Result give_text(char **to, const char *text, Error *error)
{
    if (*to) return RESULT_OK; // the first line about an image counts
    *to = strdup(text);
    return *to ? RESULT_OK : fail_memory(error);
}

// Handles one line for the images that `named` means: give_reason or give_command.
typedef Result GiveLine(PairList *list, Side sides[2], const Side *named, const char *text,
                        Error *error);

static Result give_reason(PairList *list, Side sides[2], const Side *named, const char *text,
                          Error *error)
{
    Result result = RESULT_OK;
    bool found = false;
    for (size_t i = 0; i < list->count && result == RESULT_OK; ++i) {
        Pair *pair = &list->pairs[i];
        if (pair->has_b || !is_of(named, pair)) continue;
        found = true;
        result = give_text(&pair->unrendered, text, error);
    }
    if (found || result != RESULT_OK) return result;
    TRY(add_pair(list, sides, named->text, 0, -1, error));
    return give_text(&list->pairs[list->count - 1].unrendered, text, error);
}

static Result give_command(PairList *list, Side sides[2], const Side *named, const char *text,
                           Error *error)
{
    (void)sides;
    Result result = RESULT_OK;
    for (size_t i = 0; i < list->count && result == RESULT_OK; ++i)
        if (is_of(named, &list->pairs[i])) result = give_text(&list->pairs[i].command, text, error);
    return result;
}

// Reads lines of the form "NAME: TEXT".
static Result read_lines(PairList *list, Side sides[2], const char *path, const char *what,
                         GiveLine *give, Error *error)
{
    Bytes file;
    TRY(bytes_read_file(&file, path, error));
    Result result = RESULT_OK;
    char *rest = NULL, *line = strtok_r((char *)file.data, "\n", &rest);
    for (; line && result == RESULT_OK; line = strtok_r(NULL, "\n", &rest)) {
        char *colon = strstr(line, ": ");
        if (!colon || colon == line) {
            result = error_set(error, RESULT_BAD_INPUT, "%s: got '%.60s', expected NAME: %s", path,
                               line, what);
            break;
        }
        *colon = 0;
        Side named = side_of_name(line);
        result = give(list, sides, &named, colon + 2, error);
        target_destroy(&named.target);
    }
    bytes_destroy(&file);
    return result;
}

// Refuses options that name single images if A and B are not folders.
static Result check_kind(Kind kind, const PairOptions *options, Error *error)
{
    const char *option = options->unrendered ? "--unrendered"
                         : options->commands ? "--commands"
                         : options->only     ? "--only"
                         : options->platform ? "--platform"
                                             : NULL;
    if (!option || kind == KIND_FOLDER) return RESULT_OK;
    return error_set(error, RESULT_USAGE, "%s: got %s, expected two folders", option,
                     kind == KIND_PATTERN ? "patterns" : "two files");
}

static void pair_destroy(Pair *pair)
{
    free(pair->name);
    free(pair->a);
    free(pair->b);
    free(pair->mask);
    free(pair->unrendered);
    free(pair->command);
    free(pair->fallback);
}

// ": did you mean 'x.png'?" if an image has a similar name.
static void suggest(const PairList *list, const char *name, char *words, size_t size)
{
    const char **names = malloc((list->count + 1) * sizeof *names);
    for (size_t i = 0; names && i < list->count; ++i) names[i] = list->pairs[i].name;
    const char *nearest = names ? suggest_nearest(name, names, list->count) : NULL;
    if (nearest) snprintf(words, size, ": did you mean '%.100s'?", nearest);
    free(names);
}

// Removes all pairs that `name` does not mean.
static Result keep_only(PairList *list, const char *name, Error *error)
{
    Side named = side_of_name(name);
    char words[200] = "";
    size_t kept = 0;
    suggest(list, name, words, sizeof words);
    for (size_t i = 0; i < list->count; ++i)
        if (is_of(&named, &list->pairs[i]))
            list->pairs[kept++] = list->pairs[i];
        else
            pair_destroy(&list->pairs[i]);
    list->count = kept;
    target_destroy(&named.target);
    if (kept) return RESULT_OK;
    return error_set(error, RESULT_BAD_INPUT, "--only %s: no image of this name%s", name, words);
}

// --- Masks.

// Whether two file names are equal without their suffixes.
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

// Gives a mask to the pairs that it belongs to. `all`: the list was not shortened by --only, so a
// mask without a pair is an error.
static Result give_mask(PairList *list, const Side *masks, const char *name, int frame, bool all,
                        Error *error)
{
    bool found = false;
    for (size_t i = 0; i < list->count; ++i) {
        Pair *pair = &list->pairs[i];
        if (masks->kind == KIND_PATTERN
                ? pair->frame != frame
                : !have_one_stem(name, list->many ? pair->name : file_name(pair->a)))
            continue;
        if (pair->mask)
            return error_set(error, RESULT_BAD_INPUT,
                             "%s: two masks for %s: %s and %s: expected one", masks->text,
                             pair->name, file_name(pair->mask), name);
        found = true;
        pair->mask = place_of(masks, name, frame);
        if (!pair->mask) return fail_memory(error);
    }
    if (found || !all) return RESULT_OK;
    return error_set(error, RESULT_BAD_INPUT,
                     "%s: the mask %s belongs to no image: expected a mask with the %s of an image",
                     masks->text, name, masks->kind == KIND_PATTERN ? "number" : "name");
}

static Result give_masks(PairList *list, const Side *masks, bool all, Error *error)
{
    Names names;
    Result result = read_names(&names, masks, error);
    if (result == RESULT_OK && names.count == 0)
        result = error_set(error, RESULT_BAD_INPUT,
                           "%s: no masks: expected images in this folder or of this pattern",
                           masks->text);
    for (size_t i = 0; i < names.count && result == RESULT_OK; ++i)
        result = give_mask(list, masks, names.list[i], names.frames[i], all, error);
    names_destroy(&names);
    return result;
}

static Result find_masks(PairList *list, const Side sides[2], const PairOptions *options,
                         Error *error)
{
    const char *text = options->mask;
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
    Result result = give_masks(list, &masks, !options->only, error);
    target_destroy(&masks.target);
    return result;
}

// --- Pairs of two files, folders or patterns.

static Result pair_files(PairList *list, const Side sides[2], Error *error)
{
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

static Result pair_many(PairList *list, Side sides[2], const PairOptions *options, Error *error)
{
    list->many = true;
    list->by_platform = options->platform != NULL;
    for (int i = 0; i < 2; ++i)
        if (sides[i].kind == KIND_PATTERN)
            TRY(target_parse(&sides[i].target, sides[i].text, error));
    if (options->platform)
        TRY(list_levels(list, sides, options, error));
    else
        TRY(list_side(list, sides, &sides[0], 0, error));
    TRY(list_side(list, sides, &sides[1], 1, error));
    if (options->unrendered)
        TRY(read_lines(list, sides, options->unrendered, "REASON", give_reason, error));
    if (options->commands)
        TRY(read_lines(list, sides, options->commands, "COMMAND", give_command, error));
    if (list->count == 0)
        return error_set(error, RESULT_BAD_INPUT,
                         "%s and %s: no images: expected .png, .pfm or .exr files", sides[0].text,
                         sides[1].text);
    qsort(list->pairs, list->count, sizeof *list->pairs, order);
    if (options->only) TRY(keep_only(list, options->only, error));
    for (size_t i = 0; i < list->count && options->platform; ++i)
        TRY(choose_golden(&list->pairs[i], &sides[0], options, error));
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
        result =
            error_set(error, RESULT_USAGE,
                      "%s is %s, but %s is %s: expected two files, two folders or two patterns", a,
                      KIND_NAMES[sides[0].kind], b, KIND_NAMES[sides[1].kind]);
    else
        result = check_kind(sides[0].kind, options, error);
    if (sides[0].kind == KIND_FILE)
        THEN(result, pair_files(list, sides, error));
    else
        THEN(result, pair_many(list, sides, options, error));
    if (options->mask) THEN(result, find_masks(list, sides, options, error));
    for (int i = 0; i < 2; ++i) target_destroy(&sides[i].target);
    if (result != RESULT_OK) pairs_destroy(list);
    return result;
}

void pairs_destroy(PairList *list)
{
    for (size_t i = 0; i < list->count; ++i) pair_destroy(&list->pairs[i]);
    free(list->pairs);
    *list = (PairList){0};
}
