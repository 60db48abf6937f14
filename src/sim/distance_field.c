// SPDX-License-Identifier: MIT
#include "sim/distance_field.h"
#include "base/chunk.h"
#include "base/outfile.h"
#include "gpu/gpu_dispatch.h"
#include "gpu/gpu_uniforms.h"
#include "gpu/shader.h"

#include "glsl/field/field_params.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// PADDING: grid points around the mesh. BAND: distance from a triangle, in spacings, within which
// exact distances are computed.
enum { PADDING = 3, BAND = 2 };

// Work items are created and dispatched in parts of this many (32 MiB), or fewer if half of a
// storage block holds fewer. So memory does not grow with the mesh.
enum { PART_ITEMS = 1 << 21 };

// A triangle, and the first grid point of the block or square of this work item
// (glsl/field/field_near.comp, field_cross.comp).
typedef struct Item {
    uint32_t at[4];
} Item;

typedef struct Items {
    Item *list;
    size_t count, capacity;
    bool failed; // out of memory
} Items;

// Temporary objects for computing the field.
typedef struct Work {
    const Gpu *gpu;
    const Mesh *mesh;
    DistanceField *field;
    bool *repeated; // find_repeated
    FieldParams params;
    GpuBuffer triangles, items, squares, nearest, closest[2], winding;
    int present; // index of the current buffer in `closest`
} Work;

static void work_destroy(Work *work)
{
    GpuBuffer *buffers[] = {&work->triangles,  &work->items,      &work->squares, &work->nearest,
                            &work->closest[0], &work->closest[1], &work->winding};
    for (size_t i = 0; i < sizeof buffers / sizeof *buffers; ++i) gpu_buffer_destroy(buffers[i]);
    free(work->repeated);
}

void distance_field_destroy(DistanceField *field)
{
    gpu_buffer_destroy(&field->values);
    *field = (DistanceField){0};
}

static void choose_grid(DistanceField *field, const Mesh *mesh, uint32_t resolution)
{
    float low[3], high[3], longest = 0;
    mesh_bounds(mesh, low, high);
    for (int k = 0; k < 3; ++k) longest = fmaxf(longest, high[k] - low[k]);
    field->spacing = longest > 0 ? longest / (float)resolution : 1;
    for (int k = 0; k < 3; ++k) {
        field->size[k] = (uint32_t)ceilf((high[k] - low[k]) / field->spacing) + 1 + 2 * PADDING;
        float side = (float)(field->size[k] - 1) * field->spacing;
        field->low[k] = 0.5f * (low[k] + high[k]) - 0.5f * side;
    }
}

// --- Triangles that occur again change nothing, and a file may repeat one a hundred thousand
// times.

// The corners from the smallest one on, in the order of the triangle.
static void turn(const uint32_t from[3], uint32_t to[3])
{
    int first = from[1] < from[0] ? (from[2] < from[1] ? 2 : 1) : from[2] < from[0] ? 2 : 0;
    for (int i = 0; i < 3; ++i) to[i] = from[(first + i) % 3];
}

// [triangle_count] whether the same triangle comes earlier; to be freed. NULL when memory is short.
static bool *find_repeated(const Mesh *mesh)
{
    size_t room = 16;
    while (room < 2 * (size_t)mesh->triangle_count) room *= 2;
    uint32_t *table = calloc(room, sizeof *table); // numbers of triangles from 1, by their hash
    bool *repeated = calloc((size_t)mesh->triangle_count + 1, sizeof *repeated);
    for (uint32_t t = 0; table && repeated && t < mesh->triangle_count; ++t) {
        uint32_t own[3], other[3];
        turn(mesh->triangle[t], own);
        uint64_t hash = ((own[0] * 0x9e3779b97f4a7c15u ^ own[1]) * 0xbf58476d1ce4e5b9u ^ own[2]) *
                        0x94d049bb133111ebu;
        size_t at = (hash >> 20) & (room - 1);
        for (; table[at] && !repeated[t]; at = (at + 1) & (room - 1)) {
            turn(mesh->triangle[table[at] - 1], other);
            repeated[t] = memcmp(own, other, sizeof own) == 0;
        }
        if (!repeated[t]) table[at] = t + 1;
    }
    free(table);
    if (table) return repeated;
    free(repeated);
    return NULL;
}

// --- Work items.

static void add_item(Items *items, const uint32_t at[4])
{
    if (items->count == items->capacity && !items->failed) {
        size_t capacity = 2 * items->capacity + 1024;
        Item *list = realloc(items->list, capacity * sizeof *list);
        items->failed = !list;
        if (list) items->list = list, items->capacity = capacity;
    }
    if (!items->failed) memcpy(items->list[items->count++].at, at, sizeof items->list->at);
}

// The steps of `step` grid points that the range low .. high (in spacings) touches along one axis.
static void cover(double low, double high, uint32_t size, uint32_t step, uint32_t *first,
                  uint32_t *end)
{
    double from = fmin(fmax(floor(low), 0), size - 1.0), to = fmin(fmax(ceil(high), 0), size - 1.0);
    *first = (uint32_t)from / step * step;
    *end = (uint32_t)to + 1;
}

// A triangle's bounding box, in spacings from the first grid point, and its plane.
typedef struct Extent {
    double low[3], high[3];
    double normal[3], height; // unit normal; zero for a degenerate triangle
} Extent;

static Extent extent_of(const DistanceField *field, const Mesh *mesh, uint32_t triangle)
{
    Extent extent;
    double p[3][3], length = 0;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            p[i][k] =
                ((double)mesh->position[mesh->triangle[triangle][i]][k] - (double)field->low[k]) /
                (double)field->spacing;
    for (int k = 0; k < 3; ++k) {
        int u = (k + 1) % 3, v = (k + 2) % 3;
        extent.low[k] = fmin(p[0][k], fmin(p[1][k], p[2][k]));
        extent.high[k] = fmax(p[0][k], fmax(p[1][k], p[2][k]));
        extent.normal[k] =
            (p[1][u] - p[0][u]) * (p[2][v] - p[0][v]) - (p[1][v] - p[0][v]) * (p[2][u] - p[0][u]);
        length += extent.normal[k] * extent.normal[k];
    }
    length = sqrt(length);
    extent.height = 0;
    for (int k = 0; k < 3; ++k) {
        extent.normal[k] = length > 0 ? extent.normal[k] / length : 0;
        extent.height += extent.normal[k] * p[0][k];
    }
    return extent;
}

// Whether the plane of the triangle passes within BAND of the block.
static bool plane_is_near(const Extent *extent, const uint32_t at[3])
{
    double half = 0.5 * (FIELD_BLOCK - 1), away = -extent->height, reach = BAND;
    for (int k = 0; k < 3; ++k) {
        away += extent->normal[k] * (at[k] + half);
        reach += fabs(extent->normal[k]) * half;
    }
    return fabs(away) <= reach;
}

static void add_blocks(Items *items, const DistanceField *field, const Extent *extent,
                       uint32_t triangle, uint32_t unused)
{
    (void)unused;
    uint32_t first[3], end[3], at[3];
    for (int k = 0; k < 3; ++k)
        cover(extent->low[k] - BAND, extent->high[k] + BAND, field->size[k], FIELD_BLOCK, &first[k],
              &end[k]);
    for (at[2] = first[2]; at[2] < end[2]; at[2] += FIELD_BLOCK)
        for (at[1] = first[1]; at[1] < end[1]; at[1] += FIELD_BLOCK)
            for (at[0] = first[0]; at[0] < end[0]; at[0] += FIELD_BLOCK)
                if (plane_is_near(extent, at))
                    add_item(items, (const uint32_t[]){triangle, at[0], at[1], at[2]});
}

static void add_columns(Items *items, const DistanceField *field, const Extent *extent,
                        uint32_t triangle, uint32_t axis)
{
    uint32_t u = (axis + 1) % 3, v = (axis + 2) % 3, first[2], end[2];
    cover(extent->low[u], extent->high[u], field->size[u], FIELD_COLUMNS, &first[0], &end[0]);
    cover(extent->low[v], extent->high[v], field->size[v], FIELD_COLUMNS, &first[1], &end[1]);
    for (uint32_t j = first[1]; j < end[1]; j += FIELD_COLUMNS)
        for (uint32_t i = first[0]; i < end[0]; i += FIELD_COLUMNS)
            add_item(items, (const uint32_t[]){triangle, axis, i, j});
}

// --- Cost.

// The work items of usual meshes: a dozen for each small triangle, of which there are two for each
// vertex, and for large triangles this many for each block of a side of the grid, as many as fifty
// closed layers make.
enum { ITEMS_EACH = 12, ITEMS_EACH_BLOCK = 400, LEAST_AFFORDABLE = 2 };

// Whether find_near has at most `most` work items.
static bool has_at_most(const DistanceField *field, const Mesh *mesh, const bool *repeated,
                        size_t most)
{
    Items items = {0};
    size_t count = 0;
    for (uint32_t t = 0; t < mesh->triangle_count && count <= most && !items.failed; ++t) {
        if (repeated && repeated[t]) continue;
        Extent extent = extent_of(field, mesh, t);
        items.count = 0;
        add_blocks(&items, field, &extent, t, 0);
        count += items.count;
    }
    free(items.list);
    return count <= most;
}

uint32_t distance_field_affordable(const Mesh *mesh, uint32_t resolution)
{
    size_t few = mesh->triangle_count < 2 * (size_t)mesh->vertex_count
                     ? mesh->triangle_count
                     : 2 * (size_t)mesh->vertex_count;
    bool *repeated = find_repeated(mesh); // NULL: all count
    for (; resolution > LEAST_AFFORDABLE; resolution -= (resolution + 7) / 8) {
        DistanceField field = {0};
        size_t side = resolution / FIELD_BLOCK + 1;
        choose_grid(&field, mesh, resolution);
        if (has_at_most(&field, mesh, repeated, ITEMS_EACH * few + ITEMS_EACH_BLOCK * side * side))
            break;
    }
    free(repeated);
    return resolution < LEAST_AFFORDABLE ? LEAST_AFFORDABLE : resolution;
}

// --- Passes.

static void set_params(Work *work)
{
    gpu_uniforms_set(BIND_STEP, &work->params, sizeof work->params);
}

// The number of work groups along a row of `points` grid points. Rows are the other dimensions of
// the dispatch.
static GLuint groups_of(const Work *work, uint32_t points)
{
    GLuint lanes = (GLuint)work->gpu->limits.sizes.items;
    return (points + lanes - 1) / lanes;
}

static void dispatch_grid(Work *work)
{
    const uint32_t *size = work->field->size;
    set_params(work);
    glDispatchCompute(groups_of(work, size[0]), size[1], size[2]);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
}

static void dispatch_items(Work *work)
{
    const GpuLimits *limits = &work->gpu->limits;
    set_params(work);
    gpu_dispatch(limits, work->params.count, (uint64_t)limits->sizes.items, 1);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
}

static Result use(const Work *work, GLuint *program, const char *file, Error *error)
{
    const ShaderDefine defines[] = {{"GROUP_SIZE", work->gpu->limits.sizes.items}, {NULL, 0}};
    TRY(shader_build_compute(program, file, defines, error));
    glUseProgram(*program);
    return RESULT_OK;
}

// Uploads the items and frees them.
static Result take_items(Work *work, Items *items, Error *error)
{
    gpu_buffer_destroy(&work->items);
    Result result = RESULT_OK;
    if (items->failed) result = error_set(error, RESULT_FAILED, "no memory for a distance field");
    THEN(result, gpu_buffer_create(&work->items, &work->gpu->limits, "a distance field's work",
                                   (int64_t)(items->count * sizeof(Item)), items->list, 0, error));
    work->params.count = (uint32_t)items->count;
    free(items->list);
    return result;
}

static Result upload_triangles(Work *work, Error *error)
{
    const Mesh *mesh = work->mesh;
    float(*corners)[4] = calloc((size_t)mesh->triangle_count * 3 + 1, sizeof *corners);
    if (!corners) return error_set(error, RESULT_FAILED, "no memory for a distance field");
    for (size_t i = 0; i < (size_t)mesh->triangle_count * 3; ++i)
        for (int k = 0; k < 3; ++k)
            corners[i][k] = mesh->position[mesh->triangle[i / 3][i % 3]][k] - work->field->low[k];
    // Read only as a texture, so the limit of storage blocks does not apply.
    int64_t size = (int64_t)((size_t)mesh->triangle_count * 3 * sizeof *corners);
    Result result =
        gpu_buffer_create_pieces(&work->triangles, &work->gpu->limits,
                                 "a distance field's triangles", size, GL_RGBA32F, error);
    if (result == RESULT_OK) gpu_buffer_write(&work->triangles, 0, corners, size);
    free(corners);
    return result;
}

static Result create_buffers(Work *work, Error *error)
{
    const GpuLimits *limits = &work->gpu->limits;
    int64_t count = (int64_t)distance_field_count(work->field);
    const struct {
        GpuBuffer *buffer;
        int64_t size;
        GLenum format;
    } buffers[] = {
        {&work->squares, 4, 0},
        {&work->nearest, 4, 0},
        {&work->winding, 4, 0},
        {&work->closest[0], 16, GL_RGBA32F},
        {&work->closest[1], 16, GL_RGBA32F},
        {&work->field->values, 4, GL_R32F},
    };
    TRY(upload_triangles(work, error));
    for (size_t i = 0; i < sizeof buffers / sizeof *buffers; ++i)
        TRY(gpu_buffer_create(buffers[i].buffer, limits, "a distance field (--sdf-resolution)",
                              count * buffers[i].size, NULL, buffers[i].format, error));
    return RESULT_OK;
}

// A function that adds the work items of a triangle.
typedef void AddItems(Items *items, const DistanceField *field, const Extent *extent,
                      uint32_t triangle, uint32_t axis);

// Dispatches the current program over the items of all triangles.
static Result dispatch_triangles(Work *work, AddItems *add, uint32_t axis, Error *error)
{
    int64_t half_block = work->gpu->limits.storage_block / (int64_t)(2 * sizeof(Item));
    size_t part = half_block < PART_ITEMS ? (size_t)half_block : PART_ITEMS;
    for (uint32_t t = 0; t < work->mesh->triangle_count;) {
        Items items = {0};
        for (; t < work->mesh->triangle_count && items.count < part && !items.failed; ++t) {
            if (work->repeated[t]) continue;
            Extent extent = extent_of(work->field, work->mesh, t);
            add(&items, work->field, &extent, t, axis);
        }
        TRY(take_items(work, &items, error));
        gpu_buffer_bind_storage(&work->items, 0);
        dispatch_items(work);
    }
    return RESULT_OK;
}

static Result find_near(Work *work, Error *error)
{
    GLuint program;
    TRY(use(work, &program, "field/field_near.comp", error));
    gpu_buffer_clear(&work->squares, 0x7f7fffff); // the largest float
    gpu_buffer_clear(&work->nearest, 0xffffffff);
    gpu_buffer_bind_texture(&work->triangles, BIND_POSITION);
    gpu_buffer_bind_storage(&work->squares, 1);
    gpu_buffer_bind_storage(&work->nearest, 2);
    Result result = RESULT_OK;
    for (work->params.phase = 0; work->params.phase < 2; ++work->params.phase)
        THEN(result, dispatch_triangles(work, add_blocks, 0, error));
    shader_release(program);
    return result;
}

static Result seed(Work *work, Error *error)
{
    GLuint program;
    TRY(use(work, &program, "field/field_seed.comp", error));
    gpu_buffer_bind_storage(&work->nearest, 0);
    gpu_buffer_bind_storage(&work->closest[0], 1);
    dispatch_grid(work);
    shader_release(program);
    return RESULT_OK;
}

// Jump flooding: strides are halved from half the grid to 1. A second pass with stride 1 corrects
// most of the errors.
static Result flood(Work *work, Error *error)
{
    GLuint program;
    const uint32_t *size = work->field->size;
    uint32_t longest = size[0] > size[1] ? size[0] : size[1], stride = 1;
    if (size[2] > longest) longest = size[2];
    TRY(use(work, &program, "field/field_flood.comp", error));
    while (2 * stride < longest) stride *= 2;
    for (int ones = 0; ones<2; stride = stride> 1 ? stride / 2 : 1) {
        ones += stride == 1;
        work->params.stride = stride;
        gpu_buffer_bind_texture(&work->closest[work->present], BIND_REST);
        gpu_buffer_bind_storage(&work->closest[!work->present], 1);
        dispatch_grid(work);
        work->present = !work->present;
    }
    shader_release(program);
    return RESULT_OK;
}

static Result cross(Work *work, uint32_t axis, Error *error)
{
    GLuint program;
    TRY(use(work, &program, "field/field_cross.comp", error));
    gpu_buffer_bind_storage(&work->squares, 1); // reused for the crossings
    Result result = dispatch_triangles(work, add_columns, axis, error);
    shader_release(program);
    return result;
}

static Result sign(Work *work, uint32_t axis, Error *error)
{
    GLuint program;
    const uint32_t *size = work->field->size;
    TRY(use(work, &program, "field/field_sign.comp", error));
    work->params.axis = axis;
    set_params(work);
    gpu_buffer_bind_storage(&work->squares, 0);
    gpu_buffer_bind_storage(&work->winding, 1);
    gpu_buffer_bind_storage(&work->field->values, 2);
    gpu_buffer_bind_texture(&work->closest[work->present], BIND_REST);
    glDispatchCompute(groups_of(work, size[(axis + 1) % 3]), size[(axis + 2) % 3], 1);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
    shader_release(program);
    return RESULT_OK;
}

static Result compute(Work *work, Error *error)
{
    TRY(create_buffers(work, error));
    TRY(find_near(work, error));
    TRY(seed(work, error));
    TRY(flood(work, error));
    gpu_buffer_clear(&work->squares, 0);
    gpu_buffer_clear(&work->winding, 0);
    for (uint32_t axis = 0; axis < 3; ++axis) {
        TRY(cross(work, axis, error));
        TRY(sign(work, axis, error));
    }
    return gpu_check("a distance field", error);
}

Result distance_field_create(DistanceField *field, const Gpu *gpu, const Mesh *mesh,
                             uint32_t resolution, Error *error)
{
    *field = (DistanceField){0};
    choose_grid(field, mesh, resolution);
    Work work = {.gpu = gpu, .mesh = mesh, .field = field};
    memcpy(work.params.low, field->low, sizeof field->low);
    work.params.low[3] = field->spacing;
    work.params.size_x = field->size[0];
    work.params.size_y = field->size[1];
    work.params.size_z = field->size[2];
    work.repeated = find_repeated(mesh);
    Result result = work.repeated
                        ? compute(&work, error)
                        : error_set(error, RESULT_FAILED, "no memory for a distance field");
    work_destroy(&work);
    if (result != RESULT_OK) distance_field_destroy(field);
    return result;
}

static const char MAGIC[] = "TRXFIELD";

// Increase this whenever the field of an unchanged mesh changes, so that cached files are not used.
enum { METHOD = 2 };

// The grid as stored in the file.
typedef struct GridRecord {
    uint32_t size[3];
    float low[3], spacing;
} GridRecord;

// 64-bit FNV-1a hash, 4 bytes at a time.
static uint64_t hash_words(uint64_t hash, const void *words, size_t count)
{
    for (size_t i = 0; i < count; ++i) {
        uint32_t word;
        memcpy(&word, (const char *)words + 4 * i, 4);
        hash = (hash ^ word) * 0x100000001b3ull;
    }
    return hash;
}

char *distance_field_cache_name(const Mesh *mesh, uint32_t resolution)
{
    const char *folder = getenv("XDG_CACHE_HOME"), *home = getenv("HOME"), *between = "";
    if (!folder || folder[0] != '/') folder = home, between = "/.cache";
    if (!folder || folder[0] != '/') return NULL;
    const uint32_t header[] = {METHOD, resolution, mesh->vertex_count, mesh->triangle_count};
    uint64_t hash = hash_words(0xcbf29ce484222325ull, header, 4);
    hash = hash_words(hash, mesh->position, 3 * (size_t)mesh->vertex_count);
    hash = hash_words(hash, mesh->triangle, 3 * (size_t)mesh->triangle_count);
    char *name = NULL;
    if (asprintf(&name, "%s%s/tractrix/%016llx.field", folder, between, (unsigned long long)hash) <
        0)
        return NULL;
    return name;
}

static Result read_chunk(ChunkFile *file, uint64_t at, const char *tag, size_t size, Bytes *bytes,
                         uint64_t *end, Error *error)
{
    Chunk chunk;
    TRY(chunk_find(file, at, &chunk, error));
    if (strcmp(chunk.tag, tag) != 0 || chunk.size != size)
        return error_set(
            error, RESULT_BAD_INPUT,
            "%s: not a distance field that this version can read: expected one that it has written",
            file->path);
    *end = chunk_end(&chunk);
    return chunk_read(file, &chunk, bytes, error);
}

static Result read_field(DistanceField *field, ChunkFile *file, const Gpu *gpu, Error *error)
{
    Bytes grid = {0}, values = {0};
    uint64_t at = CHUNK_FILE_HEADER_BYTES;
    Result result = read_chunk(file, at, "GRID", sizeof(GridRecord), &grid, &at, error);
    if (result == RESULT_OK) {
        GridRecord record;
        memcpy(&record, grid.data, sizeof record);
        memcpy(field->size, record.size, sizeof field->size);
        memcpy(field->low, record.low, sizeof field->low);
        field->spacing = record.spacing;
        result = read_chunk(file, at, "DIST", distance_field_count(field) * sizeof(float), &values,
                            &at, error);
    }
    THEN(result, gpu_buffer_create(&field->values, &gpu->limits, "a distance field",
                                   (int64_t)values.size, values.data, GL_R32F, error));
    bytes_destroy(&grid);
    bytes_destroy(&values);
    return result;
}

static Result read_cached(DistanceField *field, const char *name, const Gpu *gpu, Error *error)
{
    ChunkFile file;
    *field = (DistanceField){0};
    Result result = chunk_file_open(&file, name, MAGIC, error);
    if (result == RESULT_OK) {
        result = read_field(field, &file, gpu, error);
        chunk_file_close(&file);
    }
    if (result != RESULT_OK) distance_field_destroy(field);
    return result;
}

static Result write_cached(const DistanceField *field, const char *name, Error *error)
{
    size_t size = distance_field_count(field) * sizeof(float);
    void *values = gpu_buffer_read(&field->values);
    if (!values) return error_set(error, RESULT_FAILED, "no memory for a distance field");
    GridRecord record = {.spacing = field->spacing};
    memcpy(record.size, field->size, sizeof record.size);
    memcpy(record.low, field->low, sizeof record.low);
    OutFile file;
    Result result = outfile_open_private(&file, name, error);
    if (result == RESULT_OK) {
        chunk_file_begin(file.stream, MAGIC);
        chunk_write(file.stream, "GRID", 0, &record, sizeof record);
        chunk_write(file.stream, "DIST", 0, values, size);
        result = outfile_commit(&file, error);
    }
    free(values);
    return result;
}

Result distance_field_create_cached(DistanceField *field, const Gpu *gpu, const Mesh *mesh,
                                    uint32_t resolution, bool *read, Error *error)
{
    Error why = {{0}};
    char *name = distance_field_cache_name(mesh, resolution);
    bool found = name && read_cached(field, name, gpu, &why) == RESULT_OK;
    Result result = found ? RESULT_OK : distance_field_create(field, gpu, mesh, resolution, error);
    if (result == RESULT_OK && name && !found) write_cached(field, name, &why);
    if (read) *read = found;
    free(name);
    return result;
}
