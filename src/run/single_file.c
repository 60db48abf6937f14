// SPDX-License-Identifier: MIT
#include "run/single_file.h"

Result single_file_start_sheet(SingleFile *single, int columns, int rows, const Image *tile,
                               Error *error)
{
    return image_sheet_create(&single->sheet, columns, rows, tile, error);
}

Result single_file_start_video(SingleFile *single, TargetFormat format, const VideoOptions *options,
                               Error *error)
{
    if (format == TARGET_PNG) return RESULT_OK; // each frame has its own file
    if (format == TARGET_Y4M)
        return y4m_create(&single->y4m, options->path, options->width, options->height,
                          options->fps, error);
    return video_create(&single->video, options, error);
}

bool single_file_is_used(const SingleFile *single)
{
    return single_file_is_video(single) || single->sheet.columns;
}

bool single_file_is_video(const SingleFile *single)
{
    return single->video || single->y4m.planes;
}

Result single_file_add(SingleFile *single, const Image *image, Error *error)
{
    if (single->video) return video_write(single->video, image, error);
    if (single->y4m.planes) return y4m_write(&single->y4m, image, error);
    image_sheet_add(&single->sheet, image);
    return RESULT_OK;
}

static Result write_sheet(const SingleFile *single, FrameFile *file, ImageTexts *texts,
                          Error *error)
{
    Result result = frame_file_write(file, &single->sheet.image, texts, NULL, error);
    THEN(result, frame_file_commit(file, "", error));
    frame_file_discard(file);
    return result;
}

Result single_file_finish(SingleFile *single, FrameFile *file, ImageTexts *texts, uint64_t *bytes,
                          Error *error)
{
    if (single->video) return video_finish(single->video, bytes, error);
    bool is_sheet = !single->y4m.planes;
    Result result =
        is_sheet ? write_sheet(single, file, texts, error) : y4m_finish(&single->y4m, error);
    *bytes = is_sheet ? file->bytes : single->y4m.bytes;
    return result;
}

void single_file_stop(SingleFile *single)
{
    if (single->video) video_kill(single->video);
}

void single_file_destroy(SingleFile *single)
{
    video_destroy(single->video);
    y4m_destroy(&single->y4m);
    image_sheet_destroy(&single->sheet);
}
