// SPDX-License-Identifier: MIT
// Coverage of strands: area, layers, level of detail.
#include "base/random.h"
#include "support/stage.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// Rounding to 8 bits errs by up to 1/510 in each of the (width + 1.5) (length + 1) pixels that a
// strand touches, with equal errors if it runs along the rows. Its ends are blurred over one pixel,
// which is exact along rows and columns and errs by less than half a square pixel in other
// directions. At most angles both errors average out.
static void coverage_of_a_strand_is_its_area(void **state)
{
    (void)state;
    const float widths[] = {0.05f, 0.2f, 0.5f, 1, 2.3f, 5}, length = 180;
    use(&TRANSPARENT);
    for (size_t w = 0; w < sizeof widths / sizeof *widths; ++w) {
        double mean = 0, area = widths[w] * length,
               bound = (widths[w] + 1.5) * (length + 1) / 510 + fmin(widths[w], 0.5);
        int angles = 0;
        for (float deg = 0; deg < 180; deg += 7.5f, ++angles) {
            float x = 0.5f * length * cosf(glm_rad(deg)), y = 0.5f * length * sinf(glm_rad(deg));
            float shift = 0.1f * (float)angles;
            add_line((float[3]){shift - x, -y, 0}, (float[3]){shift + x, y, 0}, widths[w] / 2, 1);
            studio_draw(&studio);
            double off = alpha_sum() - area;
            if (fabs(off) > bound)
                fail_msg("width %g px at %g degrees: area off by %g, bound %g", widths[w], deg, off,
                         bound);
            mean += off;
            studio_clear(&studio);
        }
        if (fabs(mean / angles) > 0.3 * bound)
            fail_msg("width %g px: area off by %g on average", widths[w], mean / angles);
    }
}

// A ribbon that is wider than a block covers all pixels between its edges completely, in every
// direction, and no pixels outside.
static void wide_ribbons_are_whole(void **state)
{
    (void)state;
    const float widths[] = {21, 60, 150}; // px
    use(&TRANSPARENT);
    for (size_t w = 0; w < sizeof widths / sizeof *widths; ++w)
        for (float deg = 0; deg < 180; deg += 22.5f) {
            float x = cosf(glm_rad(deg)), y = sinf(glm_rad(deg));
            const float ends[2][3] = {{-300 * x, -300 * y, 0}, {300 * x, 300 * y, 0}};
            Strands strands = studio_strands(1, 2, ends);
            studio_add(&studio, &strands, widths[w] / 2, 1);
            strands_destroy(&strands);
            studio_draw(&studio);
            for (int row = 0; row < SIDE; ++row)
                for (int column = 0; column < SIDE; ++column) {
                    float across =
                        fabsf((column + 0.5f - SIDE / 2) * y + (row + 0.5f - SIDE / 2) * x);
                    int alpha = studio_pixel(&studio, column, row)[3];
                    if (across < widths[w] / 2 - 0.75f) assert_int_equal(alpha, 255);
                    if (across > widths[w] / 2 + 0.75f) assert_int_equal(alpha, 0);
                }
            studio_clear(&studio);
        }
}

// A cylinder that is parallel to the image and off the axis of a wide-angle camera appears as wide
// as the tangent planes through the eye: with radius r at (x, z) in front of the eye, they
// intersect the screen at focal (x z +- r sqrt(x^2 + z^2 - r^2)) / (z^2 - r^2). Rounding and rows
// as above.
static void cylinders_off_the_axis_are_wider(void **state)
{
    (void)state;
    const double x[] = {0, 0.7, 1.2}, z = 1, r = 0.04, edge = tan(55 * M_PI / 180);
    use(&TRANSPARENT);
    for (int turned = 0; turned < 2; ++turned)
        for (size_t i = 0; i < sizeof x / sizeof *x; ++i) {
            View view;
            studio_view(&view, SIDE, SIDE);
            view.eye[2] = 0, view.near_distance = 0.1f, view.far_distance = 10;
            view.fov = glm_rad(110);
            glm_look(view.eye, (vec3){0, 0, -1}, (vec3){0, 1, 0}, view.view);
            glm_perspective(view.fov, 1, 0.1f, 10, view.projection);
            float from[3] = {(float)x[i], -4, -1}, to[3] = {(float)x[i], 4, -1};
            if (turned) from[0] = -4, to[0] = 4, from[1] = to[1] = (float)x[i];
            add_line(from, to, (float)r, 1);
            studio_draw_view(&studio, &view);
            double root = r * sqrt(x[i] * x[i] + z * z - r * r),
                   focal = SIDE / 2 / edge, // px
                width = focal * 2 * root / (z * z - r * r), bound = (width + 1.5) * SIDE / 510;
            if (fabs(alpha_sum() - width * SIDE) > bound)
                fail_msg("at %g: %g px wide instead of %g", x[i], alpha_sum() / SIDE, width);
            studio_clear(&studio);
        }
}

static double line_area(double deg, float distance, float radius, float length)
{
    float angle = glm_rad((float)deg), z = 1000 - distance;
    float x = 0.5f * length * cosf(angle), y = 0.5f * length * sinf(angle);
    add_line((float[3]){-x, -y, z}, (float[3]){x, y, z}, radius, 1);
    studio_draw(&studio);
    double sum = alpha_sum();
    studio_clear(&studio);
    return sum;
}

// In a slow turntable, coverage that depends on the positions of pixels would flicker. A strand of
// 90 px^2 touches about 450 pixels, each of which is rounded by 1/510 at most and by half of that
// on average, in either direction: 0.3 px^2 is more than ten standard deviations. The ends are
// blurred over one pixel's length instead of a pixel's extent in the strand's direction, which adds
// 2 ends x 0.5 px wide x 0.1.
static void coverage_is_steady_in_a_slow_turn(void **state)
{
    (void)state;
    use(&TRANSPARENT);
    double low = 1e9, high = 0;
    for (int i = 0; i <= 20; ++i) {
        double area = line_area(29.5 + 0.05 * i, 1000, 0.25f, 180);
        low = fmin(low, area);
        high = fmax(high, area);
    }
    assert_true(fabs(low - 90) < 0.4 && fabs(high - 90) < 0.4);
}

// Draws from `distance` px off the middle, with the camera turned by `deg` about the vertical axis.
static void draw_from(float distance, double deg)
{
    View view;
    float angle = glm_rad((float)deg);
    studio_view(&view, SIDE, SIDE);
    glm_vec3_copy((vec3){distance * sinf(angle), 0, distance * cosf(angle)}, view.eye);
    glm_lookat(view.eye, (vec3){0, 0, 0}, (vec3){0, 1, 0}, view.view);
    studio_draw_view(&studio, &view);
}

// Adds `count` straight strands of `length` in the plane z = `depth`, spread over 256 x 256 px.
static void add_flat(uint32_t count, float length, float depth, float radius)
{
    float(*position)[3] = malloc((size_t)count * 2 * sizeof *position);
    assert_non_null(position);
    Random random = random_create(7, 0);
    for (uint32_t s = 0; s < count; ++s) {
        double x[2] = {random_real(&random) - 0.5, random_real(&random) - 0.5},
               angle = random_real(&random) * 2 * M_PI;
        for (int j = 0; j < 2; ++j) {
            float t = ((float)j - 0.5f) * length, *to = position[2 * s + (uint32_t)j];
            to[0] = (float)(256 * x[0] + t * cos(angle));
            to[1] = (float)(256 * x[1] + t * sin(angle));
            to[2] = depth;
        }
    }
    Strands strands = studio_strands(count, 2, (const float(*)[3])position);
    studio_add(&studio, &strands, radius, 1);
    strands_destroy(&strands);
    free(position);
}

// The camera turns by one degree about an axis behind hair that faces it. The hair moves by 4 px,
// but its area, and the area covered twice, change by 4e-5 only. A strand's end is blurred over one
// pixel's length wherever the pixels' middles lie, which errs by less than half a pixel's length,
// equally often in both directions: the standard deviation is sqrt(1/12) of the width. Rounding to
// 1/255 adds sqrt(1/12) of 1/255 in each of the (width + 1.5) length pixels. 4 standard deviations
// are allowed between the lowest and the highest sum. Strands that simply covered the pixels whose
// middles they meet would vary by sqrt(COUNT length width) px.
static void thin_hair_is_steady_in_a_slow_turn(void **state)
{
    (void)state;
    enum { COUNT = 200, STEPS = 20 };
    const float widths[] = {0.1f, 0.3f, 0.8f}, length = 40, scale = 2; // px in the picture
    use(&TRANSPARENT);
    for (size_t w = 0; w < sizeof widths / sizeof *widths; ++w) {
        double width = widths[w], low = INFINITY, high = 0;
        double ends = 2 * COUNT / 12.0 * width * width,
               rounding = COUNT * length * (width + 1.5) / (12.0 * 255 * 255),
               bound = 4 * sqrt(ends + rounding);
        add_flat(COUNT, scale * length, 500, scale * widths[w] / 2);
        for (int i = 0; i <= STEPS; ++i) {
            draw_from(1000 * scale + 500, (double)i / STEPS - 0.5);
            low = fmin(low, alpha_sum());
            high = fmax(high, alpha_sum());
        }
        if (!(high - low < bound))
            fail_msg("width %g px: %g to %g px^2, bound %g", width, low, high, bound);
        studio_clear(&studio);
    }
}

// The same strand from increasing distances, down to a width of 0.12 px: its area falls with the
// square of the distance. Every pixel is rounded to 1/255, which is up to 2 % of 0.12 and averages
// out over many pixels.
static void coverage_does_not_change_below_a_pixel(void **state)
{
    (void)state;
    use(&TRANSPARENT);
    for (double zoom = 1; zoom < 10; zoom *= 1.25) {
        double area = line_area(33, (float)(1000 * zoom), 0.5f, 220) * zoom * zoom;
        if (fabs(area - 220) > 0.015 * 220)
            fail_msg("%g times as far off: %g of 220 px^2", zoom, area);
    }
}

static void joints_are_covered_once(void **state)
{
    (void)state;
    enum { VERTICES = 17 };
    float position[VERTICES][3] = {{-90, 0, 0}}, angle = 0;
    for (int j = 1; j < VERTICES; ++j) { // bends of up to 60 degrees in alternating directions
        angle += glm_rad(15) * (float)(j % 5) * (j % 2 ? 1 : -1);
        position[j][0] = position[j - 1][0] + 12 * cosf(angle);
        position[j][1] = position[j - 1][1] + 12 * sinf(angle);
    }
    use(&TRANSPARENT);
    Strands strands = studio_strands(1, VERTICES, (const float(*)[3])position);
    studio_add(&studio, &strands, 2.5f, 0.5f);
    strands_destroy(&strands);
    studio_draw(&studio);
    for (int y = 0; y < SIDE; ++y)
        for (int x = 0; x < SIDE; ++x) assert_true(studio_pixel(&studio, x, y)[3] <= 128);
    for (int j = 1; j < VERTICES; ++j)
        for (int i = 0; i <= 24; ++i) { // along the ribbon's middle in steps of half a pixel
            float t = (float)i / 24;
            if ((j == 1 && i < 4) || (j == VERTICES - 1 && i > 20)) continue; // ends
            float x = position[j - 1][0] * (1 - t) + position[j][0] * t + SIDE / 2;
            float y = SIDE / 2 - (position[j - 1][1] * (1 - t) + position[j][1] * t);
            assert_true(studio_pixel(&studio, (int)x, (int)y)[3] >= 127);
        }
}

// Two wide ribbons meet at a bend of 120 degrees. Their mitre sticks out by twice their half-width,
// and both ribbons are complete almost up to its tip.
static void the_mitre_of_a_sharp_bend_is_whole(void **state)
{
    (void)state;
    const float radius = 16, half = 0.8660254f;
    const float position[3][3] = {{-100, 0, 0}, {0, 0, 0}, {-50, 100 * half, 0}};
    use(&TRANSPARENT);
    Strands strands = studio_strands(1, 3, position);
    studio_add(&studio, &strands, radius, 1);
    strands_destroy(&strands);
    studio_draw(&studio);
    for (float out = 0; out < 1.8f * radius; out += 0.5f)
        for (int side = -1; side <= 1; side += 2) {
            // A point on the bend's outer bisector, and points beside it that still lie in the
            // mitre.
            float off = 0.4f * (float)side * (2 * radius - out) * 0.5f;
            float x = half * out + 0.5f * off, y = -0.5f * out + half * off;
            assert_int_equal(studio_pixel(&studio, (int)(SIDE / 2 + x), (int)(SIDE / 2 - y))[3],
                             255);
        }
}

static void layers_of_equal_opacity_multiply(void **state)
{
    (void)state;
    enum { MOST = 8 };
    use(&TRANSPARENT);
    for (int n = 1; n <= MOST; ++n) {
        float position[MOST][2][3];
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < 2; ++j)
                memcpy(position[i][j], (float[3]){j ? 60 : -60, 0, (float)i}, sizeof(float[3]));
        Strands strands = studio_strands((uint32_t)n, 2, (const float(*)[3])position);
        studio_add(&studio, &strands, 6, 0.3f);
        strands_destroy(&strands);
        studio_draw(&studio);
        double expected = 255 * (1 - pow(0.7, n));
        assert_true(fabs(studio_pixel(&studio, SIDE / 2, SIDE / 2)[3] - expected) <= 0.6);
        studio_clear(&studio);
    }
}

// 30 layers: 8 in order, the rest in sums whose precision is far below one level of 255.
static void many_layers_still_multiply(void **state)
{
    (void)state;
    enum { COUNT = 30 };
    float position[COUNT][2][3];
    for (int i = 0; i < COUNT; ++i)
        for (int j = 0; j < 2; ++j)
            memcpy(position[i][j], (float[3]){j ? 60 : -60, 0, (float)i}, sizeof(float[3]));
    use(&TRANSPARENT);
    Strands strands = studio_strands(COUNT, 2, (const float(*)[3])position);
    studio_add(&studio, &strands, 6, 0.05f);
    strands_destroy(&strands);
    studio_draw(&studio);
    assert_true(fabs(studio_pixel(&studio, SIDE / 2, SIDE / 2)[3] - 255 * (1 - pow(0.95, COUNT))) <=
                1.0);
}

// From far away, hundreds of particles share a pixel.
static void hair_smaller_than_a_pixel_leaves_no_holes(void **state)
{
    (void)state;
    RendererOptions options = BLACK;
    options.width = options.height = 2;
    for (int k = 0; k < 3; ++k) options.background[k] = 1;
    use(&options);
    float(*position)[3] = malloc(2000 * 32 * sizeof *position);
    assert_non_null(position);
    Random random = random_create(3, 0);
    for (int i = 0; i < 2000 * 32; ++i) {
        double d[3];
        random_direction(&random, d);
        for (int k = 0; k < 3; ++k)
            position[i][k] = (float)(1.5 * d[k]) + (i % 32 ? position[i - 1][k] / 2 : 0);
    }
    Strands strands = studio_strands(2000, 32, (const float(*)[3])position);
    uint32_t item = studio_add(&studio, &strands, 0.2f, 1);
    studio.material[item].opacity = 0; // only errors would be visible
    studio_draw(&studio);
    assert_int_equal(studio.renderer.counts.fragments, 0);
    for (int i = 0; i < 2 * 2 * 3; ++i) assert_int_equal(studio.image.pixels[i], 255);
    strands_destroy(&strands);
    free(position);
}

// Sets options by which this share of the studio's strands is drawn, 1000 from the eye.
static void use_share(const RendererOptions *options, float share)
{
    RendererOptions mine = *options;
    mine.lod = (LodOptions){.end = 2000, .least = 2 * share - 1};
    use(&mine);
}

// Strands much thinner than a pixel rarely overlap, so their coverage adds up. The sum over n
// random strands of different visible lengths varies by about 1/sqrt(n) of itself.
static void fewer_strands_cover_as_much(void **state)
{
    (void)state;
    enum { COUNT = 4000 };
    double all = 0;
    add_tangle(COUNT, 0.05f, 0.2f, NULL);
    for (float share = 1; share > 0.51f; share -= 0.08f) {
        use_share(&TRANSPARENT, share);
        studio_draw(&studio);
        double sum = alpha_sum();
        if (share == 1) all = sum;
        if (fabs(sum / all - 1) > 0.02) fail_msg("share %g: %g, of all %g", share, sum, all);
        double left_out = COUNT * (1 - (double)share);
        assert_true(fabs((double)studio.renderer.counts.thinned - left_out) <=
                    0.01 * COUNT); // depends on where the hair's middle is
    }
}

// From one share to the next, a strand's width changes by a tenth. No pixel changes by more than a
// tenth of full opacity plus the change of the other strands' widths. Strands that appeared or
// vanished at once would change pixels by six tenths.
static void strands_neither_come_nor_go_at_once(void **state)
{
    (void)state;
    enum { COUNT = 50 };
    add_tangle(COUNT, 0.4f, 0.6f, NULL);
    uint8_t *before = NULL;
    size_t size;
    for (int i = 0; i <= 40; ++i) {
        use_share(&TRANSPARENT, 1 - 0.1f * (float)i / COUNT);
        uint8_t *now = draw_copy(&size);
        for (size_t k = 3; before && k < size; k += 4)
            assert_true(abs(now[k] - before[k]) <= 0.15 * 255);
        free(before);
        before = now;
    }
    free(before);
}

// The sum of opacity in the image from `distance` without level of detail.
static double find_all(float distance)
{
    studio.renderer.options.lod = (LodOptions){0};
    draw_from(distance, 0);
    return alpha_sum();
}

// The sum of opacity differences between two levels of detail, in the image from `distance`.
static double find_change(float distance, LodOptions before, LodOptions now)
{
    size_t size;
    double sum = 0;
    studio.renderer.options.lod = before;
    draw_from(distance, 0);
    uint8_t *old = studio_copy(&studio, &size);
    studio.renderer.options.lod = now;
    draw_from(distance, 0);
    for (size_t k = 3; k < size; k += 4) sum += abs(studio.image.pixels[k] - old[k]) / 255.0;
    free(old);
    return sum;
}

// A zoom out from `near` to `far` in this number of images. The share of strands falls from 1
// evenly with the distance, or with the width of a fibre on the screen.
enum { ZOOM_STRANDS = 2000, ZOOM_FRAMES = 40 };
static const float ZOOM_NEAR = 1000, ZOOM_FAR = 3000, ZOOM_LEAST = 0.2f, FIBRE_PX = 0.1f;

// The level of detail that has at `distance` the share which a zoom has at distance `of`.
static LodOptions zoom_level(bool by_width, float distance, float of)
{
    float shift = distance - of;
    LodOptions even = {.start = ZOOM_NEAR + shift, .end = ZOOM_FAR + shift, .least = ZOOM_LEAST};
    LodOptions width = {.width = FIBRE_PX * of / distance, .least = ZOOM_LEAST};
    return by_width ? width : even;
}

static double zoom_share(bool by_width, float distance)
{
    double even = 1 - (1 - ZOOM_LEAST) * (distance - ZOOM_NEAR) / (ZOOM_FAR - ZOOM_NEAR);
    return by_width ? ZOOM_NEAR / distance : even;
}

// To exclude the change by the zoom itself, each image is compared with an image from the same
// place with the previous place's level of detail. From share s to s - d, the strands that vanish
// take away the part d/s of the total coverage, and the remaining, wider strands add as much; less
// is visible where strands overlap. Rounding to 1/255 increases and decreases values equally often.
// If n strands vanish at a time, their visible lengths vary by half, and the mean by 0.5/sqrt(n): 4
// of these are allowed in addition to one of the two parts. If the share changed in quarters, some
// image would change by 8 parts.
static void nothing_pops_along_a_zoom(void **state)
{
    (void)state;
    const float step = (ZOOM_FAR - ZOOM_NEAR) / ZOOM_FRAMES;
    use(&TRANSPARENT);
    add_tangle(ZOOM_STRANDS, FIBRE_PX / 2, 0.2f, NULL);
    for (int i = 1; i <= ZOOM_FRAMES; ++i) {
        const float now = ZOOM_NEAR + step * (float)i, before = now - step;
        const double all = find_all(now);
        for (int by_width = 0; by_width < 2; ++by_width) {
            double share = zoom_share(by_width, before), goes = share - zoom_share(by_width, now),
                   change = find_change(now, zoom_level(by_width, now, before),
                                        zoom_level(by_width, now, now));
            double parts = change / all * share / goes;
            if (!(parts < 2 + 4 * 0.5 / sqrt(goes * ZOOM_STRANDS)))
                fail_msg("%s, picture %d: %g parts change", by_width ? "width" : "distance", i,
                         parts);
            assert_true(parts > 1); // strands do vanish, a few at a time
        }
    }
}

// The narrower the fibres, the fewer are drawn, so that they are as wide as requested.
static void fibres_are_as_wide_as_asked_for(void **state)
{
    (void)state;
    RendererOptions options = TRANSPARENT;
    options.lod = (LodOptions){.width = 0.5f, .least = 0.01f};
    use(&options);
    add_tangle(1000, 0.1f, 0.2f, NULL); // 0.2 px wide
    studio_draw(&studio);
    assert_in_range(studio.renderer.counts.thinned, 590,
                    610); // their middle is not exactly 1000 away
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        CLAIM(coverage_of_a_strand_is_its_area),
        CLAIM(coverage_is_steady_in_a_slow_turn),
        CLAIM(thin_hair_is_steady_in_a_slow_turn),
        CLAIM(coverage_does_not_change_below_a_pixel),
        CLAIM(joints_are_covered_once),
        CLAIM(the_mitre_of_a_sharp_bend_is_whole),
        CLAIM(wide_ribbons_are_whole),
        CLAIM(cylinders_off_the_axis_are_wider),
        CLAIM(layers_of_equal_opacity_multiply),
        CLAIM(many_layers_still_multiply),
        CLAIM(hair_smaller_than_a_pixel_leaves_no_holes),
        CLAIM(fewer_strands_cover_as_much),
        CLAIM(strands_neither_come_nor_go_at_once),
        CLAIM(nothing_pops_along_a_zoom),
        CLAIM(fibres_are_as_wide_as_asked_for),
    };
    return stage_run(tests);
}
