// SPDX-License-Identifier: MIT
#include "image_reference.h"
#include "random.h"
#include "studio.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { SIDE = 128, MOST_ITEMS = 2 };

// A scene of the studio (world and picture agree in the plane z = 0) for the reference.
typedef struct Sitting {
    View view;
    Strands strands[MOST_ITEMS];
    SectionParams material[MOST_ITEMS];
    ReferenceItem items[MOST_ITEMS];
    ReferenceScene scene;
    Image image;
} Sitting;

static void sitting_open(Sitting *sitting, const float background[4])
{
    Error error = {{0}};
    memset(sitting, 0, sizeof *sitting);
    studio_view(&sitting->view, SIDE, SIDE);
    sitting->scene = (ReferenceScene){.view = &sitting->view, .items = sitting->items};
    memcpy(sitting->scene.background, background, 4 * sizeof *background);
    int channels = background[3] < 1 ? 4 : 3;
    assert_int_equal(image_create(&sitting->image, SIDE, SIDE, channels, &error), RESULT_OK);
}

static void sitting_close(Sitting *sitting)
{
    for (uint32_t i = 0; i < sitting->scene.item_count; ++i) {
        strands_destroy(&sitting->strands[i]);
        section_params_destroy(&sitting->material[i]);
    }
    image_destroy(&sitting->image);
}

// Takes the strands over.
static SectionParams *sitting_add(Sitting *sitting, Strands strands, float radius, float opacity)
{
    Error error = {{0}};
    uint32_t i = sitting->scene.item_count++;
    assert_true(i < MOST_ITEMS);
    SectionParams *material = &sitting->material[i];
    assert_int_equal(section_params_create(material, &error), RESULT_OK);
    studio_make_plain(material, opacity);
    sitting->strands[i] = strands;
    sitting->items[i] =
        (ReferenceItem){.strands = &sitting->strands[i], .material = material, .radius = radius};
    for (uint32_t k = 0; k < i; ++k) sitting->items[i].first_id += sitting->strands[k].strand_count;
    return material;
}

static void draw(Sitting *sitting)
{
    Error error = {{0}};
    assert_int_equal(image_reference_draw(&sitting->image, &sitting->scene, REFERENCE_SIDE, &error),
                     RESULT_OK);
}

static const uint8_t *pixel(const Sitting *sitting, int x, int y)
{
    return &sitting->image.pixels[(y * SIDE + x) * sitting->image.channels];
}

static const float TRANSPARENT[4] = {0}, BLACK[4] = {0, 0, 0, 1};

static Strands make_line(const float from[3], const float to[3])
{
    float position[2][3];
    memcpy(position[0], from, sizeof position[0]);
    memcpy(position[1], to, sizeof position[1]);
    return studio_strands(1, 2, (const float(*)[3])position);
}

// Strands along the picture's middle row, one behind the other, 1 apart.
static Strands make_stack(uint32_t count)
{
    float position[32][2][3];
    assert_true(count <= 32);
    for (uint32_t i = 0; i < count; ++i)
        for (int j = 0; j < 2; ++j)
            memcpy(position[i][j], (float[3]){j ? 50 : -50, 0, (float)i}, sizeof(float[3]));
    return studio_strands(count, 2, (const float(*)[3])position);
}

static double alpha_sum(const Sitting *sitting)
{
    double sum = 0;
    for (int y = 0; y < SIDE; ++y)
        for (int x = 0; x < SIDE; ++x) sum += pixel(sitting, x, y)[3] / 255.0;
    return sum;
}

// Rounding to 8 bits as in test_renderer.c; the grid of sub-samples errs by less.
static void area_of_a_strand_is_width_times_length(void **state)
{
    (void)state;
    const double widths[] = {0.05, 0.2, 0.5, 1, 2.3, 5}, length = 100;
    for (size_t w = 0; w < sizeof widths / sizeof *widths; ++w) {
        double mean = 0, bound = (widths[w] + 1.5) * (length + 1) / 510 + 0.1 * widths[w];
        int angles = 0;
        for (double deg = 3; deg < 180; deg += 15, ++angles) {
            double angle = deg * acos(-1) / 180, shift = 0.1 * angles;
            float x = (float)(length / 2 * cos(angle)), y = (float)(length / 2 * sin(angle));
            Sitting sitting;
            sitting_open(&sitting, TRANSPARENT);
            sitting_add(
                &sitting,
                make_line((float[3]){(float)shift - x, -y, 0}, (float[3]){(float)shift + x, y, 0}),
                (float)widths[w] / 2, 1);
            draw(&sitting);
            double off = alpha_sum(&sitting) - widths[w] * length;
            if (fabs(off) > bound)
                fail_msg("width %g px at %g degrees: area off by %g, bound %g", widths[w], deg, off,
                         bound);
            mean += off;
            sitting_close(&sitting);
        }
        if (fabs(mean / angles) > 0.3 * bound)
            fail_msg("width %g px: area off by %g on average", widths[w], mean / angles);
    }
}

static void layers_multiply(void **state)
{
    (void)state;
    for (uint32_t n = 1; n <= 32; n += 3) {
        Sitting sitting;
        sitting_open(&sitting, TRANSPARENT);
        sitting_add(&sitting, make_stack(n), 6, 0.2f);
        draw(&sitting);
        assert_true(fabs(pixel(&sitting, SIDE / 2, SIDE / 2)[3] - 255 * (1 - pow(0.8, n))) <= 0.51);
        sitting_close(&sitting);
    }
}

// n strands of a tenth of a pixel, each behind the other, cover that tenth: what hides it hides
// all.
static void strands_behind_each_other_cover_no_more(void **state)
{
    (void)state;
    for (uint32_t n = 1; n <= 7; n += 3) {
        Sitting sitting;
        sitting_open(&sitting, TRANSPARENT);
        Strands strands = make_stack(n);
        for (uint32_t v = 0; v < strands.vertex_count; ++v) { // at half a pixel below the edge
            float scale = (1000 - strands.position[v][2]) / 1000;
            strands.position[v][0] *= scale;
            strands.position[v][1] = 0.5f * scale;
        }
        sitting_add(&sitting, strands, 0.125f, 0.5f);
        draw(&sitting);
        double expected = 255 * 0.25 * (1 - pow(0.5, n));
        assert_true(fabs(pixel(&sitting, SIDE / 2, SIDE / 2 - 1)[3] - expected) <= 0.51);
        sitting_close(&sitting);
    }
}

static void joints_have_neither_gap_nor_overlap(void **state)
{
    (void)state;
    enum { VERTICES = 12 };
    float position[VERTICES][3] = {{-50, 0, 0}}, angle = 0;
    for (int j = 1; j < VERTICES; ++j) {
        angle += 0.25f * (float)(j % 5) * (j % 2 ? 1 : -1);
        position[j][0] = position[j - 1][0] + 9 * cosf(angle);
        position[j][1] = position[j - 1][1] + 9 * sinf(angle);
    }
    Sitting sitting;
    sitting_open(&sitting, TRANSPARENT);
    sitting_add(&sitting, studio_strands(1, VERTICES, (const float(*)[3])position), 2, 0.5f);
    draw(&sitting);
    for (int y = 0; y < SIDE; ++y)
        for (int x = 0; x < SIDE; ++x) assert_true(pixel(&sitting, x, y)[3] <= 128);
    for (int j = 1; j < VERTICES - 1; ++j)
        assert_int_equal(
            pixel(&sitting, (int)(position[j][0] + SIDE / 2), (int)(SIDE / 2 - position[j][1]))[3],
            128);
    sitting_close(&sitting);
}

static void the_nearer_strand_is_in_front(void **state)
{
    (void)state;
    for (int near = 0; near < 2; ++near) {
        Sitting sitting;
        sitting_open(&sitting, BLACK);
        for (int i = 0; i < 2; ++i) {
            float z = i == near ? 1 : -1;
            SectionParams *material = sitting_add(
                &sitting, make_line((float[3]){-50, 0, z}, (float[3]){50, 0, z}), 6, 0.6f);
            for (int k = 0; k < 3; ++k) material->color[k] = k == i;
        }
        draw(&sitting);
        const uint8_t *middle = pixel(&sitting, SIDE / 2, SIDE / 2);
        assert_int_equal(middle[near], lrint(255 * image_srgb_from_linear(0.6)));
        assert_int_equal(middle[!near], lrint(255 * image_srgb_from_linear(0.24)));
        assert_int_equal(middle[2], 0);
        sitting_close(&sitting);
    }
}

static void a_mesh_hides_what_is_behind_it(void **state)
{
    (void)state;
    float corners[4][3] = {{-20, -40, 0}, {20, -40, 0}, {-20, 40, 0}, {20, 40, 0}};
    uint32_t triangles[2][3] = {{0, 1, 2}, {2, 1, 3}};
    const Mesh mesh = {
        .vertex_count = 4, .triangle_count = 2, .position = corners, .triangle = triangles};
    Sitting sitting;
    sitting_open(&sitting, BLACK);
    sitting_add(&sitting, make_line((float[3]){-50, 20, 10}, (float[3]){50, 20, 10}), 3, 1);
    sitting_add(&sitting, make_line((float[3]){-50, -20, -10}, (float[3]){50, -20, -10}), 3, 1);
    sitting.scene.mesh = &mesh;
    sitting.scene.mesh_color[1] = 1;
    draw(&sitting);
    const int seen = SIDE / 2 - 20, hidden = SIDE / 2 + 20;
    assert_int_equal(pixel(&sitting, SIDE / 2, seen)[0], 255);
    assert_int_equal(pixel(&sitting, SIDE / 2, hidden)[0], 0);
    assert_int_equal(pixel(&sitting, SIDE / 2, hidden)[1], 255);
    assert_int_equal(pixel(&sitting, SIDE / 2 + 40, hidden)[0], 255);
    sitting_close(&sitting);
}

static void threads_do_not_change_it(void **state)
{
    (void)state;
    uint8_t first[SIDE * SIDE * 4];
    for (int threads = 1; threads <= 3; ++threads) {
        Sitting sitting;
        sitting_open(&sitting, TRANSPARENT);
        sitting_add(&sitting, make_stack(20), 6, 0.2f);
        sitting_add(&sitting, make_line((float[3]){-50, -60, 4}, (float[3]){50, 60, 4}), 3, 0.5f);
        sitting.scene.threads = threads;
        draw(&sitting);
        if (threads == 1) memcpy(first, sitting.image.pixels, sizeof first);
        assert_memory_equal(sitting.image.pixels, first, sizeof first);
        sitting_close(&sitting);
    }
}

// --- The renderer against it.

typedef struct Case {
    const char *name;
    uint32_t count;
    float radius, opacity, tip_ratio;
    double bound[2][2]; // RMS of the difference in levels of 255 over the pixels that hair touches:
                        // quads, blocks; each of one sample a pixel and of 2 x 2
} Case;

static Strands make_tangle(uint32_t count)
{
    enum { VERTICES = 16 };
    float(*position)[3] = malloc(count * VERTICES * sizeof *position);
    assert_non_null(position);
    Random random = random_create(11, 0);
    for (uint32_t s = 0; s < count; ++s) {
        double x[3], d[3], turn[3];
        for (int k = 0; k < 3; ++k) x[k] = (random_real(&random) - 0.5) * SIDE;
        random_direction(&random, d);
        random_direction(&random, turn);
        for (uint32_t j = 0; j < VERTICES; ++j)
            for (int k = 0; k < 3; ++k) {
                position[s * VERTICES + j][k] = (float)x[k];
                x[k] += 3 * d[k];
                d[k] += 0.1 * turn[k];
            }
    }
    Strands strands = studio_strands(count, VERTICES, (const float(*)[3])position);
    free(position);
    return strands;
}

static void dress(SectionParams *material, float tip_ratio)
{
    const SectionParams worn = *material;
    *material = (SectionParams){0};
    Error error = {{0}};
    assert_int_equal(section_params_create(material, &error), RESULT_OK);
    material->opacity = worn.opacity;
    material->tip_ratio = tip_ratio;
    SectionParams old = worn;
    section_params_destroy(&old);
}

static double rms_difference(const Image *a, const Image *b, const uint8_t background[3])
{
    double sum = 0;
    size_t covered = 0;
    for (int i = 0; i < SIDE * SIDE; ++i) {
        const uint8_t *p = &a->pixels[3 * i], *q = &b->pixels[3 * i];
        if (memcmp(p, background, 3) == 0 && memcmp(q, background, 3) == 0) continue;
        ++covered;
        for (int k = 0; k < 3; ++k) sum += (p[k] - q[k]) * (p[k] - q[k]) / 3.0;
    }
    assert_true(covered > SIDE);
    return sqrt(sum / (double)covered);
}

static void compare_case(Studio *studio, const Case *c, double bound)
{
    Sitting sitting;
    const float dark[4] = {0.125f, 0.14f, 0.17f, 1};
    const Light light = {.direction = {0.6f, 0.8f, 0}, .color = {1, 0.9f, 0.8f}, .intensity = 2};
    sitting_open(&sitting, dark);
    SectionParams *material = sitting_add(&sitting, make_tangle(c->count), c->radius, c->opacity);
    dress(material, c->tip_ratio);
    sitting.scene.lights = &light;
    sitting.scene.light_count = 1;
    draw(&sitting);
    uint32_t item = studio_add(studio, &sitting.strands[0], c->radius, c->opacity);
    dress(&studio->material[item], c->tip_ratio);
    studio->light = light;
    studio_draw(studio);
    const uint8_t background[3] = {32, 36, 43};
    double rms = rms_difference(&sitting.image, &studio->image, background);
    print_message("%s: RMS %.2f of 255, bound %.2f\n", c->name, rms, bound);
    studio_clear(studio);
    sitting_close(&sitting);
    if (rms > bound) fail_msg("%s: RMS %.2f of 255, bound %.2f", c->name, rms, bound);
}

// What is left is that a pixel's ribbons are taken to be spread evenly and independently over it,
// where the reference knows which sub-samples they share; and the sorted layers' number.
static void the_renderer_is_near_the_reference(void **state)
{
    (void)state;
    static const Case cases[] = {
        {"fine hair, 0.6 px", 1000, 0.3f, 0.6f, 0.3f, {{2.1, 1.1}, {2.1, 1.15}}},
        {"sparse hair, 1 px", 150, 0.5f, 0.6f, 1, {{1.2, 0.56}, {1.2, 0.55}}},
        {"thick hair, 5 px", 100, 2.5f, 0.5f, 0.3f, {{0.85, 0.48}, {1.25, 0.77}}},
    };
    RendererOptions options = {
        .width = SIDE, .height = SIDE, .background = {0.125f, 0.14f, 0.17f, 1}};
    for (int kind = 0; kind < 4; ++kind) {
        Studio studio;
        options.raster = kind < 2 ? RASTER_QUADS : RASTER_BLOCKS;
        options.samples = 1 + kind % 2;
        studio_open(&studio, &options);
        print_message("%s, samples %d:\n", kind < 2 ? "quads" : "blocks", options.samples);
        for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i)
            compare_case(&studio, &cases[i], cases[i].bound[kind / 2][kind % 2]);
        studio_close(&studio);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(area_of_a_strand_is_width_times_length),
        cmocka_unit_test(layers_multiply),
        cmocka_unit_test(strands_behind_each_other_cover_no_more),
        cmocka_unit_test(joints_have_neither_gap_nor_overlap),
        cmocka_unit_test(the_nearer_strand_is_in_front),
        cmocka_unit_test(a_mesh_hides_what_is_behind_it),
        cmocka_unit_test(threads_do_not_change_it),
        cmocka_unit_test(the_renderer_is_near_the_reference),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
