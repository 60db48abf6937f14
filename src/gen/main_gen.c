// SPDX-License-Identifier: MIT
// tractrix-gen: makes hair, and the mesh that it grows on.
#include "base/activity.h"
#include "base/paths.h"
#include "base/program.h"
#include "base/quote.h"
#include "formats/mesh_read.h"
#include "formats/mesh_sequence.h"
#include "formats/obj.h"
#include "formats/strands_read.h"
#include "gen/fur.h"
#include "gen/head_motion.h"
#include "gen/strands_make.h"
#include "gen/studio_light.h"
#include "mesh/head.h"
#include "mesh/scalp.h"

#include <math.h>
#include <string.h>

// Options that were not given are negative or NaN.
typedef struct Command {
    int kind, shape, count, vertices, set, seed;
    double length, length_variation, curl_radius, curl_turns, curl_disorder;
    GenOutput output;
    const char *mesh, *motion, *environment;
} Command;

static const char KINDS[] = "random|straight|curls|fur";
static const char *const KIND_NAMES[] = {"random", "straight", "curls", "fur"};
static const char *const SET_NAMES[] = {"1k16", "1k32", "10k16", "10k32"};

#define AT(member) offsetof(Command, member)

static const Option OPTIONS[] = {
    {"kind", 0, OPTION_WORD, AT(kind), KINDS, 0, 0,
     "kind of hair; random: segments in random directions [default curls]"},
    {"shape", 0, OPTION_WORD, AT(shape), "sphere|head", 0, 0,
     "shape on which hair grows: a sphere (radius 0.1 m), or a head with neck and shoulders"},
    {"count", 'n', OPTION_WHOLE, AT(count), "N", 1, 1e7, "number of strands"},
    {"vertices", 0, OPTION_WHOLE, AT(vertices), "N", 2, 65535, "vertices per strand"},
    {"length", 0, OPTION_REAL, AT(length), "M", 1e-3, 100, "length of the longest strand, metres"},
    {"length-variation", 0, OPTION_REAL, AT(length_variation), "SHARE", 0, 1,
     "largest random reduction of a strand's length, as a share"},
    {"curl-radius", 0, OPTION_REAL, AT(curl_radius), "M", 0, 1,
     "radius of curls at the tip, metres; --kind curls"},
    {"curl-turns", 0, OPTION_REAL, AT(curl_turns), "N", 0, 1000,
     "turns of curls per strand; --kind curls"},
    {"curl-disorder", 0, OPTION_REAL, AT(curl_disorder), "SHARE", 0, 1,
     "0: neighbouring curls are in phase, 1: each strand has its own phase; --kind curls"},
    GEN_OPTION_SEED(AT(seed)),
    {"set", 0, OPTION_WORD, AT(set), "1k16|1k32|10k16|10k32", 0, 0,
     "make this test set of the thesis (thousands of strands x vertices)"},
    GEN_OPTION_FORMAT(AT(output.format)),
    GEN_OPTION_OUTPUT(AT(output.path)),
    {"mesh", 0, OPTION_STRING, AT(mesh), "FILE", 0, 0, "also write the shape, as Wavefront OBJ"},
    {"motion", 0, OPTION_STRING, AT(motion), "FILE.npz", 0, 0,
     "also write a moving head, which turns, nods, speaks and shrugs, for tractrix-render --mesh"},
    {"environment", 0, OPTION_STRING, AT(environment), "FILE.pfm", 0, 0,
     "also write the light of a studio with three soft boxes, for tractrix-render --environment"},
    GEN_OPTION_QUIET(AT(output.quiet)),
};

static const char *const STATUS[][2] = {{"0", "done"},
                                        {"1", "failed: disk full, no memory, ..."},
                                        {"2", "wrong usage"},
                                        {"130", "interrupted"},
                                        {NULL, NULL}};

static const char *const EXAMPLES[] = {
    "tractrix-gen --kind curls --shape head --count 2000 -o curls.tfx --mesh head.obj",
    "tractrix-gen --set 10k16 -o 10k16.tfx", NULL};

static const char *const COMMANDS[][2] = {
    {"fur", "grow fur and hair on any mesh: see tractrix-gen fur --help or tractrix-gen-fur(1)"},
    {NULL, NULL}};

static const OptionsProgram PROGRAM = {
    .name = "tractrix-gen",
    .summary = "make hair, and what it grows on",
    .synopsis = "[OPTION]... -o FILE\nfur [OPTION]... MESH.obj -o FILE",
    .commands = COMMANDS,
    .sub = &FUR_RECIPE_PROGRAM,
    .sub_word = "fur",
    .description = "Makes hair, and with --mesh the shape it grows on. Metres, y up, the face "
                   "towards +z.",
    .options = OPTIONS,
    .option_count = sizeof OPTIONS / sizeof *OPTIONS,
    .status = STATUS,
    .examples = EXAMPLES,
};

// --- The command line.

// Writes the defaults of each kind of hair, a paragraph of the help.
static void write_defaults(char *text, size_t size)
{
    size_t at = (size_t)snprintf(text, size, "Defaults.");
    for (int style = 0; style < STRANDS_STYLES && at < size; ++style) {
        StrandsRecipe r = strands_make_recipe((StrandsStyle)style);
        at += (size_t)snprintf(
            text + at, size - at,
            " %s: --shape %s --count %u --vertices %u --length %g --length-variation %g",
            KIND_NAMES[style], r.shape == SCALP_SPHERE ? "sphere" : "head", r.count, r.vertices,
            (double)r.length, (double)r.length_variation);
        if (style == STRANDS_STYLE_CURLS && at < size)
            at += (size_t)snprintf(
                text + at, size - at, " --curl-radius %g --curl-turns %g --curl-disorder %g",
                (double)r.curl_radius, (double)r.curl_turns, (double)r.curl_disorder);
        if (at < size) at += (size_t)snprintf(text + at, size - at, ".");
    }
}

// The first of `names` that was given; NULL if there is none.
static const char *find_given(const Command *command, const char *const *names)
{
    for (; *names; ++names) {
        size_t i = 0;
        while (strcmp(OPTIONS[i].name, *names) != 0) ++i;
        const char *at = (const char *)command + OPTIONS[i].place;
        double number = NAN;
        int whole;
        memcpy(&whole, at, sizeof whole);
        if (OPTIONS[i].kind == OPTION_REAL) memcpy(&number, at, sizeof number);
        if (OPTIONS[i].kind == OPTION_REAL ? !isnan(number) : whole >= 0) return *names;
    }
    return NULL;
}

// An option without effect is an error.
static Result check_effect(const Command *command, Error *error)
{
    static const char *const CURLS[] = {"curl-radius", "curl-turns", "curl-disorder", NULL};
    static const char *const SHAPING[] = {
        "kind",        "shape",      "count",         "vertices", "length", "length-variation",
        "curl-radius", "curl-turns", "curl-disorder", NULL};
    const char *curl = find_given(command, CURLS), *shaping = find_given(command, SHAPING);
    if (curl && command->kind >= 0 && command->kind != STRANDS_STYLE_CURLS)
        return error_set(error, RESULT_USAGE, "--%s: has no effect: --kind is %s", curl,
                         KIND_NAMES[command->kind]);
    if (command->set >= 0 && shaping)
        return error_set(error, RESULT_USAGE, "--set %s and --%s: expected only one of them",
                         SET_NAMES[command->set], shaping);
    if (!command->output.path && !command->mesh && !command->motion && !command->environment)
        return error_set(error, RESULT_USAGE, "no output: expected -o FILE");
    return RESULT_OK;
}

static Result parse(Command *command, int argc, char **argv, bool *done, Error *error)
{
    char defaults[1024];
    const char *const notes[] = {defaults, NULL};
    OptionsProgram program = PROGRAM;
    int first;
    program.notes = notes;
    write_defaults(defaults, sizeof defaults);
    *command = (Command){.kind = -1,
                         .shape = -1,
                         .count = -1,
                         .vertices = -1,
                         .set = -1,
                         .output.format = -1,
                         .seed = 1,
                         .length = NAN,
                         .length_variation = NAN,
                         .curl_radius = NAN,
                         .curl_turns = NAN,
                         .curl_disorder = NAN};
    Result result = options_parse(&program, command, argc, argv, &first, done, error);
    if (result != RESULT_OK || *done) return result;
    if (first < argc)
        return error_set(error, RESULT_USAGE, "%s: got a file, expected only options and -o FILE",
                         argv[first]);
    TRY(gen_choose_format(&command->output, error));
    return check_effect(command, error);
}

static void set_real(float *to, double value)
{
    if (!isnan(value)) *to = (float)value;
}

static StrandsRecipe make_recipe(const Command *command)
{
    StrandsStyle style = command->kind < 0 ? STRANDS_STYLE_CURLS : (StrandsStyle)command->kind;
    StrandsRecipe recipe = strands_make_recipe(style);
    if (command->shape >= 0) recipe.shape = (ScalpShape)command->shape;
    if (command->count >= 0) recipe.count = (uint32_t)command->count;
    if (command->vertices >= 0) recipe.vertices = (uint32_t)command->vertices;
    set_real(&recipe.length, command->length);
    set_real(&recipe.length_variation, command->length_variation);
    set_real(&recipe.curl_radius, command->curl_radius);
    set_real(&recipe.curl_turns, command->curl_turns);
    set_real(&recipe.curl_disorder, command->curl_disorder);
    recipe.seed = (uint32_t)command->seed;
    return recipe;
}

// --- The work.

// Writes strands of equal vertex counts to output->path and reports it unless `quiet`. `guides` is
// the number of guides for the report; 0: the report does not mention guides.
static Result write_strands(const GenOutput *output, const Strands *strands, uint32_t guides,
                            Error *error)
{
    activity_set("writing");
    Result result = format_write(output->path, (FormatKind)output->format, strands, error);
    activity_end();
    TRY(result);
    if (output->quiet) return RESULT_OK;
    FILE *stream = gen_messages(output);
    fprintf(stream, "%s: %u strands of %u vertices, ", quote(output->path).text,
            strands->strand_count, strands_size(strands, 0));
    if (guides) fprintf(stream, "%u of them guides, ", guides);
    fprintf(stream, "%s\n", FORMAT_TABLE[output->format]->name);
    return RESULT_OK;
}

static Result write_hair(const Command *command, const StrandsRecipe *recipe, Error *error)
{
    Strands strands;
    TRY(command->set >= 0 ? strands_make_set(&strands, SET_NAMES[command->set], recipe->seed, error)
                          : strands_make(&strands, recipe, error));
    Result result = write_strands(&command->output, &strands, 0, error);
    strands_destroy(&strands);
    return result;
}

static Result write_mesh(const Command *command, ScalpShape shape, Error *error)
{
    enum { SPHERE_RINGS = 36, HEAD_TRIANGLES = 12000 };
    Mesh mesh;
    Result result = shape == SCALP_SPHERE ? scalp_make_mesh(&mesh, shape, SPHERE_RINGS, error)
                                          : head_make_mesh(&mesh, HEAD_TRIANGLES, error);
    THEN(result, obj_write_mesh(command->mesh, &mesh, error));
    if (result == RESULT_OK && !command->output.quiet)
        fprintf(gen_messages(&command->output), "%s: %u vertices, %u triangles\n",
                quote(command->mesh).text, mesh.vertex_count, mesh.triangle_count);
    mesh_destroy(&mesh);
    return result;
}

static Result write_motion(const Command *command, Error *error)
{
    Mesh mesh;
    Result result = head_make_mesh(&mesh, HEAD_MOTION_TRIANGLES, error);
    THEN(result, head_motion_write(command->motion, &mesh, error));
    if (result == RESULT_OK && !command->output.quiet)
        fprintf(gen_messages(&command->output), "%s: %u vertices, %d s at %d samples a second\n",
                quote(command->motion).text, mesh.vertex_count, HEAD_MOTION_SECONDS,
                HEAD_MOTION_RATE);
    mesh_destroy(&mesh);
    return result;
}

static Result write_environment(const Command *command, Error *error)
{
    TRY(studio_light_write(command->environment, error));
    if (!command->output.quiet)
        fprintf(gen_messages(&command->output), "%s: %d x %d px\n",
                quote(command->environment).text, 2 * STUDIO_LIGHT_HEIGHT, STUDIO_LIGHT_HEIGHT);
    return RESULT_OK;
}

static Result write_all(const Command *command, Error *error)
{
    StrandsRecipe recipe = make_recipe(command);
    ScalpShape shape = command->set >= 0 ? SCALP_SPHERE : recipe.shape;
    const PathUse uses[] = {{"-o", command->output.path, PATH_WRITTEN, NULL},
                            {"--mesh", command->mesh, PATH_WRITTEN, NULL},
                            {"--motion", command->motion, PATH_WRITTEN, NULL},
                            {"--environment", command->environment, PATH_WRITTEN, NULL}};
    TRY(paths_claim(uses, sizeof uses / sizeof *uses, error));
    activity_start(stderr, command->output.quiet);
    activity_set("growing hair");
    if (command->output.path) TRY(write_hair(command, &recipe, error));
    if (command->mesh) TRY(write_mesh(command, shape, error));
    if (command->motion) TRY(write_motion(command, error));
    if (command->environment) TRY(write_environment(command, error));
    return RESULT_OK;
}

// --- tractrix-gen fur.

static Result write_fur(const FurOptions *options, const Mesh *mesh, Error *error)
{
    Strands strands;
    FurReport report;
    TRY(fur_grow(&strands, &options->recipe, mesh, options->mesh, &report, error));
    if (report.flat_triangles)
        fprintf(stderr, "%s: %u triangles without area are ignored\n", quote(options->mesh).text,
                report.flat_triangles);
    if (report.stuck)
        fprintf(stderr, "%s: %llu segments could not be kept outside the mesh\n",
                quote(options->output.path).text, (unsigned long long)report.stuck);
    Result result = write_strands(&options->output, &strands, report.guides, error);
    strands_destroy(&strands);
    return result;
}

// Of a mesh that deforms, the first sample.
static Result read_mesh(Mesh *mesh, const FurOptions *options, Error *error)
{
    if (!mesh_sequence_matches(options->mesh)) {
        float unit = options->unit > 0 ? (float)options->unit : 1;
        Result result = mesh_read(mesh, options->mesh, unit, options->up_z, error);
        return strands_read_as_mesh(result, options->mesh, error);
    }
    MeshSequence sequence = {0};
    Mesh rest = {0};
    const MeshSequenceOptions wishes = {.unit = options->unit,
                                        .otherwise_unit = 1,
                                        .up_z = options->up_z ? 1 : -1,
                                        .rest = NULL,
                                        .otherwise_rate = 1};
    Result result = mesh_sequence_read(&sequence, mesh, &rest, options->mesh, &wishes, error);
    if (result == RESULT_OK && *sequence.note)
        fprintf(stderr, "%s: %s\n", quote(options->mesh).text, sequence.note);
    mesh_sequence_destroy(&sequence);
    mesh_destroy(&rest);
    return result;
}

static Result grow_fur(int argc, char **argv, Error *error)
{
    FurOptions options;
    Mesh mesh;
    bool done;
    TRY(fur_recipe_parse(&options, argc, argv, &done, error));
    if (done) return RESULT_OK;
    const PathUse uses[] = {{"the mesh", options.mesh, PATH_READ, NULL},
                            {"--density", options.recipe.density, PATH_READ, NULL},
                            {"--length-map", options.recipe.length_map, PATH_READ, NULL},
                            {"--comb", options.recipe.comb, PATH_READ, NULL},
                            {"-o", options.output.path, PATH_WRITTEN, NULL}};
    TRY(paths_claim(uses, sizeof uses / sizeof *uses, error));
    activity_start(stderr, options.output.quiet);
    activity_set("growing hair");
    TRY(read_mesh(&mesh, &options, error));
    // After the mesh: a file of hair in its place is the first thing to mend.
    Result result = options.output.path
                        ? write_fur(&options, &mesh, error)
                        : error_set(error, RESULT_USAGE, "no output: expected -o FILE");
    mesh_destroy(&mesh);
    return result;
}

// --- The program.

static Result run(int argc, char **argv, Error *error)
{
    Command command;
    bool done;
    if (argc > 1 && strcmp(argv[1], "fur") == 0) return grow_fur(argc - 1, argv + 1, error);
    Result result = parse(&command, argc, argv, &done, error);
    return result == RESULT_OK && !done ? write_all(&command, error) : result;
}

int main(int argc, char **argv)
{
    Error error = {{0}};
    program_begin(argc, argv);
    Result result = run(argc, argv, &error);
    activity_end();
    return program_end("tractrix-gen", result, &error);
}
