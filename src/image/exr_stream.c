// SPDX-License-Identifier: MIT
#include "image/exr_stream.h"

#include <stdio.h>

// Keeps the last message, because the first is often less exact. A message may quote arbitrary
// bytes of the file.
void exr_stream_keep_reason(exr_const_context_t context, exr_result_t code, const char *message)
{
    void *data = NULL;
    (void)code;
    if (exr_get_user_data(context, &data) != EXR_ERR_SUCCESS || !data) return;
    ExrStream *stream = data;
    snprintf(stream->reason, sizeof stream->reason, "%s", message ? message : "");
    for (char *at = stream->reason; *at; ++at)
        if (*at < ' ' || *at > '~') *at = *at == '\n' ? ' ' : '?';
}

const char *exr_stream_reason(const ExrStream *stream, exr_result_t code)
{
    if (stream->short_of_memory) return "no memory";
    return stream->reason[0] ? stream->reason : exr_get_default_error_message(code);
}
