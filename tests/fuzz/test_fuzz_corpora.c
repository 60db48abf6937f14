// SPDX-License-Identifier: MIT
// Runs every input of the fuzzer's corpora, and every input that once broke a promise, through its
// target. A corpus is a file of inputs, each after its size (4 bytes, little-endian).
#include "fuzz/fuzz.h"

#include <dirent.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static int replay_corpus(const FuzzTarget *target)
{
    char path[256];
    snprintf(path, sizeof path, "tests/fuzz/corpus/%s", target->name);
    Bytes pack = {0};
    Error error = {{0}};
    if (bytes_read_file(&pack, path, &error) != RESULT_OK) fail_msg("%s", error.text);
    int count = 0;
    for (size_t at = 0; at < pack.size; ++count) {
        uint32_t size;
        assert_true(pack.size - at >= sizeof size);
        memcpy(&size, pack.data + at, sizeof size);
        at += sizeof size;
        assert_true(size <= pack.size - at);
        fuzz_run(target, pack.data + at, size);
        at += size;
    }
    bytes_destroy(&pack);
    return count;
}

static int replay_failed(const FuzzTarget *target)
{
    char folder[256], path[600];
    snprintf(folder, sizeof folder, "tests/fuzz/failed/%s", target->name);
    DIR *directory = opendir(folder);
    int count = 0;
    for (const struct dirent *entry; directory && (entry = readdir(directory));) {
        if (*entry->d_name == '.') continue;
        Bytes bytes = {0};
        Error error = {{0}};
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        if (bytes_read_file(&bytes, path, &error) != RESULT_OK) fail_msg("%s", error.text);
        puts(path); // remains on the screen after a crash
        fflush(stdout);
        fuzz_run(target, bytes.data, bytes.size);
        bytes_destroy(&bytes);
        ++count;
    }
    if (directory) closedir(directory);
    return count;
}

static void its_corpus_keeps_the_promises(void **state)
{
    const FuzzTarget *target = *state;
    int failed = replay_failed(target), corpus = replay_corpus(target);
    printf("%s: %d inputs, %d that once failed\n", target->name, corpus, failed);
    assert_true(corpus > 0);
}

int main(void)
{
    struct CMUnitTest *tests = calloc(FUZZ_TARGET_COUNT, sizeof *tests);
    if (!tests) return 1;
    for (size_t i = 0; i < FUZZ_TARGET_COUNT; ++i)
        tests[i] = (struct CMUnitTest){.name = FUZZ_TARGETS[i].name,
                                       .test_func = its_corpus_keeps_the_promises,
                                       .initial_state = (void *)&FUZZ_TARGETS[i]};
    int status = _cmocka_run_group_tests("corpora", tests, FUZZ_TARGET_COUNT, NULL, NULL);
    free(tests);
    return status;
}
