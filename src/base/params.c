// SPDX-License-Identifier: MIT
#include "base/params.h"

#include "glsl/common/collider_table.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#define CHOICE_WORD(value, word) word,
#define ROW_STRUCT_RUN           RunParams
#define ROW_STRUCT_SECTION       SectionParams
#define PARAM(scope_, KIND, GROUP, owner_, field, letter_, default_, minimum_, maximum_, unit_,    \
              CHOICES, help_)                                                                      \
    {.name = #field,                                                                               \
     .scope = SCOPE_##scope_,                                                                      \
     .kind = PARAM_##KIND,                                                                         \
     .group = GROUP_##GROUP,                                                                       \
     .owner = owner_,                                                                              \
     .letter = letter_,                                                                            \
     .offset = offsetof(ROW_STRUCT_##scope_, field),                                               \
     .default_text = default_,                                                                     \
     .minimum = minimum_,                                                                          \
     .maximum = maximum_,                                                                          \
     .unit = unit_,                                                                                \
     .choices = (const char *const[]){CHOICES(CHOICE_WORD) NULL},                                  \
     .help = help_},
const ParamInfo PARAM_TABLE[] = {
#include "base/params.def"
};
#undef PARAM

const size_t PARAM_COUNT = sizeof PARAM_TABLE / sizeof PARAM_TABLE[0];

#define GROUP_TITLE(group, title) title,
const char *const GROUP_TITLES[GROUP_COUNT] = {PARAM_GROUPS(GROUP_TITLE)};

static bool owns_text(const ParamInfo *info)
{
    return info->kind == PARAM_TEXT || info->kind == PARAM_PATH;
}

static char **text_field(const ParamInfo *info, void *params)
{
    return (char **)(void *)((char *)params + info->offset);
}

static Result create_defaults(ParamScope scope, void *params, Error *error)
{
    for (size_t i = 0; i < PARAM_COUNT; i++) {
        if (PARAM_TABLE[i].scope != scope) continue;
        Result result = params_parse(&PARAM_TABLE[i], params, PARAM_TABLE[i].default_text, error);
        assert(result != RESULT_USAGE);
        if (result != RESULT_OK) return result;
    }
    return RESULT_OK;
}

static void free_texts(ParamScope scope, void *params)
{
    for (size_t i = 0; i < PARAM_COUNT; i++) {
        const ParamInfo *info = &PARAM_TABLE[i];
        if (info->scope == scope && owns_text(info)) free(*text_field(info, params));
    }
}

Result params_create_run(RunParams *params, Error *error)
{
    *params = (RunParams){0};
    return create_defaults(SCOPE_RUN, params, error);
}

Result params_create_section(SectionParams *params, Error *error)
{
    *params = (SectionParams){0};
    return create_defaults(SCOPE_SECTION, params, error);
}

void params_destroy_run(RunParams *params)
{
    free_texts(SCOPE_RUN, params);
    *params = (RunParams){0};
}

void params_destroy_section(SectionParams *params)
{
    free_texts(SCOPE_SECTION, params);
    *params = (SectionParams){0};
}

Result params_copy_section(SectionParams *to, const SectionParams *from, Error *error)
{
    *to = *from;
    bool copied = true;
    for (size_t i = 0; i < PARAM_COUNT; i++) {
        const ParamInfo *info = &PARAM_TABLE[i];
        if (info->scope != SCOPE_SECTION || !owns_text(info)) continue;
        char **text = text_field(info, to);
        // Once one copy has failed the others become NULL, so that nothing is shared with `from`.
        *text = copied ? strdup(*text) : NULL;
        copied = *text != NULL;
    }
    if (copied) return RESULT_OK;
    params_destroy_section(to);
    return error_set(error, RESULT_FAILED, "out of memory");
}

static bool names_equal(const char *a, const char *b)
{
    for (; *a && *b; a++, b++) {
        if ((*a == '-' ? '_' : *a) != (*b == '-' ? '_' : *b)) return false;
    }
    return *a == *b;
}

const ParamInfo *params_find(const char *name)
{
    for (size_t i = 0; i < PARAM_COUNT; i++) {
        if (names_equal(PARAM_TABLE[i].name, name)) return &PARAM_TABLE[i];
    }
    return NULL;
}

const ParamInfo *params_find_letter(char letter)
{
    for (size_t i = 0; letter && i < PARAM_COUNT; i++) {
        if (PARAM_TABLE[i].letter == letter) return &PARAM_TABLE[i];
    }
    return NULL;
}

bool params_owned_by(const ParamInfo *info, const char *solver)
{
    size_t length = strlen(solver);
    if (!*info->owner) return true;
    for (const char *at = info->owner; *at; at += strcspn(at, " "), at += *at == ' ')
        if (strncmp(at, solver, length) == 0 && (!at[length] || at[length] == ' ')) return true;
    return false;
}
