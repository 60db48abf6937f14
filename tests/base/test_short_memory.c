// SPDX-License-Identifier: MIT
// Hair, meshes, images and scenes that are read and written while memory is short: in turn, one
// allocation fails each time, also in the libraries. Then the result is an error or what it would
// have been, never a part of it.
#include "base/bytes.h"
#include "formats/format.h"
#include "formats/mesh_read.h"
#include "formats/mesh_sequence.h"
#include "formats/strands_read.h"
#include "gen/strands_make.h"
#include "image/exr_file.h"
#include "image/jpeg.h"
#include "image/pfm.h"
#include "image/png.h"
#include "scene/scene.h"
#include "support/temporary.h"

#include <limits.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// --- Allocations, counted. These functions replace those of the C library, and of
// AddressSanitizer, which then finds what is lost or used after an error.

#ifdef __SANITIZE_ADDRESS__
#define FOR_REAL(name) __interceptor_##name
#else
#define FOR_REAL(name) __libc_##name
#endif
void *FOR_REAL(malloc)(size_t size);
void *FOR_REAL(calloc)(size_t count, size_t size);
void *FOR_REAL(realloc)(void *block, size_t size);

static atomic_int allocations_left = INT_MAX; // before one that fails

static bool fails(void)
{
    return atomic_load(&allocations_left) != INT_MAX && atomic_fetch_sub(&allocations_left, 1) == 0;
}

void *malloc(size_t size)
{
    return fails() ? NULL : FOR_REAL(malloc)(size);
}

void *calloc(size_t count, size_t size)
{
    return fails() ? NULL : FOR_REAL(calloc)(count, size);
}

void *realloc(void *block, size_t size)
{
    return fails() ? NULL : FOR_REAL(realloc)(block, size);
}

enum { MOST_ALLOCATIONS = 1 << 20 };

// A call, which may allocate. `made` has its result: equal bytes are equal results.
typedef struct Trial {
    Result (*call)(void **state, const char *path, Bytes *made, Error *error);
    const char *name; // for messages
} Trial;

// What the test itself allocates does not count.
static int pause_failing(void)
{
    return atomic_exchange(&allocations_left, INT_MAX);
}

static void go_on_failing(int left)
{
    atomic_store(&allocations_left, left);
}

static void append(Bytes *made, const void *data, size_t size)
{
    if (!data) return;
    int left = pause_failing();
    uint8_t *bytes = realloc(made->data, made->size + size + 1);
    assert_non_null(bytes);
    memcpy(bytes + made->size, data, size);
    made->data = bytes;
    made->size += size;
    go_on_failing(left);
}

// Calls once with enough memory, and then once for each allocation of that call.
static void try_all(void **state, const Trial *trial, const char *path)
{
    Bytes whole = {0};
    Error error = {{0}};
    go_on_failing(MOST_ALLOCATIONS);
    if (trial->call(state, path, &whole, &error) != RESULT_OK)
        fail_msg("%s: %s", trial->name, error.text);
    int all = MOST_ALLOCATIONS - pause_failing(), failed = 0;
    for (int i = 0; i < all; ++i) {
        Bytes made = {0};
        error = (Error){{0}};
        go_on_failing(i);
        Result result = trial->call(state, path, &made, &error);
        pause_failing();
        bool same = made.size == whole.size &&
                    (!made.size || memcmp(made.data, whole.data, made.size) == 0);
        if (result == RESULT_OK && !same)
            fail_msg("%s: allocation %d of %d fails, and another result comes", trial->name, i,
                     all);
        if (result != RESULT_OK && (!error.text[0] || strchr(error.text, '\n')))
            fail_msg("%s: allocation %d of %d: '%s' is no line", trial->name, i, all, error.text);
        failed += result != RESULT_OK;
        bytes_destroy(&made);
    }
    if (2 * failed < all) fail_msg("%s: only %d of %d are noticed", trial->name, failed, all);
    bytes_destroy(&whole);
}

// --- Hair.

static Strands make_hair(void)
{
    StrandsRecipe recipe = strands_make_recipe(STRANDS_STYLE_CURLS);
    Strands strands;
    recipe.count = 3;
    recipe.vertices = 5;
    assert_int_equal(strands_make(&strands, &recipe, NULL), RESULT_OK);
    return strands;
}

static Result read_hair(void **state, const char *path, Bytes *made, Error *error)
{
    Strands strands;
    StrandsFrames frames;
    (void)state;
    Result result = strands_read_frames(&strands, &frames, path,
                                        &(StrandsReadOptions){.unit = 1.0f}, NULL, error);
    if (result != RESULT_OK) return result;
    size_t n = strands.strand_count, vertices = strands.vertex_count;
    append(made, strands.first, (n + 1) * sizeof *strands.first);
    append(made, strands.position, vertices * sizeof *strands.position);
#define OF_VERTICES(member, ...) append(made, strands.member, vertices * sizeof *strands.member);
#define OF_STRANDS(member, ...)  append(made, strands.member, n * sizeof *strands.member);
    STRANDS_ARRAYS_OF_VERTICES(OF_VERTICES)
    STRANDS_ARRAYS_OF_STRANDS(OF_STRANDS)
#undef OF_VERTICES
#undef OF_STRANDS
    append(made, frames.position, frames.count * vertices * sizeof *frames.position);
    strands_frames_destroy(&frames);
    strands_destroy(&strands);
    return result;
}

static void hair_is_read_whole_or_not_at_all(void **state)
{
    Strands strands = make_hair();
    for (FormatKind kind = 0; kind < FORMAT_KINDS; kind++) {
        const Format *format = FORMAT_TABLE[kind];
        const char *path = temporary_path(state, "hair");
        if (!format->write) continue;
        assert_int_equal(format_write(path, kind, &strands, NULL), RESULT_OK);
        try_all(state, &(Trial){read_hair, format->name}, path);
    }
    static const char *const FILES[] = {"tests/data/curves.abc", "tests/data/unreal.abc",
                                        "tests/data/groom.abc"};
    for (size_t i = 0; i < sizeof FILES / sizeof *FILES; ++i)
        try_all(state, &(Trial){read_hair, FILES[i]}, FILES[i]);
    strands_destroy(&strands);
}

static FormatKind written;
static Strands hair;

static Result write_hair(void **state, const char *path, Bytes *made, Error *error)
{
    Bytes file;
    Result result = format_write(path, written, &hair, error);
    int left = pause_failing();
    if (result == RESULT_OK) {
        assert_int_equal(bytes_read_file(&file, path, NULL), RESULT_OK);
        append(made, file.data, file.size);
        bytes_destroy(&file);
        remove(path);
    }
    assert_int_equal(temporary_count_files(temporary_path(state, ".")), 0);
    go_on_failing(left);
    return result;
}

static void hair_is_written_whole_or_not_at_all(void **state)
{
    hair = make_hair();
    for (written = 0; written < FORMAT_KINDS; written++) {
        const Format *format = FORMAT_TABLE[written];
        if (format->write)
            try_all(state, &(Trial){write_hair, format->name}, temporary_path(state, "hair"));
    }
    strands_destroy(&hair);
}

// --- Meshes.

static void append_mesh(Bytes *made, const Mesh *mesh)
{
    append(made, mesh->position, mesh->vertex_count * sizeof *mesh->position);
    append(made, mesh->normal, mesh->vertex_count * sizeof *mesh->normal);
    append(made, mesh->triangle, mesh->triangle_count * sizeof *mesh->triangle);
    append(made, mesh->uv, mesh->uv_count * sizeof *mesh->uv);
    append(made, mesh->triangle_uv, mesh->triangle_count * sizeof *mesh->triangle_uv);
}

static Result read_mesh(void **state, const char *path, Bytes *made, Error *error)
{
    Mesh mesh;
    (void)state;
    Result result = mesh_read(&mesh, path, 1, false, error);
    if (result != RESULT_OK) return result;
    append_mesh(made, &mesh);
    mesh_destroy(&mesh);
    return result;
}

static Result read_sequence(void **state, const char *path, Bytes *made, Error *error)
{
    const MeshSequenceOptions options = {
        .otherwise_unit = 1, .up_z = -1, .rest = "", .otherwise_rate = 24};
    MeshSequence sequence = {0};
    Mesh mesh = {0}, rest = {0};
    (void)state;
    Result result = mesh_sequence_read(&sequence, &mesh, &rest, path, &options, error);
    if (result != RESULT_OK) return result;
    append_mesh(made, &mesh);
    append(made, sequence.position,
           sequence.times.count * sequence.vertex_count * sizeof *sequence.position);
    mesh_sequence_destroy(&sequence);
    mesh_destroy(&mesh);
    mesh_destroy(&rest);
    return result;
}

static void meshes_are_read_whole_or_not_at_all(void **state)
{
    static const char OBJ[] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\n"
                              "f 1/1 2/2 3/3\nf 1 3 4\n",
                      PLY[] = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                              "property float y\nproperty float z\nelement face 1\n"
                              "property list uchar int vertex_indices\nend_header\n"
                              "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
                      USD[] = "#usda 1.0\ndef Mesh \"m\" {\nint[] faceVertexCounts = [3]\n"
                              "int[] faceVertexIndices = [0, 1, 2]\n"
                              "point3f[] points.timeSamples = {1: [(0,0,0),(1,0,0),(0,1,0)],"
                              " 2: [(0,0,1),(1,0,1),(0,1,1)]}\n}\n";
    temporary_write(state, "m.obj", OBJ, 0644);
    temporary_write(state, "m.ply", PLY, 0644);
    temporary_write(state, "m.usda", USD, 0644);
    temporary_write(state, "m_1.obj", OBJ, 0644);
    temporary_write(state, "m_2.obj", OBJ, 0644);
    try_all(state, &(Trial){read_mesh, "OBJ"}, temporary_path(state, "m.obj"));
    try_all(state, &(Trial){read_mesh, "PLY"}, temporary_path(state, "m.ply"));
    try_all(state, &(Trial){read_sequence, "USD"}, temporary_path(state, "m.usda"));
    try_all(state, &(Trial){read_sequence, "OBJ files"}, temporary_path(state, "m_%d.obj"));
    try_all(state, &(Trial){read_sequence, "Alembic"}, "tests/data/body.abc");
}

// --- Images: they are encoded and decoded again.

static ImageTexts texts;

static Result keep(Bytes *made, const Bytes *file, Result result)
{
    if (result == RESULT_OK) append(made, file->data, file->size);
    return result;
}

static Result keep_image(Bytes *made, Image *image, Result result)
{
    if (result == RESULT_OK) append(made, image->pixels, image_size(image));
    image_destroy(image);
    return result;
}

static void make_image(Image *image, ImageKind kind)
{
    int left = pause_failing();
    assert_int_equal(image_create_kind(image, 7, 5, 3, kind, NULL), RESULT_OK);
    for (size_t i = 0; i < image_size(image); ++i) image->pixels[i] = (uint8_t)(i % 4 * 20);
    go_on_failing(left);
}

static Result copy_png(void **state, const char *path, Bytes *made, Error *error)
{
    Image image, back = {0};
    Bytes file = {0};
    ImageTexts own = {0};
    (void)state, (void)path;
    make_image(&image, IMAGE_16);
    Result result = keep(made, &file, png_encode(&image, &texts, &file, error));
    THEN(result, keep_image(made, &back, png_decode_deep(&back, &file, "png", error)));
    THEN(result, png_decode_texts(&own, &file, "png", error));
    for (size_t i = 0; result == RESULT_OK && i < own.count; ++i)
        append(made, own.list[i].value, strlen(own.list[i].value));
    image_texts_destroy(&own);
    bytes_destroy(&file);
    image_destroy(&image);
    return result;
}

// Without memory for a palette the file has none: only the pixels are the same.
static Result copy_palette(void **state, const char *path, Bytes *made, Error *error)
{
    Image image, back = {0};
    Bytes file = {0};
    (void)state, (void)path;
    make_image(&image, IMAGE_8);
    Result result = png_encode_palette(&image, &file, error);
    THEN(result, keep_image(made, &back, png_decode_deep(&back, &file, "png", error)));
    bytes_destroy(&file);
    image_destroy(&image);
    return result;
}

static Result copy_exr(void **state, const char *path, Bytes *made, Error *error)
{
    Image image, back = {0};
    Bytes file = {0};
    (void)state, (void)path;
    make_image(&image, IMAGE_FLOAT);
    const ExrFile exr = {.image = &image, .texts = &texts};
    Result result = keep(made, &file, exr_file_encode(&exr, &file, error));
    THEN(result, keep_image(made, &back, exr_file_decode(&back, &file, "exr", error)));
    bytes_destroy(&file);
    image_destroy(&image);
    return result;
}

static Result copy_pfm(void **state, const char *path, Bytes *made, Error *error)
{
    Image image, back = {0};
    Bytes file = {0};
    (void)state, (void)path;
    make_image(&image, IMAGE_FLOAT);
    Result result = keep(made, &file, pfm_encode(&image, &file, error));
    THEN(result, keep_image(made, &back, pfm_decode(&back, &file, "pfm", error)));
    bytes_destroy(&file);
    image_destroy(&image);
    return result;
}

static Result copy_jpeg(void **state, const char *path, Bytes *made, Error *error)
{
    Image image;
    Bytes file = {0};
    (void)state, (void)path;
    make_image(&image, IMAGE_8);
    Result result = keep(made, &file, jpeg_encode(&image, JPEG_FINE, &file, error));
    bytes_destroy(&file);
    image_destroy(&image);
    return result;
}

static void images_are_copied_whole_or_not_at_all(void **state)
{
    static const Trial TRIALS[] = {{copy_png, "PNG"},
                                   {copy_palette, "PNG with a palette"},
                                   {copy_exr, "EXR"},
                                   {copy_pfm, "PFM"},
                                   {copy_jpeg, "JPEG"}};
    assert_int_equal(image_texts_set(&texts, "Software", "a test", NULL), RESULT_OK);
    for (size_t i = 0; i < sizeof TRIALS / sizeof *TRIALS; ++i) try_all(state, &TRIALS[i], "");
    image_texts_destroy(&texts);
}

// --- Scenes.

static Result copy_scene(void **state, const char *path, Bytes *made, Error *error)
{
    Scene scene;
    (void)state;
    Result result = scene_read(&scene, path, error);
    json_t *json = result == RESULT_OK ? scene_to_json(&scene) : NULL;
    int left = pause_failing();
    if (result == RESULT_OK && !json) result = error_set(error, RESULT_FAILED, "no JSON");
    char *text = json ? json_text(json, JSON_INDENT(1) | JSON_SORT_KEYS) : NULL;
    if (text) append(made, text, strlen(text));
    free(text);
    json_decref(json);
    scene_destroy(&scene);
    go_on_failing(left);
    return result;
}

static void scenes_are_copied_whole_or_not_at_all(void **state)
{
    static const char *const FILES[] = {"tests/data/scene_full.json", "assets/gust.json",
                                        "assets/pair.json"};
    for (size_t i = 0; i < sizeof FILES / sizeof *FILES; ++i)
        try_all(state, &(Trial){copy_scene, FILES[i]}, FILES[i]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(hair_is_read_whole_or_not_at_all, temporary_create,
                                        temporary_destroy),
        cmocka_unit_test_setup_teardown(hair_is_written_whole_or_not_at_all, temporary_create,
                                        temporary_destroy),
        cmocka_unit_test_setup_teardown(meshes_are_read_whole_or_not_at_all, temporary_create,
                                        temporary_destroy),
        cmocka_unit_test(scenes_are_copied_whole_or_not_at_all),
        cmocka_unit_test(images_are_copied_whole_or_not_at_all),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
