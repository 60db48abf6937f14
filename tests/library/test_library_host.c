// SPDX-License-Identifier: MIT
// A host that loads the library while it runs, and uses the same libraries itself: afterwards their
// state, and that of the process, is as before.
#include "library/tractrix.h"
#include "support/temporary.h"

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <fenv.h>
#include <jansson.h>
#include <locale.h>
#include <pthread.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdio_ext.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

// What a host can see of the process and of its libraries.
typedef struct Seen {
    json_malloc_t json_allocates;
    json_free_t json_releases;
    struct {
        void (*handler)(int);
        int flags;
    } signals[64];
    sigset_t blocked;
    char locale[200], folder[4096];
    locale_t thread;
    int rounding, exceptions, traps;
    mode_t mask;
    struct rlimit files, size, stack;
    size_t buffers[3];
    int lines[3];
    int variables; // of the environment
    EGLContext context;
    EGLenum api;
} Seen;

extern char **environ;

static void see(Seen *seen)
{
    FILE *const streams[] = {stdin, stdout, stderr};
    memset(seen, 0, sizeof *seen);
    json_get_alloc_funcs(&seen->json_allocates, &seen->json_releases);
    for (int i = 1; i < 64; ++i) {
        struct sigaction action;
        if (sigaction(i, NULL, &action) != 0) continue;
        seen->signals[i].handler = action.sa_handler;
        seen->signals[i].flags = action.sa_flags;
    }
    pthread_sigmask(SIG_SETMASK, NULL, &seen->blocked);
    snprintf(seen->locale, sizeof seen->locale, "%s", setlocale(LC_ALL, NULL));
    seen->thread = uselocale((locale_t)0);
    assert_non_null(getcwd(seen->folder, sizeof seen->folder));
    seen->rounding = fegetround();
    seen->exceptions = fetestexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
    seen->traps = fegetexcept();
    seen->mask = umask(022);
    umask(seen->mask);
    getrlimit(RLIMIT_NOFILE, &seen->files);
    getrlimit(RLIMIT_FSIZE, &seen->size);
    getrlimit(RLIMIT_STACK, &seen->stack);
    for (int i = 0; i < 3; ++i) {
        seen->buffers[i] = __fbufsize(streams[i]);
        seen->lines[i] = __flbf(streams[i]) != 0;
    }
    while (environ[seen->variables]) ++seen->variables;
    seen->context = eglGetCurrentContext();
    seen->api = eglQueryAPI();
}

static void *host_malloc(size_t size)
{
    return malloc(size + 64);
}

static void on_signal(int number)
{
    (void)number;
}

static void (*find(void *library, const char *name))(void)
{
    void *found = dlsym(library, name);
    void (*function)(void);
    memcpy(&function, &found, sizeof function);
    assert_non_null(function);
    return function;
}

#define FIND(name)              ((__typeof__(&(name)))find(library, #name))
#define CALL(result, name, ...) assert_int_equal(FIND(name)(__VA_ARGS__), result)

// Good and bad calls of every kind.
static void use(void *library, const char *picture)
{
    TractrixScene *scene;
    TractrixDevice *device;
    TractrixSimulation *simulation;
    TractrixPicture *read;
    TractrixError error;
    uint8_t pixels[16 * 16 * 4] = {0};
    TractrixImage image = {.size = sizeof image, .width = 16, .height = 16, .pixels = pixels};
    CALL(TRACTRIX_OK, tractrix_scene_read, &scene, "assets/fur.tfx", &error);
    CALL(TRACTRIX_USAGE, tractrix_scene_set, scene, -1, "wind", "x", &error);
    CALL(TRACTRIX_OK, tractrix_scene_set, scene, -1, "wind", "0.5,0,0", &error);
    CALL(TRACTRIX_OK, tractrix_device_open, &device, NULL, &error);
    CALL(TRACTRIX_OK, tractrix_simulation_create, &simulation, device, scene, &error);
    CALL(TRACTRIX_OK, tractrix_simulation_advance, simulation, NULL, &error);
    CALL(TRACTRIX_OK, tractrix_image_write, &image, picture, &error);
    CALL(TRACTRIX_OK, tractrix_picture_read, &read, picture, &error);
    FIND(tractrix_picture_destroy)(read);
    CALL(TRACTRIX_BAD_INPUT, tractrix_picture_read, &read, "LICENSE", &error);
    FIND(tractrix_simulation_destroy)(simulation);
    FIND(tractrix_device_destroy)(device);
    FIND(tractrix_scene_destroy)(scene);
}

static void a_host_finds_everything_as_before(void **state)
{
    char path[4096], picture[4096];
    Seen before, loaded, after;
    snprintf(path, sizeof path, "%s/lib/libtractrix.so.0", getenv("TRACTRIX_BIN"));
    snprintf(picture, sizeof picture, "%s", temporary_path(state, "x.png"));
    signal(SIGPIPE, on_signal);
    signal(SIGXFSZ, SIG_DFL);
    setvbuf(stdin, NULL, _IOFBF, 777);
    fesetround(FE_UPWARD);
    for (int own = 0; own < 2; ++own) { // with jansson's allocator, and with one of the host
        if (own) json_set_alloc_funcs(host_malloc, free);
        feclearexcept(FE_ALL_EXCEPT);
        see(&before);
        void *library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
        assert_non_null(library);
        see(&loaded);
        assert_memory_equal(&loaded, &before, sizeof before);
        use(library, picture);
        see(&after);
        after.exceptions = 0; // as every function of the C library may set them
        assert_memory_equal(&after, &before, sizeof before);
        json_t *value = json_pack("{s:[i]}", "a", 1);
        assert_non_null(value);
        json_decref(value);
    }
    fesetround(FE_TONEAREST);
    json_set_alloc_funcs(malloc, free);
}

int main(void)
{
    if (!getenv("TRACTRIX_BIN")) return 77;
    const struct CMUnitTest tests[] = {cmocka_unit_test_setup_teardown(
        a_host_finds_everything_as_before, temporary_create, temporary_destroy)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
