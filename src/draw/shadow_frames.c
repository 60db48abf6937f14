// SPDX-License-Identifier: MIT
#include "draw/shadow_frames.h"

#include <math.h>
#include <string.h>

enum {
    HAIR_MARGIN = 3, // texels at the edges of a map without hair
    MESH_MARGIN = 6, // empty texels at the edges: a point outside the map samples only these
};

static const double UNIT = 1 << 16; // steps of the integer sums for one fibre
static const double SUM_MAX = 2e9;  // largest sum, in steps, without overflow

void shadow_frames_begin(ShadowFrames *frames, const Light *lights, uint32_t light_count,
                         const float middle[3], const ShadowMesh *mesh, uint64_t revision)
{
    memset(frames, 0, sizeof *frames);
    ShadowKey *key = &frames->key;
    key->light_count = light_count;
    key->revision = revision;
    key->hair = 0xcbf29ce484222325; // FNV-1a
    key->mesh = *mesh;
    for (uint32_t i = 0; i < light_count; ++i) {
        memcpy(&key->lights[i], &lights[i], sizeof *lights);
        if (!lights[i].shadow || lights[i].intensity <= 0) continue;
        frames->views[frames->count] = light_frame_view(&lights[i], middle);
        frames->lights[frames->count++] = (int)i;
    }
}

static uint64_t add_bytes(uint64_t hash, const void *bytes, size_t size)
{
    for (size_t i = 0; i < size; ++i) hash = (hash ^ ((const uint8_t *)bytes)[i]) * 0x100000001b3;
    return hash;
}

static uint64_t add_hair(uint64_t hash, const void *batch, const MaterialParams *m)
{
    const float floats[] = {m->radius, m->tip_ratio, m->shadow_opacity, m->last_share};
    const uint words[] = {m->vertex_count, m->drawn_strands, m->smooth_parts, m->smooth_curve,
                          m->last_strand};
    hash = add_bytes(hash, &batch, sizeof batch);
    hash = add_bytes(hash, floats, sizeof floats);
    return add_bytes(hash, words, sizeof words);
}

void shadow_frames_add(ShadowFrames *frames, const void *batch, const MaterialParams *material,
                       bool painted)
{
    double particles = (double)material->drawn_strands * material->vertex_count,
           depth = (double)fibre_depth(material->shadow_opacity, 100) * material->drawn_strands *
                   (material->vertex_count - 1) * material->smooth_parts;
    frames->key.hair = add_hair(frames->key.hair, batch, material);
    frames->particles += particles;
    frames->radius += particles * (double)material->radius;
    frames->opacity += particles * (double)material->shadow_opacity;
    frames->painted += painted ? depth : 0;
    frames->plain += painted ? 0 : depth;
    frames->plain_width += painted ? 0 : depth * 2 * (double)material->radius;
}

bool shadow_frames_same(const ShadowFrames *frames, const ShadowKey *drawn)
{
    return frames->key.revision && memcmp(&frames->key, drawn, sizeof *drawn) == 0;
}

static float reach_of(const LightView *view)
{
    return (float)(view->perspective ? LIGHT_FRAME_WIDE : LIGHT_FRAME_FAR);
}

static void set_rows(mat4 matrix, double rows[4][4])
{
    for (int k = 0; k < 4; ++k)
        for (int i = 0; i < 4; ++i) matrix[k][i] = (float)rows[k][i];
}

CastParams shadow_frames_box(const ShadowFrames *frames, int i)
{
    const LightView *view = &frames->views[i];
    double rows[4][4];
    CastParams params = {.map = i, .limit = (float)LIGHT_FRAME_FAR, .reach = reach_of(view)};
    for (int k = 0; k < 4; ++k) light_frame_row(view, k, rows[k]);
    set_rows(params.from_world, rows);
    return params;
}

// --- The mesh.

static void empty_box(double box[6])
{
    for (int k = 0; k < 3; ++k) box[k] = LIGHT_FRAME_FAR, box[k + 3] = -LIGHT_FRAME_FAR;
}

// Widens the box to include the mesh's box.
static void add_mesh_box(const ShadowMesh *mesh, const LightView *view, double box[6])
{
    for (int corner = 0; corner < 8; ++corner) {
        vec3 x;
        versor turn = {0};
        double world[3], place[3];
        memcpy(turn, mesh->rotation, sizeof turn);
        for (int k = 0; k < 3; ++k) x[k] = (corner >> k & 1 ? mesh->high : mesh->low)[k];
        glm_quat_rotatev(turn, x, x);
        for (int k = 0; k < 3; ++k) world[k] = (double)(x[k] + mesh->translation[k]);
        if (!light_frame_place(view, world, place)) continue;
        for (int k = 0; k < 3; ++k) {
            double bound = k < 2 && view->perspective ? LIGHT_FRAME_WIDE : LIGHT_FRAME_FAR;
            double value = fmin(fmax(place[k], -bound), bound);
            box[k] = fmin(box[k], value);
            box[k + 3] = fmax(box[k + 3], value);
        }
    }
}

// Depth bias. A texel stores the depth at its centre; on a surface at 45 degrees to the light the
// error is one texel. The bias is two texels in depth, and 1.5 texels along the normal. For a lamp,
// the texel size is taken half-way between near and far, and the slope of depth at the far end,
// where it is least.
static void set_mesh_frame(ShadowParams *params, int map, const LightView *view,
                           const double box[6], double wide)
{
    LightFrame frame = light_frame_drawn(view, box, SHADOW_MESH_SIDE, MESH_MARGIN);
    double near = frame.depth[0], far = frame.depth[1], texel = frame.texel,
           shift = 2 * texel / (far - near);
    if (view->perspective) {
        texel *= 0.5 * (near + far);
        shift = 2 * texel * near / (far * (far - near));
    }
    // Before a lamp depth on the screen is linear in 1 / distance, as are the places that a ray
    // meets.
    params->wide[map][1] =
        (float)(wide * (far - near) / (view->perspective ? far * near * frame.texel : frame.texel));
    set_rows(params->mesh_from_world[map], frame.rows);
    params->place[map][2] = (float)shift;
    params->mesh_lift = fmaxf(params->mesh_lift, (float)(1.5 * texel));
}

// The window of the mesh's map encloses only the mesh, so the map can be kept while the head is
// still; points outside it are not shadowed by the mesh. Its depth range is at least a tenth of its
// width: otherwise the depths of a mesh that is flat towards the light would be mere rounding
// errors. A lamp may stand inside the mesh's box, so its window encloses the hair as well.
static void place_mesh(ShadowParams *params, int map, const ShadowMesh *mesh, const LightView *view,
                       double box[6], double wide)
{
    if (!view->perspective) empty_box(box);
    add_mesh_box(mesh, view, box);
    if (!view->perspective)
        box[5] = fmax(box[5], box[2] + 0.1 * fmax(box[3] - box[0], box[4] - box[1]));
    set_mesh_frame(params, map, view, box, wide);
}

ShadowMeshKey shadow_frames_mesh_key(const ShadowFrames *frames)
{
    ShadowMeshKey key;
    memset(&key, 0, sizeof key);
    memcpy(&key.mesh, &frames->key.mesh, sizeof key.mesh);
    key.maps = frames->params.maps;
    memcpy(key.frames, frames->params.mesh_from_world, sizeof key.frames);
    return key;
}

// --- Hair.

// The mean fibre of approximated shadow maps: fibres per optical depth, and the transmittance of
// one fibre, which is at least 1/1000.
static void find_mean_fibre(const ShadowFrames *frames, float spacing, ShadowParams *params)
{
    const double least_left = 1e-3;
    double weight = frames->particles, radius = frames->radius;
    if (weight == 0) weight = 1, radius = 1;
    params->fibres = (float)(weight / (radius * (double)spacing));
    params->passed = (float)log2(fmax(1 - frames->opacity / weight, least_left));
}

// Steps of the sums for one fibre: as many as possible without overflow if all segments lie in one
// texel.
static float find_unit(const ShadowFrames *frames, bool perspective, double texels)
{
    double plain = perspective ? frames->plain : fmin(frames->plain_width * texels, frames->plain);
    return (float)fmin(UNIT, SUM_MAX / (1 + frames->painted + plain));
}

// The tangent of a directional light's radius, or a lamp's radius in metres.
static double find_width(const Light *light)
{
    double radius = (double)light->radius;
    return light->kind == LIGHT_DIRECTIONAL ? tan(radius * M_PI / 180) : radius;
}

// Rays to two rings of a disc, which have together the disc's mean and variance, and over a texel.
static void find_rays(ShadowParams *params)
{
    enum { INNER = 3, OUTER = LEFT_RAYS - INNER };
    const double inner = sqrt(0.5 * INNER / LEFT_RAYS),
                 outer = sqrt((0.5 * LEFT_RAYS - INNER * inner * inner) / OUTER);
    for (int i = 0; i < LEFT_RAYS; ++i) {
        bool near = i < INNER;
        double off = near ? inner : outer,
               turn = 2 * M_PI * (near ? i / (double)INNER : (i + 0.25) / OUTER);
        params->ray[i][0] = (float)(off * cos(turn));
        params->ray[i][1] = (float)(off * sin(turn));
        params->ray[i][2] = (float)((i % 4 + 0.5) / 4 - 0.5);
        params->ray[i][3] = (float)((i * 3 % LEFT_RAYS + 0.5) / LEFT_RAYS - 0.5);
    }
}

// Rays that are spread evenly over a disc by the golden angle (Vogel 1979, A better way to
// construct the sunflower head), and over a texel.
static void find_spread(ShadowParams *params)
{
    const double golden = M_PI * (3 - sqrt(5));
    for (int i = 0; i < LEFT_SPREAD; ++i) {
        double off = sqrt((i + 0.5) / LEFT_SPREAD);
        params->spread[i][0] = (float)(off * cos(golden * i));
        params->spread[i][1] = (float)(off * sin(golden * i));
        params->spread[i][2] = (float)((i % 4 + 0.5) / 4 - 0.5);
        params->spread[i][3] = (float)((i * 7 % LEFT_SPREAD + 0.5) / LEFT_SPREAD - 0.5);
    }
}

static void place_hair(ShadowFrames *frames, int map, int i, const double box[6])
{
    const LightView *view = &frames->views[i];
    ShadowParams *params = &frames->params;
    LightFrame frame = light_frame_steady(view, box, params->side, HAIR_MARGIN);
    double distance = view->perspective ? 0.5 * (frame.depth[0] + frame.depth[1]) : 1;
    set_rows(params->from_world[map], frame.rows);
    params->place[map][0] = (float)frames->lights[i];
    params->place[map][1] = (float)(frame.depth[1] - frame.depth[0]);
    params->place[map][3] = (float)(1 / (frame.texel * distance));
    params->wide[map][0] = (float)(find_width(&frames->key.lights[frames->lights[i]]) / distance *
                                   (frame.depth[1] - frame.depth[0]) / (frame.texel * distance));
    frames->casts[map] = (CastParams){.side = params->side,
                                      .map = map,
                                      .texels = (float)(1 / frame.texel),
                                      .unit = find_unit(frames, view->perspective, 1 / frame.texel),
                                      .reach = reach_of(view),
                                      .limit = (float)LIGHT_FRAME_FAR};
    set_rows(frames->casts[map].from_world, frame.rows);
}

void shadow_frames_place(ShadowFrames *frames, int side, float spacing, double (*boxes)[6])
{
    ShadowParams *params = &frames->params;
    const ShadowMesh *mesh = &frames->key.mesh;
    memset(params, 0, sizeof *params);
    params->side = side;
    params->mesh_side = SHADOW_MESH_SIDE;
    find_mean_fibre(frames, spacing, params);
    find_rays(params);
    find_spread(params);
    for (int i = 0; i < frames->count; ++i) {
        double *box = boxes[i];
        if (!(box[0] <= box[3])) {
            if (!mesh->version) continue;
            empty_box(box);
            add_mesh_box(mesh, &frames->views[i], box);
        }
        place_hair(frames, params->maps, i, box);
        if (mesh->version)
            place_mesh(params, params->maps, mesh, &frames->views[i], box,
                       find_width(&frames->key.lights[frames->lights[i]]));
        ++params->maps;
    }
}
