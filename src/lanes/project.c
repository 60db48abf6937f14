// SPDX-License-Identifier: MIT
// Processes a tile of strands at a time, a strand for each lane, until it is known which points are
// kept. Then it processes each strand alone; kept points are packed, so that loops over them are
// vectorised, too.
#include "lanes/project.h"

#include "base/room.h"

#include "lanes/shadow_tile.h"

#include "glsl/kernel/ribbon.h"

#include <stdlib.h>

enum { BESIDE = W }; // spare room behind a strand's last point, so loops may run past it
// A ribbon of more than 1 px has at most 1 / MOST_SHARE of its strand's parts.
enum { MOST_SHARE = 16 };

// A point of each strand of a tile.
typedef struct Row {
    float x[W], y[W], inverse_w[W], half_width[W];
} Row;

// The kept points of a strand, and properties of the ribbons that begin there.
typedef struct Kept {
    float *x, *y, *inverse_w, *half_width;
    float *way_x, *way_y;               // unit direction of the ribbon; [-1] is 0
    float *left, *top, *right, *bottom; // px whose centres it may touch
    uint32_t *number;                   // index of the point on the strand
    uint8_t *seen;
} Kept;

typedef struct Project {
    Projection *to;
    const LaneHairs *hairs;
    const DrawParams *draw;
    const Hidden *hidden;
    float far;
    size_t most; // largest number of points of a strand
} Project;

// --- Scratch memory of a thread.

enum { KEPT_ARRAYS = 10 };

static size_t row_floats(size_t most)
{
    return most * (sizeof(Row) / sizeof(float));
}

static size_t kept_floats(size_t most)
{
    return most + 2 * BESIDE;
}

static size_t scratch_floats(size_t most)
{
    return row_floats(most) + (KEPT_ARRAYS + 1) * kept_floats(most) + (most + 3) / 4 + most / 2 +
           8 + 2 * BESIDE;
}

static Kept open_kept(float *memory, size_t most)
{
    size_t n = kept_floats(most);
    float *at = memory + row_floats(most) + BESIDE;
    return (Kept){.x = at,
                  .y = at + n,
                  .inverse_w = at + 2 * n,
                  .half_width = at + 3 * n,
                  .way_x = at + 4 * n,
                  .way_y = at + 5 * n,
                  .left = at + 6 * n,
                  .top = at + 7 * n,
                  .right = at + 8 * n,
                  .bottom = at + 9 * n,
                  .number = (uint32_t *)(void *)(at + 10 * n),
                  .seen = (uint8_t *)(void *)(at + 11 * n)};
}

static uint16_t *open_masks(float *memory, size_t most)
{
    return (uint16_t *)(void *)(memory + row_floats(most) + 11 * kept_floats(most) + BESIDE +
                                (most + 3) / 4 + BESIDE);
}

// --- Points of a tile.

SIMD_INLINE void find_clip(const DrawParams *draw, const float x[3][W], float clip[3][W])
{
    const vec4 *m = draw->clip_from_world;
    for (int i = 0; i < W; ++i) {
        float a = x[0][i], b = x[1][i], c = x[2][i];
        clip[0][i] = m[0][0] * a + m[1][0] * b + m[2][0] * c + m[3][0];
        clip[1][i] = m[0][1] * a + m[1][1] * b + m[2][1] * c + m[3][1];
        clip[2][i] = m[0][3] * a + m[1][3] * b + m[2][3] * c + m[3][3];
    }
}

// Moves points in front of the near plane (`x`, clip coordinates) to that plane, towards the
// neighbour that is behind it.
SIMD_INLINE void move_to_near(float near, float x[3][W], const float before[3][W],
                              const float after[3][W])
{
    for (int i = 0; i < W; ++i) {
        bool on = after[2][i] >= near, moves = (x[2][i] < near) & (on | (before[2][i] >= near));
        float w = on ? after[2][i] : before[2][i],
              share = moves ? (near - x[2][i]) / simd_max(w - x[2][i], 1e-20f) : 0;
        for (int c = 0; c < 3; ++c)
            x[c][i] += share * ((on ? after[c][i] : before[c][i]) - x[c][i]);
    }
}

SIMD_INLINE void find_row(const DrawParams *draw, const float clip[3][W], const float radius[W],
                          Row *row)
{
    for (int i = 0; i < W; ++i) {
        RibbonPoint p = ribbon_project(clip[0][i], clip[1][i], clip[2][i], radius[i], draw->width,
                                       draw->height, draw->near_distance, draw->focal);
        row->x[i] = p.x, row->y[i] = p.y;
        row->inverse_w[i] = p.inverse_w, row->half_width[i] = p.half_width;
    }
}

SIMD_INLINE void find_rows(const Project *project, const Tile *tile, int points, Row *rows)
{
    const DrawParams *draw = project->draw;
    float own[3][W], radius[W], clip[3][3][W];
    find_clip(draw, find_points(tile, 0, own), clip[0]);
    memcpy(clip[2], clip[0], sizeof *clip); // the first point is its own predecessor
    for (int k = 0; k < points; ++k) {
        float(*here)[W] = clip[k % 3], (*after)[W] = clip[(k + 1) % 3],
        (*before)[W] = clip[(k + 2) % 3], moved[3][W], least = 1e30f;
        if (k + 1 < points)
            find_clip(draw, find_points(tile, k + 1, own), after);
        else
            memcpy(after, here, sizeof *clip);
        find_radii(tile, k, radius);
        memcpy(moved, here, sizeof moved);
        for (int i = 0; i < W; ++i) least = simd_min(here[2][i], least);
        if (least < draw->near_distance)
            move_to_near(draw->near_distance, moved, (const float(*)[W])before,
                         (const float(*)[W])after);
        find_row(draw, (const float(*)[W])moved, radius, &rows[k]);
    }
}

SIMD_INLINE RibbonPoint point_of(const Row *row, int i)
{
    RibbonPoint p = {row->x[i], row->y[i], row->inverse_w[i], row->half_width[i]};
    return p;
}

// Decides which points are kept, one bit for each strand: the first and the last, and each point
// after which the ribbon would bend too much or become too long. Colours change along a strand, so
// a ribbon of more than 1 px is only a small part of it.
SIMD_INLINE void keep_points(const Row *rows, int points, float far, uint16_t *masks)
{
    Row kept = rows[0];
    float bent[W];
    int from[W], most = points / MOST_SHARE;
    for (int i = 0; i < W; ++i) bent[i] = 0, from[i] = 0;
    masks[0] = masks[points - 1] = 0xffff;
    for (int j = 2; j < points; ++j) {
        const Row *here = &rows[j], *before = &rows[j - 1];
        uint32_t ends[W], mask = 0;
        for (int i = 0; i < W; ++i) {
            float x = here->x[i] - kept.x[i], y = here->y[i] - kept.y[i],
                  sum = bent[i] +
                        ribbon_bend(point_of(&kept, i), point_of(before, i), point_of(here, i));
            float longest = j - from[i] > most ? simd_min(far, 1) : far;
            bool end = (sum > 1) | (x * x + y * y > longest * longest);
            ends[i] = end;
            from[i] = end ? j - 1 : from[i];
            bent[i] = end ? 0 : sum;
            kept.x[i] = end ? before->x[i] : kept.x[i];
            kept.y[i] = end ? before->y[i] : kept.y[i];
            kept.inverse_w[i] = end ? before->inverse_w[i] : kept.inverse_w[i];
            kept.half_width[i] = end ? before->half_width[i] : kept.half_width[i];
        }
        for (int i = 0; i < W; ++i) mask |= ends[i] << i;
        masks[j - 1] = (uint16_t)mask;
    }
}

// --- A strand.

SIMD_INLINE int pack_points(const Row *rows, const uint16_t *masks, int points, int i, Kept *kept)
{
    int n = 0;
    for (int j = 0; j < points; ++j) {
        const Row *row = &rows[j];
        kept->x[n] = row->x[i], kept->y[n] = row->y[i];
        kept->inverse_w[n] = row->inverse_w[i], kept->half_width[n] = row->half_width[i];
        kept->number[n] = (uint32_t)j;
        n += masks[j] >> i & 1;
    }
    for (int j = n; j < n + BESIDE; ++j) {
        kept->x[j] = kept->x[n - 1], kept->y[j] = kept->y[n - 1];
        kept->inverse_w[j] = kept->half_width[j] = 0;
    }
    return n;
}

SIMD_INLINE void find_directions(const Kept *kept, int count)
{
    float *x = kept->way_x, *y = kept->way_y;
    x[-1] = y[-1] = 0;
    for (int j = 0; j < count; ++j) {
        float a = kept->x[j + 1] - kept->x[j], b = kept->y[j + 1] - kept->y[j],
              square = a * a + b * b, scale = 1 / sqrtf(simd_max(square, 1e-20f));
        bool there = (square > 1e-12f) & (kept->inverse_w[j] > 0) & (kept->inverse_w[j + 1] > 0);
        scale = there ? scale : 0;
        x[j] = a * scale, y[j] = b * scale;
    }
    x[count] = y[count] = 0;
}

SIMD_INLINE void widen(const Kept *kept, int count, const DrawParams *draw)
{
    for (int j = 0; j < count; ++j)
        kept->half_width[j] *= ribbon_widening(
            kept->way_x[j - 1] + kept->way_x[j], kept->way_y[j - 1] + kept->way_y[j],
            kept->x[j] - draw->axis[0], kept->y[j] - draw->axis[1], draw->focal);
}

// The box of pixels whose centres the ribbon from point j can reach.
SIMD_INLINE void find_boxes(const Kept *kept, int count, const DrawParams *draw,
                            float *restrict lefts, float *restrict tops, float *restrict rights,
                            float *restrict bottoms)
{
    const float *x = kept->way_x, *y = kept->way_y, *at_x = kept->x, *at_y = kept->y,
                *half_width = kept->half_width, across = draw->width - 1, down = draw->height - 1;
    for (int j = 0; j < count - 1; ++j) {
        float reach =
            simd_max(half_width[j], half_width[j + 1]) + 0.5f * (fabsf(x[j]) + fabsf(y[j]));
        RibbonBound first = ribbon_bound(x[j], y[j], x[j - 1], y[j - 1]),
                    last = ribbon_bound(x[j], y[j], x[j + 1], y[j + 1]);
        float over = ribbon_overhang(first, x[j], y[j], reach),
              beyond = ribbon_overhang(last, x[j], y[j], reach), a = at_x[j] - x[j] * over,
              b = at_y[j] - y[j] * over, c = at_x[j + 1] + x[j] * beyond,
              d = at_y[j + 1] + y[j] * beyond, wide = reach * fabsf(y[j]),
              tall = reach * fabsf(x[j]);
        float left = simd_max(simd_ceil(simd_max(simd_min(a, c) - wide - 0.5f, -1)), 0),
              top = simd_max(simd_ceil(simd_max(simd_min(b, d) - tall - 0.5f, -1)), 0),
              right = simd_min(simd_max(a, c) + wide - 0.5f, across),
              bottom = simd_min(simd_max(b, d) + tall - 0.5f, down);
        lefts[j] = left, tops[j] = top, rights[j] = right, bottoms[j] = bottom;
    }
}

static void store_points(const Kept *kept, int count, ScreenPoint *points)
{
    for (int j = 0; j < count; ++j)
        points[j] = (ScreenPoint){kept->x[j], kept->y[j], kept->inverse_w[j],
                                  pack_level(kept->half_width[j]) | kept->number[j] << 16};
    // The sign bit marks the last point, also for 0.
    points[count - 1].inverse_w = -points[count - 1].inverse_w;
}

static bool make_room(Projection *to, int part, size_t count)
{
    if (to->item_room[part] >= count) return true;
    size_t room = count + count / 2;
    RibbonItem *items = realloc(to->items[part], room * sizeof *items);
    if (!items) return false;
    to->items[part] = items;
    to->item_room[part] = room;
    return true;
}

// Lists the ribbons that may be visible. Strands that the base hides are only counted.
static void list_ribbons(const Project *project, const Kept *kept, int count, size_t slot, int part)
{
    Projection *to = project->to;
    size_t n = to->item_count[part], first = n;
    bool hides = false;
    for (int j = 0; j < count - 1; ++j) {
        if (!(kept->left[j] <= kept->right[j] && kept->top[j] <= kept->bottom[j]) ||
            (kept->way_x[j] == 0 && kept->way_y[j] == 0))
            continue;
        int left = (int)kept->left[j], top = (int)kept->top[j], right = (int)kept->right[j],
            bottom = (int)kept->bottom[j];
        float a = kept->inverse_w[j], b = kept->inverse_w[j + 1], depth = 0.5f * (a + b);
        if (project->hidden &&
            hidden_hides(project->hidden, left, top, right, bottom, 1.0001f * (a > b ? a : b))) {
            hides = true;
            continue;
        }
        to->items[part][n++] = (RibbonItem){BITS_OF_FLOAT(depth),
                                            (uint32_t)(slot + (size_t)j),
                                            (uint16_t)(left / BLOCK_WIDTH),
                                            (uint16_t)(top / BLOCK_HEIGHT),
                                            (uint16_t)(right / BLOCK_WIDTH),
                                            (uint16_t)(bottom / BLOCK_HEIGHT)};
    }
    to->item_count[part] = n;
    to->hidden[part] += n == first && hides;
    to->culled[part] += n == first && !hides;
}

SIMD_INLINE void project_tile(const Project *project, const LaneHair *hair, size_t number, int part)
{
    Projection *to = project->to;
    int points = (int)hair->points;
    Tile tile = open_tile_at(&hair->caster, number);
    Row *rows = (Row *)(void *)to->scratch[part];
    Kept kept = open_kept(to->scratch[part], project->most);
    uint16_t *masks = open_masks(to->scratch[part], project->most);
    if (!make_room(to, part, to->item_count[part] + (size_t)points * W)) {
        to->short_of_memory[part] = true;
        return;
    }
    find_rows(project, &tile, points, rows);
    keep_points(rows, points, project->far, masks);
    for (int i = 0; i < tile.strands; ++i) {
        size_t slot = hair->first_point + (number * W + (size_t)i) * hair->points;
        if (hair->caster.material.opacity * tile.share[i] < RIBBON_LEAST_OPACITY) {
            ++to->culled[part];
            continue;
        }
        int count = pack_points(rows, masks, points, i, &kept);
        find_directions(&kept, count);
        widen(&kept, count, project->draw);
        find_boxes(&kept, count, project->draw, kept.left, kept.top, kept.right, kept.bottom);
        store_points(&kept, count, to->points + slot);
        list_ribbons(project, &kept, count, slot, part);
    }
}

SIMD_INLINE void project_hairs(const Project *project, int part)
{
    Projection *to = project->to;
    size_t first = project->hairs->tiles * (size_t)part / (size_t)to->parts,
           end = project->hairs->tiles * ((size_t)part + 1) / (size_t)to->parts;
    to->item_count[part] = 0;
    to->culled[part] = to->hidden[part] = 0;
    to->short_of_memory[part] = false;
    for (uint32_t h = 0; h < project->hairs->count; ++h) {
        const LaneHair *hair = &project->hairs->list[h];
        for (size_t t = 0; t < hair->tiles; ++t)
            if (hair->first_tile + t >= first && hair->first_tile + t < end)
                project_tile(project, hair, t, part);
    }
}

SIMD_STAGE(project_hairs, Project)

// --- All strands.

static Result make_scratch(Projection *projection, size_t points, size_t most, Error *error)
{
    room_make(&projection->points, &projection->point_room, points, sizeof *projection->points);
    const bool grows = projection->scratch_room < most;
    if (grows) projection->scratch_room = 0;
    for (int part = 0; part < projection->parts && grows; ++part) {
        free(projection->scratch[part]);
        projection->scratch[part] = malloc(scratch_floats(most) * sizeof(float));
        if (!projection->scratch[part]) projection->point_room = 0;
    }
    if (!projection->point_room)
        return error_set(error, RESULT_FAILED, "no memory to project %zu points of hair", points);
    if (grows) projection->scratch_room = most;
    return RESULT_OK;
}

Result projection_find(Projection *projection, const LaneHairs *hairs, const DrawParams *draw,
                       const Hidden *hidden, float far, int parts, Error *error)
{
    Project project = {projection, hairs, draw, hidden, far, 2};
    for (uint32_t i = 0; i < hairs->count; ++i)
        if (hairs->list[i].points > project.most) project.most = hairs->list[i].points;
    projection->parts = parts;
    TRY(make_scratch(projection, hairs->points + 2, project.most, error));
    project.most = projection->scratch_room;
    run_project_hairs(&project, projection->parts);
    for (int part = 0; part < projection->parts; ++part)
        if (projection->short_of_memory[part])
            return error_set(error, RESULT_FAILED, "no memory to list ribbons of hair");
    return RESULT_OK;
}

void projection_destroy(Projection *projection)
{
    free(projection->points);
    for (int part = 0; part < PARALLEL_MOST; ++part) {
        free(projection->items[part]);
        free(projection->scratch[part]);
    }
    *projection = (Projection){0};
}
