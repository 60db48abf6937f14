// SPDX-License-Identifier: MIT
#include "gpu/gpu_timer.h"

#include "base/clock.h"
#include "gpu/gpu_error.h"

#include <assert.h>
#include <string.h>

void gpu_timer_create(GpuTimer *timer, bool enabled, bool software)
{
    *timer = (GpuTimer){.enabled = enabled, .by_clock = software, .current = -1};
}

void gpu_timer_destroy(GpuTimer *timer)
{
    for (int i = 0; i < timer->count; ++i) glDeleteQueries(TIMER_RING, timer->labels[i].query);
    *timer = (GpuTimer){.current = -1};
}

static int find_label(GpuTimer *timer, const char *name)
{
    for (int i = 0; i < timer->count; ++i)
        if (strcmp(timer->labels[i].name, name) == 0) return i;
    assert(timer->count < TIMER_MAX_LABELS);
    timer->labels[timer->count] = (TimerLabel){.name = name};
    glGenQueries(TIMER_RING, timer->labels[timer->count].query);
    return timer->count++;
}

static void read_oldest(TimerLabel *label)
{
    GLuint64 ns = 0;
    glGetQueryObjectui64v(label->query[label->read++ % TIMER_RING], GL_QUERY_RESULT, &ns);
    label->total_ms += (double)ns * 1e-6;
}

void gpu_timer_begin(GpuTimer *timer, const char *name)
{
    gpu_error_note("between passes");
    timer->pass = name;
    if (!timer->enabled) return;
    assert(timer->current < 0);
    timer->current = find_label(timer, name);
    TimerLabel *label = &timer->labels[timer->current];
    if (timer->by_clock) {
        glFinish();
        timer->begun_ms = clock_ms();
    } else {
        if (label->begun - label->read == TIMER_RING) read_oldest(label);
        glBeginQuery(GL_TIME_ELAPSED, label->query[label->begun % TIMER_RING]);
    }
    ++label->begun;
}

void gpu_timer_end(GpuTimer *timer)
{
    gpu_error_note(timer->pass);
    if (!timer->enabled) return;
    TimerLabel *label = &timer->labels[timer->current];
    if (timer->by_clock) {
        glFinish();
        label->total_ms += clock_ms() - timer->begun_ms;
        ++label->read;
    } else {
        glEndQuery(GL_TIME_ELAPSED);
    }
    timer->current = -1;
}

void gpu_timer_collect(GpuTimer *timer)
{
    for (int i = 0; i < timer->count; ++i)
        while (timer->labels[i].read != timer->labels[i].begun) read_oldest(&timer->labels[i]);
}
