// SPDX-License-Identifier: MIT
// From GLSL files to programs: joins included files, puts the variant's defines in front, compiles,
// and reports errors by file and line.
#pragma once

#include "base/error.h"
#include "base/stock.h"

#include <epoxy/gl.h>

#include <stdbool.h>

// A file of glsl/, embedded by scripts/embed-text. The table ends with {NULL, NULL}. For work on
// shaders without a build, TRACTRIX_GLSL_DIR names a folder from which all of them are read
// instead.
typedef struct GlslSource {
    const char *name; // "sim/split.comp"
    const char *text;
} GlslSource;
extern const GlslSource GLSL_SOURCES[];

// Adds a table of shaders that not all programs carry, for benchmarks and tests; the latest call's
// is used, by pointer. Its files may include those of GLSL_SOURCES, and are never read from
// TRACTRIX_GLSL_DIR.
void shader_add_sources(const GlslSource *sources);

// A macro of a shader variant. Lists end with {NULL, 0}. Every macro that a shader tests must be
// given: an undefined one would silently count as 0.
typedef struct ShaderDefine {
    const char *name;
    int value;
} ShaderDefine;

// Builds a program from a compute shader, or from a vertex and a fragment shader, unless the
// context has one of the same files and macros: all who asked for it share it, so each sets its
// uniforms before every use. `defines` may be NULL. A file may `#include "other.glsl"`; each file
// is taken once. On failure *program is 0 and the line is "glsl/FILE:LINE: compiler's message"
// (RESULT_FAILED).
Result shader_build_compute(GLuint *program, const char *file, const ShaderDefine *defines,
                            Error *error);
Result shader_build_draw(GLuint *program, const char *vertex_file, const char *fragment_file,
                         const ShaderDefine *defines, Error *error);

// Gives back what a call above has returned; 0: nothing. The program stays for the next who asks
// for it, as long as its stock keeps it.
void shader_release(GLuint program);

// From now on this thread's programs are kept in that stock, its current context's.
void shader_use_programs(Stock *programs);

// The folder of TRACTRIX_GLSL_DIR; NULL: the shaders are the program's own. Where
// TRACTRIX_GLSL_DUMP names a folder, the joined text of every shader that is built is written
// there, for compilers of other drivers: draw_hair.frag is draw_hair.HASH.frag.
const char *shader_folder(void);

// Neither counts from now on: in a library, files are those that its caller names.
void shader_ignore_environment(void);

// Every shader built from now on rounds otherwise, by so many units in the last place
// (glsl/common/perturb.glsl); 0: as the driver does.
void shader_assume_ulps(int ulps);

// Compiler warnings of all programs built so far count as failures if this is on (the shader check
// of `make check`).
void shader_treat_warnings_as_errors(bool on);
