// SPDX-License-Identifier: MIT
#include "convert/convert_steps.h"

#include "strands/strands.h"
#include "strands/strands_edit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// --- Reading values.

// Reads a decimal number at the beginning of the text. Returns the text behind it, NULL if there is
// no number.
static const char *scan_number(const char *text, double *number)
{
    char *end;
    if (!*text || !strchr("0123456789+-.", *text)) return NULL;
    *number = strtod(text, &end);
    return end == text || !isfinite(*number) ? NULL : end;
}

static Result refuse(const char *name, const char *text, const char *expected, Error *error)
{
    return error_set(error, RESULT_USAGE, "--%s: got '%s', expected %s", name, text, expected);
}

static Result parse_share(ConvertStep *step, const char *name, const char *text, Error *error)
{
    const char *end = scan_number(text, &step->number);
    bool percent = end && strcmp(end, "%") == 0;
    if (percent) step->number /= 100;
    if (end && (percent || !*end) && step->number > 0 && step->number <= 1) return RESULT_OK;
    return refuse(name, text, "a share above 0 up to 1, or 100%", error);
}

static Result parse_count(ConvertStep *step, const char *name, const char *text, Error *error)
{
    static const struct {
        ConvertKind kind;
        double least, most;
    } limits[] = {{CONVERT_NTH, 1, 1e9},
                  {CONVERT_GROUP, 0, STRANDS_MOST_GROUP},
                  {CONVERT_SMOOTH, 1, 10000},
                  {CONVERT_RESAMPLE, 2, STRANDS_MAX_SIZE}};
    double number;
    char expected[64];
    const char *end = scan_number(text, &number);
    for (size_t i = 0; i < sizeof limits / sizeof *limits; i++) {
        if (limits[i].kind != step->kind) continue;
        snprintf(expected, sizeof expected, "a whole number from %.0f to %.0f", limits[i].least,
                 limits[i].most);
        if (!end || *end || number != floor(number) || number < limits[i].least ||
            number > limits[i].most)
            return refuse(name, text, expected, error);
    }
    step->count = step->resample.count = (uint32_t)number;
    return RESULT_OK;
}

static Result parse_positive(double *number, const char *name, const char *text, Error *error)
{
    const char *end = scan_number(text, number);
    if (end && !*end && *number >= 1e-9 && *number <= 1e9) return RESULT_OK;
    return refuse(name, text, "a number from 1e-9 to 1e9", error);
}

static Result parse_gap(double *number, const char *name, const char *text, Error *error)
{
    const char *end = scan_number(text, number);
    if (end && !*end && *number >= 0 && *number <= 1) return RESULT_OK;
    return refuse(name, text, "a distance from 0 to 1 m", error);
}

static Result parse_rotation(StrandsMove *move, const char *name, const char *text, Error *error)
{
    double angle_deg;
    bool axis = *text >= 'x' && *text <= 'z' && text[1] == ',';
    const char *end = axis ? scan_number(text + 2, &angle_deg) : NULL;
    if (!end || *end) return refuse(name, text, "an axis and degrees such as y,90", error);
    *move = strands_move_rotation(*text - 'x', angle_deg);
    return RESULT_OK;
}

static Result parse_translation(StrandsMove *move, const char *name, const char *text, Error *error)
{
    const char *at = text;
    for (int i = 0; i < 3 && at; i++) {
        if (i) at = *at == ',' ? at + 1 : NULL;
        if (at) at = scan_number(at, &move->translation[i]);
        if (at && fabs(move->translation[i]) > 1e6) at = NULL;
    }
    return at && !*at ? RESULT_OK : refuse(name, text, "X,Y,Z, each up to 1e6 m", error);
}

static Result parse_step(ConvertStep *step, const char *name, const char *text, Error *error)
{
    *step = (ConvertStep){.move = strands_move_none()};
    step->kind = CONVERT_MOVE;
    if (strcmp(name, "scale") == 0) return parse_positive(&step->move.scale, name, text, error);
    if (strcmp(name, "rotate") == 0) return parse_rotation(&step->move, name, text, error);
    if (strcmp(name, "translate") == 0) return parse_translation(&step->move, name, text, error);
    step->kind = CONVERT_REVERSE;
    if (strcmp(name, "reverse") == 0) return RESULT_OK;
    step->kind = CONVERT_FIT;
    if (strcmp(name, "fit") == 0) return RESULT_OK;
    step->kind = CONVERT_ATTACH;
    if (strcmp(name, "attach") == 0) return RESULT_OK;
    step->kind = CONVERT_PUSH_OUT;
    if (strcmp(name, "push-out") == 0) return parse_gap(&step->number, name, text, error);
    step->kind = CONVERT_SUBSAMPLE;
    if (strcmp(name, "subsample") == 0) return parse_share(step, name, text, error);
    step->kind = CONVERT_MIN_LENGTH;
    if (strcmp(name, "min-length") == 0) return parse_positive(&step->number, name, text, error);
    step->kind = CONVERT_RESAMPLE;
    if (strcmp(name, "spacing") == 0)
        return parse_positive(&step->resample.spacing, name, text, error);
    step->resample.spline = strcmp(name, "resample-spline") == 0;
    if (strcmp(name, "nth") == 0) step->kind = CONVERT_NTH;
    if (strcmp(name, "group") == 0) step->kind = CONVERT_GROUP;
    if (strcmp(name, "smooth") == 0) step->kind = CONVERT_SMOOTH;
    return parse_count(step, name, text, error);
}

Result convert_steps_parse(ConvertSteps *steps, const OptionSteps *options, Error *error)
{
    Result result = RESULT_OK;
    steps->count = options->count;
    for (int i = 0; i < options->count && result == RESULT_OK; i++)
        result = parse_step(&steps->step[i], options->step[i].option->name, options->step[i].text,
                            error);
    return result;
}

// --- Applying steps.

static bool keeps(const ConvertStep *step, const Strands *strands, uint32_t s)
{
    return step->kind == CONVERT_NTH ? s % step->count == 0
                                     : strands_length(strands, s) >= step->number;
}

static Result pick(const ConvertStep *step, Strands *strands, Error *error)
{
    uint32_t count = 0, *which = malloc(((size_t)strands->strand_count + 1) * sizeof *which);
    if (!which) return error_set(error, RESULT_FAILED, "no memory to pick strands");
    for (uint32_t s = 0; s < strands->strand_count; s++)
        if (keeps(step, strands, s)) which[count++] = s;
    Result result = strands_pick(strands, which, count, error);
    free(which);
    if (result == RESULT_OK && count == 0)
        result = error_set(error, RESULT_FAILED, "--min-length %g: no strand is that long",
                           step->number);
    return result;
}

static Result pick_group(Strands *strands, uint32_t group, Error *error)
{
    Result result = strands_pick_group(strands, group, error);
    return result == RESULT_OK ? result : error_prefix(error, result, "--group: ");
}

// --- Steps that use a mesh.

// A warning is printed if half of the roots are farther than this from the mesh, m.
static const double FITS_BADLY = 0.01;

static const char *const MESH_STEPS[] = {"fit", "attach", "push-out"};

const char *convert_steps_need_mesh(const ConvertSteps *steps)
{
    for (int i = 0; i < steps->count; i++)
        if (steps->step[i].kind >= CONVERT_FIT)
            return MESH_STEPS[steps->step[i].kind - CONVERT_FIT];
    return NULL;
}

bool convert_steps_fit(const ConvertSteps *steps)
{
    for (int i = 0; i < steps->count; i++)
        if (steps->step[i].kind == CONVERT_FIT) return true;
    return false;
}

// How far a fit may turn hair, degrees. No start is turned, and a fit that ends farther has found
// another part of the mesh, such as the face.
static const double MOST_TURN = 45;

static Result check_turn(const StrandsFit *fit, Error *error)
{
    if (fit->turned_deg <= MOST_TURN) return RESULT_OK;
    return error_set(
        error, RESULT_BAD_INPUT,
        "--fit: the best fit turns the hair by %.3g degrees, which is not its place on "
        "a head: expected hair and mesh that face the same way (--up, --mesh-up, or "
        "--rotate before --fit)",
        fit->turned_deg);
}

static void tell_fit(const StrandsFit *fit, FILE *messages)
{
    fprintf(messages,
            "--fit: scaled by %.4g, turned by %.3g degrees, moved by %.4g mm: half of the roots "
            "lay within "
            "%.3g mm of the mesh, now within %.3g mm\n",
            fit->move.scale, fit->turned_deg, 1e3 * fit->moved, 1e3 * fit->before,
            1e3 * fit->after);
    if (fit->after > FITS_BADLY)
        fprintf(messages, "--fit: this is a bad fit: check that the mesh is a head, its "
                          "orientation (--rotate before --fit) and its unit (--mesh-unit)\n");
}

static Result fit(ConvertSteps *steps, Strands *strands, Error *error)
{
    if (!steps->has_fit) {
        Result result = strands_find_fit(&steps->fit, strands, steps->surface, error);
        if (result != RESULT_OK) return error_prefix(error, result, "--fit: ");
        TRY(check_turn(&steps->fit, error));
        if (steps->messages) tell_fit(&steps->fit, steps->messages);
        steps->has_fit = true;
    }
    strands_move(strands, &steps->fit.move);
    return RESULT_OK;
}

static Result attach(const ConvertSteps *steps, Strands *strands, Error *error)
{
    StrandsShift shift;
    TRY(strands_attach(strands, steps->surface, &shift, error));
    if (steps->messages)
        fprintf(steps->messages,
                "--attach: %u roots moved onto the mesh, half of them by at most %.3g mm, all by "
                "at most %.3g mm\n",
                shift.strands, 1e3 * shift.median, 1e3 * shift.most);
    return RESULT_OK;
}

static Result push_out(const ConvertSteps *steps, double gap, Strands *strands, Error *error)
{
    StrandsShift shift;
    TRY(strands_push_out(strands, steps->surface, gap, &shift, error));
    if (steps->messages)
        fprintf(steps->messages,
                "--push-out: %u of %u vertices of %u strands moved to %.3g mm from the mesh; those "
                "inside were up to "
                "%.3g mm deep, half of them up to %.3g mm\n",
                shift.vertices, strands->vertex_count, shift.strands, 1e3 * gap, 1e3 * shift.most,
                1e3 * shift.median);
    return RESULT_OK;
}

static Result apply(ConvertSteps *steps, const ConvertStep *step, Strands *strands, Error *error)
{
    switch (step->kind) {
    case CONVERT_FIT:
        return fit(steps, strands, error);
    case CONVERT_ATTACH:
        return attach(steps, strands, error);
    case CONVERT_PUSH_OUT:
        return push_out(steps, step->number, strands, error);
    case CONVERT_SUBSAMPLE:
        return strands_thin(strands, step->number, steps->seed, error);
    case CONVERT_NTH:
    case CONVERT_MIN_LENGTH:
        return pick(step, strands, error);
    case CONVERT_GROUP:
        return pick_group(strands, step->count, error);
    case CONVERT_RESAMPLE:
        return strands_resample(strands, &step->resample, error);
    case CONVERT_SMOOTH:
        strands_smooth(strands, step->count);
        return RESULT_OK;
    case CONVERT_MOVE:
        strands_move(strands, &step->move);
        return RESULT_OK;
    default:
        strands_reverse(strands);
        return RESULT_OK;
    }
}

Result convert_steps_apply(ConvertSteps *steps, Strands *strands, Error *error)
{
    Result result = RESULT_OK;
    for (int i = 0; i < steps->count && result == RESULT_OK; i++)
        result = apply(steps, &steps->step[i], strands, error);
    steps->messages = NULL; // messages are printed for the first frame only
    return result;
}
