// SPDX-License-Identifier: MIT
#include "fibre.h"
#include "hair_fixture.h"
#include "hair_paint.h"
#include "random.h"
#include "render_shadow.h"
#include "render_uniforms.h"
#include "shadow_reference.h"
#include "strands_make.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const Light ABOVE = {
    .direction = {0, 1, 0}, .color = {1, 1, 1}, .intensity = 1, .shadow = true};

// Hair and mesh with both judgements of the light that reaches a point.
typedef struct Stage {
    Strands strands;
    Hair hair;
    SectionParams material;
    ReferenceItem item;
    ReferenceScene reference_scene;
    ShadowReference reference;
    ShadowCaster casters[8];
    ShadowScene scene;
    RenderMesh mesh;
    RenderShadow shadow;
    bool on_fibre; // points that are asked for lie in the middle of fibres
    Light light;
} Stage;

#define NEEDED(call)                                                                               \
    do {                                                                                           \
        Error error_ = {{0}};                                                                      \
        Error *error = &error_;                                                                    \
        if ((call) != RESULT_OK) fail_msg("%s", error_.text);                                      \
    } while (0)

static void assert_near(double got, double expected, double tolerance)
{
    if (!(fabs(got - expected) <= tolerance)) fail_msg("got %.9g, expected %.9g", got, expected);
}

// Takes the strands over.
static void stage_open(Stage *stage, Strands strands, float radius, float opacity, const Mesh *mesh,
                       const Light *light)
{
    *stage = (Stage){.strands = strands, .light = *light};
    const GpuLimits *limits = &fixture_gpu()->limits;
    NEEDED(section_params_create(&stage->material, error));
    stage->material.tip_ratio = 1;
    stage->material.shadow_opacity = opacity;
    NEEDED(hair_create(&stage->hair, &stage->strands, 0, limits, error));
    stage->item =
        (ReferenceItem){.strands = &stage->strands, .material = &stage->material, .radius = radius};
    stage->reference_scene = (ReferenceScene){.items = &stage->item, .item_count = 1, .mesh = mesh};
    NEEDED(shadow_reference_create(&stage->reference, &stage->reference_scene, light,
                                   (const float[3]){0}, error));
    stage->scene = (ShadowScene){.lights = &stage->light,
                                 .light_count = 1,
                                 .casters = {.list = stage->casters},
                                 .mesh = {&stage->mesh, {0, 0, 0, 1}, {0}},
                                 .revision = 1};
    for (uint32_t b = 0; b < stage->hair.batch_count && b < 8; ++b)
        stage->casters[stage->scene.casters.count++] =
            (ShadowCaster){&stage->hair.batches[b],
                           {.material = material_params(&stage->material, radius), .share = 1}};
    if (mesh)
        NEEDED(render_mesh_create(&stage->mesh, mesh, (const float[3]){1, 1, 1}, limits, error));
}

static void stage_close(Stage *stage)
{
    render_shadow_destroy(&stage->shadow);
    render_mesh_destroy(&stage->mesh);
    hair_destroy(&stage->hair);
    shadow_reference_destroy(&stage->reference);
    section_params_destroy(&stage->material);
    strands_destroy(&stage->strands);
}

static bool by_processor; // what makes the maps that are tested

static int by_shaders(void **state)
{
    (void)state;
    by_processor = false;
    return 0;
}

static int by_c(void **state)
{
    (void)state;
    by_processor = true;
    return 0;
}

static void draw_maps(Stage *stage, Shadow kind, int side, float spacing)
{
    GpuTimer timer;
    GpuBuffer uniforms = {0};
    gpu_timer_create(&timer, false, true);
    DrawParams draw = {.head_rotation = {0, 0, 0, 1}};
    gpu_uniforms_set(&uniforms, BIND_DRAW, &draw, sizeof draw);
    render_shadow_destroy(&stage->shadow);
    const ShadowOptions options = {kind, side, spacing};
    NEEDED(render_shadow_create(&stage->shadow, &fixture_gpu()->limits, &options, by_processor,
                                error));
    NEEDED(render_shadow_draw(&stage->shadow, &stage->scene, &timer, error));
    gpu_timer_destroy(&timer);
    gpu_buffer_destroy(&uniforms);
}

// What the maps say of `count` points; the caller frees it.
static float *light_left(Stage *stage, const float (*points)[4], uint32_t count)
{
    GLuint program;
    GpuBuffer in, out;
    const GpuLimits *limits = &fixture_gpu()->limits;
    const ShaderDefine defines[] = {{"SHADOW", stage->shadow.options.kind},
                                    {"SHADOW_BY_MESH", stage->mesh.triangle_count > 0},
                                    {NULL, 0}};
    uint32_t groups = (count + 7) / 8;
    float *shares = malloc(groups * 8 * sizeof *shares);
    float(*whole)[4] = calloc(groups * 8, sizeof *whole);
    assert_true(shares && whole);
    memcpy(whole, points, count * sizeof *points);
    NEEDED(shader_build_compute(&program, "check_shadow.comp", defines, error));
    NEEDED(gpu_buffer_create(&in, limits, "points", groups * 8 * 16, whole, 0, error));
    NEEDED(gpu_buffer_create(&out, limits, "shares", groups * 8 * 4, NULL, 0, error));
    gpu_buffer_bind_storage(&in, 0);
    gpu_buffer_bind_storage(&out, 1);
    render_shadow_bind(&stage->shadow);
    glUseProgram(program);
    glUniform2f(0, stage->on_fibre ? 2 * stage->item.radius : 0, stage->material.shadow_opacity);
    glDispatchCompute(groups, 1, 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, count * 4, shares);
    gpu_buffer_destroy(&in);
    gpu_buffer_destroy(&out);
    glDeleteProgram(program);
    free(whole);
    return shares;
}

static float light_at(Stage *stage, float x, float y, float z)
{
    const float point[1][4] = {{x, y, z, 1}};
    float *share = light_left(stage, point, 1), value = *share;
    free(share);
    return value;
}

static void expect_light(Stage *stage, float x, float y, float z, double expected, double tolerance)
{
    assert_near((double)light_at(stage, x, y, z), expected, tolerance);
}

static double exact_at(const Stage *stage, double x, double y, double z)
{
    return shadow_reference_light(&stage->reference, (const double[3]){x, y, z}, 0);
}

// `layers` straight strands, 1 m long and 2 * radius wide, at y = 0, -0.1, -0.2 ...
static Strands make_layers(uint32_t layers)
{
    enum { VERTICES = 5 };
    Strands strands;
    NEEDED(strands_create(&strands, layers, layers * VERTICES, error));
    for (uint32_t s = 0; s <= layers; ++s) strands.first[s] = s * VERTICES;
    for (uint32_t v = 0; v < strands.vertex_count; ++v) {
        strands.position[v][0] = (float)(v % VERTICES) / (VERTICES - 1) - 0.5f;
        strands.position[v][1] = -0.1f * (float)(v / VERTICES);
    }
    return strands;
}

static Mesh make_square(float y, float half)
{
    Mesh mesh;
    NEEDED(mesh_create(&mesh, 4, 2, error));
    for (int v = 0; v < 4; ++v) {
        memcpy(mesh.position[v], (float[3]){v & 1 ? half : -half, y, v & 2 ? half : -half}, 12);
        mesh.normal[v][1] = 1;
    }
    const uint32_t triangles[2][3] = {{0, 1, 2}, {2, 1, 3}};
    memcpy(mesh.triangle, triangles, sizeof triangles);
    return mesh;
}

static void exact_light_multiplies_through_layers(void **state)
{
    (void)state;
    Stage stage;
    stage_open(&stage, make_layers(5), 0.01f, 0.3f, NULL, &ABOVE);
    assert_near(exact_at(&stage, 0.1, 1, 0), 1, 0); // before all of them
    for (int n = 1; n <= 5; ++n) {
        assert_near(exact_at(&stage, 0.1, 0.05 - 0.1 * n, 0.0099), pow(0.7, n), 1e-6);
        assert_near(exact_at(&stage, 0.1, 0.05 - 0.1 * n, 0.0101), 1, 0);
    }
    assert_near(exact_at(&stage, 0.51, -1, 0), 1, 0); // beyond the ends
    const double on_the_second[3] = {0.1, -0.1 - 1e-4, 0};
    assert_near(shadow_reference_light(&stage.reference, on_the_second, 0.01), 0.7, 1e-6);
    stage_close(&stage);
}

// Every straight way through a bent ribbon crosses it once: no joint is counted twice or left out.
static void exact_light_meets_a_joint_once(void **state)
{
    (void)state;
    enum { VERTICES = 12 };
    Strands strands;
    Stage stage;
    NEEDED(strands_create(&strands, 1, VERTICES, error));
    strands.first[1] = VERTICES;
    for (int j = 0; j < VERTICES; ++j) {
        strands.position[j][0] = 0.5f * cosf(0.3f * (float)j);
        strands.position[j][2] = 0.5f * sinf(0.3f * (float)j);
        strands.position[j][1] = 0.03f * (float)j;
    }
    stage_open(&stage, strands, 0.05f, 0.4f, NULL, &ABOVE);
    for (int i = 5; i < 595; ++i) // not at the ends, which are square
        for (int k = -4; k <= 4; ++k) {
            double angle = 3.3 * i / 600, r = 0.495 + 0.01 * k;
            assert_near(exact_at(&stage, r * cos(angle), -1, r * sin(angle)), 0.6, 1e-6);
        }
    stage_close(&stage);
}

static void exact_light_ends_at_the_mesh(void **state)
{
    (void)state;
    Stage stage;
    Mesh mesh = make_square(-0.05f, 0.3f);
    stage_open(&stage, make_layers(2), 0.01f, 0.3f, &mesh, &ABOVE);
    assert_near(exact_at(&stage, 0.1, -0.04, 0), 0.7, 1e-6);
    assert_near(exact_at(&stage, 0.1, -0.06, 0), 0, 0);
    assert_near(exact_at(&stage, 0.1, -0.06, 0.299), 0, 0);
    assert_near(exact_at(&stage, 0.4, -0.2, 0), 0.49, 1e-6);
    stage_close(&stage);
    mesh_destroy(&mesh);
}

static const Light LAMP = {.kind = LIGHT_POINT,
                           .position = {0.3f, 2, 0.1f},
                           .color = {1, 1, 1},
                           .intensity = 1,
                           .distance = 1,
                           .shadow = true};

// Before a lamp what lies half as far off is twice as large: behind a fibre at half the way to the
// plane y = -2 the shadow is twice as wide.
static void exact_light_of_a_lamp_spreads(void **state)
{
    (void)state;
    Stage stage;
    stage_open(&stage, make_layers(1), 0.01f, 0.3f, NULL, &LAMP);
    double x = 2 * 0.1 - 0.3;                      // below the fibre's point 0.1
    for (double side = -1; side <= 1; side += 2) { // the fibre's middle lies at z = -0.1 there
        assert_near(exact_at(&stage, x, -2, -0.1 + side * 0.0199), 0.7, 1e-6);
        assert_near(exact_at(&stage, x, -2, -0.1 + side * 0.0203), 1, 0);
    }
    assert_near(exact_at(&stage, x, 0.01, -0.1), 1, 0);
    assert_near(exact_at(&stage, 0.3, 3, 0.1), 1, 0); // behind the lamp
    stage_close(&stage);
}

// Strands much wider than a texel, so that what is smoothed is beside them. In each gap the layer
// before lies wholly before the point, whatever the map's own layers are; the rest is the rounding
// of sums to steps of 2^-16, some thousand of them, and points that share a texel.
static void layers_of_hair_multiply(void **state)
{
    (void)state;
    Stage stage;
    for (int lamp = 0; lamp < 2; ++lamp) {
        stage_open(&stage, make_layers(5), 0.06f, 0.3f, NULL, lamp ? &LAMP : &ABOVE);
        draw_maps(&stage, SHADOW_DOM, 256, 1);
        expect_light(&stage, 0.1f, 1, 0, 1, 1e-6);
        for (int n = 1; n <= 5; ++n) {
            float y = 0.05f - 0.1f * (float)n;
            assert_near(exact_at(&stage, 0.1, (double)y, 0), pow(0.7, n), 1e-6);
            expect_light(&stage, 0.1f, y, 0, pow(0.7, n), 0.03);
            expect_light(&stage, 0.1f, y, 0.2f, 1, 1e-6);
        }
        expect_light(&stage, 3, -2, 0, 1, 0); // beside the map
        stage_close(&stage);
    }
}

// The other scheme supposes fibres at even distances. Where they are, it has the exact light behind
// n of them, within the steps of its depths.
static void approximated_layers_multiply_at_even_distances(void **state)
{
    (void)state;
    const float radius = 0.06f, distance = 0.1f;
    Stage stage;
    stage_open(&stage, make_layers(5), radius, 0.3f, NULL, &ABOVE);
    draw_maps(&stage, SHADOW_APPROX, 256, distance / radius);
    for (int n = 1; n <= 4; ++n) {
        float y = 0.001f - distance * (float)n;
        assert_near(exact_at(&stage, 0.1, (double)y, 0), pow(0.7, n), 1e-6);
        expect_light(&stage, 0.1f, y, 0, pow(0.7, n), 0.01);
        expect_light(&stage, 0.1f, y, 0.2f, 1, 1e-6);
    }
    stage_close(&stage);
}

// Behind one fibre both schemes have its opacity, and before it all light.
static void one_fibre_takes_its_opacity(void **state)
{
    (void)state;
    for (Shadow kind = SHADOW_APPROX; kind <= SHADOW_DOM; ++kind) {
        Stage stage;
        stage_open(&stage, make_layers(1), 0.06f, 0.4f, NULL, &ABOVE);
        draw_maps(&stage, kind, 256, 1e5f);
        expect_light(&stage, 0.1f, 0.1f, 0, 1, 1e-6);
        expect_light(&stage, 0.1f, -0.1f, 0, 0.6, 0.02);
        expect_light(&stage, 0.1f, -0.1f, 0.3f, 1, 1e-6);
        stage_close(&stage);
    }
}

static void mesh_stands_in_the_light(void **state)
{
    (void)state;
    Mesh mesh = make_square(-0.05f, 0.3f);
    for (int lamp = 0; lamp < 2; ++lamp) {
        Stage stage;
        stage_open(&stage, make_layers(2), 0.06f, 0.3f, &mesh, lamp ? &LAMP : &ABOVE);
        draw_maps(&stage, SHADOW_DOM, 256, 1);
        expect_light(&stage, 0.1f, -0.04f, 0, 0.7, 0.03); // before it
        expect_light(&stage, 0.1f, -0.06f, 0, 0, 1e-6);   // behind it
        expect_light(&stage, 0.1f, -0.08f, 0.25f, 0, 1e-6);
        expect_light(&stage, 0.1f, -0.08f, 0.4f, 1, 1e-6); // beside it
        stage_close(&stage);
    }
    mesh_destroy(&mesh);
}

// Thickness and opacity that a file has: the first strand grows from 1 to 3 radii, the second one
// lets half as much through as the material says.
static void shadows_are_as_wide_and_dark_as_the_paint(void **state)
{
    (void)state;
    enum { VERTICES = 5 };
    Stage stage;
    Strands strands = make_layers(2);
    for (int v = VERTICES; v < 2 * VERTICES; ++v) strands.position[v][2] = 0.5f;
    stage_open(&stage, strands, 0.03f, 0.4f, NULL, &ABOVE);
    float color[2 * VERTICES][4], thickness[2 * VERTICES];
    for (int v = 0; v < 2 * VERTICES; ++v) {
        for (int k = 0; k < 4; ++k) color[v][k] = k == 3 && v >= VERTICES ? 0.5f : 1;
        thickness[v] = v < VERTICES ? 1 + 0.5f * (float)v : 2;
    }
    const Paint paint = {.color = color, .thickness = thickness, .vertex_count = 2 * VERTICES};
    NEEDED(hair_paint(&stage.hair, &strands, &paint, &fixture_gpu()->limits, error));
    stage.item.paint = &paint;
    shadow_reference_destroy(&stage.reference);
    NEEDED(shadow_reference_create(&stage.reference, &stage.reference_scene, &ABOVE,
                                   (const float[3]){0}, error));
    for (Shadow kind = SHADOW_APPROX; kind <= SHADOW_DOM; ++kind) {
        draw_maps(&stage, kind, 256, 1e5f);
        const float places[][2] = {{-0.4f, 0.015f}, {-0.4f, 0.06f}, {0.4f, 0.06f},
                                   {0.4f, 0.12f},   {0, 0.48f},     {0, 0.6f}};
        for (size_t i = 0; i < 6; ++i) {
            float x = places[i][0], z = places[i][1];
            if (kind == SHADOW_APPROX && z > 0.4f) continue; // it knows the mean opacity only
            expect_light(&stage, x, -0.3f, z, exact_at(&stage, (double)x, -0.3, (double)z), 0.02);
        }
    }
    assert_near(exact_at(&stage, 0, -0.3, 0.48), 0.8, 1e-6); // 1 - 0.5 * 0.4
    stage_close(&stage);
}

// A bent strand of three particles as a B-spline, which passes its corner at two thirds of the way.
static void smooth_strands_cast_the_shadow_of_their_curve(void **state)
{
    (void)state;
    Stage stage;
    Strands strands;
    NEEDED(strands_create(&strands, 1, 3, error));
    strands.first[1] = 3;
    const float corners[3][3] = {{-0.5f, 0, 0}, {0, 0, 0.5f}, {0.5f, 0, 0}};
    memcpy(strands.position, corners, sizeof corners);
    stage_open(&stage, strands, 0.03f, 0.4f, NULL, &ABOVE);
    Look *look = &stage.casters[0].look;
    for (Shadow kind = SHADOW_APPROX; kind <= SHADOW_DOM; ++kind)
        for (uint parts = 1; parts <= 20; parts += 19) {
            look->material.smooth_parts = parts;
            look->material.smooth_curve = CURVE_BSPLINE;
            look->features = parts > 1 ? LOOK_SMOOTH : 0;
            draw_maps(&stage, kind, 256, 1e5f);
            expect_light(&stage, 0, -0.1f, 1 / 3.0f, parts > 1 ? 0.6 : 1, 0.02);
            expect_light(&stage, -0.1f, -0.1f, 0.4f, parts > 1 ? 1 : 0.6, 0.02);
        }
    stage_close(&stage);
}

// Three eighths of four strands side by side: one and a half, wider by the inverse share.
static void strands_left_out_cast_no_shadow(void **state)
{
    (void)state;
    Stage stage;
    Strands strands = make_layers(4);
    for (uint32_t v = 0; v < strands.vertex_count; ++v) {
        strands.position[v][2] = -2 * strands.position[v][1];
        strands.position[v][1] = 0;
    }
    stage_open(&stage, strands, 0.02f, 0.4f, NULL, &ABOVE);
    Look *look = &stage.casters[0].look;
    look->share = 0.375f; // one and a half
    look->material.radius /= look->share;
    for (Shadow kind = SHADOW_APPROX; kind <= SHADOW_DOM; ++kind) {
        draw_maps(&stage, kind, 256, 1e5f);
        expect_light(&stage, 0, -0.1f, 0.04f, 0.6, 0.02);         // 0.053 to each side
        expect_light(&stage, 0, -0.1f, 0.015f + 0.2f, 0.6, 0.02); // 0.027 to each side
        expect_light(&stage, 0, -0.1f, 0.04f + 0.2f, 1, 0.02);
        expect_light(&stage, 0, -0.1f, 0.4f, 1, 0);
    }
    uint32_t drawn = stage.shadow.maps_drawn;
    GpuTimer timer;
    gpu_timer_create(&timer, false, true);
    assert_int_equal(drawn, 1);
    for (uint32_t pass = 0; pass < 2; ++pass) { // a share that changes makes them anew
        NEEDED(render_shadow_draw(&stage.shadow, &stage.scene, &timer, error));
        assert_int_equal(stage.shadow.maps_drawn, pass);
        look->share = 0.5f;
    }
    gpu_timer_destroy(&timer);
    stage_close(&stage);
}

static void maps_are_kept_while_nothing_changes(void **state)
{
    (void)state;
    Stage stage;
    GpuTimer timer;
    gpu_timer_create(&timer, false, true);
    stage_open(&stage, make_layers(2), 0.06f, 0.3f, NULL, &ABOVE);
    draw_maps(&stage, SHADOW_DOM, 64, 1);
    const struct {
        uint64_t revision;
        float way;
        uint32_t drawn;
    } pictures[] = {{1, 0, 0},    {2, 0, 1},    {2, 0, 0},   {2, 0.5f, 1},
                    {2, 0.5f, 0}, {0, 0.5f, 1}, {0, 0.5f, 1}};
    assert_int_equal(stage.shadow.maps_drawn, 1);
    for (size_t i = 0; i < sizeof pictures / sizeof *pictures; ++i) {
        stage.scene.revision = pictures[i].revision;
        stage.light.direction[0] = pictures[i].way;
        NEEDED(render_shadow_draw(&stage.shadow, &stage.scene, &timer, error));
        assert_int_equal(stage.shadow.maps_drawn, pictures[i].drawn);
    }
    stage.light.shadow = false;
    NEEDED(render_shadow_draw(&stage.shadow, &stage.scene, &timer, error));
    assert_int_equal(stage.shadow.maps_drawn, 0);
    expect_light(&stage, 0.1f, -0.5f, 0, 1, 0);
    stage_close(&stage);
    gpu_timer_destroy(&timer);
}

static void broken_positions_leave_the_rest_its_shadow(void **state)
{
    (void)state;
    const float values[] = {NAN, INFINITY, -1e30f, 1e7f};
    for (size_t i = 0; i < sizeof values / sizeof *values; ++i) {
        Stage stage;
        Strands strands = make_layers(2);
        strands.position[7][i % 3] = values[i];
        stage_open(&stage, strands, 0.06f, 0.4f, NULL, &ABOVE);
        draw_maps(&stage, SHADOW_DOM, 256, 1);
        expect_light(&stage, 0.1f, -0.05f, 0, 0.6, 0.02);
        stage_close(&stage);
    }
}

typedef struct Fit {
    double rms, bias;
} Fit;

// Against the exact light at every 7th vertex. Most of the difference is the exact light's own
// noise: it steps by the opacity at every fibre's edge, the maps average over texels.
static Fit judge(Stage *stage)
{
    const Strands *strands = &stage->strands;
    uint32_t count = 0;
    float(*points)[4] = malloc((strands->vertex_count / 7 + 1) * sizeof *points);
    assert_non_null(points);
    for (uint32_t v = 0; v < strands->vertex_count; v += 7, ++count)
        memcpy(points[count], strands->position[v], 12);
    stage->on_fibre = true;
    float *shares = light_left(stage, (const float(*)[4])points, count);
    Fit fit = {0};
    for (uint32_t i = 0; i < count; ++i) {
        const double x[3] = {(double)points[i][0], (double)points[i][1], (double)points[i][2]};
        double off = (double)shares[i] -
                     shadow_reference_light(&stage->reference, x, (double)stage->item.radius);
        fit.rms += off * off / count;
        fit.bias += off / count;
    }
    fit.rms = sqrt(fit.rms);
    free(points);
    free(shares);
    return fit;
}

// The bounds are the figures as measured (docs/renderer.md), and a little more.
static void deep_maps_are_near_the_exact_light(void **state)
{
    (void)state;
    const struct {
        StrandsStyle style;
        uint32_t count, vertices;
        double rms;
    } sets[] = {{STRANDS_STYLE_STRAIGHT, 10000, 32, 0.2},
                {STRANDS_STYLE_CURLS, 10000, 32, 0.19},
                {STRANDS_STYLE_FUR, 37747, 8, 0.22}};
    Light light = ABOVE;
    memcpy(light.direction, (float[3]){0.36f, 0.8f, 0.48f}, sizeof light.direction);
    for (size_t i = 0; i < sizeof sets / sizeof *sets; ++i) {
        StrandsRecipe recipe = strands_recipe_default(sets[i].style);
        Strands strands;
        Stage stage;
        recipe.count = sets[i].count, recipe.vertices = sets[i].vertices;
        NEEDED(strands_make(&strands, &recipe, error));
        stage_open(&stage, strands, fibre_auto_radius(&strands, 0), 0.33f, NULL, &light);
        draw_maps(&stage, SHADOW_DOM, 256, 200);
        Fit deep = judge(&stage);
        draw_maps(&stage, SHADOW_APPROX, 256, 200);
        Fit approximated = judge(&stage);
        print_message("%u x %u: off by %.3f (mean %+.3f) dom, %.3f (%+.3f) approx\n", recipe.count,
                      recipe.vertices, deep.rms, deep.bias, approximated.rms, approximated.bias);
        assert_true(deep.rms < sets[i].rms && fabs(deep.bias) < 0.02);
        assert_true(deep.rms < approximated.rms);
        stage_close(&stage);
    }
}

// The same light but for rounding. A point that is rounded to another texel takes a quarter (the
// middle of 1 2 1 each way) of the optical depth of two texels of fibre, 0.4 each, with it: 0.2 at
// most. One that is read in the next layer lacks no more of its own, half of 0.4. Places of 128
// texels are known to 1e-5 texels, so that one point of 1e5 is, and no more of the sum than that.
static void expect_same_light(const float *a, const float *b, uint32_t count)
{
    double most = 0, sum = 0;
    for (uint32_t i = 0; i < count; ++i) {
        double off = fabs((double)a[i] - (double)b[i]);
        most = fmax(most, off), sum += off / count;
    }
    if (!(most < 0.2 && sum < 1e-5)) fail_msg("off by %g, in the mean %g", most, sum);
}

// What C has found at each vertex; the caller frees it.
static float *light_found(const Stage *stage)
{
    const HairBatch *batch = &stage->hair.batches[0];
    const ParticleLight *lights;
    uint32_t count, n = batch->vertex_count;
    assert_true(render_shadow_hair_lights(&stage->shadow.hair, &lights, &count));
    assert_int_equal(count, 1);
    float *left = malloc((size_t)lights->left.size), *shares = malloc((size_t)lights->left.size);
    assert_true(left && shares);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, lights->left.buffer);
    glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)lights->left.size, left);
    for (uint32_t s = 0; s < batch->strand_count; ++s)
        for (uint32_t j = 0; j < n; ++j)
            shares[stage->strands.first[batch->strand[s]] + j] = left[hair_address(batch, s, j)];
    free(left);
    return shares;
}

// C and shaders make the same maps of fur and curls, finer and wider than texels, and find the same
// light by them.
static void c_and_shaders_are_alike(void **state)
{
    (void)state;
    const Light lights[] = {ABOVE, LAMP};
    for (int i = 0; i < 8; ++i) {
        StrandsRecipe recipe =
            strands_recipe_default(i & 1 ? STRANDS_STYLE_CURLS : STRANDS_STYLE_FUR);
        Strands strands;
        Stage stage;
        recipe.count = 1001, recipe.vertices = 16; // the last tile is not full
        NEEDED(strands_make(&strands, &recipe, error));
        float radius = (i & 2 ? 8 : 1) * fibre_auto_radius(&strands, 0);
        stage_open(&stage, strands, radius, 0.33f, NULL, &lights[i / 4]);
        stage.on_fibre = true;
        uint32_t count = strands.vertex_count;
        float(*points)[4] = malloc(count * sizeof *points);
        assert_non_null(points);
        for (uint32_t v = 0; v < count; ++v) memcpy(points[v], strands.position[v], 12);
        for (Shadow kind = SHADOW_APPROX; kind <= SHADOW_DOM; ++kind) {
            float *shares[3];
            for (int way = 0; way < 2; ++way) {
                by_processor = way;
                draw_maps(&stage, kind, 128, 200);
                shares[way] = light_left(&stage, (const float(*)[4])points, count);
            }
            expect_same_light(shares[0], shares[1], count);
            shares[2] = kind == SHADOW_DOM ? light_found(&stage) : NULL;
            if (shares[2]) expect_same_light(shares[1], shares[2], count);
            for (int k = 0; k < 3; ++k) free(shares[k]);
        }
        free(points);
        stage_close(&stage);
    }
}

// Sums are integers, and the least of some depths is the same in any order.
static void c_makes_the_same_maps_with_any_thread_count(void **state)
{
    (void)state;
    enum { SIDE = 64, TEXELS = SIDE * SIDE, STRANDS = 10 * STRAND_TILE, N = 6 };
    static float position[STRANDS * N][4], depths[2][TEXELS];
    static uint32_t layers[2][TEXELS * SHADOW_LAYERS];
    Random random = random_create(7, 0);
    for (int i = 0; i < STRANDS * N; ++i) {
        for (int k = 0; k < 3; ++k) position[i][k] = (float)random_real(&random);
        position[i][3] = 1;
    }
    const CpuCaster caster = {.position = (const float(*)[4])position,
                              .material = {.radius = 0.005f,
                                           .tip_ratio = 0.5f,
                                           .shadow_opacity = 0.5f,
                                           .vertex_count = N,
                                           .drawn_strands = STRANDS - 3,
                                           .last_strand = STRANDS - 4,
                                           .last_share = 0.4f}};
    const CastParams params = {
        .side = SIDE,
        .unit = 1000,
        .texels = SIDE,
        .from_world = {{SIDE, 0, 0, 0}, {0, SIDE, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
    CpuShadow shadow;
    NEEDED(cpu_shadow_create(&shadow, SIDE, true, error));
    for (int parts = shadow.parts; parts >= 1; --parts) {
        int at = parts == shadow.parts ? 0 : 1;
        CpuShadow some = shadow;
        some.parts = parts;
        cpu_shadow_draw_deep(&some, &params, (CpuCasters){&caster, 1}, depths[at], layers[at]);
        assert_memory_equal(depths[at], depths[0], sizeof depths[0]);
        assert_memory_equal(layers[at], layers[0], sizeof layers[0]);
    }
    const int middle = TEXELS / 2 + SIDE / 2; // where there is hair
    assert_true(depths[0][middle] < 1 && layers[0][TEXELS * (SHADOW_LAYERS - 1) + middle] != 0);
    cpu_shadow_destroy(&shadow);
}

int main(void)
{
    const struct CMUnitTest exact[] = {
        cmocka_unit_test(exact_light_multiplies_through_layers),
        cmocka_unit_test(exact_light_meets_a_joint_once),
        cmocka_unit_test(exact_light_ends_at_the_mesh),
        cmocka_unit_test(exact_light_of_a_lamp_spreads),
        cmocka_unit_test(c_and_shaders_are_alike),
        cmocka_unit_test(c_makes_the_same_maps_with_any_thread_count),
    };
    const struct CMUnitTest maps[] = {
        cmocka_unit_test(layers_of_hair_multiply),
        cmocka_unit_test(approximated_layers_multiply_at_even_distances),
        cmocka_unit_test(one_fibre_takes_its_opacity),
        cmocka_unit_test(mesh_stands_in_the_light),
        cmocka_unit_test(shadows_are_as_wide_and_dark_as_the_paint),
        cmocka_unit_test(smooth_strands_cast_the_shadow_of_their_curve),
        cmocka_unit_test(strands_left_out_cast_no_shadow),
        cmocka_unit_test(maps_are_kept_while_nothing_changes),
        cmocka_unit_test(broken_positions_leave_the_rest_its_shadow),
        cmocka_unit_test(deep_maps_are_near_the_exact_light),
    };
    int failed = cmocka_run_group_tests(exact, NULL, NULL);
    failed += cmocka_run_group_tests_name("by shaders", maps, by_shaders, NULL);
    return failed + cmocka_run_group_tests_name("by C", maps, by_c, NULL);
}
