// SPDX-License-Identifier: MIT
// What fur is grown by, and the command line of tractrix-gen fur.
#pragma once

#include "gen/gen_output.h"

typedef struct FurRecipe {
    int seed;
    // Roots.
    int count;           // strands; 0: by per_cm2
    double per_cm2;      // strands on a square centimetre where the density is 1
    int vertices;        // per strand, 2 .. 1024
    const char *density; // a map (fur_map.h) of the share of strands; NULL: even
    double root_lift;    // m: roots lie so far over the surface
    // Form.
    double length;           // m: of the longest strand
    double length_variation; // 0 .. 1: strands are up to this share shorter, at random
    const char *length_map;  // a map of factors, cut to 0 .. 1; NULL: 1
    const char *comb;        // a comb (fur_map.h); NULL: hair stands up
    double lift_deg;         // between hair and surface at the root where it is combed, 0 .. 90
    double lie;              // m: over about so much hair comes to lie as it is combed; 0: never
    double comb_reach;       // m: so far from the root the comb reaches; 0: all along
    double gravity_bend;     // rad/m: how fast hair that is level turns down
    double volume;           // m: so far hair keeps off the surface, far from its root
    double noise;            // how much guides stray, as a share of the comb
    double noise_size;       // m: of what strays together
    double scatter;          // how much strands stray at the root, for themselves
    // Guides.
    int guides;           // strands that are grown; the others lie between them. 0: all are
    int clumps;           // guides that strands gather around; 0: all guides
    double clump;         // 0 .. 1: how close to their guide the tips are
    double clump_root;    // 0 .. 1: and the roots
    double clump_profile; // 0.01 .. 0.99: where strands gather; 0.5 evenly, less: towards the tip
    // Curls.
    double curl_radius;    // m
    double curl_frequency; // turns a metre
    double curl_disorder;  // 0: those of a clump wind in step, 1: each for itself
    // Disorder.
    double frizz;           // m: at the tip
    double frizz_frequency; // waves a metre
    double flyaways;        // share of strands that join no clump and have more frizz
    // What is written besides.
    int followers;        // that the renderer draws for each strand
    double thickness;     // m: of the hair at the root; 0: none is written
    double tip_thickness; // share of it at the tip
} FurRecipe;

// What `tractrix-gen fur --help` says.
extern const OptionsProgram FUR_RECIPE_PROGRAM;

// Short fur that stands off.
FurRecipe fur_recipe_default(void);

// RESULT_USAGE for what does not go together; single values are in range.
Result fur_recipe_check(const FurRecipe *recipe, Error *error);

typedef struct FurOptions {
    FurRecipe recipe;
    GenOutput output;
    const char *mesh;
    double unit; // metres per unit of the mesh's file
    bool up_z;
} FurOptions;

// argv[0] is the word fur. Errors as options_parse gives them, and for what does not go together.
Result fur_recipe_parse(FurOptions *options, int argc, char **argv, bool *done, Error *error);
