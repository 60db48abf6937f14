// SPDX-License-Identifier: MIT
// The single file of all frames: a video, raw video or a contact sheet.
#pragma once

#include "base/target.h"
#include "image/image.h"
#include "run/frame_file.h"
#include "run/video.h"
#include "run/y4m.h"

#include <stdbool.h>

// Zeroed: each frame has a file of its own; such a struct may be destroyed.
typedef struct SingleFile {
    Video *video;     // NULL unless ffmpeg writes a video
    Y4m y4m;          // without planes unless this is raw video
    ImageSheet sheet; // without columns unless this is a sheet
} SingleFile;

// A sheet of columns x rows images like `tile`. Fails like image_sheet_create.
Result single_file_start_sheet(SingleFile *single, int columns, int rows, const Image *tile,
                               Error *error);

// Nothing for a stream of PNG files. Fails like video_create and y4m_create.
Result single_file_start_video(SingleFile *single, TargetFormat format, const VideoOptions *options,
                               Error *error);

bool single_file_is_used(const SingleFile *single);
bool single_file_is_video(const SingleFile *single);

// Appends the next frame. RESULT_FAILED with path and reason.
Result single_file_add(SingleFile *single, const Image *image, Error *error);

// Completes the file, gives it its name and sets *bytes. `file` and `texts` are for a sheet.
// RESULT_FAILED with path and reason.
Result single_file_finish(SingleFile *single, FrameFile *file, ImageTexts *texts, uint64_t *bytes,
                          Error *error);

// Makes adding or finishing in another thread fail if it waits for ffmpeg.
void single_file_stop(SingleFile *single);

// Removes an incomplete file.
void single_file_destroy(SingleFile *single);
