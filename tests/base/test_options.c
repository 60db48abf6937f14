// SPDX-License-Identifier: MIT
// The command line parser of all programs, and the forms of --help.
#include "base/options.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

typedef struct Values {
    bool fast, no_wait;
    const char *file;
    double size;
    int count, kind;
    OptionSteps steps;
} Values;

#define AT(member) offsetof(Values, member)

static const Option OPTIONS[] = {
    {"fast", 'f', OPTION_SWITCH, AT(fast), NULL, 0, 0, "be quick"},
    {"no-wait", 0, OPTION_SWITCH, AT(no_wait), NULL, 0, 0, "do not wait"},
    {"out-file", 'o', OPTION_STRING, AT(file), "FILE", 0, 0, "file to write"},
    {"size", 0, OPTION_REAL, AT(size), "M", 0.5, 2, "size [default 1]"},
    {"count", 'n', OPTION_WHOLE, AT(count), "N", 1, 9, "count"},
    {"kind", 0, OPTION_WORD, AT(kind), "one|two|three", 0, 0, "kind"},
    {"move", 0, OPTION_STEP, AT(steps), "X", 0, 0, "step: move"},
    {"turn", 0, OPTION_STEP, AT(steps), NULL, 0, 0, "step: turn"},
};

static const char *const STATUS[][2] = {{"0", "done"}, {NULL, NULL}};
static const char *const EXAMPLES[] = {"program -f", NULL};

static const OptionsProgram PROGRAM = {
    .name = "program",
    .summary = "try options",
    .synopsis = "[OPTION]... FILE",
    .description = "Tries options.",
    .options = OPTIONS,
    .option_count = sizeof OPTIONS / sizeof *OPTIONS,
    .status = STATUS,
    .examples = EXAMPLES,
};

enum { MOST_WORDS = 20 };

// Parses `line`, split at blanks; joins the operands in `operands`. argv points into `copy`.
static Result parse(Values *values, char copy[200], const char *line, char operands[100],
                    Error *error)
{
    char *argv[MOST_WORDS] = {"program"}, *rest = copy;
    int argc = 1, first = 0;
    bool done;
    snprintf(copy, 200, "%s", line);
    for (char *word; (word = strsep(&rest, " "));)
        if (*word) argv[argc++] = word;
    *values = (Values){.size = 1};
    Result result = options_parse(&PROGRAM, values, argc, argv, &first, &done, error);
    operands[0] = 0;
    for (int i = first; result == RESULT_OK && i < argc; ++i) {
        strcat(operands, argv[i]);
        strcat(operands, " ");
    }
    return result;
}

static void options_have_the_same_forms_everywhere(void **state)
{
    (void)state;
    Values values;
    Error error = {{0}};
    char copy[200], operands[100];
    assert_int_equal(parse(&values, copy,
                           "a -fo x --out_file=y --size -1e0 --size 1.5 -n7 b --no-wait --kind two "
                           "--no-fast -- --size -f",
                           operands, &error),
                     RESULT_USAGE); // --size -1e0 is out of range
    assert_string_equal(error.text, "--size: got '-1e0', expected a number from 0.5 to 2");
    assert_int_equal(parse(&values, copy,
                           "a -fo x --out_file=y --size 1 --size 1.5 -n7 b --no-wait --kind two "
                           "--no-fast -- --size -f",
                           operands, &error),
                     RESULT_OK);
    assert_string_equal(operands, "a b --size -f ");
    assert_string_equal(values.file, "y");
    assert_true(values.size == 1.5 && values.count == 7 && values.kind == 1);
    assert_true(!values.fast && values.no_wait);
    assert_int_equal(parse(&values, copy, "--fast=true --turn --move 1 --turn", operands, &error),
                     RESULT_OK);
    assert_true(values.fast);
    assert_int_equal(values.steps.count, 3);
    assert_ptr_equal(values.steps.step[1].option, &OPTIONS[6]);
    assert_string_equal(values.steps.step[1].text, "1");
    assert_null(values.steps.step[2].text);
}

static void mistakes_name_the_option_and_what_was_expected(void **state)
{
    (void)state;
    static const struct {
        const char *line, *message;
    } LINES[] = {
        {"--fsat", "--fsat: no such option: did you mean '--fast'?"},
        {"--no-fats", "--no-fats: no such option: did you mean '--no-fast'?"},
        {"--outfile x", "--outfile: no such option: did you mean '--out-file'?"},
        {"--quantity", "--quantity: no such option: see --help"},
        {"-x", "-x: no such option: see --help"},
        {"--size", "--size: no value: expected M"},
        {"--out-file --fast", "--out-file: no value: expected FILE"},
        {"--out-file=", "--out-file: got '', expected FILE"},
        {"-n 1.5", "-n: got '1.5', expected a whole number from 1 to 9"},
        {"--size nan", "--size: got 'nan', expected a number from 0.5 to 2"},
        {"--kind tow", "--kind: got 'tow', expected one, two or three (nearest: two)"},
        {"--kind seven", "--kind: got 'seven', expected one, two or three"},
        {"--fast=ture", "--fast: got 'ture', expected true or false (nearest: true)"},
        {"--fast=maybe", "--fast: got 'maybe', expected true or false"},
        {"--turn=1", "--turn: got '1', expected no value"},
        {"--no-size", "--no-size: --size takes a value: only switches have --no-"},
        {"--help nothing",
         "--help: no topic 'nothing': expected all, man, markdown, bash, zsh, fish or "
         "an option's name"},
    };
    for (size_t i = 0; i < sizeof LINES / sizeof *LINES; ++i) {
        Values values;
        Error error = {{0}};
        char copy[200], operands[100];
        assert_int_equal(parse(&values, copy, LINES[i].line, operands, &error), RESULT_USAGE);
        assert_string_equal(error.text, LINES[i].message);
    }
}

static void help_has_a_form_for_every_topic(void **state)
{
    (void)state;
    static const struct {
        const char *topic, *has;
    } TOPICS[] = {
        {NULL, "  -o, --out-file FILE         file to write\n"},
        {"all", "Usage: program [OPTION]... FILE\n"},
        {"man", ".TH PROGRAM 1"},
        {"markdown", "| `--kind one\\|two\\|three` | kind |"},
        {"bash", "--kind) _tractrix_words 'one two three' ;;"},
        {"bash", "-o|--out-file) _tractrix_files -f ;;"},
        {"zsh", "'--kind=[kind]:value:(one two three)'"},
        {"zsh", "'-o+[file to write]:FILE:_files'"},
        {"fish", "-l kind -x -a 'one two three' -d 'kind'"},
        {"fish", "-s o -l out-file -r -F -d 'file to write'"},
        {"size", "  --size M                    size [default 1]\n"},
        {"-n", "  -n, --count N               count\n"},
        {"--help", "  -h, --help [TOPIC]"},
    };
    for (size_t i = 0; i < sizeof TOPICS / sizeof *TOPICS; ++i) {
        Error error;
        char *text = NULL;
        size_t size = 0;
        FILE *stream = open_memstream(&text, &size);
        assert_int_equal(options_help(&PROGRAM, TOPICS[i].topic, stream, &error), RESULT_OK);
        fclose(stream);
        if (!strstr(text, TOPICS[i].has)) fail_msg("no '%s' in %s", TOPICS[i].has, text);
        free(text);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(options_have_the_same_forms_everywhere),
        cmocka_unit_test(mistakes_name_the_option_and_what_was_expected),
        cmocka_unit_test(help_has_a_form_for_every_topic),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
