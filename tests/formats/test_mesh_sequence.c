// SPDX-License-Identifier: MIT
// Animated meshes: reading files, and positions between samples.
#include "formats/mesh_sequence.h"
#include "formats/npy_array.h"
#include "formats/zip.h"
#include "support/temporary.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define FACE "f 1 2 3\n"

static const MeshSequenceOptions OPTIONS = {
    .otherwise_unit = 1, .up_z = -1, .rest = "", .otherwise_rate = 24};

// Three vertices in two samples.
static const float SAMPLES[2][3][3] = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                                       {{0, 0, 1}, {1, 0, 2}, {0, 1, 3}}};

static Result read(MeshSequence *sequence, Mesh *mesh, const char *path,
                   const MeshSequenceOptions *options, Error *error)
{
    Mesh rest = {0};
    assert_true(mesh_sequence_matches(path));
    Result result = mesh_sequence_read(sequence, mesh, &rest, path, options, error);
    mesh_destroy(&rest);
    return result;
}

// Checks that the file contains SAMPLES, or is refused with `why` in the message.
static void expect(const char *path, const MeshSequenceOptions *options, const char *why)
{
    MeshSequence sequence;
    Mesh mesh;
    Error error = {""};
    Result result = read(&sequence, &mesh, path, options, &error);
    if (why) {
        assert_int_equal(result, RESULT_BAD_INPUT);
        if (!strstr(error.text, why)) fail_msg("'%s' lacks '%s'", error.text, why);
    } else {
        if (result != RESULT_OK) fail_msg("%s", error.text);
        assert_int_equal(sequence.times.count, 2);
        assert_int_equal(mesh.triangle_count, 1);
        assert_memory_equal(mesh.triangle[0], ((const uint32_t[3]){0, 1, 2}), 12);
        const float *numbers = sequence.position[0];
        for (int i = 0; i < 18; ++i) assert_true(numbers[i] == ((const float *)SAMPLES)[i]);
    }
    mesh_sequence_destroy(&sequence);
    mesh_destroy(&mesh);
}

static void numbered_obj_files_are_samples(void **state)
{
    const char *path = temporary_path(state, "m_%03d.obj");
    temporary_write(state, "m_004.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n" FACE, 0644);
    temporary_write(state, "m_005.obj", "v 0 0 1\nv 1 0 2\nv 0 1 3\n" FACE, 0644);
    expect(path, &OPTIONS, NULL);
    temporary_write(state, "m_007.obj", "v 0 0 1\nv 1 0 2\nv 0 1 3\n" FACE, 0644);
    expect(path, &OPTIONS, "m_006.obj: missing: expected files for samples 4 to 7 without gaps");
    temporary_write(state, "m_006.obj", "v 0 0 1\nv 1 0 2\n" FACE, 0644);
    expect(path, &OPTIONS, "m_006.obj");
    temporary_write(state, "m_006.obj", "v 0 0 1\nv 1 0 2\nv 0 1 3\nv 5 5 5\n" FACE, 0644);
    expect(path, &OPTIONS, "m_006.obj: 4 vertices: expected 3 as in");
    temporary_write(state, "m_006.obj", "v 0 0 1\nv 1 0 2\nv 0 1 3\nf 1 3 2\n", 0644);
    expect(path, &OPTIONS, "m_006.obj: triangle 1 has other corners than in");
    temporary_write(state, "m_006.obj", "v 0 0 1\nv 1 0 nan\nv 0 1 3\n" FACE, 0644);
    expect(path, &OPTIONS, "m_006.obj:2:");
    expect(temporary_path(state, "other_%d.obj"), &OPTIONS, "no file has such a name");
}

static void put(FILE *file, const void *data, size_t size)
{
    assert_int_equal(fwrite(data, 1, size, file), size);
}

static uint32_t swap(uint32_t word)
{
    return word >> 24 | (word >> 8 & 0xff00) | (word << 8 & 0xff0000) | word << 24;
}

// Writes the first `size` bytes of a file; if `bad`, the number of a sample is not finite.
static const char *write_points(void **state, const char *name, bool mdd, bool bad, size_t size)
{
    char bytes[200] = "POINTCACHE2";
    size_t at = mdd ? 0 : 12;
    const uint32_t head[] = {1, 3, 0, 0x3f800000, 2}, short_head[] = {swap(2), swap(3)};
    memcpy(bytes + at, mdd ? short_head : head, mdd ? sizeof short_head : sizeof head);
    at += mdd ? sizeof short_head : sizeof head;
    float times[2] = {1, 1.1f};
    for (int i = 0; i < 2 && mdd; ++i) {
        uint32_t word;
        memcpy(&word, &times[i], 4);
        word = swap(word);
        memcpy(bytes + at, &word, 4);
        at += 4;
    }
    for (int i = 0; i < 18; ++i, at += 4) {
        float number = bad && i == 13 ? NAN : ((const float *)SAMPLES)[i];
        uint32_t word;
        memcpy(&word, &number, 4);
        if (mdd) word = swap(word);
        memcpy(bytes + at, &word, 4);
    }
    const char *path = temporary_path(state, name);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    put(file, bytes, size < at ? size : at);
    fclose(file);
    return path;
}

static void point_caches_take_faces_from_the_rest_pose(void **state)
{
    MeshSequenceOptions options = OPTIONS;
    temporary_write(state, "rest.obj", "v 9 0 0\nv 1 0 0\nv 0 1 0\n" FACE, 0644);
    char rest[300];
    snprintf(rest, sizeof rest, "%s", temporary_path(state, "rest.obj"));
    for (int mdd = 0; mdd < 2; ++mdd) {
        const char *name = mdd ? "p.mdd" : "p.pc2";
        options.rest = "";
        expect(write_points(state, name, mdd, false, 1000), &options,
               "no faces: expected a mesh (tractrix-render takes hair without --mesh), or "
               "--mesh-rest");
        options.rest = rest;
        expect(write_points(state, name, mdd, false, 1000), &options, NULL);
        expect(write_points(state, name, mdd, true, 1000), &options,
               "sample 1: a coordinate of vertex 1 is NaN, infinite or beyond 1e18");
        for (size_t size = mdd ? 4 : 12; size < 86; size += 7)
            expect(write_points(state, name, mdd, false, size), &options, name);
    }
    // MDD files contain the times of samples: a tenth of a second apart.
    MeshSequence sequence;
    Mesh mesh;
    Error error;
    assert_int_equal(
        read(&sequence, &mesh, write_points(state, "p.mdd", true, false, 1000), &options, &error),
        RESULT_OK);
    assert_true(fabs(sequence.times.rate - 10) < 1e-5);
    mesh_sequence_destroy(&sequence);
    mesh_destroy(&mesh);
}

static void add_array(ZipWriter *zip, const char *name, const char *type, const uint64_t *shape,
                      uint32_t axes, const void *data, size_t size)
{
    char header[NPY_HEADER_SIZE];
    size_t head = npy_array_header(header, type, shape, axes);
    zip_add(zip, name, header, head, data, size);
}

// Coordinates in millimetres, z up. `broken`: a third triangle begins with a corner that is
// missing; `bad`: a negative unit.
static const char *write_npz(void **state, const char *name, bool broken, bool bad)
{
    int16_t points[2][3][3] = {{{0}}};
    const int32_t faces[3][3] = {{0, 1, 2}, {0, 1, 2}, {3, 1, 2}};
    const double fps = 12, unit = bad ? -1 : 1;
    const uint64_t shape[3] = {2, 3, 3}, face_shape[2] = {broken ? 3 : 1, 3};
    const char up[4] = {'z', 0, 0, 0};
    for (int i = 0; i < 6; ++i) { // with z up, (x, y, z) becomes (x, -z, y)
        const float *p = ((const float(*)[3])SAMPLES)[i];
        const int16_t turned[3] = {(int16_t)p[0], (int16_t)-p[2], (int16_t)p[1]};
        memcpy(((int16_t(*)[3])points)[i], turned, sizeof turned);
    }
    const char *path = temporary_path(state, name);
    OutFile file;
    assert_int_equal(outfile_open(&file, path, NULL), RESULT_OK);
    ZipWriter zip = {.out = &file};
    add_array(&zip, "positions.npy", "<i2", shape, 3, points, sizeof points);
    add_array(&zip, "faces.npy", "<i4", face_shape, 2, faces, face_shape[0] * sizeof *faces);
    add_array(&zip, "fps.npy", "<f8", shape, 0, &fps, sizeof fps);
    add_array(&zip, "unit.npy", "<f8", shape, 0, &unit, sizeof unit);
    add_array(&zip, "up.npy", "<U1", shape, 0, up, sizeof up);
    assert_int_equal(zip_finish(&zip, NULL), RESULT_OK);
    assert_int_equal(outfile_commit(&file, NULL), RESULT_OK);
    return path;
}

static void arrays_of_numpy_say_faces_rate_unit_and_axes(void **state)
{
    expect(write_npz(state, "a.npz", false, false), &OPTIONS, NULL);
    expect(write_npz(state, "b.npz", true, false), &OPTIONS,
           "triangle 2 has corner 3: expected less than 3");
    expect(write_npz(state, "c.npz", false, true), &OPTIONS, "'unit': expected one number");
    MeshSequence sequence;
    Mesh mesh;
    Error error;
    MeshSequenceOptions options = OPTIONS;
    options.unit = 2; // the user's options take precedence over the file
    options.rate = 7;
    assert_int_equal(
        read(&sequence, &mesh, write_npz(state, "a.npz", false, false), &options, &error),
        RESULT_OK);
    assert_true(sequence.times.rate == 7 && mesh.position[1][0] == 2);
    mesh_sequence_destroy(&sequence);
    mesh_destroy(&mesh);
}

static void splines_are_exact_for_what_is_quadratic(void **state)
{
    (void)state;
    enum { COUNT = 6 };
    float position[COUNT][3];
    for (int linear = 0; linear < 2; ++linear)
        for (uint32_t count = 2; count <= COUNT; ++count) {
            SampleTimes times = {.count = count, .rate = 4, .start = 0.5, .linear = linear};
            MeshSequence sequence = {.times = times, .vertex_count = 1, .position = position};
            for (int i = 0; i < COUNT; ++i)
                position[i][0] = 3.0f * (float)i, position[i][1] = (float)(i * i),
                position[i][2] = -1;
            for (double x = 0; x <= count - 1; x += 0.125) {
                float p[1][3];
                mesh_sequence_evaluate(&sequence, 0.5 + x / 4, p);
                double share = x - floor(x),
                       exact = linear || count == 2
                                   ? floor(x) * floor(x) + share * (2 * floor(x) + 1)
                                   : x * x;
                // Positions of at most 25, a few operations in float32.
                assert_true(fabs((double)p[0][0] - 3 * x) < 1e-5);
                assert_true(fabs((double)p[0][1] - exact) < 1e-5);
                assert_true(p[0][2] == -1);
            }
            // Constant before the first and after the last sample.
            float p[1][3];
            mesh_sequence_evaluate(&sequence, -3, p);
            assert_memory_equal(p, position[0], sizeof p);
            mesh_sequence_evaluate(&sequence, 99, p);
            assert_memory_equal(p, position[count - 1], sizeof p);
        }
}

static void a_cut_holds_and_jumps(void **state)
{
    (void)state;
    float position[5][3] = {{0}, {1}, {4}, {100}, {105}}; // x of five samples
    bool cut[4] = {false, false, true, false};
    MeshSequence sequence = {
        .times = {.count = 5, .rate = 1, .cut = cut}, .vertex_count = 1, .position = position};
    float p[1][3];
    mesh_sequence_evaluate(&sequence, 1.5, p); // continues the parabola x^2
    assert_true(fabsf(p[0][0] - 2.25f) < 1e-6f);
    mesh_sequence_evaluate(&sequence, 2.999, p);
    assert_true(p[0][0] == 4);
    mesh_sequence_evaluate(&sequence, 3 - 1e-9, p); // the time of a step, rounded
    assert_true(p[0][0] == 100);
    mesh_sequence_evaluate(&sequence, 3.5, p);
    assert_true(fabsf(p[0][0] - 102.5f) < 1e-5f);
}

static void the_shape_tells_rest_from_motion(void **state)
{
    (void)state;
    float position[6][3] = {{0}, {1}, {1}, {1}, {1}, {2}};
    MeshSequence sequence = {
        .times = {.count = 6, .rate = 1}, .vertex_count = 1, .position = position};
    assert_true(mesh_sequence_shape(&sequence, -1) == mesh_sequence_shape(&sequence, 0));
    assert_true(mesh_sequence_shape(&sequence, 0.5) != mesh_sequence_shape(&sequence, 0));
    assert_true(mesh_sequence_shape(&sequence, 2.2) == mesh_sequence_shape(&sequence, 2.8));
    assert_true(mesh_sequence_shape(&sequence, 2) == mesh_sequence_shape(&sequence, 4));
    assert_true(mesh_sequence_shape(&sequence, 6) == mesh_sequence_shape(&sequence, 5));
}

// body.abc, written by Alembic 1.8: a quad and a triangle with five vertices, of which the third
// rises, under a transform that doubles the size and then moves by 1 m along x per sample; a
// triangle at rest; and a hidden triangle.
static void alembic_meshes_are_samples_with_their_transforms(void **state)
{
    (void)state;
    MeshSequence sequence;
    Mesh mesh;
    Error error = {""};
    if (read(&sequence, &mesh, "tests/data/body.abc", &OPTIONS, &error) != RESULT_OK)
        fail_msg("%s", error.text);
    assert_int_equal(sequence.times.count, 4);
    assert_float_equal(sequence.times.rate, 30, 1e-9);
    assert_int_equal(sequence.vertex_count, 8);
    // Alembic's corners are in clockwise order; ours are not.
    const uint32_t triangles[4][3] = {{3, 1, 2}, {3, 0, 1}, {2, 1, 4}, {5, 6, 7}};
    assert_int_equal(mesh.triangle_count, 4);
    assert_memory_equal(mesh.triangle, triangles, sizeof triangles);
    for (uint32_t i = 0; i < 4; ++i) {
        const float(*p)[3] = (const float(*)[3])mesh_sequence_at(&sequence, i);
        assert_float_equal(p[2][0], 2 + 0.5 * i, 1e-6);
        assert_float_equal(p[2][2], 0.5 * i, 1e-6);
        assert_float_equal(p[4][0], 4 + 0.5 * i, 1e-6);
        assert_float_equal(p[7][1], 6, 1e-6);
    }
    mesh_sequence_destroy(&sequence);
    mesh_destroy(&mesh);
    expect("tests/data/curves.abc", &OPTIONS, "hair and no visible mesh");
}

#define USD_HEAD                                                                                   \
    "#usda 1.0\n(\n    metersPerUnit = 0.5\n    upAxis = \"Z\"\n    timeCodesPerSecond = 30\n)\n"
#define USD_FACES                                                                                  \
    "        int[] faceVertexCounts = [3]\n        int[] faceVertexIndices = [0, 1, 2]\n"

// SAMPLES in units of half a metre with z up, under a transform that moves by (2, 4, 6).
static void points_of_usd_are_samples_with_their_transforms(void **state)
{
    static const char *const move =
        "def Xform \"Body\"\n{\n    double3 xformOp:translate = (2, 4, 6)\n"
        "    uniform token[] xformOpOrder = [\"xformOp:translate\"]\n";
    char text[3000];
    const char *path = temporary_path(state, "m.usda");
    snprintf(text, sizeof text,
             "%s%s    def Mesh \"Skin\"\n    {\n%s        point3f[] points = [(9, 9, 9)]\n"
             "        point3f[] points.timeSamples = {\n"
             "            1: [(-2, -4, -6), (0, -4, -6), (-2, -4, -4)],\n"
             "            3: [(-2, -6, -6), (0, -8, -6), (-2, -10, -4)],\n        }\n    }\n"
             "    def Mesh \"Proxy\"\n    {\n        uniform token purpose = \"proxy\"\n%s"
             "        point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]\n    }\n}\n",
             USD_HEAD, move, USD_FACES, USD_FACES);
    temporary_write(state, "m.usda", text, 0644);
    expect(path, &OPTIONS, NULL);
    MeshSequence sequence;
    Mesh mesh;
    Error error = {""};
    assert_int_equal(read(&sequence, &mesh, path, &OPTIONS, &error), RESULT_OK);
    assert_float_equal(sequence.times.rate, 15, 1e-9); // every second of 30 time codes per second
    assert_int_equal(mesh.triangle[0][1], 1);
    mesh_sequence_destroy(&sequence);
    mesh_destroy(&mesh);
}

static void meshes_of_usd_that_cannot_be_taken_are_refused_with_their_line(void **state)
{
    static const struct {
        const char *body, *why;
    } cases[] = {
        {USD_FACES "point3f[] points = [(0, 0, 0), (1, 0, 0)]\n",
         "m.usda:10: faceVertexIndices: 2: expected a vertex from 0 to 1"},
        {USD_FACES "point3f[] points.timeSamples = {\n1: [(0, 0, 0), (1, 0, 0), (0, 1, 0)],\n"
                   "2: [(0, 0, 0)],\n}\n",
         "m.usda:13: the sample at 2 has 1 vertices: expected 3 as in the first one"},
        {USD_FACES "point3f[] points.timeSamples = {\n1: [(0, 0, 0), (1, 0, 0), (0, nan, 0)],\n}\n",
         "m.usda: sample 0: a coordinate of vertex 2 is NaN"},
        {"point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]\n",
         "m.usda:9: a mesh without faceVertexCounts"},
        {"int[] faceVertexCounts = [4]\nint[] faceVertexIndices = [0, 1, 2]\n"
         "point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]\n",
         "face 0 has 4 corners: expected at most 3"},
        {"int[] faceVertexCounts = [3]\nint[] faceVertexIndices.timeSamples = {\n1: [0, 1, 2],\n"
         "2: [0, 2, 1],\n}\npoint3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]\n",
         "m.usda:12: faceVertexIndices: the faces change: expected the same faces in all samples"},
        {USD_FACES "point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]\n"
                   "int[] primvars:skel:jointIndices = [0, 0, 0]\n",
         "a mesh that a skeleton moves: expected baked points"},
        {"}\nclass Mesh \"C\"\n{\n" USD_FACES
         "point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]\n",
         "no visible Mesh prim"},
        {"", "no Mesh prim with points"},
        {"references = @x@\n}\ndef Xform \"A\" (\nreferences = @other.usda@\n)\n{\n",
         "references are not read: expected one layer"},
    };
    char text[2000];
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        snprintf(text, sizeof text, USD_HEAD "def Mesh \"M\"\n{\n%s}\n", cases[i].body);
        temporary_write(state, "m.usda", text, 0644);
        expect(temporary_path(state, "m.usda"), &OPTIONS, cases[i].why);
    }
    snprintf(text, sizeof text,
             USD_HEAD "def BasisCurves \"H\"\n{\nint[] curveVertexCounts = [2]\n"
                      "point3f[] points = [(0, 0, 0), (1, 0, 0)]\n}\n");
    temporary_write(state, "m.usda", text, 0644);
    expect(temporary_path(state, "m.usda"), &OPTIONS, "hair, not a mesh");
    // Corners in clockwise order are reversed; faces that are given for several times and are equal
    // are accepted.
    snprintf(text, sizeof text,
             USD_HEAD "def Mesh \"M\"\n{\nuniform token orientation = \"leftHanded\"\n"
                      "int[] faceVertexCounts.timeSamples = {\n1: [3],\n2: [3],\n}\n"
                      "int[] faceVertexIndices = [0, 2, 1]\n"
                      "point3f[] points.timeSamples = {\n1: [(0, 0, 0), (2, 0, 0), (0, 0, 2)],\n"
                      "2: [(0, -2, 0), (2, -4, 0), (0, -6, 2)],\n}\n}\n");
    temporary_write(state, "m.usda", text, 0644);
    expect(temporary_path(state, "m.usda"), &OPTIONS, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(numbered_obj_files_are_samples, temporary_create,
                                        temporary_destroy),
        cmocka_unit_test_setup_teardown(point_caches_take_faces_from_the_rest_pose,
                                        temporary_create, temporary_destroy),
        cmocka_unit_test_setup_teardown(arrays_of_numpy_say_faces_rate_unit_and_axes,
                                        temporary_create, temporary_destroy),
        cmocka_unit_test(alembic_meshes_are_samples_with_their_transforms),
        cmocka_unit_test_setup_teardown(points_of_usd_are_samples_with_their_transforms,
                                        temporary_create, temporary_destroy),
        cmocka_unit_test_setup_teardown(
            meshes_of_usd_that_cannot_be_taken_are_refused_with_their_line, temporary_create,
            temporary_destroy),
        cmocka_unit_test(splines_are_exact_for_what_is_quadratic),
        cmocka_unit_test(a_cut_holds_and_jumps),
        cmocka_unit_test(the_shape_tells_rest_from_motion),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
