// SPDX-License-Identifier: MIT
#include "base/progress.h"

#include "base/activity.h"
#include "base/clock.h"

#include <math.h>
#include <unistd.h>

#define DRAW_INTERVAL_S 0.1
// Time constant with which the rate follows changes. A shorter one makes the remaining time jump.
#define SMOOTHING_S 3.0
#define COLUMNS_MIN 40
#define COLUMNS_MAX 200
#define BAR_MAX     40

void progress_start_at(Progress *progress, FILE *stream, int total, bool quiet, double now_s)
{
    bool shown = !quiet && isatty(fileno(stream));
    *progress = (Progress){
        .stream = shown ? stream : NULL,
        .total = total,
        .updated_s = now_s,
        .drawn_s = now_s - DRAW_INTERVAL_S,
    };
}

void progress_start(Progress *progress, FILE *stream, int total, bool quiet)
{
    progress_start_at(progress, stream, total, quiet, 1e-3 * clock_ms());
}

// Writes "h:mm:ss" or "m:ss".
static int format_duration(char *text, size_t size, double seconds)
{
    long whole = seconds < 359999.0 ? lround(ceil(seconds)) : 359999;
    if (whole < 3600) return snprintf(text, size, "%ld:%02ld", whole / 60, whole % 60);
    return snprintf(text, size, "%ld:%02ld:%02ld", whole / 3600, whole / 60 % 60, whole % 60);
}

int progress_format(char *line, size_t size, int columns, int done, int total, double rate)
{
    if (columns < COLUMNS_MIN) columns = COLUMNS_MIN;
    char count[32], tail[64] = "", left[24];
    int count_length = snprintf(count, sizeof count, "%d/%d", done, total);
    int tail_length = 0;
    if (rate > 0.0) {
        format_duration(left, sizeof left, (total - done) / rate);
        tail_length = snprintf(tail, sizeof tail, "%.3g/s, %s left", rate, left);
    }
    // The bar takes the rest, less its brackets, two spaces and the last column, where terminals
    // wrap.
    int bar = columns - 1 - count_length - tail_length - 4;
    if (bar > BAR_MAX) bar = BAR_MAX;
    if (bar < 4) return snprintf(line, size, "%.*s", columns - 1, count);
    char cells[BAR_MAX + 1];
    int filled = total > 0 ? (int)((long long)bar * done / total) : 0;
    for (int i = 0; i < bar; i++) cells[i] = i < filled ? '#' : '-';
    cells[bar] = 0;
    return snprintf(line, size, "%s [%s]%s%s", count, cells, tail_length ? " " : "", tail);
}

static void draw(Progress *progress)
{
    char line[COLUMNS_MAX + 1];
    int length = progress_format(
        line, sizeof line, activity_width(progress->stream) - activity_columns(progress->stream),
        progress->done, progress->total, progress->rate);
    int before = progress->shown;
    progress->shown = length;
    if (activity_line(progress->stream, line)) return;
    // Overwrite the rest of a longer line with blanks, because not every terminal can erase.
    int blanks = before > length ? before - length : 0;
    fprintf(progress->stream, "\r%s%*s", line, blanks, "");
    fflush(progress->stream);
}

void progress_update_at(Progress *progress, int done, double now_s)
{
    if (!progress->stream) return;
    if (now_s - progress->drawn_s < DRAW_INTERVAL_S && done < progress->total) return;
    double elapsed_s = now_s - progress->updated_s;
    if (elapsed_s > 0.0 && done > progress->done) {
        double rate = (done - progress->done) / elapsed_s;
        // One-pole low-pass filter, exact for any interval between updates. The first rate is taken
        // unfiltered.
        double weight = progress->rate > 0.0 ? -expm1(-elapsed_s / SMOOTHING_S) : 1.0;
        progress->rate += weight * (rate - progress->rate);
        progress->updated_s = now_s;
        progress->done = done;
    }
    progress->drawn_s = now_s;
    draw(progress);
}

void progress_update(Progress *progress, int done)
{
    if (progress->stream) progress_update_at(progress, done, 1e-3 * clock_ms());
}

void progress_clear(Progress *progress)
{
    if (!progress->stream || progress->shown == 0) return;
    if (!activity_line(progress->stream, NULL)) {
        fprintf(progress->stream, "\r%*s\r", progress->shown, "");
        fflush(progress->stream);
    }
    progress->shown = 0;
    progress->drawn_s -= DRAW_INTERVAL_S;
}
