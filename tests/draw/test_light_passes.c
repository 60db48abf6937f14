// SPDX-License-Identifier: MIT
// The light among hair by shaders, which GPUs have, against C's, point by point.
#include "passes/light_passes.h"

#include "lanes/light_grid_state.h"
#include "support/hair_fixture.h"
#include "support/needed.h"
#include "support/stage.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { STRANDS = 100, N = 8, SUMS_OF_A_TURN = 1 << 18 };

// Of the strands one in two and a half, the last of them a narrow one.
static const float LEAST_SHARE = 0.403f;

// Initialisers of lights.
// clang-format off
#define SUN {.kind = LIGHT_DIRECTIONAL, .direction = {0.48f, 0.6f, 0.64f}, .color = {1, 0.8f, 0.5f}, \
    .intensity = 2, .shadow = true}
#define BACK {.kind = LIGHT_DIRECTIONAL, .direction = {-0.6f, 0, -0.8f}, .color = {0.3f, 0.6f, 1}, \
    .intensity = 1}
#define LAMP {.kind = LIGHT_POINT, .position = {-150, 100, 40}, .distance = 100, \
    .color = {1, 1, 1}, .intensity = 1, .shadow = true}
#define SPOT {.kind = LIGHT_SPOT, .position = {20, 300, 100}, .direction = {0, -0.95f, -0.3122f}, \
    .inner_deg = 10, .outer_deg = 25, .distance = 300, .color = {1, 0.2f, 0.2f}, .intensity = 3}
// clang-format on

// What is drawn, and how.
typedef struct Case {
    const char *name;
    Light lights[3];
    uint32_t light_count;
    Scatter scatter;
    bool sky, mesh, painted, smooth, dense, thinned;
    int cells;
    bool turns; // sums of cells in turns
} Case;

static const Case CASES[] = {
    {.name = "sun", .lights = {SUN}, .light_count = 1, .scatter = SCATTER_GRID},
    {.name = "sky alone", .scatter = SCATTER_NONE, .sky = true},
    {.name = "sun, back, sky",
     .lights = {SUN, BACK},
     .light_count = 2,
     .scatter = SCATTER_GRID,
     .sky = true,
     .cells = 16},
    {.name = "lamp, spot",
     .lights = {LAMP, SPOT},
     .light_count = 2,
     .scatter = SCATTER_GRID,
     .thinned = true},
    {.name = "mesh",
     .lights = {SUN, LAMP, BACK},
     .light_count = 3,
     .scatter = SCATTER_GRID,
     .mesh = true,
     .sky = true},
    {.name = "paint, curves",
     .lights = {SUN},
     .light_count = 1,
     .scatter = SCATTER_GRID,
     .painted = true,
     .smooth = true},
    {.name = "dense",
     .lights = {SUN},
     .light_count = 1,
     .scatter = SCATTER_GRID,
     .dense = true,
     .turns = true},
};

static void paint_strands(uint32_t item, const Strands *strands)
{
    Paint paint;
    Strands colored = *strands;
    colored.color = calloc(strands->vertex_count, sizeof *colored.color);
    assert_non_null(colored.color);
    for (uint32_t v = 0; v < strands->vertex_count; ++v)
        for (int k = 0; k < 4; ++k)
            colored.color[v][k] = k < 3 ? 0.3f + 0.6f * (float)((v + 7 * (uint)k) % 11) / 10 : 1;
    NEEDED(paint_create(&paint, &colored, &studio.material[item], error));
    NEEDED(look_paint(&studio.hair[item], &colored, &paint, &studio.gpu.limits, error));
    paint_destroy(&paint);
    free(colored.color);
}

// Two sections of fair hair, of other colours, whose segments are longer than a cell: C leaves no
// particle of them out.
static void add_sections(const Case *of)
{
    for (uint64_t i = 0; i < 2; ++i) {
        Strands strands = studio_tangle(5 + i, SIDE * 0.6, STRANDS, N, 18, 0.5, NULL);
        uint32_t item = studio_add(&studio, &strands, of->dense ? 14 : 0.7f, of->dense ? 1 : 0.5f);
        SectionParams *material = &studio.material[item];
        material->shading = SHADING_MARSCHNER;
        material->cone_angle = 3;
        material->shadow_opacity = 1;
        material->tip_ratio = 0.4f;
        material->smooth = of->smooth ? 3 : 1;
        material->curve = CURVE_BSPLINE; // which passes no particle
        for (int k = 0; k < 3; ++k) material->color[k] = 0.9f - 0.15f * (float)((uint)k + i);
        if (of->painted) paint_strands(item, &strands);
        strands_destroy(&strands);
    }
}

static void draw(const Case *of, GpuKind kind)
{
    const Ambient sky = {{0.5f, 0.6f, 0.9f}, {0.2f, 0.1f, 0.1f}}, none = {{0}, {0}};
    RendererOptions options = BLACK;
    View view;
    studio.gpu.kind = kind;
    options.shadow = (ShadowOptions){.kind = SHADOW_DOM, .side = 128, .spacing = 200};
    options.scatter = of->scatter;
    options.scatter_cells = of->cells ? of->cells : 10;
    if (of->thinned) options.lod = (LodOptions){.start = 1, .end = 2, .least = LEAST_SHARE};
    use(&options);
    if (of->turns) studio.renderer.scatter.passes.most_sums = SUMS_OF_A_TURN;
    if (of->mesh) {
        Mesh mesh = make_square(45);
        for (uint32_t v = 0; v < mesh.vertex_count; ++v)
            mesh.position[v][2] = 0.4f * mesh.position[v][0] - 10;
        NEEDED(renderer_set_mesh(&studio.renderer, &mesh, (float[3]){0.9f, 0.6f, 0.5f}, error));
        mesh_destroy(&mesh);
    }
    studio_view(&view, SIDE, SIDE);
    const RenderFrame frame = {.view = &view,
                               .lights = of->lights,
                               .light_count = of->light_count,
                               .ambient = of->sky ? &sky : &none,
                               .head_rotation = {0, 0, 0, 1}};
    NEEDED(
        renderer_draw(&studio.renderer, &frame, studio.items, studio.count, &studio.image, error));
}

// What a section's points show, three floats each; the caller frees it.
static float *copy_seen(uint32_t item, size_t *count)
{
    const GpuBuffer *seen = &studio.renderer.scatter.seen[item].left;
    float *copy = gpu_buffer_read(seen);
    assert_non_null(copy);
    *count = (size_t)seen->size / sizeof *copy;
    return copy;
}

// Points of the strands that are drawn, not of those that only fill the last tile.
static bool is_drawn(const Case *of, size_t at, size_t count)
{
    size_t tiles = (STRANDS + STRAND_TILE - 1) / STRAND_TILE,
           points = count / 3 / tiles / STRAND_TILE, point = at / 3,
           strand = point / (points * STRAND_TILE) * STRAND_TILE + point % STRAND_TILE;
    return strand < (of->thinned ? (size_t)ceilf(STRANDS * LEAST_SHARE) : STRANDS);
}

// Sums of hair are whole numbers on either side. What comes after them is rounded, in the longest
// chain of cells and orders a few hundred times, by 1e-7 or less each: 3e-5 in all. Where light is
// a difference of sums, or a piece of hair is rounded to another cell, a point may be off by more.
static void expect_same(const Case *of, const float *c, const float *shaders, size_t count)
{
    double off = 0, all = 0, most = 0;
    for (size_t i = 0; i < count; ++i) {
        if (!is_drawn(of, i, count)) continue;
        double a = (double)c[i], b = (double)shaders[i];
        assert_true(isfinite(a) && isfinite(b));
        off += (a - b) * (a - b), all += a * a, most = fmax(most, fabs(a - b));
    }
    double mean = sqrt(all / (double)count);
    assert_true(mean > 0.003);
    if (!(sqrt(off / all) < 3e-5 && most < 1e-3 * mean))
        fail_msg("%s: off by %g of the root mean square, at most by %g of %g", of->name,
                 sqrt(off / all), most, mean);
}

// Cells that so little is seen of that their mean light will do.
static int count_hidden(void)
{
    const LightPasses *passes = &studio.renderer.scatter.passes;
    int hidden = 0;
    float *cells = gpu_buffer_read(&passes->cells);
    assert_non_null(cells);
    for (int slot = 0; slot < passes->active; ++slot) hidden += cells[24 * slot + 11] > 0;
    free(cells);
    return hidden;
}

static void c_and_shaders_find_the_same_light(void **state)
{
    (void)state;
    const Gpu own = studio.gpu;
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; ++i) {
        float *seen[2][2];
        size_t count[2];
        add_sections(&CASES[i]);
        for (int kind = 0; kind < 2; ++kind) {
            draw(&CASES[i], kind ? GPU_HARDWARE : GPU_CPU_DRIVER);
            assert_int_equal(studio.renderer.scatter.passes.filled > 0, kind);
            for (uint32_t item = 0; item < 2; ++item)
                seen[kind][item] = copy_seen(item, &count[item]);
        }
        assert_int_equal(count_hidden() > 0, CASES[i].dense);
        for (uint32_t item = 0; item < 2; ++item) {
            expect_same(&CASES[i], seen[0][item], seen[1][item], count[item]);
            free(seen[0][item]);
            free(seen[1][item]);
        }
        studio_clear(&studio);
    }
    studio.gpu.kind = own.kind;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        CLAIM(c_and_shaders_find_the_same_light),
    };
    return stage_run_one(tests, RASTER_BLOCKS);
}
