// SPDX-License-Identifier: MIT
#include "gen/fur_options.h"

// 0 or NULL: not given, where the recipe takes that for something else.
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
     "metres per unit of the mesh [default 1]"},
    {"up", 0, OPTION_WORD, AT_COMMAND(up), "y|z", 0, 0, "axis of the mesh that is up [default y]"},
    GEN_OPTION_SEED(AT(seed)),
    GEN_OPTION_QUIET(AT_COMMAND(output.quiet)),
    // Roots.
    {"count", 'n', OPTION_WHOLE, AT(count), "N", 1, 2e6, "strands [default 4000]"},
    {"per-cm2", 0, OPTION_REAL, AT(per_cm2), "N", 1e-6, 1e6,
     "strands on a square centimetre where the density is 1, instead of --count"},
    {"density", 0, OPTION_STRING, AT(density), "MAP", 0, 0, "how dense they stand, 0: none"},
    {"root-lift", 0, OPTION_REAL, AT(root_lift), "M", 1e-6, 1,
     "how far roots lie over the surface, and all other vertices at least [default 0.0001]"},
    {"vertices", 0, OPTION_WHOLE, AT(vertices), "N", 2, 1024, "per strand [default 16]"},
    // Form.
    {"length", 0, OPTION_REAL, AT(length), "M", 1e-4, 100, "of the longest strand [default 0.03]"},
    {"length-variation", 0, OPTION_REAL, AT(length_variation), "SHARE", 0, 0.99,
     "strands are up to this share shorter, each by chance [default 0.3]"},
    {"length-map", 0, OPTION_STRING, AT(length_map), "MAP", 0, 0, "factor of the length, 0 to 1"},
    {"comb", 0, OPTION_STRING, AT(comb), "X,Y,Z|PNG", 0, 0,
     "direction, each coordinate a number or a formula; projected onto the surface. Of a picture "
     "red is the way along u, green along v"},
    {"lift", 0, OPTION_REAL, AT(lift_deg), "DEG", 0, 90,
     "angle between combed hair and the surface at the root [default 45]"},
    {"lie", 0, OPTION_REAL, AT(lie), "M", 0, 100,
     "over about so much of its length hair comes to lie down, as it is combed where it is; 0: it "
     "keeps its direction [default 0]"},
    {"comb-reach", 0, OPTION_REAL, AT(comb_reach), "M", 0, 100,
     "how far from the root --lie holds; 0: all along [default 0]"},
    {"gravity-bend", 0, OPTION_REAL, AT(gravity_bend), "RAD/M", 0, 10000,
     "how much hair that is level turns down on its way [default 10]"},
    {"volume", 0, OPTION_REAL, AT(volume), "M", 0, 1,
     "how far hair keeps off the surface, far from its root [default 0]"},
    {"noise", 0, OPTION_REAL, AT(noise), "X", 0, 10,
     "how much hair strays on its way, neighbours together: 0.3 is a little, 1 much [default 0]"},
    {"noise-size", 0, OPTION_REAL, AT(noise_size), "M", 1e-4, 10,
     "of what strays together [default 0.02]"},
    {"scatter", 0, OPTION_REAL, AT(scatter), "X", 0, 10,
     "how much strands stray at the root, each by itself [default 0]"},
    // Guides.
    {"guides", 0, OPTION_WHOLE, AT(guides), "N", 1, 2e6,
     "strands that are grown so; the others are laid between them, quicker and smoother. Without "
     "it all are"},
    {"clumps", 0, OPTION_WHOLE, AT(clumps), "N", 1, 2e6,
     "guides that the others gather around [default: all]"},
    {"clump", 0, OPTION_REAL, AT(clump), "SHARE", 0, 1,
     "of the way to their guide that tips are drawn [default 0]"},
    {"clump-root", 0, OPTION_REAL, AT(clump_root), "SHARE", 0, 1, "the same of roots [default 0]"},
    {"clump-profile", 0, OPTION_REAL, AT(clump_profile), "X", 0.01, 0.99,
     "where between root and tip they come together: less than 0.5 late, more early [default 0.5]"},
    // Curls, disorder.
    {"curl-radius", 0, OPTION_REAL, AT(curl_radius), "M", 0, 1, "of curls [default 0]"},
    {"curl-frequency", 0, OPTION_REAL, AT(curl_frequency), "N", 0.01, 100000,
     "turns of curls on a metre [default 40]"},
    {"curl-disorder", 0, OPTION_REAL, AT(curl_disorder), "SHARE", 0, 1,
     "0: a clump winds in step, 1: each strand begins anywhere [default 0.2]"},
    {"frizz", 0, OPTION_REAL, AT(frizz), "M", 0, 1,
     "how far each strand waves for itself, at the tip [default 0]"},
    {"frizz-frequency", 0, OPTION_REAL, AT(frizz_frequency), "N", 0.01, 100000,
     "such waves on a metre [default 60]"},
    {"flyaways", 0, OPTION_REAL, AT(flyaways), "SHARE", 0, 1,
     "of the strands that hardly clump and have three times as much frizz [default 0]"},
    // Besides.
    {"followers", 0, OPTION_WHOLE, AT(followers), "N", 1, 1000,
     "that the file asks the renderer to draw with each strand, where the format holds it"},
    {"thickness", 0, OPTION_REAL, AT(thickness), "M", 1e-7, 1,
     "of hair at the root, written by vertex, where the format holds it"},
    {"tip-thickness", 0, OPTION_REAL, AT(tip_thickness), "SHARE", 0, 1,
     "of that at the tip [default 0.3]"},
};

static const char *const NOTES[] = {
    "Lengths are metres. A MAP is a number, a PNG that lies on the mesh by its texture coordinates "
    "(black 0, white 1, grey as its level says), or a formula of the place x, y, z, the normal nx, "
    "ny, nz and the texture coordinates u, v: + - * / ^, comparisons, a ? b : c, the functions of "
    "muParser (sqrt, abs, min, max, sin ...), smoothstep(a, b, x) and noise(x, y, z), which is "
    "between -1 and 1 and changes over distances of 1.",
    "Hair does not grow through the mesh: what would is bent out. Where parts of the mesh overlap, "
    "give the part that hair grows on a density, else roots lie inside the other part.",
    "One seed gives the same bytes on every machine, if formulas use none of muParser's functions "
    "but sqrt, abs, min and max.",
    NULL};

static const char *const STATUS[][2] = {{"0", "done"},
                                        {"1", "failed: disk full, no memory, ..."},
                                        {"2", "wrong usage"},
                                        {"3", "the mesh or a map can't be read"},
                                        {NULL, NULL}};

static const char *const EXAMPLES[] = {
    "tractrix-gen fur ball.obj --comb 0,-1,0 --count 20000 -o fur.tfx",
    "tractrix-gen fur head.obj --density scalp.png --comb 0,-0.3,-1 --lie 0.02 --length 0.25 "
    "--guides 400 --clump 0.6 -o hair.tfx",
    NULL};

static const OptionsProgram PROGRAM = {
    .name = "tractrix-gen",
    .page = "tractrix-gen-fur",
    .summary = "grow fur or hair on a mesh",
    .synopsis = "fur [OPTION]... MESH.obj -o FILE",
    .description = "Grows fur or hair on a mesh (Wavefront OBJ): strands spread evenly, combed, "
                   "bent by their weight, in clumps and curls.",
    .options = OPTIONS,
    .option_count = sizeof OPTIONS / sizeof *OPTIONS,
    .notes = NOTES,
    .status = STATUS,
    .examples = EXAMPLES,
};

// An option whose values only some formats hold.
static Result check_holds(const Command *command, const char *option, uint32_t features,
                          Error *error)
{
    char words[200];
    if (!(features & ~FORMAT_TABLE[command->output.format]->features)) return RESULT_OK;
    format_list_holding(features, words, sizeof words);
    return error_set(error, RESULT_USAGE, "--%s needs --format %s", option, words);
}

static Result check(const Command *command, Error *error)
{
    if (!command->output.path)
        return error_set(error, RESULT_USAGE, "nothing to write: expected -o FILE");
    if (command->recipe.followers > 0)
        TRY(check_holds(command, "followers", STRANDS_HAS_FOLLOWERS, error));
    if (command->recipe.thickness > 0.0)
        TRY(check_holds(command, "thickness", STRANDS_HAS_VERTEX_THICKNESS, error));
    return fur_recipe_check(&command->recipe, error);
}

Result fur_options_read(FurOptions *options, int argc, char **argv, bool *done, Error *error)
{
    Command command = {.recipe = fur_recipe_default(), .output.format = FORMAT_TFX4, .unit = 1.0};
    int first;
    Result result = options_parse(&PROGRAM, &command, argc, argv, &first, done, error);
    if (result != RESULT_OK || *done) return result;
    if (argc - first != 1)
        return error_set(error, RESULT_USAGE, "fur: expected one mesh, got %d", argc - first);
    *options = (FurOptions){.recipe = command.recipe,
                            .output = command.output,
                            .mesh = argv[first],
                            .unit = command.unit,
                            .up_z = command.up == 1};
    return check(&command, error);
}
