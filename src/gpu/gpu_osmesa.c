// SPDX-License-Identifier: MIT
#include "gpu/gpu_osmesa.h"

#include <epoxy/gl.h>

#include <dlfcn.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

// Declares the few constants of <GL/osmesa.h> that are used, so that building needs no package for
// it.
enum {
    OSMESA_FORMAT = 0x22,
    OSMESA_DEPTH_BITS = 0x30,
    OSMESA_PROFILE = 0x33,
    OSMESA_CORE_PROFILE = 0x34,
    OSMESA_CONTEXT_MAJOR_VERSION = 0x36,
    OSMESA_CONTEXT_MINOR_VERSION = 0x37,
};

typedef void (*AnyFunction)(void);
struct GpuOsMesa {
    void *context;
    uint32_t pixel; // storage of the default framebuffer, which is never drawn to
    void *(*create)(const int *attributes, void *share);
    void (*destroy)(void *context);
    GLboolean (*make_current)(void *context, void *buffer, GLenum type, GLsizei width,
                              GLsizei height);
    AnyFunction (*get_function)(const char *name);
};

// POSIX lets dlsym return functions, but ISO C has no cast from an object pointer to a function
// pointer, so the bytes are copied.
static void load(void *library, const char *name, void *function)
{
    void *address = dlsym(library, name);
    memcpy(function, &address, sizeof address);
}

// libepoxy resolves a name at its first call, for which it requires EGL or GLX. Its names are plain
// function pointers, so they can be set here.
static bool fill_functions(const GpuOsMesa *mesa)
{
    bool complete = true;
    AnyFunction function;
#define GL_FUNCTION(type, name, parameters, arguments)                                             \
    function = mesa->get_function(#name);                                                          \
    memcpy(&epoxy_##name, &function, sizeof function);                                             \
    complete = complete && function;
#define GL_VALUE GL_FUNCTION
#include "gpu/gl_functions.def"
#undef GL_FUNCTION
#undef GL_VALUE
    return complete;
}

// OSMesa of Mesa 22.3 crashes if it does not know the driver.
static Result check_driver(Error *error)
{
    const char *driver = getenv("GALLIUM_DRIVER");
    if (!driver || !*driver || strcmp(driver, "llvmpipe") == 0 || strcmp(driver, "softpipe") == 0)
        return RESULT_OK;
    return error_set(error, RESULT_NO_GL, "GALLIUM_DRIVER is '%s': expected llvmpipe or softpipe",
                     driver);
}

static Result open_osmesa(GpuOsMesa *mesa, Error *error)
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
    TRY(check_driver(error));
    mesa->context = mesa->create(attributes, NULL);
    if (!mesa->context) return error_set(error, RESULT_NO_GL, "OSMesa has no OpenGL 4.3 core");
    if (!mesa->make_current(mesa->context, &mesa->pixel, GL_UNSIGNED_BYTE, 1, 1))
        return error_set(error, RESULT_NO_GL, "OSMesa can't make its context current");
    if (!fill_functions(mesa))
        return error_set(error, RESULT_NO_GL, "OSMesa lacks an OpenGL 4.3 function");
    return RESULT_OK; // cppcheck-suppress resourceLeak // LLVM's handlers must outlive the library
}

Result gpu_osmesa_create(GpuOsMesa **mesa, Error *error)
{
    *mesa = calloc(1, sizeof **mesa);
    if (!*mesa) return error_set(error, RESULT_FAILED, "no memory for a context");
    Result result = open_osmesa(*mesa, error);
    if (result == RESULT_OK) return RESULT_OK;
    gpu_osmesa_destroy(*mesa);
    *mesa = NULL;
    return result;
}

void gpu_osmesa_destroy(GpuOsMesa *mesa)
{
    if (mesa && mesa->context) mesa->destroy(mesa->context);
    free(mesa);
}
