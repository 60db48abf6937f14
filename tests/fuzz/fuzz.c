// SPDX-License-Identifier: MIT
#include "fuzz/fuzz.h"

#include "formats/format.h"

#include <ctype.h>
#include <ftw.h>
#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define TARGET(name, function, number) void function(const Bytes *bytes, int kind);
#include "fuzz/targets.def"
#undef TARGET

const FuzzTarget FUZZ_TARGETS[] = {
#define TARGET(name, function, number) {#name, function, number},
#include "fuzz/targets.def"
#undef TARGET
};
const size_t FUZZ_TARGET_COUNT = sizeof FUZZ_TARGETS / sizeof *FUZZ_TARGETS;

static char folder[64];

static int remove_entry(const char *path, const struct stat *status, int kind, struct FTW *walk)
{
    (void)status, (void)kind, (void)walk;
    return remove(path);
}

static void remove_folder(void)
{
    nftw(folder, remove_entry, 8, FTW_DEPTH | FTW_PHYS);
}

// In a memory file system if possible, since every run may write a file.
static void make_folder(void)
{
    const char *const places[] = {"/dev/shm", "/tmp"};
    for (size_t i = 0; i < 2; ++i) {
        snprintf(folder, sizeof folder, "%s/tractrix-fuzz-XXXXXX", places[i]);
        if (mkdtemp(folder)) {
            atexit(remove_folder);
            return;
        }
    }
    perror("fuzz: no folder");
    abort();
}

const char *fuzz_path(const char *name)
{
    static char paths[4][PATH_MAX];
    static unsigned next;
    if (!*folder) make_folder();
    char *path = paths[next++ % 4];
    snprintf(path, PATH_MAX, "%s/%s", folder, name);
    return path;
}

const char *fuzz_file(const char *name, const Bytes *bytes)
{
    const char *path = fuzz_path(name);
    FILE *file = fopen(path, "wb");
    bool written = file && fwrite(bytes->data, 1, bytes->size, file) == bytes->size;
    if (file && fclose(file) != 0) written = false;
    if (written) return path;
    perror(path);
    abort();
}

const FuzzTarget *fuzz_find(const char *name)
{
    for (size_t i = 0; i < FUZZ_TARGET_COUNT; ++i)
        if (strcmp(name, FUZZ_TARGETS[i].name) == 0) return &FUZZ_TARGETS[i];
    return NULL;
}

void fuzz_run(const FuzzTarget *target, const uint8_t *data, size_t size)
{
    Bytes bytes = {malloc(size + 1), size};
    if (!bytes.data) abort();
    if (size) memcpy(bytes.data, data, size);
    bytes.data[size] = 0;
    target->run(&bytes, target->number);
    free(bytes.data);
}

void fuzz_claim(bool holds, const char *format, ...)
{
    if (holds) return;
    va_list arguments;
    va_start(arguments, format);
    fputs("fuzz: broken promise: ", stderr);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    va_end(arguments);
    abort();
}

void fuzz_claim_error(Result result, const Error *error)
{
    if (result == RESULT_OK) return;
    fuzz_claim(*error->text != 0, "status %d without a message", result);
    for (const char *c = error->text; *c; ++c)
        fuzz_claim((unsigned char)*c >= 0x20 && *c != 0x7f, "a control character in \"%s\"",
                   error->text);
    size_t length = strlen(error->text);
    fuzz_claim(!isspace((unsigned char)error->text[length - 1]) && error->text[length - 1] != ':',
               "no reason in \"%s\"", error->text);
}
