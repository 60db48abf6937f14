// SPDX-License-Identifier: MIT
#include "bench/bench_options.h"
#include "base/options.h"
#include "base/suggest.h"
#include "report/shell_words.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// The target of options_parse. Lists and names are read as text first.
typedef struct Values {
    BenchOptions bench;
    const char *rates, *size, *raster, *oit, *shadow, *quality;
    const char *param[BENCH_MOST_PARAMS]; // text of the parameter param_info[i] below
    bool software, osmesa, no_shrink;
} Values;

#define AT(member) offsetof(Values, member)
static const Option OPTIONS[] = {
    {"set", 0, OPTION_STRING, AT(bench.set), "NAME", 0, 0,
     "test set of the thesis: 1k16, 1k32, 10k16 or 10k32 (thousands of strands x vertices); image: "
     "also straight, curls, fur"},
    {"tfx", 0, OPTION_STRING, AT(bench.tfx), "FILE", 0, 0, "a hair file of any supported format"},
    {"vectors", 0, OPTION_STRING, AT(bench.vectors), "FILE.csv", 0, 0,
     "step, chain: test vectors (default: those in tests/data)"},
    {"reference", 0, OPTION_STRING, AT(bench.reference), "DIR", 0, 0,
     "accuracy: folder of exact motions, NAME.csv with NAME.json (default tests/data/motion); "
     "light: folder of path-traced cases in the same form (default tests/data/light)"},
    {"part", 0, OPTION_STRING, AT(bench.parts), "LIST", 0, 0,
     "only these parts of the command, separated by commas (default: all)"},
    {"algo", 0, OPTION_STRING, AT(bench.method.algo), "LIST", 0, 0,
     "solvers, separated by commas (default: all); scenes, stress: one solver (default of scenes: "
     "split)"},
    {"variant", 0, OPTION_STRING, AT(bench.method.variant), "NAME", 0, 0,
     "variant of the solver (default: the solver's first)"},
    {"rates", 0, OPTION_STRING, AT(rates), "LIST", 0, 0,
     "accuracy, groom: up to 8 simulation rates, in steps per second (default: those of the part; "
     "groom: 60,240)"},
    {"mesh", 0, OPTION_STRING, AT(bench.mesh), "FILE.obj", 0, 0,
     "groom: the head on which the hair grows, in a format of tractrix-render --mesh"},
    {"strands", 0, OPTION_WHOLE, AT(bench.strands), "N", 1, 1e9,
     "groom: use only N strands of a file, evenly spread (default: all)"},
    {"seconds", 0, OPTION_REAL, AT(bench.seconds), "S", 0.1, 1e5,
     "accuracy: simulated time of the long runs (default 60)"},
    {"steps", 0, OPTION_WHOLE, AT(bench.steps), "N", 1, 1e6,
     "number of measured steps (default 200; stress: of each case, default 10000)"},
    {"warm-up", 0, OPTION_WHOLE, AT(bench.warm_up), "N", 0, 1e6,
     "number of steps before the measurement (default 20)"},
    {"size", 0, OPTION_STRING, AT(size), "WxH", 0, 0,
     "also measure drawing, with images of this size (px)"},
    {"raster", 0, OPTION_STRING, AT(raster), "WORD", 0, 0,
     "rasteriser: auto, quads, blocks or compute (default auto)"},
    {"oit", 0, OPTION_STRING, AT(oit), "WORD", 0, 0,
     "image, --raster quads: abuffer or none (default auto: abuffer)"},
    {"layers", 0, OPTION_WHOLE, AT(bench.scheme.layers), "K", 0, 64,
     "image, --raster quads: fragments per pixel that are sorted, 1 to 64 (default 0: 8, or 16 "
     "with --samples)"},
    {"samples", 0, OPTION_WHOLE, AT(bench.scheme.samples), "N", 1, 4,
     "image: 2 or 4 renders 2 x 2 or 4 x 4 samples per pixel (default 1)"},
    {"shadow", 0, OPTION_STRING, AT(shadow), "WORD", 0, 0,
     "image: none, approx or dom (default none)"},
    {"quality", 0, OPTION_STRING, AT(quality), "WORD", 0, 0,
     "image: preset normal, draft or final for options that are not given (default normal)"},
    {"frames", 0, OPTION_WHOLE, AT(bench.frames), "N", 0, 1e6,
     "image, light: number of measured images (default 15; light: 0 measures no times); a path "
     "tracer follows 8 paths a pixel for each"},
    {"no-error", 0, OPTION_SWITCH, AT(bench.no_error), NULL, 0, 0,
     "image: measure times only, not the error"},
    {"cases", 0, OPTION_WHOLE, AT(bench.stress.cases), "N", 1, 1e6,
     "stress: number of random cases for each variant of a solver (default 5000)"},
    {"seed", 0, OPTION_WHOLE, AT(bench.stress.seed), "N", 0, 2e9,
     "stress: start of the random numbers (default 1)"},
    {"case", 0, OPTION_STRING, AT(bench.case_name), "TEXT", 0, 0,
     "stress: run only this case of --algo: the text that is printed for a failed case, or "
     "'plain'; light: only these cases, separated by commas"},
    {"way", 0, OPTION_STRING, AT(bench.ways), "LIST", 0, 0,
     "light: only these methods of computing light, separated by commas, or all (default: methods "
     "with a stated bound); a path tracer: 'traced one' with 1 bounce, 'traced' with 64 bounces"},
    {"render", 0, OPTION_STRING, AT(bench.render), "TEXT", 0, 0,
     "light, trace, groom: options of tractrix-render for every scene, for example "
     "--render='--smooth 3'"},
    {"picture", 0, OPTION_STRING, AT(bench.picture), "FILE.png", 0, 0,
     "light: write an image with a row for each case: the case by each method, and by the path "
     "tracer"},
    {"before", 0, OPTION_STRING, AT(bench.before), "DIR", 0, 0,
     "light: folder with NAME.pfm of each case by an older version, shown first in --picture"},
    {"allow", 0, OPTION_REAL, AT(bench.stress.allowed), "X", 1e-3, 1,
     "stress: share of each bound that a case may use (default 1)"},
    {"no-shrink", 0, OPTION_SWITCH, AT(no_shrink), NULL, 0, 0,
     "stress: print failed cases as they were found, without reducing them"},
    {"json", 0, OPTION_STRING, AT(bench.output.json), "FILE", 0, 0,
     "write the rows to this JSON file"},
    {"csv", 0, OPTION_STRING, AT(bench.output.csv), "FILE", 0, 0,
     "write the rows to this CSV file"},
    {"html", 0, OPTION_STRING, AT(bench.output.html), "FILE.html", 0, 0,
     "write the rows as a page with plots for a browser; it needs no network"},
    {"device", 0, OPTION_STRING, AT(bench.gpu.device), "NAME|N", 0, 0,
     "device, by its number or name in tractrix-render --list-devices (default: the best device)"},
    {"software", 0, OPTION_SWITCH, AT(software), NULL, 0, 0,
     "use a CPU driver even if there is a GPU"},
    {"osmesa", 0, OPTION_SWITCH, AT(osmesa), NULL, 0, 0, "use OSMesa instead of EGL"},
};
enum { OWN_COUNT = sizeof OPTIONS / sizeof *OPTIONS, NAME_SIZE = 64 };

static const char *const STATUS[][2] = {
    {"0", "done"},         {"1", "failure, or a stated bound is broken"},
    {"2", "wrong usage"},  {"3", "bad input file"},
    {"4", "no usable GL"}, {"130", "interrupted"},
    {NULL, NULL}};

static const char *const EXAMPLES[] = {
    "tractrix-bench step --vectors tests/data/tractrix_steps.csv",
    "tractrix-bench accuracy --part motions --algo rope --rope-iterations 50 --rates 60,120",
    "tractrix-bench speed --set 10k32 --algo chain --csv chain.csv",
    "tractrix-bench accuracy --part work --set 1k16 --html work.html", NULL};

static const char *const NOTES[] = {
    "The options from --style on are those of tractrix-render and change the solvers. Times are "
    "wall-clock milliseconds after a warm-up; each sample ends when the driver has finished.",
    NULL};

// --- Solvers' parameters as options.

// The options, followed by every parameter of solvers. Row OWN_COUNT + i belongs to param_info[i].
typedef struct Rows {
    Option option[OWN_COUNT + BENCH_MOST_PARAMS];
    char name[BENCH_MOST_PARAMS][NAME_SIZE];
    const ParamInfo *info[BENCH_MOST_PARAMS];
    size_t params;
} Rows;

static void list_rows(Rows *rows)
{
    memcpy(rows->option, OPTIONS, sizeof OPTIONS);
    rows->params = 0;
    for (size_t i = 0; i < PARAM_COUNT && rows->params < BENCH_MOST_PARAMS; ++i) {
        const ParamInfo *info = &PARAM_TABLE[i];
        size_t row = rows->params;
        if (!trial_takes(info)) continue;
        snprintf(rows->name[row], NAME_SIZE, "%s", info->name);
        for (char *at = rows->name[row]; *at; ++at)
            if (*at == '_') *at = '-';
        rows->info[row] = info;
        rows->option[OWN_COUNT + row] = (Option){rows->name[row],
                                                 0,
                                                 OPTION_STRING,
                                                 AT(param) + row * sizeof(const char *),
                                                 *info->unit ? info->unit : "VALUE",
                                                 0,
                                                 0,
                                                 info->help};
        ++rows->params;
    }
}

// Joins the parameters that were given, in the table's order, such as "--rope-iterations 50 --style
// 0".
static Result join_settings(Values *values, const Rows *rows, Error *error)
{
    size_t size = 0;
    FILE *stream = open_memstream(&values->bench.settings, &size);
    if (!stream) return error_set(error, RESULT_FAILED, "no memory for settings");
    for (size_t i = 0; i < rows->params; ++i)
        if (values->param[i])
            fprintf(stream, "%s--%s %s", ftell(stream) > 0 ? " " : "", rows->name[i],
                    values->param[i]);
    if (fclose(stream) != 0) return error_set(error, RESULT_FAILED, "no memory for settings");
    values->bench.method.settings = values->bench.settings;
    return RESULT_OK;
}

// Checks that the values are valid. Which solver reads them is not known yet.
static Result check_settings(const BenchOptions *options, Error *error)
{
    SectionParams params;
    Method method = options->method;
    if (!method.algo && *method.variant)
        return error_set(error, RESULT_USAGE, "--variant '%s' needs --algo", method.variant);
    Method each[METHODS_MOST];
    char name[64];
    Result result = RESULT_OK;
    for (const char *at = method.algo ? method.algo : "split"; at && result == RESULT_OK;
         at = strchr(at, ',')) {
        at += *at == ',';
        snprintf(name, sizeof name, "%.*s", (int)strcspn(at, ","), at);
        const Method one = {name, method.variant, method.settings};
        result = trial_params(&params, &one, "", error);
        params_destroy_section(&params);
    }
    if (result == RESULT_OK && trial_list(&method, each) == METHODS_MOST)
        return error_set(error, RESULT_USAGE, "--algo: too many solvers: expected fewer than %d",
                         METHODS_MOST);
    return result;
}

Result bench_options_one_algo(const BenchOptions *options, Error *error)
{
    const char *algo = options->method.algo;
    if (!algo || !strchr(algo, ',')) return RESULT_OK;
    return error_set(error, RESULT_USAGE, "--algo: got '%s', expected one solver", algo);
}

Result bench_options_some_frames(const BenchOptions *options, Error *error)
{
    if (options->frames > 0) return RESULT_OK;
    return error_set(
        error, RESULT_USAGE,
        "--frames: got 0, expected 1 or more: only light without a path tracer takes 0");
}

// --- Options whose values are names or lists.

static Result read_rates(const char *text, BenchOptions *options, Error *error)
{
    const char *at = text;
    char *end = (char *)text;
    for (options->rate_count = 0; options->rate_count < BENCH_MOST_RATES; at = end + 1) {
        double rate = strtod(at, &end);
        if (end == at || !(rate >= 1 && rate <= 1e6)) break;
        options->rates[options->rate_count++] = rate;
        if (!*end) return RESULT_OK;
        if (*end != ',') break;
    }
    return error_set(
        error, RESULT_USAGE,
        "--rates: got '%s', expected up to %d numbers from 1 to 1000000 with commas between them",
        text, BENCH_MOST_RATES);
}

static Result read_size(const char *text, int size[2], Error *error)
{
    char rest;
    if (sscanf(text, "%dx%d%c", &size[0], &size[1], &rest) == 2 && size[0] >= 1 && size[1] >= 1 &&
        size[0] <= 16384 && size[1] <= 16384)
        return RESULT_OK;
    return error_set(error, RESULT_USAGE, "--size: got '%s', expected WxH, each from 1 to 16384",
                     text);
}

static Result read_words(Values *values, Error *error)
{
    BenchOptions *options = &values->bench;
    RunParams run = {0};
    const char *const words[][2] = {{"raster", values->raster},
                                    {"oit", values->oit},
                                    {"shadow", values->shadow},
                                    {"quality", values->quality}};
    if (values->rates) TRY(read_rates(values->rates, options, error));
    if (values->size) TRY(read_size(values->size, options->size, error));
    for (size_t i = 0; i < sizeof words / sizeof *words; ++i) {
        if (!words[i][1]) continue;
        Result result = params_parse(params_find(words[i][0]), &run, words[i][1], error);
        if (result != RESULT_OK) return error_prefix(error, result, "--%s: ", words[i][0]);
    }
    options->scheme.raster = (Raster)run.raster;
    options->scheme.oit = (Oit)run.oit;
    options->scheme.shadow = (Shadow)run.shadow;
    options->scheme.quality = (Quality)run.quality;
    options->stress.text = options->case_name;
    options->stress.shrinks = !values->no_shrink;
    if (options->steps) options->stress.steps = options->steps;
    if (!options->steps) options->steps = 200;
    options->gpu.software = values->software;
    if (values->osmesa) options->gpu.backend = BACKEND_OSMESA;
    return RESULT_OK;
}

// --- The command line.

// Sets the heading of the HTML page: the command or, for `page`, the names of its CSV files.
static Result name_page(BenchOptions *options, char **words, int count, Error *error)
{
    char *joined = NULL;
    size_t size;
    FILE *stream = open_memstream(&joined, &size);
    bool shows = count > 1 && strcmp(words[0], "page") == 0;
    if (stream) {
        fprintf(stream, "%s", shows ? "" : "tractrix-bench ");
        for (int i = shows; i < (shows ? count : count > 0); ++i)
            fprintf(stream, "%s%s", shows && i > 1 ? ", " : "", words[i]);
    }
    if (stream && fclose(stream) == 0) options->title = joined;
    options->output.title = options->title;
    options->output.command = options->line;
    if (options->title && options->line) return RESULT_OK;
    return error_set(error, RESULT_FAILED, "no memory for the command line");
}

Result bench_options_read(BenchOptions *options, int argc, char **argv,
                          const char *const (*commands)[2], Error *error)
{
    Rows rows;
    Values values = {.bench = {.method = {NULL, "", ""},
                               .seconds = 60,
                               .warm_up = 20,
                               .stress = stress_options_default(),
                               .frames = 15,
                               .gpu = {0}}};
    int first = 0;
    values.bench.line = shell_join_line("tractrix-bench", argc, argv); // before its order changes
    list_rows(&rows);
    const OptionsProgram program = {
        .name = "tractrix-bench",
        .summary = "measure accuracy and speed",
        .synopsis = "COMMAND [OPTION]... [HAIR_FILE]...",
        .description =
            "Measures how accurate and how fast Tractrix is, and prints a line for each result.",
        .commands = commands,
        .options = rows.option,
        .option_count = OWN_COUNT + rows.params,
        .notes = NOTES,
        .status = STATUS,
        .examples = EXAMPLES};
    Result result = options_parse(&program, &values, argc, argv, &first, &values.bench.done, error);
    if (!values.bench.done) THEN(result, read_words(&values, error));
    if (!values.bench.done) THEN(result, join_settings(&values, &rows, error));
    if (!values.bench.done)
        THEN(result, name_page(&values.bench, argv + first, argc - first, error));
    values.bench.files = argv + first;
    values.bench.file_count = argc - first;
    *options = values.bench;
    if (!options->done) THEN(result, check_settings(options, error));
    return result;
}

void bench_options_destroy(BenchOptions *options)
{
    free(options->settings);
    free(options->line);
    free(options->title);
    *options = (BenchOptions){0};
}

// Whether the comma-separated list `text` contains a word of this length.
static bool lists(const char *text, const char *word, size_t length)
{
    for (size_t part; *text; text += part + (text[part] == ',')) {
        part = strcspn(text, ",");
        if (part == length && strncmp(text, word, length) == 0) return true;
    }
    return false;
}

bool bench_options_lists(const char *text, const char *word)
{
    return lists(text, word, strlen(word));
}

bool bench_options_part(const BenchOptions *options, const char *name)
{
    return !options->parts || lists(options->parts, name, strlen(name));
}

Result bench_options_check_list(const char *option, const char *text, const char *const *names,
                                Error *error)
{
    size_t count = 0;
    while (names[count]) count++;
    for (size_t part; text && *text; text += part + (text[part] == ',')) {
        part = strcspn(text, ",");
        char word[64], words[300];
        snprintf(word, sizeof word, "%.*s", (int)part, text);
        size_t i = 0;
        while (i < count && strcmp(names[i], word) != 0) i++;
        if (i == count)
            return error_set(error, RESULT_USAGE, "%s: no %s '%s': %s", option,
                             option + strspn(option, "-"), word,
                             suggest_words(words, sizeof words, word, names, count));
    }
    return RESULT_OK;
}

Result bench_options_check_parts(const BenchOptions *options, const char *const *names,
                                 Error *error)
{
    return bench_options_check_list("--part", options->parts, names, error);
}
