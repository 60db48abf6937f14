// SPDX-License-Identifier: MIT
#include "gpu/shader.h"

#include "base/bytes.h"
#include "base/outfile.h"
#include "base/stock.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_FILES = 32, MAX_LOG = 4096, MAX_KEY = 1024 };

static const char NO_REASON[] = "the driver refuses it and gives no reason";

static const GlslSource NONE[] = {{NULL, NULL}};
static const GlslSource *added_sources = NONE;
static bool warnings_are_errors;
static atomic_bool environment_ignored;
static _Thread_local int assumed_ulps; // of the current context
static _Thread_local Stock *programs;  // of the current context

void shader_add_sources(const GlslSource *sources)
{
    added_sources = sources;
}

void shader_treat_warnings_as_errors(bool on)
{
    warnings_are_errors = on;
}

void shader_assume_ulps(int ulps)
{
    assumed_ulps = ulps;
}

void shader_use_programs(Stock *stock)
{
    programs = stock;
}

void shader_forget_programs(const Stock *stock)
{
    if (programs == stock) programs = NULL;
}

void shader_ignore_environment(void)
{
    atomic_store(&environment_ignored, true);
}

static const char *folder_of(const char *variable)
{
    const char *folder = atomic_load(&environment_ignored) ? NULL : getenv(variable);
    return folder && *folder ? folder : NULL;
}

const char *shader_folder(void)
{
    return folder_of("TRACTRIX_GLSL_DIR");
}

// The concatenated source of a stage. Mesa drops the source string number of `#line` from semantic
// errors, so `origins` maps each line to its file.
typedef struct Composition {
    char *text;
    size_t length, capacity;
    struct File {
        const GlslSource *source;
        Bytes text; // read from TRACTRIX_GLSL_DIR; empty if the built-in text is used
    } files[MAX_FILES];
    int file_count;
    struct Origin {
        int file, line;
    } * origins;
    int line_count, line_capacity;
} Composition;

static void composition_destroy(Composition *composition)
{
    for (int i = 0; i < composition->file_count; ++i) bytes_destroy(&composition->files[i].text);
    free(composition->text);
    free(composition->origins);
    *composition = (Composition){0};
}

static bool grow(Composition *c, size_t length)
{
    if (c->length + length + 2 > c->capacity) {
        size_t capacity = 2 * (c->length + length) + 4096;
        char *text = realloc(c->text, capacity);
        if (!text) return false;
        c->text = text, c->capacity = capacity;
    }
    if (c->line_count == c->line_capacity) {
        int capacity = 2 * c->line_capacity + 256;
        struct Origin *origins = realloc(c->origins, (size_t)capacity * sizeof *origins);
        if (!origins) return false;
        c->origins = origins, c->line_capacity = capacity;
    }
    return true;
}

static Result append_line(Composition *c, const char *line, size_t length, int file, int number,
                          Error *error)
{
    if (!grow(c, length)) return error_set(error, RESULT_FAILED, "no memory for shader text");
    memcpy(c->text + c->length, line, length);
    c->length += length;
    c->text[c->length++] = '\n';
    c->text[c->length] = 0;
    c->origins[c->line_count++] = (struct Origin){file, number};
    return RESULT_OK;
}

static const GlslSource *find_source(const GlslSource *sources, const char *name, size_t length)
{
    for (const GlslSource *source = sources; source->name; ++source)
        if (strlen(source->name) == length && memcmp(source->name, name, length) == 0)
            return source;
    return NULL;
}

static Result read_file(struct File *file, Error *error)
{
    const char *folder = shader_folder();
    char path[4096];
    if (!folder) return RESULT_OK;
    if (snprintf(path, sizeof path, "%s/%s", folder, file->source->name) >= (int)sizeof path)
        return error_set(error, RESULT_FAILED, "TRACTRIX_GLSL_DIR: too long a path");
    return bytes_read_file(&file->text, path, error);
}

// Appends a file. A line `#include "name"` is replaced by that file; other directives are left to
// the driver.
static Result append_file(Composition *c, const char *name, size_t length, Error *error)
{
    static const char include[] = "#include \"";
    size_t prefix = sizeof include - 1;
    const GlslSource *source = find_source(GLSL_SOURCES, name, length),
                     *added = source ? NULL : find_source(added_sources, name, length);
    if (!source) source = added;
    if (!source)
        return error_set(error, RESULT_FAILED, "glsl/%.*s: no such shader file", (int)length, name);
    for (int i = 0; i < c->file_count; ++i)
        if (c->files[i].source == source) return RESULT_OK;
    if (c->file_count == MAX_FILES)
        return error_set(error, RESULT_FAILED, "glsl/%s: too many includes", source->name);
    int file = c->file_count++, number = 1;
    c->files[file] = (struct File){.source = source};
    if (!added) TRY(read_file(&c->files[file], error));
    const char *line = c->files[file].text.data ? (char *)c->files[file].text.data : source->text;
    for (; *line; ++number) {
        size_t end = strcspn(line, "\n");
        if (end > prefix && memcmp(line, include, prefix) == 0) {
            const char *inner = line + prefix, *quote = memchr(inner, '"', end - prefix);
            TRY(append_file(c, inner, quote ? (size_t)(quote - inner) : 0, error));
        } else {
            TRY(append_line(c, line, end, file, number, error));
        }
        line += end + (line[end] == '\n');
    }
    return RESULT_OK;
}

static Result compose(Composition *c, const char *file, const ShaderDefine *defines, Error *error)
{
    TRY(append_line(c, "#version 430 core", 17, -1, 0, error));
    for (const ShaderDefine *define = defines; define && define->name; ++define) {
        char line[128];
        int length = snprintf(line, sizeof line, "#define %s %d", define->name, define->value);
        TRY(append_line(c, line, (size_t)length, -1, 0, error));
    }
    if (assumed_ulps) {
        static const char perturb[] = "common/perturb.glsl";
        char line[32];
        int length = snprintf(line, sizeof line, "#define ULPS %d", assumed_ulps);
        TRY(append_line(c, line, (size_t)length, -1, 0, error));
        TRY(append_file(c, perturb, strlen(perturb), error));
    }
    return append_file(c, file, strlen(file), error);
}

// Writes the concatenated source to the folder TRACTRIX_GLSL_DUMP, if set. The file name contains
// the text's FNV-1a hash, so variants do not overwrite each other.
static Result dump(const Composition *c, const char *file, Error *error)
{
    const char *folder = folder_of("TRACTRIX_GLSL_DUMP"), *ending = strrchr(file, '.');
    char path[4096];
    uint64_t hash = 0xcbf29ce484222325;
    OutFile out;
    if (!folder || !ending) return RESULT_OK;
    for (size_t i = 0; i < c->length; ++i) hash = (hash ^ (uint8_t)c->text[i]) * 0x100000001b3;
    int start = snprintf(path, sizeof path, "%s/", folder);
    if (start < 0 || (size_t)start + strlen(file) + 20 >= sizeof path)
        return error_set(error, RESULT_FAILED, "TRACTRIX_GLSL_DUMP: too long a path");
    snprintf(path + start, sizeof path - (size_t)start, "%.*s.%016llx%s", (int)(ending - file),
             file, (unsigned long long)hash, ending);
    for (char *at = path + start; *at; ++at)
        if (*at == '/') *at = '_';
    TRY(outfile_open(&out, path, error));
    fwrite(c->text, 1, c->length, out.stream);
    return outfile_commit(&out, error);
}

// Reports the first line of a driver's log as "glsl/FILE:LINE: message". Mesa writes "0:12(5):
// error: ...", NVIDIA "0(12) : ...".
static Result report_log(const Composition *c, const char *file, char *log, Error *error)
{
    int line = 0, ends = 0;
    log[strcspn(log, "\n")] = 0;
    if (sscanf(log, "%*d:%d(%*d): %n", &line, &ends) < 1 &&
        sscanf(log, "%*d(%d) : %n", &line, &ends) < 1)
        line = 0;
    if (line < 1 || line > c->line_count || c->origins[line - 1].file < 0)
        return error_set(error, RESULT_FAILED, "glsl/%s: %s", file, log);
    struct Origin origin = c->origins[line - 1];
    return error_set(error, RESULT_FAILED, "glsl/%s:%d: %s", c->files[origin.file].source->name,
                     origin.line, log + ends);
}

static Result compile(GLuint shader, const char *file, const ShaderDefine *defines, Error *error)
{
    Composition composition = {0};
    Result result = compose(&composition, file, defines, error);
    if (result == RESULT_OK) {
        GLint good = 0, length = (GLint)composition.length;
        char log[MAX_LOG] = "";
        glShaderSource(shader, 1, (const char *const *)&composition.text, &length);
        glCompileShader(shader);
        glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
        glGetShaderInfoLog(shader, sizeof log, NULL, log);
        result = dump(&composition, file, error);
        if (!good && !*log) snprintf(log, sizeof log, "%s", NO_REASON);
        if (result == RESULT_OK && (!good || (warnings_are_errors && *log)))
            result = report_log(&composition, file, log, error);
    }
    composition_destroy(&composition);
    return result;
}

static Result link_program(GLuint program, const char *file, Error *error)
{
    GLint good = 0;
    char log[MAX_LOG] = "";
    glLinkProgram(program);
    glGetProgramiv(program, GL_LINK_STATUS, &good);
    glGetProgramInfoLog(program, sizeof log, NULL, log);
    if (good && !(warnings_are_errors && *log)) return RESULT_OK;
    log[strcspn(log, "\n")] = 0;
    return error_set(error, RESULT_FAILED, "glsl/%s: link: %s", file, *log ? log : NO_REASON);
}

typedef struct Stage {
    GLenum type;
    const char *file;
} Stage;

static Result fail_memory(const char *file, Error *error)
{
    return error_set(error, RESULT_FAILED, "glsl/%s: no memory for it", file);
}

static Result make(GLuint *program, const Stage *stages, int count, const ShaderDefine *defines,
                   Error *error)
{
    *program = glCreateProgram();
    Result result = *program ? RESULT_OK : fail_memory(stages[count - 1].file, error);
    for (int i = 0; i < count && result == RESULT_OK; ++i) {
        GLuint shader = glCreateShader(stages[i].type);
        result = shader ? compile(shader, stages[i].file, defines, error)
                        : fail_memory(stages[i].file, error);
        if (result == RESULT_OK) glAttachShader(*program, shader);
        glDeleteShader(shader); // the program keeps it while it is attached
    }
    THEN(result, link_program(*program, stages[count - 1].file, error));
    if (result != RESULT_OK) {
        glDeleteProgram(*program);
        *program = 0;
    }
    return result;
}

// --- Programs are kept by what their text follows from: files and macros.

typedef struct Key {
    char text[MAX_KEY];
    size_t size;
} Key;

static void add_word(Key *key, const char *word, int value)
{
    size_t room = key->size < MAX_KEY ? MAX_KEY - key->size : 0;
    key->size += (size_t)snprintf(key->text + MAX_KEY - room, room, "%s %d ", word, value);
}

static Result write_key(Key *key, const Stage *stages, int count, const ShaderDefine *defines,
                        Error *error)
{
    key->size = 0;
    for (int i = 0; i < count; ++i) add_word(key, stages[i].file, assumed_ulps);
    for (; defines && defines->name; ++defines) add_word(key, defines->name, defines->value);
    if (key->size < MAX_KEY) return RESULT_OK;
    return error_set(error, RESULT_FAILED, "glsl/%s: too many macros", stages[count - 1].file);
}

static void destroy_program(void *value)
{
    glDeleteProgram(*(GLuint *)value);
}

static Result keep(GLuint *program, const Key *key, const char *file, Error *error)
{
    GLuint *kept = stock_add(programs, key->text, key->size, sizeof *kept, destroy_program);
    if (kept) {
        *kept = *program;
        return RESULT_OK;
    }
    glDeleteProgram(*program);
    *program = 0;
    return fail_memory(file, error);
}

static Result build(GLuint *program, const Stage *stages, int count, const ShaderDefine *defines,
                    Error *error)
{
    Key key;
    *program = 0;
    TRY(write_key(&key, stages, count, defines, error));
    const GLuint *known = stock_take(programs, key.text, key.size);
    if (known) {
        *program = *known;
        return RESULT_OK;
    }
    TRY(make(program, stages, count, defines, error));
    return keep(program, &key, stages[count - 1].file, error);
}

Result shader_build_compute(GLuint *program, const char *file, const ShaderDefine *defines,
                            Error *error)
{
    return build(program, &(Stage){GL_COMPUTE_SHADER, file}, 1, defines, error);
}

Result shader_build_draw(GLuint *program, const char *vertex_file, const char *fragment_file,
                         const ShaderDefine *defines, Error *error)
{
    const Stage stages[] = {{GL_VERTEX_SHADER, vertex_file}, {GL_FRAGMENT_SHADER, fragment_file}};
    return build(program, stages, 2, defines, error);
}

void shader_release(GLuint program)
{
    if (!program) return;
    for (GLuint *kept = stock_next(programs, NULL); kept; kept = stock_next(programs, kept))
        if (*kept == program) {
            stock_return(programs, kept);
            return;
        }
}
