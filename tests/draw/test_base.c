// SPDX-License-Identifier: MIT
// Mesh and floor drawn in C against OpenGL: a head under lights of all kinds.
#include "lanes/base.h"

#include "base/random.h"
#include "mesh/head.h"
#include "passes/passes.h"
#include "support/needed.h"
#include "support/stage.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static Light lights[] = {{.direction = {0.48f, 0.6f, 0.64f},
                          .color = {1, 0.9f, 0.8f},
                          .intensity = 0.6f,
                          .shadow = true},
                         {.kind = LIGHT_POINT,
                          .position = {-0.4f, 0.3f, 0.3f},
                          .distance = 0.4f,
                          .color = {0.5f, 0.7f, 1},
                          .intensity = 0.5f},
                         {.kind = LIGHT_SPOT,
                          .position = {0.1f, 0.5f, 0.5f},
                          .direction = {0, -0.70710678f, -0.70710678f},
                          .inner_deg = 5,
                          .outer_deg = 20,
                          .distance = 0.6f,
                          .color = {1, 1, 1},
                          .intensity = 0.5f,
                          .shadow = true}};
static const Ambient AMBIENT = {.sky = {0.8f, 0.9f, 1}, .ground = {0.3f, 0.25f, 0.2f}};
static const float COLOR[3] = {0.8f, 0.6f, 0.5f};

static Mesh head;
static float (*open_sky)[2]; // of the head's vertices
static float (*tint)[3];

enum { STRANDS = 200, VERTICES = 5 };

// Strands around the head on all sides.
static Strands make_hair(void)
{
    static float x[STRANDS * VERTICES][3];
    Random random = random_create(27, 3);
    for (int s = 0; s < STRANDS; ++s) {
        uint32_t root = random_below(&random, head.vertex_count);
        for (int v = 0; v < VERTICES; ++v)
            for (int k = 0; k < 3; ++k)
                x[s * VERTICES + v][k] =
                    head.position[root][k] + 0.012f * (float)v * head.normal[root][k];
    }
    return studio_strands(STRANDS, VERTICES, (const float(*)[3])x);
}

// A copy of the hair's positions for C, and its maps.
typedef struct Shade {
    float (*position)[4];
    MappedCaster caster;
    LaneShadow shadow;
} Shade;

// The camera in front of the head and slightly above it.
static View look(void)
{
    View view = {
        .eye = {0.12f, 0.1f, 0.75f}, .near_distance = 0.1f, .far_distance = 20, .fov = 0.6f};
    glm_lookat(view.eye, (vec3){0, -0.06f, 0}, (vec3){0, 1, 0}, view.view);
    glm_perspective(view.fov, 1, view.near_distance, view.far_distance, view.projection);
    return view;
}

// What OpenGL draws, read back: see BlockBase.
typedef struct Shown {
    int side;
    uint16_t (*light)[4];
    float *depth;
} Shown;

static Shown draw_by_opengl(const RendererOptions *options, const float turn[4], StageSky sky)
{
    View view = look();
    const Ambient around = sky == STAGE_ENVIRONMENT ? stage_ambient(sky) : AMBIENT;
    RenderFrame frame = {.view = &view,
                         .lights = lights,
                         .light_count = sizeof lights / sizeof *lights,
                         .ambient = &around,
                         .head_translation = {0.01f, 0, 0.02f}};
    memcpy(frame.head_rotation, turn, sizeof frame.head_rotation);
    use(options);
    if (options->shadow.kind != SHADOW_NONE && !studio.count) {
        Strands hair = make_hair();
        studio_add(&studio, &hair, 0.002f, 0.5f);
        strands_destroy(&hair);
    }
    Renderer *renderer = &studio.renderer;
    NEEDED(renderer_set_mesh(renderer, &head, COLOR, error));
    NEEDED(renderer_set_openness(renderer, (const float(*)[2])open_sky, error));
    NEEDED(renderer_set_tint(renderer, (const float(*)[3])tint, error));
    NEEDED(renderer_draw(renderer, &frame, studio.items, studio.count, &studio.image, error));
    const RenderTarget *target = &((const Passes *)renderer->state)->target;
    Shown shown = {.side = target->width * target->samples};
    size_t count = (size_t)shown.side * (size_t)shown.side;
    shown.light = malloc(count * sizeof *shown.light);
    shown.depth = malloc(count * sizeof *shown.depth);
    assert_true(shown.light && shown.depth);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, target->base_frame);
    glReadPixels(0, 0, shown.side, shown.side, GL_RGBA, GL_HALF_FLOAT, shown.light);
    glReadPixels(0, 0, shown.side, shown.side, GL_DEPTH_COMPONENT, GL_FLOAT, shown.depth);
    return shown;
}

static void free_shown(Shown *shown)
{
    free(shown->light);
    free(shown->depth);
}

static LaneBaseScene make_scene(const float turn[4])
{
    const Drawing *drawing = &studio.renderer.drawing;
    LaneBaseScene scene = {.mesh = {.position = (const float(*)[3])head.position,
                                    .normal = (const float(*)[3])head.normal,
                                    .open = (const float(*)[2])open_sky,
                                    .tint = (const float(*)[3])tint,
                                    .triangle = (const uint32_t(*)[3])head.triangle,
                                    .vertex_count = head.vertex_count,
                                    .triangle_count = head.triangle_count,
                                    .translation = {0.01f, 0, 0.02f}},
                           .mesh_version = 1,
                           .shading = studio.renderer.options.mesh_shading,
                           .floor = &studio.renderer.options.floor,
                           .draw = &drawing->draw,
                           .mesh_box = drawing->mesh_box,
                           .box = drawing->base_box};
    memcpy(scene.mesh.rotation, turn, sizeof scene.mesh.rotation);
    return scene;
}

// The shadows of the scene that draw_by_opengl has drawn.
static void cast_shadows(Shade *shade, const LaneBaseScene *base)
{
    const Drawing *drawing = &studio.renderer.drawing;
    const HairBatch *batch = &studio.hair[0].batches[0];
    const DrawnMesh *mesh = &studio.renderer.mesh;
    assert_int_equal(studio.hair[0].batch_count, 1);
    *shade = (Shade){.position = malloc((size_t)batch->position.size)};
    assert_non_null(shade->position);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, batch->position.buffer);
    glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)batch->position.size,
                       shade->position);
    shade->caster = (MappedCaster){.position = (const float(*)[4])(void *)shade->position,
                                   .material = look_material(&drawing->looks[0], batch)};
    LaneShadowScene scene = {.lights = lights,
                             .light_count = sizeof lights / sizeof *lights,
                             .casters = {&shade->caster, 1},
                             .mesh = &base->mesh,
                             .mesh_version = 1};
    memcpy(scene.mesh_low, mesh->low, sizeof scene.mesh_low);
    memcpy(scene.mesh_high, mesh->high, sizeof scene.mesh_high);
    drawing_find_middle(&studio.items[0], scene.middle);
    NEEDED(lane_shadow_create(&shade->shadow, &studio.renderer.options.shadow, error));
    NEEDED(lane_shadow_draw(&shade->shadow, &scene, error));
}

static void free_shade(Shade *shade)
{
    lane_shadow_destroy(&shade->shadow);
    free(shade->position);
}

static double half(uint16_t bits)
{
    return bits >> 10 ? ldexp(1024 + (bits & 1023), (bits >> 10 & 31) - 25)
                      : ldexp(bits & 1023, -24);
}

// Largest difference of two pixels' channels, in levels of 255.
static double levels_between(const uint16_t a[4], const uint16_t b[4])
{
    double off = 0;
    for (int c = 0; c < 4; ++c)
        off = fmax(off, fabs(srgb(fmin(half(a[c]), 1)) - srgb(fmin(half(b[c]), 1))));
    return off;
}

// Whether a surface ends among the 3 x 3 pixels around, judged by depth: within a surface, depth
// changes by less than 0.1 mm, 2e-4 here, per pixel.
static bool is_edge(const Shown *shown, int x, int y)
{
    float low = 1, high = 0;
    for (int n = 0; n < 9; ++n) {
        int column = x + n % 3 - 1, row = y + n / 3 - 1;
        if (column < 0 || column >= shown->side || row < 0 || row >= shown->side) continue;
        float z = shown->depth[row * shown->side + column];
        low = fminf(low, z), high = fmaxf(high, z);
    }
    return high - low > 2e-4f;
}

// C rounds vertices to the same 1/256 pixel from sums in another order, so that a sample exactly on
// an edge may fall on the edge's other side: a few edge pixels in ten thousand. All other pixels
// differ only by rounding light to half floats, once in OpenGL and twice in C: one level at most.
static void compare(const Shown *shown, const BlockBase *base)
{
    int off = 0, deep = 0, pixels = base->width * base->height;
    for (int i = 0; i < pixels; ++i) {
        int x = i % base->width + base->x, y = i / base->width + base->y;
        size_t there = (size_t)(y * shown->side + x);
        double levels = levels_between(base->light[i], shown->light[there]);
        bool edge = is_edge(shown, x, y);
        if (levels > 1 && !edge) fail_msg("%d %d: %g levels off", x, y, levels);
        off += levels > 2;
        // The 24 bits of the largest sum that a depth is made of; more where surfaces are steep.
        deep +=
            !(fabs((double)base->depth[i] - (double)shown->depth[there]) < (edge ? 1e-3 : 1e-5));
    }
    if (off > 5 + pixels / 10000) fail_msg("%d of %d px differ", off, pixels);
    if (deep > 5 + pixels / 10000) fail_msg("%d of %d depths differ", deep, pixels);
}

static RendererOptions with(int samples, FloorKind floor, MeshShading shading, Shadow shadow)
{
    RendererOptions options = BLACK;
    options.shadow = (ShadowOptions){.kind = shadow, .side = 128, .spacing = 200};
    options.samples = samples;
    options.background[0] = 0.5f;
    options.mesh_shading = shading;
    options.floor = (Floor){.kind = floor,
                            .middle = {0, -0.25f, 0},
                            .whole = 0.3f,
                            .faded = 0.6f,
                            .color = {0.5f, 0.6f, 0.7f}};
    return options;
}

static const float TURN[4] = {0.0871557f, 0.1736482f, 0.0151f, 0.98083f};

static void c_shows_what_opengl_does(void **state)
{
    (void)state;
    static const struct {
        int samples;
        FloorKind floor;
        MeshShading shading;
        Shadow shadow;
        StageSky sky;
        float radius; // of the sun, degrees
    } cases[] = {{1, FLOOR_NONE, MESH_SKIN, SHADOW_NONE, STAGE_ENVIRONMENT, 0},
                 {1, FLOOR_PLANE, MESH_MATT, SHADOW_DOM, STAGE_SKY, 0},
                 {1, FLOOR_SHADOW, MESH_SKIN, SHADOW_DOM, STAGE_SKY, 8},
                 {2, FLOOR_PLANE, MESH_SKIN, SHADOW_APPROX, STAGE_ENVIRONMENT, 0},
                 {4, FLOOR_NONE, MESH_MATT, SHADOW_NONE, STAGE_ENVIRONMENT, 0}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        RendererOptions options =
            with(cases[i].samples, cases[i].floor, cases[i].shading, cases[i].shadow);
        lights[0].radius = cases[i].radius;
        Shown shown = draw_by_opengl(&options, TURN, cases[i].sky);
        LaneBaseScene scene = make_scene(TURN);
        LaneBase base = {0};
        Shade shade = {0};
        if (cases[i].shadow != SHADOW_NONE) {
            cast_shadows(&shade, &scene);
            scene.shadow = &shade.shadow;
        }
        NEEDED(lane_base_draw(&base, &scene, error));
        compare(&shown, &base.shown);
        lights[0].radius = 0;
        free_shade(&shade);
        lane_base_destroy(&base);
        free_shown(&shown);
    }
}

// Mesh and floor are drawn again only if the camera or vertices change, and then the change is
// visible.
static void it_stays_until_something_changes(void **state)
{
    (void)state;
    RendererOptions options = with(1, FLOOR_PLANE, MESH_SKIN, SHADOW_NONE);
    Shown shown = draw_by_opengl(&options, TURN, STAGE_SKY);
    LaneBaseScene scene = make_scene(TURN);
    LaneBase base = {0};
    DrawParams draw = *scene.draw;
    float(*x)[3] = malloc(head.vertex_count * sizeof *x);
    assert_non_null(x);
    memcpy(x, head.position, head.vertex_count * sizeof *x);
    scene.draw = &draw;
    NEEDED(lane_base_draw(&base, &scene, error));
    NEEDED(lane_base_draw(&base, &scene, error));
    assert_int_equal(base.version, 1);
    const size_t nose = (size_t)((128 - base.shown.y) * base.shown.width + 128 - base.shown.x);
    float before = base.shown.depth[nose];
    for (uint32_t v = 0; v < head.vertex_count; ++v) x[v][2] += 0.05f;
    scene.mesh.position = (const float(*)[3])x;
    ++scene.mesh_version;
    NEEDED(lane_base_draw(&base, &scene, error));
    assert_int_equal(base.version, 2);
    assert_true(base.shown.depth[nose] < before);
    draw.light_color[0][0] = 0;
    NEEDED(lane_base_draw(&base, &scene, error));
    assert_int_equal(base.version, 3);
    free(x);
    free_shown(&shown);
    lane_base_destroy(&base);
}

// A window of the image shows its part of the whole.
static void a_window_shows_its_part(void **state)
{
    (void)state;
    RendererOptions options = with(1, FLOOR_PLANE, MESH_SKIN, SHADOW_NONE);
    Shown shown = draw_by_opengl(&options, TURN, STAGE_SKY);
    Drawing *drawing = &studio.renderer.drawing;
    const int place[2] = {96, 120}, size[2] = {100, 80};
    drawing_set_window(drawing, &studio.renderer.options, &studio.renderer.mesh, place, size);
    LaneBaseScene scene = make_scene(TURN);
    LaneBase base = {0};
    NEEDED(lane_base_draw(&base, &scene, error));
    int off = 0;
    for (int y = 0; y < base.shown.height; ++y)
        for (int x = 0; x < base.shown.width; ++x) {
            const uint16_t *there =
                shown.light[(place[1] + base.shown.y + y) * SIDE + place[0] + base.shown.x + x];
            off += levels_between(base.shown.light[y * base.shown.width + x], there) > 1;
        }
    assert_int_equal(base.shown.width * base.shown.height, size[0] * size[1]);
    assert_true(off <= 8);
    free_shown(&shown);
    lane_base_destroy(&base);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        CLAIM(c_shows_what_opengl_does),
        CLAIM(it_stays_until_something_changes),
        CLAIM(a_window_shows_its_part),
    };
    NEEDED(head_make_mesh(&head, 6000, error));
    open_sky = malloc(head.vertex_count * sizeof *open_sky);
    tint = malloc(head.vertex_count * sizeof *tint);
    for (uint32_t v = 0; open_sky && tint && v < head.vertex_count; ++v) {
        open_sky[v][0] = 0.6f + 0.4f * head.normal[v][1];
        open_sky[v][1] = 0.5f * (1 + open_sky[v][0]);
        for (int k = 0; k < 3; ++k) tint[v][k] = 1 + 0.3f * (float)(k - 1) * head.normal[v][0];
    }
    int failed = open_sky && tint ? stage_run_one(tests, RASTER_QUADS) : 1;
    mesh_destroy(&head);
    free(open_sky);
    free(tint);
    return failed;
}
