// SPDX-License-Identifier: MIT
#include "formats/usd_transform.h"

#include "base/double3.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char INVERT[] = "!invert!", RESET[] = "!resetXformStack!", PREFIX[] = "xformOp:";

// --- Reading.

static UsdOp *find_op(const UsdTransform *transform, Reader *reader, const char *name)
{
    reader_work(reader, transform->op_count, 10);
    for (size_t i = 0; i < transform->op_count && reader_ok(reader); ++i)
        if (strcmp(transform->op[i].name, name) == 0) return &transform->op[i];
    return NULL;
}

// Whether `name` (after the prefix) is this operation, such as "translate" or "translate:pivot".
static bool is_kind(const char *name, const char *kind)
{
    size_t length = strlen(kind);
    return strncmp(name, kind, length) == 0 && (!name[length] || name[length] == ':');
}

// How many numbers a value has at most.
static uint32_t find_width(const char *name)
{
    const char *kind = name + strlen(PREFIX);
    if (is_kind(kind, "translate") || is_kind(kind, "scale")) return 3;
    if (is_kind(kind, "orient")) return 4;
    if (strncmp(kind, "rotate", 6) == 0) return strcspn(kind + 6, ":") == 1 ? 1 : 3;
    return 16;
}

static UsdOp *add_op(UsdTransform *transform, Reader *reader, const char *name)
{
    UsdOp *more = reader_realloc(reader, transform->op, transform->op_count + 1, sizeof *more);
    if (!more) return NULL;
    transform->op = more;
    more += transform->op_count++;
    *more = (UsdOp){.line = reader->line, .track.width = find_width(name)};
    snprintf(more->name, sizeof more->name, "%s", name);
    return more;
}

static void add_sample(UsdTrack *track, Reader *reader, double time)
{
    double value[16] = {0};
    if (track->count == track->room) {
        size_t room = 2 * track->room + 1;
        double *times = reader_realloc(reader, track->time, room, sizeof *times);
        if (times) track->time = times;
        double *values = reader_realloc(reader, track->value, room, track->width * sizeof *values);
        if (values) track->value = values;
        if (!times || !values) return;
        track->room = room;
    }
    if (track->count && track->timed && time <= track->time[track->count - 1])
        reader_fail(reader, "time sample %g: expected a time after that of the previous sample",
                    time);
    track->time[track->count] = time;
    usd_text_read_numbers(reader, value, (int)track->width);
    memcpy(track->value + track->count++ * track->width, value, track->width * sizeof *value);
}

void usd_transform_read_op(UsdTransform *transform, Reader *reader, const char *name, bool timed)
{
    UsdOp *op = find_op(transform, reader, name);
    if (!op) op = add_op(transform, reader, name);
    if (!op) return;
    if (op->track.timed && !timed) { // time samples override the default value
        usd_text_skip_value(reader);
        return;
    }
    op->track.count = 0;
    op->track.timed = timed;
    if (!timed) {
        if (usd_text_peek(reader, false) == 'N') // None
            usd_text_skip_value(reader);
        else
            add_sample(&op->track, reader, 0);
        return;
    }
    double time;
    usd_text_expect(reader, '{');
    while (usd_text_next_sample(reader, &time))
        if (usd_text_peek(reader, false) == 'N')
            usd_text_skip_value(reader);
        else
            add_sample(&op->track, reader, time);
}

void usd_transform_read_order(UsdTransform *transform, Reader *reader)
{
    transform->line = reader->line;
    transform->order_count = 0;
    usd_text_expect(reader, '[');
    while (reader_ok(reader) && !usd_text_take(reader, ']')) {
        char(*more)[USD_WORD_SIZE] =
            reader_realloc(reader, transform->order, transform->order_count + 1, sizeof *more);
        if (!more) return;
        transform->order = more;
        usd_text_read_string(reader, more[transform->order_count++]);
        usd_text_take(reader, ',');
    }
}

uint32_t usd_transform_count_empty(const UsdTransform *transform)
{
    uint32_t empty = 0;
    for (size_t i = 0; i < transform->order_count; ++i) {
        const char *name = transform->order[i];
        if (strncmp(name, INVERT, strlen(INVERT)) == 0) name += strlen(INVERT);
        bool found = strcmp(name, RESET) == 0;
        for (size_t k = 0; k < transform->op_count && !found; ++k)
            found = strcmp(transform->op[k].name, name) == 0 && transform->op[k].track.count > 0;
        empty += !found;
    }
    return empty;
}

void usd_transform_destroy(UsdTransform *transform)
{
    for (size_t i = 0; i < transform->op_count; ++i) {
        free(transform->op[i].track.time);
        free(transform->op[i].track.value);
    }
    free(transform->op);
    free(transform->order);
    free(transform->named);
    *transform = (UsdTransform){0};
}

// --- Matrices.

static void set_identity(double m[4][4])
{
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) m[i][j] = i == j;
}

void usd_transform_multiply(double to[4][4], double a[4][4], double b[4][4])
{
    double product[4][4];
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
            product[i][j] =
                a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j] + a[i][3] * b[3][j];
    memcpy(to, product, sizeof product);
}

// Gauss-Jordan elimination with partial pivoting. False if the matrix is singular.
static bool invert(double m[4][4])
{
    double inverse[4][4];
    set_identity(inverse);
    for (int k = 0; k < 4; ++k) {
        int best = k;
        for (int i = k + 1; i < 4; ++i)
            if (fabs(m[i][k]) > fabs(m[best][k])) best = i;
        if (!(fabs(m[best][k]) > 1e-300)) return false;
        for (int j = 0; j < 4; ++j) {
            double a = m[k][j], b = inverse[k][j];
            m[k][j] = m[best][j];
            m[best][j] = a;
            inverse[k][j] = inverse[best][j];
            inverse[best][j] = b;
        }
        double pivot = m[k][k];
        for (int j = 0; j < 4; ++j) m[k][j] /= pivot, inverse[k][j] /= pivot;
        for (int i = 0; i < 4; ++i) {
            double factor = m[i][k];
            for (int j = 0; j < 4 && i != k; ++j) {
                m[i][j] -= factor * m[k][j];
                inverse[i][j] -= factor * inverse[k][j];
            }
        }
    }
    memcpy(m, inverse, sizeof inverse);
    return true;
}

static void rotate(double m[4][4], int axis, double degrees)
{
    double turn[4][4], angle = degrees * acos(-1) / 180;
    int a = (axis + 1) % 3, b = (axis + 2) % 3;
    set_identity(turn);
    turn[a][a] = turn[b][b] = cos(angle);
    turn[a][b] = sin(angle);
    turn[b][a] = -sin(angle);
    usd_transform_multiply(m, m, turn);
}

// `q` is w, x, y, z.
static void set_orientation(double m[4][4], const double q[4])
{
    double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!(length > 0)) return;
    const double unit[4] = {q[1] / length, q[2] / length, q[3] / length, q[0] / length};
    double rows[3][3];
    double3_rotation(unit, rows);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) m[i][j] = rows[j][i];
}

// --- Values at a time.

static void mix_orientations(double to[4], const double a[4], const double b[4], double share)
{
    double dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3], sign = dot < 0 ? -1 : 1;
    double angle = acos(fmin(fabs(dot), 1)), from = 1 - share, over = share;
    if (angle > 1e-6) {
        from = sin((1 - share) * angle) / sin(angle);
        over = sin(share * angle) / sin(angle);
    }
    for (int k = 0; k < 4; ++k) to[k] = from * a[k] + sign * over * b[k];
}

static void value_at(const UsdTrack *track, double time, bool orientation, double value[16])
{
    size_t next = 0, end = track->timed ? track->count : 0;
    const size_t width = track->width;
    while (next < end) { // the first one that is not earlier
        size_t middle = next + (end - next) / 2;
        if (track->time[middle] < time)
            next = middle + 1;
        else
            end = middle;
    }
    if (next == 0 || next == track->count) {
        memcpy(value, track->value + (next == 0 ? 0 : next - 1) * width, width * sizeof *value);
        return;
    }
    const double *a = track->value + (next - 1) * width, *b = a + width;
    double share = (time - track->time[next - 1]) / (track->time[next] - track->time[next - 1]);
    for (size_t k = 0; k < width; ++k) value[k] = share < 1 ? a[k] + share * (b[k] - a[k]) : b[k];
    if (orientation && share < 1) mix_orientations(value, a, b, share);
}

static bool set_matrix(double m[4][4], const char *kind, const UsdTrack *track, double time)
{
    double v[16] = {0};
    value_at(track, time, is_kind(kind, "orient"), v);
    set_identity(m);
    if (is_kind(kind, "translate")) {
        memcpy(m[3], v, 3 * sizeof *v);
    } else if (is_kind(kind, "scale")) {
        for (int k = 0; k < 3; ++k) m[k][k] = v[k];
    } else if (is_kind(kind, "orient")) {
        set_orientation(m, v);
    } else if (is_kind(kind, "transform")) {
        memcpy(m, v, sizeof v);
    } else if (strncmp(kind, "rotate", 6) == 0) {
        const char *axes = kind + 6;
        size_t count = strcspn(axes, ":");
        bool seen[3] = {false};
        if (count != 1 && count != 3) return false;
        for (size_t i = 0; i < count; ++i) {
            int axis = axes[i] - 'X';
            if (axis < 0 || axis > 2 || seen[axis]) return false;
            seen[axis] = true;
            rotate(m, axis, v[count == 1 ? 0 : axis]);
        }
    } else {
        return false;
    }
    return true;
}

// Finds the operations that the order names.
static void find_named(UsdTransform *transform, Reader *reader)
{
    transform->still = true;
    if (transform->named || !transform->order_count) return;
    transform->named = reader_calloc(reader, transform->order_count, sizeof *transform->named);
    for (size_t i = 0; transform->named && i < transform->order_count; ++i) {
        const char *name = transform->order[i];
        if (strncmp(name, INVERT, strlen(INVERT)) == 0) name += strlen(INVERT);
        if (strcmp(name, RESET) != 0) transform->named[i] = find_op(transform, reader, name);
    }
    for (size_t i = 0; transform->named && i < transform->order_count; ++i) {
        const UsdOp *op = transform->named[i];
        transform->still = transform->still && !(op && op->track.timed && op->track.count > 1);
    }
}

void usd_transform_evaluate(UsdTransform *transform, Reader *reader, double time,
                            double matrix[4][4], bool *reset)
{
    set_identity(matrix);
    *reset = false;
    if (!transform->named) find_named(transform, reader);
    reader_work(reader, transform->order_count, 200);
    for (size_t i = 0; i < transform->order_count && reader_ok(reader); ++i) {
        const char *name = transform->order[i];
        bool inverse = strncmp(name, INVERT, strlen(INVERT)) == 0;
        double step[4][4];
        if (strcmp(name, RESET) == 0) {
            set_identity(matrix);
            *reset = true;
            continue;
        }
        if (inverse) name += strlen(INVERT);
        const UsdOp *op = transform->named[i];
        reader->line = op ? op->line : transform->line;
        if ((!op || op->track.count == 0) && strncmp(name, PREFIX, strlen(PREFIX)) == 0)
            continue; // the identity, as UsdGeomXformOp::GetOpTransform has it
        if (strncmp(name, PREFIX, strlen(PREFIX)) != 0 ||
            !set_matrix(step, name + strlen(PREFIX), &op->track, time))
            reader_fail(reader, "'%.60s': unknown kind of transform", name);
        else if (inverse && !invert(step))
            reader_fail(reader, "'%.60s' has no inverse", name);
        else
            usd_transform_multiply(matrix, step, matrix);
    }
}
