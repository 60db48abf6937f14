// SPDX-License-Identifier: MIT
#include "bench/light_case.h"
#include "base/csv.h"
#include "base/outfile.h"

#include <glob.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { MOST_BLOCKS = 2048 }; // in a row or column, for images of up to 16384 px

static const char *const COLUMNS[LIGHT_TABLES][3] = {
    {"one_r", "one_g", "one_b"}, {"all_r", "all_g", "all_b"}, {"coverage", "coverage", "coverage"}};

// --- The table.

static Result read_place(const Csv *csv, size_t line, const char *name, int *place, Error *error)
{
    size_t column;
    double value;
    TRY(csv_find(csv, name, &column, error));
    TRY(csv_number(csv, line, column, &value, error));
    if (!(value >= 0 && value < MOST_BLOCKS) || value != floor(value))
        return error_set(error, RESULT_BAD_INPUT, "%s:%zu: %s: got %s, expected 0 to %d", csv->path,
                         line + 2, name, csv_text(csv, line, column), MOST_BLOCKS - 1);
    *place = (int)value;
    return RESULT_OK;
}

// Finds the number of columns and rows of blocks. Each block must have a line.
static Result find_size(LightCase *lit, const Csv *csv, Error *error)
{
    for (size_t line = 0; line < csv->row_count; ++line) {
        int column, row;
        TRY(read_place(csv, line, "column", &column, error));
        TRY(read_place(csv, line, "row", &row, error));
        if (lit->columns <= column) lit->columns = column + 1;
        if (lit->rows <= row) lit->rows = row + 1;
    }
    if (csv->row_count == 0 || csv->row_count != (size_t)lit->columns * (size_t)lit->rows)
        return error_set(error, RESULT_BAD_INPUT,
                         "%s: got %zu lines, expected one for each of %d x %d blocks", csv->path,
                         csv->row_count, lit->columns, lit->rows);
    return RESULT_OK;
}

// Reads one channel of a table; at least one block must have light. The upper limit of a block
// keeps squares finite.
static Result read_channel(LightCase *lit, const Csv *csv, LightTable table, int channel,
                           Error *error)
{
    const char *name = COLUMNS[table][channel];
    const double most = table == LIGHT_COVERAGE ? 1 : 1e6;
    size_t column;
    double sum = 0;
    TRY(csv_find(csv, name, &column, error));
    for (size_t line = 0; line < csv->row_count; ++line) {
        double value;
        int x, y;
        TRY(read_place(csv, line, "column", &x, error));
        TRY(read_place(csv, line, "row", &y, error));
        TRY(csv_number(csv, line, column, &value, error));
        if (!(value >= 0 && value <= most))
            return error_set(error, RESULT_BAD_INPUT, "%s:%zu: %s: got %s, expected 0 to %g",
                             csv->path, line + 2, name, csv_text(csv, line, column), most);
        double *block = &lit->blocks[table][(size_t)y * (size_t)lit->columns + (size_t)x][channel];
        if (!isnan(*block))
            return error_set(
                error, RESULT_BAD_INPUT,
                "%s:%zu: a second line for block %d, %d: expected one line for each block",
                csv->path, line + 2, x, y);
        *block = value;
        sum += value;
    }
    if (!(sum > 0))
        return error_set(error, RESULT_BAD_INPUT,
                         "%s: %s is 0 in every block: expected light in one block or more",
                         csv->path, name);
    return RESULT_OK;
}

static Result read_blocks(LightCase *lit, const Csv *csv, Error *error)
{
    TRY(find_size(lit, csv, error));
    for (int table = 0; table < LIGHT_TABLES; ++table) {
        double(*blocks)[3] = malloc(csv->row_count * sizeof *blocks);
        lit->blocks[table] = blocks;
        if (!blocks)
            return error_set(error, RESULT_FAILED, "no memory for %zu blocks", csv->row_count);
        for (size_t i = 0; i < 3 * csv->row_count; ++i) blocks[i / 3][i % 3] = NAN;
        for (int channel = 0; channel < 3; ++channel)
            TRY(read_channel(lit, csv, (LightTable)table, channel, error));
    }
    return RESULT_OK;
}

// --- Folders.

static Result read_case(LightCase *lit, const char *scene, Error *error)
{
    const char *slash = strrchr(scene, '/'), *first = slash ? slash + 1 : scene;
    int length = (int)strlen(scene) - (int)strlen(".json");
    lit->scene = strdup(scene);
    lit->name = strndup(first, (size_t)(length - (first - scene)));
    if (!lit->scene || !lit->name || asprintf(&lit->table, "%.*s.csv", length, scene) < 0) {
        lit->table = NULL;
        return error_set(error, RESULT_FAILED, "no memory for %s", scene);
    }
    if (access(lit->table, F_OK) != 0) return RESULT_OK;
    Csv csv;
    TRY(csv_read(&csv, lit->table, error));
    Result result = read_blocks(lit, &csv, error);
    csv_destroy(&csv);
    return result;
}

static void destroy_case(LightCase *lit)
{
    for (int table = 0; table < LIGHT_TABLES; ++table) free(lit->blocks[table]);
    free(lit->name);
    free(lit->scene);
    free(lit->table);
    *lit = (LightCase){0};
}

// Whether the comma-separated list contains the word. NULL contains every word.
static bool has_name(const char *names, const char *word)
{
    for (const char *at = names; at; at = strchr(at, ',')) {
        at += at != names;
        if (strcspn(at, ",") == strlen(word) && strncmp(at, word, strlen(word)) == 0) return true;
    }
    return !names;
}

static Result read_found(LightCases *cases, const glob_t *found, const char *names, Error *error)
{
    cases->list = calloc(found->gl_pathc + 1, sizeof *cases->list);
    if (!cases->list) return error_set(error, RESULT_FAILED, "no memory for cases");
    for (size_t i = 0; i < found->gl_pathc; ++i) {
        LightCase *lit = &cases->list[cases->count++];
        TRY(read_case(lit, found->gl_pathv[i], error));
        bool wanted = has_name(names, lit->name);
        if (wanted && lit->blocks[LIGHT_ONE]) continue;
        if (!lit->blocks[LIGHT_ONE])
            fprintf(stderr, "%s: not a case: there is no %s\n", lit->scene, lit->table);
        destroy_case(lit);
        --cases->count;
    }
    return RESULT_OK;
}

// Checks that each name is the name of a case.
static Result check_names(const LightCases *cases, const char *folder, const char *names,
                          Error *error)
{
    for (const char *at = names; at; at = strchr(at, ',')) {
        at += at != names;
        int length = (int)strcspn(at, ",");
        bool found = false;
        for (size_t i = 0; i < cases->count; ++i)
            found |= strlen(cases->list[i].name) == (size_t)length &&
                     strncmp(cases->list[i].name, at, (size_t)length) == 0;
        if (!found)
            return error_set(error, RESULT_USAGE, "--case: no case '%.*s' in the folder %s", length,
                             at, folder);
    }
    return RESULT_OK;
}

Result light_cases_read(LightCases *cases, const char *folder, const char *names, Error *error)
{
    struct stat status;
    char pattern[4096], where[4096];
    glob_t found = {0};
    *cases = (LightCases){0};
    if (stat(folder, &status) != 0 || !S_ISDIR(status.st_mode))
        return error_set(error, RESULT_BAD_INPUT,
                         "%s: no such folder in %s: expected path-traced cases; the project's are "
                         "in its sources, others are named with --reference DIR",
                         folder, getcwd(where, sizeof where) ? where : "the working folder");
    snprintf(pattern, sizeof pattern, "%s/*.json", folder);
    glob(pattern, 0, NULL, &found);
    Result result = read_found(cases, &found, names, error);
    globfree(&found);
    TRY(result);
    TRY(check_names(cases, folder, names, error));
    if (cases->count == 0)
        return error_set(error, RESULT_BAD_INPUT,
                         "%s: no cases: expected NAME.json with NAME.csv beside it", folder);
    return RESULT_OK;
}

void light_cases_destroy(LightCases *cases)
{
    for (size_t i = 0; i < cases->count; ++i) destroy_case(&cases->list[i]);
    free(cases->list);
    *cases = (LightCases){0};
}

// --- Comparing.

void light_case_block(const Image *image, int column, int row, double *mean)
{
    const float *pixels = (const float *)(const void *)image->pixels;
    for (int k = 0; k < image->channels; ++k) mean[k] = 0;
    for (size_t i = 0; i < (size_t)LIGHT_BLOCK_PX * LIGHT_BLOCK_PX; ++i) {
        size_t x = (size_t)column * LIGHT_BLOCK_PX + i % LIGHT_BLOCK_PX;
        size_t y = (size_t)row * LIGHT_BLOCK_PX + i / LIGHT_BLOCK_PX;
        const float *pixel = pixels + (y * (size_t)image->width + x) * (size_t)image->channels;
        for (int k = 0; k < image->channels; ++k)
            mean[k] += (double)pixel[k] / (LIGHT_BLOCK_PX * LIGHT_BLOCK_PX);
    }
}

Result light_case_write(const char *path, const Image *one, const Image *all, Error *error)
{
    OutFile file;
    TRY(outfile_open(&file, path, error));
    fprintf(file.stream, "column,row,%s,%s,%s,%s,%s,%s,%s\n", COLUMNS[LIGHT_ONE][0],
            COLUMNS[LIGHT_ONE][1], COLUMNS[LIGHT_ONE][2], COLUMNS[LIGHT_ALL][0],
            COLUMNS[LIGHT_ALL][1], COLUMNS[LIGHT_ALL][2], COLUMNS[LIGHT_COVERAGE][0]);
    for (int row = 0; row < one->height / LIGHT_BLOCK_PX; ++row)
        for (int column = 0; column < one->width / LIGHT_BLOCK_PX; ++column) {
            double first[4], whole[4];
            light_case_block(one, column, row, first);
            light_case_block(all, column, row, whole);
            fprintf(file.stream, "%d,%d,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g\n", column, row,
                    first[0], first[1], first[2], whole[0], whole[1], whole[2], whole[3]);
        }
    return outfile_commit(&file, error);
}

LightError light_case_compare(const LightCase *lit, LightTable table, const Image *image)
{
    double ours[3] = {0}, theirs[3] = {0}, off[3] = {0}, squares[3] = {0};
    LightError error;
    for (int i = 0; i < lit->columns * lit->rows; ++i) {
        const double *traced = lit->blocks[table][i];
        double mean[4];
        light_case_block(image, i % lit->columns, i / lit->columns, mean);
        for (int k = 0; k < 3; ++k) {
            ours[k] += mean[k], theirs[k] += traced[k];
            off[k] += (mean[k] - traced[k]) * (mean[k] - traced[k]);
            squares[k] += traced[k] * traced[k];
        }
    }
    for (int k = 0; k < 3; ++k) {
        error.mean[k] = ours[k] / theirs[k];
        error.rel[k] = sqrt(off[k] / squares[k]);
    }
    return error;
}
