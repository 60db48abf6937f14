// SPDX-License-Identifier: MIT
#include "gpu/gpu_egl.h"

#include <epoxy/egl.h>

#include <dlfcn.h>
#include <stdio.h>
#include <string.h>

static const struct {
    EGLint code;
    const char *words;
} ERRORS[] = {
    {EGL_NOT_INITIALIZED, "the driver can't be initialised"},
    {EGL_BAD_ACCESS, "no access to the device"},
    {EGL_BAD_ALLOC, "out of memory"},
    {EGL_BAD_ATTRIBUTE, "an attribute is not known"},
    {EGL_BAD_CONFIG, "no usable configuration"},
    {EGL_BAD_DISPLAY, "no such display"},
    {EGL_BAD_MATCH, "OpenGL 4.3 core is not offered"},
    {EGL_BAD_PARAMETER, "a parameter is not known"},
    {EGL_BAD_DEVICE_EXT, "no such device"},
    {EGL_SUCCESS, "no reason given"},
};

static Result fail(const char *call, Error *error)
{
    EGLint code = eglGetError();
    const char *words = "unknown error";
    for (size_t i = 0; i < sizeof ERRORS / sizeof *ERRORS; ++i)
        if (ERRORS[i].code == code) words = ERRORS[i].words;
    return error_set(error, RESULT_NO_GL, "%s: %s (0x%04x)", call, words, (unsigned)code);
}

// The library stays open because libepoxy will load it anyway.
static bool can_load(const char *name)
{
    void *library = dlopen(name, RTLD_LAZY | RTLD_LOCAL);
    return library != NULL; // cppcheck-suppress resourceLeak
}

// libepoxy ends the program if it cannot load libEGL or, for OpenGL's functions, libOpenGL or
// libGL. So these are loaded here before its first call.
static Result require_libraries(Error *error)
{
    if (!can_load("libEGL.so.1"))
        return error_set(error, RESULT_NO_GL, "libEGL.so.1 is not installed");
    if (!can_load("libGL.so.1") && !can_load("libOpenGL.so.0"))
        return error_set(error, RESULT_NO_GL, "neither libOpenGL.so.0 nor libGL.so.1 is installed");
    return RESULT_OK;
}

// Uses EGL_EXT_device_drm and EGL_EXT_device_drm_render_node; libepoxy 1.5 has no constant for the
// latter.
static GpuDevice describe(void *egl)
{
    enum { RENDER_NODE_FILE = 0x3377 };
    GpuDevice device = {.egl = egl};
    const char *text = eglQueryDeviceStringEXT(egl, EGL_EXTENSIONS), *node = NULL;
    const char *extensions = text ? text : "";
    device.software = strstr(extensions, "EGL_MESA_device_software");
    if (strstr(extensions, "EGL_EXT_device_drm_render_node"))
        node = eglQueryDeviceStringEXT(egl, RENDER_NODE_FILE);
    if (!node && strstr(extensions, "EGL_EXT_device_drm"))
        node = eglQueryDeviceStringEXT(egl, EGL_DRM_DEVICE_FILE_EXT);
    if (node) snprintf(device.node, sizeof device.node, "%s", node);
    gpu_device_look_up(&device);
    return device;
}

// EGL_EXT_device_base is the older extension that was split into the enumeration and the query of
// devices; NVIDIA's driver names only this one.
static bool can_enumerate(void)
{
    return epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device") &&
           (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_base") ||
            epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration"));
}

Result gpu_egl_find_devices(GpuDevices *devices, Error *error)
{
    *devices = (GpuDevices){0};
    TRY(require_libraries(error));
    if (!can_enumerate()) return error_set(error, RESULT_NO_GL, "EGL can't enumerate devices");
    void *found[GPU_MOST_DEVICES];
    if (!eglQueryDevicesEXT(GPU_MOST_DEVICES, found, &devices->count))
        return fail("eglQueryDevicesEXT", error);
    for (int i = 0; i < devices->count; ++i) devices->device[i] = describe(found[i]);
    return RESULT_OK;
}

// Always names a platform: EGL_DEFAULT_DISPLAY would look for X or Wayland.
static Result open_display(EglContext *egl, void *device, Error *error)
{
    const char *client = device ? "EGL_EXT_platform_device" : "EGL_MESA_platform_surfaceless";
    if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, client))
        return error_set(error, RESULT_NO_GL, "%s is not supported", client);
    EGLenum platform = device ? EGL_PLATFORM_DEVICE_EXT : EGL_PLATFORM_SURFACELESS_MESA;
    egl->display = eglGetPlatformDisplayEXT(platform, device, NULL);
    if (!egl->display) return fail("eglGetPlatformDisplay", error);
    if (!eglInitialize(egl->display, NULL, NULL)) return fail("eglInitialize", error);
    if (!epoxy_has_egl_extension(egl->display, "EGL_KHR_surfaceless_context"))
        return error_set(error, RESULT_NO_GL, "EGL_KHR_surfaceless_context is not supported");
    return RESULT_OK;
}

static EGLConfig choose_config(EGLDisplay display)
{
    if (epoxy_has_egl_extension(display, "EGL_KHR_no_config_context")) return EGL_NO_CONFIG_KHR;
    const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, EGL_DONT_CARE,
                             EGL_NONE};
    EGLConfig config = NULL;
    EGLint count = 0;
    return eglChooseConfig(display, wanted, &config, 1, &count) && count > 0 ? config : NULL;
}

static Result open_context(EglContext *egl, bool debug, Error *error)
{
    if (!eglBindAPI(EGL_OPENGL_API)) return fail("eglBindAPI", error);
    const EGLint attributes[] = {
        EGL_CONTEXT_MAJOR_VERSION,
        4,
        EGL_CONTEXT_MINOR_VERSION,
        3,
        EGL_CONTEXT_OPENGL_PROFILE_MASK,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
        EGL_CONTEXT_OPENGL_DEBUG,
        debug ? EGL_TRUE : EGL_FALSE,
        EGL_NONE,
    };
    egl->context =
        eglCreateContext(egl->display, choose_config(egl->display), EGL_NO_CONTEXT, attributes);
    if (!egl->context) return fail("eglCreateContext", error);
    if (!eglMakeCurrent(egl->display, EGL_NO_SURFACE, EGL_NO_SURFACE, egl->context))
        return fail("eglMakeCurrent", error);
    return RESULT_OK;
}

Result gpu_egl_create(EglContext *egl, void *device, bool debug, Error *error)
{
    *egl = (EglContext){0};
    Result result = require_libraries(error);
    THEN(result, open_display(egl, device, error));
    THEN(result, open_context(egl, debug, error));
    if (result != RESULT_OK) gpu_egl_destroy(egl);
    return result;
}

void gpu_egl_destroy(EglContext *egl)
{
    if (egl->display) {
        eglMakeCurrent(egl->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        if (egl->context) eglDestroyContext(egl->display, egl->context);
        eglReleaseThread();
    }
    *egl = (EglContext){0};
}
