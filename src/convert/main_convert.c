// SPDX-License-Identifier: MIT
// tractrix-convert: describes hair files, edits hair, and writes it in other formats.
#include "base/activity.h"
#include "base/interrupt.h"
#include "base/json.h"
#include "base/options.h"
#include "base/params.h"
#include "base/paths.h"
#include "base/program.h"
#include "base/progress.h"
#include "base/quote.h"
#include "base/rate.h"
#include "convert/convert_input.h"
#include "convert/convert_output.h"
#include "convert/convert_steps.h"
#include "convert/figures.h"
#include "formats/mesh_read.h"
#include "formats/mesh_sequence.h"
#include "formats/strands_read.h"
#include "strands/strands.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct Command {
    const char *unit, *to_unit, *output, *json, *array, *object, *mesh,
        *mesh_unit; // NULL: not given
    int points, up, to_up, mesh_up, format, first, last, every, seed, frame_number;
    const char *fps;
    double width;
    bool strict, stats, quiet, partial;
    OptionSteps steps;
} Command;

#define AT(member) offsetof(Command, member)
static const char AXES[] = "y|z", FROM_AXES[] = "auto|y|z", UNITS[] = "m|cm|mm|in|NUMBER";

static const Option OPTIONS[] = {
    {"output", 'o', OPTION_STRING, AT(output), "FILE", 0, 0,
     "file to write, in the format of its suffix (see below); a name with %d or %04d: one file per "
     "frame; -: standard output, in the format of --format"},
    {"format", 0, OPTION_WORD, AT(format), "auto" FORMAT_WORDS, 0, 0,
     "format of FILE; auto: as the suffix says, .tfx is tfx4, or text if strands differ in their "
     "number of vertices [default auto]"},
    {"stats", 0, OPTION_SWITCH, AT(stats), NULL, 0, 0,
     "print counts, lengths, curvature, spacing and a histogram of vertices per strand, after all "
     "steps"},
    {"json", 0, OPTION_STRING, AT(json), "FILE", 0, 0, "write all figures to this JSON file"},
    {"quiet", 'q', OPTION_SWITCH, AT(quiet), NULL, 0, 0, "print errors only"},

    {"unit", 0, OPTION_STRING, AT(unit), UNITS, 0, 0,
     "length of one unit of the hair files [default: as the file says, or guessed from format and "
     "size]"},
    {"up", 0, OPTION_WORD, AT(up), FROM_AXES, 0, 0,
     "axis of the hair files that points up; auto: as the file says, otherwise z in Cem Yuksel's "
     ".hair files and y in all others [default auto]"},
    {"points-per-strand", 0, OPTION_WHOLE, AT(points), "N", 2, 65535,
     "points per strand of .ply and .npy point lists; vertices per cubic curve of USD and Alembic "
     "files [default: from the gaps between strands; 1 to 4 per curve segment]"},
    {"object", 0, OPTION_STRING, AT(object), "NAME", 0, 0,
     "read only these objects of a USD or Alembic file: names in their paths, separated by commas, "
     "with * and ?; !NAME leaves out [default: all]"},
    {"array", 0, OPTION_STRING, AT(array), "NAME", 0, 0,
     "name of the array of positions in a .npz file [default: positions, points, or the first "
     "array of a suitable shape]"},
    {"strict", 0, OPTION_SWITCH, AT(strict), NULL, 0, 0,
     "reject files with defects instead of repairing them"},
    {"to-unit", 0, OPTION_STRING, AT(to_unit), UNITS, 0, 0, "unit of the written file [default m]"},
    {"to-up", 0, OPTION_WORD, AT(to_up), AXES, 0, 0,
     "axis of the written file that points up [default y]"},
    {"width", 0, OPTION_REAL, AT(width), "M", 1e-7, 1,
     "diameter of the strands in .usda and .abc, metres [default: the file's, or estimated]"},

    {"first", 0, OPTION_WHOLE, AT(first), "N", 0, 9999999, "first frame to write [default 0]"},
    {"last", 0, OPTION_WHOLE, AT(last), "N", 0, 9999999,
     "last frame to write [default: the last frame of the input]"},
    {"frame-number", 0, OPTION_WHOLE, AT(frame_number), "N", 0, 9999999,
     "number of the first frame in the output [default: that of the input]"},
    {"partial", 0, OPTION_SWITCH, AT(partial), NULL, 0, 0,
     "if a cache is cut off or a numbered file is missing, use the frames before that; without "
     "this option it is an error"},
    {"every", 0, OPTION_WHOLE, AT(every), "N", 1, 9999999, "write every Nth frame [default 1]"},
    {"fps", 0, OPTION_STRING, AT(fps), "X|A/B", 0, 0,
     "frames per second, such as 25, 23.976 or 24000/1001, of .usda, .abc and .npz [default: the "
     "cache's; 60 for numbered files]"},

    {"mesh", 0, OPTION_STRING, AT(mesh), "FILE", 0, 0,
     "head or body for --fit, --attach and --push-out, and for --stats, which then prints how deep "
     "hair is inside it: OBJ, PLY, or a deforming mesh with faces (its first sample)"},
    {"mesh-unit", 0, OPTION_STRING, AT(mesh_unit), UNITS, 0, 0,
     "length of one unit of the mesh [default: as the file says; otherwise as for the first hair "
     "file or, with --fit, guessed from the size of an OBJ or PLY file]"},
    {"mesh-up", 0, OPTION_WORD, AT(mesh_up), FROM_AXES, 0, 0,
     "axis of the mesh that points up; auto: as the file says, otherwise as for the first hair "
     "file [default auto]"},

    {"subsample", 0, OPTION_STEP, AT(steps), "SHARE", 0, 0,
     "step: keep a random share of the strands, 0.1 or 10%"},
    {"nth", 0, OPTION_STEP, AT(steps), "N", 0, 0, "step: keep every Nth strand"},
    {"group", 0, OPTION_STEP, AT(steps), "N", 0, 0,
     "step: keep the strands of group N: Alembic's groom_group_id; the section of a cache or "
     ".usda; the number of the input file, from 0, if there are several"},
    {"min-length", 0, OPTION_STEP, AT(steps), "M", 0, 0,
     "step: drop strands that are shorter than M metres"},
    {"resample", 0, OPTION_STEP, AT(steps), "N", 0, 0,
     "step: place N vertices at equal distances along each strand"},
    {"resample-spline", 0, OPTION_STEP, AT(steps), "N", 0, 0,
     "step: like --resample, along a spline through the vertices (centripetal Catmull-Rom)"},
    {"spacing", 0, OPTION_STEP, AT(steps), "M", 0, 0,
     "step: place vertices at equal distances of at most M metres"},
    {"smooth", 0, OPTION_STEP, AT(steps), "N", 0, 0,
     "step: run a binomial filter N times over the vertices between root and tip"},
    {"scale", 0, OPTION_STEP, AT(steps), "X", 0, 0, "step: scale about the origin"},
    {"rotate", 0, OPTION_STEP, AT(steps), "AXIS,DEG", 0, 0,
     "step: rotate about the axis x, y or z, for example y,90"},
    {"translate", 0, OPTION_STEP, AT(steps), "X,Y,Z", 0, 0, "step: move by X,Y,Z metres"},
    {"reverse", 0, OPTION_STEP, AT(steps), NULL, 0, 0, "step: swap roots and tips"},
    {"fit", 0, OPTION_STEP, AT(steps), NULL, 0, 0,
     "step: scale, rotate and move all hair so that the roots come as near to the mesh as "
     "possible, to move a groom to another head"},
    {"attach", 0, OPTION_STEP, AT(steps), NULL, 0, 0,
     "step: move each strand so that its root lies on the mesh"},
    {"push-out", 0, OPTION_STEP, AT(steps), "M", 0, 0,
     "step: move vertices that are inside the mesh, or nearer to it than M metres, to a distance "
     "of M outside; roots stay"},
    {"seed", 0, OPTION_WHOLE, AT(seed), "N", 0, 2147483647,
     "start of the random numbers of --subsample and of the shuffle that some formats need "
     "[default 1]"},
};

// The notes of the help after the paragraph about formats.
#define OTHER_NOTES                                                                                \
    "Steps run in the order of the command line. Their lengths are in metres and y points up, "    \
    "whatever unit and axis the file uses.",                                                       \
        "Defects are repaired when a file is read, as in tractrix-render, and a line is printed "  \
        "for each kind of defect: strands without length or with coordinates that are not "        \
        "numbers are dropped, coincident vertices are merged, bad attributes are replaced. Data "  \
        "that the written format cannot store is left out, with one warning.",                     \
        NULL

static const char *const STATUS[][2] = {
    {"0", "done"},
    {"1", "failed: a file can't be written, frames are missing, no strand is left, ..."},
    {"2", "wrong usage"},
    {"3", "a file can't be read or is rejected"},
    {"130", "interrupted"},
    {NULL, NULL}};

static const char *const EXAMPLES[] = {
    "tractrix-convert hair.tfx",
    "tractrix-convert hair.tfx --stats --json hair.json",
    "tractrix-convert hair.tfx -o hair.usda",
    "tractrix-convert in.tfx --resample 32 --subsample 10% --scale 0.5 -o out.hair",
    "tractrix-convert scan.data --up z --min-length 0.01 --spacing 0.005 -o scan.tfx --format text",
    "tractrix-convert groom.abc --mesh other.obj --fit --attach --push-out 0.001 -o fitted.abc",
    "tractrix-convert anim.cache -o anim.usda",
    "tractrix-convert sim_%04d.tfx --fps 30 -o sim.usda",
    "tractrix-gen --kind curls -o - | tractrix-convert - --resample 64 -o x.usda",
    NULL};

static const OptionsProgram PROGRAM = {
    .name = "tractrix-convert",
    .summary = "convert, change and measure hair files",
    .synopsis = "[OPTION]... FILE...",
    .description =
        "Describes hair files; thins, resamples, smooths and moves hair; and writes it in "
        "other formats, also animated.",
    .options = OPTIONS,
    .option_count = sizeof OPTIONS / sizeof *OPTIONS,
    .status = STATUS,
    .examples = EXAMPLES,
};

// --- The command line.

typedef struct Job {
    Command command;
    ConvertSteps steps;
    ConvertInput input;
    ConvertOutput output;
    Figures figures;
    int shift;       // of frame numbers, from the input to the output
    float mesh_unit; // m; 0: not given
    Mesh mesh;
    Surface surface; // of the mesh; without it all zero
} Job;

static Result parse_unit(const char *name, const char *text, float *metres, Error *error)
{
    SectionParams params = {0};
    if (!text) return RESULT_OK;
    Result result = params_parse(params_find("unit"), &params, text, error);
    *metres = params.unit.automatic ? 0 : params.unit.value;
    return result == RESULT_OK ? result : error_prefix(error, result, "--%s: ", name);
}

// A last input that does not exist may be meant as the output: `tractrix-convert a.tfx b.abc`.
static Result check_last(const Command *command, char **files, int count, Error *error)
{
    const char *last = files[count - 1];
    if (command->output || count < 2 || strcmp(last, "-") == 0 || strchr(last, '%') ||
        access(last, F_OK) == 0)
        return RESULT_OK;
    return error_set(error, RESULT_BAD_INPUT, "%.300s: %s: expected -o %.300s for an output", last,
                     strerror(errno), last);
}

// Checks that no output overwrites an input or another output.
static Result check_paths(const Command *command, char **files, int count, Error *error)
{
    PathUse *uses = calloc((size_t)count + 3, sizeof *uses);
    if (!uses) return error_set(error, RESULT_FAILED, "no memory for %d files", count);
    for (int i = 0; i < count; ++i) uses[i] = (PathUse){"the input", files[i], PATH_READ, NULL};
    uses[count] = (PathUse){"-o", command->output, PATH_TARGET, NULL};
    uses[count + 1] = (PathUse){"--json", command->json, PATH_WRITTEN, NULL};
    uses[count + 2] = (PathUse){"--mesh", command->mesh, PATH_READ, NULL};
    Result result = paths_claim(uses, count + 3, error);
    free(uses);
    return result;
}

static Result check_sense(const Command *command, int files, Error *error)
{
    bool to = command->to_unit || command->to_up || command->format || command->width > 0;
    if (files == 0)
        return error_set(error, RESULT_USAGE, "no input: expected a hair file or a cache");
    if (!command->output && to)
        return error_set(
            error, RESULT_USAGE,
            "--to-unit, --to-up, --format and --width have no effect: expected -o with them");
    if (!command->output && !command->stats && !command->json && command->steps.count)
        return error_set(error, RESULT_USAGE,
                         "--%s: has no effect without output: expected -o, --stats or --json",
                         command->steps.step[0].option->name);
    if (!command->mesh && (command->mesh_unit || command->mesh_up))
        return error_set(error, RESULT_USAGE,
                         "--mesh-unit and --mesh-up have no effect: expected --mesh with them");
    return RESULT_OK;
}

// Steps that use a mesh need --mesh, and --mesh without any use of the mesh is an error.
static Result check_mesh(const Job *job, Error *error)
{
    const Command *command = &job->command;
    const char *step = convert_steps_need_mesh(&job->steps);
    if (step && !command->mesh)
        return error_set(error, RESULT_USAGE, "--%s: expected --mesh FILE with it", step);
    if (command->mesh && !step && !command->stats && !command->json)
        return error_set(error, RESULT_USAGE,
                         "--mesh: has no effect: expected --fit, --attach, --push-out, --stats or "
                         "--json with it");
    return RESULT_OK;
}

static void describe_formats(char *text, size_t size)
{
    char names[400], suffixes[200];
    format_list_names(names, sizeof names);
    format_list_suffixes(suffixes, sizeof suffixes);
    snprintf(text, size,
             "FILE is a hair file (%s), - for standard input, a name with %%d or %%04d that stands "
             "for numbered files, or a cache of tractrix-render. Several hair files are joined to "
             "one. Without -o, --stats and --json the program only describes the files. Files are "
             "written with the suffix %s.",
             names, suffixes);
}

// Whether to read all frames of a file with animation: if the output can hold frames, or if --first
// or --last is given.
static bool wants_frames(const Command *command)
{
    bool still = !command->output || convert_output_is_still(command->output, command->format);
    return !still || command->first > 0 || command->last >= 0;
}

static Result parse(Job *job, int argc, char **argv, bool *done, Error *error)
{
    Command *command = &job->command;
    int first;
    float unit = 0, to_unit = 1;
    char formats[1400];
    const char *const notes[] = {formats, OTHER_NOTES};
    OptionsProgram program = PROGRAM;
    program.notes = notes;
    describe_formats(formats, sizeof formats);
    *command = (Command){.last = -1, .frame_number = -1, .every = 1, .seed = 1};
    TRY(options_parse(&program, command, argc, argv, &first, done, error));
    if (*done) return RESULT_OK;
    TRY(check_sense(command, argc - first, error));
    TRY(check_last(command, argv + first, argc - first, error));
    TRY(check_paths(command, argv + first, argc - first, error));
    double fps = 0;
    if (command->fps && !(rate_parse(command->fps, &fps) && fps >= 0.001 && fps <= 10000))
        return error_set(error, RESULT_USAGE,
                         "--fps: got '%.200s', expected a number from 0.001 to 10000, or a "
                         "fraction, 24000/1001",
                         command->fps);
    TRY(parse_unit("unit", command->unit, &unit, error));
    TRY(parse_unit("to-unit", command->to_unit, &to_unit, error));
    if (to_unit == 0)
        return error_set(error, RESULT_USAGE, "--to-unit: got 'auto', expected a unit");
    TRY(convert_steps_parse(&job->steps, &command->steps, error));
    TRY(parse_unit("mesh-unit", command->mesh_unit, &job->mesh_unit, error));
    TRY(check_mesh(job, error));
    job->steps.seed = (uint32_t)command->seed;
    job->input = (ConvertInput){.paths = argv + first,
                                .path_count = argc - first,
                                .options = {.unit = unit,
                                            .up = (UpAxis)command->up,
                                            .strict = command->strict,
                                            .seed = (uint32_t)command->seed,
                                            .recenters = true,
                                            .points_per_strand = (uint32_t)command->points,
                                            .array = command->array,
                                            .objects = command->object},
                                .messages = command->quiet ? NULL : stderr,
                                .says_guess = command->output,
                                .wants_frames = wants_frames(command),
                                .first = command->first,
                                .last = command->last,
                                .whole = command->output && !command->partial,
                                .every = command->every,
                                .fps = fps};
    job->output = (ConvertOutput){.path = command->output,
                                  .format = command->format,
                                  .unit = (double)to_unit,
                                  .up_z = command->to_up == 1,
                                  .width = command->width};
    return RESULT_OK;
}

// --- The work.

// Guesses the unit of a mesh in the units of its file, and converts it to metres: of a metre, a
// centimetre and a millimetre the one with which the diagonal of its bounding box comes nearest to
// 0.8 m, as a ratio. That is between a head (0.3 m) and a body (2.2 m). Returns the unit.
static double guess_unit(Mesh *mesh)
{
    static const double USUAL_SIZE = 0.8;
    double size = mesh_diagonal(mesh), unit = 1;
    if (size > USUAL_SIZE * sqrt(1e2)) unit = 0.01;
    if (size > USUAL_SIZE * sqrt(1e5)) unit = 0.001;
    for (uint32_t v = 0; v < mesh->vertex_count; ++v)
        for (int k = 0; k < 3; ++k)
            mesh->position[v][k] = (float)(unit * (double)mesh->position[v][k]);
    return unit;
}

// A mesh in one pose. It has the unit of the hair, unless the hair is to be fitted to it: then it
// is not the mesh on which the hair was groomed, and only its size tells its unit.
static Result read_rigid_mesh(Job *job, const MeshSequenceOptions *options, Error *error)
{
    const char *path = job->command.mesh;
    bool guesses = options->unit == 0 && convert_steps_fit(&job->steps),
         up_z = (options->up_z >= 0 ? options->up_z : options->otherwise_up_z) == 1;
    double unit = guesses ? 1 : options->unit > 0 ? options->unit : options->otherwise_unit;
    Result result = mesh_read(&job->mesh, path, (float)unit, up_z, error);
    if (result == RESULT_OK && guesses) unit = guess_unit(&job->mesh);
    if (result == RESULT_OK) mesh_take_away(&job->mesh, options->origin);
    // If hair and mesh are in metres, nothing was assumed that a reader would not expect.
    if (result == RESULT_OK && guesses && !job->command.quiet &&
        (unit != 1 || options->otherwise_unit != 1))
        fprintf(stderr, "%s: guessed a unit of %g m: set --mesh-unit if this is wrong\n",
                quote(path).text, unit);
    return strands_read_as_mesh(result, path, error);
}

// Reads the mesh after the first frame of hair, so that the hair's unit and up axis can serve as
// defaults for the mesh.
static Result read_mesh(Job *job, Error *error)
{
    const char *path = job->command.mesh;
    const StrandsReport *first = job->input.cached ? NULL : &job->input.reports[0];
    const MeshSequenceOptions options = {
        .unit = (double)job->mesh_unit,
        .otherwise_unit = first ? (double)first->unit_used : 1,
        .up_z = job->command.mesh_up ? job->command.mesh_up == UP_Z : -1,
        .otherwise_up_z = first && first->up_z,
        .rest = NULL,
        .otherwise_rate = 1,
        .origin = {job->input.origin[0], job->input.origin[1], job->input.origin[2]},
    };
    if (!path) return RESULT_OK;
    MeshSequence sequence = {0};
    Mesh rest = {0};
    Result result = mesh_sequence_matches(path)
                        ? mesh_sequence_read(&sequence, &job->mesh, &rest, path, &options, error)
                        : read_rigid_mesh(job, &options, error);
    mesh_sequence_destroy(&sequence);
    mesh_destroy(&rest);
    THEN(result, surface_create(&job->surface, &job->mesh, path, error));
    job->steps.surface = &job->surface;
    job->steps.messages = job->command.quiet ? NULL : stderr;
    return result;
}

static Result open_files(Job *job, Error *error)
{
    ConvertInput *input = &job->input;
    ConvertOutput *output = &job->output;
    TRY(convert_input_open(input, error));
    if (!output->path) return RESULT_OK;
    int count = convert_input_count(input);
    output->animated = convert_input_moves(input);
    int number = job->command.frame_number;
    job->shift = number < 0 ? 0 : number - input->first;
    output->first = input->first + job->shift;
    output->last = output->first + (count - 1) * input->every;
    output->fps = input->fps;
    return convert_output_open(output, count, error);
}

static Result do_frame(Job *job, int frame, Error *error)
{
    const Command *command = &job->command;
    Strands strands;
    bool first = frame == job->input.first;
    activity_set("reading");
    Result result = convert_input_read(&job->input, frame, &strands, error);
    if (result == RESULT_OK && first)
        job->output.lost = job->input.features & ~strands_features(&strands);
    if (first) THEN(result, read_mesh(job, error));
    activity_set("converting");
    THEN(result, convert_steps_apply(&job->steps, &strands, error));
    if (first && (command->stats || command->json))
        THEN(result, figures_measure(&job->figures, &strands, job->steps.surface, error));
    activity_set("writing");
    if (command->output)
        THEN(result, convert_output_add(&job->output, frame + job->shift, &strands, error));
    // A group for each joined file was made here, not read from a file. So an output format without
    // groups loses nothing of the input.
    if (!(job->input.features & STRANDS_HAS_GROUP))
        job->output.lost &= ~(uint32_t)STRANDS_HAS_GROUP;
    strands_destroy(&strands);
    return result;
}

static Result do_frames(Job *job, Error *error)
{
    const ConvertInput *input = &job->input;
    int done = 0, count = job->command.output ? convert_input_count(input) : 1;
    Progress progress;
    Result result = RESULT_OK;
    progress_start(&progress, stderr, count, job->command.quiet || count == 1);
    for (; done < count && result == RESULT_OK; ++done) {
        result = interrupt_requested() ? error_set(error, RESULT_INTERRUPTED,
                                                   "interrupted after %d of %d frames", done, count)
                                       : do_frame(job, input->first + done * input->every, error);
        progress_update(&progress, done + 1);
    }
    progress_clear(&progress);
    if (job->command.output) THEN(result, convert_output_finish(&job->output, error));
    activity_end();
    return result;
}

// The stream for messages: stderr if hair is written to standard output.
static FILE *messages_of(const Command *command)
{
    return command->output && outfile_is_stdout(command->output) ? stderr : stdout;
}

static void print_output(const Job *job)
{
    FILE *stream = messages_of(&job->command);
    const ConvertOutput *output = &job->output;
    const char *kind = FORMAT_TABLE[output->kind]->name;
    char lost[300];
    strands_features_describe(output->lost, lost, sizeof lost);
    if (*lost) fprintf(stderr, "%s: %s leaves out: %s\n", quote(output->path).text, kind, lost);
    if (output->animated)
        fprintf(stream, "%s: %s, %d frames\n", quote(output->path).text, kind,
                convert_input_count(&job->input));
    else
        fprintf(stream, "%s: %s\n", quote(output->path).text, kind);
}

static json_t *output_to_json(const ConvertOutput *output)
{
    char lost[300];
    strands_features_describe(output->lost, lost, sizeof lost);
    return json_pack("{ss ss si ss}", "file", output->path, "kind",
                     FORMAT_TABLE[output->kind]->name, "files", output->files, "left_out", lost);
}

// `output`: NULL if no hair is written.
static Result write_json(const char *path, const ConvertInput *input, const Figures *figures,
                         const ConvertOutput *output, Error *error)
{
    json_t *root = json_pack("{so so}", "input", convert_input_to_json(input), "hair",
                             figures_to_json(figures));
    if (convert_input_moves(input))
        json_object_set_new(root, "frames",
                            json_pack("{si si si sf}", "first", input->first, "last", input->last,
                                      "every", input->every, "fps", input->fps));
    if (output) json_object_set_new(root, "output", output_to_json(output));
    Result result = json_write_file(root, path, error);
    json_decref(root);
    return result;
}

static Result run(Job *job, Error *error)
{
    const Command *command = &job->command;
    bool only_reports = !command->output && !command->stats && !command->json;
    activity_start(stderr, command->quiet);
    activity_set("reading");
    TRY(open_files(job, error));
    TRY(do_frames(job, error));
    if (!command->quiet && only_reports) convert_input_print(&job->input, stdout);
    if (!command->quiet && command->output) print_output(job);
    if (command->stats) figures_print(&job->figures, messages_of(command));
    for (int i = 0; command->stats && i < job->input.path_count && !job->input.cached; ++i)
        strands_report_print_contents(&job->input.reports[i], messages_of(command));
    if (!command->json) return RESULT_OK;
    return write_json(command->json, &job->input, &job->figures,
                      command->output ? &job->output : NULL, error);
}

int main(int argc, char **argv)
{
    Job job = {0};
    Error error = {{0}};
    bool done = false;
    program_begin(argc, argv);
    Result result = parse(&job, argc, argv, &done, &error);
    if (result == RESULT_OK && !done) result = run(&job, &error);
    activity_end();
    convert_output_close(&job.output);
    convert_input_close(&job.input);
    figures_destroy(&job.figures);
    surface_destroy(&job.surface);
    mesh_destroy(&job.mesh);
    return program_end("tractrix-convert", result, &error);
}
