// SPDX-License-Identifier: MIT
#include "base/suggest.h"

#include <ctype.h>
#include <limits.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

// A name is near the word if it differs by at most one edit per three letters and three in all, if
// the word is its beginning, or if one of them ends in the other as a whole word.
enum { LONGEST = 63, LETTERS_AN_EDIT = 3, MOST_EDITS = 3, SHORTEST_BEGINNING = 3 };

static int fold(char character)
{
    return character == '-' ? '_' : tolower((unsigned char)character);
}

static bool begins(const char *name, const char *word)
{
    while (*word && fold(*word) == fold(*name)) word++, name++;
    return !*word;
}

// Whether `end` is the end of `text` from a '-' or '_' on: "tolerance" of "pixel-tolerance".
static bool ends_in(const char *text, const char *end)
{
    size_t length = strlen(text), part = strlen(end);
    if (part < SHORTEST_BEGINNING || length <= part || fold(text[length - part - 1]) != '_')
        return false;
    return begins(text + length - part, end);
}

static int least(int a, int b)
{
    return a < b ? a : b;
}

// Optimal string alignment distance (Damerau 1964). Row i of the usual table holds the distances of
// the first i characters of `a` from every prefix of `b`; a transposition needs the row before the
// previous.
static int distance(const char *a, const char *b)
{
    int a_length = (int)strnlen(a, LONGEST), b_length = (int)strnlen(b, LONGEST);
    int rows[3][LONGEST + 1];
    for (int j = 0; j <= b_length; j++) rows[0][j] = j;
    for (int i = 1; i <= a_length; i++) {
        int *row = rows[i % 3];
        const int *above = rows[(i + 2) % 3], *two_above = rows[(i + 1) % 3];
        row[0] = i;
        for (int j = 1; j <= b_length; j++) {
            int replaced = above[j - 1] + (fold(a[i - 1]) != fold(b[j - 1]));
            row[j] = least(replaced, least(above[j], row[j - 1]) + 1);
            if (i > 1 && j > 1 && fold(a[i - 1]) == fold(b[j - 2]) &&
                fold(a[i - 2]) == fold(b[j - 1]))
                row[j] = least(row[j], two_above[j - 2] + 1);
        }
    }
    return rows[a_length % 3][b_length];
}

const char *suggest_nearest(const char *word, const char *const *names, size_t count)
{
    const char *nearest = NULL;
    int lowest = INT_MAX, length = (int)strnlen(word, LONGEST);
    int most = least(length / LETTERS_AN_EDIT, MOST_EDITS);
    for (size_t i = 0; i < count; i++) {
        int edits = distance(word, names[i]);
        bool cut_short = length >= SHORTEST_BEGINNING && begins(names[i], word);
        // If two names are equally near, prefer the one that the user abbreviated.
        int rank = 2 * edits - cut_short;
        bool near = edits <= most || cut_short;
        // A common last word counts between one and two edits.
        if (ends_in(names[i], word) || ends_in(word, names[i]))
            rank = near ? least(rank, 3) : 3, near = true;
        if (!near || rank >= lowest) continue;
        lowest = rank;
        nearest = names[i];
    }
    return nearest;
}

const char *suggest_words(char *text, size_t size, const char *word, const char *const *names,
                          size_t count)
{
    const char *nearest = suggest_nearest(word, names, count);
    size_t length = (size_t)snprintf(text, size, nearest ? "did you mean '%s'?" : "expected ",
                                     nearest ? nearest : "");
    for (size_t i = 0; !nearest && i < count && length < size; i++)
        length += (size_t)snprintf(text + length, size - length, "%s%s",
                                   i == 0          ? ""
                                   : i + 1 < count ? ", "
                                                   : " or ",
                                   names[i]);
    if (length >= size) text[0] = 0;
    return text;
}
