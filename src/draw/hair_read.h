// SPDX-License-Identifier: MIT
// Reads hair from the GPU, for a frame that the CPU draws. It is the only transfer of such a frame.
#pragma once

#include "draw/backend.h"
#include "sim/hair.h"

// The buffers being read. They are mapped if the driver keeps them in the CPU's memory, and copied
// otherwise. A zeroed struct is empty.
typedef struct HairRead {
    bool copies; // set before use: buffers are in memory of the GPU
    struct ReadBuffer {
        GLuint buffer;
        int64_t size, room;
        void *copy; // owned
    } * buffers;    // [room], owned
    uint32_t count, room;
} HairRead;

// Fills in `position`, `paint` and `ids` of the hair, which are valid until hair_read_end. Waits
// for the GPU. RESULT_FAILED if memory is short or a buffer cannot be read.
Result hair_read_begin(HairRead *read, DrawnHair *hair, uint32_t count, Error *error);
void hair_read_end(HairRead *read);
void hair_read_destroy(HairRead *read);
