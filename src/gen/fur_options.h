// SPDX-License-Identifier: MIT
// The command line of tractrix-gen fur.
#pragma once

#include "gen/fur_recipe.h"
#include "gen/gen_output.h"

#include <stdbool.h>

typedef struct FurOptions {
    FurRecipe recipe;
    GenOutput output;
    const char *mesh;
    double unit; // metres per unit of the mesh's file
    bool up_z;
} FurOptions;

// argv[0] is the word fur. Errors as options_parse gives them, and for what does not go together.
Result fur_options_read(FurOptions *options, int argc, char **argv, bool *done, Error *error);
