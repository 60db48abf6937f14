// SPDX-License-Identifier: MIT
// Goldens by platform: a golden is searched for in the current platform's own folder, then in that
// of its class, then among those for all platforms. Each level has its own limits, because less
// similar drivers round more differently.
#pragma once

#include "base/error.h"
#include "image/compare.h"

#include <stdbool.h>

typedef enum Level {
    LEVEL_NONE,     // goldens are not stored by platform
    LEVEL_PLATFORM, // GOLDENS/llvmpipe-mesa22.3-llvm15-256-fma-x86_64/
    LEVEL_CLASS,    // GOLDENS/cpu/
    LEVEL_COMMON,   // GOLDENS/
    LEVELS
} Level;

extern const char *const LEVEL_NAMES[LEVELS]; // "", "platform", "class", "common"

// "cpu", "nvidia", "amd", "intel", or "gpu" for others, by the start of the platform's name.
const char *level_class(const char *platform);

// Whether tractrix-render --platform may print this name: neither a path nor a class.
bool level_is_platform(const char *name);

// Whether a subfolder of GOLDENS with this name has the goldens of a class or of a platform: its
// name is that of a class, or begins like a platform's.
bool level_has_folder(const char *name);

// The folder's name in GOLDENS; "": GOLDENS itself.
const char *level_folder(Level level, const char *platform);

// Whether goldens of the level apply to the platform. Those for all platforms apply to CPUs only,
// unless `any` is set.
bool level_counts(Level level, const char *platform, bool any);

// The level where a new golden is stored: for all platforms by CPUs, in the class by GPUs.
Level level_of_new(const char *platform);

// The default limits: equal images for the platform, else those of the table in levels.c.
void level_set_limits(CompareLimits *limits, Level level);
