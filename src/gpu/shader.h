// SPDX-License-Identifier: MIT
// Builds programs from GLSL files: joins included files, adds the variant's defines in front,
// compiles, and reports errors by file and line.
#pragma once

#include "base/error.h"
#include "base/stock.h"

#include <epoxy/gl.h>

#include <stdbool.h>

// A file of glsl/, embedded by scripts/embed-text. The table ends with {NULL, NULL}. To work on
// shaders without rebuilding, TRACTRIX_GLSL_DIR names a folder from which all files are read
// instead.
typedef struct GlslSource {
    const char *name; // "sim/split.comp"
    const char *text;
} GlslSource;
extern const GlslSource GLSL_SOURCES[];

// Adds a table of shaders for benchmarks or tests; only the last table counts (its pointer is
// kept). Its files may include files of GLSL_SOURCES, and are never read from TRACTRIX_GLSL_DIR.
void shader_add_sources(const GlslSource *sources);

// A macro of a shader variant. Lists end with {NULL, 0}. Every macro that a shader tests must be
// defined, because an undefined macro silently counts as 0.
typedef struct ShaderDefine {
    const char *name;
    int value;
} ShaderDefine;

// Builds a program from a compute shader, or from a vertex and a fragment shader. If the context
// already has a program of the same files and macros, it is shared; so each user sets its uniforms
// before every use. `defines` may be NULL. A file may `#include "other.glsl"`; each file is
// included once. On failure (RESULT_FAILED) *program is 0 and the message is "glsl/FILE:LINE:
// compiler's message".
Result shader_build_compute(GLuint *program, const char *file, const ShaderDefine *defines,
                            Error *error);
Result shader_build_draw(GLuint *program, const char *vertex_file, const char *fragment_file,
                         const ShaderDefine *defines, Error *error);

// Releases a program returned by the functions above; 0 is ignored. Its stock may keep it for the
// next user.
void shader_release(GLuint program);

// Sets the stock in which this thread's programs are kept, that of its current context.
void shader_use_programs(Stock *programs);

// Makes this thread use that stock no longer, before it is destroyed.
void shader_forget_programs(const Stock *programs);

// The folder of TRACTRIX_GLSL_DIR; NULL if the built-in shaders are used. If TRACTRIX_GLSL_DUMP
// names a folder, the joined source of every shader that is built is written there, for other
// compilers: draw_hair.frag becomes draw_hair.HASH.frag.
const char *shader_folder(void);

// Ignores both variables from now on: a library reads only files that its caller names.
void shader_ignore_environment(void);

// Adds errors of `ulps` units in the last place to all shaders built from now on
// (glsl/common/perturb.glsl); 0: none.
void shader_assume_ulps(int ulps);

// If on, compiler warnings of all programs built so far count as failures (the shader check of
// `make check`).
void shader_treat_warnings_as_errors(bool on);
