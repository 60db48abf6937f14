// SPDX-License-Identifier: MIT
// tractrix-compare: measures how much images differ, frame by frame, and compares that with limits.
#include "base/clock.h"
#include "base/interrupt.h"
#include "base/options.h"
#include "base/outfile.h"
#include "base/paths.h"
#include "base/program.h"
#include "base/progress.h"
#include "compare/github.h"
#include "compare/html.h"
#include "compare/junit.h"
#include "compare/pairs.h"
#include "compare/verdict.h"
#include "image/compare.h"
#include "image/jpeg.h"
#include "image/mask.h"
#include "report/picture.h"
#include "report/shell_words.h"

#include <errno.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

typedef struct Command {
    double pixel_tolerance, max_difference, max_local, max_flip; // negative if not given
    double ppd;
    const char *max_failing, *mask, *heat_map, *sheet, *json, *junit, *unrendered, *html;
    const char *commands, *only, *platform, *class_limits, *common_limits;
    bool github, only_failures, update, any_platform, quiet, all_metrics;
    bool exact_if_alike[LEVELS]; // VerdictOptions
    int jobs, shrink, level;     // level: of --update; LEVEL_NONE: the level of the golden in use
    const char *a, *b;
    CompareLimits limits[LEVELS];
    char *line; // the command line before the parser changes its order; owned
} Command;

#define AT(member) offsetof(Command, member)

static const Option OPTIONS[] = {
    {"pixel-tolerance", 0, OPTION_REAL, AT(pixel_tolerance), "LEVELS", 0, 255,
     "a pixel fails if one of its channels differs by more than this, in levels of 0 to 255 "
     "[default 0]"},
    {"max-failing-pixels", 0, OPTION_STRING, AT(max_failing), "N|P%", 0, 0,
     "number or percentage of the pixels of an image that may fail [default 0]"},
    {"max-difference", 0, OPTION_REAL, AT(max_difference), "LEVELS", 0, 255,
     "no pixel may differ by more than this in any channel, however few pixels fail"},
    {"max-local-difference", 0, OPTION_REAL, AT(max_local), "LEVELS", 0, 255,
     "largest mean difference of a channel over any 16 x 16 pixels; lighter and darker pixels "
     "cancel out"},
    {"max-flip", 0, OPTION_REAL, AT(max_flip), "X", 0, 1,
     "largest mean FLIP error of an image; this and the two options above can be the only limits"},
    {"all-metrics", 0, OPTION_SWITCH, AT(all_metrics), NULL, 0, 0,
     "also compute SSIM, and FLIP where no limit and no heat map needs it"},
    {"platform", 0, OPTION_STRING, AT(platform), "NAME", 0, 0,
     "A is a folder of goldens by platform: the golden of an image is the first that exists in "
     "A/NAME/, in A/CLASS/ (cpu, nvidia, amd, intel, gpu) and in A; tractrix-render --platform "
     "prints NAME. Without limits, images must be equal in A/NAME/, and if both files say that the "
     "same driver and processor drew them; otherwise A/CLASS/ and A have limits for differences in "
     "rounding"},
    {"any-platform", 0, OPTION_SWITCH, AT(any_platform), NULL, 0, 0,
     "compare images of GPUs with goldens in A itself, too"},
    {"level", 0, OPTION_WORD, AT(level), "used|platform|class|common", 0, 0,
     "goldens that --update writes; used: the goldens that were compared; new goldens are common "
     "if a CPU drew them, and of the class if a GPU did [default used]"},
    {"class-limits", 0, OPTION_STRING, AT(class_limits), "LEVELS,N|P%", 0, 0,
     "--pixel-tolerance and --max-failing-pixels for goldens in A/CLASS/ only, instead of the "
     "default limits"},
    {"common-limits", 0, OPTION_STRING, AT(common_limits), "LEVELS,N|P%", 0, 0,
     "--pixel-tolerance and --max-failing-pixels for goldens in A itself only"},
    {"ppd", 0, OPTION_REAL, AT(ppd), "X", 1, 1000,
     "pixels per degree of the field of view, for FLIP [default 67]"},
    {"mask", 0, OPTION_STRING, AT(mask), "PATH", 0, 0,
     "image whose black pixels are ignored; a folder or a pattern has a mask for each image of the "
     "same name or number"},
    {"heatmap", 0, OPTION_STRING, AT(heat_map), "PATH", 0, 0,
     "PNG file with the FLIP error of each pixel, black to yellow; for folders and patterns, a "
     "folder with one file for each image that differs"},
    {"sheet", 0, OPTION_STRING, AT(sheet), "PATH", 0, 0,
     "like --heatmap, with A, B and the heat map side by side"},
    {"html", 0, OPTION_STRING, AT(html), "FILE.html", 0, 0,
     "write a page for a browser that shows every pair; it contains all images and needs no "
     "network"},
    {"json", 0, OPTION_STRING, AT(json), "FILE", 0, 0, "write all figures to this JSON file"},
    {"junit", 0, OPTION_STRING, AT(junit), "FILE", 0, 0,
     "write the results to this JUnit XML file, for CI"},
    {"github", 0, OPTION_SWITCH, AT(github), NULL, 0, 0,
     "print annotations for GitHub Actions, and append a summary to $GITHUB_STEP_SUMMARY"},
    {"only-failures", 0, OPTION_SWITCH, AT(only_failures), NULL, 0, 0,
     "list only images that fail, in lines and reports; counts still cover all images"},
    {"unrendered", 0, OPTION_STRING, AT(unrendered), "FILE", 0, 0,
     "file with lines NAME: REASON for images that could not be rendered, for the reports"},
    {"commands", 0, OPTION_STRING, AT(commands), "FILE", 0, 0,
     "file with lines NAME: COMMAND, the commands that rendered the images B, for the reports"},
    {"only", 0, OPTION_STRING, AT(only), "NAME", 0, 0,
     "compare only the image of this name, such as walk/0001.png; %d or %04d in the name stands "
     "for "
     "any number"},
    {"update", 0, OPTION_SWITCH, AT(update), NULL, 0, 0,
     "accept B: copy it over A where the two differ or A is missing"},
    {"shrink", 0, OPTION_WHOLE, AT(shrink), "PX", 1, 16384,
     "compare nothing: write image A as the JPEG file B, at most PX pixels wide and high"},
    {"jobs", 'j', OPTION_WHOLE, AT(jobs), "N", 1, 1024,
     "number of images that are compared in parallel [default: the number of processors]"},
    {"quiet", 'q', OPTION_SWITCH, AT(quiet), NULL, 0, 0, "print errors only"},
};

static const char *const NOTES[] = {
    "A and B are two images (PNG of 8 or 16 bits, PFM, EXR), two folders, whose .png, .pfm and "
    ".exr files are paired by name, also in subfolders, or two patterns with %d or %04d, paired by "
    "number. Images of different sizes "
    "and images without a partner count as different.",
    "Results: `same` has no visible difference; `within limits` differs, but passes; `different` "
    "fails.",
    "RMSE and PSNR are of red, green and blue in sRGB levels of 0 to 255. SSIM is that of Wang et "
    "al. 2004 on luma. FLIP is that of Andersson et al. 2020: 0 looks the same, 1 is the largest "
    "difference. Equal images score exactly 0 (SSIM 1). Images with alpha are compared over black "
    "and over white, and the worse result counts.",
    "White pixels of a mask are compared, black ones ignored. Images without a mask are compared "
    "as a whole, but "
    "each mask must belong to an image.",
    NULL};

static const char *const STATUS[][2] = {{"0", "all images are the same or within the limits"},
                                        {"1", "different or missing; or a file can't be written"},
                                        {"2", "wrong usage"},
                                        {"3", "an image, a mask or a folder can't be read"},
                                        {"130", "interrupted"},
                                        {NULL, NULL}};

static const char *const EXAMPLES[] = {
    "tractrix-compare golden.png new.png --heatmap difference.png",
    "tractrix-compare goldens/ frames/ --pixel-tolerance 8 --max-failing-pixels 2% --sheet bad/",
    "tractrix-compare ref_%04d.png new_%04d.png --max-flip 0.05 --junit report.xml",
    "tractrix-compare goldens/ frames/ --mask masks/ --only-failures --github",
    "tractrix-compare goldens/ frames/ --html report.html",
    "tractrix-compare goldens/ frames/ --update",
    "tractrix-compare goldens/ frames/ --platform \"$(tractrix-render --platform)\"",
    NULL};

static const OptionsProgram PROGRAM = {
    .name = "tractrix-compare",
    .summary = "compare rendered images, frame by frame",
    .synopsis = "[OPTION]... A B",
    .description = "Compares the images B with the references A and prints one line for "
                   "each image. The exit status is 1 if any image differs by more than the limits.",
    .options = OPTIONS,
    .option_count = sizeof OPTIONS / sizeof *OPTIONS,
    .notes = NOTES,
    .status = STATUS,
    .examples = EXAMPLES,
};

// --- The command line.

static Result read_failing(CompareLimits *limits, const char *name, const char *text, Error *error)
{
    char *end;
    double number = strtod(text, &end);
    bool percent = end != text && end[0] == '%' && !end[1];
    bool whole = end != text && !*end && number <= 1e15 && number == (double)(long long)number;
    limits->max_failing = number;
    limits->max_failing_percent = percent;
    if (number >= 0 && ((percent && number <= 100) || whole)) return RESULT_OK;
    return error_set(error, RESULT_USAGE,
                     "%s: got '%s', expected a whole number of pixels, or 0%% to 100%%", name,
                     text);
}

// "2,0.5%"
static Result read_level_limits(CompareLimits *limits, const char *name, const char *text,
                                Error *error)
{
    char *end;
    double levels = strtod(text, &end);
    if (end == text || *end != ',' || !(levels >= 0 && levels <= 255))
        return error_set(error, RESULT_USAGE,
                         "%s: got '%s', expected LEVELS,N or LEVELS,P%%, for example 2,0.5%% "
                         "(levels from 0 to 255)",
                         name, text);
    limits->pixels_matter = true;
    limits->pixel_tolerance = levels;
    return read_failing(limits, name, end + 1, error);
}

// Limits given as options apply. Without any, images must be equal, or within the limits of the
// golden's level.
static Result read_limits(Command *command, Error *error)
{
    CompareLimits limits = compare_limits_default();
    bool pixels = command->pixel_tolerance >= 0 || command->max_failing;
    limits.pixels_per_degree = command->ppd;
    limits.figures = command->all_metrics ? COMPARE_SSIM | COMPARE_FLIP : 0;
    limits.difference_matters = command->max_difference >= 0;
    limits.max_difference = command->max_difference;
    limits.local_matters = command->max_local >= 0;
    limits.max_local = command->max_local;
    limits.flip_matters = command->max_flip >= 0;
    limits.max_flip = command->max_flip;
    bool others = limits.difference_matters || limits.local_matters || limits.flip_matters;
    limits.pixels_matter = pixels || !others;
    if (command->pixel_tolerance >= 0) limits.pixel_tolerance = command->pixel_tolerance;
    if (command->max_failing)
        TRY(read_failing(&limits, "--max-failing-pixels", command->max_failing, error));
    for (Level level = LEVEL_NONE; level < LEVELS; ++level) {
        command->limits[level] = limits;
        if (!level || pixels || others) continue;
        level_set_limits(&command->limits[level], level);
        command->exact_if_alike[level] = true;
    }
    if (command->class_limits) command->limits[LEVEL_CLASS] = limits;
    if (command->common_limits) command->limits[LEVEL_COMMON] = limits;
    command->exact_if_alike[LEVEL_CLASS] &= !command->class_limits;
    command->exact_if_alike[LEVEL_COMMON] &= !command->common_limits;
    if (command->class_limits)
        TRY(read_level_limits(&command->limits[LEVEL_CLASS], "--class-limits",
                              command->class_limits, error));
    if (!command->common_limits) return RESULT_OK;
    return read_level_limits(&command->limits[LEVEL_COMMON], "--common-limits",
                             command->common_limits, error);
}

// Checks the options for goldens by platform: they need --platform, and --level must be a level
// that this platform uses.
static Result check_platform(const Command *command, Error *error)
{
    const char *alone = command->any_platform    ? "--any-platform"
                        : command->level         ? "--level"
                        : command->class_limits  ? "--class-limits"
                        : command->common_limits ? "--common-limits"
                                                 : NULL;
    if (!command->platform && alone)
        return error_set(error, RESULT_USAGE, "%s: has no effect: expected --platform NAME with it",
                         alone);
    if (command->level && !command->update)
        return error_set(error, RESULT_USAGE, "--level: has no effect: expected --update with it");
    if (!command->platform) return RESULT_OK;
    if (!level_is_platform(command->platform))
        return error_set(error, RESULT_USAGE,
                         "--platform: got '%s', expected the output of tractrix-render --platform",
                         command->platform);
    if (command->level && !level_counts(command->level, command->platform, command->any_platform))
        return error_set(
            error, RESULT_USAGE,
            "--level common: images of the GPU %s are not compared with goldens for all platforms: "
            "expected --level platform or class, or --any-platform with it",
            command->platform);
    return RESULT_OK;
}

// How many reports and images are written to standard output.
static int count_to_stdout(const Command *command)
{
    const char *const paths[] = {command->json, command->junit, command->html, command->heat_map,
                                 command->sheet};
    int count = 0;
    for (size_t i = 0; i < sizeof paths / sizeof *paths; ++i)
        count += paths[i] && outfile_is_stdout(paths[i]);
    return count;
}

// The stream for verdicts. They go to stderr if a report is written to standard output.
static FILE *lines(const Command *command)
{
    return count_to_stdout(command) ? stderr : stdout;
}

static Result check_reports(const Command *command, Error *error)
{
    const char *const images[] = {command->heat_map, command->sheet};
    for (int i = 0; i < 2; ++i)
        if (images[i]) TRY(outfile_refuse_terminal(images[i], error));
    if (count_to_stdout(command) <= 1) return RESULT_OK;
    return error_set(error, RESULT_USAGE, "%d reports to standard output: expected at most one",
                     count_to_stdout(command));
}

// Checks that no output overwrites an input or another output. With --update, A may be overwritten.
// If there are several pairs, --heatmap and --sheet name folders.
static Result claim_paths(const Command *command, const PairList *list, Error *error)
{
    PathRole drawings = list->many ? PATH_FOLDER : PATH_WRITTEN;
    PathRole references = command->update ? PATH_UPDATED : PATH_READ;
    const char *summary = command->github ? getenv("GITHUB_STEP_SUMMARY") : NULL;
    const PathUse own[] = {
        {"A", command->a, references, NULL},
        {"B", command->b, PATH_READ, NULL},
        {"--mask", command->mask, PATH_READ, NULL},
        {"--unrendered", command->unrendered, PATH_READ, NULL},
        {"--commands", command->commands, PATH_READ, NULL},
        {"--heatmap", command->heat_map, drawings, NULL},
        {"--sheet", command->sheet, drawings, NULL},
        {"--html", command->html, PATH_WRITTEN, NULL},
        {"--json", command->json, PATH_WRITTEN, NULL},
        {"--junit", command->junit, PATH_WRITTEN, NULL},
        {"$GITHUB_STEP_SUMMARY", summary, PATH_KEPT, NULL},
    };
    enum { OWN = sizeof own / sizeof *own };
    PathUse *uses = malloc((OWN + 3 * list->count) * sizeof *uses);
    if (!uses) return error_set(error, RESULT_FAILED, "no memory for paths");
    memcpy(uses, own, sizeof own);
    int count = OWN;
    for (size_t i = 0; i < list->count && list->many; ++i) {
        const Pair *pair = &list->pairs[i];
        if (pair->has_a && !command->update)
            uses[count++] = (PathUse){"A's image", pair->a, PATH_READ, NULL};
        if (pair->has_b) uses[count++] = (PathUse){"B's image", pair->b, PATH_READ, NULL};
        if (pair->mask) uses[count++] = (PathUse){"the mask", pair->mask, PATH_READ, NULL};
    }
    Result result = paths_claim(uses, count, error);
    free(uses);
    return result;
}

// --shrink compares nothing, so it refuses all options of a comparison.
static Result check_shrink(const Command *command, const Command *before, Error *error)
{
    static const size_t sizes[] = {[OPTION_SWITCH] = sizeof(bool),
                                   [OPTION_WORD] = sizeof(int),
                                   [OPTION_WHOLE] = sizeof(int),
                                   [OPTION_REAL] = sizeof(double),
                                   [OPTION_STRING] = sizeof(char *)};
    if (!command->shrink) return RESULT_OK;
    for (size_t i = 0; i < sizeof OPTIONS / sizeof *OPTIONS; ++i) {
        const Option *option = &OPTIONS[i];
        if (option->place == AT(shrink) || option->place == AT(quiet)) continue;
        if (memcmp((const char *)command + option->place, (const char *)before + option->place,
                   sizes[option->kind]) != 0)
            return error_set(error, RESULT_USAGE, "--%s: has no effect: --shrink compares nothing",
                             option->name);
    }
    return RESULT_OK;
}

static Result parse(Command *command, int argc, char **argv, bool *done, Error *error)
{
    long cores = sysconf(_SC_NPROCESSORS_ONLN);
    int first;
    *command = (Command){.pixel_tolerance = -1,
                         .max_difference = -1,
                         .max_local = -1,
                         .max_flip = -1,
                         .ppd = compare_limits_default().pixels_per_degree,
                         .jobs = cores < 1      ? 1
                                 : cores > 1024 ? 1024
                                                : (int)cores,
                         .line = shell_join_line("tractrix-compare", argc, argv)};
    if (!command->line)
        return error_set(error, RESULT_FAILED, "cannot record the command line: %s",
                         strerror(errno));
    const Command before = *command;
    Result result = options_parse(&PROGRAM, command, argc, argv, &first, done, error);
    if (result != RESULT_OK || *done) return result;
    TRY(check_shrink(command, &before, error));
    if (argc - first != 2)
        return error_set(error, RESULT_USAGE,
                         "got %d name%s, expected two files, folders or patterns", argc - first,
                         argc - first == 1 ? "" : "s");
    command->a = argv[first], command->b = argv[first + 1];
    TRY(check_reports(command, error));
    TRY(check_platform(command, error));
    return read_limits(command, error);
}

// --- The work: threads take pairs in order; the main thread prints verdicts in order.

typedef struct Work {
    const Command *command;
    const PairList *list;
    Verdict *verdicts;
    HtmlPair *pages; // NULL without --html
    Html html;
    bool *ready;
    size_t next; // the next pair that a thread will take
    pthread_mutex_t lock;
    pthread_cond_t changed;
    Mask mask; // for all pairs; empty if there is none
    time_t started;
    double start_ms;
} Work;

// The path of a pair's heat map or sheet: a file in the folder `path` with the name of the pair's
// image, such as "frame_0001.png" or "frame_0001.pfm.png". If there is only one pair, `path`
// itself. NULL if `path` is NULL or memory is short.
static char *name_drawing(const Work *work, const char *path, const Pair *pair)
{
    char *name;
    size_t length = strlen(pair->name);
    if (!path) return NULL;
    if (!work->list->many) return strdup(path);
    bool png = length > 4 && strcasecmp(pair->name + length - 4, ".png") == 0;
    return asprintf(&name, "%s/%s%s", path, pair->name, png ? "" : ".png") < 0 ? NULL : name;
}

static void judge(Work *work, size_t i)
{
    const Command *command = work->command;
    const Pair *pair = &work->list->pairs[i];
    char *heat_map = name_drawing(work, command->heat_map, pair);
    char *sheet = name_drawing(work, command->sheet, pair);
    VerdictOptions options = {.limits = command->limits[pair->level],
                              .exact_if_alike = command->exact_if_alike[pair->level],
                              .heat_map = heat_map,
                              .sheet = sheet,
                              .draw_all = !work->list->many,
                              .update = command->update,
                              .mask = work->mask.nearest ? &work->mask : NULL,
                              .map = work->pages ? &work->pages[i].map : NULL};
    if (work->pages) html_pair_read(&work->pages[i], pair);
    if (!heat_map == !command->heat_map && !sheet == !command->sheet)
        verdict_find(&work->verdicts[i], pair, &options);
    else
        work->verdicts[i] = (Verdict){.outcome = OUTCOME_FAILED, .text = "no memory for a name"};
    free(heat_map);
    free(sheet);
}

static void *run_thread(void *argument)
{
    Work *work = argument;
    pthread_mutex_lock(&work->lock);
    while (work->next < work->list->count && !interrupt_requested()) {
        size_t i = work->next++;
        pthread_mutex_unlock(&work->lock);
        judge(work, i);
        pthread_mutex_lock(&work->lock);
        work->ready[i] = true;
        pthread_cond_signal(&work->changed);
    }
    work->next = work->list->count;
    pthread_cond_signal(&work->changed);
    pthread_mutex_unlock(&work->lock);
    return NULL;
}

// Adds the pair to the HTML page, which writes its images to the file at once. If that fails,
// threads take no more pairs.
static Result add_to_page(Work *work, size_t i, Error *error)
{
    Result result =
        html_add(&work->html, &work->list->pairs[i], &work->verdicts[i], &work->pages[i], error);
    html_pair_destroy(&work->pages[i]);
    if (result == RESULT_OK) return RESULT_OK;
    pthread_mutex_lock(&work->lock);
    work->next = work->list->count;
    pthread_mutex_unlock(&work->lock);
    return result;
}

// Waits for the verdicts in order and prints each. After an interruption some pairs have no
// verdict; the loop ends at the first of them.
static Result print_verdicts(Work *work, Error *error)
{
    Progress progress;
    Result result = RESULT_OK;
    progress_start(&progress, stderr, (int)work->list->count, work->command->quiet);
    for (size_t i = 0; i < work->list->count && result == RESULT_OK; ++i) {
        pthread_mutex_lock(&work->lock);
        while (!work->ready[i] && !interrupt_requested())
            pthread_cond_wait(&work->changed, &work->lock);
        bool ready = work->ready[i];
        pthread_mutex_unlock(&work->lock);
        if (!ready) {
            progress_clear(&progress);
            return error_set(error, RESULT_INTERRUPTED, "interrupted");
        }
        bool listed = !work->command->only_failures || verdict_is_listed(&work->verdicts[i]);
        if (!work->command->quiet && listed) {
            progress_clear(&progress);
            verdict_print(&work->verdicts[i], &work->list->pairs[i], lines(work->command));
        }
        if (work->pages && listed) result = add_to_page(work, i, error);
        progress_update(&progress, (int)i + 1);
    }
    progress_clear(&progress);
    return result;
}

static Result run_threads(Work *work, Error *error)
{
    pthread_t threads[1024];
    int count = 0, wanted = work->command->jobs;
    if ((size_t)wanted > work->list->count) wanted = (int)work->list->count;
    int reason = 0;
    while (count < wanted && !reason) {
        reason = pthread_create(&threads[count], NULL, run_thread, work);
        if (!reason) ++count;
    }
    if (count == 0)
        return error_set(error, RESULT_FAILED, "cannot start a thread: %s", strerror(reason));
    Result result = print_verdicts(work, error);
    for (int i = 0; i < count; ++i) pthread_join(threads[i], NULL);
    return result;
}

// --- Results.

// Writes the reports, prints the last line and returns the exit status. If an image cannot be read
// (status 3), its error also goes to stderr, where the other programs print errors.
static Result conclude(Work *work, Error *error)
{
    const Command *command = work->command;
    if (command->json)
        TRY(verdict_write_json(command->json, work->list, work->verdicts, command->limits,
                               command->only_failures, error));
    JunitOptions junit = {command->only_failures, 1e-3 * (clock_ms() - work->start_ms),
                          work->started};
    if (command->junit) TRY(junit_write(command->junit, work->list, work->verdicts, &junit, error));
    if (command->github) {
        TRY(github_append_summary(work->list, work->verdicts, command->limits, error));
        github_print_annotations(work->list, work->verdicts, lines(command));
    }
    if (command->html)
        TRY(html_close(&work->html, work->list, command->limits, command->line, error));
    if (!command->quiet) verdict_print_tally(work->list, work->verdicts, lines(command));
    Result result = verdict_status(work->list, work->verdicts);
    for (size_t i = 0; i < work->list->count && result != RESULT_OK; ++i) {
        const Verdict *verdict = &work->verdicts[i];
        bool stops = verdict->outcome == OUTCOME_UNREADABLE || verdict->outcome == OUTCOME_FAILED;
        if (stops && !verdict->updated) return error_set(error, result, "%s", verdict->text);
    }
    error->text[0] = 0;
    return result;
}

// A mask for all pairs is read once before the images, so an error in it is reported only once.
static Result read_mask(Mask *mask, const Command *command, Error *error)
{
    *mask = (Mask){0};
    struct stat status;
    if (!command->mask || stat(command->mask, &status) != 0 || S_ISDIR(status.st_mode))
        return RESULT_OK; // masks in a folder or by pattern are found with the images
    return mask_read(mask, command->mask, error);
}

static Result shrink(const Command *command, Error *error)
{
    Image image, picture = {0}, small = {0};
    Bytes jpeg = {0};
    const PathUse uses[] = {{"A", command->a, PATH_READ, NULL},
                            {"B", command->b, PATH_WRITTEN, NULL}};
    TRY(paths_claim(uses, 2, error));
    TRY(float_image_read_image(&image, command->a, error));
    Result result = picture_create(&picture, &image, error);
    THEN(result,
         picture_create_thumbnail(&small, &picture, command->shrink, command->shrink, error));
    THEN(result, jpeg_encode(&small, JPEG_SMALL, &jpeg, error));
    if (result != RESULT_OK) error_prefix(error, result, "%s: ", command->a);
    THEN(result, bytes_write_file(&jpeg, command->b, error));
    bytes_destroy(&jpeg);
    image_destroy(&small);
    image_destroy(&picture);
    image_destroy(&image);
    return result;
}

static Result run(const Command *command, Error *error)
{
    PairList list = {0};
    Mask mask;
    PairOptions options = {.create = command->update,
                           .mask = command->mask,
                           .unrendered = command->unrendered,
                           .commands = command->commands,
                           .only = command->only,
                           .platform = command->platform,
                           .any_platform = command->any_platform,
                           .update = (Level)command->level};
    TRY(pairs_find(&list, command->a, command->b, &options, error));
    Result ready = claim_paths(command, &list, error);
    THEN(ready, read_mask(&mask, command, error));
    if (ready != RESULT_OK) {
        pairs_destroy(&list);
        return ready;
    }
    Work work = {.command = command,
                 .list = &list,
                 .verdicts = calloc(list.count, sizeof *work.verdicts),
                 .ready = calloc(list.count, sizeof *work.ready),
                 .pages = command->html ? calloc(list.count, sizeof *work.pages) : NULL,
                 .lock = PTHREAD_MUTEX_INITIALIZER,
                 .changed = PTHREAD_COND_INITIALIZER,
                 .mask = mask,
                 .started = time(NULL),
                 .start_ms = clock_ms()};
    bool room = work.verdicts && work.ready && (work.pages || !command->html);
    Result result = room ? RESULT_OK : error_set(error, RESULT_FAILED, "no memory");
    if (command->html) THEN(result, html_open(&work.html, command->html, error));
    THEN(result, run_threads(&work, error));
    THEN(result, conclude(&work, error));
    for (size_t i = 0; work.verdicts && i < list.count; ++i) verdict_destroy(&work.verdicts[i]);
    for (size_t i = 0; work.pages && i < list.count; ++i) html_pair_destroy(&work.pages[i]);
    html_discard(&work.html);
    free(work.pages);
    free(work.verdicts);
    free(work.ready);
    pairs_destroy(&list);
    mask_destroy(&work.mask);
    return result;
}

int main(int argc, char **argv)
{
    Command command;
    Error error = {{0}};
    bool done = false;
    program_begin(argc, argv);
    Result result = parse(&command, argc, argv, &done, &error);
    if (result == RESULT_OK && !done)
        result = command.shrink ? shrink(&command, &error) : run(&command, &error);
    free(command.line);
    return program_end("tractrix-compare", result, &error);
}
