// SPDX-License-Identifier: MIT
#include "bench/stress_case.h"
#include "base/double3.h"
#include "base/suggest.h"
#include "bench/trial.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

// --- Fields.

// How random values of a field are distributed. ZERO: logarithmic, often 0. WHOLE_LOG: even in the
// logarithm of 1 + a whole number. STYLE: often 0, 0.5 or 1. The last two are for parameters.
typedef enum Spread { EVEN, LOG, ZERO, WHOLE, WHOLE_LOG, STYLE } Spread;

typedef struct Field {
    const char *name;
    double plain, low, high;
    Spread spread;
    double likely;
    const ParamInfo *info; // NULL for a circumstance
} Field;

static const Field CIRCUMSTANCES[] = {
#define STRESS_ROW(name, plain, low, high, spread, likely)                                         \
    {#name, plain, low, high, spread, likely, NULL},
    STRESS_FIELDS(STRESS_ROW)
#undef STRESS_ROW
};

// Parameters with other distributions than find_param derives from their kind and range.
static const struct {
    const char *name;
    double low, high;
    Spread spread;
    double likely;
} SPECIAL[] = {
    {"drag", 1e-3, 1e4, ZERO, 0.5}, // with more drag, hair moves exactly with the air
    {"style", 0, 1, STYLE, 0.5},
    {"rest", REST_GROOM, REST_HANGING, WHOLE, 1},
    {"style_stiffness", 1, 1e9, ZERO, 0.3}, // softer springs have no effect
    {"youngs_modulus", 1e-3, 100, ZERO, 0.2},
    {"hair_radius", 5, 500, LOG, 1},
    {"bend_damping", 0.01, 100, ZERO, 0.3},
    {"rope_iterations", 1, 100, WHOLE_LOG, 0.3}, // each iteration takes the same time
    {"rope_compliance", 1e-9, 1e6, ZERO, 0.3},   // small values are stiff
    {"stretch_drawn", 0, 1, WHOLE, 1},
};

static double default_of(const ParamInfo *info)
{
    if (info->kind == PARAM_BOOL) return strcmp(info->default_text, "true") == 0;
    for (int i = 0; info->kind == PARAM_CHOICE && info->choices[i]; ++i)
        if (strcmp(info->choices[i], info->default_text) == 0) return i;
    return strtod(info->default_text, NULL);
}

// The distribution of a parameter: within its documented range. If that begins at 0, the
// logarithmic part begins at a billionth of its end.
static Field find_param(const ParamInfo *info)
{
    Field field = {info->name, default_of(info), info->minimum, info->maximum, EVEN, 0.2, info};
    if (info->kind == PARAM_BOOL) field.high = 1;
    for (; info->kind == PARAM_CHOICE && info->choices[(int)field.high + 1];) ++field.high;
    if (info->kind != PARAM_FLOAT && info->kind != PARAM_PROFILE)
        field.spread = field.high > 3 ? WHOLE_LOG : WHOLE;
    else if (field.low > 0)
        field.spread = LOG;
    else if (field.high > 1)
        field.spread = ZERO, field.low = 1e-9 * field.high;
    for (size_t i = 0; i < sizeof SPECIAL / sizeof *SPECIAL; ++i)
        if (strcmp(SPECIAL[i].name, info->name) == 0) {
            field.low = SPECIAL[i].low, field.high = SPECIAL[i].high;
            field.spread = SPECIAL[i].spread, field.likely = SPECIAL[i].likely;
        }
    return field;
}

typedef struct Fields {
    Field field[STRESS_MOST_FIELDS];
    int count;
} Fields;

// All fields. Built from params.def at the first call.
static const Fields *list_fields(void)
{
    static Fields all;
    if (all.count) return &all;
    memcpy(all.field, CIRCUMSTANCES, sizeof CIRCUMSTANCES);
    all.count = STRESS_PARAMS;
    for (size_t i = 0; i < PARAM_COUNT && all.count < STRESS_MOST_FIELDS; ++i) {
        ParamKind kind = PARAM_TABLE[i].kind;
        if (trial_takes(&PARAM_TABLE[i]) &&
            (kind == PARAM_FLOAT || kind == PARAM_PROFILE || kind == PARAM_INT ||
             kind == PARAM_BOOL || kind == PARAM_CHOICE))
            all.field[all.count++] = find_param(&PARAM_TABLE[i]);
    }
    return &all;
}

static bool applies(const Field *field, const StressCase *stress)
{
    if (!field->info) return true;
    bool refused = strcmp(field->name, "rope_compliance") == 0 &&
                   strcmp(stress->variant, "xpbd") != 0; // the other variant of rope refuses it
    return !refused && params_owned_by(field->info, stress->algo);
}

static double param_value(const StressCase *stress, const char *name)
{
    const Fields *all = list_fields();
    for (int i = STRESS_PARAMS; i < all->count; ++i)
        if (strcmp(all->field[i].name, name) == 0) return stress->value[i];
    return NAN;
}

static bool is_whole(const Field *field)
{
    return field->spread == WHOLE || field->spread == WHOLE_LOG;
}

static bool is_in_range(const Field *field, double value)
{
    return (field->spread == ZERO && value == 0) || (value >= field->low && value <= field->high);
}

// --- Making cases.

const int STRESS_VERTICES[STRESS_VERTEX_COUNTS] = {2, 3, 16, 64};

StressCase stress_case_plain(const char *algo, const char *variant)
{
    const Fields *all = list_fields();
    StressCase stress = {.algo = algo, .variant = variant};
    for (int i = 0; i < all->count; ++i) stress.value[i] = all->field[i].plain;
    return stress;
}

// Rounds to five digits, so that a case is exactly its text.
static double rounded(double value)
{
    char text[32];
    snprintf(text, sizeof text, "%.5g", value);
    return strtod(text, NULL);
}

static double random_value(const Field *field, Random *random)
{
    double share = random_real(random), choice = random_real(random), low = field->low,
           high = field->high;
    switch (field->spread) {
    case EVEN:
        return low + share * (high - low);
    case ZERO:
        if (choice < 0.25) return 0;
        return low * pow(high / low, share);
    case LOG:
        return low * pow(high / low, share);
    case WHOLE:
        return floor(low + share * (high - low + 1));
    case WHOLE_LOG:
        return fmax(floor(pow(high + 1, share)), low);
    case STYLE:
    default:
        return choice < 0.5 ? 0.5 * floor(6 * choice) : share;
    }
}

// Fields that are drawn at random together: for a set, for each strand, for the mesh.
typedef enum Part { OF_SET, OF_STRAND, OF_WARP } Part;

static Part part_of(int field)
{
    if (field == STRESS_shape || field == STRESS_tilt || field == STRESS_shape_seed)
        return OF_STRAND;
    return field >= STRESS_warp && field <= STRESS_warp_seed ? OF_WARP : OF_SET;
}

static void draw(StressCase *stress, Part part, Random *random)
{
    const Fields *all = list_fields();
    for (int i = 0; i < all->count; ++i) {
        if (part_of(i) == part && applies(&all->field[i], stress) &&
            random_real(random) < all->field[i].likely)
            stress->value[i] = rounded(random_value(&all->field[i], random));
    }
}

// Moves the root near enough to the origin that float32 can tell a strand's particles apart: the
// reader merges particles that are closer than 1e-7 of the largest coordinate.
static void keep_apart(StressCase *stress)
{
    double link = stress->value[STRESS_length] / (stress->value[STRESS_n] - 1);
    stress->value[STRESS_arm] = rounded(fmin(stress->value[STRESS_arm], 1e6 * link));
}

// Limits the time step for stiff springs, which take thousands of sub-steps for long steps
// (solver_spring.c).
static void keep_affordable(StressCase *stress)
{
    const double *value = stress->value;
    double links = value[STRESS_n] - 1, most = STRESS_MOST_SMALL_STEPS;
    if (strcmp(stress->algo, "spring") != 0) return;
    most *= strcmp(stress->variant, "explicit") == 0
                ? 1.6 / (links * sqrt(2.5 * param_value(stress, "spring_coil")))
                : 10 / (links * sqrt(fmax(value[STRESS_gravity], 1e-9) / value[STRESS_length]));
    stress->value[STRESS_dt] = rounded(fmax(fmin(value[STRESS_dt], most), 1e-6));
}

StressCase stress_case_random(const char *algo, const char *variant, int vertices, Random *random)
{
    StressCase stress = stress_case_plain(algo, variant);
    Random fork = *random, warps = random_create(random_next(&fork), 1);
    draw(&stress, OF_SET, random);
    // The warp has random numbers of its own, so a case without its warp stays the same otherwise.
    draw(&stress, OF_WARP, &warps);
    if (stress.value[STRESS_warp] == 0)
        for (int i = STRESS_warp_rate; i <= STRESS_warp_seed; ++i)
            stress.value[i] = CIRCUMSTANCES[i].plain;
    stress.value[STRESS_n] = vertices;
    keep_apart(&stress);
    keep_affordable(&stress);
    return stress;
}

StressCase stress_case_random_strand(const StressCase *set, int strand, Random *random)
{
    StressCase stress = *set;
    stress.value[STRESS_strand] = strand;
    draw(&stress, OF_STRAND, random);
    return stress;
}

// --- Text.

static Result read_word(StressCase *stress, const char *word, size_t length, Error *error)
{
    const Fields *all = list_fields();
    const char *equals = memchr(word, '=', length), *names[STRESS_MOST_FIELDS];
    size_t name = equals ? (size_t)(equals - word) : length;
    char text[64], *end = NULL;
    snprintf(text, sizeof text, "%.*s", (int)name, word);
    for (int i = 0; i < all->count; ++i) {
        const Field *field = &all->field[i];
        names[i] = field->name;
        if (strcmp(field->name, text) != 0) continue;
        if (!applies(field, stress))
            return error_set(error, RESULT_USAGE, "--case: %s does not belong to %s %s", text,
                             stress->algo, stress->variant);
        double value = equals ? strtod(equals + 1, &end) : NAN;
        if (!equals || end != word + length || (is_whole(field) && value != floor(value)) ||
            !is_in_range(field, value))
            return error_set(error, RESULT_USAGE, "--case: %s: expected %g to %g, got '%.*s'", text,
                             field->low, field->high, (int)length, word);
        stress->value[i] = value;
        return RESULT_OK;
    }
    char words[800];
    return error_set(error, RESULT_USAGE, "--case: no '%s': %s", text,
                     suggest_words(words, sizeof words, text, names, (size_t)all->count));
}

Result stress_case_read(StressCase *stress, const char *text, Error *error)
{
    *stress = stress_case_plain(stress->algo, stress->variant);
    if (strcmp(text, "plain") == 0) text = "";
    for (size_t length; *(text += strspn(text, " ")); text += length) {
        length = strcspn(text, " ");
        TRY(read_word(stress, text, length, error));
    }
    keep_apart(stress);
    return RESULT_OK;
}

void stress_case_write(const StressCase *stress, char *text, size_t size)
{
    const Fields *all = list_fields();
    size_t used = 0;
    snprintf(text, size, "plain");
    for (int i = 0; i < all->count && used < size; ++i)
        if (applies(&all->field[i], stress) && stress->value[i] != all->field[i].plain)
            used += (size_t)snprintf(text + used, size - used, "%s%s=%.5g", used ? " " : "",
                                     all->field[i].name, stress->value[i]);
}

// --- Simpler cases.

// Three ways to simplify a value: its plain value; half of the way to it (in the logarithm if both
// are positive), or the plain value if that is near; the value rounded to one digit.
enum { MOVES_A_FIELD = 3, VERTEX_MOVES = 5 };

static double simpler_value(const Field *field, int way, double value)
{
    char text[32];
    double plain = field->plain;
    if (way == 0 || value == plain) return plain;
    double half = value > 0 && plain > 0 ? sqrt(value * plain) : 0.5 * (value + plain);
    if (is_whole(field)) half = floor(half);
    if (fabs(half - plain) < 0.05 * fabs(plain) || half == value) half = plain;
    snprintf(text, sizeof text, "%.0e", value);
    double simpler = way == 1 ? rounded(half) : strtod(text, NULL);
    return is_in_range(field, simpler) ? simpler : value;
}

bool stress_case_simplify(const StressCase *stress, int move, StressCase *simpler)
{
    static const int fewer[VERTEX_MOVES] = {2, 3, 4, 8, 16};
    const Fields *all = list_fields();
    *simpler = *stress;
    if (move < VERTEX_MOVES) {
        if (fewer[move] < stress->value[STRESS_n]) simpler->value[STRESS_n] = fewer[move];
    } else {
        int at = (move - VERTEX_MOVES) % all->count, way = (move - VERTEX_MOVES) / all->count;
        if (way >= MOVES_A_FIELD) return false;
        if (at != STRESS_n && applies(&all->field[at], stress))
            simpler->value[at] = simpler_value(&all->field[at], way, stress->value[at]);
    }
    keep_apart(simpler);
    return true;
}

// --- The solver's parameters.

Result stress_case_params(const StressCase *stress, SectionParams *params, Error *error)
{
    const Fields *all = list_fields();
    Result result = params_create_section(params, error);
    THEN(result, params_parse(params_find("algo"), params, stress->algo, error));
    THEN(result, params_parse(params_find("variant"), params, stress->variant, error));
    for (int i = STRESS_PARAMS; i < all->count && result == RESULT_OK; ++i) {
        const ParamInfo *info = all->field[i].info;
        char text[32];
        if (!applies(&all->field[i], stress)) continue;
        snprintf(text, sizeof text, "%.5g", stress->value[i]);
        if (info->kind == PARAM_BOOL)
            snprintf(text, sizeof text, stress->value[i] > 0 ? "true" : "false");
        if (info->kind == PARAM_CHOICE)
            snprintf(text, sizeof text, "%s", info->choices[(int)stress->value[i]]);
        result = params_parse(info, params, text, error);
        if (result != RESULT_OK) error_prefix(error, result, "--case: %s: ", info->name);
    }
    if (result != RESULT_OK) params_destroy_section(params);
    return result;
}

// --- The mesh.

void stress_case_warp(const StressCase *stress, double time, const double rest[3], double place[3])
{
    enum { WAVES = 3 };
    const double *value = stress->value;
    const double from[3] = {rest[0], rest[1] - value[STRESS_arm], rest[2]};
    Random random = random_create((uint64_t)value[STRESS_warp_seed], 1);
    memcpy(place, rest, 3 * sizeof *place);
    for (int i = 0; i < WAVES; ++i) {
        double along[3], way[3];
        random_direction(&random, along);
        random_direction(&random, way);
        double phase = 2 * PI * random_real(&random), speed = 0.5 + random_real(&random);
        double here = sin(2 * PI * double3_dot(along, from) / value[STRESS_warp_size] + phase),
               now = sin(2 * PI * value[STRESS_warp_rate] * speed * time);
        for (int k = 0; k < 3; ++k) place[k] += value[STRESS_warp] / WAVES * here * now * way[k];
    }
}

// --- The strand.

// The vector from particle j - 1 to j, before the strand is scaled to `length`. `main` is a unit
// vector, `side` a unit vector across it.
static void link_of(const StressCase *stress, int j, const double main[3], const double side[3],
                    Random *random, double link[3])
{
    double turn = 2 * PI * 3 * j / stress->value[STRESS_n], along = 1, across = 0, over = 0;
    switch ((enum StressShape)stress->value[STRESS_shape]) {
    case STRESS_CURL:
        along = 0.5, across = cos(turn), over = sin(turn);
        break;
    case STRESS_ZIGZAG:
        along = j % 2 ? 1 : -1;
        break;
    case STRESS_UNEVEN:
        along = pow(1e4, random_real(random));
        break;
    case STRESS_WALK:
    case STRESS_NEARLY_ZERO:
        random_direction(random, link);
        for (int k = 0; k < 3 && stress->value[STRESS_shape] == STRESS_NEARLY_ZERO; ++k)
            link[k] *= j % 2 ? 1 : 1e-12;
        return;
    case STRESS_STRAIGHT:
        break;
    }
    Double3 third;
    double3_cross(main, side, third);
    for (int k = 0; k < 3; ++k) link[k] = along * main[k] + across * side[k] + over * third[k];
}

void stress_case_make_strand(const StressCase *stress, float (*points)[3])
{
    enum { MOST = 64 };
    int n = (int)stress->value[STRESS_n];
    double tilt = stress->value[STRESS_tilt] * PI / 180, length = stress->value[STRESS_length],
           arm = stress->value[STRESS_arm], total = 0, links[MOST][3], x[3] = {0, arm, 0};
    const double main[3] = {sin(tilt), -cos(tilt), 0}, side[3] = {cos(tilt), sin(tilt), 0};
    Random random = random_create((uint64_t)stress->value[STRESS_shape_seed], 0);
    for (int j = 1; j < n; ++j) {
        link_of(stress, j, main, side, &random, links[j]);
        total += double3_length(links[j]);
    }
    // The reader keeps particles apart that are more than 1e-7 of the largest coordinate apart
    // after rounding.
    double least = fmax(1.1e-9, 4e-7 * (arm + length));
    for (int j = 0; j < n; ++j) {
        double size = j ? double3_length(links[j]) : 1,
               scaled = j ? fmax(size * length / total, least) / size : 0;
        for (int k = 0; k < 3; ++k) points[j][k] = (float)(x[k] += j ? scaled * links[j][k] : 0);
    }
}
