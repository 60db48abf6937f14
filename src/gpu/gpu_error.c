// SPDX-License-Identifier: MIT
#include "gpu/gpu_error.h"

#include <epoxy/gl.h>

#include <stddef.h>

// Like GL, which keeps one error for everything done in a context, this keeps one for the thread.
static _Thread_local struct {
    GLenum code;
    const char *pass;
} noted;

static const char *words_of(GLenum code)
{
    switch (code) {
    case GL_INVALID_ENUM:
        return "invalid enum";
    case GL_INVALID_VALUE:
        return "invalid value";
    case GL_INVALID_OPERATION:
        return "invalid operation";
    case GL_OUT_OF_MEMORY:
        return "out of memory";
    case GL_INVALID_FRAMEBUFFER_OPERATION:
        return "incomplete framebuffer";
    default:
        return "unknown";
    }
}

void gpu_error_note(const char *pass)
{
    GLenum code = glGetError();
    if (code == GL_NO_ERROR || noted.code != GL_NO_ERROR) return;
    noted.code = code;
    noted.pass = pass;
}

void gpu_error_forget(void)
{
    noted.code = GL_NO_ERROR, noted.pass = NULL;
    while (glGetError() != GL_NO_ERROR) {
    }
}

Result gpu_check(const char *what, Error *error)
{
    gpu_error_note(NULL);
    GLenum code = noted.code;
    const char *pass = noted.pass;
    noted.code = GL_NO_ERROR, noted.pass = NULL;
    if (code == GL_NO_ERROR) return RESULT_OK;
    return error_set(error, RESULT_FAILED, "%s%s%s: OpenGL error 0x%04x (%s)", what,
                     pass ? ": pass " : "", pass ? pass : "", code, words_of(code));
}
