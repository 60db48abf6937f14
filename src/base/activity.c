// SPDX-License-Identifier: MIT
#include "base/activity.h"

#include "base/clock.h"

#include <pthread.h>
#include <string.h>
#include <sys/ioctl.h>
#include <time.h>
#include <unistd.h>

enum { WHAT_SIZE = 101, LINE_SIZE = 256, LOOK_MS = 100, SILENT_MS = 1000 };

static struct {
    pthread_mutex_t lock;
    pthread_cond_t ended;
    pthread_t thread;
    FILE *stream; // NULL if nothing is shown
    bool ends;
    char what[WHAT_SIZE]; // empty if nothing is going on that takes long
    char line[LINE_SIZE]; // the line that precedes the activity
    double begun_ms;      // start of `what`
    double drawn_ms;
    int shown; // characters that are now on the line
} activity = {.lock = PTHREAD_MUTEX_INITIALIZER, .ended = PTHREAD_COND_INITIALIZER};

int activity_width(FILE *stream)
{
    enum { DEFAULT = 80, MOST = 200 };
    struct winsize size;
    if (ioctl(fileno(stream), TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return DEFAULT;
    return size.ws_col > MOST ? MOST : size.ws_col;
}

static void draw(const char *text)
{
    int most = activity_width(activity.stream) - 1, length = (int)strlen(text);
    if (length > most) length = most;
    int blanks = activity.shown > length ? activity.shown - length : 0;
    fprintf(activity.stream, "\r%.*s%*s", length, text, blanks, "");
    // After erasing, the cursor stays at the start of the line; otherwise at the end of the text.
    if (length == 0) fputc('\r', activity.stream);
    fflush(activity.stream);
    activity.shown = length;
    activity.drawn_ms = clock_ms();
}

static void draw_all(void)
{
    char text[LINE_SIZE + WHAT_SIZE + 32];
    double seconds = (clock_ms() - activity.begun_ms) / 1e3;
    snprintf(text, sizeof text, "%s%s%s, %.0f s", activity.line, *activity.line ? " " : "",
             activity.what, seconds);
    draw(text);
}

static void *watch(void *unused)
{
    (void)unused;
    pthread_mutex_lock(&activity.lock);
    while (!activity.ends) {
        struct timespec until;
        clock_gettime(CLOCK_REALTIME, &until);
        until.tv_nsec += LOOK_MS * 1000000L;
        until.tv_sec += until.tv_nsec / 1000000000L;
        until.tv_nsec %= 1000000000L;
        pthread_cond_timedwait(&activity.ended, &activity.lock, &until);
        double since_ms = clock_ms() - activity.drawn_ms;
        if (!activity.ends && *activity.what && since_ms >= SILENT_MS) draw_all();
    }
    pthread_mutex_unlock(&activity.lock);
    return NULL;
}

void activity_start(FILE *stream, bool quiet)
{
    if (activity.stream || quiet || !isatty(fileno(stream))) return;
    activity.stream = stream;
    activity.ends = false;
    activity.drawn_ms = clock_ms();
    if (pthread_create(&activity.thread, NULL, watch, NULL) != 0) activity.stream = NULL;
}

void activity_set(const char *what)
{
    if (!activity.stream) return;
    pthread_mutex_lock(&activity.lock);
    snprintf(activity.what, sizeof activity.what, "%s", what ? what : "");
    activity.begun_ms = clock_ms();
    if (activity.shown) draw(activity.line);
    pthread_mutex_unlock(&activity.lock);
}

bool activity_line(FILE *stream, const char *line)
{
    if (!activity.stream || stream != activity.stream) return false;
    pthread_mutex_lock(&activity.lock);
    snprintf(activity.line, sizeof activity.line, "%s", line ? line : "");
    if (line || activity.shown) draw(activity.line);
    pthread_mutex_unlock(&activity.lock);
    return true;
}

int activity_columns(FILE *stream)
{
    return activity.stream && stream == activity.stream ? 26 : 0; // " preparing the renderer, 9 s"
}

void activity_end(void)
{
    if (!activity.stream) return;
    pthread_mutex_lock(&activity.lock);
    activity.ends = true;
    pthread_cond_signal(&activity.ended);
    pthread_mutex_unlock(&activity.lock);
    pthread_join(activity.thread, NULL);
    if (activity.shown) draw("");
    activity.stream = NULL;
    activity.what[0] = activity.line[0] = 0;
}
