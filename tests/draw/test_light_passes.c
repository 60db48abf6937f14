// SPDX-License-Identifier: MIT
// Multiple scattering by shaders, which GPUs use, against C, point by point.
#include "draw/hair_paint.h"
#include "passes/passes.h"
#include "support/hair_fixture.h"
#include "support/needed.h"
#include "support/stage.h"

#include "glsl/kernel/onto.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { STRANDS = 100, N = 8, SUMS_OF_A_TURN = 1 << 18 };

// The share of strands that is drawn: two of five, the last of them narrower.
static const float LEAST_SHARE = 0.403f;

// Initialisers of lights.
// clang-format off
#define SUN {.kind = LIGHT_DIRECTIONAL, .direction = {0.48f, 0.6f, 0.64f}, .color = {1, 0.8f, 0.5f}, \
    .intensity = 2, .shadow = true}
#define WIDE_SUN {.kind = LIGHT_DIRECTIONAL, .direction = {0.48f, 0.6f, 0.64f}, .color = {1, 0.8f, 0.5f}, \
    .intensity = 2, .radius = 12, .shadow = true}
#define WIDE_LAMP {.kind = LIGHT_POINT, .position = {-150, 100, 40}, .distance = 100, \
    .color = {1, 1, 1}, .intensity = 1, .radius = 25, .shadow = true}
#define BACK {.kind = LIGHT_DIRECTIONAL, .direction = {-0.6f, 0, -0.8f}, .color = {0.3f, 0.6f, 1}, \
    .intensity = 1}
#define LAMP {.kind = LIGHT_POINT, .position = {-150, 100, 40}, .distance = 100, \
    .color = {1, 1, 1}, .intensity = 1, .shadow = true}
#define INNER {.kind = LIGHT_POINT, .position = {-10, 4, 25}, .distance = 100, \
    .color = {1, 1, 1}, .intensity = 3, .shadow = true}
#define SPOT {.kind = LIGHT_SPOT, .position = {20, 300, 100}, .direction = {0, -0.95f, -0.3122f}, \
    .inner_deg = 10, .outer_deg = 25, .distance = 300, .color = {1, 0.2f, 0.2f}, .intensity = 3}
// clang-format on

// What is drawn, and how.
typedef struct Case {
    const char *name;
    Light lights[3];
    uint32_t light_count;
    Scatter scatter;
    StageSky sky;
    bool mesh, painted, smooth, dense, thinned, sheer;
    int cells;
    bool turns;       // sums of cells in several turns
    uint32_t strands; // number of strands that represent all; 0: all
} Case;

static const Case CASES[] = {
    {.name = "sun", .lights = {SUN}, .light_count = 1, .scatter = SCATTER_GRID},
    {.name = "sky alone", .scatter = SCATTER_NONE, .sky = STAGE_SKY},
    {.name = "sun, back, sky",
     .lights = {SUN, BACK},
     .light_count = 2,
     .scatter = SCATTER_GRID,
     .sky = STAGE_SKY,
     .cells = 16},
    {.name = "an environment, a mesh",
     .scatter = SCATTER_GRID,
     .mesh = true,
     .sky = STAGE_ENVIRONMENT},
    {.name = "a wide sun and a wide lamp, a mesh",
     .lights = {WIDE_SUN, WIDE_LAMP},
     .light_count = 2,
     .scatter = SCATTER_GRID,
     .mesh = true},
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
     .sky = STAGE_SKY},
    {.name = "a lamp among hair, a mesh before one half",
     .lights = {INNER},
     .light_count = 1,
     .scatter = SCATTER_GRID,
     .mesh = true},
    {.name = "sheer hair",
     .lights = {SUN},
     .light_count = 1,
     .scatter = SCATTER_GRID,
     .cells = 24,
     .sheer = true},
    {.name = "paint, curves",
     .lights = {SUN},
     .light_count = 1,
     .scatter = SCATTER_GRID,
     .painted = true,
     .smooth = true},
    {.name = "a third of paint, curves",
     .lights = {SUN},
     .light_count = 1,
     .scatter = SCATTER_GRID,
     .sky = STAGE_SKY,
     .painted = true,
     .smooth = true,
     .strands = 60},
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
    NEEDED(hair_paint_upload(&studio.hair[item], &colored, &paint, &studio.gpu.limits, error));
    paint_destroy(&paint);
    free(colored.color);
}

// Adds two sections of fair hair with different colours. Their segments are longer than a cell, so
// that C leaves out no particle.
static void add_sections(const Case *of)
{
    for (uint64_t i = 0; i < 2; ++i) {
        Strands strands = studio_tangle(5 + i, SIDE * 0.6, STRANDS, N, 18, 0.5, NULL);
        uint32_t item = studio_add(&studio, &strands, of->dense ? 14 : 0.7f, of->dense ? 1 : 0.5f);
        SectionParams *material = &studio.material[item];
        material->shading = SHADING_MARSCHNER;
        material->cone_angle = 3;
        material->shadow_opacity = of->sheer ? 0.4f : 1;
        material->tip_ratio = 0.4f;
        material->smooth = of->smooth ? 3 : 1;
        material->curve = CURVE_BSPLINE; // does not pass through the particles
        for (int k = 0; k < 3; ++k) material->color[k] = 0.9f - 0.15f * (float)((uint)k + i);
        if (of->painted) paint_strands(item, &strands);
        strands_destroy(&strands);
    }
}

static void draw(const Case *of, Raster by)
{
    RendererOptions options = BLACK;
    raster = by;
    options.shadow = (ShadowOptions){.kind = SHADOW_DOM, .side = 128, .spacing = 200};
    options.mesh_shading = MESH_SKIN;
    options.scatter = (ScatterOptions){
        .kind = of->scatter, .cells = of->cells ? of->cells : 10, .strands = of->strands};
    if (of->thinned) options.lod = (LodOptions){.start = 1, .end = 2, .least = LEAST_SHARE};
    use(&options);
    if (of->turns && by == RASTER_COMPUTE)
        stage_passes()->scatter.passes.most_sums = SUMS_OF_A_TURN;
    if (of->mesh) {
        Mesh mesh = make_square(45);
        for (uint32_t v = 0; v < mesh.vertex_count; ++v)
            mesh.position[v][2] = 0.4f * mesh.position[v][0] - 10;
        NEEDED(renderer_set_mesh(&studio.renderer, &mesh, (float[3]){0.9f, 0.6f, 0.5f}, error));
        mesh_destroy(&mesh);
    }
    stage_draw_lit(of->lights, of->light_count, of->sky);
}

// The light that a section's particles show, three floats each in the order of positions; the
// caller frees it. Shaders compute it for all points of the curves, some of which are the
// particles.
static float *copy_seen(uint32_t item, size_t *count)
{
    const HairBatch *batch = &studio.hair[item].batches[0];
    const size_t n = batch->vertex_count, tiles = hair_slots(batch) / STRAND_TILE;
    const size_t parts = (size_t)studio.material[item].smooth, points = (n - 1) * parts + 1;
    const float *all = gpu_buffer_read(&stage_passes()->scatter.seen[item].seen);
    float *copy = malloc((*count = 3 * tiles * n * STRAND_TILE) * sizeof *copy);
    assert_non_null(all);
    assert_non_null(copy);
    for (size_t tile = 0; tile < tiles; ++tile)
        for (size_t j = 0; j < n; ++j)
            memcpy(copy + 3 * (tile * n + j) * STRAND_TILE,
                   all + 3 * (tile * points + j * parts) * STRAND_TILE,
                   3 * STRAND_TILE * sizeof *copy);
    free((void *)(uintptr_t)all);
    return copy;
}

// The same by C.
static float *find_seen(uint32_t item)
{
    const HairBatch *batch = &studio.hair[item].batches[0];
    const size_t n = batch->vertex_count, all = hair_slots(batch) * n;
    const float(*position)[4] = gpu_buffer_read(&batch->position);
    float *copy = malloc(3 * all * sizeof *copy), *to = copy;
    assert_non_null(position);
    assert_non_null(copy);
    for (size_t at = 0; at < all; at += STRAND_TILE) {
        size_t j = at / STRAND_TILE % n, before = j > 0 ? at - STRAND_TILE : at,
               after = j + 1 < n ? at + STRAND_TILE : at;
        float x[3][STRAND_TILE], t[3][STRAND_TILE], seen[3][STRAND_TILE];
        for (int i = 0; i < STRAND_TILE; ++i)
            for (int k = 0; k < 3; ++k) {
                x[k][i] = position[at + (size_t)i][k];
                t[k][i] = position[after + (size_t)i][k] - position[before + (size_t)i][k];
            }
        stage_lanes_show(item, (const float(*)[STRAND_TILE])x, (const float(*)[STRAND_TILE])t,
                         seen);
        for (int i = 0; i < STRAND_TILE; ++i)
            for (int k = 0; k < 3; ++k) *to++ = seen[k][i];
    }
    free((void *)(uintptr_t)position);
    return copy;
}

// Whether the particle belongs to a strand that is drawn, and not to one that only fills the last
// tile.
static bool is_drawn(const Case *of, size_t at)
{
    size_t particle = at / 3,
           strand = particle / (N * STRAND_TILE) * STRAND_TILE + particle % STRAND_TILE;
    return strand < (of->thinned ? (size_t)ceilf(STRANDS * LEAST_SHARE) : STRANDS);
}

// Sums of hair are integers in both. What follows is rounded a few hundred times in the longest
// chain of cells and orders, by up to 1e-7 each: 3e-5 in all. Single points may differ more, where
// light is a difference of sums or a piece of hair is rounded to another cell.
static void expect_same(const Case *of, const float *c, const float *shaders, size_t count)
{
    double off = 0, all = 0, most = 0;
    for (size_t i = 0; i < count; ++i) {
        if (!is_drawn(of, i)) continue;
        double a = (double)c[i], b = (double)shaders[i];
        assert_true(isfinite(a) && isfinite(b));
        off += (a - b) * (a - b), all += a * a, most = fmax(most, fabs(a - b));
    }
    double mean = sqrt(all / (double)count);
    if (!(mean > 0.003)) fail_msg("%s: hardly any light: %g", of->name, mean);
    if (!(sqrt(off / all) < 3e-5 && most < 1e-3 * mean))
        fail_msg("%s: off by %g of the root mean square, at most by %g of %g", of->name,
                 sqrt(off / all), most, mean);
}

// Number of cells that are almost hidden, so that their mean light suffices.
static int count_hidden(void)
{
    const LightPasses *passes = &stage_passes()->scatter.passes;
    int hidden = 0;
    LightCell *cells = gpu_buffer_read(&passes->cells);
    assert_non_null(cells);
    for (int slot = 0; slot < passes->active; ++slot) hidden += cells[slot].mean[3] > 0;
    free(cells);
    return hidden;
}

// The light of hair on skin passes through halves, rounded by up to 2^-11, and the cells below the
// skin are the same.
static void expect_same_skin(const Case *of, const float (*c)[ONTO_FACES][4])
{
    const LightPasses *passes = &stage_passes()->scatter.passes;
    assert_true((c != NULL) == of->mesh && passes->lights_skin == of->mesh);
    if (!c) return;
    // Skin does not lower the number of cells that fit into a driver's largest buffer.
    assert_true(passes->source.size <= passes->light.size &&
                passes->sent.size <= passes->light.size);
    const float(*shaders)[ONTO_FACES][4] = gpu_buffer_read(&passes->faces);
    const size_t cells = light_lattice_cells(&passes->field.lattice);
    double off = 0, all = 0;
    assert_non_null(shaders);
    for (size_t i = 0; i < cells; ++i)
        for (int f = 0; f < ONTO_FACES; ++f)
            for (int k = 0; k < (f == 0 ? 4 : 3); ++k) { // 4th: which cells count
                double a = (double)c[i][f][k], b = (double)shaders[i][f][k];
                off += (a - b) * (a - b), all += a * a;
            }
    if (!(all > 1e-4 * (double)cells && sqrt(off / all) < 0x1p-11))
        fail_msg("%s: skin: off by %g of %g in %zu cells", of->name, sqrt(off / all), all, cells);
    free((void *)(uintptr_t)shaders);
}

static const float (*copy_onto(void))[ONTO_FACES][4]
{
    const float(*onto)[ONTO_FACES][4] = stage_lanes_onto();
    size_t size = stage_lanes_cells() * sizeof *onto;
    float(*copy)[ONTO_FACES][4] = onto ? malloc(size) : NULL;
    if (copy) memcpy(copy, onto, size);
    return (const float(*)[ONTO_FACES][4])copy;
}

static void c_and_shaders_find_the_same_light(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; ++i) {
        float *c[2], *shaders[2];
        size_t count[2];
        add_sections(&CASES[i]);
        draw(&CASES[i], RASTER_BLOCKS);
        for (uint32_t item = 0; item < 2; ++item) c[item] = find_seen(item);
        const float(*onto)[ONTO_FACES][4] = copy_onto();
        draw(&CASES[i], RASTER_COMPUTE);
        for (uint32_t item = 0; item < 2; ++item) shaders[item] = copy_seen(item, &count[item]);
        assert_int_equal(count_hidden() > 0, CASES[i].dense);
        for (uint32_t item = 0; item < 2; ++item) {
            expect_same(&CASES[i], c[item], shaders[item], count[item]);
            free(c[item]);
            free(shaders[item]);
        }
        expect_same_skin(&CASES[i], onto);
        free((void *)(uintptr_t)onto);
        studio_clear(&studio);
    }
}

// The brightest lamp that a scene may have, among hair: the light on skin is beyond the range of
// halves.
static void bright_light_on_skin_is_finite(void **state)
{
    (void)state;
    const Case bright = {.name = "a bright lamp among hair, a mesh",
                         .lights = {{.kind = LIGHT_POINT,
                                     .position = {-10, 4, 25},
                                     .distance = 1000,
                                     .color = {1, 1, 1},
                                     .intensity = 1e4f}},
                         .light_count = 1,
                         .scatter = SCATTER_GRID,
                         .mesh = true};
    add_sections(&bright);
    draw(&bright, RASTER_COMPUTE);
    const LightPasses *passes = &stage_passes()->scatter.passes;
    const size_t count = light_lattice_cells(&passes->field.lattice) * ONTO_FACES * 4;
    float *shown = gpu_buffer_read(&passes->faces), most = 0;
    assert_non_null(shown);
    for (size_t i = 0; i < count; ++i) {
        if (!isfinite(shown[i])) fail_msg("%zu: %g", i, (double)shown[i]);
        most = fmaxf(most, shown[i]);
    }
    if (!(most > 6e4f)) fail_msg("at most %g", (double)most);
    free(shown);
    studio_clear(&studio);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        CLAIM(bright_light_on_skin_is_finite),
        CLAIM(c_and_shaders_find_the_same_light),
    };
    return stage_run_one(tests, RASTER_BLOCKS);
}
