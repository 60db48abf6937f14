// SPDX-License-Identifier: MIT
#include "gpu/gpu.h"
#include "base/quote.h"
#include "gpu/gpu_egl.h"

#include <epoxy/gl.h>

#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>

// --- OSMesa: Mesa's llvmpipe without EGL, loaded at run time.

// The few names of <GL/osmesa.h> that are needed, so that building does not need its package.
enum {
    OSMESA_FORMAT = 0x22,
    OSMESA_DEPTH_BITS = 0x30,
    OSMESA_PROFILE = 0x33,
    OSMESA_CORE_PROFILE = 0x34,
    OSMESA_CONTEXT_MAJOR_VERSION = 0x36,
    OSMESA_CONTEXT_MINOR_VERSION = 0x37,
};

typedef void (*AnyFunction)(void);
typedef struct GpuOsMesa OsMesa;

struct GpuOsMesa {
    void *context;
    uint32_t pixel; // the default framebuffer, which nothing draws to
    void *(*create)(const int *attributes, void *share);
    void (*destroy)(void *context);
    GLboolean (*make_current)(void *context, void *buffer, GLenum type, GLsizei width,
                              GLsizei height);
    AnyFunction (*get_function)(const char *name);
};

// POSIX promises that dlsym gives functions, too; ISO C has no cast that says so, a copy of the
// bytes does.
static void load(void *library, const char *name, void *function)
{
    void *address = dlsym(library, name);
    memcpy(function, &address, sizeof address);
}

// libepoxy resolves a name when it is first called and insists on EGL or GLX for that; its names
// are plain pointers, though.
static bool fill_functions(const OsMesa *mesa)
{
    bool complete = true;
    AnyFunction function;
#define GL_FUNCTION(name)                                                                          \
    function = mesa->get_function(#name);                                                          \
    memcpy(&epoxy_##name, &function, sizeof function);                                             \
    complete = complete && function;
#include "gpu/gl_functions.def"
#undef GL_FUNCTION
    return complete;
}

static Result open_osmesa(OsMesa *mesa, Error *error)
{
    static const int attributes[] = {OSMESA_FORMAT,
                                     GL_RGBA,
                                     OSMESA_DEPTH_BITS,
                                     0,
                                     OSMESA_PROFILE,
                                     OSMESA_CORE_PROFILE,
                                     OSMESA_CONTEXT_MAJOR_VERSION,
                                     4,
                                     OSMESA_CONTEXT_MINOR_VERSION,
                                     3,
                                     0};
    void *library = dlopen("libOSMesa.so.8", RTLD_NOW | RTLD_LOCAL);
    if (!library) return error_set(error, RESULT_NO_GL, "libOSMesa.so.8 is not installed");
    load(library, "OSMesaCreateContextAttribs", &mesa->create);
    load(library, "OSMesaDestroyContext", &mesa->destroy);
    load(library, "OSMesaMakeCurrent", &mesa->make_current);
    load(library, "OSMesaGetProcAddress", &mesa->get_function);
    if (!mesa->create || !mesa->destroy || !mesa->make_current || !mesa->get_function)
        return error_set(error, RESULT_NO_GL, "libOSMesa.so.8 lacks OSMesaCreateContextAttribs");
    mesa->context = mesa->create(attributes, NULL);
    if (!mesa->context) return error_set(error, RESULT_NO_GL, "OSMesa has no OpenGL 4.3 core");
    if (!mesa->make_current(mesa->context, &mesa->pixel, GL_UNSIGNED_BYTE, 1, 1))
        return error_set(error, RESULT_NO_GL, "OSMesa can't make its context current");
    if (!fill_functions(mesa))
        return error_set(error, RESULT_NO_GL, "OSMesa lacks an OpenGL 4.3 function");
    return RESULT_OK; // cppcheck-suppress resourceLeak // LLVM's handlers must outlive the library
}

// --- What a context offers.

static void copy_string(char *to, size_t size, GLenum name)
{
    const char *text = (const char *)glGetString(name);
    snprintf(to, size, "%s", text ? text : "unknown");
}

static void read_processor(char name[256])
{
    char line[512];
    FILE *info = fopen("/proc/cpuinfo", "r");
    snprintf(name, 256, "unknown");
    while (info && fgets(line, sizeof line, info))
        if (sscanf(line, "model name : %255[^\n]", name) == 1) break;
    if (info) fclose(info);
}

// A device may call itself software and be hardware, or the other way round: the renderer's name
// decides.
static bool is_cpu_driver(const char *renderer)
{
    static const char *const names[] = {"llvmpipe",    "softpipe", "swrast",
                                        "SwiftShader", "lavapipe", "SWR"};
    for (size_t i = 0; i < sizeof names / sizeof *names; ++i)
        if (strcasestr(renderer, names[i])) return true;
    return false;
}

static int query_int(GLenum name)
{
    GLint value = 0;
    glGetIntegerv(name, &value);
    return value;
}

// GL 4.3 guarantees shader storage in compute shaders only; vertex and fragment stages get theirs
// by buffer texture and images.
static Result read_limits(Gpu *gpu, const GpuOptions *options, Error *error)
{
    copy_string(gpu->renderer, sizeof gpu->renderer, GL_RENDERER);
    copy_string(gpu->version, sizeof gpu->version, GL_VERSION);
    copy_string(gpu->vendor, sizeof gpu->vendor, GL_VENDOR);
    read_processor(gpu->processor);
    gpu->software = is_cpu_driver(gpu->renderer);
    gpu->kind = gpu->software && !options->assume_hardware ? GPU_CPU_DRIVER : GPU_HARDWARE;
    int version = 10 * query_int(GL_MAJOR_VERSION) + query_int(GL_MINOR_VERSION);
    if (version < 43)
        return error_set(error, RESULT_NO_GL, "%s has OpenGL %d.%d, 4.3 is needed", gpu->renderer,
                         version / 10, version % 10);
    int side_px = query_int(GL_MAX_TEXTURE_SIZE), layer_px = query_int(GL_MAX_FRAMEBUFFER_WIDTH);
    gpu->limits = (GpuLimits){
        .storage_block = query_int(GL_MAX_SHADER_STORAGE_BLOCK_SIZE),
        .texture_texels = query_int(GL_MAX_TEXTURE_BUFFER_SIZE),
        .framebuffer_side_px = layer_px && layer_px < side_px ? layer_px : side_px,
        .work_groups = 65535,
        .sizes = GPU_SIZES[gpu->kind],
    };
    if (query_int(GL_MAX_FRAGMENT_SHADER_STORAGE_BLOCKS) < 4)
        return error_set(error, RESULT_NO_GL, "%s has no shader storage in fragment shaders",
                         gpu->renderer);
    return RESULT_OK;
}

static Result accept(Gpu *gpu, const GpuOptions *options, const char *path, Error *error)
{
    snprintf(gpu->path, sizeof gpu->path, "%s", path);
    TRY(read_limits(gpu, options, error));
    if (options->require_hardware && gpu->software)
        return error_set(error, RESULT_NO_GL, "%s is a CPU driver", gpu->renderer);
    if (options->software && !gpu->software)
        return error_set(error, RESULT_NO_GL, "%s is not a CPU driver", gpu->renderer);
    return RESULT_OK;
}

// --- The ways to a context.

static Result try_egl(Gpu *gpu, const GpuOptions *options, void *device, const char *path,
                      Error *error)
{
    TRY(gpu_egl_create(&gpu->egl, device, options->debug, error));
    Result result = accept(gpu, options, path, error);
    if (result != RESULT_OK) gpu_destroy(gpu);
    return result;
}

static Result try_osmesa(Gpu *gpu, const GpuOptions *options, Error *error)
{
    if (options->require_hardware) return error_set(error, RESULT_NO_GL, "OSMesa draws on the CPU");
    gpu->osmesa = calloc(1, sizeof *gpu->osmesa);
    if (!gpu->osmesa) return error_set(error, RESULT_FAILED, "no memory for a context");
    Result result = open_osmesa(gpu->osmesa, error);
    THEN(result, accept(gpu, options, "OSMesa", error));
    if (result != RESULT_OK) gpu_destroy(gpu);
    return result;
}

// Adds to the one line that the user gets if nothing works, as long as there is room.
static void note_failure(Error *attempts, const char *path, const Error *why)
{
    size_t used = strlen(attempts->text), room = sizeof attempts->text - used;
    int length =
        snprintf(attempts->text + used, room, "%s%s: %s", used ? "; " : "", path, why->text);
    if (length < 0 || (size_t)length >= room) attempts->text[used] = 0;
}

// Hardware devices first, so that the fastest is taken where both are there.
static Result try_devices(Gpu *gpu, const GpuOptions *options, Error *attempts)
{
    Error why;
    EglDevices devices;
    if (gpu_egl_find_devices(&devices, &why) != RESULT_OK)
        note_failure(attempts, "EGL devices", &why);
    for (int pass = 0; pass < 2; ++pass)
        for (int i = 0; i < devices.count; ++i) {
            char path[64];
            snprintf(path, sizeof path, "EGL device %d", i);
            if (devices.software[i] != (pass == 1) ||
                (options->device >= 0 && options->device != i))
                continue;
            if (try_egl(gpu, options, devices.device[i], path, &why) == RESULT_OK) return RESULT_OK;
            note_failure(attempts, path, &why);
        }
    if (options->device >= devices.count) {
        error_set(&why, RESULT_NO_GL, "no device %d, there are %d (see --list-devices)",
                  options->device, devices.count);
        note_failure(attempts, "--device", &why);
    }
    return RESULT_NO_GL;
}

static Result try_all(Gpu *gpu, const GpuOptions *options, Error *attempts)
{
    Error why;
    bool any_path = options->device < 0;
    if (options->backend != BACKEND_OSMESA) {
        if (try_devices(gpu, options, attempts) == RESULT_OK) return RESULT_OK;
        if (any_path && try_egl(gpu, options, NULL, "EGL surfaceless", &why) == RESULT_OK)
            return RESULT_OK;
        if (any_path) note_failure(attempts, "EGL surfaceless", &why);
    }
    if (options->backend != BACKEND_EGL && any_path) {
        if (try_osmesa(gpu, options, &why) == RESULT_OK) return RESULT_OK;
        note_failure(attempts, "OSMesa", &why);
    }
    return RESULT_NO_GL;
}

static void APIENTRY print_message(GLenum source, GLenum type, GLuint id, GLenum severity,
                                   GLsizei length, const GLchar *text, const void *user)
{
    (void)source, (void)id, (void)length, (void)user;
    if (severity == GL_DEBUG_SEVERITY_NOTIFICATION || type == GL_DEBUG_TYPE_PERFORMANCE) return;
    fprintf(stderr, "tractrix: GL: %s\n", quote(text).text);
}

Result gpu_create(Gpu *gpu, const GpuOptions *options, Error *error)
{
    *gpu = (Gpu){0};
    Error attempts = {{0}};
    if (try_all(gpu, options, &attempts) != RESULT_OK)
        return error_set(
            error, RESULT_NO_GL,
            "no usable OpenGL 4.3 (%s); on Debian the packages libegl1, "
            "libopengl0 and libgl1-mesa-dri give a CPU driver, in a container on NVIDIA the "
            "'graphics' driver capability is needed",
            attempts.text);
    if (options->debug) {
        glEnable(GL_DEBUG_OUTPUT);
        glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
        glDebugMessageCallback(print_message, NULL);
    }
    return RESULT_OK;
}

void gpu_destroy(Gpu *gpu)
{
    gpu_egl_destroy(&gpu->egl);
    if (gpu->osmesa && gpu->osmesa->context) gpu->osmesa->destroy(gpu->osmesa->context);
    free(gpu->osmesa);
    *gpu = (Gpu){0};
}

static bool list_one(FILE *stream, Gpu *gpu, Result result, const char *name, const Error *why)
{
    if (result == RESULT_OK)
        fprintf(stream, "%-17s %s, OpenGL %s%s\n", name, quote(gpu->renderer).text,
                quote(gpu->version).text, gpu->software ? " (CPU)" : "");
    else
        fprintf(stream, "%-17s not usable: %s\n", name, why->text);
    gpu_destroy(gpu);
    return result == RESULT_OK;
}

Result gpu_list_devices(FILE *stream, Error *error)
{
    Gpu gpu = {0};
    Error why;
    EglDevices devices;
    const GpuOptions any = {.device = -1};
    bool usable = false;
    if (gpu_egl_find_devices(&devices, &why) != RESULT_OK)
        list_one(stream, &gpu, RESULT_NO_GL, "EGL devices", &why);
    for (int i = 0; i < devices.count; ++i) {
        char name[32];
        snprintf(name, sizeof name, "--device %d", i);
        usable |=
            list_one(stream, &gpu, try_egl(&gpu, &any, devices.device[i], name, &why), name, &why);
    }
    usable |= list_one(stream, &gpu, try_egl(&gpu, &any, NULL, "EGL surfaceless", &why),
                       "EGL surfaceless", &why);
    usable |= list_one(stream, &gpu, try_osmesa(&gpu, &any, &why), "--backend osmesa", &why);
    return usable ? RESULT_OK : error_set(error, RESULT_NO_GL, "no usable OpenGL 4.3 device");
}

Result gpu_check(const char *what, Error *error)
{
    GLenum code = glGetError();
    if (code == GL_NO_ERROR) return RESULT_OK;
    return error_set(error, RESULT_FAILED, "%s: OpenGL error 0x%04x%s", what, code,
                     code == GL_OUT_OF_MEMORY ? " (out of memory)" : "");
}
