// SPDX-License-Identifier: MIT
// Linked into the programs of OUT/faults, never into those that people run: makes chosen library
// calls fail. Every call of a function of calls.def by the project's own code arrives here first
// (the linker's --wrap); calls within libraries and drivers do not.
//
//   TRACTRIX_FAULT        NAME: every call of that name fails; NAME:N: the Nth; NAME@SITE:N: the
//                         Nth of that call site. Several, separated by commas.
//   TRACTRIX_FAULT_LOG    a file: without TRACTRIX_FAULT it gets a line `NAME SITE` for each call,
//                         with it a line `NAME REASON` for each call that was made to fail
//   TRACTRIX_FAULT_DEPTH  how many callers make a site (default 4)
#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <libdeflate.h>
#include <png.h>

#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <execinfo.h>
#include <fcntl.h>
#include <locale.h>
#include <pthread.h>
#include <spawn.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

enum { SITES = 1 << 16, FRAMES = 32, WISHES = 8, LOG_LOWEST = 200 };

// Number of calls of a site or name.
typedef struct Counter {
    uint64_t key;
    unsigned calls;
} Counter;

typedef struct Wish {
    char name[64];
    uint64_t site;  // 0: any
    unsigned which; // 0: every call
} Wish;

extern const char __executable_start, etext; // the linker's
extern int __real_open(const char *path, int flags, ...);
extern ssize_t __real_write(int file, const void *from, size_t size);
extern void *__real_malloc(size_t size);
extern int __real_fflush(FILE *stream);
extern int __real_close(int file);

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static Counter counters[SITES];
static Wish wishes[WISHES];
static int wish_count, callers = 4, log_file = -1;
static _Thread_local bool busy;
static _Thread_local GLenum gl_error;
static _Thread_local EGLint egl_error = EGL_SUCCESS;

static unsigned count_call(uint64_t key)
{
    unsigned at = (unsigned)(key % SITES), tries = 0;
    while (counters[at].key && counters[at].key != key && ++tries < SITES) at = (at + 1) % SITES;
    counters[at].key = key;
    return ++counters[at].calls;
}

static uint64_t mix(uint64_t hash, uint64_t value)
{
    return (hash ^ value) * 0x9e3779b97f4a7c15u ^ (hash >> 29);
}

static uint64_t hash_name(const char *name)
{
    uint64_t hash = 14695981039346656037u;
    while (*name) hash = (hash ^ (uint8_t)*name++) * 1099511628211u;
    return hash | 1;
}

// Hashes the callers that lie in the program itself, since addresses in libraries differ from run
// to run. noinline: the first two frames are this function's and its caller's.
static __attribute__((noinline)) uint64_t hash_callers(uint64_t hash)
{
    void *frames[FRAMES];
    int count = backtrace(frames, FRAMES), used = 0;
    for (int i = 3; i < count && used < callers; ++i) {
        const char *at = frames[i];
        if (at < &__executable_start || at >= &etext) continue;
        hash = mix(hash, (uint64_t)(at - &__executable_start));
        ++used;
    }
    return hash | 1;
}

static void log_line(const char *format, ...)
{
    char line[160];
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    if (__real_write(log_file, line, (size_t)length) != length) abort();
}

static bool is_wished(const char *name, uint64_t site, unsigned of_name, unsigned of_site)
{
    for (int i = 0; i < wish_count; ++i) {
        const Wish *wish = &wishes[i];
        if (strcmp(wish->name, name) != 0 || (wish->site && wish->site != site)) continue;
        if (!wish->which || wish->which == (wish->site ? of_site : of_name)) return true;
    }
    return false;
}

// Whether calls of this name need counting: some fault names it.
static bool matters(const char *name)
{
    bool named = wish_count == 0;
    for (int i = 0; i < wish_count; ++i) named = named || strcmp(wishes[i].name, name) == 0;
    return named;
}

// Counts this call; returns whether it must fail.
static __attribute__((noinline)) bool chosen(const char *name, const char *reason)
{
    if (log_file < 0 || busy || !matters(name)) return false;
    int before = errno;
    busy = true;
    uint64_t key = hash_name(name), site = hash_callers(key);
    pthread_mutex_lock(&lock);
    unsigned of_name = count_call(key), of_site = count_call(site);
    pthread_mutex_unlock(&lock);
    bool fails = is_wished(name, site, of_name, of_site);
    if (fails)
        log_line("%s %s\n", name, reason);
    else if (!wish_count)
        log_line("%s %016llx\n", name, (unsigned long long)site);
    busy = false;
    errno = before;
    return fails;
}

static void add_wish(const char *text)
{
    Wish *wish = &wishes[wish_count++];
    unsigned long long site = 0;
    if (sscanf(text, "%63[^@:]@%llx:%u", wish->name, &site, &wish->which) < 2)
        sscanf(text, "%63[^@:]:%u", wish->name, &wish->which);
    wish->site = site;
}

static __attribute__((constructor)) void start(void)
{
    void *frame;
    const char *wanted = getenv("TRACTRIX_FAULT"), *path = getenv("TRACTRIX_FAULT_LOG");
    const char *count = getenv("TRACTRIX_FAULT_DEPTH");
    if (!path) return;
    backtrace(&frame, 1); // loads the unwinder, which allocates memory
    if (count) callers = atoi(count);
    char text[1024];
    snprintf(text, sizeof text, "%s", wanted ? wanted : "");
    for (char *at = text, *one; (one = strsep(&at, ",")) && wish_count < WISHES;)
        if (*one) add_wish(one);
    int file = __real_open(path, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    log_file = fcntl(file, F_DUPFD_CLOEXEC, LOG_LOWEST);
    __real_close(file);
}

// --- Kinds of failures.

// From now on, writing to this file fails as on a full disk.
static void fill_disk(int file)
{
    if (file < 0) return;
    int flags = fcntl(file, F_GETFD), full = __real_open("/dev/full", O_WRONLY | O_CLOEXEC);
    dup3(full, file, flags & FD_CLOEXEC ? O_CLOEXEC : 0);
    __real_close(full);
}

// From now on, reading from this file fails.
static void break_file(int file)
{
    int flags = fcntl(file, F_GETFD), closed = __real_open("/dev/null", O_WRONLY | O_CLOEXEC);
    dup3(closed, file, flags & FD_CLOEXEC ? O_CLOEXEC : 0);
    __real_close(closed);
}

static bool is_disk(FILE *stream)
{
    return stream && stream != stderr && fileno(stream) >= 0;
}

static void fill_stream(const char *name, FILE *stream)
{
    if (is_disk(stream) && chosen(name, strerror(ENOSPC))) fill_disk(fileno(stream));
}

// clang-format off
#define CALL(type, name, parameters, arguments, error, result)                                     \
    extern type __real_##name parameters;                                                          \
    extern type __wrap_##name parameters;                                                          \
    type __wrap_##name parameters                                                                  \
    {                                                                                              \
        if (!chosen(#name, strerror(error))) return __real_##name arguments;                       \
        errno = error;                                                                             \
        return result;                                                                             \
    }
#define AFTER(type, name, parameters, arguments, error, result)                                    \
    extern type __real_##name parameters;                                                          \
    extern type __wrap_##name parameters;                                                          \
    type __wrap_##name parameters                                                                  \
    {                                                                                              \
        type outcome = __real_##name arguments;                                                    \
        if (!chosen(#name, strerror(error))) return outcome;                                       \
        errno = error;                                                                             \
        return result;                                                                             \
    }
#define TEXT(type, name, parameters, arguments, to)                                                \
    extern type __real_##name parameters;                                                          \
    extern type __wrap_##name parameters;                                                          \
    type __wrap_##name parameters                                                                  \
    {                                                                                              \
        fill_stream(#name, to);                                                                    \
        return __real_##name arguments;                                                            \
    }
#define GL(type, name, parameters, arguments, result)                                              \
    extern type(*__real_epoxy_##name) parameters;                                                  \
    static type fail_##name parameters                                                             \
    {                                                                                              \
        if (!chosen(#name, "")) return __real_epoxy_##name arguments;                              \
        gl_error = GL_OUT_OF_MEMORY;                                                               \
        egl_error = EGL_BAD_ALLOC;                                                                 \
        return result;                                                                             \
    }                                                                                              \
    extern type(*__wrap_epoxy_##name) parameters;                                                  \
    type(*__wrap_epoxy_##name) parameters = fail_##name;
#define GL_VOID(name, parameters, arguments)                                                       \
    extern void(*__real_epoxy_##name) parameters;                                                  \
    static void fail_##name parameters                                                             \
    {                                                                                              \
        if (chosen(#name, "out of memory"))                                                        \
            gl_error = GL_OUT_OF_MEMORY;                                                           \
        else                                                                                       \
            __real_epoxy_##name arguments;                                                         \
    }                                                                                              \
    extern void(*__wrap_epoxy_##name) parameters;                                                  \
    void(*__wrap_epoxy_##name) parameters = fail_##name;
#define OWN(name)
#define OWN_GL(name)
#include "faults/calls.def"
// clang-format on

// --- Functions that need more than the macro.

extern int __real_fclose(FILE *stream);
extern int __wrap_fclose(FILE *stream);

// A stream in memory has no file and can't fail to close.
int __wrap_fclose(FILE *stream)
{
    bool has_file = fileno(stream) >= 0;
    int outcome = __real_fclose(stream);
    if (!has_file || !chosen("fclose", strerror(EIO))) return outcome;
    errno = EIO;
    return EOF;
}

int __wrap_asprintf(char **text, const char *format, ...)
{
    if (chosen("asprintf", strerror(ENOMEM))) {
        errno = ENOMEM;
        return -1;
    }
    va_list arguments;
    va_start(arguments, format);
    int length = vasprintf(text, format, arguments);
    va_end(arguments);
    return length;
}

static int take_mode(int flags, va_list arguments)
{
    return flags & (O_CREAT | O_TMPFILE) ? va_arg(arguments, int) : 0;
}

int __wrap_open(const char *path, int flags, ...)
{
    va_list arguments;
    va_start(arguments, flags);
    int mode = take_mode(flags, arguments);
    va_end(arguments);
    if (!chosen("open", strerror(EMFILE))) return __real_open(path, flags, mode);
    errno = EMFILE;
    return -1;
}

extern int __real_openat(int folder, const char *path, int flags, ...);
int __wrap_openat(int folder, const char *path, int flags, ...)
{
    if (!chosen("openat", strerror(EMFILE))) return __real_openat(folder, path, flags);
    errno = EMFILE;
    return -1;
}

extern ssize_t __real_read(int file, void *to, size_t size);
ssize_t __wrap_read(int file, void *to, size_t size)
{
    if (chosen("read_interrupted", "")) {
        errno = EINTR;
        return -1;
    }
    if (size > 1 && chosen("read_short", "")) return __real_read(file, to, 1 + size / 2);
    if (!chosen("read", strerror(EIO))) return __real_read(file, to, size);
    errno = EIO;
    return -1;
}

ssize_t __wrap_write(int file, const void *from, size_t size)
{
    if (chosen("write_interrupted", "")) {
        errno = EINTR;
        return -1;
    }
    if (size > 1 && chosen("write_short", "")) return __real_write(file, from, size / 2);
    if (chosen("write", strerror(ENOSPC))) fill_disk(file);
    return __real_write(file, from, size);
}

extern size_t __real_fread(void *to, size_t size, size_t count, FILE *stream);
size_t __wrap_fread(void *to, size_t size, size_t count, FILE *stream)
{
    if (chosen("fread", strerror(EBADF))) break_file(fileno(stream));
    return __real_fread(to, size, count, stream);
}

extern char *__real_fgets(char *to, int size, FILE *stream);
char *__wrap_fgets(char *to, int size, FILE *stream)
{
    if (chosen("fgets", strerror(EBADF))) break_file(fileno(stream));
    return __real_fgets(to, size, stream);
}

int __wrap_fprintf(FILE *stream, const char *format, ...)
{
    fill_stream("fprintf", stream);
    va_list arguments;
    va_start(arguments, format);
    int length = vfprintf(stream, format, arguments);
    va_end(arguments);
    return length;
}

int __wrap_printf(const char *format, ...)
{
    fill_stream("printf", stdout);
    va_list arguments;
    va_start(arguments, format);
    int length = vprintf(format, arguments);
    va_end(arguments);
    return length;
}

// --- OpenGL's queries of success.

extern void (*__real_epoxy_glGetShaderiv)(GLuint shader, GLenum name, GLint *value);
static void fail_glGetShaderiv(GLuint shader, GLenum name, GLint *value)
{
    __real_epoxy_glGetShaderiv(shader, name, value);
    if (name == GL_COMPILE_STATUS && chosen("glGetShaderiv", "")) *value = GL_FALSE;
}
void (*__wrap_epoxy_glGetShaderiv)(GLuint, GLenum, GLint *) = fail_glGetShaderiv;

extern void (*__real_epoxy_glGetProgramiv)(GLuint program, GLenum name, GLint *value);
static void fail_glGetProgramiv(GLuint program, GLenum name, GLint *value)
{
    __real_epoxy_glGetProgramiv(program, name, value);
    if (name == GL_LINK_STATUS && chosen("glGetProgramiv", "")) *value = GL_FALSE;
}
void (*__wrap_epoxy_glGetProgramiv)(GLuint, GLenum, GLint *) = fail_glGetProgramiv;

extern GLenum (*__real_epoxy_glGetError)(void);
static GLenum tell_gl_error(void)
{
    GLenum code = __real_epoxy_glGetError();
    if (gl_error) code = gl_error;
    gl_error = GL_NO_ERROR;
    return code;
}
GLenum (*__wrap_epoxy_glGetError)(void) = tell_gl_error;

extern EGLint (*__real_epoxy_eglGetError)(void);
static EGLint tell_egl_error(void)
{
    EGLint code = egl_error != EGL_SUCCESS ? egl_error : __real_epoxy_eglGetError();
    egl_error = EGL_SUCCESS;
    return code;
}
EGLint (*__wrap_epoxy_eglGetError)(void) = tell_egl_error;
