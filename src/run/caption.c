// SPDX-License-Identifier: MIT
#include "run/caption.h"

#include "base/suggest.h"
#include "scene/schedule.h"

#include <stb_easy_font.h>

#include <stdio.h>
#include <string.h>

typedef enum Word { WORD_FRAME, WORD_TIME, WORD_FILE, WORD_SOLVER, WORD_COUNT } Word;
static const char *const WORDS[WORD_COUNT] = {"frame", "time", "file", "solver"};

// Lines of stb_easy_font are 12 units high.
enum { LINE_UNITS = 12, QUADS_MAX = 12 * CAPTION_BYTES };

// The word at the beginning of `text`; WORD_COUNT if it is unknown. `length`: its length, up to the
// next comma.
static Word find_word(const char *text, size_t *length)
{
    *length = strcspn(text, ",");
    for (int i = 0; i < WORD_COUNT; ++i)
        if (strlen(WORDS[i]) == *length && strncmp(WORDS[i], text, *length) == 0) return (Word)i;
    return WORD_COUNT;
}

Result caption_check(const char *words, Error *error)
{
    size_t length;
    for (const char *at = words; *words; at += length + 1) {
        if (find_word(at, &length) == WORD_COUNT) {
            char word[64];
            snprintf(word, sizeof word, "%.*s", (int)length, at);
            const char *nearest = suggest_nearest(word, WORDS, WORD_COUNT);
            return error_set(error, RESULT_USAGE,
                             "--caption: got '%s', expected the words frame, time, file, solver, "
                             "or some of them, separated by commas%s%s%s",
                             word, nearest ? " (nearest: " : "", nearest ? nearest : "",
                             nearest ? ")" : "");
        }
        if (!at[length]) break;
    }
    return RESULT_OK;
}

static void append(char text[CAPTION_BYTES], const char *more)
{
    size_t length = strlen(text);
    snprintf(text + length, CAPTION_BYTES - length, "%s", more);
}

static const char *name_of(const Section *section, Word word)
{
    if (word == WORD_SOLVER) return section->params.algo;
    const char *slash = strrchr(section->file, '/');
    return slash ? slash + 1 : section->file;
}

// Appends the names of all sections; equal neighbours are written once.
static void append_names(char text[CAPTION_BYTES], const Scene *scene, Word word)
{
    for (uint32_t i = 0; i < scene->section_count; ++i) {
        const char *name = name_of(&scene->sections[i], word);
        if (i > 0 && strcmp(name, name_of(&scene->sections[i - 1], word)) == 0) continue;
        if (i > 0) append(text, ", ");
        append(text, name);
    }
}

void caption_write(char text[CAPTION_BYTES], const Scene *scene, int frame)
{
    char number[40];
    size_t length;
    text[0] = 0;
    for (const char *at = scene->run.caption; *at; at += length + (at[length] != 0)) {
        Word word = find_word(at, &length);
        if (text[0]) append(text, "   ");
        snprintf(number, sizeof number, word == WORD_FRAME ? "frame %.0f" : "%.2f s",
                 word == WORD_FRAME ? frame + scene->run.frame_number.value
                                    : schedule_frame_time(&scene->run, frame));
        if (word == WORD_FRAME || word == WORD_TIME)
            append(text, number);
        else
            append_names(text, scene, word);
    }
    for (char *c = text; *c; ++c)
        if (*c < ' ' || *c > '~') *c = '?';
}

// Fills a rectangle of `wide` x `high` pixels at (x, y): opaque, black if `grey` is 0, otherwise
// white.
static void fill(Image *image, int x, int y, int wide, int high, int grey)
{
    int right = x + wide < image->width ? x + wide : image->width;
    int bottom = y + high < image->height ? y + high : image->height;
    size_t pixel = (size_t)image->channels * image_channel_size(image->kind);
    for (int row = y > 0 ? y : 0; row < bottom; ++row)
        for (int column = x > 0 ? x : 0; column < right; ++column) {
            uint8_t *at =
                image->pixels + ((size_t)row * (size_t)image->width + (size_t)column) * pixel;
            memset(at, grey ? 255 : 0, pixel);
            if (image->channels == 4) memset(at + pixel / 4 * 3, 255, pixel / 4);
        }
}

void caption_draw(Image *image, const char *text)
{
    static const struct {
        int grow, grey;
    } LAYERS[] = {{1, 0}, {0, 1}};
    char line[CAPTION_BYTES];
    float quads[QUADS_MAX][4][4]; // x, y, z, color of each corner
    int unit = image->height / (20 * LINE_UNITS) > 1 ? image->height / (20 * LINE_UNITS) : 1;
    int left = 4 * unit, top = image->height - (LINE_UNITS + 2) * unit;
    snprintf(line, sizeof line, "%s", text);
    int count = stb_easy_font_print(0, 0, line, NULL, quads, (int)sizeof quads);
    for (int layer = 0; layer < 2; ++layer)
        for (int i = 0; i < count; ++i) {
            int grow = LAYERS[layer].grow;
            const float *low = quads[i][0], *high = quads[i][2];
            fill(image, left + unit * (int)low[0] - grow, top + unit * (int)low[1] - grow,
                 unit * (int)(high[0] - low[0]) + 2 * grow,
                 unit * (int)(high[1] - low[1]) + 2 * grow, LAYERS[layer].grey);
        }
}
