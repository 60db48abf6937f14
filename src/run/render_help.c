// SPDX-License-Identifier: MIT
#include "run/render_help.h"

#include "base/colors.h"
#include "base/params.h"
#include "scene/scene.h"
#include "scene/scene_schema.h"
#include "sim/solver.h"

#include <stdlib.h>
#include <string.h>

enum { TEXT_SIZE = 600, MOST_TOPICS = 32 };

static const char DESCRIPTION[] =
    "Simulates the hair of one or more hair files (formats as for tractrix-convert) and draws it "
    "to images or a video. A scene file "
    "(JSON) can give each hair file its own values, and add keyframes and lights. Options override "
    "the scene file.";

static const char *const NOTES[] = {
    "Options marked * set the value of every hair file; a scene file can give each its own. "
    "Options marked + set the value of every body of a scene file.",
    "--option VALUE and --option=VALUE are the same. --no-option switches off an option without a "
    "value. If an option is given twice, the last one counts. -- ends the options.",
    NULL};

// The options that --help lists without a topic.
static const char *const BRIEF[] = {"mesh",   "fps",     "output",     "size",      "first",
                                    "cache",  "quiet",   "algo",       "style",     "followers",
                                    "frames", "wind",    "colliders",  "turntable", "color",
                                    "look",   "quality", "background", NULL};

static const struct {
    ParamGroup group;
    const char *topic[2];
} GROUP_TOPICS[] = {
    {GROUP_INPUT, {"input", "hair files and the mesh"}},
    {GROUP_OUTPUT, {"output", "images, videos, caches, exported hair, messages"}},
    {GROUP_SIMULATION, {"sim", "solver, followers, time"}},
    {GROUP_FORCES, {"forces", "gravity and wind"}},
    {GROUP_COLLISION, {"collision", "shapes that hair must not cross"}},
    {GROUP_CAMERA, {"camera", "camera, framing, turntable"}},
    {GROUP_HAIR, {"hair", "color, fibres and highlights"}},
    {GROUP_LIGHT, {"light", "ambient light, shadows, floor, tone, background"}},
    {GROUP_QUALITY, {"quality", "presets, anti-aliasing, smooth curves, level of detail"}},
    {GROUP_DEVICE, {"device", "rasteriser and OpenGL device"}},
};

static const char *const SCENE_KEYS[][3] = {
    {"sections", "[{\"file\": \"hair.tfx\", \"style\": 0.8}, ...]",
     "the hair files, each with its own values of options marked *"},
    {"head",
     "{\"pivot\": [0, 1.5, 0], \"keys\": [{\"time\": 1, \"translate\": [0, 0, 0.1], "
     "\"rotate\": [0, 90, 0]}, ...]}",
     "rigid motion of the roots and the mesh: time in s, translation in m, rotation as axis times "
     "angle in degrees about the pivot"},
    {"head", "{\"translate\": [\"0.02*sin(2*pi*t)\", 0, 0], \"rotate\": [0, \"30*sin(6*t)\", 0]}",
     "the same by formulas of the time t in s: + - * / ^, a ? b : c, pi, sin, exp, min, abs ... "
     "(those of muParser), smoothstep(a, b, x)"},
    {"bodies",
     "[{\"mesh\": \"a.npz\", \"sections\": [{\"file\": \"a.tfx\"}]}, {\"mesh\": \"b.obj\", "
     "\"head\": {...}, \"sections\": [...]}]",
     "up to 16 heads or bodies in place of sections and head: each with its sections and, if it "
     "has them, its own head, colliders and values of the options marked +. Hair collides with "
     "the mesh and the colliders of its own body"},
    {"gravity, wind", "{\"keys\": [{\"time\": 0, \"value\": [0, 0, 2]}, ...]}",
     "gravity or wind that changes over time, by keys or by {\"formula\": [\"2*sin(t)\", 0, 0]}; a "
     "constant value is an array of three numbers"},
    {"camera",
     "{\"keys\": [{\"time\": 0, \"eye\": [0, 1.6, 2], \"target\": [0, 1.5, 0], "
     "\"fov\": 30}, ...]}",
     "path of the camera; if no key has one of the values, the option of the same name applies"},
    {"camera", "{\"eye\": [\"1.5*sin(t)\", 0.1, \"1.5*cos(t)\"], \"fov\": \"30-5*t\"}",
     "the same by formulas; each value has keys or formulas"},
    {"colliders",
     "[{\"capsule\": [0, 1, 0, 0.08, 0, 1.4, 0, 0.05], \"frame\": \"head\"}, {\"ground\": 0}, ...]",
     "shapes that hair must not cross, with the numbers of --colliders (m); frame: head (the shape "
     "moves with the head) or world"},
    {"lights",
     "[{\"type\": \"directional\", \"direction\": [0, -1, 0], \"color\": \"#ffffff\", "
     "\"intensity\": 1}, {\"type\": \"spot\", \"position\": [0, 3, 1], \"distance\": 1, "
     "\"direction\": [0, -1, 0], \"inner\": 0, \"outer\": 45}, ...]",
     "up to 8 lights: directional, point or spot; direction is the direction in which the light "
     "travels. A point or spot light has its intensity at `distance` (m) and falls off with the "
     "square of the distance. A spot has its full intensity up to `inner` degrees off its axis and "
     "is dark beyond `outer`. `radius` (0) softens shadows and highlights: degrees as seen from "
     "the hair for directional lights, metres for others. The first light casts shadows, and so do "
     "others with \"shadow\": true (unless --shadow is none). Without this key the lights are "
     "those of --look: three (studio) or two (plain); an empty list leaves ambient light only"},
    {"$schema", "\"/usr/share/tractrix/scene.schema.json\"",
     "JSON schema with which editors complete and check the file; --help schema prints it"},
    {NULL, NULL, NULL}};

static const OptionsChapter SCENE_FILES = {
    .topic = "scene",
    .title = "Scene files",
    .text =
        "A scene file is a JSON object. Its keys are the options, with '_' in place of '-'. Values "
        "are numbers, true or false, arrays for X,Y,Z and WxH, and strings for everything else. "
        "Options marked * can be in a section, or beside the sections and then hold for all of "
        "them. Options marked + can be in a body, or beside the list of bodies and then hold for "
        "all of them. Paths are relative to the file's folder. Numbers and colors of a section can "
        "change over time: {\"keys\": [{\"time\": 0, \"value\": 0.5}, ...]}; numbers also by a "
        "formula: {\"formula\": \"0.5*exp(-t)\"}. "
        "Values between keyframes are interpolated smoothly (monotone "
        "cubic) or, with \"interpolation\": \"linear\", linearly. They are constant before the "
        "first and after the last keyframe. If a keyframe lacks a value, the value is interpolated "
        "between the keyframes that have it. Times are those of the scene: 0 at frame 0, and "
        "--speed seconds per second of video.",
    .entries = SCENE_KEYS,
};

static const char *const STATUS[][2] = {
    {"0", "done"},
    {"1", "failed while running (disk full, out of memory, ...), or --check found defects"},
    {"2", "an option or a combination of values is wrong"},
    {"3", "a hair, mesh, scene or cache file is wrong, or the cache belongs to another scene"},
    {"4", "no usable OpenGL (4.3 core or better)"},
    {"130", "interrupted"},
    {NULL, NULL}};

static const char *const EXAMPLES[] = {
    "tractrix-render hair.tfx -o hair.png",
    "tractrix-render hair.tfx --turntable --wind 2,0,0 -o hair.mp4",
    "tractrix-render scene.json --cache sim.cache",
    "tractrix-render scene.json --from-cache sim.cache --first 60 --last 119 -o frames/", NULL};

// A topic of --help that is not a list of options.
static const char *const SCHEMA_TOPIC[2] = {"schema", "JSON schema of scene files"};

// Limits of at least this size only exclude absurd numbers; the help does not show them.
static const double WIDE = 1e6;

// Writes the range and unit of a parameter, such as "0 to 90 deg"; "" if it has neither.
static void write_range(const ParamInfo *info, char *text, size_t size)
{
    static const char *const FORMS[] = {[PARAM_COLOR] = "name, #rrggbb or r,g,b",
                                        [PARAM_AUTO_COLOR] = "name, #rrggbb, r,g,b or auto",
                                        [PARAM_BACKGROUND] = "name, #rrggbb, r,g,b or transparent",
                                        [PARAM_UNIT] = "m, cm, mm, in, auto, or a number of metres",
                                        [PARAM_PATH] = ""};
    const char *between = info->unit[0] ? " " : "";
    if (FORMS[info->kind])
        snprintf(text, size, "%s", FORMS[info->kind]);
    else if (info->minimum == info->maximum)
        snprintf(text, size, "%s", info->unit);
    else if (info->maximum < WIDE)
        snprintf(text, size, "%.10g to %.10g%s%s", info->minimum, info->maximum, between,
                 info->unit);
    else if (info->minimum > -WIDE)
        snprintf(text, size, "at least %.10g%s%s", info->minimum, between, info->unit);
    else
        snprintf(text, size, "%s", info->unit);
}

// Writes the help text of a parameter, such as "* angle [0 to 90 deg; default 15]". Missing parts
// are left out.
static void write_text(const ParamInfo *info, char *text, size_t size)
{
    char range[100];
    write_range(info, range, sizeof range);
    bool on = info->kind == PARAM_BOOL && strcmp(info->default_text, "true") == 0;
    bool shown = info->default_text[0] && (info->kind != PARAM_BOOL || on);
    bool any = range[0] || shown;
    static const char *const MARKS[] = {
        [SCOPE_RUN] = "", [SCOPE_BODY] = "+ ", [SCOPE_SECTION] = "* "};
    snprintf(text, size, "%s%s%s%s%s%s%s%s", MARKS[info->scope], info->help, any ? " [" : "", range,
             range[0] && shown ? "; " : "", shown ? "default " : "",
             !shown ? ""
             : on   ? "on"
                    : info->default_text,
             any ? "]" : "");
}

// Writes the heading of a group of options, such as "Simulation: chain, hybrid".
static void write_heading(const ParamInfo *info, char *text, size_t size)
{
    size_t length =
        (size_t)snprintf(text, size, "%s%s", GROUP_TITLES[info->group], *info->owner ? ": " : "");
    for (const char *at = info->owner; *at && length + 2 < size; ++at) {
        if (*at == ' ') text[length++] = ',';
        text[length++] = *at;
        text[length] = 0;
    }
}

// Whether a word occurs in a list that is separated by bars.
static bool lists_word(const char *list, const char *word)
{
    size_t length = strlen(word);
    for (const char *at = list; (at = strstr(at, word)); at += length)
        if ((at == list || at[-1] == '|') && (!at[length] || at[length] == '|')) return true;
    return false;
}

// Writes the names of the solvers, or of all their variants, separated by bars. A variant that two
// solvers have is listed once.
static void write_solvers(char *text, size_t size, bool variants)
{
    size_t length = 0;
    for (const SolverType *const *type = SOLVER_TYPES; *type; ++type) {
        const char *const *words = variants ? (*type)->variants : &(*type)->name;
        for (int i = 0; i < (variants ? SOLVER_MAX_VARIANTS : 1) && words[i]; ++i)
            if (length < size && !lists_word(text, words[i]))
                length += (size_t)snprintf(text + length, size - length, "%s%s", length ? "|" : "",
                                           words[i]);
    }
}

static bool is_of(const char *topic, size_t option)
{
    const ParamInfo *info = &PARAM_TABLE[option];
    for (size_t i = 0; i < sizeof GROUP_TOPICS / sizeof *GROUP_TOPICS; ++i)
        if (strcmp(GROUP_TOPICS[i].topic[0], topic) == 0)
            return GROUP_TOPICS[i].group == info->group;
    return *info->owner && params_owned_by(info, topic);
}

// The generated strings that help rows point to.
typedef struct Texts {
    char help[SCENE_PARAMS][TEXT_SIZE], heading[SCENE_PARAMS][80], solvers[2][TEXT_SIZE];
    char colors_text[COLOR_NAME_COUNT][32];
    Option options[SCENE_PARAMS];
    const char *headings[SCENE_PARAMS], *topics[MOST_TOPICS][2], *colors[COLOR_NAME_COUNT + 1][3];
} Texts;

// Writes the meaning of a colour name. If the name means another colour for hair, both are shown.
static void write_color(const char *entry[3], char meaning[32], const ColorName *color)
{
    snprintf(meaning, 32, color->css && color->hair ? "%s, of hair %s" : "%s",
             color->css ? color->css : color->hair, color->hair);
    entry[0] = color->name, entry[1] = meaning, entry[2] = "";
}

static void make_texts(Texts *texts)
{
    size_t count = 0;
    write_solvers(texts->solvers[0], TEXT_SIZE, false);
    write_solvers(texts->solvers[1], TEXT_SIZE, true);
    for (size_t i = 0; i < PARAM_COUNT; ++i) {
        const ParamInfo *info = &PARAM_TABLE[i];
        texts->options[i] = OPTIONS_OF_PARAMS[i];
        texts->options[i].help = texts->help[i];
        texts->headings[i] = texts->heading[i];
        write_text(info, texts->help[i], TEXT_SIZE);
        write_heading(info, texts->heading[i], sizeof texts->heading[i]);
        if (strcmp(info->name, "algo") == 0) texts->options[i].value = texts->solvers[0];
        if (strcmp(info->name, "variant") == 0) texts->options[i].value = texts->solvers[1];
    }
    for (size_t i = 0; i < COLOR_NAME_COUNT; ++i)
        write_color(texts->colors[i], texts->colors_text[i], &COLOR_NAMES[i]);
    for (; count < sizeof GROUP_TOPICS / sizeof *GROUP_TOPICS; ++count)
        memcpy(texts->topics[count], GROUP_TOPICS[count].topic, sizeof texts->topics[count]);
    memcpy(texts->topics[count++], SCHEMA_TOPIC, sizeof SCHEMA_TOPIC);
    for (const SolverType *const *type = SOLVER_TYPES; *type; ++type) {
        bool any = false;
        for (size_t i = 0; i < PARAM_COUNT; ++i) any = any || is_of((*type)->name, i);
        if (!any || count + 1 == MOST_TOPICS) continue;
        texts->topics[count++][0] = (*type)->name;
    }
}

static Result write_schema(FILE *stream, Error *error)
{
    SchemaSolver solvers[MOST_TOPICS] = {{NULL, NULL}};
    for (size_t i = 0; SOLVER_TYPES[i] && i + 1 < MOST_TOPICS; ++i)
        solvers[i] = (SchemaSolver){SOLVER_TYPES[i]->name, SOLVER_TYPES[i]->variants};
    return scene_schema_write(solvers, SCENE_KEYS, stream, error);
}

Result render_help(const char *topic, FILE *stream, Error *error)
{
    if (topic && strcmp(topic, SCHEMA_TOPIC[0]) == 0) return write_schema(stream, error);
    Texts *texts = calloc(1, sizeof *texts);
    if (!texts) return error_set(error, RESULT_FAILED, "no memory for the help");
    make_texts(texts);
    const OptionsChapter colors = {
        .topic = "colors",
        .title = "Colors",
        .text =
            "Every option and key that takes a color also takes one of these names. They stand "
            "for the sRGB values beside them. If a name has two values, --color and --tip-color "
            "use the second one, the visible color of a whole head of such hair; all others, "
            "--transmission among them, use the first one, the color of CSS.",
        .entries = (const char *const(*)[3])texts->colors,
    };
    const OptionsProgram program = {
        .name = "tractrix-render",
        .summary = "simulate and render hair, without a window",
        .description = DESCRIPTION,
        .synopsis = "[OPTION]... HAIR_FILE...\n[OPTION]... SCENE.json",
        .options = texts->options,
        .option_count = PARAM_COUNT,
        .headings = texts->headings,
        .brief = BRIEF,
        .topics = (const char *const(*)[2])texts->topics,
        .is_of = is_of,
        .chapters = (const OptionsChapter *const[]){&SCENE_FILES, &colors, NULL},
        .notes = NOTES,
        .status = STATUS,
        .examples = EXAMPLES,
    };
    Result result = options_help(&program, topic, stream, error);
    free(texts);
    return result;
}
