// SPDX-License-Identifier: MIT
// Devices of the library, simulations and images on them, and interaction with the host's OpenGL
// context.
#include "base/random.h"
#include "support/library_fixture.h"

#include <cglm/cglm.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <math.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#define error library_error

static TractrixDevice *device; // for all tests that need no other device

// The environment variables that programs read have no effect.
static int open_device(void **state)
{
    (void)state;
    setenv("TRACTRIX_GLSL_DIR", "/nowhere", 1);
    WELL(tractrix_device_open(&device, NULL, &error));
    return 0;
}

static int close_device(void **state)
{
    (void)state;
    tractrix_device_destroy(device);
    return 0;
}

static const char *const NONE[] = {NULL};

static TractrixSimulation *simulate(TractrixDevice *on, const char *const *parameters)
{
    TractrixScene *scene = library_scene(parameters);
    TractrixSimulation *simulation;
    WELL(tractrix_simulation_create(&simulation, on, scene, &error));
    tractrix_scene_destroy(scene); // the simulation no longer needs it
    return simulation;
}

static TractrixPositions map(TractrixSimulation *simulation, TractrixPart part)
{
    TractrixPositions positions = {.size = sizeof positions};
    WELL(tractrix_simulation_map(simulation, 0, part, &positions, &error));
    return positions;
}

static void assert_near(const float *a, const float *b, float within)
{
    for (int k = 0; k < 3; ++k)
        if (!(fabsf(a[k] - b[k]) <= within)) // cppcheck-suppress objectIndex ; rows have three
            fail_msg("%g, %g, %g is not %g, %g, %g", (double)a[0], (double)a[1], (double)a[2],
                     (double)b[0], (double)b[1], (double)b[2]);
}

// --- Positions.

// The GPU stores strands of each size in tiles of their own; mapped positions are in the strands'
// original order.
static void maps_strands_in_their_order(void **state)
{
    static const char *const parameters[] = {"followers", "2", "follower_radius", "0.001", NULL};
    float position[FIXTURE_VERTICES][3];
    (void)state;
    TractrixSimulation *simulation = simulate(device, parameters);
    TractrixPositions guides = map(simulation, TRACTRIX_GUIDES);
    library_positions(position);
    assert_int_equal(guides.strand_count, FIXTURE_STRANDS);
    assert_int_equal(guides.vertex_count, FIXTURE_VERTICES);
    assert_memory_equal(guides.sizes, library_sizes, sizeof library_sizes);
    for (int v = 0; v < FIXTURE_VERTICES; ++v) {
        assert_near(&guides.position[4 * v], position[v], 1e-6f);
        assert_true(guides.position[4 * v + 3] == 1);
    }
    TractrixPositions followers = map(simulation, TRACTRIX_FOLLOWERS);
    assert_int_equal(followers.strand_count, 2 * FIXTURE_STRANDS);
    assert_int_equal(followers.vertex_count, 2 * FIXTURE_VERTICES);
    for (uint32_t s = 0, at = 0; s < 2 * FIXTURE_STRANDS; at += followers.sizes[s++]) {
        uint32_t first = 0; // of the strand's guide
        for (uint32_t g = 0; g < s / 2; ++g) first += library_sizes[g];
        assert_int_equal(followers.sizes[s], library_sizes[s / 2]);
        assert_near(&followers.position[4 * at], position[first], 0.0011f);
    }
    TractrixPositions positions = {.size = sizeof positions};
    library_refused(tractrix_simulation_map(simulation, 1, TRACTRIX_GUIDES, &positions, &error),
                    TRACTRIX_USAGE, "section: got 1, expected 0 to 0");
    positions.size = 3;
    library_refused(tractrix_simulation_map(simulation, 0, TRACTRIX_GUIDES, &positions, &error),
                    TRACTRIX_USAGE, "positions.size");
    library_refused(tractrix_simulation_copy_to_gl(simulation, 0, TRACTRIX_GUIDES, 1, 0, &error),
                    TRACTRIX_USAGE, "not borrowed");
    tractrix_simulation_destroy(simulation);
}

// --- Motion.

// A turn of 90 degrees about z within four frames, and a motion along x.
static TractrixPose pose_after(int frame)
{
    double half = 0.5 * 1.5707963267948966 * frame / 4;
    return (TractrixPose){{0, 0, sin(half), cos(half)}, {0.1 * frame, 0, 0}};
}

static void follows_poses(void **state)
{
    float position[FIXTURE_VERTICES][3];
    (void)state;
    TractrixSimulation *simulation = simulate(device, NONE);
    library_positions(position);
    for (int frame = 1; frame <= 4; ++frame) {
        TractrixPose pose = pose_after(frame);
        WELL(tractrix_simulation_advance(simulation, &pose, &error));
    }
    assert_true(fabs(tractrix_simulation_time(simulation) - 4.0 / 60) < 1e-9);
    WELL(tractrix_simulation_advance(simulation, NULL, &error)); // does not move
    TractrixPositions moved = map(simulation, TRACTRIX_GUIDES);
    for (uint32_t s = 0, at = 0; s < FIXTURE_STRANDS; at += library_sizes[s++]) {
        const float *p = position[at], root[3] = {0.4f - p[1], p[0], p[2]};
        assert_near(&moved.position[4 * at], root, 1e-6f);
    }
    tractrix_simulation_destroy(simulation);
}

// Roots follow any rotation of the head, and 1e-6 is more than the rounding of float32 below 1 m. A
// quaternion's length may differ from 1 by up to 1e-3, whatever its direction.
static void roots_follow_any_rotation(void **state)
{
    float position[FIXTURE_VERTICES][3];
    Random random = random_create(7, 0);
    (void)state;
    TractrixSimulation *simulation = simulate(device, NONE);
    library_positions(position);
    for (int i = 0; i < 20; ++i) {
        TractrixPose pose = {.translation = {0.1, -0.2, 0.3}};
        double *q = pose.rotation, length = 0;
        for (int k = 0; k < 4; ++k) q[k] = 2 * random_real(&random) - 1;
        for (int k = 0; k < 4; ++k) length += q[k] * q[k];
        for (int k = 0; k < 4; ++k) q[k] /= sqrt(length);
        WELL(tractrix_simulation_advance(simulation, &pose, &error));
        TractrixPositions moved = map(simulation, TRACTRIX_GUIDES);
        for (uint32_t s = 0, at = 0; s < FIXTURE_STRANDS; at += library_sizes[s++]) {
            const float *p = position[at];
            float root[3];
            for (int k = 0; k < 3; ++k) { // p + 2 w (q x p) + 2 q x (q x p), the product expanded
                int a = (k + 1) % 3, b = (k + 2) % 3;
                double along = q[0] * p[0] + q[1] * p[1] + q[2] * p[2];
                double square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2];
                root[k] = (float)(p[k] + 2 * q[3] * (q[a] * p[b] - q[b] * p[a]) +
                                  2 * (along * q[k] - square * p[k]) + pose.translation[k]);
            }
            assert_near(&moved.position[4 * at], root, 1e-6f);
        }
        const double scales[] = {1 - 9e-4, 1 + 9e-4, 1 - 1.1e-3, 1 + 1.1e-3};
        for (int n = 0; n < 4; ++n) {
            TractrixPose scaled = pose;
            for (int k = 0; k < 4; ++k) scaled.rotation[k] *= scales[n];
            if (n < 2)
                WELL(tractrix_simulation_place_body(simulation, 0, &scaled, &error));
            else
                library_refused(tractrix_simulation_place_body(simulation, 0, &scaled, &error),
                                TRACTRIX_USAGE, "head.rotation");
        }
    }
    tractrix_simulation_destroy(simulation);
}

// Keys of the scene and poses given by the host describe the same motion over frames of two steps
// each, and move hair equally. Poses are interpolated by screw motions and keys linearly, which is
// equal without rotation. The bound covers float32 positions at 0.5 m over 8 steps.
static void moves_as_the_scene_would(void **state)
{
    static const char json[] =
        "{\"sections\": [{\"file\": \"assets/curls.tfx\"}], \"substeps\": 2, \"head\": {\"keys\": "
        "[{\"time\": 0, \"translate\": [0, 0, 0]}, {\"time\": 1, \"translate\": [3, 1, 0]}], "
        "\"interpolation\": \"linear\"}}",
                      still[] = "{\"sections\": [{\"file\": \"assets/curls.tfx\"}], "
                                "\"substeps\": 2}";
    TractrixScene *scene;
    TractrixSimulation *keyed, *driven;
    (void)state;
    WELL(tractrix_scene_parse(&scene, json, NULL, &error));
    WELL(tractrix_simulation_create(&keyed, device, scene, &error));
    tractrix_scene_destroy(scene);
    WELL(tractrix_scene_parse(&scene, still, NULL, &error));
    WELL(tractrix_simulation_create(&driven, device, scene, &error));
    tractrix_scene_destroy(scene);
    for (int frame = 1; frame <= 4; ++frame) {
        const TractrixPose pose = {{0, 0, 0, 1}, {frame / 20.0, frame / 60.0, 0}};
        WELL(tractrix_simulation_advance(keyed, NULL, &error));
        WELL(tractrix_simulation_advance(driven, &pose, &error));
    }
    TractrixPositions a = map(keyed, TRACTRIX_GUIDES), b = map(driven, TRACTRIX_GUIDES);
    assert_int_equal(a.vertex_count, b.vertex_count);
    for (uint32_t v = 0; v < a.vertex_count; ++v)
        assert_near(&a.position[4 * v], &b.position[4 * v], 1e-5f);
    tractrix_simulation_destroy(keyed);
    tractrix_simulation_destroy(driven);
}

static void refuses_wrong_poses(void **state)
{
    static const char *const odd[] = {"sim_rate", "100", NULL};
    TractrixPose pose = pose_after(1);
    (void)state;
    TractrixSimulation *simulation = simulate(device, odd);
    library_refused(tractrix_simulation_advance(simulation, &pose, &error), TRACTRIX_USAGE,
                    "whole number");
    WELL(tractrix_simulation_advance(simulation, NULL, &error));
    tractrix_simulation_destroy(simulation);
    simulation = simulate(device, NONE);
    pose.rotation[3] = 2;
    library_refused(tractrix_simulation_advance(simulation, &pose, &error), TRACTRIX_USAGE,
                    "head.rotation");
    for (int k = 0; k < 3; ++k) {
        pose = pose_after(1);
        pose.translation[k] = k == 1 ? NAN : 1e9;
        library_refused(tractrix_simulation_advance(simulation, &pose, &error), TRACTRIX_USAGE,
                        "head.translation");
    }
    library_refused(tractrix_simulation_advance_mesh(simulation, library_sheet[0], 4, &error),
                    TRACTRIX_USAGE, "deforms");
    library_refused(tractrix_simulation_set(simulation, "drag", "1", &error), TRACTRIX_USAGE,
                    "live");
    library_refused(tractrix_simulation_set(simulation, "wnid", "1,0,0", &error), TRACTRIX_USAGE,
                    "wnid: the library has no such parameter: did you mean 'wind'?");
    library_refused(tractrix_simulation_set(simulation, "wind", "1", &error), TRACTRIX_USAGE,
                    "wind: ");
    tractrix_simulation_destroy(simulation);
}

static TractrixSimulation *simulate_sheet(bool deforms)
{
    TractrixScene *scene = library_scene(NONE);
    TractrixSimulation *simulation;
    library_set_sheet(scene, deforms);
    WELL(tractrix_simulation_create(&simulation, device, scene, &error));
    tractrix_scene_destroy(scene);
    return simulation;
}

static void moves_a_mesh_only_by_whole_steps(void **state)
{
    static const char *const odd[] = {"sim_rate", "100", NULL};
    TractrixScene *scene = library_scene(odd);
    TractrixSimulation *simulation;
    (void)state;
    library_set_sheet(scene, true);
    WELL(tractrix_simulation_create(&simulation, device, scene, &error));
    library_refused(tractrix_simulation_advance_mesh(simulation, library_sheet[0], 4, &error),
                    TRACTRIX_USAGE, "whole number");
    tractrix_simulation_destroy(simulation);
    tractrix_scene_destroy(scene);
}

// A mesh whose vertices move rigidly acts like a moving head; if it stretches to twice its width,
// so do the roots.
static void follows_a_mesh(void **state)
{
    float sheet[4][3], position[FIXTURE_VERTICES][3];
    (void)state;
    TractrixSimulation *skin = simulate_sheet(true), *head = simulate_sheet(false);
    for (int frame = 1; frame <= 4; ++frame) {
        const TractrixPose pose = {{0, 0, 0, 1}, {0.02 * frame, 0.01 * frame, 0}};
        memcpy(sheet, library_sheet, sizeof sheet);
        for (int v = 0; v < 4; ++v)
            for (int k = 0; k < 2; ++k) sheet[v][k] += (float)pose.translation[k];
        WELL(tractrix_simulation_advance_mesh(skin, sheet[0], 4, &error));
        WELL(tractrix_simulation_advance(head, &pose, &error));
    }
    TractrixPositions a = map(skin, TRACTRIX_GUIDES), b = map(head, TRACTRIX_GUIDES);
    for (uint32_t v = 0; v < FIXTURE_VERTICES; ++v)
        assert_near(&a.position[4 * v], &b.position[4 * v], 2e-5f);
    for (int v = 0; v < 4; ++v) sheet[v][0] = 2 * library_sheet[v][0];
    WELL(tractrix_simulation_advance_mesh(skin, sheet[0], 4, &error));
    WELL(tractrix_simulation_advance(skin, NULL, &error));
    a = map(skin, TRACTRIX_GUIDES);
    library_positions(position);
    for (uint32_t s = 0, at = 0; s < FIXTURE_STRANDS; at += library_sizes[s++]) {
        const float root[3] = {2 * position[at][0], sheet[0][1], position[at][2]};
        assert_near(&a.position[4 * at], root, 1e-5f);
    }
    const TractrixPose pose = pose_after(1);
    library_refused(tractrix_simulation_advance(skin, &pose, &error), TRACTRIX_USAGE, "deforms");
    library_refused(tractrix_simulation_advance_mesh(skin, sheet[0], 3, &error), TRACTRIX_USAGE,
                    "vertex_count");
    sheet[2][1] = NAN;
    library_refused(tractrix_simulation_advance_mesh(skin, sheet[0], 4, &error), TRACTRIX_BAD_INPUT,
                    "vertex 2");
    tractrix_simulation_destroy(skin);
    tractrix_simulation_destroy(head);
}

static void takes_live_parameters(void **state)
{
    static uint8_t before[FIXTURE_PIXELS][4], after[FIXTURE_PIXELS][4];
    TractrixRenderer *renderer;
    TractrixImage image = {.size = sizeof image, .width = 48, .height = 32, .pixels = before};
    (void)state;
    TractrixSimulation *still = simulate(device, NONE), *blown = simulate(device, NONE);
    WELL(tractrix_simulation_set(blown, "wind", "8,0,0", &error));
    for (int frame = 0; frame < 4; ++frame) {
        WELL(tractrix_simulation_advance(still, NULL, &error));
        WELL(tractrix_simulation_advance(blown, NULL, &error));
    }
    uint32_t tip = FIXTURE_VERTICES - 1;
    assert_true(map(blown, TRACTRIX_GUIDES).position[4 * tip] >
                map(still, TRACTRIX_GUIDES).position[4 * tip] + 1e-4f);
    WELL(tractrix_renderer_create(&renderer, still, 48, 32, TRACTRIX_RGBA8, &error));
    WELL(tractrix_render(renderer, NULL, &image, &error));
    WELL(tractrix_simulation_set(still, "fov", "60", &error)); // the automatic camera comes nearer
    image.pixels = after;
    WELL(tractrix_render(renderer, NULL, &image, &error));
    tractrix_renderer_destroy(renderer);
    assert_memory_not_equal(before, after, sizeof before);
    library_draw(still, NULL, before); // equals the image of a new renderer
    assert_memory_equal(before, after, sizeof before);
    tractrix_simulation_destroy(still);
    tractrix_simulation_destroy(blown);
}

// Parameters of drawing: a kept renderer draws what a new simulation with the parameter draws.
static void is_lit_and_coloured_anew(void **state)
{
    // What is changed, and a parameter that both simulations begin with.
    static const char *const CHANGES[][4] = {
        {"color", "#c02040", "exposure", "0"},
        {"tip_length", "0.6", "exposure", "0"},
        {"tip_color", "#20c040", "tip_length", "0.5"},
        {"opacity", "0.5", "exposure", "0"},
        {"diffuse", "0.8", "exposure", "0"},
        {"shading", "marschner", "exposure", "0"},
        {"roughness", "9", "shading", "marschner"},
        {"melanin", "0.9", "shading", "marschner"},
        {"shadow", "dom", "exposure", "0"},
        {"exposure", "1", "samples", "2"},
        {"samples", "2", "exposure", "0"},
        {"tone_map", "filmic", "exposure", "0"},
        {"background", "transparent", "exposure", "0"},
        {"aov", "depth", "exposure", "0"},
    };
    static uint8_t kept[FIXTURE_PIXELS][4], made[FIXTURE_PIXELS][4], last[FIXTURE_PIXELS][4];
    TractrixRenderer *renderer;
    TractrixImage image = {.size = sizeof image, .width = 48, .height = 32, .pixels = kept};
    (void)state;
    for (size_t i = 0; i < sizeof CHANGES / sizeof *CHANGES; ++i) {
        const char *const *change = CHANGES[i];
        const char *const before[] = {change[2], change[3], NULL};
        const char *const after[] = {change[2], change[3], change[0], change[1], NULL};
        TractrixSimulation *simulation = simulate(device, before), *other = simulate(device, after);
        WELL(tractrix_simulation_advance(simulation, NULL, &error));
        WELL(tractrix_simulation_advance(other, NULL, &error));
        WELL(tractrix_renderer_create(&renderer, simulation, 48, 32, TRACTRIX_RGBA8, &error));
        WELL(tractrix_render(renderer, NULL, &image, &error));
        memcpy(last, kept, sizeof last);
        WELL(tractrix_simulation_set_section(simulation, -1, change[0], change[1], &error));
        WELL(tractrix_render(renderer, NULL, &image, &error));
        library_draw(other, NULL, made);
        if (memcmp(kept, made, sizeof kept) != 0) fail_msg("%s", change[0]);
        if (memcmp(kept, last, sizeof kept) == 0) fail_msg("%s: no effect", change[0]);
        tractrix_renderer_destroy(renderer);
        tractrix_simulation_destroy(simulation);
        tractrix_simulation_destroy(other);
    }
    TractrixSimulation *simulation = simulate(device, NONE);
    library_refused(tractrix_simulation_set_section(simulation, 1, "color", "black", &error),
                    TRACTRIX_USAGE, "section: got 1 for color");
    library_refused(tractrix_simulation_set_section(simulation, 0, "exposure", "1", &error),
                    TRACTRIX_USAGE, "section: got 0 for exposure, expected -1");
    tractrix_simulation_destroy(simulation);
}

// The exposure of a scene is measured once on a device, and is the same for a second renderer.
static void keeps_the_exposure_of_a_scene(void **state)
{
    static uint8_t pixels[2][FIXTURE_PIXELS][4];
    TractrixScene *scene;
    TractrixDevice *own;
    (void)state;
    WELL(tractrix_device_open(&own, NULL, &error)); // which has measured nothing yet
    WELL(tractrix_scene_read(&scene, "assets/curls.tfx", &error));
    WELL(tractrix_scene_set(scene, -1, "algo", "none", &error));
    WELL(tractrix_scene_set(scene, -1, "raster", "blocks", &error));
    for (int i = 0; i < 2; ++i) {
        TractrixSimulation *simulation;
        WELL(tractrix_simulation_create(&simulation, own, scene, &error));
        library_draw(simulation, NULL, pixels[i]);
        tractrix_simulation_destroy(simulation);
    }
    assert_memory_equal(pixels[0], pixels[1], sizeof pixels[0]);
    tractrix_scene_destroy(scene);
    tractrix_device_destroy(own);
}

// From a saved state hair moves as it did before, in the same simulation and in another one.
static void returns_to_a_state(void **state)
{
    static const char *const blown[] = {"wind", "3,0,0", NULL};
    static uint8_t pixels[3][FIXTURE_PIXELS][4];
    float positions[3][FIXTURE_VERTICES][4];
    TractrixState *saved, *copy;
    size_t size;
    (void)state;
    TractrixSimulation *simulation = simulate(device, blown), *other = simulate(device, blown);
    for (int i = 0; i < 4; ++i) WELL(tractrix_simulation_advance(simulation, NULL, &error));
    WELL(tractrix_simulation_save(&saved, simulation, &error));
    const void *bytes = tractrix_state_bytes(saved, &size);
    WELL(tractrix_state_create(&copy, bytes, size, &error));
    double time = tractrix_simulation_time(simulation);
    for (int turn = 0; turn < 3; ++turn) {
        TractrixSimulation *moved = turn == 2 ? other : simulation;
        if (turn) WELL(tractrix_simulation_restore(moved, turn == 2 ? copy : saved, &error));
        assert_true(tractrix_simulation_time(moved) == time);
        library_draw(moved, NULL, pixels[turn]);
        for (int i = 0; i < 6; ++i) WELL(tractrix_simulation_advance(moved, NULL, &error));
        memcpy(positions[turn], map(moved, TRACTRIX_GUIDES).position, sizeof positions[turn]);
    }
    for (int turn = 1; turn < 3; ++turn) {
        assert_memory_equal(positions[0], positions[turn], sizeof positions[0]);
        assert_memory_equal(pixels[0], pixels[turn], sizeof pixels[0]);
    }
    tractrix_state_destroy(copy);
    WELL(tractrix_state_create(&copy, bytes, size / 2, &error));
    library_refused(tractrix_simulation_restore(other, copy, &error), TRACTRIX_BAD_INPUT,
                    "another simulation");
    WELL(tractrix_simulation_restore(other, saved, &error));
    TractrixPose pose = pose_after(1);
    WELL(tractrix_simulation_advance(other, &pose, &error));
    TractrixState *none;
    library_refused(tractrix_simulation_save(&none, other, &error), TRACTRIX_USAGE,
                    "the caller moves body 0");
    assert_null(none);
    tractrix_state_destroy(saved);
    tractrix_state_destroy(copy);
    tractrix_simulation_destroy(simulation);
    tractrix_simulation_destroy(other);
}

static bool give_up(void *data, double share)
{
    double *shares = data;
    shares[0] = shares[1], shares[1] = share;
    return share < 0.01;
}

static void a_warm_up_can_be_cancelled(void **state)
{
    static const char *const long_parameters[] = {"preroll", "3600", NULL};
    TractrixScene *scene = library_scene(long_parameters);
    TractrixSimulation *simulation;
    double shares[2] = {0};
    (void)state;
    tractrix_device_set_progress(device, give_up, shares);
    library_refused(tractrix_simulation_create(&simulation, device, scene, &error),
                    TRACTRIX_CANCELLED, "cancelled after");
    assert_null(simulation);
    assert_true(shares[0] < shares[1] && shares[1] >= 0.01 && shares[1] < 0.5);
    tractrix_device_set_progress(device, NULL, NULL);
    tractrix_scene_destroy(scene);
}

// Layers hold what images of --aov show, and the image is that of a call without layers.
static void layers_come_with_the_image(void **state)
{
    static uint8_t image_pixels[FIXTURE_PIXELS][4], plain[FIXTURE_PIXELS][4];
    static float coverage[FIXTURE_PIXELS], depth[FIXTURE_PIXELS], tangent[FIXTURE_PIXELS][3],
        aov[FIXTURE_PIXELS][4];
    static uint32_t strand[FIXTURE_PIXELS];
    TractrixRenderer *renderer;
    TractrixImage image = {.size = sizeof image, .width = 48, .height = 32, .pixels = image_pixels};
    TractrixImage floats = {.size = sizeof floats,
                            .width = 48,
                            .height = 32,
                            .format = TRACTRIX_RGBA32F,
                            .pixels = aov};
    const TractrixLayers layers = {sizeof layers, coverage, depth, tangent[0], strand};
    int hair = 0;
    (void)state;
    TractrixSimulation *simulation = simulate(device, NONE);
    library_draw(simulation, NULL, plain);
    WELL(tractrix_renderer_create(&renderer, simulation, 48, 32, TRACTRIX_RGBA8, &error));
    WELL(tractrix_render(renderer, NULL, &image, &error));
    WELL(tractrix_render_layers(renderer, NULL, &image, &layers, &error));
    assert_memory_equal(image_pixels, plain, sizeof plain);
    tractrix_renderer_destroy(renderer);
    WELL(tractrix_simulation_set(simulation, "aov", "depth", &error));
    WELL(tractrix_renderer_create(&renderer, simulation, 48, 32, TRACTRIX_RGBA32F, &error));
    WELL(tractrix_render(renderer, NULL, &floats, &error));
    for (int i = 0; i < FIXTURE_PIXELS; ++i) {
        const float *t = tangent[i];
        bool there = strand[i] != 0;
        assert_true(there == (depth[i] > 0) && coverage[i] >= 0 && coverage[i] <= 1);
        assert_true(!there || (depth[i] == aov[i][0] && coverage[i] > 0));
        assert_true(fabsf(t[0] * t[0] + t[1] * t[1] + t[2] * t[2] - (float)there) < 1e-5f);
        hair += there;
    }
    assert_in_range(hair, 5, FIXTURE_PIXELS);
    tractrix_renderer_destroy(renderer);
    tractrix_simulation_destroy(simulation);
}

// --- Images.

static int count_hair(uint8_t pixels[FIXTURE_PIXELS][4])
{
    int count = 0;
    for (int i = 0; i < FIXTURE_PIXELS; ++i) count += memcmp(pixels[i], pixels[0], 4) != 0;
    return count;
}

static void draws_by_views_and_formats(void **state)
{
    static const char *const clear[] = {"background", "transparent", NULL};
    static uint8_t pixels[FIXTURE_PIXELS][4];
    static float light[FIXTURE_PIXELS][4];
    // From 0.5 m in front of the hair, which fills about a third of the image's height.
    TractrixView view = {
        .size = sizeof view,
        .world_to_eye = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -0.04f, 0.06f, -0.5f, 1},
        .projection = {2, 0, 0, 0, 0, 3, 0, 0, 0, 0, -1.02f, -1, 0, 0, -0.0202f, 0}};
    TractrixRenderer *renderer;
    TractrixImage image = {.size = sizeof image,
                           .width = 48,
                           .height = 32,
                           .format = TRACTRIX_RGBA32F,
                           .pixels = light};
    (void)state;
    TractrixSimulation *simulation = simulate(device, clear);
    library_draw(simulation, &view, pixels);
    assert_in_range(count_hair(pixels), 5, FIXTURE_PIXELS / 2);
    assert_int_equal(pixels[0][3], 0);
    view.world_to_eye[14] = 0.5f; // behind the eye
    library_draw(simulation, &view, pixels);
    assert_int_equal(count_hair(pixels), 0);
    WELL(tractrix_renderer_create(&renderer, simulation, 48, 32, TRACTRIX_RGBA32F, &error));
    WELL(tractrix_render(renderer, NULL, &image, &error));
    float most = 0;
    for (int i = 0; i < FIXTURE_PIXELS; ++i) most = fmaxf(most, light[i][3]);
    assert_true(most > 0.05f && most <= 1 && light[0][3] == 0);
    view.projection[11] = 0;
    library_refused(tractrix_render(renderer, &view, &image, &error), TRACTRIX_USAGE, "view");
    view.projection[11] = -1;
    const float turns[][2] = {{0, -1}, {0, 2}, {5, 0.1f}, {3, 0.1f}}; // mirrored, scaled, ...
    for (size_t i = 0; i < sizeof turns / sizeof *turns; ++i) {
        TractrixView wrong = view;
        wrong.world_to_eye[(int)turns[i][0]] = turns[i][1];
        library_refused(tractrix_render(renderer, &wrong, &image, &error), TRACTRIX_USAGE,
                        "view.world_to_eye");
    }
    Random random = random_create(6, 0);
    for (int i = 0; i < 60; ++i) { // any rotation, but not its mirror image
        versor turn;
        mat4 rotation;
        for (int k = 0; k < 4; ++k) turn[k] = (float)(2 * random_real(&random) - 1);
        glm_quat_normalize(turn);
        glm_quat_mat4(turn, rotation);
        TractrixView turned = view;
        for (int k = 0; k < 12; ++k) turned.world_to_eye[k] = rotation[k / 4][k % 4];
        WELL(tractrix_render(renderer, &turned, &image, &error));
        for (int k = 0; k < 3; ++k) turned.world_to_eye[4 * (i % 3) + k] *= -1;
        library_refused(tractrix_render(renderer, &turned, &image, &error), TRACTRIX_USAGE,
                        "view.world_to_eye");
    }
    image.width = 47;
    library_refused(tractrix_render(renderer, NULL, &image, &error), TRACTRIX_USAGE, "48x32");
    tractrix_renderer_destroy(renderer);
    library_refused(tractrix_renderer_create(&renderer, simulation, 0, 32, TRACTRIX_RGBA8, &error),
                    TRACTRIX_USAGE, "size: got 0x32");
    assert_null(renderer);
    tractrix_simulation_destroy(simulation);
}

// A renderer keeps the number of threads for which it was made, because its lists have room for
// these only.
static void keeps_pixels_when_threads_change(void **state)
{
    enum { W = 480, H = 320 };
    static uint8_t pixels[2][W * H][4];
    TractrixRenderer *renderer;
    (void)state;
    TractrixSimulation *simulation = simulate(device, NONE);
    for (int i = 0; i < 2; ++i) {
        TractrixImage image = {.size = sizeof image, .width = W, .height = H, .pixels = pixels[i]};
        tractrix_set_threads(i ? 1 : 4);
        WELL(tractrix_renderer_create(&renderer, simulation, W, H, TRACTRIX_RGBA8, &error));
        tractrix_set_threads(i ? 4 : 1);
        WELL(tractrix_render(renderer, NULL, &image, &error));
        tractrix_set_threads(i ? 8 : 2);
        WELL(tractrix_render(renderer, NULL, &image, &error));
        tractrix_renderer_destroy(renderer);
    }
    tractrix_set_threads(0);
    assert_memory_equal(pixels[0], pixels[1], sizeof pixels[0]);
    tractrix_simulation_destroy(simulation);
}

static void refuses_what_has_no_effect(void **state)
{
    static const struct {
        const char *const parameters[5];
        const char *message;
    } WRONG[] = {{{"gust_period", "3"}, "no effect"},
                 {{"raster", "blocks", "oit", "none"}, "expected only one of them"},
                 {{"framing", "hair", "eye", "0,0,3"}, "--framing hair: expected an automatic"},
                 {{"unit", "cm"}, "--unit: has no effect: the hair is from an array"},
                 {{"strict", "true"}, "--strict: has no effect: the hair is from an array"},
                 {{"mesh_up", "z"}, "--mesh-up: has no effect: the mesh is from an array"},
                 {{"mesh_fps", "9"}, "--mesh-fps: has no effect: the mesh is from an array"}};
    TractrixSimulation *simulation;
    (void)state;
    for (size_t i = 0; i < sizeof WRONG / sizeof *WRONG; ++i) {
        TractrixScene *scene = library_scene(WRONG[i].parameters);
        library_set_sheet(scene, false);
        library_refused(tractrix_simulation_create(&simulation, device, scene, &error),
                        TRACTRIX_USAGE, WRONG[i].message);
        assert_null(simulation);
        tractrix_scene_destroy(scene);
    }
    TractrixScene *empty;
    WELL(tractrix_scene_create(&empty, NULL, &error));
    library_refused(tractrix_simulation_create(&simulation, device, empty, &error), TRACTRIX_USAGE,
                    "no hair");
    tractrix_scene_destroy(empty);
}

// --- Several bodies: two, both with the same hair.

#define TWO_BODIES(motion)                                                                         \
    "{\"look\": \"plain\", \"eye\": [0, 0, 2], \"target\": [0, 0, 0], \"bodies\": ["               \
    "{\"head\": {\"translate\": [-0.3, 0, 0]}, \"sections\": [{\"file\": \"curls.tfx\"}]}, "       \
    "{\"mesh\": \"ball.obj\", " motion                                                             \
    "\"sections\": [{\"file\": \"curls.tfx\", \"collide\": false}]}]}"

static TractrixScene *two_bodies(const char *json)
{
    TractrixScene *scene;
    WELL(tractrix_scene_parse(&scene, json, "assets", &error));
    assert_int_equal(tractrix_scene_body_count(scene), 2);
    return scene;
}

static TractrixSimulation *simulate_once(TractrixScene *scene)
{
    TractrixSimulation *simulation;
    WELL(tractrix_simulation_create(&simulation, device, scene, &error));
    tractrix_scene_destroy(scene);
    return simulation;
}

static void assert_same_guides(TractrixSimulation *one, TractrixSimulation *other, int section,
                               float within)
{
    TractrixPositions a = {.size = sizeof a}, b = {.size = sizeof b};
    WELL(tractrix_simulation_map(one, section, TRACTRIX_GUIDES, &a, &error));
    WELL(tractrix_simulation_map(other, section, TRACTRIX_GUIDES, &b, &error));
    assert_true(a.vertex_count > 0 && a.vertex_count == b.vertex_count);
    for (uint32_t v = 0; v < a.vertex_count; ++v)
        assert_near(&a.position[4 * v], &b.position[4 * v], within);
}

// A body that the host places moves its hair and its drawn mesh as the scene's formula does, and
// leaves the other body alone. A scene moves roots by displacements in double precision and a host
// by differences of float32; contacts would amplify that, so there are none. At most 1 % of the
// pixels (at silhouettes) may show those differences.
static void the_host_moves_one_of_two_bodies(void **state)
{
    static uint8_t pixels[2][FIXTURE_PIXELS][4];
    TractrixScene *scene =
        two_bodies(TWO_BODIES("\"head\": {\"translate\": [\"3*t\", \"t\", 0]}, "));
    TractrixSimulation *says = simulate_once(scene),
                       *placed = simulate_once(two_bodies(TWO_BODIES("")));
    int differing = 0;
    (void)state;
    for (int frame = 1; frame <= 6; ++frame) {
        const TractrixPose wrong = {{1, 0, 0, 0}, {9, 9, 9}},
                           pose = {{0, 0, 0, 1}, {frame / 20.0, frame / 60.0, 0}};
        WELL(tractrix_simulation_place_body(placed, 1, &wrong, &error)); // the last one counts
        WELL(tractrix_simulation_place_body(placed, 1, &pose, &error));
        WELL(tractrix_simulation_advance(placed, NULL, &error));
        WELL(tractrix_simulation_advance(says, NULL, &error));
    }
    for (int section = 0; section < 2; ++section) assert_same_guides(says, placed, section, 1e-5f);
    library_draw(says, NULL, pixels[0]);
    library_draw(placed, NULL, pixels[1]);
    for (int i = 0; i < FIXTURE_PIXELS; ++i)
        for (int c = 0; c < 3; ++c)
            if (abs(pixels[0][i][c] - pixels[1][i][c]) > 8) {
                ++differing;
                break;
            }
    assert_true(differing <= FIXTURE_PIXELS / 100);
    tractrix_simulation_destroy(says);
    tractrix_simulation_destroy(placed);
}

// A mesh with a small triangle around each root of the guides of section 0.
static void set_scales(TractrixScene *scene, uint32_t body, TractrixSimulation *of, bool deforms,
                       float (**vertices)[3], uint32_t *count)
{
    static const float AROUND[3][2] = {{-0.01f, -0.01f}, {0.01f, -0.01f}, {0, 0.01f}};
    TractrixPositions guides = map(of, TRACTRIX_GUIDES);
    *count = 3 * guides.strand_count;
    float(*position)[3] = *vertices = malloc(*count * sizeof *position);
    uint32_t *triangle = malloc(*count * sizeof *triangle);
    for (uint32_t s = 0, v = 0, at = 0; s < guides.strand_count; at += guides.sizes[s++])
        for (int k = 0; k < 3; ++k, ++v) {
            const float *root = guides.position + (size_t)4 * at;
            triangle[v] = v;
            position[v][0] = root[0] + AROUND[k][0];
            position[v][1] = root[1];
            position[v][2] = root[2] + AROUND[k][1];
        }
    WELL(tractrix_scene_set_body_mesh(scene, body,
                                      &(TractrixMesh){.size = sizeof(TractrixMesh),
                                                      .metres_per_unit = 1,
                                                      .deforms = deforms,
                                                      .vertex_count = *count,
                                                      .triangle_count = *count / 3,
                                                      .position = position[0],
                                                      .triangle = triangle},
                                      &error));
    free(triangle);
}

// A mesh from an array that the host shifts carries its body's hair as a pose would. Without
// colliders, because distances to a mesh that deforms are found in another way.
static void the_host_deforms_one_of_two_meshes(void **state)
{
    TractrixScene *soft = two_bodies(TWO_BODIES("")), *hard = two_bodies(TWO_BODIES("")), *one;
    float(*vertices)[3], (*unused)[3];
    uint32_t count;
    (void)state;
    WELL(tractrix_scene_read(&one, "assets/curls.tfx", &error));
    TractrixSimulation *still = simulate_once(one);
    set_scales(soft, 1, still, true, &vertices, &count);
    set_scales(hard, 1, still, false, &unused, &count);
    WELL(tractrix_scene_set(soft, -1, "collide", "false", &error));
    WELL(tractrix_scene_set(hard, -1, "collide", "false", &error));
    TractrixSimulation *mesh = simulate_once(soft), *head = simulate_once(hard);
    for (int frame = 1; frame <= 3; ++frame) {
        const TractrixPose pose = {{0, 0, 0, 1}, {0.02 * frame, 0, 0}};
        for (uint32_t v = 0; v < count; ++v) vertices[v][0] += 0.02f;
        WELL(tractrix_simulation_place_body_mesh(mesh, 1, vertices[0], count, &error));
        WELL(tractrix_simulation_place_body(head, 1, &pose, &error));
        WELL(tractrix_simulation_advance(mesh, NULL, &error));
        WELL(tractrix_simulation_advance(head, NULL, &error));
    }
    for (int section = 0; section < 2; ++section) assert_same_guides(mesh, head, section, 1e-4f);
    library_refused(tractrix_simulation_place_body_mesh(mesh, 1, vertices[0], count - 1, &error),
                    TRACTRIX_USAGE, "vertex_count");
    library_refused(tractrix_simulation_place_body_mesh(mesh, 0, vertices[0], count, &error),
                    TRACTRIX_USAGE, "deforms");
    library_refused(tractrix_simulation_advance_mesh(mesh, vertices[0], count, &error),
                    TRACTRIX_USAGE, "tractrix_simulation_place_body_mesh");
    // placed, but never simulated: freed with the simulation
    WELL(tractrix_simulation_place_body_mesh(mesh, 1, vertices[0], count, &error));
    tractrix_simulation_destroy(still);
    tractrix_simulation_destroy(mesh);
    tractrix_simulation_destroy(head);
    free(vertices);
    free(unused);
}

static void refuses_bodies_that_are_not_there(void **state)
{
    const TractrixPose pose = {.rotation = {0, 0, 0, 1}};
    const TractrixMesh mesh = {.size = sizeof mesh};
    TractrixScene *scene = two_bodies(TWO_BODIES(""));
    (void)state;
    library_refused(tractrix_scene_set_mesh(scene, &mesh, &error), TRACTRIX_USAGE, "2 bodies");
    library_refused(tractrix_scene_set_body_mesh(scene, 2, &mesh, &error), TRACTRIX_USAGE,
                    "body: got 2, expected 0 to 1");
    library_refused(tractrix_scene_set_body_mesh(scene, 0, NULL, &error), TRACTRIX_USAGE,
                    "mesh: got NULL");
    TractrixSimulation *simulation = simulate_once(scene);
    library_refused(tractrix_simulation_advance(simulation, &pose, &error), TRACTRIX_USAGE,
                    "2 bodies");
    library_refused(tractrix_simulation_place_body(simulation, 2, &pose, &error), TRACTRIX_USAGE,
                    "body: got 2, expected 0 to 1");
    library_refused(tractrix_simulation_place_body(simulation, 1, NULL, &error), TRACTRIX_USAGE,
                    "NULL");
    tractrix_simulation_destroy(simulation);
}

// --- Lifetimes.

static void children_keep_their_parents(void **state)
{
    static uint8_t one[FIXTURE_PIXELS][4], other[FIXTURE_PIXELS][4];
    TractrixDevice *own;
    TractrixRenderer *renderer;
    TractrixImage image = {.size = sizeof image, .width = 48, .height = 32, .pixels = one};
    (void)state;
    WELL(tractrix_device_open(&own, NULL, &error));
    assert_true(*tractrix_device_text(own, "renderer") && !*tractrix_device_text(own, "colour"));
    TractrixSimulation *simulation = simulate(own, NONE);
    WELL(tractrix_renderer_create(&renderer, simulation, 48, 32, TRACTRIX_RGBA8, &error));
    tractrix_device_destroy(own);
    tractrix_simulation_destroy(simulation);
    WELL(tractrix_render(renderer, NULL, &image, &error));
    tractrix_renderer_destroy(renderer);
    simulation = simulate(device, NONE);
    library_draw(simulation, NULL, other);
    assert_memory_equal(one, other, sizeof one);
    tractrix_simulation_destroy(simulation);
    tractrix_device_destroy(NULL);
    tractrix_simulation_destroy(NULL);
    tractrix_renderer_destroy(NULL);
    const TractrixDeviceOptions both = {sizeof both, NULL, true, true},
                                none = {sizeof none, "no such device", false, false};
    library_refused(tractrix_device_open(&own, &both, &error), TRACTRIX_USAGE,
                    "expected only one of them");
    library_refused(tractrix_device_open(&own, &none, &error), TRACTRIX_NO_GL, "no such device");
}

// In a forked child no function that needs a device works, and none hangs.
static void says_so_after_fork(void **state)
{
    (void)state;
    TractrixSimulation *simulation = simulate(device, NONE);
    pid_t child = fork();
    if (child == 0) {
        TractrixResult result = tractrix_simulation_advance(simulation, NULL, &error);
        bool told = result == TRACTRIX_NO_GL && strstr(error.text, "fork");
        TractrixDevice *own;
        result = tractrix_device_open(&own, NULL, &error);
        told = told && result == TRACTRIX_NO_GL && !own && strstr(error.text, "fork");
        tractrix_simulation_destroy(simulation);
        _exit(told ? 0 : 1);
    }
    int status = 1;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_int_equal(status, 0);
    WELL(tractrix_simulation_advance(simulation, NULL, &error));
    tractrix_simulation_destroy(simulation);
}

// --- Two devices at once.

typedef struct Job {
    pthread_t thread;
    float position[FIXTURE_VERTICES][4];
    uint8_t pixels[FIXTURE_PIXELS][4];
} Job;

static void work_on(TractrixDevice *on, Job *job)
{
    static const char *const windy[] = {"wind", "3,0,0", "shading", "marschner", NULL};
    TractrixSimulation *simulation = simulate(on, windy);
    for (int frame = 1; frame <= 4; ++frame) {
        TractrixPose pose = pose_after(frame);
        WELL(tractrix_simulation_advance(simulation, &pose, &library_error));
    }
    TractrixPositions positions = map(simulation, TRACTRIX_GUIDES);
    memcpy(job->position, positions.position, sizeof job->position);
    library_draw(simulation, NULL, job->pixels);
    tractrix_simulation_destroy(simulation);
}

static void *work(void *data)
{
    TractrixDevice *own;
    if (tractrix_device_open(&own, NULL, NULL) == TRACTRIX_OK) work_on(own, data);
    tractrix_device_destroy(own);
    return NULL;
}

static void two_devices_work_side_by_side(void **state)
{
    static Job jobs[3];
    (void)state;
    for (int i = 0; i < 2; ++i)
        assert_int_equal(pthread_create(&jobs[i].thread, NULL, work, &jobs[i]), 0);
    for (int i = 0; i < 2; ++i) pthread_join(jobs[i].thread, NULL);
    work_on(device, &jobs[2]);
    assert_in_range(count_hair(jobs[2].pixels), 5, FIXTURE_PIXELS);
    for (int i = 0; i < 2; ++i) {
        assert_memory_equal(jobs[i].position, jobs[2].position, sizeof jobs[2].position);
        assert_memory_equal(jobs[i].pixels, jobs[2].pixels, sizeof jobs[2].pixels);
    }
}

// --- The host's context.

static EGLDisplay host_display;
static EGLContext host_context;

static void make_host(void)
{
    static const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                        4,
                                        EGL_CONTEXT_MINOR_VERSION,
                                        3,
                                        EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                        EGL_NONE};
    host_display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, NULL, NULL);
    assert_true(host_display && eglInitialize(host_display, NULL, NULL));
    eglBindAPI(EGL_OPENGL_API);
    host_context = eglCreateContext(host_display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
    assert_non_null(host_context);
    assert_true(eglMakeCurrent(host_display, EGL_NO_SURFACE, EGL_NO_SURFACE, host_context));
}

static void drop_host(void)
{
    eglMakeCurrent(host_display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(host_display, host_context);
}

// A device of the same driver is opened, used and closed while the host's context is current: the
// context stays current with its bindings, and its display stays initialised.
static void leaves_a_hosts_context_alone(void **state)
{
    TractrixDevice *own;
    GLuint buffer;
    GLint bound = 0;
    static Job job;
    (void)state;
    make_host();
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glBufferData(GL_ARRAY_BUFFER, 16, "fifteen letters", GL_STATIC_DRAW);
    WELL(tractrix_device_open(&own, NULL, &error));
    work_on(own, &job);
    tractrix_device_destroy(own);
    assert_ptr_equal(eglGetCurrentContext(), host_context);
    glGetIntegerv(GL_ARRAY_BUFFER_BINDING, &bound);
    assert_int_equal(bound, buffer);
    char text[16];
    glGetBufferSubData(GL_ARRAY_BUFFER, 0, sizeof text, text);
    assert_string_equal(text, "fifteen letters");
    assert_int_equal(glGetError(), GL_NO_ERROR);
    assert_true(eglMakeCurrent(host_display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT));
    assert_true(eglMakeCurrent(host_display, EGL_NO_SURFACE, EGL_NO_SURFACE, host_context));
    drop_host();
}

// Positions and pixels in a borrowed context equal those in an own context, whatever the host does
// in between.
static void works_in_a_borrowed_context(void **state)
{
    TractrixDevice *borrowed = (TractrixDevice *)&error;
    static Job job, own;
    GLuint buffers[2];
    (void)state;
    library_refused(tractrix_device_borrow(&borrowed, &error), TRACTRIX_NO_GL, "no OpenGL context");
    assert_null(borrowed);
    make_host();
    WELL(tractrix_device_borrow(&borrowed, &error));
    work_on(borrowed, &job);
    work_on(device, &own);
    assert_memory_equal(job.position, own.position, sizeof own.position);
    assert_memory_equal(job.pixels, own.pixels, sizeof own.pixels);
    TractrixSimulation *simulation = simulate(borrowed, NONE);
    glGenBuffers(2, buffers);
    glBindBuffer(GL_ARRAY_BUFFER, buffers[0]);
    glBufferData(GL_ARRAY_BUFFER, 32 + sizeof own.position, NULL, GL_STREAM_DRAW);
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, buffers[0]); // the host's own uniforms
    WELL(tractrix_simulation_advance(simulation, NULL, &error));
    WELL(tractrix_simulation_copy_to_gl(simulation, 0, TRACTRIX_GUIDES, buffers[0], 32, &error));
    glBindBuffer(GL_ARRAY_BUFFER, buffers[0]);
    glGetBufferSubData(GL_ARRAY_BUFFER, 32, sizeof job.position, job.position);
    assert_memory_equal(job.position, map(simulation, TRACTRIX_GUIDES).position,
                        sizeof job.position);
    library_refused(
        tractrix_simulation_copy_to_gl(simulation, 0, TRACTRIX_GUIDES, buffers[0], 48, &error),
        TRACTRIX_USAGE, "buffer: has ");
    library_refused(
        tractrix_simulation_copy_to_gl(simulation, 0, TRACTRIX_GUIDES, buffers[0], 8, &error),
        TRACTRIX_USAGE, "multiple of 16");
    library_refused(tractrix_simulation_copy_to_gl(simulation, 0, TRACTRIX_GUIDES, 9999, 0, &error),
                    TRACTRIX_USAGE, "9999");
    glEnable(0x1234); // an error by the host must not be reported as the library's
    WELL(tractrix_simulation_advance(simulation, NULL, &error));
    eglMakeCurrent(host_display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    library_refused(tractrix_simulation_advance(simulation, NULL, &error), TRACTRIX_NO_GL,
                    "no OpenGL context");
    eglMakeCurrent(host_display, EGL_NO_SURFACE, EGL_NO_SURFACE, host_context);
    tractrix_simulation_destroy(simulation);
    tractrix_device_destroy(borrowed);
    drop_host();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_host_moves_one_of_two_bodies),
        cmocka_unit_test(the_host_deforms_one_of_two_meshes),
        cmocka_unit_test(refuses_bodies_that_are_not_there),
        cmocka_unit_test(maps_strands_in_their_order),
        cmocka_unit_test(follows_poses),
        cmocka_unit_test(roots_follow_any_rotation),
        cmocka_unit_test(moves_as_the_scene_would),
        cmocka_unit_test(refuses_wrong_poses),
        cmocka_unit_test(moves_a_mesh_only_by_whole_steps),
        cmocka_unit_test(follows_a_mesh),
        cmocka_unit_test(takes_live_parameters),
        cmocka_unit_test(is_lit_and_coloured_anew),
        cmocka_unit_test(keeps_the_exposure_of_a_scene),
        cmocka_unit_test(returns_to_a_state),
        cmocka_unit_test(a_warm_up_can_be_cancelled),
        cmocka_unit_test(layers_come_with_the_image),
        cmocka_unit_test(draws_by_views_and_formats),
        cmocka_unit_test(keeps_pixels_when_threads_change),
        cmocka_unit_test(refuses_what_has_no_effect),
        cmocka_unit_test(children_keep_their_parents),
        cmocka_unit_test(says_so_after_fork),
        cmocka_unit_test(two_devices_work_side_by_side),
        cmocka_unit_test(leaves_a_hosts_context_alone),
        cmocka_unit_test(works_in_a_borrowed_context),
    };
    return cmocka_run_group_tests_name("library_device", tests, open_device, close_device);
}
