// SPDX-License-Identifier: MIT
// Caches of simulations, as tractrix-convert reads them: index, scene, hair and frames.
#include "convert/convert_input.h"
#include "fuzz/fuzz.h"

#include <math.h>

void fuzz_cache(const Bytes *bytes, int unused);

static void read_frames(ConvertInput *input)
{
    enum { MOST = 64 };
    for (int frame = input->first, i = 0; frame <= input->last && i < MOST;
         frame += input->every, ++i) {
        Strands strands = {0};
        Error error = {{0}};
        Result result = convert_input_read(input, frame, &strands, &error);
        fuzz_claim_error(result, &error);
        for (uint32_t v = 0; result == RESULT_OK && v < strands.vertex_count; ++v)
            for (int axis = 0; axis < 3; ++axis)
                fuzz_claim(isfinite(strands.position[v][axis]), "vertex %u of frame %d", v, frame);
        strands_destroy(&strands);
    }
}

void fuzz_cache(const Bytes *bytes, int unused)
{
    (void)unused;
    Bytes copy = *bytes;
    fuzz_repair_chunks(&copy);
    char *path = (char *)fuzz_file("x.cache", &copy);
    ConvertInput input = {.paths = &path, .path_count = 1, .last = -1, .every = 1};
    Error error = {{0}};
    bool matches = false;
    fuzz_claim(cache_file_matches(path, &matches, &error) == RESULT_OK, "%s", error.text);
    if (!matches) return; // a hair file, or no known format
    Result result = convert_input_open(&input, &error);
    fuzz_claim_error(result, &error);
    if (result == RESULT_OK) read_frames(&input);
    convert_input_close(&input);
    CacheFile cache = {0};
    if (cache_file_open(&cache, path, &error) != RESULT_OK) return;
    if (!cache_file_verify(&cache)) fuzz_claim_error(RESULT_BAD_INPUT, &cache.end);
    cache_file_close(&cache);
}
