// SPDX-License-Identifier: MIT
#include "gpu/gpu_current.h"

#include <dlfcn.h>
#include <stdbool.h>
#include <stddef.h>

typedef void *GetCurrent(void);

// Does not load the library: if it is not loaded, it has no current context.
static bool has_current(const char *library, const char *function)
{
    void *handle = dlopen(library, RTLD_LAZY | RTLD_NOLOAD);
    if (!handle) return false;
    void *symbol = dlsym(handle, function);
    GetCurrent *get = NULL;
    *(void **)&get = symbol;
    bool current = get && get();
    dlclose(handle);
    return current;
}

Result gpu_current_check(Error *error)
{
    if (has_current("libEGL.so.1", "eglGetCurrentContext") ||
        has_current("libGLX.so.0", "glXGetCurrentContext") ||
        has_current("libGL.so.1", "glXGetCurrentContext"))
        return RESULT_OK;
    return error_set(error, RESULT_NO_GL, "no OpenGL context is current on this thread");
}
