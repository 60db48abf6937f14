// SPDX-License-Identifier: MIT
// What writing and reading EXR files share: the library's stream, and what it says of a failure.
#pragma once

#include "base/bytes.h"

#include <openexr.h>
#include <stdbool.h>

enum { EXR_PART = 0 }; // the first; files that are written have no other

typedef struct ExrStream {
    exr_context_t context;
    Bytes written; // with `room`
    size_t room;
    const Bytes *read;
    bool short_of_memory; // in a callback, where no handler may be called
    char reason[600];     // with a name of up to 255 bytes
} ExrStream;

// The library's error handler; the context's user data is the stream.
void exr_stream_keep_reason(exr_const_context_t context, exr_result_t code, const char *message);

// Why a call failed with this code, in one line of plain ASCII.
const char *exr_stream_reason(const ExrStream *stream, exr_result_t code);
