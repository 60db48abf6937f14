// SPDX-License-Identifier: MIT
#include "compare/levels.h"

#include <string.h>

const char *const LEVEL_NAMES[LEVELS] = {"", "platform", "class", "common"};

// The beginning of a platform's name (gpu/platform.h), and the class of the platform.
static const char *const CLASSES[][2] = {
    {"llvmpipe", "cpu"},  {"softpipe", "cpu"}, {"swrast", "cpu"}, {"swiftshader", "cpu"},
    {"lavapipe", "cpu"},  {"swr", "cpu"},      {"amd", "amd"},    {"intel", "intel"},
    {"nvidia", "nvidia"}, {"gpu", "gpu"},
};
enum { CLASS_COUNT = sizeof CLASSES / sizeof *CLASSES };

const char *level_class(const char *platform)
{
    size_t length = strcspn(platform, "-");
    for (int i = 0; i < CLASS_COUNT; ++i)
        if (strlen(CLASSES[i][0]) == length && strncmp(platform, CLASSES[i][0], length) == 0)
            return CLASSES[i][1];
    return "gpu";
}

bool level_is_platform(const char *name)
{
    for (int i = 0; i < CLASS_COUNT; ++i)
        if (strcmp(name, CLASSES[i][1]) == 0) return false;
    return *name && *name != '.' && *name != '-' &&
           strspn(name, "abcdefghijklmnopqrstuvwxyz0123456789._-") == strlen(name);
}

bool level_has_folder(const char *name)
{
    size_t length = strcspn(name, "-");
    for (int i = 0; i < CLASS_COUNT; ++i) {
        bool begins = strlen(CLASSES[i][0]) == length && strncmp(name, CLASSES[i][0], length) == 0;
        if ((begins && name[length] == '-') || strcmp(name, CLASSES[i][1]) == 0) return true;
    }
    return false;
}

const char *level_folder(Level level, const char *platform)
{
    if (level == LEVEL_PLATFORM) return platform;
    return level == LEVEL_CLASS ? level_class(platform) : "";
}

static bool is_cpu(const char *platform)
{
    return strcmp(level_class(platform), "cpu") == 0;
}

bool level_counts(Level level, const char *platform, bool any)
{
    return level != LEVEL_COMMON || any || is_cpu(platform);
}

Level level_of_new(const char *platform)
{
    return is_cpu(platform) ? LEVEL_COMMON : LEVEL_CLASS;
}

// Drivers and processors round differently. scripts/compare-regressions measures by how much: with
// llvmpipe's vectors of 128 and 256 bits, with and without FMA, and with zink on lavapipe, images
// reach at most 60 % of the limits of the class and 45 % of those for all platforms
// (docs/compare.md#what-the-limits-catch).
static const struct {
    double tolerance, percent, difference, local, flip;
} LIMITS[LEVELS] = {
    [LEVEL_CLASS] = {2, 0.1, 48, 0.4, 0.001},
    [LEVEL_COMMON] = {8, 0.2, 64, 0.5, 0.002},
};

void level_set_limits(CompareLimits *limits, Level level)
{
    bool loose = level == LEVEL_CLASS || level == LEVEL_COMMON;
    limits->pixels_matter = true;
    limits->pixel_tolerance = LIMITS[level].tolerance;
    limits->max_failing = LIMITS[level].percent;
    limits->max_failing_percent = loose;
    limits->difference_matters = limits->local_matters = limits->flip_matters = loose;
    limits->max_difference = LIMITS[level].difference;
    limits->max_local = LIMITS[level].local;
    limits->max_flip = LIMITS[level].flip;
}
