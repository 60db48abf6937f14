// SPDX-License-Identifier: MIT
#include "library/library.h"

#include "base/json.h"
#include "base/suggest.h"
#include "formats/strands_mend.h"
#include "scene/scene_param.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const SceneOverrides NO_OVERRIDES;

// --- Making a scene, and making it again from its steps.

static bool is_preset(const ParamInfo *info)
{
    return strcmp(info->name, "look") == 0 || strcmp(info->name, "quality") == 0;
}

static Result begin(Scene *scene, const TractrixScene *from, Error *error)
{
    *scene = (Scene){0};
    json_memory_forget();
    if (from->json) {
        const Bytes content = {(uint8_t *)from->json, strlen(from->json)};
        return scene_parse_unchecked(scene, from->path, &content, from->folder, &NO_OVERRIDES,
                                     error);
    }
    TRY(scene_create_as(scene, &(Presets){.look = from->look}, error));
    if (!from->path) return RESULT_OK;
    return scene_open(scene, (const char *const[]){from->path}, 1, &NO_OVERRIDES, error);
}

static Result add_section(Scene *scene, const LibraryArray *array, Error *error)
{
    const Presets presets = {params_find("look")->choices[scene->run.look],
                             params_find("quality")->choices[scene->run.quality]};
    SectionParams params;
    Result result = params_create_section(&params, error);
    THEN(result, scene_apply_presets(&presets, SCOPE_SECTION, &params, error));
    THEN(result, scene_add_section(scene, array->name, &params, error));
    if (result == RESULT_OK) scene->sections[scene->section_count - 1].given = &array->strands;
    params_destroy_section(&params);
    return result;
}

static Result apply(Scene *scene, const TractrixScene *of, const LibraryStep *step, Error *error)
{
    if (!step->info) return add_section(scene, &of->arrays[step->array], error);
    Result result = is_preset(step->info)
                        ? scene_set_preset(scene, step->info, step->text, error)
                        : scene_set(scene, step->section, step->info, step->text, error);
    return result == RESULT_OK ? result : error_prefix(error, result, "%s: ", step->info->name);
}

// Settles values that depend on all parameters together.
static Result settle(Scene *scene, const TractrixScene *from, Error *error)
{
    static const char ARRAY[] = "(array)";
    for (uint32_t b = 0; b < scene->body_count; ++b) {
        SceneBody *body = &scene->bodies[b];
        body->given_mesh = from->meshes[b].mesh.vertex_count ? &from->meshes[b] : NULL;
        if (body->given_mesh) TRY(params_parse(params_find("mesh"), &body->params, ARRAY, error));
    }
    scene_settle(scene);
    TRY(scene_choose_turn(scene, error));
    scene_set_lights(scene);
    return RESULT_OK;
}

Result library_copy_scene(Scene *scene, const TractrixScene *from, Error *error)
{
    Result result = begin(scene, from, error);
    for (uint32_t i = 0; i < from->step_count && result == RESULT_OK; ++i)
        result = apply(scene, from, &from->steps[i], error);
    THEN(result, settle(scene, from, error));
    return result;
}

// Executes a step and remembers it, so that the scene can be made again. Takes ownership of its
// text.
static Result take_step(TractrixScene *scene, LibraryStep step, Error *error)
{
    LibraryStep *steps = realloc(scene->steps, (scene->step_count + (size_t)1) * sizeof *steps);
    if (steps) scene->steps = steps;
    Result result = steps && (step.text || !step.info)
                        ? apply(&scene->scene, scene, &step, error)
                        : error_set(error, RESULT_FAILED, "no memory for a scene");
    if (result == RESULT_OK)
        scene->steps[scene->step_count++] = step;
    else
        free(step.text);
    return result;
}

static void forget_meshes(TractrixScene *scene)
{
    for (uint32_t b = 0; b < SCENE_MAX_BODIES; ++b) mesh_destroy(&scene->meshes[b].mesh);
}

// --- Lifetime.

void tractrix_scene_destroy(TractrixScene *scene)
{
    LIBRARY_CALL;
    if (!scene) return;
    scene_destroy(&scene->scene);
    for (uint32_t i = 0; i < scene->array_count; ++i) {
        free(scene->arrays[i].name);
        strands_destroy(&scene->arrays[i].strands);
    }
    for (uint32_t i = 0; i < scene->step_count; ++i) free(scene->steps[i].text);
    free(scene->arrays);
    free(scene->steps);
    forget_meshes(scene);
    free(scene->path);
    free(scene->json);
    free(scene->folder);
    free(scene->look);
    free(scene);
}

// `path`, `json`, `folder` and `look` are copied; some may be NULL.
static Result make(TractrixScene **scene, const char *path, const char *json, const char *folder,
                   const char *look, Error *error)
{
    TractrixScene *made = calloc(1, sizeof *made);
    *scene = made;
    if (!made) return error_set(error, RESULT_FAILED, "no memory for a scene");
    made->path = path ? strdup(path) : NULL;
    made->json = json ? strdup(json) : NULL;
    made->folder = folder ? strdup(folder) : NULL;
    made->look = look ? strdup(look) : NULL;
    if ((path && !made->path) || (json && !made->json) || (folder && !made->folder) ||
        (look && !made->look))
        return error_set(error, RESULT_FAILED, "no memory for a scene");
    return begin(&made->scene, made, error);
}

static TractrixResult finish(TractrixScene **scene, Result result, const Error *why,
                             TractrixError *error)
{
    if (result != RESULT_OK && *scene) {
        tractrix_scene_destroy(*scene);
        *scene = NULL;
    }
    return library_end(result, why, error);
}

TractrixResult tractrix_scene_create(TractrixScene **scene, const char *look, TractrixError *error)
{
    LIBRARY_CALL;
    Error why = {{0}};
    if (!scene) return library_refuse(error, "scene: got NULL");
    *scene = NULL;
    Result result = make(scene, NULL, NULL, NULL, look, &why);
    return finish(scene, result, &why, error);
}

// Checks now that the file can be read: only the simulation reads it, whose error would come late.
static Result check_file(const char *path, Error *error)
{
    if (strcmp(path, "-") == 0)
        return error_set(error, RESULT_USAGE, "-: expected a file: the library reads no streams");
    struct stat status;
    int descriptor = bytes_open_plain(path, &status);
    if (descriptor >= 0) close(descriptor);
    if (descriptor >= 0 && !S_ISDIR(status.st_mode)) return RESULT_OK;
    Bytes bytes; // gives the same message as the programs
    Result result = bytes_read_plain(&bytes, path, error);
    bytes_destroy(&bytes);
    return result;
}

// Patterns of numbered files ('%') are checked by their reader.
static Result check_files(const TractrixScene *scene, Error *error)
{
    for (uint32_t b = 0; b < scene->scene.body_count; ++b) {
        const BodyParams *body = &scene->scene.bodies[b].params;
        if (*body->mesh && !strchr(body->mesh, '%')) TRY(check_file(body->mesh, error));
        if (*body->mesh_rest) TRY(check_file(body->mesh_rest, error));
    }
    for (uint32_t i = 0; i < scene->scene.section_count; ++i)
        TRY(check_file(scene->scene.sections[i].file, error));
    return RESULT_OK;
}

static Result read_scene(TractrixScene **scene, const char *path, Error *error)
{
    Bytes bytes = {0};
    if (strcmp(path, "-") == 0) return check_file(path, error);
    if (!scene_is_file(path)) return make(scene, path, NULL, NULL, NULL, error);
    TRY(bytes_read_file(&bytes, path, error));
    bytes_drop_mark(&bytes);
    const char *slash = strrchr(path, '/');
    char *folder = strndup(path, slash ? (size_t)(slash + 1 - path) : 0);
    Result result = !folder ? error_set(error, RESULT_FAILED, "%s: no memory", path)
                    : memchr(bytes.data, 0, bytes.size)
                        ? error_set(error, RESULT_BAD_INPUT, "%s: has a zero byte", path)
                        : make(scene, path, (const char *)bytes.data, folder, NULL, error);
    free(folder);
    bytes_destroy(&bytes);
    return result;
}

TractrixResult tractrix_scene_read(TractrixScene **scene, const char *path, TractrixError *error)
{
    LIBRARY_CALL;
    Error why = {{0}};
    if (!scene) return library_refuse(error, "scene: got NULL");
    *scene = NULL;
    if (!path || !*path) return library_refuse(error, "path: expected the name of a file");
    Result result = read_scene(scene, path, &why);
    THEN(result, check_files(*scene, &why));
    return finish(scene, result, &why, error);
}

TractrixResult tractrix_scene_parse(TractrixScene **scene, const char *json, const char *folder,
                                    TractrixError *error)
{
    LIBRARY_CALL;
    Error why = {{0}};
    char *place = NULL;
    if (!scene) return library_refuse(error, "scene: got NULL");
    *scene = NULL;
    if (!json) return library_refuse(error, "json: got NULL");
    bool whole = !folder || !*folder || folder[strlen(folder) - 1] == '/';
    if (asprintf(&place, "%s%s", folder ? folder : "", whole ? "" : "/") < 0) place = NULL;
    Result result = place ? make(scene, "scene", json, place, NULL, &why)
                          : error_set(&why, RESULT_FAILED, "no memory for a scene");
    free(place);
    THEN(result, check_files(*scene, &why));
    return finish(scene, result, &why, error);
}

// --- Parameters.

Result library_refuse_name(const char *name, Error *error)
{
    char words[200];
    const char *names[SCENE_PARAMS];
    size_t count = 0;
    for (const TractrixParameter *row; (row = tractrix_parameter(count)); ++count)
        names[count] = row->name;
    const char *nearest = suggest_nearest(name, names, count);
    snprintf(words, sizeof words, nearest ? "did you mean '%s'?" : "see tractrix_parameter%s",
             nearest ? nearest : "");
    return error_set(error, RESULT_USAGE, "%s: the library has no such parameter: %s", name, words);
}

static Result set(TractrixScene *scene, int section, const char *name, const char *text,
                  Error *error)
{
    const ParamInfo *info = library_parameter(name);
    if (!info) return library_refuse_name(name, error);
    if (section < -1 || section >= (int)scene->scene.section_count)
        return error_set(error, RESULT_USAGE, "section: got %d, expected -1 to %d", section,
                         (int)scene->scene.section_count - 1);
    if (section >= 0 && info->scope != SCOPE_SECTION)
        return error_set(error, RESULT_USAGE,
                         "%s: is no parameter of a section: expected section -1", info->name);
    TRY(take_step(scene, (LibraryStep){.info = info, .section = section, .text = strdup(text)},
                  error));
    if (strcmp(info->name, "mesh") == 0) forget_meshes(scene);
    return RESULT_OK;
}

TractrixResult tractrix_scene_set(TractrixScene *scene, int section, const char *name,
                                  const char *text, TractrixError *error)
{
    LIBRARY_CALL;
    Error why = {{0}};
    if (!scene || !name || !text) return library_refuse(error, "scene, name or text: got NULL");
    return library_end(set(scene, section, name, text, &why), &why, error);
}

static size_t put(const char *from, char *text, size_t room)
{
    if (text && room) snprintf(text, room, "%s", from);
    return strlen(from);
}

size_t tractrix_scene_get(const TractrixScene *scene, int section, const char *name, char *text,
                          size_t room)
{
    LIBRARY_CALL;
    const ParamInfo *info = name ? params_find(name) : NULL;
    uint32_t i = section < 0 ? 0 : (uint32_t)section;
    if (text && room) *text = 0;
    if (!scene || !info || (info->scope == SCOPE_SECTION && i >= scene->scene.section_count))
        return 0;
    if (info->scope != SCOPE_SECTION) i = 0; // the run, or the first body
    char *value = params_format(info, scene_params(&scene->scene, info->scope, i));
    size_t length = value ? put(value, text, room) : 0;
    free(value);
    return length;
}

size_t tractrix_scene_json(const TractrixScene *scene, char *text, size_t room)
{
    LIBRARY_CALL;
    Scene whole;
    size_t length = 0;
    if (text && room) *text = 0;
    if (!scene) return 0;
    if (library_copy_scene(&whole, scene, NULL) == RESULT_OK) {
        json_t *json = scene_to_json(&whole);
        char *dumped = json_text(json, JSON_INDENT(2) | JSON_REAL_PRECISION(9));
        if (dumped) length = put(dumped, text, room);
        free(dumped);
        json_decref(json);
    }
    scene_destroy(&whole);
    return length;
}

uint32_t tractrix_scene_section_count(const TractrixScene *scene)
{
    LIBRARY_CALL;
    return scene ? scene->scene.section_count : 0;
}

uint32_t tractrix_scene_body_count(const TractrixScene *scene)
{
    LIBRARY_CALL;
    return scene ? scene->scene.body_count : 0;
}

// --- Arrays.

static Result check_strands(const TractrixStrands *strands, uint64_t *vertices, Error *error)
{
    if (!(strands->metres_per_unit > 0 && strands->metres_per_unit <= 1e9))
        return error_set(error, RESULT_USAGE,
                         "strands.metres_per_unit: got %g, expected above 0 and at most 1e9",
                         strands->metres_per_unit);
    if (!strands->position || !strands->strand_count)
        return error_set(error, RESULT_USAGE, "strands: expected at least one, and positions");
    if (!strands->sizes &&
        (strands->vertices_each < 2 || strands->vertices_each > STRANDS_MAX_SIZE))
        return error_set(error, RESULT_USAGE, "strands.vertices_each: got %u, expected 2 to %d",
                         strands->vertices_each, STRANDS_MAX_SIZE);
    *vertices = strands->sizes ? 0 : (uint64_t)strands->strand_count * strands->vertices_each;
    for (uint32_t s = 0; strands->sizes && s < strands->strand_count && *vertices < UINT32_MAX;
         ++s) {
        uint32_t size = strands->sizes[s];
        if (size < 2 || size > STRANDS_MAX_SIZE)
            return error_set(error, RESULT_BAD_INPUT,
                             "strands: strand %u has %u vertices: expected 2 to %d", s, size,
                             STRANDS_MAX_SIZE);
        *vertices += size;
    }
    if (*vertices >= UINT32_MAX)
        return error_set(error, RESULT_USAGE,
                         "strands: got %llu vertices or more, expected fewer than 2^32 - 1",
                         (unsigned long long)*vertices);
    return RESULT_OK;
}

static bool copy_floats(void *to, const float *from, size_t count)
{
    float **array = to;
    if (!from) return true;
    *array = malloc(count * sizeof **array + 1);
    if (*array) memcpy(*array, from, count * sizeof **array);
    return *array != NULL;
}

// Converts points as file readers do: in double precision, rounded once.
static void put_points(float (*to)[3], const float *from, size_t count, double unit, bool up_z)
{
    for (size_t v = 0; v < count; ++v, from += 3) {
        to[v][0] = (float)((double)from[0] * unit);
        to[v][1] = (float)((double)(up_z ? from[2] : from[1]) * unit);
        to[v][2] = (float)((double)(up_z ? -from[1] : from[2]) * unit);
    }
}

// Checks that the numbers of each vertex are 0 to `most`.
static Result check_range(const Strands *strands, const float *numbers, uint32_t each, float most,
                          const char *name, const char *expected, Error *error)
{
    for (uint32_t s = 0; numbers && s < strands->strand_count; ++s)
        for (size_t i = (size_t)each * strands->first[s]; i < (size_t)each * strands->first[s + 1];
             ++i)
            if (numbers[i] < 0 || (numbers[i] > most && isfinite(numbers[i])))
                return error_set(error, RESULT_BAD_INPUT, "%s: strand %u: got %g: expected %s",
                                 name, s, (double)numbers[i], expected);
    return RESULT_OK;
}

static Result copy_strands(Strands *to, const TractrixStrands *from, uint32_t vertices,
                           Error *error)
{
    TRY(strands_create(to, from->strand_count, vertices, error));
    for (uint32_t s = 0; s < from->strand_count; ++s)
        to->first[s + 1] = to->first[s] + (from->sizes ? from->sizes[s] : from->vertices_each);
    TRY(check_range(to, from->thickness, 1, FLT_MAX, "thickness", "0 or more", error));
    TRY(check_range(to, from->color, 4, 1, "color", "linear light and opacity of 0 to 1", error));
    put_points(to->position, from->position, vertices, from->metres_per_unit, from->up_z);
    to->relative_widths = true;
    if (copy_floats(&to->vertex_thickness, from->thickness, vertices) &&
        copy_floats(&to->color, from->color, 4 * (size_t)vertices) &&
        copy_floats(&to->strand_uv, from->uv, 2 * (size_t)from->strand_count))
        return RESULT_OK;
    return error_set(error, RESULT_FAILED, "no memory for %u strands", from->strand_count);
}

static Result add_strands(TractrixScene *scene, const char *name, const TractrixStrands *asked,
                          Error *error)
{
    TractrixStrands strands;
    uint64_t vertices = 0;
    TRY(library_take(&strands, sizeof strands, asked, sizeof strands, "strands", error));
    TRY(check_strands(&strands, &vertices, error));
    LibraryArray *arrays =
        realloc(scene->arrays, (scene->array_count + (size_t)1) * sizeof *arrays);
    if (!arrays) return error_set(error, RESULT_FAILED, "no memory for strands");
    scene->arrays = arrays;
    LibraryArray *array = &arrays[scene->array_count];
    *array = (LibraryArray){.name = strdup(name ? name : "strands")};
    Result result = array->name ? copy_strands(&array->strands, &strands, (uint32_t)vertices, error)
                                : error_set(error, RESULT_FAILED, "no memory for a name");
    THEN(result, strands_check(&array->strands, array->name, error));
    THEN(result, take_step(scene, (LibraryStep){.array = scene->array_count}, error));
    if (result == RESULT_OK) {
        ++scene->array_count;
        // Only copies of the scene are loaded, and growing this array moves it.
        scene->scene.sections[scene->scene.section_count - 1].given = NULL;
        return RESULT_OK;
    }
    free(array->name);
    strands_destroy(&array->strands);
    return result;
}

TractrixResult tractrix_scene_add_strands(TractrixScene *scene, const char *name,
                                          const TractrixStrands *strands, TractrixError *error)
{
    LIBRARY_CALL;
    Error why = {{0}};
    if (!scene) return library_refuse(error, "scene: got NULL");
    return library_end(add_strands(scene, name, strands, &why), &why, error);
}

static Result check_mesh(const TractrixMesh *mesh, Error *error)
{
    if (!(mesh->metres_per_unit > 0 && mesh->metres_per_unit <= 1e9))
        return error_set(error, RESULT_USAGE,
                         "mesh.metres_per_unit: got %g, expected above 0 and at most 1e9",
                         mesh->metres_per_unit);
    if (!mesh->position || !mesh->triangle || mesh->vertex_count < 3 || !mesh->triangle_count)
        return error_set(error, RESULT_USAGE, "mesh: expected vertices and triangles");
    for (size_t i = 0; i < 3 * (size_t)mesh->triangle_count; ++i)
        if (mesh->triangle[i] >= mesh->vertex_count)
            return error_set(error, RESULT_BAD_INPUT,
                             "mesh: triangle %zu has vertex %u: expected 0 to %u", i / 3,
                             mesh->triangle[i], mesh->vertex_count - 1);
    return RESULT_OK;
}

static Result check_points(const float (*position)[3], uint32_t count, Error *error)
{
    for (uint32_t v = 0; v < count; ++v)
        for (int k = 0; k < 3; ++k)
            if (!(position[v][k] >= -1e6f && position[v][k] <= 1e6f))
                return error_set(
                    error, RESULT_BAD_INPUT,
                    "mesh: a coordinate of vertex %u is NaN, infinite or beyond 1000 km", v);
    return RESULT_OK;
}

static Result copy_mesh(Mesh *to, const TractrixMesh *from, Error *error)
{
    TRY(mesh_create(to, from->vertex_count, from->triangle_count, error));
    put_points(to->position, from->position, from->vertex_count, from->metres_per_unit, from->up_z);
    memcpy(to->triangle, from->triangle, from->triangle_count * sizeof *to->triangle);
    return check_points((const float(*)[3])to->position, to->vertex_count, error);
}

static Result set_mesh(TractrixScene *scene, uint32_t body, const TractrixMesh *asked, Error *error)
{
    TractrixMesh from;
    Mesh mesh = {0};
    if (body >= scene->scene.body_count)
        return error_set(error, RESULT_USAGE, "body: got %u, expected 0 to %u", body,
                         scene->scene.body_count - 1);
    TRY(library_take(&from, sizeof from, asked, sizeof from, "mesh", error));
    TRY(check_mesh(&from, error));
    Result result = copy_mesh(&mesh, &from, error);
    if (result != RESULT_OK) {
        mesh_destroy(&mesh);
        return result;
    }
    mesh_destroy(&scene->meshes[body].mesh);
    scene->meshes[body] = (GivenMesh){mesh, from.deforms};
    return RESULT_OK;
}

static Result set_only_mesh(TractrixScene *scene, const TractrixMesh *mesh, Error *error)
{
    if (scene->scene.body_count > 1)
        return error_set(error, RESULT_USAGE,
                         "mesh: the scene has %u bodies, each with a mesh of its own: expected a "
                         "scene of one body, or tractrix_scene_set_body_mesh",
                         scene->scene.body_count);
    return mesh ? set_mesh(scene, 0, mesh, error) : set(scene, -1, "mesh", "", error);
}

TractrixResult tractrix_scene_set_mesh(TractrixScene *scene, const TractrixMesh *mesh,
                                       TractrixError *error)
{
    LIBRARY_CALL;
    Error why = {{0}};
    if (!scene) return library_refuse(error, "scene: got NULL");
    return library_end(set_only_mesh(scene, mesh, &why), &why, error);
}

TractrixResult tractrix_scene_set_body_mesh(TractrixScene *scene, uint32_t body,
                                            const TractrixMesh *mesh, TractrixError *error)
{
    LIBRARY_CALL;
    Error why = {{0}};
    if (!scene) return library_refuse(error, "scene: got NULL");
    return library_end(set_mesh(scene, body, mesh, &why), &why, error);
}
