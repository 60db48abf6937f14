// SPDX-License-Identifier: MIT
// Makes a data set: grooms from numbers, ten frames of motion for each, all positions in one .npy
// of shape (grooms, strands, vertices, 4), and a picture of each.
//   cc grooms.c -o grooms $(pkg-config --cflags --libs tractrix) -lm
//   ./grooms FOLDER COUNT
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tractrix.h>

enum { STRANDS = 600, VERTICES = 16, SIDE = 256, FRAMES = 10 };

static TractrixError error;
#define NEED(call)                                                                                 \
    do {                                                                                           \
        if ((call) != TRACTRIX_OK) {                                                               \
            fprintf(stderr, "grooms: %s\n", error.text);                                           \
            exit(1);                                                                               \
        }                                                                                          \
    } while (0)

// Strands all over a ball with a radius of 10 cm; each groom has its own length and curl.
static void make_groom(float position[STRANDS][VERTICES][3], int groom)
{
    double length = 0.08 + 0.02 * (groom % 5), curl = 0.004 * (groom % 3);
    for (int s = 0; s < STRANDS; ++s) {
        double y = 1 - (s + 0.5) / STRANDS, around = 2.399963 * s, r = sqrt(1 - y * y);
        double n[3] = {r * cos(around), y, r * sin(around)};
        for (int v = 0; v < VERTICES; ++v) {
            double way = 0.1 + length * v / (VERTICES - 1), turn = 0.9 * v;
            position[s][v][0] = (float)(n[0] * way + curl * (cos(turn) - 1));
            position[s][v][1] = (float)(n[1] * way + curl * sin(turn));
            position[s][v][2] = (float)(n[2] * way);
        }
    }
}

// Writes the header of numpy's format 1.0: 128 bytes.
static FILE *open_npy(const char *folder, int grooms)
{
    char path[4096], header[128];
    snprintf(path, sizeof path, "%s/positions.npy", folder);
    FILE *file = fopen(path, "wb");
    if (!file) perror(path), exit(1);
    memset(header, ' ', sizeof header);
    memcpy(header, "\x93NUMPY\x01\x00\x76\x00", 10);
    int length = snprintf(header + 10, 118,
                          "{'descr': '<f4', 'fortran_order': False, 'shape': (%d, %d, %d, 4)}",
                          grooms, STRANDS, VERTICES);
    header[10 + length] = ' ', header[127] = '\n';
    fwrite(header, 1, sizeof header, file);
    return file;
}

static void do_groom(TractrixDevice *device, const char *folder, int groom, FILE *npy)
{
    static float position[STRANDS][VERTICES][3];
    static uint8_t pixels[SIDE][SIDE][4];
    const TractrixStrands strands = {.size = sizeof strands,
                                     .metres_per_unit = 1,
                                     .strand_count = STRANDS,
                                     .vertices_each = VERTICES,
                                     .position = position[0][0]};
    TractrixScene *scene;
    TractrixSimulation *simulation;
    TractrixRenderer *renderer;
    TractrixPositions moved = {.size = sizeof moved};
    TractrixImage image = {sizeof image, SIDE, SIDE, TRACTRIX_RGBA8, 0, pixels};
    char path[4096];
    make_groom(position, groom);
    NEED(tractrix_scene_create(&scene, "plain", &error));
    NEED(tractrix_scene_add_strands(scene, "groom", &strands, &error));
    NEED(tractrix_scene_set(scene, -1, "wind", "1.5,0,0", &error));
    NEED(tractrix_simulation_create(&simulation, device, scene, &error));
    for (int frame = 0; frame < FRAMES; ++frame)
        NEED(tractrix_simulation_advance(simulation, NULL, &error));
    NEED(tractrix_simulation_map(simulation, 0, TRACTRIX_GUIDES, &moved, &error));
    fwrite(moved.position, 16, moved.vertex_count, npy);
    NEED(tractrix_renderer_create(&renderer, simulation, SIDE, SIDE, TRACTRIX_RGBA8, &error));
    NEED(tractrix_render(renderer, NULL, &image, &error));
    snprintf(path, sizeof path, "%s/groom_%04d.png", folder, groom);
    NEED(tractrix_image_write(&image, path, &error));
    tractrix_renderer_destroy(renderer);
    tractrix_simulation_destroy(simulation);
    tractrix_scene_destroy(scene);
}

int main(int argc, char **argv)
{
    TractrixDevice *device;
    int grooms = argc == 3 ? atoi(argv[2]) : 0;
    if (grooms < 1) return fprintf(stderr, "grooms: expected FOLDER COUNT\n"), 2;
    NEED(tractrix_device_open(&device, NULL, &error));
    FILE *npy = open_npy(argv[1], grooms);
    for (int groom = 0; groom < grooms; ++groom) do_groom(device, argv[1], groom, npy);
    tractrix_device_destroy(device);
    return fclose(npy) == 0 ? 0 : 1;
}
