// SPDX-License-Identifier: MIT
// The budget of a reader: small files cannot make a reader use much memory or time.
#include "base/reader.h"
#include "formats/strands_read.h"
#include "support/temporary.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

static Reader begin(Error *error)
{
    static uint8_t data[1];
    const Bytes none = {data, 0};
    return reader_begin_binary("x", &none, error);
}

static void counts_are_multiplied_without_overflow(void **state)
{
    const uint64_t counts[] = {UINT64_MAX, UINT64_MAX / 16 + 1, UINT64_C(1) << 61,
                               READER_MEMORY_BYTES / 16 + 1};
    (void)state;
    for (int i = 0; i < 4; ++i) {
        Error error = {{0}};
        Reader reader = begin(&error);
        assert_null(reader_malloc(&reader, counts[i], 16));
        assert_int_equal(reader.result, RESULT_BAD_INPUT);
        assert_non_null(strstr(error.text, "needs more memory than a file of this size may use"));
        reader = begin(&error);
        assert_null(reader_calloc(&reader, counts[i], 16));
        reader = begin(&error);
        assert_null(reader_realloc(&reader, NULL, counts[i], 16));
        reader = begin(&error);
        assert_null(reader_malloc_frames(&reader, counts[i], UINT64_C(1) << 32));
        reader = begin(&error);
        assert_false(reader_work(&reader, counts[i], UINT64_C(1) << 16));
    }
}

static void memory_and_work_are_counted_together(void **state)
{
    Error error = {{0}};
    Reader reader = begin(&error);
    uint8_t data[1] = {0};
    const Bytes none = {data, 0};
    (void)state;
    void *half = reader_malloc(&reader, READER_MEMORY_BYTES / 2, 1);
    assert_non_null(half);
    Reader inner = reader_begin_inner(&reader, "y", &none);
    assert_true(reader_work(&inner, READER_WORK_STEPS / 2, 1));
    assert_null(reader_malloc(&inner, READER_MEMORY_BYTES / 2, 1)); // malloc's own bytes count, too
    reader_end_inner(&reader, &inner);
    assert_int_equal(reader.result, RESULT_BAD_INPUT);
    free(half);
    reader.result = RESULT_OK;
    assert_false(reader_work(&reader, READER_WORK_STEPS / 2 + 1, 1));
}

// --- Files of a megabyte that stand for much more.

#define CURVE                                                                                      \
    "def BasisCurves\"\"{point3f[] points=[(0,0,0),(0,0,1)]\nint[] curveVertexCounts=[2]\n"        \
    "uniform token type=\"linear\"\n}\n"

static void put_times(FILE *file, const char *before, const char *value, int count)
{
    fputs(before, file);
    for (int i = 0; i < count; ++i) fprintf(file, "%d:%s,", i, value);
    fputs("}\n", file);
}

static void repeat(FILE *file, const char *text, int count)
{
    for (int i = 0; i < count; ++i) fputs(text, file);
}

// Many curves under one transform of many samples.
static void put_moved(FILE *file, int curves)
{
    fputs("def Xform\"\"{\n", file);
    put_times(file, "double xformOp:rotateX.timeSamples={", "1", 95000);
    fputs("uniform token[] xformOpOrder=[\"xformOp:rotateX\"]\n", file);
    repeat(file, CURVE, curves);
    fputs("}\n", file);
}

static void put_one_moved(FILE *file)
{
    put_moved(file, 1);
}

static void put_thousand_moved(FILE *file)
{
    put_moved(file, 1000);
}

// Many operations, each of which is looked up by its name, over many curves.
static void put_operations(FILE *file)
{
    enum { OPERATIONS = 8000 };
    fputs("def Xform\"\"{\n", file);
    for (int i = 0; i < OPERATIONS; ++i) fprintf(file, "double xformOp:rotateX:%x=1\n", i);
    fputs("uniform token[] xformOpOrder=[", file);
    for (int i = 0; i < OPERATIONS; ++i) fprintf(file, "\"xformOp:rotateX:%x\",", i);
    fputs("]\n", file);
    repeat(file, CURVE, 800);
    fputs("}\n", file);
}

static void put_samples(FILE *file)
{
    fputs("def BasisCurves\"\"{\n", file);
    put_times(file, "point3f[] points.timeSamples={", "[(0,0,0),(0,0,1)]", 40000);
    fputs("int[] curveVertexCounts=[2]\nuniform token type=\"linear\"\n}\n", file);
}

// Work is counted, so that a file of a megabyte that stands for hours of it is refused at the same
// place everywhere.
static void small_files_stand_for_little_work(void **state)
{
    static const struct {
        void (*put)(FILE *file);
        const char *refused; // NULL: it is read
    } cases[] = {
        {put_one_moved, NULL},
        {put_thousand_moved, "frames of 2000 vertices need"},
        {put_operations, "takes more time than a file of this size may take"},
        {put_samples, NULL},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        const char *path = temporary_path(state, "x.usda");
        Strands strands;
        StrandsFrames frames;
        Error error = {{0}};
        FILE *file = fopen(path, "wb");
        assert_non_null(file);
        fputs("#usda 1.0\n", file);
        cases[i].put(file);
        fclose(file);
        Result result = strands_read_frames(&strands, &frames, path, NULL, NULL, &error);
        if (cases[i].refused ? !strstr(error.text, cases[i].refused) : result != RESULT_OK)
            fail_msg("case %zu: '%s'", i, error.text);
        strands_destroy(&strands);
        strands_frames_destroy(&frames);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(counts_are_multiplied_without_overflow),
        cmocka_unit_test(memory_and_work_are_counted_together),
        cmocka_unit_test_setup_teardown(small_files_stand_for_little_work, temporary_create,
                                        temporary_destroy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
