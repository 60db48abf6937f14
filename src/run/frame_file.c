// SPDX-License-Identifier: MIT
#include "run/frame_file.h"

#include "base/bytes.h"
#include "image/jpeg.h"
#include "image/pfm.h"
#include "image/png.h"
#include "run/record.h"

#include <stdio.h>
#include <stdlib.h>

static Result set_texts(const FrameFile *file, ImageTexts *texts, const FrameExtra *extra,
                        Error *error)
{
    const int offset = file->target->offset;
    char text[40];
    if (!texts) return RESULT_OK;
    if (extra)
        snprintf(text, sizeof text, "%d", file->first + offset);
    else
        snprintf(text, sizeof text, "%d-%d", file->first + offset, file->last + offset);
    TRY(image_texts_set(texts, "Frame", text, error));
    if (!extra || !*extra->scene) return RESULT_OK;
    return image_texts_set(texts, FINGERPRINT_KEY, extra->scene, error);
}

static Result encode(const FrameFile *file, const Image *image, const ImageTexts *texts,
                     const FrameExtra *extra, Bytes *bytes, Error *error)
{
    if (file->target->format == TARGET_PFM) return pfm_encode(image, bytes, error);
    if (file->target->format == TARGET_PNG) return png_encode(image, texts, bytes, error);
    if (file->target->format == TARGET_JPEG) return jpeg_encode(image, JPEG_FINE, bytes, error);
    // Programs that compose images take a missing alpha for 0.
    ExrFile exr = {.image = image, .alpha = true, .floats = file->exr_float, .texts = texts};
    if (extra) {
        exr.layers = extra->layers[0].pixels ? extra->layers : NULL;
        exr.world_to_camera = (const float(*)[4])extra->world_to_camera;
        exr.world_to_ndc = (const float(*)[4])extra->world_to_ndc;
    }
    return exr_file_encode(&exr, bytes, error);
}

static Result write_bytes(OutFile *file, const Bytes *bytes, const char *name, Error *error)
{
    TRY(outfile_open(file, name, error));
    fwrite(bytes->data, 1, bytes->size, file->stream);
    return outfile_sync(file, error);
}

Result frame_file_write(FrameFile *file, const Image *image, ImageTexts *texts,
                        const FrameExtra *extra, Error *error)
{
    char *name = target_name_frame(file->target, file->first);
    if (!name)
        return error_set(error, RESULT_FAILED, "no memory for the name of frame %d", file->first);
    Bytes bytes = {0};
    Result result = set_texts(file, texts, extra, error);
    THEN(result, encode(file, image, texts, extra, &bytes, error));
    file->bytes = bytes.size;
    if (result == RESULT_OK)
        result = write_bytes(&file->file, &bytes, name, error);
    else
        error_prefix(error, result, "%s: ", name);
    bytes_destroy(&bytes);
    free(name);
    return result;
}

Result frame_file_commit(FrameFile *file, const char *scene, Error *error)
{
    TRY(outfile_commit(&file->file, error));
    if (file->target->format != TARGET_PFM || !*scene) return RESULT_OK;
    return record_add(file->target, file->first, scene, error);
}

void frame_file_discard(FrameFile *file)
{
    outfile_discard(&file->file);
}
