// SPDX-License-Identifier: MIT
#include "gpu/gpu_osmesa.h"

#include <epoxy/gl.h>

#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>

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

typedef struct OsMesa {
    void *library;
    void *context;
    uint32_t pixel; // the default framebuffer, which nothing draws to
    void *(*create)(const int *attributes, void *share);
    void (*destroy)(void *context);
    GLboolean (*make_current)(void *context, void *buffer, GLenum type, GLsizei width,
                              GLsizei height);
    AnyFunction (*get_function)(const char *name);
} OsMesa;

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

static Result open_library(OsMesa *mesa, Error *error)
{
    mesa->library = dlopen("libOSMesa.so.8", RTLD_NOW | RTLD_LOCAL);
    if (!mesa->library) return error_set(error, RESULT_NO_GL, "libOSMesa.so.8 is not installed");
    load(mesa->library, "OSMesaCreateContextAttribs", &mesa->create);
    load(mesa->library, "OSMesaDestroyContext", &mesa->destroy);
    load(mesa->library, "OSMesaMakeCurrent", &mesa->make_current);
    load(mesa->library, "OSMesaGetProcAddress", &mesa->get_function);
    if (!mesa->create || !mesa->destroy || !mesa->make_current || !mesa->get_function)
        return error_set(error, RESULT_NO_GL, "libOSMesa.so.8 lacks OSMesaCreateContextAttribs");
    return RESULT_OK;
}

static Result open_context(OsMesa *mesa, Error *error)
{
    const int attributes[] = {OSMESA_FORMAT,
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
    mesa->context = mesa->create(attributes, NULL);
    if (!mesa->context) return error_set(error, RESULT_NO_GL, "OSMesa has no OpenGL 4.3 core");
    if (!mesa->make_current(mesa->context, &mesa->pixel, GL_UNSIGNED_BYTE, 1, 1))
        return error_set(error, RESULT_NO_GL, "OSMesa can't make its context current");
    if (!fill_functions(mesa))
        return error_set(error, RESULT_NO_GL, "OSMesa lacks an OpenGL 4.3 function");
    return RESULT_OK;
}

Result gpu_osmesa_create(void **state, Error *error)
{
    OsMesa *mesa = calloc(1, sizeof *mesa);
    if (!mesa) return error_set(error, RESULT_FAILED, "no memory for a context");
    Result result = open_library(mesa, error);
    if (result == RESULT_OK) result = open_context(mesa, error);
    if (result != RESULT_OK) {
        gpu_osmesa_destroy(mesa);
        mesa = NULL;
    }
    *state = mesa;
    return result;
}

// The library stays loaded: LLVM registers handlers that must outlive it.
void gpu_osmesa_destroy(void *state)
{
    OsMesa *mesa = state;
    if (!mesa) return;
    if (mesa->context) mesa->destroy(mesa->context);
    free(mesa);
}
