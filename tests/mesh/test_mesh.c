// SPDX-License-Identifier: MIT
// Meshes from Wavefront and PLY files, and meshes made by the program.
#include "formats/mesh_read.h"
#include "formats/obj.h"
#include "mesh/mesh.h"
#include "mesh/scalp.h"
#include "support/temporary.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static Result read_text(void **state, Mesh *mesh, const char *text, bool up_z, Error *error)
{
    temporary_write(state, "m.obj", text, 0644);
    return mesh_read(mesh, temporary_path(state, "m.obj"), 1.0f, up_z, error);
}

static Mesh read_good(void **state, const char *text, bool up_z)
{
    Mesh mesh;
    Error error = {""};
    if (read_text(state, &mesh, text, up_z, &error) != RESULT_OK) fail_msg("%s", error.text);
    return mesh;
}

#define SQUARE "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"

static void all_forms_of_faces_give_the_same_square(void **state)
{
    static const char *const texts[] = {
        SQUARE "f 1 2 3 4\n",
        "# a comment\r\no thing\r\n" SQUARE "s 1\r\nf 1 2 3 4 # another\r\n",
        SQUARE "vt 0 0\nvt 1 0\nf 1/1 2/2 3/1 4/2\n",
        SQUARE "vt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1 4/1/1",
        SQUARE "vn 0 0 2\nf 1//1 2//1 3//1 4//-1\n",
        SQUARE "f -4 -3 -2 -1\n",
        SQUARE "f 1 2 \\\n3 \\\r\n4\n",
        ("f 1 2 3 4\n" SQUARE),
        "v 0 0 0 1.0\nv\t1 0 0\n  v 1 1 0 0.5 0.5 0.5\nv 0 1e0 0\nf 1 2 3\nf 1 3 4\n",
    };
    static const uint32_t expected[2][3] = {{0, 1, 2}, {0, 2, 3}};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        Mesh mesh = read_good(state, texts[i], false);
        assert_int_equal(mesh.vertex_count, 4);
        assert_int_equal(mesh.triangle_count, 2);
        assert_memory_equal(mesh.triangle, expected, sizeof expected);
        for (int v = 0; v < 4; v++) assert_memory_equal(mesh.normal[v], ((float[3]){0, 0, 1}), 12);
        mesh_destroy(&mesh);
    }
}

static void z_up_turns_positions_and_normals(void **state)
{
    Mesh mesh = read_good(state, SQUARE "vn 0 0 1\nf 1//1 2//1 3//1 4\n", true);
    assert_true(mesh.position[2][0] == 1.0f && mesh.position[2][2] == -1.0f);
    for (int v = 0; v < 4; v++) assert_true(mesh.normal[v][1] > 0.999f);
    mesh_destroy(&mesh);
}

static void texture_coordinates_belong_to_corners(void **state)
{
    Mesh mesh =
        read_good(state, SQUARE "vt 0 0.25\nvt 1\nvt 1 1 0\nf 1/1 2/2 3/3\nf 1 3/3 4/-3\n", false);
    static const float uv[3][2] = {{0.0f, 0.25f}, {1.0f, 0.0f}, {1.0f, 1.0f}};
    static const uint32_t expected[2][3] = {{0, 1, 2}, {MESH_NO_UV, 2, 0}};
    assert_int_equal(mesh.uv_count, 3);
    assert_memory_equal(mesh.uv, uv, sizeof uv);
    assert_memory_equal(mesh.triangle_uv, expected, sizeof expected);
    mesh_destroy(&mesh);
    mesh = read_good(state, SQUARE "vt 0 0\nf 1 2 3\n", false);
    assert_null(mesh.uv);
    mesh_destroy(&mesh);
}

#define PLY(format, vertices, faces, list)                                                         \
    "ply\nformat " format " 1.0\ncomment x\nelement vertex " #vertices "\nproperty float x\n"      \
    "property float y\nproperty float z\nproperty uchar red\nelement face " #faces                 \
    "\nproperty list uchar int " list "\nend_header\n"

static void all_forms_of_ply_give_the_same_square(void **state)
{
    static const float corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    static const uint32_t expected[2][3] = {{0, 1, 2}, {0, 2, 3}};
    for (int form = 0; form < 4; form++) {
        const char *path = temporary_path(state, "m.ply");
        FILE *file = fopen(path, "wb");
        fputs(form == 0   ? PLY("ascii", 4, 1, "vertex_indices")
              : form == 1 ? PLY("ascii", 4, 2, "vertex_index")
              : form == 2 ? PLY("binary_little_endian", 4, 1, "vertex_indices")
                          : PLY("binary_big_endian", 4, 1, "vertex_indices"),
              file);
        if (form < 2) {
            for (int v = 0; v < 4; v++)
                fprintf(file, "%g %g %g 7\n", (double)corners[v][0], (double)corners[v][1],
                        (double)corners[v][2]);
            fputs(form == 0 ? "4 0 1 2 3\n" : "3 0 1 2\n3 0 2 3\n", file);
        }
        for (int i = 0; form >= 2 && i < 17;
             i++) { // 12 numbers with a byte behind three, 4 corners
            uint8_t bytes[4] = {0};
            const uint32_t corner = (uint32_t)(i - 13);
            if (i < 12) memcpy(bytes, &corners[i / 3][i % 3], 4);
            if (i > 12) memcpy(bytes, &corner, 4);
            for (int k = 0; k < 4 && i != 12; k++) fputc(bytes[form == 2 ? k : 3 - k], file);
            if (i < 12 && i % 3 == 2) fputc(7, file);
            if (i == 12) fputc(4, file);
        }
        fclose(file);
        Mesh mesh;
        Error error = {""};
        if (mesh_read(&mesh, path, 2.0f, true, &error) != RESULT_OK) fail_msg("%s", error.text);
        assert_int_equal(mesh.vertex_count, 4);
        assert_int_equal(mesh.triangle_count, 2);
        assert_memory_equal(mesh.triangle, expected, sizeof expected);
        for (int v = 0; v < 4; v++) { // y becomes -z
            assert_true(mesh.position[v][0] == 2 * corners[v][0]);
            assert_true(mesh.position[v][2] == -2 * corners[v][1]);
            assert_memory_equal(mesh.normal[v], ((float[3]){0, 1, 0}), 12);
        }
        mesh_destroy(&mesh);
    }
}

// A strip of two triangles, and one of one: every other triangle is turned round.
static void strips_of_ply_are_triangles(void **state)
{
    Mesh mesh;
    static const uint32_t wanted[3][3] = {{0, 1, 2}, {2, 1, 3}, {0, 2, 3}};
    temporary_write(state, "m.ply",
                    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                    "property float z\nelement tristrips 1\n"
                    "property list int int vertex_indices\nend_header\n"
                    "0 0 0\n1 0 0\n0 1 0\n1 1 0\n8 0 1 2 3 -1 0 2 3\n",
                    0644);
    assert_int_equal(mesh_read(&mesh, temporary_path(state, "m.ply"), 1, false, NULL), RESULT_OK);
    assert_int_equal(mesh.triangle_count, 3);
    assert_memory_equal(mesh.triangle, wanted, sizeof wanted);
    mesh_destroy(&mesh);
}

static void malformed_ply_is_refused_with_its_line(void **state)
{
    static const struct {
        const char *text, *why;
    } cases[] = {
        {PLY("ascii", 3, 1, "vertex_indices") "0 0 0 0\n1 0 0 0\n0 1 0 0\n3 0 1 3\n",
         "m.ply:15: face 0 has corner 3: expected less than 3"},
        {PLY("ascii", 3, 1, "vertex_indices") "0 0 0 0\n1 0 nan 0\n0 1 0 0\n3 0 1 2\n",
         "m.ply:13:"},
        {PLY("ascii", 3, 1, "vertex_indices") "0 0 0 0\n1 0 1e30 0\n0 1 0 0\n3 0 1 2\n",
         "a coordinate of vertex 1 is NaN, infinite or beyond 1e18"},
        {PLY("ascii", 3, 1, "vertex_indices") "0 0 0 0\n1 0 0 0\n0 1 0 0\n", "m.ply:"},
        {PLY("ascii", 3, 1, "corners") "0 0 0 0\n1 0 0 0\n0 1 0 0\n3 0 1 2\n",
         "faces without vertex_indices"},
        {PLY("ascii", 3, 0, "vertex_indices") "0 0 0 0\n1 0 0 0\n0 1 0 0\n",
         "no faces: expected a mesh"},
        {"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n",
         "vertices without x, y and z"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Mesh mesh;
        Error error = {""};
        temporary_write(state, "m.ply", cases[i].text, 0644);
        assert_int_equal(mesh_read(&mesh, temporary_path(state, "m.ply"), 1, false, &error),
                         RESULT_BAD_INPUT);
        if (!strstr(error.text, cases[i].why))
            fail_msg("'%s' lacks '%s'", error.text, cases[i].why);
        mesh_destroy(&mesh);
    }
}

static void other_files_are_refused_with_what_makes_a_mesh_of_them(void **state)
{
    static const char *const cases[][2] = {
        {"glTF\x02", "m.obj: GLB, not a mesh: bake it: blender -b --python "
                     "scripts/blender_hair.py -- export FILE --mesh x.npz --frames scene"},
        {"PXR-USDC", "m.obj: binary USD (.usdc), not a mesh: convert it: usdcat FILE -o x.usda"},
        {"Kaydara FBX Binary", "m.obj: FBX, not a mesh: bake it"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Mesh mesh;
        Error error = {""};
        assert_int_equal(read_text(state, &mesh, cases[i][0], false, &error), RESULT_BAD_INPUT);
        if (!strstr(error.text, cases[i][1])) fail_msg("'%s' lacks '%s'", error.text, cases[i][1]);
        mesh_destroy(&mesh);
    }
}

static void malformed_files_are_refused_with_their_line(void **state)
{
    static const struct {
        const char *text, *message;
    } cases[] = {
        {"", "1: no faces: expected a mesh (tractrix-render takes hair without --mesh)"},
        {SQUARE, "5: no faces: expected a mesh (tractrix-render takes hair without --mesh)"},
        {"v 0 0\nf 1 1 1\n", "1: expected a vertex's coordinate, got the end of the line"},
        {"v 0 0 nan\n", "1: expected a vertex's coordinate, got 'nan'"},
        {"v 0 x 0\n", "1: expected a vertex's coordinate, got 'x'"},
        {SQUARE "f 1 2\n", "5: a face of 2 corners: expected at least 3"},
        {SQUARE "f 1 2 5\n\n",
         "5: a face uses vertex 5: expected at most 4, the number in the file"},
        {SQUARE "f 1//1 2//1 3//2\nvn 0 0 1\n",
         "5: a face uses normal 2: expected at most 1, the number in the file"},
        {SQUARE "vt 0 0\nf 1/1 2/1 3/2\n",
         "6: a face uses texture coordinate 2: expected at most 1, the number in the file"},
        {SQUARE "vt 0 inf\n", "5: expected a texture coordinate, got 'inf'"},
        {SQUARE "f 1 2 0\n",
         "5: expected a corner v, v/t, v//n or v/t/n with an index in range, got '0'"},
        {SQUARE "f 1 2 -5\n",
         "5: expected a corner v, v/t, v//n or v/t/n with an index in range, got '-5'"},
        {SQUARE "f 1 2 3/x\n",
         "5: expected a corner v, v/t, v//n or v/t/n with an index in range, got '3/x'"},
        {SQUARE "f 1 2 99999999999999999999\n",
         "5: expected a corner v, v/t, v//n or v/t/n with an index in range, got "
         "'99999999999999999999'"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Mesh mesh;
        Error error = {""};
        assert_int_equal(read_text(state, &mesh, cases[i].text, false, &error), RESULT_BAD_INPUT);
        const char *place = strstr(error.text, "m.obj:");
        assert_non_null(place);
        assert_string_equal(place + strlen("m.obj:"), cases[i].message);
    }
}

static void every_truncation_is_read_or_refused(void **state)
{
    static const char text[] = SQUARE "vt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 \\\n3/1/1 4/1/1\n";
    for (size_t length = 0; length < sizeof text; length++) {
        char part[sizeof text];
        memcpy(part, text, length);
        part[length] = 0;
        Mesh mesh;
        Error error = {""};
        Result result = read_text(state, &mesh, part, false, &error);
        assert_true(result == RESULT_OK || (result == RESULT_BAD_INPUT && error.text[0]));
        mesh_destroy(&mesh);
    }
}

static void written_meshes_read_back_bit_for_bit(void **state)
{
    Mesh mesh, back;
    assert_int_equal(scalp_make_mesh(&mesh, SCALP_HEAD, 12, NULL), RESULT_OK);
    const char *path = temporary_path(state, "head.obj");
    assert_int_equal(obj_write_mesh(path, &mesh, NULL), RESULT_OK);
    assert_int_equal(mesh_read(&back, path, 1.0f, false, NULL), RESULT_OK);
    assert_int_equal(back.vertex_count, mesh.vertex_count);
    assert_int_equal(back.triangle_count, mesh.triangle_count);
    assert_memory_equal(back.position, mesh.position, 12 * (size_t)mesh.vertex_count);
    assert_memory_equal(back.triangle, mesh.triangle, 12 * (size_t)mesh.triangle_count);
    assert_int_equal(back.uv_count, mesh.uv_count);
    assert_memory_equal(back.uv, mesh.uv, 8 * (size_t)mesh.uv_count);
    assert_memory_equal(back.triangle_uv, mesh.triangle_uv, 12 * (size_t)mesh.triangle_count);
    mesh_destroy(&mesh);
    mesh_destroy(&back);
}

// Every edge of a closed mesh belongs to two triangles, once in each direction; Euler's formula: V
// - E + F = 2.
static void the_sphere_is_closed_and_faces_outwards(void **state)
{
    (void)state;
    Mesh mesh;
    assert_int_equal(scalp_make_mesh(&mesh, SCALP_SPHERE, 10, NULL), RESULT_OK);
    int64_t sum = 0;
    for (uint32_t t = 0; t < mesh.triangle_count; t++)
        for (int i = 0; i < 3; i++) {
            int64_t a = mesh.triangle[t][i], b = mesh.triangle[t][(i + 1) % 3];
            sum += (a - b) * (1 + a * b);
        }
    assert_int_equal(sum, 0);
    assert_int_equal(mesh.vertex_count + mesh.triangle_count - mesh.triangle_count * 3 / 2, 2);
    for (uint32_t v = 0; v < mesh.vertex_count; v++) {
        const float *p = mesh.position[v], *n = mesh.normal[v];
        assert_true(p[0] * n[0] + p[1] * n[1] + p[2] * n[2] > 0.0f);
    }
    mesh_destroy(&mesh);
}

// Longitude changes by a 20th over each sector, also at the seam; vertices have the latitude.
static void shapes_have_longitude_and_latitude(void **state)
{
    (void)state;
    Mesh mesh;
    assert_int_equal(scalp_make_mesh(&mesh, SCALP_SPHERE, 10, NULL), RESULT_OK);
    for (uint32_t t = 0; t < mesh.triangle_count; t++) {
        float low = 2, high = -1;
        for (int i = 0; i < 3; i++) {
            const float *uv = mesh.uv[mesh.triangle_uv[t][i]];
            const float *p = mesh.position[mesh.triangle[t][i]];
            double u = (double)uv[0], pi = 3.14159265358979323846, x = (double)p[0];
            double flat = sqrt(x * x + (double)p[2] * (double)p[2]);
            assert_true(fabs((double)p[1] - 0.1 * sin(pi * ((double)uv[1] - 0.5))) < 1e-6);
            assert_true(fabs(x - flat * sin(2 * pi * (u - 0.5))) < 1e-6);
            low = fminf(low, uv[0]), high = fmaxf(high, uv[0]);
        }
        assert_true(low >= 0 && high <= 1 && high - low < 0.0501f);
    }
    mesh_destroy(&mesh);
}

static void bundled_head_is_read(void **state)
{
    (void)state;
    Mesh mesh;
    float low[3], high[3];
    assert_int_equal(mesh_read(&mesh, "assets/head.obj", 1.0f, false, NULL), RESULT_OK);
    mesh_bounds(&mesh, low, high);
    assert_true(mesh.triangle_count >= 5000 && mesh.triangle_count <= 20000);
    assert_true(high[1] - low[1] > 0.35f && high[1] - low[1] < 0.45f);
    mesh_destroy(&mesh);
}

static void real_head_is_read(void **state)
{
    (void)state;
    const char *path = "../shared/assets/sintel.obj";
    if (access(path, R_OK) != 0) {
        print_message("%s is not here: skipped\n", path);
        skip();
    }
    Mesh mesh;
    assert_int_equal(mesh_read(&mesh, path, 0.01f, false, NULL), RESULT_OK);
    assert_int_equal(mesh.vertex_count, 3046);
    assert_int_equal(mesh.triangle_count, 5952);
    for (uint32_t v = 0; v < mesh.vertex_count; v++) {
        const float *n = mesh.normal[v];
        assert_true(fabsf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] - 1.0f) < 1e-5f);
    }
    mesh_destroy(&mesh);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, temporary_create, temporary_destroy)
    const struct CMUnitTest tests[] = {
        TEST(all_forms_of_faces_give_the_same_square),
        TEST(z_up_turns_positions_and_normals),
        TEST(texture_coordinates_belong_to_corners),
        TEST(all_forms_of_ply_give_the_same_square),
        TEST(strips_of_ply_are_triangles),
        TEST(malformed_ply_is_refused_with_its_line),
        TEST(other_files_are_refused_with_what_makes_a_mesh_of_them),
        TEST(malformed_files_are_refused_with_their_line),
        TEST(every_truncation_is_read_or_refused),
        TEST(written_meshes_read_back_bit_for_bit),
        TEST(the_sphere_is_closed_and_faces_outwards),
        TEST(shapes_have_longitude_and_latitude),
        TEST(bundled_head_is_read),
        TEST(real_head_is_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
