// SPDX-License-Identifier: MIT
// The OpenGL context of a game: without a screen by EGL (-lEGL), or with -DWINDOW that of a hidden
// GLFW window (-lglfw).
#pragma once

#include <epoxy/gl.h>
#include <stdbool.h>

#ifdef WINDOW
#include <GLFW/glfw3.h>

// Makes OpenGL 4.3 or newer current; false if there is none.
static bool host_context(int width, int height)
{
    if (!glfwInit()) return false;
    glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
    GLFWwindow *window = glfwCreateWindow(width, height, "hair", NULL, NULL);
    if (window) glfwMakeContextCurrent(window);
    return window && epoxy_gl_version() >= 43;
}
#else
#include <epoxy/egl.h>

static bool host_context(int width, int height)
{
    static const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 3,
                                     EGL_NONE};
    (void)width, (void)height; // the host draws to a texture
    EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, NULL, NULL);
    if (!display || !eglInitialize(display, NULL, NULL) || !eglBindAPI(EGL_OPENGL_API))
        return false;
    EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, version);
    return context && eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context);
}
#endif
