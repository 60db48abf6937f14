// SPDX-License-Identifier: MIT
#include "formats/alembic.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// --- Transforms.

typedef enum Step { SCALE, TRANSLATE, ROTATE, MATRIX, ROTATE_X, ROTATE_Y, ROTATE_Z, STEPS } Step;

static const uint32_t STEP_WIDTHS[STEPS] = {3, 3, 4, 16, 1, 1, 1};

static void read_transform(Ogawa *file, const OgawaObject *object, AlembicTransform *transform)
{
    Reader *reader = file->reader;
    OgawaProperties own = ogawa_compound(file, &object->own, ".xform");
    const OgawaProperty *inherits = ogawa_find(&own, ".inherits"),
                        *steps = ogawa_find(&own, ".ops");
    const OgawaProperty *values = ogawa_find(&own, ".vals");
    size_t count;
    double *number =
        inherits && inherits->samples ? ogawa_numbers(file, inherits, 0, &count) : NULL;
    transform->resets = number && count > 0 && number[0] == 0;
    free(number);
    number = steps && steps->samples && values && values->samples
                 ? ogawa_numbers(file, steps, 0, &count)
                 : NULL;
    for (size_t i = 0; number && i < count && reader_ok(reader); ++i) {
        uint32_t step = number[i] >= 0 && number[i] < 256 ? (uint32_t)number[i] >> 4 : STEPS;
        if (step >= STEPS || i >= sizeof transform->step)
            reader_fail(reader,
                        "%s: operation %zu of a transform is unknown, or beyond the limit of %zu "
                        "operations",
                        object->path, i, sizeof transform->step);
        else
            transform->step[transform->step_count++] = (uint8_t)step,
            transform->width += STEP_WIDTHS[step];
    }
    bool moves = number && transform->width > 0;
    free(number);
    uint32_t samples = moves ? values->last ? values->samples : 1 : 0;
    if (moves)
        transform->value =
            reader_malloc(reader, (uint64_t)samples * transform->width, sizeof *transform->value);
    for (uint32_t i = 0; i < samples && reader_ok(reader); ++i) {
        number = ogawa_numbers(file, values, i, &count);
        if (number && count < transform->width)
            reader_fail(reader, "%s: a transform has %zu numbers: expected %u", object->path, count,
                        transform->width);
        else if (number)
            memcpy(transform->value + (size_t)i * transform->width, number,
                   transform->width * sizeof *number);
        free(number);
    }
    transform->samples = samples;
    transform->sampling = values ? values->sampling : 0;
    ogawa_free(&own);
}

static void set_identity(double m[4][4])
{
    for (int i = 0; i < 16; ++i) m[i / 4][i % 4] = i / 4 == i % 4;
}

// to = a b
static void multiply(double to[4][4], double a[4][4], double b[4][4])
{
    double product[4][4];
    for (int i = 0; i < 16; ++i) {
        double sum = 0;
        for (int k = 0; k < 4; ++k) sum += a[i / 4][k] * b[k][i % 4];
        product[i / 4][i % 4] = sum;
    }
    memcpy(to, product, sizeof product);
}

// A rotation about an axis (Rodrigues' formula) for row vectors.
static void rotate(double m[4][4], const double axis[3], double degrees)
{
    double length = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
    if (!(length > 0)) return;
    double angle = degrees * acos(-1) / 180, c = cos(angle), s = sin(angle);
    double a[3] = {axis[0] / length, axis[1] / length, axis[2] / length};
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            m[i][k] = (i == k ? c : 0) + (1 - c) * a[i] * a[k] +
                      (i == k ? 0 : s * ((k - i + 3) % 3 == 1 ? 1 : -1) * a[3 - i - k]);
}

static void step_matrix(double m[4][4], Step step, const double *v)
{
    set_identity(m);
    if (step == SCALE)
        for (int i = 0; i < 3; ++i) m[i][i] = v[i];
    if (step == TRANSLATE) memcpy(m[3], v, 3 * sizeof *v);
    if (step == MATRIX) memcpy(m, v, 16 * sizeof *v);
    if (step == ROTATE) rotate(m, v, v[3]);
    if (step >= ROTATE_X)
        rotate(m, (const double[3]){step == ROTATE_X, step == ROTATE_Y, step == ROTATE_Z}, v[0]);
}

// The last step in the list is applied first.
static void transform_matrix(const Ogawa *file, const AlembicTransform *transform, double time,
                             double m[4][4])
{
    uint32_t a, b, width = transform->width;
    set_identity(m);
    if (!transform->value) return;
    double share = ogawa_around(file, transform->sampling, transform->samples, time, &a, &b);
    const double *from = transform->value + (size_t)a * width,
                 *to = transform->value + (size_t)b * width;
    for (uint32_t i = 0, at = 0; i < transform->step_count;
         at += STEP_WIDTHS[transform->step[i++]]) {
        double v[16], one[4][4];
        for (uint32_t k = 0; k < STEP_WIDTHS[transform->step[i]]; ++k)
            v[k] = share > 0 ? from[at + k] + share * (to[at + k] - from[at + k]) : from[at + k];
        step_matrix(one, (Step)transform->step[i], v);
        multiply(m, one, m);
    }
}

// The object's place in the world at a time; NULL after an error. Remembers it, since many objects
// lie below one transform, and most transforms do not change.
static AlembicWorld *find_world(const Alembic *alembic, int object, double time)
{
    Reader *reader = alembic->file.reader;
    AlembicTransform *transform = &alembic->transform[object];
    AlembicWorld *world = transform->world;
    if (world && (world->still || world->time == time)) return world;
    if (!world) world = transform->world = reader_calloc(reader, 1, sizeof *world);
    if (!world) return NULL;
    if (!world->own_known) {
        if (!reader_work(reader, transform->step_count + 1u, 200)) return NULL;
        transform_matrix(&alembic->file, transform, time, world->own);
        world->own_known = transform->samples < 2;
    }
    world->time = time;
    world->still = world->own_known;
    memcpy(world->matrix, world->own, sizeof world->own);
    int parent = alembic->file.object[object].parent;
    if (transform->resets || parent < 0) return world;
    AlembicWorld *above = find_world(alembic, parent, time);
    if (!above) return NULL;
    multiply(world->matrix, world->own, above->matrix);
    world->still = world->still && above->still;
    return world;
}

void alembic_matrix(const Alembic *alembic, int object, double time, double matrix[4][4])
{
    bool good = reader_work(alembic->file.reader, 64, 50); // its parents
    const AlembicWorld *world = good ? find_world(alembic, object, time) : NULL;
    if (world)
        memcpy(matrix, world->matrix, sizeof world->matrix);
    else
        memset(matrix, 0, 16 * sizeof(double));
}

void alembic_longest(const Alembic *alembic, int object, uint32_t *sampling, uint32_t *count)
{
    for (; object >= 0; object = alembic->file.object[object].parent) {
        const AlembicTransform *transform = &alembic->transform[object];
        if (transform->samples > *count) {
            *count = transform->samples;
            *sampling = transform->sampling;
        }
        if (transform->resets) break;
    }
}

// --- Objects.

typedef enum Shown { SHOWN_INHERITED, SHOWN_ALWAYS, SHOWN_NEVER } Shown;

// What an object itself says: its nearest explicit value decides (AbcGeom's IsAncestorInvisible),
// and what is visible in any sample is visible.
static Shown find_shown(Ogawa *file, const OgawaObject *object)
{
    const OgawaProperty *visible = ogawa_find(&object->own, "visible");
    uint32_t samples = visible ? visible->last ? visible->samples : visible->samples > 0 : 0;
    Shown shown = SHOWN_INHERITED;
    for (uint32_t i = 0; i < samples && shown != SHOWN_ALWAYS; ++i) {
        size_t count = 0;
        double *number = ogawa_numbers(file, visible, i, &count);
        double value = number && count > 0 ? number[0] : -1;
        free(number);
        if (value > 0) shown = SHOWN_ALWAYS;
        if (value == 0) shown = SHOWN_NEVER;
        if (value < 0) return SHOWN_INHERITED;
    }
    return shown;
}

static void read_own(Alembic *alembic, int i)
{
    Ogawa *file = &alembic->file;
    const OgawaObject *object = &file->object[i];
    Shown shown = find_shown(file, object);
    bool above = object->parent >= 0 && alembic->hidden[object->parent];
    alembic->hidden[i] = shown == SHOWN_NEVER || (shown == SHOWN_INHERITED && above);
    if (strncmp(object->schema, "AbcGeom_Xform", 13) == 0)
        read_transform(file, object, &alembic->transform[i]);
}

// --- Instances. An object with the property .instanceSource stands for the object of this path and
// all below it, under the instance's own parents. It becomes copies of these objects, which read
// the same properties.

enum { DEEPEST_INSTANCE = 8 };

static int find_path(Ogawa *file, const char *path, int originals)
{
    if (!reader_work(file->reader, (uint64_t)originals, 20)) return -1;
    for (int i = 0; i < originals; ++i)
        if (strcmp(file->object[i].path, path) == 0) return i;
    return -1;
}

static void expand(Ogawa *file, int instance, int originals, int depth);

// Adds a copy of object `of`, at another path, and of those below it.
static void copy_tree(Ogawa *file, int of, int parent, const char *path, int originals, int depth)
{
    int number = ogawa_add_copy(file, of, parent, path);
    if (number < 0 || !reader_work(file->reader, (uint64_t)originals, 10)) return;
    expand(file, number, originals, depth);
    for (int i = of + 1; i < originals && reader_ok(file->reader); ++i) {
        if (file->object[i].parent != of) continue;
        char name[2 * OGAWA_PATH_SIZE];
        const char *last = strrchr(file->object[i].path, '/');
        snprintf(name, sizeof name, "%s%s", file->object[number].path, last ? last : "");
        copy_tree(file, i, number, name, originals, depth);
    }
}

static void expand(Ogawa *file, int instance, int originals, int depth)
{
    const OgawaProperty *source = ogawa_find(&file->object[instance].own, ".instanceSource");
    size_t count;
    char *path = source ? ogawa_texts(file, source, &count) : NULL;
    if (!path) return;
    int of = find_path(file, path, originals), above = instance;
    if (depth >= DEEPEST_INSTANCE)
        reader_fail(file->reader, "%s: instances of instances more than %d deep",
                    file->object[instance].path, DEEPEST_INSTANCE);
    while (above >= 0 && above != of) above = file->object[above].parent;
    if (of >= 0 && above == of)
        reader_fail(file->reader, "%s: an instance of its own parent", file->object[instance].path);
    char name[OGAWA_PATH_SIZE];
    snprintf(name, sizeof name, "%s", file->object[instance].path);
    if (of >= 0 && reader_ok(file->reader))
        copy_tree(file, of, file->object[instance].parent, name, originals, depth + 1);
    else
        file->lost_instances++;
    free(path);
}

Result alembic_open(Alembic *alembic, Reader *reader)
{
    Ogawa *file = &alembic->file;
    *alembic = (Alembic){0};
    TRY(ogawa_open(file, reader));
    const int originals = file->count;
    for (int i = 0; i < originals && reader_ok(reader); ++i) expand(file, i, originals, 0);
    alembic->transform = reader_calloc(reader, (size_t)file->count + 1, sizeof *alembic->transform);
    alembic->hidden = reader_calloc(reader, (size_t)file->count + 1, sizeof *alembic->hidden);
    if (!alembic->transform || !alembic->hidden) return reader_fail_memory(reader);
    for (int i = 0; i < file->count && reader_ok(reader); ++i) read_own(alembic, i);
    return reader->result;
}

void alembic_close(Alembic *alembic)
{
    for (int i = 0; alembic->transform && i < alembic->file.count; ++i) {
        free(alembic->transform[i].value);
        free(alembic->transform[i].world);
    }
    free(alembic->transform);
    free(alembic->hidden);
    ogawa_close(&alembic->file);
    *alembic = (Alembic){0};
}
