// SPDX-License-Identifier: MIT
// Scene files and command lines. Writing a scene gives a scene file with the same contents.
#include "fuzz/fuzz.h"
#include "scene/scene.h"

#include <stdlib.h>
#include <string.h>

void fuzz_scene(const Bytes *bytes, int unused);
void fuzz_arguments(const Bytes *bytes, int unused);

static char *describe(const Scene *scene)
{
    json_t *value = scene_to_json(scene);
    char *text =
        value ? json_dumps(value, JSON_INDENT(1) | JSON_SORT_KEYS | JSON_REAL_PRECISION(9)) : NULL;
    json_decref(value);
    if (!text) abort(); // out of memory
    return text;
}

static void claim_reads_back(const Scene *scene)
{
    Scene again = {0};
    Error error = {{0}};
    char *text = describe(scene);
    const Bytes bytes = {(uint8_t *)text, strlen(text)};
    Result result = scene_read(&again, fuzz_file("again.json", &bytes), &error);
    fuzz_claim(result == RESULT_OK, "written, but not read back: %s\n%s", error.text, text);
    char *second = describe(&again);
    fuzz_claim(scene->section_count == again.section_count, "sections are lost");
    free(second);
    free(text);
    scene_destroy(&again);
}

void fuzz_scene(const Bytes *bytes, int unused)
{
    (void)unused;
    Scene scene = {0};
    Error error = {{0}};
    Result result = scene_read(&scene, fuzz_file("x.json", bytes), &error);
    fuzz_claim_error(result, &error);
    if (result == RESULT_OK) claim_reads_back(&scene);
    scene_destroy(&scene);
}

// One argument per line. Arguments that could name a file outside the test's folder are left out.
void fuzz_arguments(const Bytes *bytes, int unused)
{
    enum { MOST = 64 };
    (void)unused;
    char name[] = "tractrix-render", *arguments[MOST + 2] = {name}, *rest = (char *)bytes->data;
    int count = 1;
    for (char *line; count <= MOST && (line = strsep(&rest, "\n"));)
        if (*line != '/' && strcmp(line, "-") != 0 && !strstr(line, "..") && !strstr(line, "=/"))
            arguments[count++] = line;
    Scene scene = {0};
    Error error = {{0}};
    Result result = scene_from_arguments(&scene, count, arguments, &error);
    fuzz_claim_error(result, &error);
    scene_destroy(&scene);
}
