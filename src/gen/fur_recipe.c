// SPDX-License-Identifier: MIT
#include "gen/fur_recipe.h"

#include <math.h>
#include <stddef.h>
#include <stdint.h>

FurRecipe fur_recipe_default(void)
{
    return (FurRecipe){.seed = 1,
                       .count = 4000,
                       .vertices = 16,
                       .root_lift = 1e-4,
                       .length = 0.03,
                       .length_variation = 0.3,
                       .lift_deg = 45.0,
                       .gravity_bend = 10.0,
                       .noise_size = 0.02,
                       .clump_profile = 0.5,
                       .curl_frequency = 40.0,
                       .curl_disorder = 0.2,
                       .frizz_frequency = 60.0,
                       .tip_thickness = 0.3};
}

Result fur_recipe_check(const FurRecipe *recipe, Error *error)
{
    double turns = recipe->curl_frequency * recipe->length;
    if (recipe->curl_radius > 0.0 && recipe->vertices - 1 < 4.0 * turns)
        return error_set(error, RESULT_USAGE,
                         "--vertices: got %d, expected at least %.0f: 4 for each of the %g turns "
                         "of curls over %g m",
                         recipe->vertices, ceil(4.0 * turns) + 1.0, turns, recipe->length);
    if (recipe->clumps > 0 && recipe->guides > 0 && recipe->clumps > recipe->guides)
        return error_set(error, RESULT_USAGE,
                         "--clumps: got %d, expected at most %d, the number of --guides",
                         recipe->clumps, recipe->guides);
    if ((recipe->clump > 0.0 || recipe->clump_root > 0.0) && !recipe->guides && !recipe->clumps)
        return error_set(
            error, RESULT_USAGE,
            "--clump and --clump-root: have no effect: expected --guides or --clumps with them");
    if (recipe->count > 0 && (uint64_t)recipe->count * (uint64_t)recipe->vertices > 1u << 30)
        return error_set(error, RESULT_USAGE,
                         "%d strands of %d vertices: expected at most 2^30 vertices in all",
                         recipe->count, recipe->vertices);
    return RESULT_OK;
}

// --- The command line.

// Options that were not given are 0 or NULL.
typedef struct Command {
    FurRecipe recipe;
    GenOutput output;
    double unit;
    int up;
} Command;

#define AT(member)         offsetof(Command, recipe.member)
#define AT_COMMAND(member) offsetof(Command, member)

static const Option OPTIONS[] = {
    GEN_OPTION_OUTPUT(AT_COMMAND(output.path)),
    GEN_OPTION_FORMAT(AT_COMMAND(output.format)),
    {"unit", 0, OPTION_REAL, AT_COMMAND(unit), "M", 1e-6, 1e6,
     "metres per unit of the mesh [default: as the file says, otherwise 1]"},
    {"up", 0, OPTION_WORD, AT_COMMAND(up), "y|z", 0, 0,
     "axis of the mesh that points up [default y]"},
    GEN_OPTION_SEED(AT(seed)),
    GEN_OPTION_QUIET(AT_COMMAND(output.quiet)),
    // Roots.
    {"count", 'n', OPTION_WHOLE, AT(count), "N", 1, 2e6, "number of strands [default 4000]"},
    {"per-cm2", 0, OPTION_REAL, AT(per_cm2), "N", 1e-6, 1e6,
     "strands per square centimetre where the density is 1, instead of --count"},
    {"density", 0, OPTION_STRING, AT(density), "MAP", 0, 0,
     "relative density of hair at each place; 0: no hair"},
    {"root-lift", 0, OPTION_REAL, AT(root_lift), "M", 1e-6, 1,
     "height of roots above the surface; no other vertex comes nearer to the surface [default "
     "0.0001]"},
    {"vertices", 0, OPTION_WHOLE, AT(vertices), "N", 2, 1024, "vertices per strand [default 16]"},
    // Form.
    {"length", 0, OPTION_REAL, AT(length), "M", 1e-4, 100,
     "length of the longest strand [default 0.03]"},
    {"length-variation", 0, OPTION_REAL, AT(length_variation), "SHARE", 0, 0.99,
     "each strand is shortened by a random share of its length; this is the largest share [default "
     "0.3]"},
    {"length-map", 0, OPTION_STRING, AT(length_map), "MAP", 0, 0,
     "factor of --length at each place, 0 to 1"},
    {"comb", 0, OPTION_STRING, AT(comb), "X,Y,Z|PNG", 0, 0,
     "direction in which hair is combed: three numbers or formulas, a vector of which only the "
     "part along the surface counts; or an image: red is the direction along u, green along v"},
    {"lift", 0, OPTION_REAL, AT(lift_deg), "DEG", 0, 90,
     "angle between hair and surface at the root [default 45]"},
    {"lie", 0, OPTION_REAL, AT(lie), "M", 0, 100,
     "distance along the strand over which hair turns into the direction of --comb and down onto "
     "the surface; 0: the comb acts only at the root [default 0]"},
    {"comb-reach", 0, OPTION_REAL, AT(comb_reach), "M", 0, 100,
     "length of the strand, from the root, on which --lie acts; 0: the whole strand [default 0]"},
    {"gravity-bend", 0, OPTION_REAL, AT(gravity_bend), "RAD/M", 0, 10000,
     "how much hair bends down by its weight where it is horizontal [default 10]"},
    {"volume", 0, OPTION_REAL, AT(volume), "M", 0, 1,
     "height above the surface that hair keeps, except near its root [default 0]"},
    {"noise", 0, OPTION_REAL, AT(noise), "X", 0, 10,
     "random bends along the strands, nearly the same for neighbours: 0.3 slight, 1 strong "
     "[default 0]"},
    {"noise-size", 0, OPTION_REAL, AT(noise_size), "M", 1e-4, 10,
     "distance over which the bends of --noise change; a smaller distance also bends hair more "
     "sharply [default 0.02]"},
    {"scatter", 0, OPTION_REAL, AT(scatter), "X", 0, 10,
     "how much the directions of the strands at the root differ at random [default 0]"},
    // Guides.
    {"guides", 0, OPTION_WHOLE, AT(guides), "N", 1, 2e6,
     "grow this many strands over the surface and interpolate the others between them: faster and "
     "smoother [default: all strands are grown]"},
    {"clumps", 0, OPTION_WHOLE, AT(clumps), "N", 1, 2e6,
     "number of clumps, each around a guide [default: one for every guide]"},
    {"clump", 0, OPTION_REAL, AT(clump), "SHARE", 0, 1,
     "how far tips are pulled to the guide of their clump, as a share of the distance "
     "[default 0]"},
    {"clump-root", 0, OPTION_REAL, AT(clump_root), "SHARE", 0, 1,
     "how far roots are pulled to the guide of their clump, as a share of the distance [default "
     "0]"},
    {"clump-profile", 0, OPTION_REAL, AT(clump_profile), "X", 0.01, 0.99,
     "where the strands of a clump come together: below 0.5 near the tip, above near the root "
     "[default 0.5]"},
    // Curls, disorder.
    {"curl-radius", 0, OPTION_REAL, AT(curl_radius), "M", 0, 1, "radius of curls [default 0]"},
    {"curl-frequency", 0, OPTION_REAL, AT(curl_frequency), "N", 0.01, 100000,
     "turns of curls per metre [default 40]"},
    {"curl-disorder", 0, OPTION_REAL, AT(curl_disorder), "SHARE", 0, 1,
     "0: the strands of a clump curl side by side; 1: each begins its curl at a random angle "
     "[default 0.2]"},
    {"frizz", 0, OPTION_REAL, AT(frizz), "M", 0, 1,
     "size of small waves at the tip, different for each strand [default 0]"},
    {"frizz-frequency", 0, OPTION_REAL, AT(frizz_frequency), "N", 0.01, 100000,
     "waves of --frizz per metre [default 60]"},
    {"flyaways", 0, OPTION_REAL, AT(flyaways), "SHARE", 0, 1,
     "share of strands that stick out: they hardly clump and have three times the frizz [default "
     "0]"},
    // Other.
    {"followers", 0, OPTION_WHOLE, AT(followers), "N", 1, 1000,
     "followers that the renderer adds to each strand; only some formats store this"},
    {"thickness", 0, OPTION_REAL, AT(thickness), "M", 1e-7, 1,
     "thickness of hair at the root; only some formats store this"},
    {"tip-thickness", 0, OPTION_REAL, AT(tip_thickness), "SHARE", 0, 1,
     "thickness at the tip, as a share of that at the root [default 0.3]"},
};

static const char *const NOTES[] = {
    "Lengths are in metres. M stands for a length. MAP stands for a number, a PNG file or a "
    "formula; the value of a file or formula can differ from place to place. A PNG file is placed "
    "by the mesh's texture coordinates; black is 0, white is 1.",
    "A formula may use the position x, y, z, the normal nx, ny, nz, the texture coordinates u, v, "
    "the operators + - * / ^, comparisons, a ? b : c, and the functions of muParser (sqrt, abs, "
    "min, max, sin ...). smoothstep(a, b, x) rises from 0 at x = a to 1 at x = b. noise(x, y, z) "
    "is a random number between -1 and 1 that changes smoothly over distances of 1, so "
    "noise(x/0.03, y/0.03, z/0.03) changes over 3 cm.",
    "Hair that would grow through the mesh is bent out of it. Where two parts of the mesh overlap, "
    "roots of one may lie inside the other: give these places a --density of 0.",
    "The same seed gives the same bytes on every machine, if formulas use only the functions "
    "smoothstep, noise, sqrt, abs, min and max.",
    NULL};

static const char *const STATUS[][2] = {
    {"0", "done"},          {"1", "failed: disk full, no memory, ..."},
    {"2", "wrong usage"},   {"3", "the mesh or a map can't be read"},
    {"130", "interrupted"}, {NULL, NULL}};

static const char *const EXAMPLES[] = {
    "tractrix-gen fur ball.obj --comb 0,-1,0 --count 20000 -o fur.tfx",
    "tractrix-gen fur head.obj --density scalp.png --comb 0,-0.3,-1 --lie 0.02 --length 0.25 "
    "--guides 400 --clump 0.6 -o hair.tfx",
    NULL};

const OptionsProgram FUR_RECIPE_PROGRAM = {
    .name = "tractrix-gen",
    .page = "tractrix-gen-fur",
    .summary = "grow fur or hair on a mesh",
    .synopsis = "fur [OPTION]... MESH.obj -o FILE",
    .description = "Grows fur or hair on a mesh (Wavefront OBJ): evenly spread strands, combed and "
                   "bent by their weight, with clumps and curls.",
    .options = OPTIONS,
    .option_count = sizeof OPTIONS / sizeof *OPTIONS,
    .notes = NOTES,
    .status = STATUS,
    .examples = EXAMPLES,
};

// Refuses an option whose values the output format cannot store.
static Result check_holds(const Command *command, const char *option, uint32_t features,
                          Error *error)
{
    char words[200];
    if (!(features & ~FORMAT_TABLE[command->output.format]->features)) return RESULT_OK;
    format_list_holding(features, words, sizeof words);
    return error_set(error, RESULT_USAGE,
                     "--%s: the format of the output cannot store it: expected --format %s", option,
                     words);
}

static Result check(const Command *command, Error *error)
{
    if (command->recipe.followers > 0)
        TRY(check_holds(command, "followers", STRANDS_HAS_FOLLOWERS, error));
    if (command->recipe.thickness > 0.0)
        TRY(check_holds(command, "thickness", STRANDS_HAS_VERTEX_THICKNESS, error));
    return fur_recipe_check(&command->recipe, error);
}

Result fur_recipe_parse(FurOptions *options, int argc, char **argv, bool *done, Error *error)
{
    Command command = {.recipe = fur_recipe_default(), .output.format = -1, .unit = 0};
    int first;
    Result result = options_parse(&FUR_RECIPE_PROGRAM, &command, argc, argv, &first, done, error);
    if (result != RESULT_OK || *done) return result;
    if (argc - first != 1)
        return error_set(error, RESULT_USAGE, "fur: got %d files, expected one mesh", argc - first);
    TRY(gen_choose_format(&command.output, error));
    *options = (FurOptions){.recipe = command.recipe,
                            .output = command.output,
                            .mesh = argv[first],
                            .unit = command.unit,
                            .up_z = command.up == 1};
    return check(&command, error);
}
