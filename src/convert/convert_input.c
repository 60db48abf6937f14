// SPDX-License-Identifier: MIT
#include "convert/convert_input.h"

#include "strands/strands.h"
#include "strands/strands_edit.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { USUAL_FPS = 60 };

// --- Frames.

static bool frame_is_there(const ConvertInput *input, int frame)
{
    char *name = target_name_frame(&input->pattern, frame);
    bool there = name && access(name, F_OK) == 0;
    free(name);
    return there;
}

// Up to the last one before a gap.
static int find_last(const ConvertInput *input)
{
    int last = input->first;
    if (input->cached) return (int)input->cache.cache.frame_count - 1;
    while (frame_is_there(input, last)) ++last;
    return last - 1;
}

static Result choose_frames(ConvertInput *input, Error *error)
{
    bool cut = input->first > 0 || input->last >= 0 || input->every > 1;
    if (!convert_input_moves(input)) {
        input->first = input->last = 0;
        if (cut || input->fps > 0)
            return error_set(error, RESULT_USAGE,
                             "--first, --last, --every and --fps are for a cache or numbered files "
                             "(x_%%04d.tfx)");
        return RESULT_OK;
    }
    if (input->fps <= 0) input->fps = input->cached ? input->cache.fps : USUAL_FPS;
    if (input->last < 0) input->last = find_last(input);
    if (input->last >= input->first)
        return input->cached ? cache_file_check(&input->cache.cache, input->last, error)
                             : RESULT_OK;
    if (input->cached) return cache_file_check(&input->cache.cache, input->first, error);
    return error_set(error, RESULT_BAD_INPUT, "%s: no file for frame %d", input->paths[0],
                     input->first);
}

// --- Opening.

Result convert_input_open(ConvertInput *input, Error *error)
{
    Result result = RESULT_OK;
    for (int i = 0; i < input->path_count; ++i) {
        bool cached = cache_file_matches(input->paths[i]);
        bool numbered = !cached && strchr(input->paths[i], '%') && access(input->paths[i], F_OK);
        input->cached = input->cached || cached;
        input->numbered = input->numbered || numbered;
        if ((cached || numbered) && input->path_count > 1)
            return error_set(error, RESULT_USAGE, "%s: frames can't be joined with other files",
                             input->paths[i]);
    }
    input->reports = calloc((size_t)input->path_count + 1, sizeof *input->reports);
    if (!input->reports) return error_set(error, RESULT_FAILED, "no memory for reports");
    if (input->cached) result = cache_strands_open(&input->cache, input->paths[0], error);
    if (input->numbered) result = format_target(&input->pattern, input->paths[0], error);
    return result == RESULT_OK ? choose_frames(input, error) : result;
}

void convert_input_close(ConvertInput *input)
{
    cache_strands_close(&input->cache);
    target_destroy(&input->pattern);
    free(input->reports);
    *input = (ConvertInput){0};
}

// --- Reading.

static void tell(const ConvertInput *input, const StrandsReport *report, const char *path)
{
    if (!input->messages) return;
    strands_report_print_mended(report, path, input->messages);
    if (report->shuffled)
        fprintf(input->messages, "%s: strands are shuffled: the file says 'is sorted 0'\n", path);
}

static Result read_file(ConvertInput *input, const char *path, int file, Strands *strands,
                        Error *error)
{
    StrandsReport report;
    Result result = strands_read(strands, path, &input->options, &report, error);
    if (result != RESULT_OK) return result;
    tell(input, &report, path);
    input->features |= strands_features(strands);
    if (input->reports[file].strands == 0) input->reports[file] = report;
    return RESULT_OK;
}

// The unit that is guessed for the first frame holds for all.
static Result read_numbered(ConvertInput *input, int frame, Strands *strands, Error *error)
{
    char *name = target_name_frame(&input->pattern, frame);
    if (!name) return error_set(error, RESULT_FAILED, "no memory for a name");
    Result result = read_file(input, name, 0, strands, error);
    if (result == RESULT_OK) input->options.unit = input->reports[0].unit_used;
    free(name);
    return result;
}

static Result read_files(ConvertInput *input, Strands *strands, Error *error)
{
    if (input->path_count == 1) return read_file(input, input->paths[0], 0, strands, error);
    Strands *sets = calloc((size_t)input->path_count, sizeof *sets);
    Result result =
        sets ? RESULT_OK
             : error_set(error, RESULT_FAILED, "no memory for %d files", input->path_count);
    for (int i = 0; i < input->path_count && result == RESULT_OK; ++i)
        result = read_file(input, input->paths[i], i, &sets[i], error);
    if (result == RESULT_OK)
        result = strands_join(strands, sets, (uint32_t)input->path_count, error);
    for (int i = 0; sets && i < input->path_count; ++i) strands_destroy(&sets[i]);
    free(sets);
    return result;
}

Result convert_input_read(ConvertInput *input, int frame, Strands *strands, Error *error)
{
    *strands = (Strands){0};
    if (input->cached) return cache_strands_read(&input->cache, frame, strands, error);
    if (input->numbered) return read_numbered(input, frame, strands, error);
    return read_files(input, strands, error);
}
