// SPDX-License-Identifier: MIT
// Exact pictures of hair (image_reference.h), and how far a picture is from them.
#pragma once

#include "bench/bench_image_hair.h"
#include "image/image.h"

// How hair is drawn; the texts are the scene's.
typedef struct ImageManner {
    RunParams run;
    SectionParams material;
} ImageManner;

typedef struct ImageExactPicture {
    Image image;    // without pixels until it is needed
    double seconds; // that it took
} ImageExactPicture;

// Zeroed: none yet.
typedef struct ImageExact {
    ImageExactPicture pictures[2][2]; // without and with shadows, straight and smooth
} ImageExact;
void image_exact_destroy(ImageExact *exact);

// The picture for a manner, drawn if it was not yet: with the exact light at the vertices
// (shadow_reference_fill) for one with shadows, without for one without; smooth strands for one
// that smoothes; all strands for one that leaves some out. Many seconds.
Result image_exact_find(ImageExact *exact, const ImageHair *hair, const ImageManner *manner,
                        const ImageExactPicture **found, Error *error);

typedef struct ImageDistance {
    double rms;     // levels of 255 over the pixels that differ from the background in either
    double covered; // their share of all
} ImageDistance;

// The background is that of both, from 0 to 1.
ImageDistance image_exact_compare(const ImageExactPicture *picture, const float background[3],
                                  const Image *image);
