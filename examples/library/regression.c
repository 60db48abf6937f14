// SPDX-License-Identifier: MIT
// An image regression test: draws a scene and compares it with a golden picture. Status 0: equal
// within the limits; 1: different, the new picture is at NEW.png; 2: an error prevented the
// comparison.
//   cc regression.c -o regression $(pkg-config --cflags --libs tractrix)
//   ./regression SCENE GOLDEN.png NEW.png
#include <stdio.h>
#include <stdlib.h>
#include <tractrix.h>

static TractrixError error;

static void need(TractrixResult result)
{
    if (result == TRACTRIX_OK) return;
    fprintf(stderr, "regression: %s\n", error.text);
    exit(2);
}

int main(int argc, char **argv)
{
    if (argc != 4) return fprintf(stderr, "regression: expected SCENE GOLDEN.png NEW.png\n"), 2;
    TractrixPicture *golden;
    need(tractrix_picture_read(&golden, argv[2], &error));
    const TractrixImage *expected = tractrix_picture_image(golden);

    // A CPU driver, so that a machine with a GPU draws the same image.
    const TractrixDeviceOptions options = {.size = sizeof options, .software = true};
    TractrixDevice *device;
    TractrixScene *scene;
    TractrixSimulation *simulation;
    TractrixRenderer *renderer;
    need(tractrix_device_open(&device, &options, &error));
    need(tractrix_scene_read(&scene, argv[1], &error));
    need(tractrix_simulation_create(&simulation, device, scene, &error));
    need(tractrix_renderer_create(&renderer, simulation, expected->width, expected->height,
                                  TRACTRIX_RGBA8, &error));
    TractrixImage image = {.size = sizeof image,
                           .width = expected->width,
                           .height = expected->height,
                           .pixels = malloc((size_t)expected->width * expected->height * 4)};
    need(tractrix_render(renderer, NULL, &image, &error));

    // Passes if at most 0.1 % of the pixels differ by more than 2 levels of 255, and no 16 x 16
    // pixels by more than 0.4 levels in the mean.
    const TractrixLimits limits = {.size = sizeof limits,
                                   .pixel_tolerance = 2,
                                   .max_failing_percent = 0.1,
                                   .max_local_difference = 0.4};
    TractrixFigures figures = {.size = sizeof figures};
    need(tractrix_compare(&figures, NULL, &image, expected, NULL, &limits, &error));
    printf("%s: RMSE %.3g levels, FLIP %.3g, %llu of %llu pixels are off by more than 2 levels\n",
           figures.equal    ? "same"
           : figures.within ? "within limits"
                            : "different",
           figures.rmse, figures.flip, (unsigned long long)figures.failing,
           (unsigned long long)figures.compared);
    if (!figures.within) need(tractrix_image_write(&image, argv[3], &error));
    free(image.pixels);
    tractrix_renderer_destroy(renderer);
    tractrix_simulation_destroy(simulation);
    tractrix_scene_destroy(scene);
    tractrix_device_destroy(device);
    tractrix_picture_destroy(golden);
    return figures.within ? 0 : 1;
}
