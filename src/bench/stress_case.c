// SPDX-License-Identifier: MIT
#include "bench/stress_case.h"
#include "base/suggest.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef enum Spread { EVEN, LOG, ZERO, WHOLE, WHOLE_LOG, STYLE } Spread;

static const struct {
    const char *name;
    double plain, low, high;
    Spread spread;
    double likely;
    const char *algo; // "": of all; NULL: no parameter of the solver's
} FIELDS[] = {
#define STRESS_ROW(name, plain, low, high, spread, likely, algo)                                   \
    {#name, plain, low, high, spread, likely, algo},
    STRESS_FIELDS(STRESS_ROW)
#undef STRESS_ROW
};

const int STRESS_VERTICES[STRESS_VERTEX_COUNTS] = {2, 3, 16, 64};

// Whether the solver has the field: the list names it, or it with the variant as "rope/xpbd".
static bool applies(int field, const StressCase *stress)
{
    const char *list = FIELDS[field].algo;
    if (!list || !*list) return true;
    size_t length = strlen(stress->algo);
    const char *at = strstr(list, stress->algo);
    if (!at) return false;
    return at[length] != '/' || strcmp(at + length + 1, stress->variant) == 0;
}

StressCase stress_case_plain(const char *algo, const char *variant)
{
    StressCase stress = {.algo = algo, .variant = variant};
    for (int i = 0; i < STRESS_FIELD_COUNT; ++i) stress.value[i] = FIELDS[i].plain;
    return stress;
}

static bool is_of_strand(int field)
{
    return field == STRESS_shape || field == STRESS_tilt || field == STRESS_shape_seed;
}

// To five digits, so that the text is the case.
static double rounded(double value)
{
    char text[32];
    snprintf(text, sizeof text, "%.5g", value);
    return strtod(text, NULL);
}

static double between(int field, bool by_log, double share)
{
    double low = FIELDS[field].low, high = FIELDS[field].high;
    return by_log ? low * pow(high / low, share) : low + share * (high - low);
}

static double random_value(int field, Random *random)
{
    double share = random_real(random), choice = random_real(random);
    switch (FIELDS[field].spread) {
    case EVEN:
        return between(field, false, share);
    case LOG:
        return between(field, true, share);
    case ZERO:
        return choice < 0.25 ? 0 : between(field, true, share);
    case WHOLE:
        return floor(FIELDS[field].low + share * (FIELDS[field].high - FIELDS[field].low + 1));
    case WHOLE_LOG:
        return floor(pow(FIELDS[field].high + 1, share));
    case STYLE:
    default:
        return choice < 0.5 ? 0.5 * floor(6 * choice) : share;
    }
}

static void draw(StressCase *stress, bool of_strand, Random *random)
{
    for (int i = 0; i < STRESS_FIELD_COUNT; ++i)
        if (is_of_strand(i) == of_strand && applies(i, stress) &&
            random_real(random) < FIELDS[i].likely)
            stress->value[i] = rounded(random_value(i, random));
}

// Roots are where float32 still tells a strand's particles apart: reading merges those that are
// closer than 1e-7 of the largest coordinate.
static void keep_apart(StressCase *stress)
{
    double link = stress->value[STRESS_length] / (stress->value[STRESS_n] - 1);
    stress->value[STRESS_arm] = rounded(fmin(stress->value[STRESS_arm], 1e6 * link));
}

// Springs take sub-steps by the thousand for long steps (solver_spring.c).
static void keep_affordable(StressCase *stress)
{
    const double *value = stress->value;
    double links = value[STRESS_n] - 1, most = STRESS_MOST_SMALL_STEPS;
    if (strcmp(stress->algo, "spring") != 0) return;
    most *= strcmp(stress->variant, "explicit") == 0
                ? 1.6 / (links * sqrt(2.5 * value[STRESS_spring_coil]))
                : 10 / (links * sqrt(fmax(value[STRESS_gravity], 1e-9) / value[STRESS_length]));
    stress->value[STRESS_dt] = rounded(fmax(fmin(value[STRESS_dt], most), 1e-6));
}

StressCase stress_case_random(const char *algo, const char *variant, int vertices, Random *random)
{
    StressCase stress = stress_case_plain(algo, variant);
    draw(&stress, false, random);
    stress.value[STRESS_n] = vertices;
    keep_apart(&stress);
    keep_affordable(&stress);
    return stress;
}

StressCase stress_case_random_strand(const StressCase *set, int strand, Random *random)
{
    StressCase stress = *set;
    stress.value[STRESS_strand] = strand;
    draw(&stress, true, random);
    return stress;
}

// --- Text.

static Result read_word(StressCase *stress, const char *word, size_t length, Error *error)
{
    const char *equals = memchr(word, '=', length), *names[STRESS_FIELD_COUNT];
    size_t name = equals ? (size_t)(equals - word) : length;
    char text[64], *end = NULL;
    snprintf(text, sizeof text, "%.*s", (int)name, word);
    for (int i = 0; i < STRESS_FIELD_COUNT; ++i) {
        names[i] = FIELDS[i].name;
        if (strcmp(FIELDS[i].name, text) != 0) continue;
        if (!applies(i, stress))
            return error_set(error, RESULT_USAGE, "--case: %s does not belong to %s %s", text,
                             stress->algo, stress->variant);
        double value = equals ? strtod(equals + 1, &end) : NAN;
        bool whole = FIELDS[i].spread == WHOLE || FIELDS[i].spread == WHOLE_LOG;
        bool zero = FIELDS[i].spread == ZERO && value == 0;
        if (!equals || end != word + length || (whole && value != floor(value)) ||
            (!zero && !(value >= FIELDS[i].low && value <= FIELDS[i].high)))
            return error_set(error, RESULT_USAGE, "--case: %s: expected %g to %g, got '%.*s'", text,
                             FIELDS[i].low, FIELDS[i].high, (int)length, word);
        stress->value[i] = value;
        return RESULT_OK;
    }
    char words[800];
    return error_set(error, RESULT_USAGE, "--case: no '%s': %s", text,
                     suggest_words(words, sizeof words, text, names, STRESS_FIELD_COUNT));
}

Result stress_case_read(StressCase *stress, const char *text, Error *error)
{
    *stress = stress_case_plain(stress->algo, stress->variant);
    Result result = RESULT_OK;
    if (strcmp(text, "plain") == 0) text = "";
    for (const char *at = text + strspn(text, " "); *at && result == RESULT_OK;) {
        size_t length = strcspn(at, " ");
        result = read_word(stress, at, length, error);
        at += length;
        at += strspn(at, " ");
    }
    keep_apart(stress);
    return result;
}

void stress_case_write(const StressCase *stress, char *text, size_t size)
{
    size_t used = 0;
    snprintf(text, size, "plain");
    for (int i = 0; i < STRESS_FIELD_COUNT && used < size; ++i)
        if (applies(i, stress) && stress->value[i] != FIELDS[i].plain)
            used += (size_t)snprintf(text + used, size - used, "%s%s=%.5g", used ? " " : "",
                                     FIELDS[i].name, stress->value[i]);
}

// --- Simpler cases.

// Half the way to the plain value, in the logarithm if both have one; the plain one from near by.
static double halved(int field, double value)
{
    double plain = FIELDS[field].plain;
    bool whole = FIELDS[field].spread == WHOLE || FIELDS[field].spread == WHOLE_LOG;
    double half = value > 0 && plain > 0 ? sqrt(value * plain) : 0.5 * (value + plain);
    half = whole ? floor(half) : half;
    return fabs(half - plain) < 0.05 * fabs(plain) || half == value ? plain : half;
}

// To one digit, as people write numbers; back to five where that changes nothing.
static double round_number(double value)
{
    char text[32];
    snprintf(text, sizeof text, "%.0e", value);
    return strtod(text, NULL);
}

enum { MOVES_A_FIELD = 3, VERTEX_MOVES = 5 };

static double simpler_value(int field, int way, double value)
{
    if (way == 0 || value == FIELDS[field].plain) return FIELDS[field].plain;
    double simpler = way == 1 ? rounded(halved(field, value)) : round_number(value);
    bool zero = FIELDS[field].spread == ZERO && simpler == 0;
    return zero || (simpler >= FIELDS[field].low && simpler <= FIELDS[field].high) ? simpler
                                                                                   : value;
}

bool stress_case_simplify(const StressCase *stress, int move, StressCase *simpler)
{
    static const int fewer[VERTEX_MOVES] = {2, 3, 4, 8, 16};
    *simpler = *stress;
    if (move < VERTEX_MOVES) {
        if (fewer[move] < stress->value[STRESS_n]) simpler->value[STRESS_n] = fewer[move];
    } else {
        int field = (move - VERTEX_MOVES) % STRESS_FIELD_COUNT;
        int way = (move - VERTEX_MOVES) / STRESS_FIELD_COUNT;
        if (way >= MOVES_A_FIELD) return false;
        if (field != STRESS_n && applies(field, stress))
            simpler->value[field] = simpler_value(field, way, stress->value[field]);
    }
    keep_apart(simpler);
    return true;
}

// --- The solver's parameters.

Result stress_case_params(const StressCase *stress, SectionParams *params, Error *error)
{
    Result result = params_create_section(params, error);
    if (result == RESULT_OK)
        result = params_parse(params_find("algo"), params, stress->algo, error);
    if (result == RESULT_OK)
        result = params_parse(params_find("variant"), params, stress->variant, error);
    for (int i = 0; i < STRESS_FIELD_COUNT && result == RESULT_OK; ++i) {
        const ParamInfo *info = FIELDS[i].algo ? params_find(FIELDS[i].name) : NULL;
        if (!info || !applies(i, stress)) continue;
        char text[32];
        snprintf(text, sizeof text, "%.5g", stress->value[i]);
        if (info->kind == PARAM_BOOL)
            snprintf(text, sizeof text, stress->value[i] > 0 ? "true" : "false");
        result = params_parse(info, params, text, error);
        if (result != RESULT_OK) error_prefix(error, result, "--case: %s: ", FIELDS[i].name);
    }
    if (result != RESULT_OK) params_destroy_section(params);
    return result;
}
