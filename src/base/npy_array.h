// SPDX-License-Identifier: MIT
// One array as numpy stores it, after "NEP 1: A Simple File Format for NumPy Arrays" and
// numpy.lib.format: versions 1, 2 and 3 of the header, C and Fortran order, both byte orders.
#pragma once

#include "base/reader.h"

enum { NPY_MOST_AXES = 8 };

// Elements of `kind`: 'f' a float of 2, 4 or 8 bytes, 'i' and 'u' integers of 1, 2, 4 or 8, 'b' one
// byte of truth, 'U' and 'S' text of `item` bytes.
typedef struct NpyArray {
    char kind;
    uint32_t item;
    bool big, fortran;
    uint32_t axes;
    uint64_t shape[NPY_MOST_AXES];
    uint64_t count;      // of elements
    const uint8_t *data; // not owned; count * item bytes
    uint64_t at;         // their place in the content
} NpyArray;

// Reads the header; the data need not outlive the content. The reader ends behind the data. Fails
// at pickled objects, at structured and complex elements, and where the content ends before the
// data do.
Result npy_array_read(NpyArray *array, Reader *reader);

// "(100, 32, 3)"
void npy_array_describe(const NpyArray *array, char *text, size_t size);

// Whether it has numbers.
bool npy_array_is_number(const NpyArray *array);

// All elements as float32 in C order, correctly rounded; `to` has room for `count`.
void npy_array_copy(const NpyArray *array, float *to);

// Element i, in the order of the content.
double npy_array_number(const NpyArray *array, uint64_t i);

// The header of an array (version 1.0, little-endian, C order): `type` as "<f4". A multiple of 64
// bytes. Returns its size; `header` has room for NPY_HEADER_SIZE.
enum { NPY_HEADER_SIZE = 256 };
size_t npy_array_header(char header[NPY_HEADER_SIZE], const char *type, const uint64_t *shape,
                        uint32_t axes);
