// SPDX-License-Identifier: MIT
// The files of a scene: units and axes of hair and meshes, bodies, messages, and errors with their
// place.
#include "scene/assets.h"
#include "support/scene_reader.h"
#include "support/temporary.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define HAIR "numStrands 1\nis sorted 1\nstrand 0 numVerts 2 texcoord 0.5 0.25\n1 2 3\n1 3 3\n"
#define MESH "v 1 2 3\nv 2 2 3\nv 1 3 3\nf 1 2 3\n"

static void write_files(void **state)
{
    temporary_write(state, "a.tfx", HAIR, 0644);
    temporary_write(state, "both.tfx", "version 2.0\nbothEndsImmovable 1\n" HAIR, 0644);
    temporary_write(state, "twice.tfx",
                    "numStrands 1\nis sorted 1\nstrand 0 numVerts 3 texcoord 0 0\n"
                    "1 2 3\n1 3 3\n1 3 3\n",
                    0644);
    temporary_write(state, "m.obj", MESH, 0644);
    temporary_write(state, "moves_1.obj", MESH, 0644);
    temporary_write(state, "moves_2.obj", "v 1 2 4\nv 2 2 4\nv 1 3 4\nf 1 2 3\n", 0644);
}

static void assert_point(const float *point, double x, double y, double z)
{
    const double expected[3] = {x, y, z};
    for (int k = 0; k < 3; ++k) assert_true(fabs((double)point[k] - expected[k]) < 1e-6);
}

// Loads the files of a scene that must be good. *messages: to be freed.
static void load(Assets *assets, Scene *scene, char **messages)
{
    Error error = {{0}};
    size_t size;
    FILE *stream = messages ? open_memstream(messages, &size) : NULL;
    if (assets_load(assets, scene, stream, false, &error) != RESULT_OK) fail_msg("%s", error.text);
    if (stream) fclose(stream);
}

// A mesh without options has the unit and axis of the hair, each for itself.
static void meshes_have_their_options_or_those_of_the_hair(void **state)
{
    static const struct {
        const char *options;
        double point[3]; // of the vertex 1 2 3
    } cases[] = {{"", {0.01, 0.03, -0.02}},
                 {"--mesh-unit m", {1, 3, -2}},
                 {"--mesh-up y", {0.01, 0.02, 0.03}},
                 {"--mesh-unit mm --mesh-up y", {0.001, 0.002, 0.003}}};
    write_files(state);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        char line[1200];
        Scene scene;
        Assets assets;
        snprintf(line, sizeof line, "%s --unit cm --up z --mesh %s %s -o x.png",
                 temporary_path(state, "a.tfx"), temporary_path(state, "m.obj"), cases[i].options);
        assert_read(&scene, line);
        load(&assets, &scene, NULL);
        assert_int_equal(assets.section_count, 1);
        assert_int_equal(assets.strands[0].vertex_count, 2);
        assert_point(assets.strands[0].position[0], 0.01, 0.03, -0.02);
        assert_point(assets.strands[0].position[1], 0.01, 0.03, -0.03);
        assert_int_equal(assets.body_count, 1);
        assert_int_equal(assets.meshes[0].vertex_count, 3);
        assert_int_equal(assets.meshes[0].triangle_count, 1);
        const double *p = cases[i].point;
        assert_point(assets.meshes[0].position[0], p[0], p[1], p[2]);
        assert_null(scene.bodies[0].shape);
        assert_null(assets.environment.parts);
        assets_destroy(&assets);
        scene_destroy(&scene);
    }
}

// Each body has its own mesh, in the unit of its own first section; a mesh that deforms moves the
// head of its body only.
static void bodies_have_meshes_of_their_own(void **state)
{
    Scene scene;
    Assets assets;
    Error error = {{0}};
    write_files(state);
    Result result =
        read_scene(state, &scene,
                   "{\"bodies\": ["
                   "{\"mesh\": \"m.obj\", \"sections\": [{\"file\": \"a.tfx\", \"unit\": \"cm\", "
                   "\"up\": \"y\"}]},"
                   "{\"sections\": [{\"file\": \"a.tfx\", \"unit\": \"m\", \"up\": \"y\"}]},"
                   "{\"mesh\": \"moves_%d.obj\", \"sections\": [{\"file\": \"a.tfx\", \"unit\": "
                   "\"mm\", \"up\": "
                   "\"y\"}, {\"file\": \"both.tfx\", \"unit\": \"mm\", \"up\": \"y\"}]}]}",
                   &error);
    if (result != RESULT_OK) fail_msg("%s", error.text);
    load(&assets, &scene, NULL);
    assert_int_equal(assets.section_count, 4);
    assert_int_equal(assets.body_count, 3);
    assert_point(assets.meshes[0].position[0], 0.01, 0.02, 0.03);
    assert_int_equal(assets.meshes[1].vertex_count, 0);
    assert_point(assets.meshes[2].position[0], 0.001, 0.002, 0.003);
    for (uint32_t b = 0; b < 3; ++b) {
        assert_ptr_equal(scene.bodies[b].shape, b == 2 ? &assets.bodies[2] : NULL);
        assert_true((scene.bodies[b].head.samples != NULL) == (b == 2));
    }
    assets_destroy(&assets);
    scene_destroy(&scene);
}

// Hair and a mesh from memory take the place of files. They are copied, in metres and with y up,
// whatever the options say; a mesh that deforms moves its head.
static void hair_and_meshes_may_come_from_memory(void **state)
{
    write_files(state);
    for (int deforms = 0; deforms < 2; ++deforms) {
        char line[1200];
        Scene scene;
        Assets files, assets;
        snprintf(line, sizeof line, "%s --unit m --up y --mesh %s -o x.png",
                 temporary_path(state, "a.tfx"), temporary_path(state, "m.obj"));
        assert_read(&scene, line);
        load(&files, &scene, NULL);
        const GivenMesh given = {.mesh = files.meshes[0], .deforms = deforms};
        scene.bodies[0].given_mesh = &given;
        scene.sections[0].given = &files.strands[0];
        snprintf(scene.bodies[0].params.mesh, 2, "x");
        load(&assets, &scene, NULL);
        assert_memory_equal(assets.strands[0].position, files.strands[0].position, 24);
        assert_int_equal(assets.meshes[0].vertex_count, 3);
        assert_memory_equal(assets.meshes[0].position, files.meshes[0].position, 36);
        assert_memory_equal(assets.meshes[0].triangle, files.meshes[0].triangle, 12);
        assert_ptr_not_equal(assets.meshes[0].position, files.meshes[0].position);
        assert_ptr_equal(scene.bodies[0].shape, deforms ? &assets.bodies[0] : NULL);
        assets_destroy(&assets);
        assets_destroy(&files);
        scene_destroy(&scene);
    }
}

static void messages_name_the_file(void **state)
{
    char line[1200], *text;
    Scene scene;
    Assets assets;
    write_files(state);
    const char *const names[] = {"both.tfx", "twice.tfx", "a.tfx"}, *const parts[] = {"both ends",
                                                                                      "", NULL};
    for (int i = 0; i < 3; ++i) {
        const char *path = temporary_path(state, names[i]);
        snprintf(line, sizeof line, "%s --unit m --up y --environment assets/studio.pfm -o x.png",
                 path);
        assert_read(&scene, line);
        load(&assets, &scene, &text);
        assert_non_null(assets.environment.parts);
        assert_true((strstr(text, path) != NULL) == (parts[i] != NULL));
        if (parts[i]) assert_non_null(strstr(text, parts[i]));
        free(text);
        assets_destroy(&assets);
        scene_destroy(&scene);
    }
}

// The hair of a.tfx grows on m.obj if both have the same unit.
static void hair_away_from_its_mesh_gets_a_message(void **state)
{
    static const struct {
        const char *options, *mesh, *part; // part of the message; NULL: there is none
    } cases[] = {
        {"--unit m", "m.obj", NULL},
        {"--unit cm", "m.obj", NULL},
        {"--unit cm --mesh-unit cm", "m.obj", NULL},
        {"--unit m --mesh-unit cm", "m.obj", "with --mesh-unit m it fits\n"},
        {"--unit m --mesh-unit 0.3", "m.obj", "with --mesh-unit m it fits\n"},
        {"--unit cm --mesh-unit m", "m.obj", "with --unit m it fits\n"},
        {"--unit in --mesh-unit m", "m.obj", "with --unit m it fits\n"},
        {"--unit cm", "metres.obj", "with --mesh-unit m it fits\n"},
        // 2 % of a diagonal of sqrt(2) m are 28 mm
        {"--unit m", "near.obj", NULL},
        {"--unit m", "far.obj",
         "more than 0.03 m from this mesh, which is 1.4 m across: expected "
         "the mesh on which the hair was groomed"},
        {"--unit m", "flat.obj", NULL},
    };
    write_files(state);
    temporary_write(state, "metres.obj",
                    "v 0.01 0.02 0.03\nv 0.02 0.02 0.03\nv 0.01 0.03 0.03\nf 1 2 3\n", 0644);
    temporary_write(state, "near.obj", "v 1 2 3.026\nv 2 2 3.026\nv 1 3 3.026\nf 1 2 3\n", 0644);
    // The root is 0.03 m beside the middle of the triangle's side, far from all vertices.
    temporary_write(state, "far.obj", "v 1.03 1.5 3\nv 2.03 1.5 3\nv 1.03 2.5 3\nf 1 2 3\n", 0644);
    temporary_write(state, "flat.obj", "v 5 5 5\nv 6 5 5\nv 7 5 5\nf 1 2 3\n", 0644);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        char line[1200], *text;
        const char *mesh = temporary_path(state, cases[i].mesh);
        Scene scene;
        Assets assets;
        snprintf(line, sizeof line, "%s %s --mesh %s -o x.png", temporary_path(state, "a.tfx"),
                 cases[i].options, mesh);
        assert_read(&scene, line);
        load(&assets, &scene, &text);
        if (cases[i].part) {
            assert_non_null(strstr(text, cases[i].mesh));
            if (!strstr(text, cases[i].part)) fail_msg("'%s' lacks '%s'", text, cases[i].part);
        } else {
            assert_string_equal(text, "");
        }
        free(text);
        assets_destroy(&assets);
        scene_destroy(&scene);
    }
}

// The roots are 0.1 to 0.9 m in front of the triangle.
static void the_message_about_hair_has_the_median_distance(void **state)
{
    enum { COUNT = 9 };
    char line[1200], hair[100 * COUNT] = "numStrands 9\nis sorted 1\n", *text;
    Scene scene;
    Assets assets;
    write_files(state);
    for (int i = 1; i <= COUNT; ++i)
        snprintf(hair + strlen(hair), 100,
                 "strand %d numVerts 2 texcoord 0 0\n1.1 2.1 3.%d\n1.1 2.1 %d\n", i - 1, i, i + 4);
    temporary_write(state, "spread.tfx", hair, 0644);
    snprintf(line, sizeof line, "%s --unit m --mesh %s -o x.png",
             temporary_path(state, "spread.tfx"), temporary_path(state, "m.obj"));
    assert_read(&scene, line);
    load(&assets, &scene, &text);
    if (!strstr(text, "half of the roots are more than 0.5 m from this mesh")) fail_msg("%s", text);
    free(text);
    assets_destroy(&assets);
    scene_destroy(&scene);
}

static void errors_name_the_file(void **state)
{
    static const char *const CASES[][2] = {
        // options after the hair, part of the message
        {"--mesh nowhere.obj", "nowhere.obj"},
        {"--mesh nowhere_%d.obj", "nowhere_%d.obj"},
        {"--environment nowhere.exr", "nowhere.exr"},
        {"--group 3", "a.tfx: --group: "},
    };
    write_files(state);
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; ++i) {
        char line[1200];
        Scene scene;
        Assets assets;
        Error error = {{0}};
        snprintf(line, sizeof line, "%s %s -o x.png", temporary_path(state, "a.tfx"), CASES[i][0]);
        assert_read(&scene, line);
        assert_true(assets_load(&assets, &scene, NULL, false, &error) != RESULT_OK);
        if (!strstr(error.text, CASES[i][1])) fail_msg("'%s' lacks '%s'", error.text, CASES[i][1]);
        assets_destroy(&assets);
        scene_destroy(&scene);
    }
}

// --check goes through all files, whatever is wrong with one of them; the result is the worst.
static void a_check_reports_every_file(void **state)
{
    static const struct {
        const char *files[3];
        Result result;
    } cases[] = {{{"a.tfx", "both.tfx", "a.tfx"}, RESULT_OK},
                 {{"twice.tfx", "a.tfx", "both.tfx"}, RESULT_FAILED},
                 {{"twice.tfx", "nowhere.tfx", "a.tfx"}, RESULT_BAD_INPUT},
                 {{"nowhere.tfx", "a.tfx", "twice.tfx"}, RESULT_BAD_INPUT}};
    write_files(state);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        const char *const *f = cases[i].files;
        char scene_text[400], *text, *at;
        size_t size;
        Scene scene;
        Error error = {{0}};
        snprintf(scene_text, sizeof scene_text,
                 "{\"sections\": [{\"file\": \"%s\"}, {\"file\": \"%s\"}, {\"file\": \"%s\"}]}",
                 f[0], f[1], f[2]);
        assert_int_equal(read_scene(state, &scene, scene_text, &error), RESULT_OK);
        FILE *stream = open_memstream(&text, &size);
        assert_int_equal(assets_check(&scene, stream), cases[i].result);
        fclose(stream);
        at = text;
        for (int k = 0; k < 3; ++k) {
            at = strstr(at, f[k]);
            assert_non_null(at);
            at = strchr(at, '\n');
        }
        free(text);
        scene_destroy(&scene);
    }
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, temporary_create, temporary_destroy)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(meshes_have_their_options_or_those_of_the_hair),
        TEST(bodies_have_meshes_of_their_own),
        TEST(hair_and_meshes_may_come_from_memory),
        TEST(messages_name_the_file),
        TEST(hair_away_from_its_mesh_gets_a_message),
        TEST(the_message_about_hair_has_the_median_distance),
        TEST(errors_name_the_file),
        TEST(a_check_reports_every_file),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
