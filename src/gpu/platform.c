// SPDX-License-Identifier: MIT
#include "gpu/platform.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const MAKERS[][2] = {{"nvidia", "nvidia"},
                                        {"amd", "amd"},
                                        {"ati tech", "amd"},
                                        {"radeon", "amd"},
                                        {"intel", "intel"}};

// Appends `length` characters to the name, in lower case and without the marks "(R)" and "(TM)".
// Each run of characters other than letters and digits becomes one '-'.
static void add(char name[PLATFORM_BYTES], const char *text, size_t length)
{
    size_t used = strlen(name);
    bool gap = used > 0;
    for (size_t i = 0; i < length && text[i]; ++i) {
        size_t mark = strncasecmp(text + i, "(R)", 3) == 0    ? 3
                      : strncasecmp(text + i, "(TM)", 4) == 0 ? 4
                                                              : 0;
        if (mark) {
            i += mark - 1;
            continue;
        }
        unsigned char c = (unsigned char)text[i];
        if (!isalnum(c) && c != '.' && c != '_') {
            gap = used > 0;
            continue;
        }
        if (used + 2 >= PLATFORM_BYTES) break;
        if (gap) name[used++] = '-';
        gap = false;
        name[used++] = (char)tolower(c);
    }
    name[used] = 0;
}

static void add_text(char name[PLATFORM_BYTES], const char *text)
{
    add(name, text, strlen(text));
}

// Appends `word` and the number that follows `key` in the text. The number may have at most `dots`
// dots. Appends nothing if there is no such number.
static void add_number(char name[PLATFORM_BYTES], const char *word, const char *text,
                       const char *key, int dots)
{
    char part[40];
    const char *at = strstr(text, key);
    if (!at) return;
    at += strlen(key);
    size_t length = 0;
    for (; isdigit((unsigned char)at[length]) || (at[length] == '.' && dots > 0); ++length)
        dots -= at[length] == '.';
    while (length > 0 && at[length - 1] == '.') --length;
    if (length == 0) return;
    snprintf(part, sizeof part, "%s%.*s", word, (int)(length < 16 ? length : 16), at);
    add_text(name, part);
}

static const char *maker_of(const PlatformFacts *facts)
{
    for (size_t i = 0; i < sizeof MAKERS / sizeof *MAKERS; ++i)
        if (strcasestr(facts->renderer, MAKERS[i][0]) || strcasestr(facts->vendor, MAKERS[i][0]))
            return MAKERS[i][1];
    return "gpu";
}

// Appends the device's name without the prefix "Mesa", the maker, and anything in brackets.
static void add_device(char name[PLATFORM_BYTES], const char *renderer)
{
    size_t maker = strlen(name);
    if (strncmp(renderer, "Mesa ", 5) == 0) renderer += 5;
    if (strncasecmp(renderer, name, maker) == 0) renderer += maker;
    const char *end = strstr(renderer, " (");
    size_t length = end ? (size_t)(end - renderer) : strcspn(renderer, "/");
    add(name, renderer, length);
}

void platform_name(char name[PLATFORM_BYTES], const PlatformFacts *facts)
{
    const char *renderer = facts->renderer, *bits = strstr(renderer, " bits");
    name[0] = 0;
    if (!facts->software || facts->assumed) add_text(name, maker_of(facts));
    if (!facts->software)
        add_device(name, renderer);
    else
        add(name, renderer, strcspn(renderer, " "));
    add_number(name, "mesa", facts->version, "Mesa ", 1);
    if (strstr(facts->version, "Mesa ") == NULL) add_number(name, "", facts->version, "NVIDIA ", 0);
    if (!facts->software) return;
    add_number(name, "llvm", renderer, "LLVM ", 0);
    while (bits && bits > renderer && isdigit((unsigned char)bits[-1])) --bits;
    if (bits) add(name, bits, strspn(bits, "0123456789"));
    if (facts->fma) add_text(name, "fma");
    add_text(name, facts->machine);
}

bool platform_has_fma(void)
{
#if defined __x86_64__ || defined __i386__
    // Every value of this Mesa variable disables FMA (u_cpu_detect.c).
    return __builtin_cpu_supports("fma") && !getenv("GALLIUM_OVERRIDE_CPU_CAPS");
#else
    return true;
#endif
}
