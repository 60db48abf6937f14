// SPDX-License-Identifier: MIT
// Hair files: strands that were read are valid, and writing and reading them again gives the same.
#include "formats/format.h"
#include "formats/strands_read.h"
#include "fuzz/fuzz.h"

#include <math.h>
#include <string.h>

void fuzz_hair(const Bytes *bytes, int kind);

// Checks what strands_read.h promises.
static void claim_sound(const Strands *strands)
{
    fuzz_claim(strands->strand_count >= 1, "no strand");
    fuzz_claim(strands->first[0] == 0, "the first strand begins at %u", strands->first[0]);
    fuzz_claim(strands->first[strands->strand_count] == strands->vertex_count,
               "vertices left over");
    for (uint32_t s = 0; s < strands->strand_count; ++s) {
        uint32_t size = strands->first[s + 1] - strands->first[s];
        fuzz_claim(size >= 2 && size <= STRANDS_MAX_SIZE, "strand %u has %u vertices", s, size);
    }
    for (uint32_t v = 0; v < strands->vertex_count; ++v)
        for (int axis = 0; axis < 3; ++axis) {
            double x = strands->position[v][axis];
            fuzz_claim(isfinite(x) && fabs(x) <= 1e6, "vertex %u is at %g", v, x);
        }
}

static bool is_same(const void *a, const void *b, size_t size)
{
    return !a == !b && (!a || memcmp(a, b, size) == 0);
}

// Whether numbers are equal; -0 may be written as 0.
static bool are_equal(const float *a, const float *b, size_t count)
{
    for (size_t i = 0; i < count; ++i)
        if (a[i] != b[i]) return false;
    return true;
}

static void claim_same(const Strands *a, const Strands *b)
{
    fuzz_claim(a->strand_count == b->strand_count && a->vertex_count == b->vertex_count,
               "%u strands of %u vertices read back as %u of %u", a->strand_count, a->vertex_count,
               b->strand_count, b->vertex_count);
    fuzz_claim(is_same(a->first, b->first, (a->strand_count + 1) * sizeof *a->first),
               "the strands read back with other sizes");
    fuzz_claim(are_equal(*a->position, *b->position, 3 * (size_t)a->vertex_count),
               "the vertices read back elsewhere");
}

static void claim_reads_back(const Strands *strands, FormatKind kind)
{
    Error error = {{0}};
    const char *path = fuzz_path("again");
    Result result = format_write(path, kind, strands, &error);
    fuzz_claim_error(result, &error);
    if (result != RESULT_OK) return; // this format can't hold the strands
    Strands again = {0};
    const StrandsReadOptions options = {.unit = 1, .up = UP_Y};
    result = strands_read(&again, path, &options, NULL, &error);
    fuzz_claim(result == RESULT_OK, "written, but not read back: %s", error.text);
    claim_same(strands, &again);
    strands_destroy(&again);
}

void fuzz_hair(const Bytes *bytes, int kind)
{
    Bytes copy = *bytes;
    if (kind == FORMAT_NPZ) fuzz_repair_zip(&copy);
    FormatKind found = format_detect(&copy);
    if (found != FORMAT_KINDS && found != (FormatKind)kind) return; // tested by another target
    Strands strands = {0};
    StrandsFrames frames = {0};
    Error error = {{0}};
    StrandsReport report;
    const StrandsReadOptions options = {0};
    const char *path = fuzz_file("hair", &copy);
    Result result = strands_read_frames(&strands, &frames, path, &options, &report, &error);
    fuzz_claim_error(result, &error);
    if (result == RESULT_OK) {
        claim_sound(&strands);
        if (FORMAT_TABLE[kind]->write) claim_reads_back(&strands, (FormatKind)kind);
    }
    strands_frames_destroy(&frames);
    strands_destroy(&strands);
}
