// SPDX-License-Identifier: MIT
#include "gpu/gl_count.h"

#include <epoxy/gl.h>

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#define GL_VALUE GL_FUNCTION

enum Call {
#define GL_FUNCTION(type, name, parameters, arguments) CALL_##name,
#include "gpu/gl_functions.def"
#undef GL_FUNCTION
    CALLS
};

static const char *const NAMES[CALLS] = {
#define GL_FUNCTION(type, name, parameters, arguments) [CALL_##name] = #name,
#include "gpu/gl_functions.def"
#undef GL_FUNCTION
};

enum { FRAMES = 8, WATCHED = 64, FENCES = 64 };

// `Written`: a buffer that a GL command fills, and the number of the call that queued the last such
// command. `Fence`: a fence, and the number of the call that set it.
typedef struct Written {
    GLuint buffer;
    uint64_t at;
} Written;
typedef struct Fence {
    GLsync sync;
    uint64_t at;
} Fence;

typedef struct Tally {
    GlCounts all;
    uint64_t by_name[CALLS];
} Tally;

static bool counting;
static Tally now, ended[FRAMES + 1]; // ring buffer
static uint64_t frames;
static Written written[WATCHED];
static Fence fences[FENCES];
static int written_next, fence_next;
static uint64_t passed; // number of the last call whose work is known to be complete
static bool unordered;  // shaders have run since the last barrier for reads of buffers

// --- Wrappers that count.

static void note_call(enum Call call)
{
    ++now.all.calls;
    ++now.by_name[call];
}

// libepoxy resolves a function at its first call and then replaces its own pointer, but only if the
// pointer is still its own. So the real pointer is put back for the duration of the call.
#undef GL_VALUE
#define GL_FUNCTION(type, name, parameters, arguments)                                             \
    static type(EPOXY_CALLSPEC *real_##name) parameters;                                           \
    static type(EPOXY_CALLSPEC *mine_##name) parameters;                                           \
    static type EPOXY_CALLSPEC count_##name parameters                                             \
    {                                                                                              \
        note_call(CALL_##name);                                                                    \
        epoxy_##name = real_##name;                                                                \
        epoxy_##name arguments;                                                                    \
        real_##name = epoxy_##name;                                                                \
        epoxy_##name = mine_##name;                                                                \
    }
#define GL_VALUE(type, name, parameters, arguments)                                                \
    static type(EPOXY_CALLSPEC *real_##name) parameters;                                           \
    static type(EPOXY_CALLSPEC *mine_##name) parameters;                                           \
    static type EPOXY_CALLSPEC count_##name parameters                                             \
    {                                                                                              \
        note_call(CALL_##name);                                                                    \
        epoxy_##name = real_##name;                                                                \
        type value = epoxy_##name arguments;                                                       \
        real_##name = epoxy_##name;                                                                \
        epoxy_##name = mine_##name;                                                                \
        return value;                                                                              \
    }
#include "gpu/gl_functions.def"
#undef GL_FUNCTION
#undef GL_VALUE
#define GL_VALUE GL_FUNCTION

// --- Which calls wait for the GPU.

static GLuint bound(GLenum target)
{
    GLint buffer = 0;
    GLenum name = target == GL_PIXEL_PACK_BUFFER       ? GL_PIXEL_PACK_BUFFER_BINDING
                  : target == GL_SHADER_STORAGE_BUFFER ? GL_SHADER_STORAGE_BUFFER_BINDING
                  : target == GL_UNIFORM_BUFFER        ? GL_UNIFORM_BUFFER_BINDING
                                                       : target; // same value for copies
    epoxy_glGetIntegerv = real_glGetIntegerv;
    glGetIntegerv(name, &buffer);
    real_glGetIntegerv = epoxy_glGetIntegerv;
    epoxy_glGetIntegerv = mine_glGetIntegerv;
    return (GLuint)buffer;
}

static void note_read(void)
{
    now.all.unordered += unordered;
}

static void note_written(GLuint buffer)
{
    int i = 0;
    while (i < WATCHED && written[i].buffer != buffer) ++i;
    if (i == WATCHED) i = written_next++ % WATCHED;
    written[i] = (Written){buffer, now.all.calls};
}

static bool is_done(GLuint buffer)
{
    for (int i = 0; i < WATCHED; ++i)
        if (written[i].buffer == buffer) return written[i].at <= passed;
    return false;
}

static void EPOXY_CALLSPEC watch_glReadPixels(GLint x, GLint y, GLsizei width, GLsizei height,
                                              GLenum format, GLenum type, void *pixels)
{
    GLuint buffer = bound(GL_PIXEL_PACK_BUFFER);
    count_glReadPixels(x, y, width, height, format, type, pixels);
    if (buffer)
        note_written(buffer);
    else
        ++now.all.blocking;
}

static void EPOXY_CALLSPEC watch_glCopyBufferSubData(GLenum from, GLenum to, GLintptr from_offset,
                                                     GLintptr to_offset, GLsizeiptr size)
{
    note_read();
    count_glCopyBufferSubData(from, to, from_offset, to_offset, size);
    note_written(bound(to));
}

static void *EPOXY_CALLSPEC watch_glMapBufferRange(GLenum target, GLintptr offset,
                                                   GLsizeiptr length, GLbitfield access)
{
    const GLbitfield free = GL_MAP_INVALIDATE_BUFFER_BIT | GL_MAP_UNSYNCHRONIZED_BIT;
    bool done = is_done(bound(target));
    if (!done && access & GL_MAP_READ_BIT) note_read();
    if (access & GL_MAP_READ_BIT)
        ++*(done ? &now.all.late : &now.all.blocking);
    else
        now.all.blocking += !(access & free);
    return count_glMapBufferRange(target, offset, length, access);
}

static void EPOXY_CALLSPEC watch_glGetBufferSubData(GLenum target, GLintptr offset, GLsizeiptr size,
                                                    void *data)
{
    bool done = is_done(bound(target));
    ++*(done ? &now.all.late : &now.all.blocking);
    if (!done) note_read();
    count_glGetBufferSubData(target, offset, size, data);
}

static void EPOXY_CALLSPEC watch_glDispatchCompute(GLuint x, GLuint y, GLuint z)
{
    unordered = true;
    count_glDispatchCompute(x, y, z);
}

static void EPOXY_CALLSPEC watch_glDispatchComputeIndirect(GLintptr offset)
{
    unordered = true;
    count_glDispatchComputeIndirect(offset);
}

static void EPOXY_CALLSPEC watch_glMemoryBarrier(GLbitfield barriers)
{
    if (barriers & GL_BUFFER_UPDATE_BARRIER_BIT) unordered = false;
    count_glMemoryBarrier(barriers);
}

static void EPOXY_CALLSPEC watch_glGetTexImage(GLenum target, GLint level, GLenum format,
                                               GLenum type, void *pixels)
{
    ++now.all.blocking;
    count_glGetTexImage(target, level, format, type, pixels);
}

static void EPOXY_CALLSPEC watch_glGetQueryObjectui64v(GLuint id, GLenum name, GLuint64 *result)
{
    ++now.all.blocking;
    count_glGetQueryObjectui64v(id, name, result);
}

static void EPOXY_CALLSPEC watch_glFinish(void)
{
    ++now.all.blocking;
    count_glFinish();
}

static GLsync EPOXY_CALLSPEC watch_glFenceSync(GLenum condition, GLbitfield flags)
{
    GLsync sync = count_glFenceSync(condition, flags);
    fences[fence_next++ % FENCES] = (Fence){sync, now.all.calls};
    return sync;
}

static GLenum EPOXY_CALLSPEC watch_glClientWaitSync(GLsync sync, GLbitfield flags, GLuint64 timeout)
{
    GLenum state = count_glClientWaitSync(sync, flags, timeout);
    now.all.waits += timeout > 0 && state != GL_ALREADY_SIGNALED;
    if (state != GL_ALREADY_SIGNALED && state != GL_CONDITION_SATISFIED) return state;
    for (int i = 0; i < FENCES; ++i)
        if (fences[i].sync == sync && fences[i].at > passed) passed = fences[i].at;
    return state;
}

static void EPOXY_CALLSPEC watch_glDeleteSync(GLsync sync)
{
    for (int i = 0; i < FENCES; ++i)
        if (fences[i].sync == sync) fences[i] = (Fence){0};
    count_glDeleteSync(sync);
}

// --- Switching the counting on and off.

static void choose_wrappers(void)
{
#define GL_FUNCTION(type, name, parameters, arguments) mine_##name = count_##name;
#include "gpu/gl_functions.def"
#undef GL_FUNCTION
#define WATCH(name) mine_##name = watch_##name
    WATCH(glReadPixels);
    WATCH(glCopyBufferSubData);
    WATCH(glMapBufferRange);
    WATCH(glGetBufferSubData);
    WATCH(glDispatchCompute);
    WATCH(glDispatchComputeIndirect);
    WATCH(glMemoryBarrier);
    WATCH(glGetTexImage);
    WATCH(glGetQueryObjectui64v);
    WATCH(glFinish);
    WATCH(glFenceSync);
    WATCH(glClientWaitSync);
    WATCH(glDeleteSync);
}

static void forget(void)
{
    now = (Tally){0};
    memset(written, 0, sizeof written);
    memset(fences, 0, sizeof fences);
    frames = passed = 0;
    unordered = false;
}

void gl_count_start(void)
{
    forget();
    if (counting) return;
    choose_wrappers();
#define GL_FUNCTION(type, name, parameters, arguments)                                             \
    real_##name = epoxy_##name;                                                                    \
    epoxy_##name = mine_##name;
#include "gpu/gl_functions.def"
#undef GL_FUNCTION
    counting = true;
}

void gl_count_stop(void)
{
    if (!counting) return;
#define GL_FUNCTION(type, name, parameters, arguments) epoxy_##name = real_##name;
#include "gpu/gl_functions.def"
#undef GL_FUNCTION
    counting = false;
}

GlCounts gl_count_get(void)
{
    return now.all;
}

void gl_count_frame(void)
{
    if (counting) ended[frames++ % (FRAMES + 1)] = now;
}

// --- The table of calls.

static const uint64_t *order_by;

static int by_count(const void *a, const void *b)
{
    int i = *(const int *)a, j = *(const int *)b;
    if (order_by[i] != order_by[j]) return order_by[i] < order_by[j] ? 1 : -1;
    return strcmp(NAMES[i], NAMES[j]);
}

void gl_count_print(FILE *stream)
{
    if (frames < 2) return;
    uint64_t count = frames - 1 < FRAMES ? frames - 1 : FRAMES;
    const Tally *last = &ended[(frames - 1) % (FRAMES + 1)],
                *first = &ended[(frames - 1 - count) % (FRAMES + 1)];
    uint64_t calls[CALLS];
    int order[CALLS];
    double n = (double)count;
    for (int i = 0; i < CALLS; ++i) {
        order[i] = i;
        calls[i] = last->by_name[i] - first->by_name[i];
    }
    order_by = calls;
    qsort(order, CALLS, sizeof *order, by_count);
    fprintf(
        stream,
        "%.4g calls a frame, %.3g blocking, %.3g late reads, %.3g waits, %llu unordered in all\n",
        (double)(last->all.calls - first->all.calls) / n,
        (double)(last->all.blocking - first->all.blocking) / n,
        (double)(last->all.late - first->all.late) / n,
        (double)(last->all.waits - first->all.waits) / n, (unsigned long long)now.all.unordered);
    for (int i = 0; i < CALLS && calls[order[i]]; ++i)
        fprintf(stream, "%8.4g %s\n", (double)calls[order[i]] / n, NAMES[order[i]]);
}
