// SPDX-License-Identifier: MIT
#include "bench/image_reference.h"
#include "base/parallel.h"
#include "bench/image_shapes.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

// A sub-sample that lies inside a shape.
typedef struct Hit {
    uint32_t sample; // of the row of pixels: sub-row, then column
    uint32_t shape;
    float inverse_w;
    float color[4]; // premultiplied
} Hit;

// The sub-samples of one row of pixels.
typedef struct Row {
    Hit *hits;
    size_t count, room;
    Hit *sorted;     // by sub-sample; as much room as hits
    uint32_t *first; // [samples + 1]
    int width, side, row;
} Row;

static Result make_room(Row *row, size_t more, Error *error)
{
    if (row->count + more <= row->room) return RESULT_OK;
    size_t room = 2 * (row->count + more);
    Hit *hits = realloc(row->hits, room * sizeof *hits);
    if (hits) row->hits = hits;
    Hit *sorted = realloc(row->sorted, room * sizeof *sorted);
    if (sorted) row->sorted = sorted;
    if (!hits || !sorted)
        return error_set(error, RESULT_FAILED, "no memory for %zu sub-samples", room);
    row->room = room;
    return RESULT_OK;
}

// Where the shape's outline crosses the horizontal line at y, ascending. An edge takes its lower
// end but not its upper one, so that shapes with a common edge share out the line between them.
static int find_crossings(const Shape *shape, double y, double crossing[4])
{
    int count = 0;
    for (int i = 0; i < shape->corners; ++i) {
        const double *a = shape->corner[i], *b = shape->corner[(i + 1) % shape->corners];
        if (a[1] > b[1]) { // the same sum for both shapes at an edge
            const double *other = a;
            a = b, b = other;
        }
        if (y < a[1] || y >= b[1]) continue;
        double x = a[0] + (b[0] - a[0]) * ((y - a[1]) / (b[1] - a[1]));
        int at = count++;
        for (; at > 0 && crossing[at - 1] > x; --at) crossing[at] = crossing[at - 1];
        crossing[at] = x;
    }
    return count;
}

static double plane_at(const ShapePlane *plane, double x, double y)
{
    double value = plane->base + plane->dx * x + plane->dy * y;
    return fmin(fmax(value, plane->low), plane->high);
}

static void add_hit(Row *row, const Shape *shape, uint32_t number, uint32_t sample, double x,
                    double y)
{
    Hit *hit = &row->hits[row->count++];
    hit->sample = sample;
    hit->shape = number;
    hit->inverse_w = (float)plane_at(&shape->inverse_w, x, y);
    for (int k = 0; k < 3; ++k)
        hit->color[k] = (float)(shape->opacity * plane_at(&shape->color[k], x, y));
    hit->color[3] = (float)shape->opacity;
}

static Result add_shape(Row *row, const Shape *shape, uint32_t number, Error *error)
{
    for (int i = 0; i < row->side; ++i) {
        double y = row->row + (i + 0.5) / row->side, crossing[4];
        int count = find_crossings(shape, y, crossing);
        for (int c = 0; c + 1 < count; c += 2) {
            // Sub-sample k lies at (k + 1/2) / side.
            int most = row->width * row->side;
            int from = (int)fmin(fmax(ceil(crossing[c] * row->side - 0.5), 0), most);
            int to = (int)fmin(fmax(ceil(crossing[c + 1] * row->side - 0.5), 0), most);
            if (from >= to) continue;
            Result result = make_room(row, (size_t)(to - from), error);
            if (result != RESULT_OK) return result;
            for (int k = from; k < to; ++k)
                add_hit(row, shape, number, (uint32_t)(i * most + k), (k + 0.5) / row->side, y);
        }
    }
    return RESULT_OK;
}

// Far to near; of two at the same depth the later shape is the farther one.
static bool is_farther(const Hit *a, const Hit *b)
{
    return a->inverse_w < b->inverse_w || (a->inverse_w == b->inverse_w && a->shape > b->shape);
}

static void sort_by_sample(Row *row)
{
    uint32_t samples = (uint32_t)(row->width * row->side * row->side);
    memset(row->first, 0, (samples + 1) * sizeof *row->first);
    for (size_t i = 0; i < row->count; ++i) ++row->first[row->hits[i].sample + 1];
    for (uint32_t s = 0; s < samples; ++s) row->first[s + 1] += row->first[s];
    for (size_t i = 0; i < row->count; ++i) // counts `first` up to the next one's
        row->sorted[row->first[row->hits[i].sample]++] = row->hits[i];
    memmove(row->first + 1, row->first, samples * sizeof *row->first);
    row->first[0] = 0;
    for (uint32_t s = 0; s < samples; ++s)
        for (uint32_t i = row->first[s] + 1; i < row->first[s + 1]; ++i) {
            Hit hit = row->sorted[i];
            uint32_t at = i;
            for (; at > row->first[s] && is_farther(&hit, &row->sorted[at - 1]); --at)
                row->sorted[at] = row->sorted[at - 1];
            row->sorted[at] = hit;
        }
}

// Mean over the pixel, linear and premultiplied.
static void average_pixel(const Row *row, int x, const double background[4], double mean[4])
{
    memset(mean, 0, 4 * sizeof *mean);
    for (int i = 0; i < row->side * row->side; ++i) {
        int sample = i / row->side * row->width * row->side + x * row->side + i % row->side;
        double color[4];
        memcpy(color, background, sizeof color);
        for (uint32_t h = row->first[sample]; h < row->first[sample + 1]; ++h)
            for (int k = 3; k >= 0; --k)
                color[k] = row->sorted[h].color[k] + (1 - row->sorted[h].color[3]) * color[k];
        for (int k = 0; k < 4; ++k) mean[k] += color[k] / (row->side * row->side);
    }
}

static void write_row(const Row *row, const double background[4], Image *image)
{
    for (int x = 0; x < image->width; ++x) {
        double mean[4];
        uint8_t *pixel = image->pixels + ((size_t)row->row * (size_t)image->width + (size_t)x) *
                                             (size_t)image->channels;
        average_pixel(row, x, background, mean);
        double alpha = image->channels == 4 ? mean[3] : 1;
        for (int k = 0; k < 3; ++k)
            pixel[k] = (uint8_t)lrint(255 * image_srgb_from_linear(mean[k] / fmax(alpha, 1e-9)));
        if (image->channels == 4) pixel[3] = (uint8_t)lrint(255 * fmin(alpha, 1));
    }
}

// A picture that is being drawn: rows of pixels are dealt out to the threads in turn, and no row
// knows of another.
typedef struct Drawing {
    const Shapes *shapes;
    const double *background; // [4], linear, premultiplied
    Image *image;
    int side, parts;
    Result results[PARALLEL_MOST];
    Error errors[PARALLEL_MOST];
} Drawing;

static Result draw_row(Row *row, const Drawing *drawing, Error *error)
{
    const Shapes *shapes = drawing->shapes;
    row->count = 0;
    for (uint32_t i = 0; i < shapes->count; ++i) {
        const Shape *shape = &shapes->shapes[i];
        if (shape->top >= row->row + 1 || shape->bottom <= row->row) continue;
        Result result = add_shape(row, shape, i, error);
        if (result != RESULT_OK) return result;
    }
    sort_by_sample(row);
    write_row(row, drawing->background, drawing->image);
    return RESULT_OK;
}

static void draw_part(void *data, int part)
{
    Drawing *drawing = data;
    Error *error = &drawing->errors[part];
    Row row = {.width = drawing->image->width, .side = drawing->side};
    size_t samples = (size_t)row.width * (size_t)row.side * (size_t)row.side;
    row.first = malloc((samples + 1) * sizeof *row.first);
    Result result = row.first
                        ? RESULT_OK
                        : error_set(error, RESULT_FAILED, "no memory for %zu sub-samples", samples);
    for (row.row = part; row.row < drawing->image->height && result == RESULT_OK;
         row.row += drawing->parts)
        result = draw_row(&row, drawing, error);
    free(row.hits);
    free(row.sorted);
    free(row.first);
    drawing->results[part] = result;
}

Result image_reference_draw(Image *image, const ReferenceScene *scene, int side, Error *error)
{
    Shapes shapes = {0};
    double background[4] = {[3] = scene->background[3]};
    for (int k = 0; k < 3; ++k)
        background[k] = image_linear_from_srgb(scene->background[k]) * scene->background[3];
    Drawing drawing = {.shapes = &shapes,
                       .background = background,
                       .image = image,
                       .side = side,
                       .parts = scene->threads ? scene->threads : parallel_threads()};
    Result result = shapes_create(&shapes, scene, image->width, image->height, error);
    if (result == RESULT_OK) parallel_run(drawing.parts, draw_part, &drawing);
    for (int i = 0; i < drawing.parts && result == RESULT_OK; ++i)
        if ((result = drawing.results[i]) != RESULT_OK) *error = drawing.errors[i];
    shapes_destroy(&shapes);
    return result;
}
