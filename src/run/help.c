// SPDX-License-Identifier: MIT
#include "run/help.h"

#include "base/completion.h"
#include "base/params.h"
#include "base/prose.h"
#include "sim/solver.h"

#include <stdlib.h>
#include <string.h>

enum { TEXT_SIZE = 600 };

static const char SUMMARY[] = "simulate hair and render it, without a window";

static const char DESCRIPTION[] =
    "Reads hair strands (any format that tractrix-convert knows; the content decides which), steps "
    "them by the solver of --algo and draws them to pictures or a video. Each hair file is a section of its own; a scene "
    "file in JSON can give sections their own values, keyframes and lights. Flags override the "
    "scene file: those marked * its value for every section, the others its value for the run.";

static const char FLAG_RULES[] =
    "--flag VALUE and --flag=VALUE are the same; --no-flag takes a flag without value back; the "
    "last of equal flags counts; -- ends the flags.";

static const struct {
    const char *flags, *help;
} REQUESTS[] = {
    {"-h, --help", "print this and stop; --help=man: the manual page in roff; --help=markdown: "
                   "the tables of flags; --help=bash: completion for bash"},
    {"--version", "print the version and stop"},
};
enum { REQUEST_COUNT = sizeof REQUESTS / sizeof REQUESTS[0] };

static const char SCENE_RULES[] =
    "A scene file is a JSON object. Its keys are the flags with '_' for '-': numbers, true and "
    "false as such, X,Y,Z and WxH as arrays, the rest as strings. Those marked * stand in a "
    "section "
    "or, for all sections, beside it. Paths are relative to the file's folder. Values between the "
    "keys of a track run smoothly (monotone cubic) or, with \"interpolation\": \"linear\", "
    "straight; "
    "before the first and after the last key they are constant, and a value that a key leaves out "
    "runs on between the keys that have it. Times are the scene's, which has 0 at frame 0 and runs "
    "--speed times as fast as the video.";

static const struct {
    const char *key, *example, *help;
} SCENE_KEYS[] = {
    {"sections", "[{\"file\": \"hair.tfx\", \"style\": 0.8}, ...]",
     "the hair files, each with its own values"},
    {"head",
     "{\"pivot\": [0, 1.5, 0], \"keys\": [{\"time\": 1, \"translate\": [0, 0, 0.1], "
     "\"rotate\": [0, 90, 0]}, ...]}",
     "rigid motion of the roots and the mesh: s, m, and axis times angle in deg about the pivot"},
    {"head", "{\"translate\": [\"0.02*sin(2*pi*t)\", 0, 0], \"rotate\": [0, \"30*sin(6*t)\", 0]}",
     "the same by formulas of the time t in s: + - * / ^, a ? b : c, pi, sin, exp, min, abs ... "
     "(muParser's), smoothstep(a, b, x)"},
    {"gravity, wind", "{\"keys\": [{\"time\": 0, \"value\": [0, 0, 2]}, ...]}",
     "instead of one array: a force that changes"},
    {"camera",
     "{\"keys\": [{\"time\": 0, \"eye\": [0, 1.6, 2], \"target\": [0, 1.5, 0], "
     "\"fov\": 30}, ...]}",
     "path of the camera; what no key has is as the flag says"},
    {"colliders",
     "[{\"capsule\": [0, 1, 0, 0.08, 0, 1.4, 0, 0.05], \"frame\": \"head\"}, {\"ground\": 0}, ...]",
     "shapes that hair must not cross: sphere, capsule, ground, plane with their numbers (m) as in "
     "--colliders; frame: head or world"},
    {"lights",
     "[{\"type\": \"directional\", \"direction\": [0, -1, 0], \"color\": \"#ffffff\", "
     "\"intensity\": 1}, {\"type\": \"spot\", \"position\": [0, 3, 1], \"distance\": 1, "
     "\"direction\": [0, -1, 0], \"inner\": 0, \"outer\": 45}, ...]",
     "up to 8 lights: directional, point or spot; direction is the way the light travels. A point "
     "or "
     "a spot has its intensity at the distance (m) and falls off by the square; a spot is whole up "
     "to inner deg off its axis and nothing beyond outer. With --shadow the first light casts "
     "shadows, others with \"shadow\": true. Without this key there are two lights, "
     "with an empty list only ambient light"},
};
enum { SCENE_KEY_COUNT = sizeof SCENE_KEYS / sizeof SCENE_KEYS[0] };

static const struct {
    const char *status, *meaning;
} STATUSES[] = {
    {"0", "done"},
    {"1", "failed while running (disk full, out of memory, ...), or --check found defects"},
    {"2", "a flag or a combination of values is wrong"},
    {"3", "a hair, mesh, scene or cache file is wrong, or the cache is of another scene"},
    {"4", "no usable OpenGL (4.3 core or better)"},
    {"130", "interrupted"},
};
enum { STATUS_COUNT = sizeof STATUSES / sizeof STATUSES[0] };

static const char *const EXAMPLES[] = {
    "tractrix-render hair.tfx --frames 120 -o frames/",
    "tractrix-render hair.tfx --turntable 360 --wind 2,0,0 -o hair.mp4",
    "tractrix-render scene.json --cache sim.cache",
    "tractrix-render scene.json --from-cache sim.cache --first 60 --last 119 -o frames/",
    "tractrix-render scene.json --size 1920x1080 -o frames/hair_%04d.png",
};
enum { EXAMPLE_COUNT = sizeof EXAMPLES / sizeof EXAMPLES[0] };

// What stands for the value behind a flag; "" for a BOOL.
static void write_placeholder(const ParamInfo *info, char *text, size_t size)
{
    static const char *const WORDS[] = {[PARAM_BOOL] = "",
                                        [PARAM_INT] = "N",
                                        [PARAM_UINT] = "N",
                                        [PARAM_FLOAT] = "X",
                                        [PARAM_VEC3] = "X,Y,Z",
                                        [PARAM_COLOR] = "COLOR",
                                        [PARAM_BACKGROUND] = "COLOR",
                                        [PARAM_AUTO_INT] = "N|auto",
                                        [PARAM_AUTO_FLOAT] = "X|auto",
                                        [PARAM_AUTO_VEC3] = "X,Y,Z|auto",
                                        [PARAM_UNIT] = "UNIT",
                                        [PARAM_SIZE] = "WxH",
                                        [PARAM_PART] = "I/N",
                                        [PARAM_CHOICE] = "",
                                        [PARAM_TEXT] = "NAME",
                                        [PARAM_PATH] = "PATH"};
    size_t length = (size_t)snprintf(text, size, "%s", WORDS[info->kind]);
    for (int i = 0; info->choices[i] && length < size; i++)
        length +=
            (size_t)snprintf(text + length, size - length, "%s%s", i ? "|" : "", info->choices[i]);
}

// "-o, --output PATH"
static void write_flag(const ParamInfo *info, char *text, size_t size)
{
    char name[64], placeholder[64], letter[8] = "";
    snprintf(name, sizeof name, "%s", info->name);
    for (char *at = name; *at; at++) {
        if (*at == '_') *at = '-';
    }
    if (info->letter) snprintf(letter, sizeof letter, "-%c, ", info->letter);
    write_placeholder(info, placeholder, sizeof placeholder);
    snprintf(text, size, "%s--%s%s%s", letter, name, placeholder[0] ? " " : "", placeholder);
}

// The values' range and unit, "" where there is nothing to say: "0 to 90 deg".
static void write_range(const ParamInfo *info, char *text, size_t size)
{
    static const char *const FORMS[] = {[PARAM_COLOR] = "#rrggbb or r,g,b from 0 to 1",
                                        [PARAM_BACKGROUND] =
                                            "#rrggbb, r,g,b from 0 to 1, or transparent",
                                        [PARAM_UNIT] = "m, cm, mm, in, auto, or a number of metres",
                                        [PARAM_PATH] = ""};
    if (FORMS[info->kind]) {
        snprintf(text, size, "%s", FORMS[info->kind]);
        return;
    }
    const char *between = info->unit[0] ? " " : "";
    if (info->minimum == info->maximum)
        snprintf(text, size, "%s", info->unit);
    else
        snprintf(text, size, "%.10g to %.10g%s%s", info->minimum, info->maximum, between,
                 info->unit);
}

// "[0 to 90 deg; default 15]", without what there is not; "" for a BOOL that is off by default.
static void write_brackets(const ParamInfo *info, char *text, size_t size)
{
    char range[100];
    write_range(info, range, sizeof range);
    bool shown = info->default_text[0] && info->kind != PARAM_BOOL;
    const char *between = range[0] && shown ? "; " : "";
    text[0] = 0;
    if (!range[0] && !shown) return;
    snprintf(text, size, " [%s%s%s%s]", range, between, shown ? "default " : "",
             shown ? info->default_text : "");
}

// The rows of a group, each as `write` lays out a flag and its text.
static void write_group(FILE *stream, int group,
                        void (*write)(FILE *stream, const char *flag, const char *text))
{
    for (size_t i = 0; i < PARAM_COUNT; i++) {
        const ParamInfo *info = &PARAM_TABLE[i];
        if ((int)info->group != group) continue;
        char flag[160], brackets[160], text[TEXT_SIZE];
        write_flag(info, flag, sizeof flag);
        write_brackets(info, brackets, sizeof brackets);
        snprintf(text, sizeof text, "%s%s%s%s%s", info->scope == SCOPE_SECTION ? "* " : "",
                 info->owner, *info->owner ? ": " : "", info->help, brackets);
        write(stream, flag, text);
    }
}

void help_write_text(FILE *stream)
{
    fprintf(stream, "Usage: tractrix-render [FLAGS] HAIR_FILE...\n"
                    "       tractrix-render [FLAGS] SCENE.json\n\n");
    prose_write_wrapped(stream, DESCRIPTION, 0, 0);
    for (int group = 0; group < GROUP_COUNT; group++) {
        fprintf(stream, "\n%s:\n", GROUP_TITLES[group]);
        write_group(stream, group, prose_write_entry);
    }
    fprintf(stream, "\nOther:\n");
    for (int i = 0; i < REQUEST_COUNT; i++)
        prose_write_entry(stream, REQUESTS[i].flags, REQUESTS[i].help);
    fprintf(stream, "\n");
    prose_write_wrapped(stream, FLAG_RULES, 0, 0);
    fprintf(stream, "\nExit status:\n");
    for (int i = 0; i < STATUS_COUNT; i++)
        fprintf(stream, "  %3s  %s\n", STATUSES[i].status, STATUSES[i].meaning);
    fprintf(stream, "\nExamples:\n");
    for (int i = 0; i < EXAMPLE_COUNT; i++) fprintf(stream, "  %s\n", EXAMPLES[i]);
}

void help_write_man(FILE *stream, const char *version)
{
    fprintf(stream, ".TH TRACTRIX-RENDER 1 \"\" \"Tractrix %s\"\n.SH NAME\n", version);
    fprintf(stream, "tractrix\\-render \\- %s\n.SH SYNOPSIS\n", SUMMARY);
    fprintf(stream, ".B tractrix\\-render\n[\\fIflags\\fR] \\fIhair_file\\fR...\n.br\n"
                    ".B tractrix\\-render\n[\\fIflags\\fR] \\fIscene.json\\fR\n");
    prose_write_roff_heading(stream, "SH", "Description");
    prose_write_roff(stream, DESCRIPTION);
    prose_write_roff_heading(stream, "SH", "Options");
    prose_write_roff(stream, FLAG_RULES);
    for (int group = 0; group < GROUP_COUNT; group++) {
        fprintf(stream, ".SS %s\n", GROUP_TITLES[group]);
        write_group(stream, group, prose_write_roff_entry);
    }
    fprintf(stream, ".SS Other\n");
    for (int i = 0; i < REQUEST_COUNT; i++)
        prose_write_roff_entry(stream, REQUESTS[i].flags, REQUESTS[i].help);
    prose_write_roff_heading(stream, "SH", "Scene files");
    prose_write_roff(stream, SCENE_RULES);
    for (int i = 0; i < SCENE_KEY_COUNT; i++) {
        prose_write_roff_entry(stream, SCENE_KEYS[i].key, SCENE_KEYS[i].help);
        fprintf(stream, ".br\n");
        prose_write_roff(stream, SCENE_KEYS[i].example);
    }
    prose_write_roff_heading(stream, "SH", "Exit status");
    for (int i = 0; i < STATUS_COUNT; i++)
        prose_write_roff_entry(stream, STATUSES[i].status, STATUSES[i].meaning);
    prose_write_roff_heading(stream, "SH", "Examples");
    fprintf(stream, ".nf\n");
    for (int i = 0; i < EXAMPLE_COUNT; i++) prose_write_roff(stream, EXAMPLES[i]);
    fprintf(stream, ".fi\n");
}

static void write_markdown_scene(FILE *stream)
{
    fprintf(stream, "\n## Scene files\n\n%s\n\n| key | value | what |\n| --- | --- | --- |\n",
            SCENE_RULES);
    for (int i = 0; i < SCENE_KEY_COUNT; i++)
        fprintf(stream, "| `%s` | `%s` | %s |\n", SCENE_KEYS[i].key, SCENE_KEYS[i].example,
                SCENE_KEYS[i].help);
}

// A cell's text; '|' would end the cell.
static void write_cell(FILE *stream, const char *text)
{
    for (; *text; text++) fprintf(stream, *text == '|' ? "\\%c" : "%c", *text);
}

static void write_markdown_row(FILE *stream, const ParamInfo *info)
{
    char flag[160], range[100];
    write_flag(info, flag, sizeof flag);
    write_range(info, range, sizeof range);
    fprintf(stream, "| `");
    write_cell(stream, flag);
    fprintf(stream, "` | %s", info->default_text[0] ? "`" : "");
    write_cell(stream, info->default_text);
    fprintf(stream, "%s | ", info->default_text[0] ? "`" : "");
    write_cell(stream, range);
    fprintf(stream, " | %s%s%s%s |\n", info->scope == SCOPE_SECTION ? "\\* " : "", info->owner,
            *info->owner ? ": " : "", info->help);
}

void help_write_markdown(FILE *stream)
{
    fprintf(stream, "# Options of tractrix-render\n\n"
                    "Made by scripts/update-options from `tractrix-render --help=markdown`. A "
                    "value marked \\* holds for every section.\n\n");
    for (int group = 0; group < GROUP_COUNT; group++) {
        fprintf(stream, "%s## %s\n\n", group ? "\n" : "", GROUP_TITLES[group]);
        fprintf(stream, "| flag | default | values | what |\n| --- | --- | --- | --- |\n");
        for (size_t i = 0; i < PARAM_COUNT; i++) {
            if ((int)PARAM_TABLE[i].group == group) write_markdown_row(stream, &PARAM_TABLE[i]);
        }
    }
    write_markdown_scene(stream);
}

// Words of a TEXT parameter: the solvers, or all their variants.
static size_t write_solvers(char *text, size_t size, bool variants)
{
    size_t length = 0;
    for (const SolverType *const *type = SOLVER_TYPES; *type; ++type) {
        const char *const *words = variants ? (*type)->variants : &(*type)->name;
        for (int i = 0; i < (variants ? SOLVER_MAX_VARIANTS : 1) && words[i]; ++i)
            if (length < size)
                length += (size_t)snprintf(text + length, size - length, "%s%s", length ? "|" : "",
                                           words[i]);
    }
    return length;
}

void help_write_bash(FILE *stream)
{
    enum { FLAG_SIZE = 400 };
    size_t count = PARAM_COUNT + REQUEST_COUNT;
    char(*texts)[FLAG_SIZE] = calloc(count, sizeof *texts);
    const char **flags = calloc(count, sizeof *flags);
    for (size_t i = 0; texts && flags && i < count; ++i) {
        flags[i] = i < PARAM_COUNT ? texts[i] : REQUESTS[i - PARAM_COUNT].flags;
        if (i < PARAM_COUNT) write_flag(&PARAM_TABLE[i], texts[i], FLAG_SIZE);
        const char *name = i < PARAM_COUNT ? PARAM_TABLE[i].name : "";
        bool algo = strcmp(name, "algo") == 0, variant = strcmp(name, "variant") == 0;
        if (!algo && !variant) continue;
        int start = snprintf(texts[i], FLAG_SIZE, "--%s ", name);
        write_solvers(texts[i] + start, FLAG_SIZE - (size_t)start, variant);
    }
    if (texts && flags) completion_write_bash(stream, "tractrix-render", flags, count);
    free(texts);
    free(flags);
}
