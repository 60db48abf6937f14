// SPDX-License-Identifier: MIT
#include "gen/head_motion.h"
#include "base/double3.h"
#include "base/portable.h"
#include "formats/npy_array.h"
#include "formats/zip.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SAMPLES = HEAD_MOTION_RATE * HEAD_MOTION_SECONDS + 1 };
static const double UNIT = 1e-5; // m

static double rise(double from, double to, double x)
{
    double share = fmin(fmax((x - from) / (to - from), 0), 1);
    return share * share * (3 - 2 * share);
}

// The pose of the skeleton. Angles are in turns (1 = 360 degrees).
typedef struct Skeleton {
    double turn, nod, tilt; // rotation of the head about the neck
    double jaw;             // opening angle
    double shrug, breath;   // m: lift of the shoulders, of the chest
} Skeleton;

// `at`: time from 0 to 1. The motion begins and ends at rest in all parts.
static Skeleton pose_at(double at)
{
    double hold = portable_sine(at / 2); // 0 at both ends; the square is smooth there
    hold *= hold;
    double talks = rise(0.72, 0.78, at) * rise(0.98, 0.92, at);
    return (Skeleton){
        .turn = 0.09 * portable_sine(2 * at) * hold,
        .nod = 0.03 * portable_sine(3 * at) * hold + 0.012 * hold,
        .tilt = 0.022 * portable_sine(at) * hold,
        .jaw = 0.014 * talks * (1 - portable_cosine(16 * at)),
        .shrug = 0.016 * rise(0.03, 0.1, at) * rise(0.25, 0.17, at),
        .breath = 0.002 * (1 - portable_cosine(2 * at)),
    };
}

// Rotates p about an axis through `pivot`, from axis u towards axis v.
static void turn_about(Double3 p, const Double3 pivot, int u, int v, double turns)
{
    double c = portable_cosine(turns), s = portable_sine(turns), x = p[u] - pivot[u],
           y = p[v] - pivot[v];
    p[u] = pivot[u] + c * x - s * y;
    p[v] = pivot[v] + s * x + c * y;
}

// Moves a vertex with each part by its weight. Along the neck the weight of the head's rotation
// rises, so the skin twists.
static void skin(const Skeleton *skeleton, Double3 p)
{
    static const Double3 NECK = {0, -0.15, -0.02}, HINGE = {0, -0.035, 0.0};
    double y = p[1], z = p[2];
    double head = rise(-0.2, -0.09, y),
           jaw = rise(-0.052, -0.075, y) * rise(-0.145, -0.115, y) * rise(0.0, 0.035, z),
           shoulder = rise(-0.19, -0.24, y) * rise(0.04, 0.1, fabs(p[0])),
           chest = rise(-0.2, -0.27, y) * rise(-0.02, 0.06, z);
    turn_about(p, HINGE, 1, 2, jaw * skeleton->jaw); // the chin moves down and back
    p[1] += shoulder * skeleton->shrug;
    p[2] += chest * skeleton->breath;
    turn_about(p, NECK, 2, 0, head * skeleton->turn);
    turn_about(p, NECK, 1, 2, head * skeleton->nod);
    turn_about(p, NECK, 0, 1, head * skeleton->tilt);
}

static void fill(int16_t (*points)[3], const Mesh *mesh)
{
    for (int i = 0; i < SAMPLES; ++i) {
        Skeleton skeleton = pose_at((double)(i % (SAMPLES - 1)) / (SAMPLES - 1));
        for (uint32_t v = 0; v < mesh->vertex_count; ++v, ++points) {
            Double3 p;
            double3_from_float(mesh->position[v], p);
            skin(&skeleton, p);
            for (int k = 0; k < 3; ++k) (*points)[k] = (int16_t)lrint(p[k] / UNIT);
        }
    }
}

static void add(ZipWriter *zip, const char *name, const char *type, const uint64_t *shape,
                uint32_t axes, const void *data, size_t size)
{
    char header[NPY_HEADER_SIZE];
    size_t head = npy_array_header(header, type, shape, axes);
    zip_add(zip, name, header, head, data, size);
}

Result head_motion_write(const char *path, const Mesh *mesh, Error *error)
{
    const uint64_t shape[3] = {SAMPLES, mesh->vertex_count, 3},
                   faces[2] = {mesh->triangle_count, 3};
    const double fps = HEAD_MOTION_RATE;
    size_t count = (size_t)SAMPLES * mesh->vertex_count;
    int16_t(*points)[3] = malloc(count * sizeof *points + 1);
    if (!points) return error_set(error, RESULT_FAILED, "no memory for a head in motion");
    fill(points, mesh);
    OutFile file;
    Result result = outfile_open(&file, path, error);
    if (result == RESULT_OK) {
        // Numbers of two and four bytes in the machine's byte order, which the header of .npy
        // names.
        const bool big = __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__;
        ZipWriter zip = {.out = &file};
        add(&zip, "positions.npy", big ? ">i2" : "<i2", shape, 3, points, count * sizeof *points);
        add(&zip, "faces.npy", big ? ">u4" : "<u4", faces, 2, mesh->triangle,
            mesh->triangle_count * sizeof *mesh->triangle);
        add(&zip, "fps.npy", big ? ">f8" : "<f8", shape, 0, &fps, sizeof fps);
        add(&zip, "unit.npy", big ? ">f8" : "<f8", shape, 0, &UNIT, sizeof UNIT);
        result = zip_finish(&zip, error);
        THEN(result, outfile_commit(&file, error));
    }
    free(points);
    return result;
}
