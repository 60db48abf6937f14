// SPDX-License-Identifier: MIT
#include "bench/method.h"
#include "sim/solver.h"

#include <string.h>

bool method_takes(const ParamInfo *info)
{
    static const char *const other[] = {
        "algo", "variant", "followers", "follow", "follower_radius", "tip_separation", "sleep"};
    for (size_t i = 0; i < sizeof other / sizeof *other; ++i)
        if (strcmp(info->name, other[i]) == 0) return false;
    return info->scope == SCOPE_SECTION && info->group == GROUP_SIMULATION;
}

bool method_has(const Method *method, const char *param)
{
    return params_owned_by(params_find(param), method->algo);
}

bool method_is_default(const Method *method)
{
    return !*method->variant && !*method->settings;
}

static Result set(SectionParams *params, const char *name, const char *text, Error *error)
{
    const ParamInfo *info = params_find(name);
    if (!info) return error_set(error, RESULT_USAGE, "--%s: no such parameter", name);
    Result result = params_parse(info, params, text, error);
    return result == RESULT_OK ? result : error_prefix(error, result, "--%s: ", name);
}

// Words in turn a flag and its value.
static Result apply(SectionParams *params, char *words, Error *error)
{
    char *rest = NULL;
    for (char *flag = strtok_r(words, " ", &rest); flag; flag = strtok_r(NULL, " ", &rest)) {
        const char *value = strtok_r(NULL, " ", &rest);
        if (strncmp(flag, "--", 2) != 0 || !value)
            return error_set(error, RESULT_USAGE, "settings: expected --flag value, got '%s'",
                             flag);
        TRY(set(params, flag + 2, value, error));
    }
    return RESULT_OK;
}

Result method_params(SectionParams *params, const Method *method, const char *before, Error *error)
{
    char words[4096];
    *params = (SectionParams){0};
    if (snprintf(words, sizeof words, "%s %s", before, method->settings) >= (int)sizeof words)
        return error_set(error, RESULT_USAGE, "settings: longer than %zu bytes", sizeof words);
    TRY(params_create_section(params, error));
    TRY(set(params, "algo", method->algo, error));
    TRY(set(params, "variant", method->variant, error));
    TRY(apply(params, words, error));
    return solver_check(params, error);
}

const char *method_variant(const Method *method)
{
    if (*method->variant) return method->variant;
    for (const SolverType *const *type = SOLVER_TYPES; *type; ++type)
        if (strcmp((*type)->name, method->algo) == 0 && (*type)->variants[0])
            return (*type)->variants[0];
    return "";
}

void method_format(const Method *method, char *text, size_t size)
{
    const char *variant = method_variant(method);
    snprintf(text, size, "--algo %s%s%s%s%s", method->algo, *variant ? " --variant " : "", variant,
             *method->settings ? " " : "", method->settings);
}

int method_list(const Method *asked, Method methods[METHODS_MOST])
{
    int count = 0;
    if (asked->algo) {
        methods[0] = *asked;
        return 1;
    }
    for (const SolverType *const *type = SOLVER_TYPES; *type && count < METHODS_MOST; ++type)
        if (!solver_is_static(*type))
            methods[count++] = (Method){(*type)->name, "", asked->settings};
    return count;
}
