// SPDX-License-Identifier: MIT
// tractrix-gen: makes hair and the mesh it grows on.
#include "bust.h"
#include "strands_make.h"
#include "strands_write.h"
#include "suggest.h"
#include "version.h"

#include <errno.h>
#include <getopt.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define ARRAY_SIZE(array) (sizeof(array) / sizeof *(array))

// --- One table: name, letter, what the value is, where it goes, what it does.

typedef enum OptionKind {
    OPTION_HELP,
    OPTION_VERSION,
    OPTION_QUIET,
    OPTION_WORD,  // one of `words`; an index
    OPTION_COUNT, // uint32_t
    OPTION_NUMBER,
    OPTION_TEXT
} OptionKind;

typedef struct Command {
    StrandsRecipe recipe;
    int format;      // index of format_words
    const char *set; // NULL: none
    const char *output, *mesh, *bust;
    const char *shaping; // an option given that a test set has its own value for; NULL: none
    bool quiet;
} Command;

static const char *const kind_words[] = {"random", "straight", "curls", "fur", NULL};
static const char *const shape_words[] = {"sphere", "head", NULL};
static const char *const format_words[] = {"text", "tfx3", "tfx4", "hair", NULL};
static const char *const set_words[] = {"1k16", "1k32", "10k16", "10k32", NULL};
static const StrandsKind format_kinds[] = {STRANDS_TFX2_TEXT, STRANDS_TFX3, STRANDS_TFX4,
                                           STRANDS_HAIR};

typedef struct Option {
    const char *name;
    char letter;
    OptionKind kind;
    size_t place; // in Command
    const char *const *words;
    const char *value, *help;
} Option;

#define AT(member) offsetof(Command, member)
static const Option options[] = {
    {"kind", 0, OPTION_WORD, AT(recipe.style), kind_words, "WORD",
     "random (segments in random directions), straight, curls or fur"},
    {"shape", 0, OPTION_WORD, AT(recipe.shape), shape_words, "WORD",
     "what it grows on: sphere (radius 0.1 m) or head"},
    {"count", 'n', OPTION_COUNT, AT(recipe.count), NULL, "N", "strands, 1 to 10000000"},
    {"vertices", 0, OPTION_COUNT, AT(recipe.vertices), NULL, "N", "per strand, 2 to 65535"},
    {"length", 0, OPTION_NUMBER, AT(recipe.length), NULL, "M",
     "of the longest strand, metres, 0.001 to 100"},
    {"length-variation", 0, OPTION_NUMBER, AT(recipe.length_variation), NULL, "SHARE",
     "strands are up to this share shorter, 0 to 1"},
    {"curl-radius", 0, OPTION_NUMBER, AT(recipe.curl_radius), NULL, "M",
     "of the curls at the tip, metres, 0 to 1"},
    {"curl-turns", 0, OPTION_NUMBER, AT(recipe.curl_turns), NULL, "N",
     "of the curls over a strand, 0 to 1000"},
    {"curl-disorder", 0, OPTION_NUMBER, AT(recipe.curl_disorder), NULL, "SHARE",
     "0: neighbours wind in step, 1: each for itself"},
    {"seed", 0, OPTION_COUNT, AT(recipe.seed), NULL, "N", "of all that is random"},
    {"set", 0, OPTION_TEXT, AT(set), set_words, "NAME",
     "a test set of the thesis instead: 1k16, 1k32, 10k16 or 10k32 (thousands of strands x "
     "vertices)"},
    {"format", 0, OPTION_WORD, AT(format), format_words, "WORD",
     "text (TressFX 2), tfx3, tfx4 (TressFX binary) or hair (HAIR)"},
    {"output", 'o', OPTION_TEXT, AT(output), NULL, "FILE", "the hair"},
    {"mesh", 0, OPTION_TEXT, AT(mesh), NULL, "FILE", "also write the shape, as Wavefront OBJ"},
    {"bust", 0, OPTION_TEXT, AT(bust), NULL, "FILE",
     "also write the head with shoulders below it, as Wavefront OBJ"},
    {"quiet", 'q', OPTION_QUIET, 0, NULL, NULL, "print nothing"},
    {"help", 'h', OPTION_HELP, 0, NULL, NULL, "print this"},
    {"version", 0, OPTION_VERSION, 0, NULL, NULL, "print the version"},
};

// --- Help.

static void print_default(const Option *option, StrandsStyle style, char *text, size_t size)
{
    Command command = {.recipe = strands_recipe_default(style), .format = 2};
    const char *at = (const char *)&command + option->place;
    int index;
    uint32_t count;
    float number;
    text[0] = 0;
    if (option->kind == OPTION_WORD) {
        memcpy(&index, at, sizeof index);
        snprintf(text, size, "%s", option->words[index]);
    } else if (option->kind == OPTION_COUNT) {
        memcpy(&count, at, sizeof count);
        snprintf(text, size, "%u", count);
    } else if (option->kind == OPTION_NUMBER) {
        memcpy(&number, at, sizeof number);
        snprintf(text, size, "%g", (double)number);
    }
}

// One default where all kinds of hair have the same, else each kind's.
static void print_defaults(const Option *option)
{
    char text[STRANDS_STYLES][32];
    bool same = true;
    for (int style = 0; style < STRANDS_STYLES; style++) {
        print_default(option, (StrandsStyle)style, text[style], sizeof text[style]);
        same = same && strcmp(text[style], text[0]) == 0;
    }
    if (strcmp(option->name, "kind") == 0) {
        printf(" [curls]");
    } else if (same) {
        if (text[0][0]) printf(" [%s]", text[0]);
    } else {
        for (int style = 0; style < STRANDS_STYLES; style++)
            printf("%s%s %s", style ? ", " : "\n                            [", kind_words[style],
                   text[style]);
        printf("]");
    }
}

static void print_help(void)
{
    printf("tractrix-gen [OPTION]... -o FILE\n"
           "Makes hair, and with --mesh the shape it grows on. Metres, y up, the face towards "
           "+z.\n\n");
    for (size_t i = 0; i < ARRAY_SIZE(options); i++) {
        const Option *option = &options[i];
        char flag[48], letter[8] = "    ";
        if (option->letter) snprintf(letter, sizeof letter, "-%c, ", option->letter);
        snprintf(flag, sizeof flag, "%s--%s %s", letter, option->name,
                 option->value ? option->value : "");
        printf("  %-25s %s", flag, option->help);
        print_defaults(option);
        printf("\n");
    }
    printf("\nExit status: 0 done, 1 failed (disk full, no memory, ...), 2 wrong usage.\n");
}

// --- Parsing.

static Result fail_unknown(const char *flag, Error *error)
{
    const char *names[ARRAY_SIZE(options)];
    for (size_t i = 0; i < ARRAY_SIZE(options); i++) names[i] = options[i].name;
    size_t length = strcspn(flag, "=");
    char word[64];
    snprintf(word, sizeof word, "%.*s", (int)length, flag + strspn(flag, "-"));
    word[strcspn(word, "=")] = 0;
    return error_set(error, RESULT_USAGE, "no option '%.*s': did you mean '--%s'?", (int)length,
                     flag, suggest_nearest(word, names, ARRAY_SIZE(names)));
}

static Result find_word(const Option *option, const char *text, int *index, Error *error)
{
    size_t count = 0;
    for (; option->words[count]; count++) {
        if (strcmp(text, option->words[count]) != 0) continue;
        *index = (int)count;
        return RESULT_OK;
    }
    return error_set(error, RESULT_USAGE, "--%s '%s': did you mean '%s'?", option->name, text,
                     suggest_nearest(text, option->words, count));
}

static Result parse_count(const Option *option, const char *text, uint32_t *count, Error *error)
{
    char *end;
    errno = 0;
    unsigned long value = strtoul(text, &end, 10);
    if (*text >= '0' && *text <= '9' && *end == 0 && errno == 0 && value <= UINT32_MAX) {
        *count = (uint32_t)value;
        return RESULT_OK;
    }
    return error_set(error, RESULT_USAGE, "--%s '%s': expected a whole number from 0 to %u",
                     option->name, text, UINT32_MAX);
}

static Result parse_number(const Option *option, const char *text, float *number, Error *error)
{
    char *end;
    *number = strtof(text, &end);
    if (end != text && *end == 0 && isfinite(*number)) return RESULT_OK;
    return error_set(error, RESULT_USAGE, "--%s '%s': expected a number", option->name, text);
}

static Result set_option(Command *command, const Option *option, const char *text, Error *error)
{
    char *at = (char *)command + option->place;
    int index = 0;
    Result result = RESULT_OK;
    switch (option->kind) {
    case OPTION_WORD:
        result = find_word(option, text, &index, error);
        if (result == RESULT_OK) memcpy(at, &index, sizeof index);
        return result;
    case OPTION_COUNT:
        return parse_count(option, text, (uint32_t *)(void *)at, error);
    case OPTION_NUMBER:
        return parse_number(option, text, (float *)(void *)at, error);
    case OPTION_TEXT:
        if (option->words) result = find_word(option, text, &index, error);
        if (result == RESULT_OK && text[0] == 0)
            result = error_set(error, RESULT_USAGE, "--%s: expected a name", option->name);
        memcpy(at, &text, sizeof text);
        return result;
    case OPTION_QUIET:
        command->quiet = true;
        return RESULT_OK;
    default:
        return RESULT_OK;
    }
}

// getopt's tables, from ours; both have room for an end.
static void make_getopt_tables(struct option *table, char *letters)
{
    *letters++ = ':'; // tell a missing value from an unknown option
    for (size_t i = 0; i < ARRAY_SIZE(options); i++) {
        bool has_value = options[i].value != NULL;
        table[i] = (struct option){options[i].name, has_value ? required_argument : no_argument,
                                   NULL, 256 + (int)i};
        if (!options[i].letter) continue;
        *letters++ = options[i].letter;
        if (has_value) *letters++ = ':';
    }
    table[ARRAY_SIZE(options)] = (struct option){0};
    *letters = 0;
}

static const Option *find_option(int code)
{
    if (code >= 256) return &options[code - 256];
    for (size_t i = 0; i < ARRAY_SIZE(options); i++)
        if (options[i].letter && options[i].letter == code) return &options[i];
    return NULL;
}

// No option is passed over without a word.
static Result check_effect(Command *command, const Option *option, Error *error)
{
    bool is_number = option->kind == OPTION_COUNT || option->kind == OPTION_NUMBER;
    if (strncmp(option->name, "curl-", 5) == 0 && command->recipe.style != STRANDS_STYLE_CURLS)
        return error_set(error, RESULT_USAGE, "--%s is for --kind curls, not %s", option->name,
                         kind_words[command->recipe.style]);
    if ((is_number || option->words == kind_words || option->words == shape_words) &&
        option->place != AT(recipe.seed))
        command->shaping = option->name;
    return RESULT_OK;
}

// The kind comes first, wherever it stands: the other defaults depend on it.
static Result parse_pass(Command *command, int argc, char **argv, bool kind_only, bool *leave,
                         Error *error)
{
    struct option table[ARRAY_SIZE(options) + 1];
    char letters[2 * ARRAY_SIZE(options) + 2];
    make_getopt_tables(table, letters);
    opterr = 0;
    optind = 0;
    int code;
    while ((code = getopt_long(argc, argv, letters, table, NULL)) != -1) {
        const Option *option = code == '?' || code == ':' ? NULL : find_option(code);
        if (code == ':')
            return error_set(error, RESULT_USAGE, "'%s' needs a value", argv[optind - 1]);
        if (!option) return fail_unknown(argv[optind - 1], error);
        if (option->kind == OPTION_HELP || option->kind == OPTION_VERSION) {
            if (option->kind == OPTION_HELP)
                print_help();
            else
                printf("tractrix-gen %s\n", TRACTRIX_VERSION);
            *leave = true;
            return RESULT_OK;
        }
        if (kind_only != (option->place == AT(recipe.style) && option->kind == OPTION_WORD))
            continue;
        Result result = set_option(command, option, optarg, error);
        if (result == RESULT_OK) result = check_effect(command, option, error);
        if (result != RESULT_OK) return result;
    }
    if (optind < argc)
        return error_set(error, RESULT_USAGE, "'%s' is no option: expected -o FILE", argv[optind]);
    return RESULT_OK;
}

static Result parse(Command *command, int argc, char **argv, bool *leave, Error *error)
{
    *command = (Command){.recipe.style = STRANDS_STYLE_CURLS};
    Result result = parse_pass(command, argc, argv, true, leave, error);
    if (result != RESULT_OK || *leave) return result;
    *command = (Command){.recipe = strands_recipe_default(command->recipe.style),
                         .shaping = command->shaping,
                         .format = 2};
    result = parse_pass(command, argc, argv, false, leave, error);
    if (result == RESULT_OK && command->set && command->shaping)
        return error_set(error, RESULT_USAGE, "--set %s and --%s exclude each other", command->set,
                         command->shaping);
    if (result == RESULT_OK && !command->output && !command->mesh && !command->bust)
        return error_set(error, RESULT_USAGE, "nothing to write: expected -o FILE");
    return result;
}

// ---

static Result write_hair(const Command *command, Error *error)
{
    Strands strands;
    Result result = command->set
                        ? strands_make_set(&strands, command->set, command->recipe.seed, error)
                        : strands_make(&strands, &command->recipe, error);
    if (result != RESULT_OK) return result;
    result = strands_write(command->output, format_kinds[command->format], &strands, error);
    if (result == RESULT_OK && !command->quiet)
        printf("%s: %u strands of %u vertices, %s\n", command->output, strands.strand_count,
               strands_size(&strands, 0), strands_kind_name(format_kinds[command->format]));
    strands_destroy(&strands);
    return result;
}

static Result write_mesh(const Command *command, const char *file, bool shoulders, Error *error)
{
    Mesh mesh;
    ScalpShape shape = shoulders ? SCALP_HEAD : command->set ? SCALP_SPHERE : command->recipe.shape;
    Result result = scalp_make_mesh(&mesh, shape, 36, error);
    if (result == RESULT_OK && shoulders) result = bust_append_shoulders(&mesh, error);
    if (result == RESULT_OK) result = mesh_write_obj(file, &mesh, error);
    if (result == RESULT_OK && !command->quiet)
        printf("%s: %u vertices, %u triangles\n", file, mesh.vertex_count, mesh.triangle_count);
    mesh_destroy(&mesh);
    return result;
}

int main(int argc, char **argv)
{
    Command command;
    Error error;
    bool leave = false;
    Result result = parse(&command, argc, argv, &leave, &error);
    if (result == RESULT_OK && !leave && command.output) result = write_hair(&command, &error);
    if (result == RESULT_OK && !leave && command.mesh)
        result = write_mesh(&command, command.mesh, false, &error);
    if (result == RESULT_OK && !leave && command.bust)
        result = write_mesh(&command, command.bust, true, &error);
    if (result == RESULT_OK && (fflush(stdout) != 0 || ferror(stdout)))
        result = error_set(&error, RESULT_FAILED, "cannot write to standard output");
    if (result != RESULT_OK) fprintf(stderr, "tractrix-gen: %s\n", error.text);
    return result;
}
