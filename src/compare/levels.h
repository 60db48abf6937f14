// SPDX-License-Identifier: MIT
// Goldens by platform: for what draws here they are sought in the platform's own folder, then in
// that of its class, then among those of all. Each level has its limits, as drivers that are
// farther apart round more differently.
#pragma once

#include "base/error.h"
#include "image/compare.h"

#include <stdbool.h>

typedef enum Level {
    LEVEL_NONE,     // goldens are not kept by platform
    LEVEL_PLATFORM, // GOLDENS/llvmpipe-mesa22.3-llvm15-256-fma-x86_64/
    LEVEL_CLASS,    // GOLDENS/cpu/
    LEVEL_COMMON,   // GOLDENS/
    LEVELS
} Level;

extern const char *const LEVEL_NAMES[LEVELS]; // "", "platform", "class", "common"

// "cpu", "nvidia", "amd", "intel", or "gpu" for others: by how the platform's name begins.
const char *level_class(const char *platform);

// Whether the name is one that tractrix-render --platform may print: no path, and not a class.
bool level_is_platform(const char *name);

// The folder's name below GOLDENS; "": GOLDENS itself.
const char *level_folder(Level level, const char *platform);

// Whether goldens of the level count. Those of all platforms are a CPU's, as a rule: a GPU has them
// only if `any` says so.
bool level_counts(Level level, const char *platform, bool any);

// Where a golden goes that no level has: to all for CPUs, to the class for GPUs.
Level level_of_new(const char *platform);

// The limits unless others are given: equal images; 2 levels, 0.5 %; 8 levels, 2 %.
void level_set_limits(CompareLimits *limits, Level level);
