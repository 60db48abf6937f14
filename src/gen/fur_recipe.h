// SPDX-License-Identifier: MIT
// The parameters of fur, and the command line of tractrix-gen fur.
#pragma once

#include "gen/gen_output.h"

typedef struct FurRecipe {
    int seed;
    // Roots.
    int count;           // number of strands; 0: by per_cm2
    double per_cm2;      // strands per square centimetre where the density is 1
    int vertices;        // per strand, 2 .. 1024
    const char *density; // a map (fur_map.h) of the share of strands; NULL: uniform
    double root_lift;    // m: height of roots above the surface
    // Form.
    double length;           // m: of the longest strand
    double length_variation; // 0 .. 1: strands are randomly shorter by up to this share
    const char *length_map;  // a map of factors, clamped to 0 .. 1; NULL: 1
    const char *comb;        // a comb (fur_map.h); NULL: hair stands upright
    double lift_deg;         // angle between combed hair and surface at the root, 0 .. 90
    double lie;              // m: the length over which hair takes the combed direction; 0: never
    double comb_reach;       // m: combed up to this distance from the root; 0: everywhere
    double gravity_bend;     // rad/m: how fast level hair turns down
    double volume;           // m: distance of hair from the surface, far from its root
    double noise;            // how much guides stray, relative to the comb
    double noise_size;       // m: size of regions that stray together
    double scatter;          // how much single strands stray at the root
    // Guides.
    int guides;           // number of grown strands; the others lie between them. 0: all are grown
    int clumps;           // number of guides around which strands gather; 0: all guides
    double clump;         // 0 .. 1: how close to their guide the tips are
    double clump_root;    // 0 .. 1: how close the roots are
    double clump_profile; // 0.01 .. 0.99: where strands gather; 0.5: evenly, less: towards the tip
    // Curls.
    double curl_radius;    // m
    double curl_frequency; // turns per metre
    double curl_disorder;  // 0: the curls of a clump are in phase, 1: independent
    // Disorder.
    double frizz;           // m: amplitude at the tip
    double frizz_frequency; // waves per metre
    double flyaways;        // share of strands outside clumps, with more frizz
    // Written in addition to the strands.
    int followers;        // number that the renderer draws for each strand
    double thickness;     // m: of the hair at the root; 0: not written
    double tip_thickness; // ratio of the tip's thickness
} FurRecipe;

// The text of `tractrix-gen fur --help`.
extern const OptionsProgram FUR_RECIPE_PROGRAM;

// Short upright fur.
FurRecipe fur_recipe_default(void);

// RESULT_USAGE for an invalid combination; single values must be in range.
Result fur_recipe_check(const FurRecipe *recipe, Error *error);

typedef struct FurOptions {
    FurRecipe recipe;
    GenOutput output;
    const char *mesh;
    double unit; // metres per unit of the mesh's file; 0: as it says, otherwise 1
    bool up_z;
} FurOptions;

// argv[0] is the word fur. Errors of options_parse, and RESULT_USAGE for an invalid combination.
// The path of the output may be missing (NULL).
Result fur_recipe_parse(FurOptions *options, int argc, char **argv, bool *done, Error *error);
