// SPDX-License-Identifier: MIT
#include "formats/frames_file.h"

#include "formats/npz_file.h"

#include <stdlib.h>
#include <string.h>

bool frames_file_has_look(FormatKind kind)
{
    return kind == FORMAT_USD || kind == FORMAT_ABC;
}

Result frames_file_open(FramesFile *file, FormatKind kind, const char *path, const Strands *strands,
                        const CurvesOptions *options, Error *error)
{
    *file = (FramesFile){.kind = kind, .path = path, .strands = strands, .options = *options};
    if (kind == FORMAT_USD) return usd_writer_open(&file->usd, path, strands, options, error);
    if (kind == FORMAT_ABC) return abc_writer_open(&file->abc, path, strands, options, error);
    return RESULT_OK;
}

static Result add_npz(FramesFile *file, const float (*positions)[3], Error *error)
{
    size_t size = file->strands->vertex_count;
    if (file->count == file->room) {
        uint32_t room = 2 * file->room + 16;
        float(*more)[3] = realloc(file->npz, room * size * sizeof *more);
        if (!more) return error_set(error, RESULT_FAILED, "%s: no memory", file->path);
        file->npz = more;
        file->room = room;
    }
    memcpy(file->npz + file->count++ * size, positions, size * sizeof *positions);
    return RESULT_OK;
}

Result frames_file_add(FramesFile *file, int number, const float (*positions)[3], Error *error)
{
    if (file->kind == FORMAT_USD) return usd_writer_add(&file->usd, number, positions, error);
    if (file->kind == FORMAT_ABC) return abc_writer_add(&file->abc, number, positions, error);
    if (file->count == 0) file->first = number;
    return add_npz(file, positions, error);
}

static Result finish_npz(const FramesFile *file, Error *error)
{
    const NpzFrames frames = {file->count, (const float(*)[3])file->npz, file->options.fps,
                              file->first};
    OutFile out;
    TRY(outfile_open(&out, file->path, error));
    Result result = npz_write_frames(&out, file->strands, &frames, error);
    if (result == RESULT_OK) return outfile_commit(&out, error);
    outfile_discard(&out);
    return result;
}

Result frames_file_finish(FramesFile *file, Error *error)
{
    Result result = RESULT_OK;
    if (!file->strands) return RESULT_OK;
    if (file->kind == FORMAT_USD)
        result = usd_writer_finish(&file->usd, error);
    else if (file->kind == FORMAT_ABC)
        result = abc_writer_finish(&file->abc, error);
    else
        result = finish_npz(file, error);
    frames_file_discard(file);
    return result;
}

void frames_file_discard(FramesFile *file)
{
    usd_writer_discard(&file->usd);
    abc_writer_discard(&file->abc);
    free(file->npz);
    *file = (FramesFile){0};
}

Result frames_file_write_still(FormatKind kind, const char *path, const Strands *strands,
                               const CurvesOptions *options, Error *error)
{
    FramesFile file = {0};
    Result result = frames_file_open(&file, kind, path, strands, options, error);
    THEN(result,
         frames_file_add(&file, options->first, (const float(*)[3])strands->position, error));
    if (result == RESULT_OK) return frames_file_finish(&file, error);
    frames_file_discard(&file);
    return result;
}
