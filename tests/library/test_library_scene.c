// SPDX-License-Identifier: MIT
// Scenes of the library, which need no device: parameters, arrays, errors as return values; and
// images.
#include "support/library_fixture.h"

#include <jansson.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static void reads_and_writes_parameters(void **state)
{
    TractrixScene *scene;
    char text[32] = "", json[20000];
    (void)state;
    WELL(tractrix_scene_create(&scene, "plain", &library_error));
    WELL(tractrix_scene_set(scene, -1, "wind", "2,0,-1", &library_error));
    assert_int_equal(tractrix_scene_get(scene, -1, "wind", text, sizeof text), 6);
    assert_string_equal(text, "2,0,-1");
    // The text is truncated to the buffer, and the full length is returned.
    assert_int_equal(tractrix_scene_get(scene, -1, "wind", text, 3), 6);
    assert_string_equal(text, "2,");
    assert_int_equal(tractrix_scene_get(scene, -1, "wind", NULL, 0), 6);
    assert_int_equal(tractrix_scene_get(scene, -1, "no_such", text, sizeof text), 0);
    assert_string_equal(text, "");
    library_refused(tractrix_scene_set(scene, -1, "wnd", "1,0,0", &library_error), TRACTRIX_USAGE,
                    "wnd");
    library_refused(tractrix_scene_set(scene, -1, "gust", "-1", &library_error), TRACTRIX_USAGE,
                    "gust: ");
    library_refused(tractrix_scene_set(scene, -1, "output", "x.png", &library_error),
                    TRACTRIX_USAGE, "output");
    library_refused(tractrix_scene_set(scene, 0, "algo", "split", &library_error), TRACTRIX_USAGE,
                    "section");
    library_refused(tractrix_scene_set(scene, 1, "algo", "split", &library_error), TRACTRIX_USAGE,
                    "section: got 1, expected -1 to -1");
    // Refused values change nothing, and a NULL error is allowed.
    assert_int_equal(tractrix_scene_set(scene, -1, "wind", "fast", NULL), TRACTRIX_USAGE);
    tractrix_scene_get(scene, -1, "wind", text, sizeof text);
    assert_string_equal(text, "2,0,-1");
    WELL(tractrix_scene_set(scene, -1, "colliders", "ground:0", &library_error));
    library_refused(tractrix_scene_set(scene, -1, "colliders", "ground:1;cube:3", &library_error),
                    TRACTRIX_USAGE, "cube");
    tractrix_scene_json(scene, json, sizeof json);
    assert_non_null(strstr(json, "\"ground\": 0"));
    assert_null(strstr(json, "\"ground\": 1"));
    tractrix_scene_destroy(scene);
    tractrix_scene_destroy(NULL);
}

static void lists_parameters(void **state)
{
    size_t count = 0, live = 0;
    bool wind = false;
    (void)state;
    for (const TractrixParameter *row; (row = tractrix_parameter(count)); ++count) {
        assert_true(*row->name && *row->kind && *row->help && row->default_text);
        assert_int_equal(*row->choices != 0, strcmp(row->kind, "choice") == 0);
        assert_string_not_equal(row->name, "output");
        assert_string_not_equal(row->name, "sdf_cache");
        assert_string_not_equal(row->name, "platform");
        live += row->live;
        if (strcmp(row->name, "look") == 0) assert_string_equal(row->choices, "studio plain");
        if (strcmp(row->name, "wind") == 0)
            wind = row->live && !row->of_section && strcmp(row->unit, "m/s") == 0;
    }
    assert_true(wind && count > 100);
    assert_int_equal(live, 12 + 45); // of motion and camera, and of drawing alone
    assert_ptr_equal(tractrix_parameter(0), tractrix_parameter(0));
}

// A look changes only parameters that were not set explicitly, in any order.
static void gives_way_to_looks(void **state)
{
    TractrixScene *one, *other;
    char a[20000], b[20000];
    (void)state;
    WELL(tractrix_scene_parse(&one, "{\"sections\": [{\"file\": \"assets/fur.tfx\"}]}", NULL,
                              &library_error));
    WELL(tractrix_scene_parse(&other, "{\"sections\": [{\"file\": \"assets/fur.tfx\"}]}", "",
                              &library_error));
    WELL(tractrix_scene_set(one, -1, "opacity", "0.9", &library_error));
    WELL(tractrix_scene_set(one, -1, "look", "plain", &library_error));
    WELL(tractrix_scene_set(other, -1, "look", "plain", &library_error));
    WELL(tractrix_scene_set(other, -1, "opacity", "0.9", &library_error));
    tractrix_scene_get(one, 0, "opacity", a, sizeof a);
    assert_string_equal(a, "0.9");
    tractrix_scene_get(one, 0, "shading", a, sizeof a);
    assert_string_equal(a, "kajiya");
    tractrix_scene_get(one, -1, "scalp", a, sizeof a);
    assert_string_equal(a, "none");
    WELL(tractrix_scene_set(one, -1, "look", "studio", &library_error));
    tractrix_scene_get(one, 0, "shading", a, sizeof a);
    assert_string_equal(a, "marschner");
    tractrix_scene_get(one, -1, "scalp", a, sizeof a);
    // with a scene file, nothing is added that it does not name
    assert_string_equal(a, "none");
    WELL(tractrix_scene_set(one, -1, "look", "plain", &library_error));
    WELL(tractrix_scene_set(other, -1, "up", "y", &library_error));
    WELL(tractrix_scene_set(one, -1, "up", "y", &library_error));
    assert_in_range(tractrix_scene_json(one, a, sizeof a), 100, sizeof a - 1);
    tractrix_scene_json(other, b, sizeof b);
    assert_non_null(strstr(a, "\"look\": \"plain\""));
    assert_string_equal(a, b);
    tractrix_scene_destroy(one);
    tractrix_scene_destroy(other);
}

// --- A host that has set jansson's allocators.

enum { BEFORE = 32 }; // bytes before each block, so that no block is one of malloc's

static void *host_malloc(size_t size)
{
    char *block = malloc(size + BEFORE);
    return block ? block + BEFORE : NULL; // cppcheck-suppress memleak ; host_free finds its start
}

static void host_free(void *block)
{
    if (block) free((char *)block - BEFORE);
}

static void works_with_a_hosts_allocators(void **state)
{
    TractrixScene *scene;
    json_malloc_t allocates;
    json_free_t releases;
    char text[20000];
    (void)state;
    json_get_alloc_funcs(&allocates, &releases);
    json_set_alloc_funcs(host_malloc, host_free);
    WELL(tractrix_scene_read(&scene, "assets/demo.json", &library_error));
    assert_in_range(tractrix_scene_json(scene, text, sizeof text), 100, sizeof text - 1);
    tractrix_scene_destroy(scene);
    json_set_alloc_funcs(allocates, releases);
}

static void reads_what_is_there(void **state)
{
    TractrixScene *scene = (TractrixScene *)&library_error;
    (void)state;
    library_refused(tractrix_scene_read(&scene, "-", &library_error), TRACTRIX_USAGE, "-: ");
    assert_null(scene);
    library_refused(tractrix_scene_read(&scene, "assets/none.tfx", &library_error),
                    TRACTRIX_BAD_INPUT, "assets/none.tfx: ");
    library_refused(tractrix_scene_read(&scene, "assets", &library_error), TRACTRIX_BAD_INPUT,
                    "assets");
    library_refused(tractrix_scene_parse(&scene, NULL, NULL, &library_error), TRACTRIX_USAGE,
                    "json: got NULL");
    assert_null(scene);
    library_refused(tractrix_scene_parse(NULL, "{}", NULL, &library_error), TRACTRIX_USAGE,
                    "scene: got NULL");
    library_refused(tractrix_scene_parse(&scene, "{", NULL, &library_error), TRACTRIX_BAD_INPUT,
                    "scene:1:");
    library_refused(tractrix_scene_parse(&scene, "{\"sections\": [{\"file\": \"none.tfx\"}]}",
                                         "assets", &library_error),
                    TRACTRIX_BAD_INPUT, "assets/none.tfx: ");
    library_refused(
        tractrix_scene_parse(&scene, "{\"sections\": [{\"file\": \"-\"}]}", NULL, &library_error),
        TRACTRIX_USAGE, "-: ");
    library_refused(tractrix_scene_parse(&scene,
                                         "{\"sections\": [{\"file\": \"fur.tfx\"}], "
                                         "\"mesh\": \"none.obj\"}",
                                         "assets", &library_error),
                    TRACTRIX_BAD_INPUT, "assets/none.obj: ");
    library_refused(tractrix_scene_parse(&scene,
                                         "{\"sections\": [{\"file\": \"fur.tfx\", \"color\": "
                                         "\"red\", \"albedo\": \"black\"}]}",
                                         "assets", &library_error),
                    TRACTRIX_BAD_INPUT, "'color' and 'albedo' are two names of the same key");
    library_refused(tractrix_scene_create(&scene, "bright", &library_error), TRACTRIX_USAGE,
                    "bright");
    WELL(tractrix_scene_read(&scene, "assets/demo.json", &library_error));
    assert_int_equal(tractrix_scene_section_count(scene), 1);
    tractrix_scene_destroy(scene);
}

// --- Arrays.

enum { STRANDS = 3, VERTICES = 4 };

static TractrixStrands make_strands(float position[STRANDS * VERTICES][3])
{
    for (int s = 0; s < STRANDS; ++s)
        for (int v = 0; v < VERTICES; ++v) {
            float *p = position[s * VERTICES + v];
            p[0] = (float)s, p[1] = -(float)v, p[2] = 0.5f * (float)v;
        }
    return (TractrixStrands){.size = sizeof(TractrixStrands),
                             .metres_per_unit = 0.01,
                             .strand_count = STRANDS,
                             .vertices_each = VERTICES,
                             .position = position[0]};
}

static void refuses_wrong_arrays(void **state)
{
    TractrixScene *scene;
    float position[STRANDS * VERTICES][3], color[STRANDS * VERTICES][4] = {{0}};
    TractrixStrands strands = make_strands(position);
    const uint32_t short_sizes[STRANDS] = {4, 4, 1};
    (void)state;
    WELL(tractrix_scene_create(&scene, NULL, &library_error));
    position[7][1] = NAN;
    library_refused(tractrix_scene_add_strands(scene, "mine", &strands, &library_error),
                    TRACTRIX_BAD_INPUT, "mine: strand 1: a coordinate of vertex 3 is NaN");
    make_strands(position);
    memcpy(position[10], position[9], sizeof position[9]);
    library_refused(tractrix_scene_add_strands(scene, NULL, &strands, &library_error),
                    TRACTRIX_BAD_INPUT, "strands: strand 2: vertices 1 and 2 coincide");
    make_strands(position);
    strands.sizes = short_sizes;
    library_refused(tractrix_scene_add_strands(scene, "mine", &strands, &library_error),
                    TRACTRIX_BAD_INPUT, "strand 2 has 1 vertices");
    strands.sizes = NULL;
    color[5][2] = INFINITY;
    strands.color = color[0];
    library_refused(tractrix_scene_add_strands(scene, "mine", &strands, &library_error),
                    TRACTRIX_BAD_INPUT, "strand 1: an attribute is not finite");
    strands.color = NULL;
    strands.metres_per_unit = 0;
    library_refused(tractrix_scene_add_strands(scene, "mine", &strands, &library_error),
                    TRACTRIX_USAGE, "metres_per_unit");
    strands.metres_per_unit = 1;
    strands.vertices_each = 1;
    library_refused(tractrix_scene_add_strands(scene, "mine", &strands, &library_error),
                    TRACTRIX_USAGE, "vertices_each");
    strands.vertices_each = VERTICES;
    strands.size = sizeof strands + 8;
    library_refused(tractrix_scene_add_strands(scene, "mine", &strands, &library_error),
                    TRACTRIX_USAGE, "size");
    assert_int_equal(tractrix_scene_section_count(scene), 0);
    strands.size = sizeof strands;
    for (int i = 0; i < 5; ++i)
        WELL(tractrix_scene_add_strands(scene, "mine", &strands, &library_error));
    assert_int_equal(tractrix_scene_section_count(scene), 5);
    WELL(tractrix_scene_set(scene, 3, "drag", "0.5", &library_error));
    char text[32];
    tractrix_scene_get(scene, 3, "drag", text, sizeof text);
    assert_string_equal(text, "0.5");
    tractrix_scene_get(scene, 2, "drag", text, sizeof text);
    assert_string_not_equal(text, "0.5");
    tractrix_scene_destroy(scene);
}

static void refuses_wrong_meshes(void **state)
{
    TractrixScene *scene;
    float position[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    uint32_t triangle[2][3] = {{0, 1, 2}, {0, 2, 4}};
    TractrixMesh mesh = {.size = sizeof mesh,
                         .metres_per_unit = 1,
                         .vertex_count = 4,
                         .triangle_count = 2,
                         .position = position[0],
                         .triangle = triangle[0]};
    char text[32];
    (void)state;
    WELL(tractrix_scene_create(&scene, NULL, &library_error));
    library_refused(tractrix_scene_set_mesh(scene, &mesh, &library_error), TRACTRIX_BAD_INPUT,
                    "triangle 1 has vertex 4");
    triangle[1][2] = 3;
    position[3][0] = INFINITY;
    library_refused(tractrix_scene_set_mesh(scene, &mesh, &library_error), TRACTRIX_BAD_INPUT,
                    "vertex 3");
    position[3][0] = 0;
    WELL(tractrix_scene_set_mesh(scene, &mesh, &library_error));
    WELL(tractrix_scene_set_mesh(scene, &mesh, &library_error));
    WELL(tractrix_scene_set_mesh(scene, NULL, &library_error));
    assert_int_equal(tractrix_scene_get(scene, -1, "mesh", text, sizeof text), 0);
    tractrix_scene_destroy(scene);
}

// --- Images.

enum { WIDTH = 5, HEIGHT = 3, GAP = 4 };

static TractrixImage image_of(uint8_t pixels[HEIGHT][WIDTH * 4 + GAP])
{
    for (int y = 0; y < HEIGHT; ++y)
        for (int x = 0; x < 4 * WIDTH; ++x)
            pixels[y][x] = x % 4 == 3 ? 255 : (uint8_t)(20 * y + 7 * x);
    return (TractrixImage){.size = sizeof(TractrixImage),
                           .width = WIDTH,
                           .height = HEIGHT,
                           .row_bytes = WIDTH * 4 + GAP,
                           .pixels = pixels[0]};
}

static void compares_images(void **state)
{
    uint8_t a[HEIGHT][WIDTH * 4 + GAP], b[HEIGHT][WIDTH * 4 + GAP], m[HEIGHT][WIDTH * 4 + GAP];
    TractrixImage one = image_of(a), other = image_of(b), mask = image_of(m);
    TractrixFigures figures = {.size = sizeof figures};
    TractrixLimits limits = {.size = sizeof limits, .pixel_tolerance = 8};
    float map[HEIGHT][WIDTH];
    (void)state;
    WELL(tractrix_compare(&figures, NULL, &one, &other, NULL, NULL, &library_error));
    assert_true(figures.same && figures.largest == 0 && figures.compared == WIDTH * HEIGHT);
    assert_true(isinf(figures.psnr));
    b[1][4 * 2 + 1] ^= 8;
    memset(&b[2][4 * WIDTH], 77, GAP); // not part of any pixel
    WELL(tractrix_compare(&figures, map[0], &one, &other, NULL, NULL, &library_error));
    assert_false(figures.same);
    assert_true(figures.largest == 8 && figures.failing == 1);
    assert_true(figures.at[0] == 2 && figures.at[1] == 1 && map[1][2] > 0);
    WELL(tractrix_compare(&figures, NULL, &one, &other, NULL, &limits, &library_error));
    assert_true(figures.same);
    limits.max_flip = 1e-9;
    WELL(tractrix_compare(&figures, NULL, &one, &other, NULL, &limits, &library_error));
    assert_false(figures.same);
    for (int y = 0; y < HEIGHT; ++y) memset(m[y], 255, 4 * WIDTH);
    m[1][4 * 2] = m[1][4 * 2 + 1] = m[1][4 * 2 + 2] = 0;
    WELL(tractrix_compare(&figures, map[0], &one, &other, &mask, NULL, &library_error));
    assert_true(figures.same && figures.compared == WIDTH * HEIGHT - 1 && isnan(map[1][2]));
    limits = (TractrixLimits){.size = sizeof limits, .pixel_tolerance = -1};
    library_refused(tractrix_compare(&figures, NULL, &one, &other, NULL, &limits, &library_error),
                    TRACTRIX_USAGE, "limits");
    other.height = 2;
    library_refused(tractrix_compare(&figures, NULL, &one, &other, NULL, NULL, &library_error),
                    TRACTRIX_USAGE, "b: has 5x2 pixels");
    other.height = HEIGHT, other.row_bytes = 8;
    library_refused(tractrix_compare(&figures, NULL, &one, &other, NULL, NULL, &library_error),
                    TRACTRIX_USAGE, "b.row_bytes");
}

// Every format and suffix can be read back exactly, half floats within their precision.
static void writes_and_reads_images(void **state)
{
    uint8_t bytes[HEIGHT][WIDTH * 4 + GAP];
    TractrixImage image = image_of(bytes);
    TractrixPicture *picture;
    char path[] = "/tmp/tractrix_library_XXXXXX", name[64];
    float light[HEIGHT][WIDTH][4];
    uint16_t words[HEIGHT][WIDTH][4];
    (void)state;
    assert_non_null(mkdtemp(path));
    snprintf(name, sizeof name, "%s/x.png", path);
    bytes[1][7] = 10; // a pixel that is not opaque
    WELL(tractrix_image_write(&image, name, &library_error));
    WELL(tractrix_picture_read(&picture, name, &library_error));
    const TractrixImage *back = tractrix_picture_image(picture);
    assert_true(back->format == TRACTRIX_RGBA8 && back->width == WIDTH && back->height == HEIGHT);
    for (int y = 0; y < HEIGHT; ++y)
        assert_memory_equal((uint8_t *)back->pixels + (size_t)y * back->row_bytes, bytes[y],
                            4 * WIDTH);
    tractrix_picture_destroy(picture);
    unlink(name);
    for (int i = 0; i < HEIGHT * WIDTH * 4; ++i)
        words[i / (4 * WIDTH)][i / 4 % WIDTH][i % 4] = (uint16_t)(1 + 1091 * i);
    image.format = TRACTRIX_RGBA16, image.row_bytes = 0, image.pixels = words;
    WELL(tractrix_image_write(&image, name, &library_error));
    WELL(tractrix_picture_read(&picture, name, &library_error));
    assert_int_equal(tractrix_picture_image(picture)->format, TRACTRIX_RGBA16);
    assert_memory_equal(tractrix_picture_image(picture)->pixels, words, sizeof words);
    tractrix_picture_destroy(picture);
    unlink(name);
    image = image_of(bytes);
    bytes[1][7] = 10;
    snprintf(name, sizeof name, "%s/x.jpeg", path);
    library_refused(tractrix_image_write(&image, name, &library_error), TRACTRIX_USAGE, "alpha");
    bytes[1][7] = 255;
    WELL(tractrix_image_write(&image, name, &library_error));
    unlink(name);
    snprintf(name, sizeof name, "%s/x.jpg", path);
    WELL(tractrix_image_write(&image, name, &library_error));
    library_refused(tractrix_picture_read(&picture, name, &library_error), TRACTRIX_BAD_INPUT,
                    name); // the file has lost what a comparison would measure
    for (int i = 0; i < HEIGHT * WIDTH * 4; ++i)
        light[i / (4 * WIDTH)][i / 4 % WIDTH][i % 4] = i % 4 == 3 ? 1 : 1.1f * (float)i;
    image = (TractrixImage){.size = sizeof image,
                            .width = WIDTH,
                            .height = HEIGHT,
                            .format = TRACTRIX_RGBA32F,
                            .pixels = light};
    library_refused(tractrix_image_write(&image, name, &library_error), TRACTRIX_USAGE, "floats");
    static const char *const SUFFIXES[] = {"exr", "pfm"};
    for (int i = 0; i < 2; ++i) {
        unlink(name);
        snprintf(name, sizeof name, "%s/x.%s", path, SUFFIXES[i]);
        WELL(tractrix_image_write(&image, name, &library_error));
        WELL(tractrix_picture_read(&picture, name, &library_error));
        assert_memory_equal(tractrix_picture_image(picture)->pixels, light, sizeof light);
        tractrix_picture_destroy(picture);
    }
    unlink(name);
    library_refused(tractrix_picture_read(&picture, name, &library_error), TRACTRIX_BAD_INPUT,
                    name);
    assert_null(picture);
    TractrixWriteOptions half = {.size = sizeof half, .half = true};
    library_refused(tractrix_image_write_with(&image, name, &half, &library_error), TRACTRIX_USAGE,
                    "expected .exr");
    snprintf(name, sizeof name, "%s/x.exr", path);
    WELL(tractrix_image_write_with(&image, name, &half, &library_error));
    WELL(tractrix_picture_read(&picture, name, &library_error));
    const float *halves = tractrix_picture_image(picture)->pixels;
    assert_true(halves[1] != light[0][0][1] && fabsf(halves[1] / light[0][0][1] - 1) <= 0x1p-11f);
    tractrix_picture_destroy(picture);
    unlink(name);
    light[1][2][0] = NAN;
    library_refused(tractrix_image_write(&image, name, &library_error), TRACTRIX_BAD_INPUT,
                    "image: pixel 2, 1: got nan in channel 0");
    TractrixFigures figures = {.size = sizeof figures};
    library_refused(tractrix_compare(&figures, NULL, &image, &image, NULL, NULL, &library_error),
                    TRACTRIX_BAD_INPUT, "a: pixel 2, 1");
    light[1][2][0] = 0;
    library_refused(tractrix_image_write(&image, "x.tga", &library_error), TRACTRIX_USAGE, ".pfm");
    assert_int_equal(rmdir(path), 0); // no other files are left in it
}

static void takes_null_and_impossible_sizes(void **state)
{
    TractrixScene *scene;
    uint8_t pixels[16 * 4] = {0};
    char text[8];
    (void)state;
    assert_int_equal(tractrix_scene_get(NULL, -1, "wind", text, sizeof text), 0);
    assert_int_equal(tractrix_scene_json(NULL, text, sizeof text), 0);
    assert_int_equal(tractrix_scene_section_count(NULL), 0);
    assert_int_equal(tractrix_scene_body_count(NULL), 0);
    assert_string_equal(tractrix_device_text(NULL, "vendor"), "");
    assert_string_equal(tractrix_simulation_messages(NULL), "");
    assert_true(tractrix_simulation_time(NULL) == 0);
    assert_null(tractrix_picture_image(NULL));
    // Rows whose distance goes beyond the address space.
    const size_t rows[] = {(size_t)-4, (size_t)1 << 63, (size_t)PTRDIFF_MAX / 4 + 1};
    for (int i = 0; i < 3; ++i) {
        const TractrixImage image = {
            .size = sizeof image, .width = 4, .height = 4, .row_bytes = rows[i], .pixels = pixels};
        library_refused(tractrix_image_write(&image, "x.png", &library_error), TRACTRIX_USAGE,
                        "image.row_bytes: ");
    }
    // Counts are multiplied in 64 bits, and the first wrong size ends the search.
    const float position[9] = {0};
    const uint32_t sizes[2] = {0, 2};
    TractrixStrands strands = {.size = sizeof strands,
                               .metres_per_unit = 1,
                               .strand_count = UINT32_MAX,
                               .vertices_each = 2,
                               .position = position};
    WELL(tractrix_scene_create(&scene, NULL, &library_error));
    library_refused(tractrix_scene_add_strands(scene, "x", &strands, &library_error),
                    TRACTRIX_USAGE, "strands: got 8589934590 vertices or more, ");
    strands.sizes = sizes;
    library_refused(tractrix_scene_add_strands(scene, "x", &strands, &library_error),
                    TRACTRIX_BAD_INPUT, "strands: strand 0 has 0 vertices: expected 2 to 65535");
    tractrix_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reads_and_writes_parameters),
        cmocka_unit_test(lists_parameters),
        cmocka_unit_test(gives_way_to_looks),
        cmocka_unit_test(works_with_a_hosts_allocators),
        cmocka_unit_test(reads_what_is_there),
        cmocka_unit_test(refuses_wrong_arrays),
        cmocka_unit_test(refuses_wrong_meshes),
        cmocka_unit_test(compares_images),
        cmocka_unit_test(writes_and_reads_images),
        cmocka_unit_test(takes_null_and_impossible_sizes),
    };
    return cmocka_run_group_tests_name("library_scene", tests, NULL, NULL);
}
