// SPDX-License-Identifier: MIT
// One NumPy array, after "NEP 1: A Simple File Format for NumPy Arrays" and numpy.lib.format:
// header versions 1, 2 and 3, C and Fortran order, both byte orders.
#pragma once

#include "base/reader.h"

enum { NPY_MOST_AXES = 8 };

// `kind` of the elements: 'f' floats of 2, 4 or 8 bytes, 'i' and 'u' integers of 1, 2, 4 or 8, 'b'
// one-byte booleans, 'U' and 'S' text of `item` bytes.
typedef struct NpyArray {
    char kind;
    uint32_t item;
    bool big, fortran;
    uint32_t axes;
    uint64_t shape[NPY_MOST_AXES];
    uint64_t count;      // of elements
    const uint8_t *data; // not owned; count * item bytes
    uint64_t at;         // their byte offset in the content
} NpyArray;

// Reads the header. The reader ends after the data. Fails for pickled objects, structured and
// complex elements, and if the content ends before the data does.
Result npy_array_read(NpyArray *array, Reader *reader);

// "(100, 32, 3)"
void npy_array_describe(const NpyArray *array, char *text, size_t size);

// Whether the elements are numbers.
bool npy_array_is_number(const NpyArray *array);

// Copies all elements as float32 in C order, correctly rounded; `to` must have room for `count`.
void npy_array_copy(const NpyArray *array, float *to);

// Element i, in the order of the content.
double npy_array_number(const NpyArray *array, uint64_t i);

// Writes the header of an array (version 1.0, little-endian, C order); `type` such as "<f4".
// Returns its size, a multiple of 64; `header` has room for NPY_HEADER_SIZE.
enum { NPY_HEADER_SIZE = 256 };
size_t npy_array_header(char header[NPY_HEADER_SIZE], const char *type, const uint64_t *shape,
                        uint32_t axes);
