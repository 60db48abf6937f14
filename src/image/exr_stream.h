// SPDX-License-Identifier: MIT
// Shared by writing and reading EXR files: the library's stream and its error messages.
#pragma once

#include "base/bytes.h"

#include <openexr.h>
#include <stdbool.h>

enum { EXR_PART = 0 }; // the first part; files written here have no other

typedef struct ExrStream {
    exr_context_t context;
    Bytes written; // with `room`
    size_t room;
    const Bytes *read;
    bool short_of_memory; // set in a callback, which must not call the error handler
    char reason[600];     // may contain a name of up to 255 bytes
} ExrStream;

// The library's error handler; the context's user data must be the stream.
void exr_stream_keep_reason(exr_const_context_t context, exr_result_t code, const char *message);

// The reason why a call failed with this code, in one line of plain ASCII.
const char *exr_stream_reason(const ExrStream *stream, exr_result_t code);
