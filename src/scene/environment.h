// SPDX-License-Identifier: MIT
// The light from all around a scene, given by an equirectangular image: rows of equal latitude from
// the top, columns of equal longitude. The centre of the image is in the direction -z, its right
// half towards +x, its top towards +y, so a camera that looks along -z sees the centre of the
// image.
#pragma once

#include "base/error.h"
#include "image/image.h"

enum { ENVIRONMENT_ROWS = 32, ENVIRONMENT_COLUMNS = 64 };
enum { ENVIRONMENT_PARTS = ENVIRONMENT_ROWS * ENVIRONMENT_COLUMNS };

typedef struct EnvironmentPart {
    float way[3];   // unit, towards the part, in the environment's axes
    float share;    // of the sphere; the sum is 1
    float light[3]; // mean radiance, linear RGB; a white matt surface shows 1 under 1 from all
                    // sides
} EnvironmentPart;

// A zeroed struct is empty.
typedef struct Environment {
    EnvironmentPart *parts; // [ENVIRONMENT_PARTS] owned; NULL if there is none
    Image image;            // owned; empty unless it is kept
} Environment;

// Reads an .exr or .pfm file, and keeps its image if `keep`. RESULT_BAD_INPUT with path and reason,
// also if the image is not twice as wide as high; RESULT_FAILED when memory is short.
Result environment_read(Environment *environment, const char *path, bool keep, Error *error);

// Averages the image over each part. `image`: an IMAGE_FLOAT of any size; negative light counts as
// 0. RESULT_FAILED when memory is short.
Result environment_create(Environment *environment, const Image *image, Error *error);
void environment_destroy(Environment *environment);

// The environment's axes in the world: its axis k has the direction [k].
typedef struct EnvironmentAxes {
    float axis[3][3];
} EnvironmentAxes;

// The place in the image, which must be kept, of the direction `way` (world, of any length but 0):
// px from the left and from the top.
void environment_place(const Environment *environment, const EnvironmentAxes *axes,
                       const float way[3], float place[2]);

// The unit direction (world) of a longitude and a height. `turn`: rad from the centre of the image
// to the right; `up`: -1 .. 1.
void environment_way(const EnvironmentAxes *axes, double turn, double up, float way[3]);

// The radiance from the direction `way` (world, of any length but 0), linear RGB: interpolated
// between pixels of the image, which must be kept. Negative light counts as 0.
void environment_look(const Environment *environment, const EnvironmentAxes *axes,
                      const float way[3], float light[3]);

// The light of a white matt surface as a function of its unit normal (x, y, z), a polynomial of the
// second degree (Ramamoorthi and Hanrahan, SIGGRAPH 2001): the sum of these terms, linear RGB,
// times 1, y, x, z, xy, yz, zx, x^2 - z^2 and 3 y^2 - 1.
enum { ENVIRONMENT_TERMS = 9 };
void environment_around(const Environment *environment, const EnvironmentAxes *axes,
                        float terms[ENVIRONMENT_TERMS][3]);

// The mean radiance around each of `count` directions (at most ENVIRONMENT_DIRECTIONS; unit, world,
// towards the light), which must be spread evenly over the sphere. All light is counted: the mean
// over the directions is that of the environment.
enum { ENVIRONMENT_DIRECTIONS = 64 };
void environment_spread(const Environment *environment, const EnvironmentAxes *axes,
                        const float (*way)[3], int count, float (*light)[3]);
