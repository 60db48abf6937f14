// SPDX-License-Identifier: MIT
#include "library/library.h"

#include "base/parallel.h"
#include "base/room.h"
#include "gpu/gl_state.h"
#include "gpu/gpu_current.h"
#include "gpu/shader.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// --- The thread of an own device. EGL's current context belongs to a thread, so the host's context
// stays current in the host's threads.

static void *serve(void *data)
{
    TractrixDevice *device = data;
    pthread_mutex_lock(&device->mutex);
    while (!device->ends) {
        if (!device->work) {
            pthread_cond_wait(&device->changed, &device->mutex);
            continue;
        }
        LibraryWork *work = device->work;
        pthread_mutex_unlock(&device->mutex);
        Result result = work(device->data, device->error);
        pthread_mutex_lock(&device->mutex);
        device->work = NULL;
        device->result = result;
        device->done = true;
        pthread_cond_broadcast(&device->changed);
    }
    pthread_mutex_unlock(&device->mutex);
    return NULL;
}

static Result ask(TractrixDevice *device, LibraryWork *work, void *data, Error *error)
{
    pthread_mutex_lock(&device->mutex);
    device->work = work;
    device->data = data;
    device->error = error;
    device->done = false;
    pthread_cond_broadcast(&device->changed);
    while (!device->done) pthread_cond_wait(&device->changed, &device->mutex);
    Result result = device->result;
    pthread_mutex_unlock(&device->mutex);
    return result;
}

static void end_thread(TractrixDevice *device)
{
    pthread_mutex_lock(&device->mutex);
    device->ends = true;
    pthread_cond_broadcast(&device->changed);
    pthread_mutex_unlock(&device->mutex);
    pthread_join(device->thread, NULL);
}

static Result close_gpu(void *data, Error *error)
{
    (void)error;
    gpu_destroy(data);
    return RESULT_OK;
}

Result library_on_device(TractrixDevice *device, LibraryWork *work, void *data, Error *error)
{
    if (device->process != getpid())
        return error_set(error, RESULT_NO_GL,
                         "the device was opened before fork(): expected a device of this process");
    if (!device->borrowed) return ask(device, work, data, error);
    GlState state;
    TRY(gpu_enter(&device->gpu, error));
    Result result = gl_state_take(&state, error);
    if (result == RESULT_OK) {
        result = work(data, error);
        gl_state_restore(&state);
    }
    gpu_leave();
    return result;
}

// --- Lifetime.

static atomic_int devices; // of this process; threads that wait for work end with the last one

void library_keep_device(TractrixDevice *device)
{
    atomic_fetch_add(&device->users, 1);
}

static void uncount_device(void)
{
    if (atomic_fetch_sub(&devices, 1) == 1) parallel_end();
}

static void free_device(TractrixDevice *device)
{
    free(device);
    uncount_device();
}

void library_drop_device(TractrixDevice *device)
{
    Error unused;
    if (atomic_fetch_sub(&device->users, 1) > 1) return;
    if (device->process != getpid()) { // a fork: thread, context, locks are the parent's
        uncount_device();
        return;
    }
    if (library_on_device(device, close_gpu, &device->gpu, &unused) != RESULT_OK)
        gpu_lose(&device->gpu); // the host's context is gone
    if (!device->borrowed) {
        end_thread(device);
        pthread_cond_destroy(&device->changed);
        pthread_mutex_destroy(&device->mutex);
    }
    free_device(device);
}

void tractrix_device_destroy(TractrixDevice *device)
{
    LIBRARY_CALL;
    if (device) library_drop_device(device);
}

static Result create(TractrixDevice **device, Error *error)
{
    *device = calloc(1, sizeof **device);
    if (!*device) return error_set(error, RESULT_FAILED, "no memory for a device");
    (*device)->users = 1;
    (*device)->process = getpid();
    atomic_fetch_add(&devices, 1);
    room_keep_freed();
    shader_ignore_environment();
    return RESULT_OK;
}

typedef struct Opening {
    Gpu *gpu;
    GpuOptions options;
} Opening;

static Result open_gpu(void *data, Error *error)
{
    Opening *opening = data;
    return gpu_create(opening->gpu, &opening->options, error);
}

static Result start(TractrixDevice *device, Error *error)
{
    pthread_mutex_init(&device->mutex, NULL);
    pthread_cond_init(&device->changed, NULL);
    int reason = parallel_start(&device->thread, serve, device);
    if (reason == 0) return RESULT_OK;
    pthread_cond_destroy(&device->changed);
    pthread_mutex_destroy(&device->mutex);
    return error_set(error, RESULT_FAILED, "a device's thread cannot be started: %s",
                     strerror(reason));
}

// EGL's displays and the threads of CPU drivers belong to the process that has opened a device,
// also after the device has been destroyed. In a forked child they would wait for ever.
static Result check_process(Error *error)
{
    static atomic_int opener; // 0: no process yet
    int before = 0, own = (int)getpid();
    if (atomic_compare_exchange_strong(&opener, &before, own) || before == own) return RESULT_OK;
    return error_set(
        error, RESULT_NO_GL,
        "tractrix_device_open was called before fork(), and drivers do not survive it: "
        "expected its first call after fork(), or exec() in the child");
}

static Result open_device(TractrixDevice **device, const TractrixDeviceOptions *asked, Error *error)
{
    TractrixDeviceOptions options = {.size = sizeof options};
    if (asked) TRY(library_take(&options, sizeof options, asked, sizeof options, "options", error));
    if (options.software && options.require_hardware)
        return error_set(error, RESULT_USAGE,
                         "options: software and require_hardware: expected only one of them");
    TRY(check_process(error));
    TRY(create(device, error));
    Opening opening = {&(*device)->gpu,
                       {.backend = BACKEND_EGL,
                        .device = options.name,
                        .software = options.software,
                        .require_hardware = options.require_hardware}};
    Result result = start(*device, error);
    if (result == RESULT_OK) {
        result = ask(*device, open_gpu, &opening, error);
        if (result == RESULT_OK) return RESULT_OK;
        tractrix_device_destroy(*device);
    } else {
        free_device(*device);
    }
    *device = NULL;
    return result;
}

TractrixResult tractrix_device_open(TractrixDevice **device, const TractrixDeviceOptions *options,
                                    TractrixError *error)
{
    LIBRARY_CALL;
    Error why = {{0}};
    if (!device) return library_refuse(error, "device: got NULL");
    *device = NULL;
    return library_end(open_device(device, options, &why), &why, error);
}

TractrixResult tractrix_device_borrow(TractrixDevice **device, TractrixError *error)
{
    LIBRARY_CALL;
    Error why = {{0}};
    GlState state;
    if (!device) return library_refuse(error, "device: got NULL");
    Result result = create(device, &why);
    if (result != RESULT_OK) return library_end(result, &why, error);
    (*device)->borrowed = true;
    result = gpu_current_check(&why);
    THEN(result, gl_state_take(&state, &why));
    if (result == RESULT_OK) {
        result = gpu_borrow(&(*device)->gpu, &why);
        gl_state_restore(&state);
    }
    if (result == RESULT_OK) {
        gpu_leave();
    } else {
        free_device(*device);
        *device = NULL;
    }
    return library_end(result, &why, error);
}

void tractrix_device_set_progress(TractrixDevice *device, TractrixProgress *progress, void *data)
{
    LIBRARY_CALL;
    if (!device) return;
    device->progress = progress;
    device->progress_data = data;
}

const char *tractrix_device_text(const TractrixDevice *device, const char *what)
{
    LIBRARY_CALL;
    if (!device) return "";
    const Gpu *gpu = &device->gpu;
    const struct {
        const char *what, *text;
    } texts[] = {
        {"renderer", gpu->renderer},
        {"version", gpu->version},
        {"vendor", gpu->vendor},
        {"processor", gpu->processor},
        {"path", gpu->path},
        {"pci", gpu->identity.pci},
        {"uuid", gpu->identity.uuid},
        {"node", gpu->identity.node},
        {"passed-over", gpu->passed_over.text},
    };
    for (size_t i = 0; what && i < sizeof texts / sizeof *texts; ++i)
        if (strcmp(texts[i].what, what) == 0) return texts[i].text;
    return "";
}
