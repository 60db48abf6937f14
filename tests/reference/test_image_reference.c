// SPDX-License-Identifier: MIT
// The exact image against areas and opacities computed by hand, and the errors of the rasterisers
// against the exact image.
#include "formats/strands_read.h"
#include "reference/image_reference.h"
#include "support/plain.h"
#include "support/studio.h"

#include "glsl/common/hash.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

enum { SIDE = 128, MOST_ITEMS = 2 };

// A scene for the reference that equals the studio's: world and image coordinates agree in the
// plane z = 0.
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
        params_destroy_section(&sitting->material[i]);
    }
    image_destroy(&sitting->image);
}

// Takes ownership of the strands.
static SectionParams *sitting_add(Sitting *sitting, Strands strands, float radius, float opacity)
{
    uint32_t i = sitting->scene.item_count++;
    assert_true(i < MOST_ITEMS);
    SectionParams *material = &sitting->material[i];
    plain_section(material);
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

// Strands along the image's middle row, one behind the other at distances of 1.
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

// Tolerance: rounding to 8 bits as in test_renderer.c; the grid of sub-samples errs by less.
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

// A painted thickness is a factor of the radius at each vertex and stands for the tips' taper, too.
static void thickness_scales_the_width(void **state)
{
    (void)state;
    const double length = 100, width = 5;
    float thickness[][2] = {{1, 1}, {0.5f, 0.5f}, {1, 0.2f}, {0.2f, 1}};
    for (size_t i = 0; i < sizeof thickness / sizeof *thickness; ++i) {
        Sitting sitting;
        Paint paint = {.thickness = thickness[i], .vertex_count = 2};
        sitting_open(&sitting, TRANSPARENT);
        sitting_add(&sitting, make_line((float[3]){-50, 0.3f, 0}, (float[3]){50, 0.3f, 0}),
                    (float)width / 2, 1)
            ->tip_ratio = 0.3f;
        sitting.items[0].paint = &paint;
        draw(&sitting);
        double mean = ((double)thickness[i][0] + (double)thickness[i][1]) / 2;
        double left = 0, right = 0, off = alpha_sum(&sitting) - mean * width * length;
        if (fabs(off) > (width + 1.5) * (length + 1) / 510 + 0.1 * width)
            fail_msg("thickness %g to %g: area off by %g", (double)thickness[i][0],
                     (double)thickness[i][1], off);
        for (int y = 0; y < SIDE; ++y) {
            left += pixel(&sitting, SIDE / 2 - 40, y)[3] / 255.0;
            right += pixel(&sitting, SIDE / 2 + 40, y)[3] / 255.0;
        }
        // 80 px apart on a strand of 100 px.
        double change = 0.8 * width * ((double)thickness[i][1] - (double)thickness[i][0]);
        assert_true(fabs(right - left - change) < 0.1);
        sitting_close(&sitting);
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

// n strands of a tenth of a pixel, one exactly behind the other, cover that tenth only: the first
// hides the others.
static void strands_behind_each_other_cover_no_more(void **state)
{
    (void)state;
    for (uint32_t n = 1; n <= 7; n += 3) {
        Sitting sitting;
        sitting_open(&sitting, TRANSPARENT);
        Strands strands = make_stack(n);
        for (uint32_t v = 0; v < strands.vertex_count; ++v) { // half a pixel below the edge
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

// Each strand has the brightness and the warmth that the renderer gives to its number and seed.
static void strands_differ_as_the_renderers_do(void **state)
{
    (void)state;
    enum { COUNT = 6, SEED = 12345 };
    const double brighter = 0.3, warmer = 0.4, grey = image_linear_from_srgb(0.5);
    float position[COUNT][2][3];
    Sitting sitting;
    sitting_open(&sitting, BLACK);
    for (int i = 0; i < COUNT; ++i)
        for (int j = 0; j < 2; ++j)
            memcpy(position[i][j], (float[3]){j ? 50 : -50, (float)(16 * i - 40), 0},
                   sizeof(float[3]));
    SectionParams *material =
        sitting_add(&sitting, studio_strands(COUNT, 2, (const float(*)[3])position), 6, 1);
    for (int k = 0; k < 3; ++k) material->color[k] = 0.5f;
    material->color_variation = (float)brighter, material->warmth_variation = (float)warmer;
    sitting.scene.seed = SEED;
    draw(&sitting);
    for (uint32_t i = 0; i < COUNT; ++i) {
        const uint32_t id = i ^ SEED;
        const double brightness = 1 + brighter * (double)hash_signed(id),
                     warmth = warmer * (double)hash_signed(id + 0x9e3779b9u),
                     shares[] = {1 + warmth, 1, 1 - warmth};
        const uint8_t *found = pixel(&sitting, SIDE / 2, SIDE / 2 - (16 * (int)i - 40));
        for (int k = 0; k < 3; ++k) {
            double expected = 255 * image_srgb_from_linear(fmin(grey * brightness * shares[k], 1));
            if (!(fabs(found[k] - expected) < 0.51))
                fail_msg("strand %u: %d is %d: expected %g", i, k, found[k], expected);
        }
    }
    sitting_close(&sitting);
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

// --- The renderer against the exact image.

enum { MOST_CASES = 4 };

typedef struct Case {
    const char *name;
    const char *file;  // a file whose hair fills the image; NULL: a tangle
    uint32_t count;    // number of strands
    double step, turn; // px between vertices, and the change of direction at each
    float radius, opacity, tip_ratio;
    double bound[2][2][3]; // RMS of the difference in levels of 255, over the pixels with hair: of
                           // colour and of opacity; by quads and by blocks; with 1, 2 x 2 and 4 x 4
                           // samples per pixel
} Case;

// The hair of a file seen from the front, in the middle of the image.
static Strands read_hair(const char *file)
{
    Error error = {{0}};
    Strands strands;
    StrandsReport report;
    float low[3], high[3];
    assert_int_equal(strands_read(&strands, file, NULL, &report, &error), RESULT_OK);
    strands_bounds(&strands, low, high);
    float scale = 0.9f * SIDE / fmaxf(high[0] - low[0], high[1] - low[1]);
    for (uint32_t v = 0; v < strands.vertex_count; ++v)
        for (int k = 0; k < 3; ++k)
            strands.position[v][k] = scale * (strands.position[v][k] - 0.5f * (low[k] + high[k]));
    return strands;
}

static void dress(SectionParams *material, float tip_ratio)
{
    const SectionParams worn = *material;
    *material = (SectionParams){0};
    plain_section(material);
    material->opacity = worn.opacity;
    material->tip_ratio = tip_ratio;
    SectionParams old = worn;
    params_destroy_section(&old);
}

// RMS over the pixels that differ from `background` in either image: of colours, or of opacity if
// there is an alpha channel.
static double rms_difference(const Image *a, const Image *b, const uint8_t background[4])
{
    double sum = 0;
    size_t covered = 0, channels = (size_t)a->channels, first = channels == 4 ? 3 : 0;
    for (size_t i = 0; i < (size_t)SIDE * SIDE; ++i) {
        const uint8_t *p = &a->pixels[channels * i], *q = &b->pixels[channels * i];
        if (!memcmp(p + first, background + first, channels - first) &&
            !memcmp(q + first, background + first, channels - first))
            continue;
        ++covered;
        for (size_t k = first; k < channels; ++k)
            sum += (p[k] - q[k]) * (p[k] - q[k]) / (double)(channels - first);
    }
    assert_true(covered > SIDE);
    return sqrt(sum / (double)covered);
}

static const float DARK[4] = {0.125f, 0.14f, 0.17f, 1};
static const uint8_t DARK_BYTES[4] = {32, 36, 43};
static const Light LIGHT = {.direction = {0.6f, 0.8f, 0}, .color = {1, 0.9f, 0.8f}, .intensity = 2};

// Draws the exact image of a case in front of a dark background and, for opacity, without
// background.
static void sitting_draw_case(Sitting exact[2], const Case *c)
{
    for (int clear = 0; clear < 2; ++clear) {
        sitting_open(&exact[clear], clear ? TRANSPARENT : DARK);
        Strands strands = c->file ? read_hair(c->file)
                                  : studio_tangle(11, SIDE, c->count, 16, c->step, c->turn, NULL);
        dress(sitting_add(&exact[clear], strands, c->radius, c->opacity), c->tip_ratio);
        exact[clear].scene.lights = &LIGHT;
        exact[clear].scene.light_count = 1;
        draw(&exact[clear]);
    }
}

// Sums of many layers in half floats that round towards zero (studio_rounding): levels of 255.
// Opacity of `thick hair` has this further error on an NVIDIA H100, with any number of samples.
static const double ROUNDED_DOWN = 0.5;

// Whether the renderer's image is as near to the exact image as the bound says.
static bool compare_case(Studio *studio, const Case *c, const Sitting *exact, const char *what,
                         double bound)
{
    const uint8_t nothing[4] = {0};
    bool clear = exact->image.channels == 4;
    if (clear && studio->renderer.options.raster == RASTER_QUADS && studio_rounding(studio) > 1)
        bound = hypot(bound, ROUNDED_DOWN);
    uint32_t item = studio_add(studio, &exact->strands[0], c->radius, c->opacity);
    dress(&studio->material[item], c->tip_ratio);
    studio->light = LIGHT;
    studio_draw(studio);
    double rms = rms_difference(&exact->image, &studio->image, clear ? nothing : DARK_BYTES);
    print_message("%s, %s, %s: RMS %.2f of 255, bound %.2f\n", what, c->name,
                  clear ? "opacity" : "colour", rms, bound);
    studio_clear(studio);
    return rms <= bound;
}

// Both rasterisers, with 1, 2 x 2 and 4 x 4 samples per pixel, colour and opacity.
static void compare_cases(const Case *cases, size_t count)
{
    static const char *const names[] = {"quads",  "quads, 2 x 2",  "quads, 4 x 4",
                                        "blocks", "blocks, 2 x 2", "blocks, 4 x 4"};
    Sitting exact[MOST_CASES][2];
    int too_far = 0;
    assert_true(count <= MOST_CASES);
    for (size_t i = 0; i < count; ++i) sitting_draw_case(exact[i], &cases[i]);
    for (int kind = 0; kind < 6; ++kind)
        for (int clear = 0; clear < 2; ++clear) {
            Studio studio;
            RendererOptions options = {.width = SIDE,
                                       .height = SIDE,
                                       .raster = kind < 3 ? RASTER_QUADS : RASTER_BLOCKS,
                                       .ribbon_length = 2,
                                       .samples = 1 << kind % 3};
            memcpy(options.background, clear ? TRANSPARENT : DARK, sizeof DARK);
            studio_open(&studio, &options);
            for (size_t i = 0; i < count; ++i)
                too_far += !compare_case(&studio, &cases[i], &exact[i][clear], names[kind],
                                         cases[i].bound[clear][kind / 3][kind % 3]);
            studio_close(&studio);
        }
    for (size_t i = 0; i < count; ++i)
        for (int clear = 0; clear < 2; ++clear) sitting_close(&exact[i][clear]);
    assert_int_equal(too_far, 0);
}

// The remaining errors: rasterisers assume that a pixel's ribbons are spread evenly and
// independently over it, while the reference knows which sub-samples they share; and, for colour,
// the number of sorted layers is limited.
static void the_renderer_is_near_the_reference(void **state)
{
    (void)state;
    static const Case cases[] = {
        {.name = "fine hair, 0.6 px",
         .count = 1000,
         .step = 3,
         .turn = 0.1,
         .radius = 0.3f,
         .opacity = 0.6f,
         .tip_ratio = 0.3f,
         .bound = {{{2.1, 1.1, 0.61}, {2.1, 1.15, 0.64}}, {{7.9, 3.9, 1.75}, {7.9, 3.9, 1.7}}}},
        {.name = "sparse hair, 1 px",
         .count = 150,
         .step = 3,
         .turn = 0.1,
         .radius = 0.5f,
         .opacity = 0.6f,
         .tip_ratio = 1,
         .bound = {{{1.2, 0.56, 0.43}, {1.2, 0.55, 0.43}}, {{4.4, 1.85, 1.2}, {4.4, 1.6, 0.94}}}},
        {.name = "thick hair, 5 px",
         .count = 100,
         .step = 3,
         .turn = 0.1,
         .radius = 2.5f,
         .opacity = 0.5f,
         .tip_ratio = 0.3f,
         .bound = {{{0.85, 0.48, 0.37}, {0.8, 0.46, 0.38}}, {{2.7, 1.65, 1}, {2.2, 0.92, 0.63}}}},
        {.name = "hair on end, 0.6 px",
         .count = 3000,
         .step = 0.2,
         .turn = 0.2,
         .radius = 0.3f,
         .opacity = 0.6f,
         .tip_ratio = 0.3f,
         .bound = {{{4.3, 2.4, 1.22}, {3.1, 1.3, 0.66}}, {{12.2, 6.7, 3.5}, {6.7, 2.8, 1.6}}}},
    };
    compare_cases(cases, sizeof cases / sizeof *cases);
}

// From so far away that strands are 0.4 and 0.8 px wide, and many are shorter than a few pixels.
static void real_hair_is_near_the_reference(void **state)
{
    (void)state;
    static const Case cases[] = {
        {.name = "Mohawk",
         .file = "../shared/assets/ratboy_mohawk.tfx",
         .radius = 0.2f,
         .opacity = 0.6f,
         .tip_ratio = 0.3f,
         .bound = {{{4.9, 2.8, 1.5}, {3.9, 2.0, 1.05}}, {{20.3, 12.0, 6.6}, {13.9, 7.4, 3.9}}}},
        {.name = "Sintel",
         .file = "../shared/assets/sintel_228x32.tfx",
         .radius = 0.4f,
         .opacity = 0.6f,
         .tip_ratio = 0.3f,
         .bound = {{{1.75, 0.92, 0.52}, {1.76, 0.94, 0.52}},
                   {{9.5, 4.75, 1.95}, {9.7, 4.9, 1.95}}}},
    };
    size_t count = sizeof cases / sizeof *cases;
    for (size_t i = 0; i < count; ++i)
        if (access(cases[i].file, R_OK) != 0) {
            print_message("%s is not here: skipped\n", cases[i].file);
            skip();
        }
    compare_cases(cases, count);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(area_of_a_strand_is_width_times_length),
        cmocka_unit_test(thickness_scales_the_width),
        cmocka_unit_test(layers_multiply),
        cmocka_unit_test(strands_behind_each_other_cover_no_more),
        cmocka_unit_test(joints_have_neither_gap_nor_overlap),
        cmocka_unit_test(the_nearer_strand_is_in_front),
        cmocka_unit_test(strands_differ_as_the_renderers_do),
        cmocka_unit_test(a_mesh_hides_what_is_behind_it),
        cmocka_unit_test(threads_do_not_change_it),
        cmocka_unit_test(the_renderer_is_near_the_reference),
        cmocka_unit_test(real_hair_is_near_the_reference),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
