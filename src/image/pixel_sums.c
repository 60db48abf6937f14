// SPDX-License-Identifier: MIT
#include "image/pixel_sums.h"

#include "image/float_image.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// A window has 2 x 2 cells.
enum { CELL = SUMS_WINDOW / 2 };

typedef struct Scan {
    PixelSums *sums;
    const Mask *mask;
    double tolerance;
    int width, cells;    // cells: in a row
    double (*cell)[3];   // [2][cells + 1] sums of differences; the last one of a row stays 0
    double (*row[2])[3]; // the two rows of cells, the upper one first
} Scan;

static Result start(Scan *scan, Error *error)
{
    scan->cells = (scan->width + CELL - 1) / CELL;
    size_t count = 2 * ((size_t)scan->cells + 1);
    scan->cell = calloc(count, sizeof *scan->cell);
    if (!scan->cell) return error_set(error, RESULT_FAILED, "no memory to compare images");
    scan->row[0] = scan->cell, scan->row[1] = scan->cell + count / 2;
    return RESULT_OK;
}

// Adds the differences of pixel x, y.
static void add_pixel(Scan *scan, int x, int y, const double difference[3])
{
    PixelSums *sums = scan->sums;
    double largest = 0, *cell = scan->row[1][x / CELL];
    for (int k = 0; k < 3; ++k) {
        sums->squares += difference[k] * difference[k];
        largest = fabs(difference[k]) > largest ? fabs(difference[k]) : largest;
        cell[k] += difference[k];
    }
    sums->failing += largest > scan->tolerance;
    if (largest <= sums->largest) return;
    sums->largest = largest;
    sums->at[0] = x, sums->at[1] = y;
}

static bool counts(const Scan *scan, int x, int y)
{
    return mask_counts(scan->mask, (size_t)y * (size_t)scan->width + (size_t)x);
}

static void add_bytes(Scan *scan, const uint8_t *a, const uint8_t *b, int y)
{
    if (memcmp(a, b, 3 * (size_t)scan->width) == 0) return;
    for (int x = 0; x < scan->width; ++x, a += 3, b += 3) {
        const int difference[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
        if (!(difference[0] | difference[1] | difference[2]) || !counts(scan, x, y)) continue;
        add_pixel(scan, x, y, (double[3]){difference[0], difference[1], difference[2]});
    }
}

static void add_floats(Scan *scan, const float *a, const float *b, int y)
{
    if (memcmp(a, b, 3 * (size_t)scan->width * sizeof *a) == 0) return;
    for (int x = 0; x < scan->width; ++x, a += 3, b += 3) {
        double difference[3];
        if (memcmp(a, b, 3 * sizeof *a) == 0 || !counts(scan, x, y)) continue;
        for (int k = 0; k < 3; ++k) difference[k] = (double)a[k] - (double)b[k];
        add_pixel(scan, x, y, difference);
    }
}

// Ends a row of cells, whose first pixels have this y: the windows that it completes.
static void end_cells(Scan *scan, int y)
{
    PixelSums *sums = scan->sums;
    double(*above)[3] = scan->row[0], (*below)[3] = scan->row[1];
    for (int c = 0; c < scan->cells; ++c)
        for (int k = 0; k < 3; ++k) {
            double sum = above[c][k] + above[c + 1][k] + below[c][k] + below[c + 1][k];
            double local = fabs(sum) / (SUMS_WINDOW * SUMS_WINDOW);
            if (local <= sums->local) continue;
            sums->local = local;
            sums->local_at[0] = c * CELL, sums->local_at[1] = y < CELL ? 0 : y - CELL;
        }
    scan->row[0] = below, scan->row[1] = above;
    memset(above, 0, (size_t)scan->cells * sizeof *above);
}

static bool are_equal(const Image *a, const Image *b, int y, int rows)
{
    size_t row = (size_t)a->width * (size_t)a->channels * image_channel_size(a->kind);
    return a->kind == b->kind && a->channels == b->channels &&
           memcmp(a->pixels + (size_t)y * row, b->pixels + (size_t)y * row, (size_t)rows * row) ==
               0;
}

// Adds the rows of one row of cells.
static Result add_rows(Scan *scan, const Image *a, const Image *b, float level, int y, int rows,
                       Error *error)
{
    const ImageArea area = {0, y, a->width, rows};
    bool bytes = a->kind == IMAGE_8 && b->kind == IMAGE_8 && a->channels == 3 && b->channels == 3;
    size_t row = 3 * (size_t)a->width;
    FloatImage p = {0}, q = {0};
    Result result = RESULT_OK;
    if (are_equal(a, b, y, rows)) {
        end_cells(scan, y);
        return RESULT_OK;
    }
    if (!bytes) {
        result = float_image_create_area(&p, a, NULL, level, area, error);
        THEN(result, float_image_create_area(&q, b, NULL, level, area, error));
    }
    for (int i = 0; i < rows && result == RESULT_OK; ++i) {
        if (bytes)
            add_bytes(scan, a->pixels + (size_t)(y + i) * row, b->pixels + (size_t)(y + i) * row,
                      y + i);
        else
            add_floats(scan, p.rgb + (size_t)i * row, q.rgb + (size_t)i * row, y + i);
    }
    end_cells(scan, y);
    float_image_destroy(&p);
    float_image_destroy(&q);
    return result;
}

Result pixel_sums_find(PixelSums *sums, const Image *a, const Image *b, const Mask *mask,
                       float level, double tolerance, Error *error)
{
    Scan scan = {.sums = sums, .mask = mask, .tolerance = tolerance, .width = a->width};
    *sums = (PixelSums){0};
    TRY(start(&scan, error));
    Result result = RESULT_OK;
    for (int y = 0; y < a->height && result == RESULT_OK; y += CELL)
        result =
            add_rows(&scan, a, b, level, y, a->height - y < CELL ? a->height - y : CELL, error);
    free(scan.cell);
    return result;
}
