// SPDX-License-Identifier: MIT
#include "gpu/gpu.h"
#include "base/quote.h"
#include "gpu/gpu_current.h"
#include "gpu/gpu_egl.h"
#include "gpu/gpu_osmesa.h"
#include "gpu/gpu_uniforms.h"
#include "gpu/shader.h"

#include <epoxy/gl.h>

#include <stdlib.h>
#include <string.h>
#include <sys/utsname.h>

// What is kept for the next scene while nobody uses it. On a CPU driver a program takes about half
// a MB (37 forms of a solver: 20 MB); a table takes 5 MB.
enum { MOST_PROGRAMS = 64, MOST_TABLES = 4 };

static const Gpu NOBODY; // for threads whose context belongs to the host again

// --- What the context can do.

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

// An EGL device's software flag is not reliable in either direction, so the renderer's name
// decides.
static bool is_cpu_driver(const char *renderer)
{
    static const char *const names[] = {"llvmpipe",    "softpipe", "swrast",
                                        "SwiftShader", "lavapipe", "SWR"};
    for (size_t i = 0; i < sizeof names / sizeof *names; ++i)
        if (strcasestr(renderer, names[i])) return true;
    return false;
}

static int64_t query_int64(GLenum name)
{
    GLint64 value = 0;
    glGetInteger64v(name, &value);
    return value;
}

static int query_int(GLenum name)
{
    GLint value = 0;
    glGetIntegerv(name, &value);
    return value;
}

// GL 4.3 guarantees storage buffers only in compute shaders. Vertex and fragment shaders read
// through buffer textures and images instead.
static Result read_limits(Gpu *gpu, Error *error)
{
    copy_string(gpu->renderer, sizeof gpu->renderer, GL_RENDERER);
    copy_string(gpu->version, sizeof gpu->version, GL_VERSION);
    copy_string(gpu->vendor, sizeof gpu->vendor, GL_VENDOR);
    read_processor(gpu->processor);
    gpu->software = is_cpu_driver(gpu->renderer);
    gpu->kind = gpu->software ? GPU_CPU_DRIVER : GPU_HARDWARE;
    int version = 10 * query_int(GL_MAJOR_VERSION) + query_int(GL_MINOR_VERSION);
    if (version < 43)
        return error_set(error, RESULT_NO_GL, "%s has OpenGL %d.%d: expected 4.3 or newer",
                         gpu->renderer, version / 10, version % 10);
    int side_px = query_int(GL_MAX_TEXTURE_SIZE), layer_px = query_int(GL_MAX_FRAMEBUFFER_WIDTH);
    gpu->limits = (GpuLimits){
        .storage_block = query_int64(GL_MAX_SHADER_STORAGE_BLOCK_SIZE),
        .texture_texels = query_int64(GL_MAX_TEXTURE_BUFFER_SIZE),
        .framebuffer_side_px = layer_px && layer_px < side_px ? layer_px : side_px,
        .work_groups = 65535,
    };
    if (query_int(GL_MAX_FRAGMENT_SHADER_STORAGE_BLOCKS) < 4)
        return error_set(error, RESULT_NO_GL, "%s has no shader storage in fragment shaders",
                         gpu->renderer);
    return RESULT_OK;
}

static void name_platform(Gpu *gpu)
{
    struct utsname system;
    const PlatformFacts facts = {.vendor = gpu->vendor,
                                 .renderer = gpu->renderer,
                                 .version = gpu->version,
                                 .machine = uname(&system) == 0 ? system.machine : "",
                                 .software = gpu->software,
                                 .fma = platform_has_fma(),
                                 .assumed = gpu->software && gpu->kind == GPU_HARDWARE};
    platform_name(gpu->platform, &facts);
}

// Applies the assumptions of tests, and sets the limits that depend on the kind of device.
static void assume(Gpu *gpu, const Assumptions *assumptions)
{
    GpuLimits *limits = &gpu->limits;
    if (assumptions->hardware && gpu->software) {
        gpu->kind = GPU_HARDWARE;
        size_t used = strlen(gpu->renderer);
        snprintf(gpu->renderer + used, sizeof gpu->renderer - used, " assumed to be hardware");
    }
    gpu->ulps = assumptions->ulps;
    limits->sizes = GPU_SIZES[gpu->kind];
    if (assumptions->groups && assumptions->groups < limits->work_groups)
        limits->work_groups = assumptions->groups;
    if (assumptions->side_px && assumptions->side_px < limits->framebuffer_side_px)
        limits->framebuffer_side_px = assumptions->side_px;
}

// --- Finding a context.

// The results of the search so far.
typedef struct Search {
    GpuOptions options;
    Assumptions assumptions;
    Error attempts; // the errors of all failed attempts
    Error hardware; // those of them that concern hardware
} Search;

static bool asks_for_device(const GpuOptions *options)
{
    return options->device && *options->device;
}

static Result accept(Gpu *gpu, const Search *search, int number, Error *error)
{
    const GpuOptions *options = &search->options;
    TRY(read_limits(gpu, error));
    if (options->require_hardware && gpu->software)
        return error_set(error, RESULT_NO_GL, "%s is a CPU driver", gpu->renderer);
    if (options->software && !gpu->software)
        return error_set(error, RESULT_NO_GL, "%s is not a CPU driver", gpu->renderer);
    if (asks_for_device(options) &&
        !gpu_device_is(options->device, number, gpu->renderer, gpu->vendor, &gpu->identity))
        return error_set(error, RESULT_NO_GL, "%s is not %s", gpu->renderer, options->device);
    assume(gpu, &search->assumptions);
    name_platform(gpu);
    return RESULT_OK;
}

// `device` NULL means the surfaceless platform.
static Result try_egl(Gpu *gpu, const Search *search, const GpuDevice *device, int number,
                      Error *error)
{
    if (device)
        snprintf(gpu->path, sizeof gpu->path, "EGL device %d", number);
    else
        snprintf(gpu->path, sizeof gpu->path, "EGL surfaceless");
    TRY(gpu_egl_create(&gpu->egl, device ? device->egl : NULL, search->options.debug != NULL,
                       error));
    gpu->identity = gpu_device_identify(device);
    Result result = accept(gpu, search, number, error);
    if (result != RESULT_OK) gpu_destroy(gpu);
    return result;
}

static Result try_osmesa(Gpu *gpu, const Search *search, Error *error)
{
    if (search->options.require_hardware)
        return error_set(error, RESULT_NO_GL, "OSMesa draws on the CPU, not on a GPU");
    TRY(gpu_osmesa_create(&gpu->osmesa, error));
    snprintf(gpu->path, sizeof gpu->path, "OSMesa");
    Result result = accept(gpu, search, -1, error);
    if (result != RESULT_OK) gpu_destroy(gpu);
    return result;
}

// Appends a reason to the line, as long as there is room.
static void note_failure(Error *line, const char *path, const Error *why)
{
    size_t used = strlen(line->text), room = sizeof line->text - used;
    int length = snprintf(line->text + used, room, "%s%s: %s", used ? "; " : "", path, why->text);
    if (length < 0 || (size_t)length >= room) line->text[used] = 0;
}

static bool is_passed_over(const GpuDevice *device, const GpuOptions *options, int number)
{
    char own[16];
    snprintf(own, sizeof own, "%d", number);
    bool other = asks_for_device(options) &&
                 strspn(options->device, "0123456789") == strlen(options->device) &&
                 strtol(options->device, NULL, 10) != number;
    return other || (options->software && !device->software);
}

// Tries hardware devices first, because they are faster.
static Result try_devices(Gpu *gpu, Search *search)
{
    Error why;
    GpuDevices devices;
    if (gpu_egl_find_devices(&devices, &why) != RESULT_OK)
        note_failure(&search->attempts, "EGL devices", &why);
    for (int pass = 0; pass < 2; ++pass)
        for (int i = 0; i < devices.count; ++i) {
            const GpuDevice *device = &devices.device[i];
            if (device->software != (pass == 1) || is_passed_over(device, &search->options, i))
                continue;
            if (try_egl(gpu, search, device, i, &why) == RESULT_OK) return RESULT_OK;
            char path[32];
            snprintf(path, sizeof path, "EGL device %d", i);
            note_failure(&search->attempts, path, &why);
            if (!device->software) note_failure(&search->hardware, path, &why);
        }
    return RESULT_NO_GL;
}

static Result try_all(Gpu *gpu, Search *search)
{
    Error why;
    const GpuOptions *options = &search->options;
    bool any_path = !asks_for_device(options);
    if (options->backend != BACKEND_OSMESA) {
        if (try_devices(gpu, search) == RESULT_OK) return RESULT_OK;
        if (any_path && try_egl(gpu, search, NULL, -1, &why) == RESULT_OK) return RESULT_OK;
        if (any_path) note_failure(&search->attempts, "EGL surfaceless", &why);
    }
    if (options->backend != BACKEND_EGL && any_path) {
        if (try_osmesa(gpu, search, &why) == RESULT_OK) return RESULT_OK;
        note_failure(&search->attempts, "OSMesa", &why);
    }
    return RESULT_NO_GL;
}

// Explains why a CPU driver was chosen although nobody asked for one; empty if there is no GPU.
static void explain_choice(Gpu *gpu, const Search *search)
{
    const GpuOptions *options = &search->options;
    if (!gpu->software || options->software || asks_for_device(options) ||
        options->backend == BACKEND_OSMESA)
        return;
    if (*search->hardware.text)
        gpu->passed_over = search->hardware;
    else
        gpu_device_explain("/dev", &gpu->passed_over);
}

static void APIENTRY print_message(GLenum source, GLenum type, GLuint id, GLenum severity,
                                   GLsizei length, const GLchar *text, const void *user)
{
    (void)source, (void)id, (void)length;
    if (severity == GL_DEBUG_SEVERITY_NOTIFICATION || type == GL_DEBUG_TYPE_PERFORMANCE) return;
    fprintf((FILE *)user, "tractrix: GL: %s\n", quote(text).text);
}

static Result refuse(const Search *search, Error *error)
{
    Error sign = {{0}}; // of a GPU that was not used
    if (asks_for_device(&search->options))
        return error_set(error, RESULT_NO_GL,
                         "--device %s: no such device: %s (see --list-devices)",
                         search->options.device,
                         *search->attempts.text ? search->attempts.text : "there are fewer");
    if (!search->options.software && search->options.backend != BACKEND_OSMESA)
        gpu_device_explain("/dev", &sign);
    return error_set(error, RESULT_NO_GL,
                     "no usable OpenGL 4.3 (%s%s%s): expected a GPU with its driver, or a CPU "
                     "driver (on Debian the packages libegl1, libopengl0 and libgl1-mesa-dri); a "
                     "container with an NVIDIA GPU needs the driver capability 'graphics'",
                     search->attempts.text, *sign.text ? "; " : "", sign.text);
}

static void use(const Gpu *gpu)
{
    gpu_uniforms_use(gpu->uniforms);
    shader_use_programs(gpu->programs);
    shader_assume_ulps(gpu->ulps);
}

static Result make_room(Gpu *gpu, Error *error)
{
    gpu->uniforms = gpu_uniforms_create();
    gpu->programs = calloc(1, sizeof *gpu->programs);
    gpu->tables = calloc(1, sizeof *gpu->tables);
    if (!gpu->uniforms || !gpu->programs || !gpu->tables) {
        gpu_destroy(gpu);
        return error_set(error, RESULT_FAILED, "no memory for the data that scenes share");
    }
    gpu->programs->most = MOST_PROGRAMS;
    gpu->tables->most = MOST_TABLES;
    use(gpu);
    return RESULT_OK;
}

Result gpu_create(Gpu *gpu, const GpuOptions *options, Error *error)
{
    *gpu = (Gpu){0};
    Search search = {.options = *options};
    TRY(assumptions_read(&search.assumptions, error));
    if (try_all(gpu, &search) != RESULT_OK) return refuse(&search, error);
    TRY(make_room(gpu, error));
    explain_choice(gpu, &search);
    if (options->debug) {
        glEnable(GL_DEBUG_OUTPUT);
        glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
        glDebugMessageCallback(print_message, options->debug);
    }
    return RESULT_OK;
}

// Without a current context libepoxy would end the program, so that is checked first.
Result gpu_borrow(Gpu *gpu, Error *error)
{
    Assumptions assumptions;
    *gpu = (Gpu){0};
    snprintf(gpu->path, sizeof gpu->path, "borrowed");
    TRY(assumptions_read(&assumptions, error));
    TRY(gpu_current_check(error));
    gpu_error_forget();
    TRY(read_limits(gpu, error));
    assume(gpu, &assumptions);
    return make_room(gpu, error);
}

Result gpu_enter(const Gpu *gpu, Error *error)
{
    TRY(gpu_current_check(error));
    gpu_error_forget();
    use(gpu);
    gpu_uniforms_forget();
    return RESULT_OK;
}

void gpu_leave(void)
{
    use(&NOBODY);
    gpu_error_forget();
}

static void end_stock(Stock *stock, bool lost)
{
    if (stock) stock_destroy(stock, lost);
    free(stock);
}

static void end(Gpu *gpu, bool lost)
{
    end_stock(gpu->tables, lost);
    shader_forget_programs(gpu->programs);
    end_stock(gpu->programs, lost);
    gpu_uniforms_destroy(gpu->uniforms, lost);
    gpu_egl_destroy(&gpu->egl);
    gpu_osmesa_destroy(gpu->osmesa);
    *gpu = (Gpu){0};
}

void gpu_destroy(Gpu *gpu)
{
    end(gpu, false);
}

void gpu_lose(Gpu *gpu)
{
    end(gpu, true);
}

// --- The list of devices.

static void list_identity(FILE *stream, const Gpu *gpu)
{
    const GpuIdentity *identity = &gpu->identity;
    fprintf(stream, "%18s%s", "", quote(gpu->vendor).text);
    if (*identity->pci) fprintf(stream, ", PCI %s", quote(identity->pci).text);
    if (*identity->uuid) fprintf(stream, ", UUID %s", identity->uuid);
    if (identity->memory) fprintf(stream, ", %.1f GiB", (double)identity->memory / 0x1p30);
    if (*identity->node) fprintf(stream, ", %s", quote(identity->node).text);
    fputc('\n', stream);
}

static bool list_one(FILE *stream, Gpu *gpu, Result result, const char *name, const Error *why)
{
    if (result == RESULT_OK) {
        fprintf(stream, "%-17s %s, OpenGL %s%s\n", name, quote(gpu->renderer).text,
                quote(gpu->version).text, gpu->software ? " (CPU)" : "");
        list_identity(stream, gpu);
    } else {
        fprintf(stream, "%-17s not usable: %s\n", name, why->text);
    }
    gpu_destroy(gpu);
    return result == RESULT_OK;
}

static bool has_hardware(const GpuDevices *devices)
{
    for (int i = 0; i < devices->count; ++i)
        if (!devices->device[i].software) return true;
    return false;
}

Result gpu_list_devices(FILE *stream, Error *error)
{
    Gpu gpu = {0};
    Error why;
    GpuDevices devices;
    const Search any = {.options = {0}};
    bool usable = false;
    Error sign;
    if (gpu_egl_find_devices(&devices, &why) != RESULT_OK)
        list_one(stream, &gpu, RESULT_NO_GL, "EGL devices", &why);
    for (int i = 0; i < devices.count; ++i) {
        char name[32];
        snprintf(name, sizeof name, "--device %d", i);
        Result result = try_egl(&gpu, &any, &devices.device[i], i, &why);
        usable |= list_one(stream, &gpu, result, name, &why);
    }
    usable |= list_one(stream, &gpu, try_egl(&gpu, &any, NULL, -1, &why), "EGL surfaceless", &why);
    usable |= list_one(stream, &gpu, try_osmesa(&gpu, &any, &why), "--backend osmesa", &why);
    gpu_device_explain("/dev", &sign);
    if (*sign.text && !has_hardware(&devices)) fprintf(stream, "%s\n", sign.text);
    return usable ? RESULT_OK : error_set(error, RESULT_NO_GL, "no usable OpenGL 4.3 device");
}
