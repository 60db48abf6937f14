// SPDX-License-Identifier: MIT
#include "reference/image_reference.h"
#include "base/double3.h"
#include "base/parallel.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

// --- Shapes.

// Least value of 1 + n0.n1 at a joint, which limits the length of mitres.
static const double LEAST_COSINE = 0.25;

// The projection of a section. For a light, width and height are 0 and the focal length is 1.
typedef struct Projector {
    const ReferenceScene *scene;
    const ReferenceItem *item;
    const LightView *light;                     // NULL for the camera
    double width, height, focal, near_distance; // px, px, px, m
    double least;                               // px, thinner ribbons are omitted
    double base[3];                             // the section's colour, linear
} Projector;

// A vertex of a strand in the space of the camera or of the light.
typedef struct Vertex {
    double eye[3]; // in the camera's frame: x right, y up, z backwards, m; for a light u, v, depth
    bool seen;
    double radius;
    double color[3];
} Vertex;

// The vertex projected to the screen.
typedef struct Point {
    double x, y; // px
    double inverse_w, half_width;
    double color[3];
} Point;

static void unit(double v[3])
{
    double length = sqrt(double3_dot(v, v));
    if (length == 0) v[1] = length = 1;
    for (int k = 0; k < 3; ++k) v[k] /= length;
}

static double angle(const double a[3], const double b[3])
{
    return acos(fmin(fmax(double3_dot(a, b), -1), 1));
}

// The irradiance at x from the light, on a surface facing the light, and the unit vector towards
// the light (scene.h).
static double reaching(const Light *light, const double x[3], double to_light[3])
{
    bool far = light->kind == LIGHT_DIRECTIONAL;
    double square = 0, axis = 0;
    for (int k = 0; k < 3; ++k)
        to_light[k] = far ? (double)light->direction[k] : (double)light->position[k] - x[k];
    square = double3_dot(to_light, to_light);
    unit(to_light);
    if (far) return light->intensity;
    for (int k = 0; k < 3; ++k) axis -= (double)light->direction[k] * to_light[k];
    double outer = cos(light->outer_deg * acos(-1) / 180),
           inner = cos(light->inner_deg * acos(-1) / 180);
    double inside =
        light->kind == LIGHT_SPOT ? fmin(fmax((axis - outer) / (inner - outer), 0), 1) : 1;
    double distance = light->distance;
    return light->intensity * fmin(distance * distance / square, 1e6) * inside * inside;
}

// The weight of the sky, the rest is the ground's. It is 1/2 if the visible side of the fibre faces
// the horizon.
static double sky_share(const ReferenceVertex *v)
{
    double along = double3_dot(v->tangent, v->to_eye), side[3];
    for (int k = 0; k < 3; ++k) side[k] = v->to_eye[k] - along * v->tangent[k];
    unit(side);
    return 0.5 + acos(-1) / 8 * side[1];
}

// Kajiya & Kay (1989) with the highlights of Scheuermann (2004). Light that arrives at angle t to
// the fibre leaves on the cone at pi - t. The first highlight is shifted by twice the scales' tilt;
// the second, which has the fibre's colour, by three times the tilt in the opposite direction.
static void shade_kajiya(const ReferenceScene *scene, const SectionParams *m,
                         const ReferenceVertex *v, double color[3])
{
    double e = angle(v->tangent, v->to_eye), tilt = m->cone_angle * acos(-1) / 180;
    double sky = sky_share(v);
    for (int k = 0; k < 3; ++k)
        color[k] = m->ambient * v->base[k] *
                   (sky * (scene->sky ? scene->sky[k] : 1) +
                    (1 - sky) * (scene->ground ? scene->ground[k] : 1));
    for (uint32_t i = 0; i < scene->light_count; ++i) {
        const Light *light = &scene->lights[i];
        double to_light[3], intensity = v->left[i] * reaching(light, v->position, to_light);
        double t = angle(v->tangent, to_light), cone = acos(-1) - t;
        double first = fmax(cos(cone + 2 * tilt - e), 0),
               second = fmax(cos(cone - 3 * tilt - e), 0);
        double white = m->specular1 * pow(first, m->exponent1);
        double tinted = m->diffuse * sin(t) + m->specular2 * pow(second, m->exponent2);
        for (int k = 0; k < 3; ++k)
            color[k] += intensity * light->color[k] * (white + tinted * v->base[k]);
    }
}

// A random number in -1 .. 1, identical to that of glsl/common/hash.h.
static double hash_signed(uint32_t id)
{
    id = (id ^ (id >> 16)) * 0x7feb352du;
    id = (id ^ (id >> 15)) * 0x846ca68bu;
    id ^= id >> 16;
    return (id >> 8) * (2.0 / 16777215) - 1;
}

static void place(const Projector *p, const float x[3], Vertex *v)
{
    const View *view = p->scene->view;
    if (p->light) {
        v->seen = light_frame_place(p->light, (double[3]){x[0], x[1], x[2]}, v->eye);
        return;
    }
    for (int k = 0; k < 3; ++k) {
        v->eye[k] = view->view[3][k];
        for (int c = 0; c < 3; ++c) v->eye[k] += (double)view->view[c][k] * x[c];
    }
    v->seen = -v->eye[2] >= p->near_distance;
}

static double radius_at(const ReferenceItem *item, uint32_t vertex, uint32_t j, uint32_t n)
{
    if (item->paint && item->paint->thickness)
        return (double)item->radius * item->paint->thickness[vertex];
    return item->radius * (1 - (1 - (double)item->material->tip_ratio) * j / (n - 1));
}

static Vertex find_vertex(const Projector *p, uint32_t strand, uint32_t j, const double tint[3])
{
    const Strands *strands = p->item->strands;
    const SectionParams *m = p->item->material;
    uint32_t n = strands_size(strands, strand);
    const float(*x)[3] = (const float(*)[3])strands->position + strands->first[strand];
    const float *before = x[j ? j - 1 : 0], *after = x[j + 1 < n ? j + 1 : j];
    const Paint *paint = p->item->paint;
    uint32_t vertex = strands->first[strand] + j;
    ReferenceVertex at;
    Vertex v = {.radius = radius_at(p->item, vertex, j, n)};
    place(p, x[j], &v);
    if (p->light) return v;
    for (int k = 0; k < 3; ++k) {
        at.position[k] = x[j][k];
        at.tangent[k] = (double)after[k] - before[k];
        at.to_eye[k] = (double)p->scene->view->eye[k] - x[j][k];
        at.base[k] = tint[k] * (paint && paint->color ? paint->color[vertex][k] : p->base[k]);
    }
    for (uint32_t i = 0; i < p->scene->light_count; ++i)
        at.left[i] = p->item->left ? p->item->left[i * strands->vertex_count + vertex] : 1;
    unit(at.tangent);
    unit(at.to_eye);
    (p->scene->shade ? p->scene->shade : shade_kajiya)(p->scene, m, &at, v.color);
    return v;
}

// The point between `from` and `to` on the near plane.
static Vertex clip(const Projector *p, const Vertex *from, const Vertex *to)
{
    Vertex v = *from;
    double share = (-p->near_distance - from->eye[2]) / (to->eye[2] - from->eye[2]);
    for (int k = 0; k < 3; ++k) {
        v.eye[k] += share * (to->eye[k] - from->eye[k]);
        v.color[k] += share * (to->color[k] - from->color[k]);
    }
    v.radius += share * (to->radius - from->radius);
    return v;
}

static Point project(const Projector *p, const Vertex *v)
{
    Point point = {.inverse_w = -1 / v->eye[2]};
    if (p->light) {
        bool lamp = p->light->perspective;
        return (Point){.x = v->eye[0],
                       .y = v->eye[1],
                       .inverse_w = lamp ? 1 / v->eye[2] : -v->eye[2],
                       .half_width = v->radius * (lamp ? 1 / v->eye[2] : 1)};
    }
    point.x = p->width / 2 + p->focal * v->eye[0] * point.inverse_w;
    point.y = p->height / 2 - p->focal * v->eye[1] * point.inverse_w;
    point.half_width = p->focal * v->radius * point.inverse_w;
    memcpy(point.color, v->color, sizeof point.color);
    return point;
}

// The vector from the centre line to the left edge, at a joint of ribbons with directions d0 and
// d1.
static void find_mitre(const Projector *p, const Point *at, const double d0[2], const double d1[2],
                       double mitre[2])
{
    double n[2] = {-d0[1] - d1[1], d0[0] + d1[0]}, length = hypot(n[0], n[1]);
    bool parallel = p->light && !p->light->perspective;
    double q =
        length > 0 && !parallel
            ? (n[0] * (at->x - p->width / 2) + n[1] * (at->y - p->height / 2)) / (length * p->focal)
            : 0;
    double scale =
        at->half_width * sqrt(1 + q * q) / fmax(1 + d0[0] * d1[0] + d0[1] * d1[1], LEAST_COSINE);
    mitre[0] = n[0] * scale;
    mitre[1] = n[1] * scale;
}

static void set_span(Shape *shape)
{
    shape->top = shape->bottom = shape->corner[0][1];
    for (int i = 1; i < shape->corners; ++i) {
        shape->top = fmin(shape->top, shape->corner[i][1]);
        shape->bottom = fmax(shape->bottom, shape->corner[i][1]);
    }
}

// The plane that is `first` at a and `last` at b, and constant across the ribbon.
static ShapePlane plane_between(const Point *a, const Point *b, double first, double last)
{
    double x = b->x - a->x, y = b->y - a->y, square = x * x + y * y;
    ShapePlane plane = {.dx = (last - first) * x / square, .dy = (last - first) * y / square};
    plane.base = first - plane.dx * a->x - plane.dy * a->y;
    plane.low = fmin(first, last);
    plane.high = fmax(first, last);
    return plane;
}

// d is the direction of the ribbon; `before` and `after` are those of its neighbours, 0 if there is
// none.
static void add_ribbon(Shapes *shapes, const Projector *p, const Point *a, const Point *b,
                       const double before[2], const double d[2], const double after[2],
                       double opacity)
{
    double first[2], last[2];
    find_mitre(p, a, before[0] || before[1] ? before : d, d, first);
    find_mitre(p, b, d, after[0] || after[1] ? after : d, last);
    Shape *shape = &shapes->shapes[shapes->count++];
    *shape = (Shape){.corners = 4,
                     .corner = {{a->x - first[0], a->y - first[1]},
                                {a->x + first[0], a->y + first[1]},
                                {b->x + last[0], b->y + last[1]},
                                {b->x - last[0], b->y - last[1]}},
                     .opacity = opacity,
                     .inverse_w = plane_between(a, b, a->inverse_w, b->inverse_w)};
    for (int k = 0; k < 3 && !p->light; ++k)
        shape->color[k] = plane_between(a, b, a->color[k], b->color[k]);
    set_span(shape);
}

typedef struct Segment {
    bool visible;
    Point a, b;
    double direction[2];
} Segment;

static Segment find_segment(const Projector *p, const Vertex *from, const Vertex *to)
{
    Segment segment = {0};
    if (p->light ? !from->seen || !to->seen : !from->seen && !to->seen) return segment;
    Vertex a = from->seen ? *from : clip(p, from, to), b = to->seen ? *to : clip(p, to, from);
    segment.a = project(p, &a);
    segment.b = project(p, &b);
    double x = segment.b.x - segment.a.x, y = segment.b.y - segment.a.y, length = hypot(x, y);
    segment.visible = length > p->least;
    segment.direction[0] = segment.visible ? x / length : 0;
    segment.direction[1] = segment.visible ? y / length : 0;
    return segment;
}

static void add_strand(Shapes *shapes, const Projector *p, uint32_t s)
{
    uint32_t n = strands_size(p->item->strands, s);
    const SectionParams *m = p->item->material;
    const Paint *paint = p->item->paint;
    bool alike = paint && paint->colors_from_file;
    uint32_t id = (p->item->first_id + s) ^ p->scene->seed;
    double brightness = alike ? 1 : 1 + m->color_variation * hash_signed(id);
    double warmth = alike ? 0 : m->warmth_variation * hash_signed(id + 0x9e3779b9u);
    double tint[] = {brightness * (1 + warmth), brightness, brightness * (1 - warmth)};
    double opacity = p->light ? m->shadow_opacity : m->opacity;
    if (paint && paint->color) opacity *= paint->color[p->item->strands->first[s]][3];
    Segment here = {0}, before = {0};
    Vertex from = find_vertex(p, s, 0, tint);
    for (uint32_t j = 1; j <= n; ++j) {
        Segment next = {0};
        if (j < n) {
            Vertex to = find_vertex(p, s, j, tint);
            next = find_segment(p, &from, &to);
            from = to;
        }
        if (here.visible)
            add_ribbon(shapes, p, &here.a, &here.b, before.direction, here.direction,
                       next.direction, opacity);
        before = here;
        here = next;
    }
}

static void add_triangle(Shapes *shapes, const Projector *p, const Mesh *mesh, uint32_t t)
{
    Shape *shape = &shapes->shapes[shapes->count];
    Point at[3];
    for (int i = 0; i < 3; ++i) {
        Vertex v = {0};
        place(p, mesh->position[mesh->triangle[t][i]], &v);
        if (!v.seen) return;
        at[i] = project(p, &v);
    }
    double ux = at[1].x - at[0].x, uy = at[1].y - at[0].y, vx = at[2].x - at[0].x,
           vy = at[2].y - at[0].y, area = ux * vy - uy * vx;
    if (area == 0) return;
    double u = at[1].inverse_w - at[0].inverse_w, v = at[2].inverse_w - at[0].inverse_w;
    ShapePlane depth = {.dx = (u * vy - v * uy) / area, .dy = (v * ux - u * vx) / area};
    depth.base = at[0].inverse_w - depth.dx * at[0].x - depth.dy * at[0].y;
    depth.low = fmin(fmin(at[0].inverse_w, at[1].inverse_w), at[2].inverse_w);
    depth.high = fmax(fmax(at[0].inverse_w, at[1].inverse_w), at[2].inverse_w);
    *shape = (Shape){.corners = 3, .opacity = 1, .inverse_w = depth};
    for (int i = 0; i < 3; ++i) {
        shape->corner[i][0] = at[i].x, shape->corner[i][1] = at[i].y;
        double color = p->scene->mesh_color[i];
        shape->color[i] = (ShapePlane){.base = color, .low = color, .high = color};
    }
    set_span(shape);
    ++shapes->count;
}

static Result create_shapes(Shapes *shapes, Projector *p, Error *error)
{
    const ReferenceScene *scene = p->scene;
    size_t count = scene->mesh ? scene->mesh->triangle_count : 0;
    for (uint32_t i = 0; i < scene->item_count; ++i) count += scene->items[i].strands->vertex_count;
    *shapes = (Shapes){.shapes = malloc((count + 1) * sizeof *shapes->shapes)};
    if (!shapes->shapes) return error_set(error, RESULT_FAILED, "no memory for %zu shapes", count);
    for (uint32_t i = 0; i < scene->item_count; ++i) {
        p->item = &scene->items[i];
        float base[3];
        paint_color(p->item->material, base);
        for (int k = 0; k < 3; ++k) p->base[k] = base[k];
        for (uint32_t s = 0; s < p->item->strands->strand_count; ++s) add_strand(shapes, p, s);
    }
    for (uint32_t t = 0; scene->mesh && t < scene->mesh->triangle_count; ++t)
        add_triangle(shapes, p, scene->mesh, t);
    return RESULT_OK;
}

Result image_reference_shapes(Shapes *shapes, const ReferenceScene *scene, const LightView *light,
                              Error *error)
{
    Projector p = {.scene = scene, .light = light, .focal = 1};
    return create_shapes(shapes, &p, error);
}

void image_reference_destroy_shapes(Shapes *shapes)
{
    free(shapes->shapes);
    *shapes = (Shapes){0};
}

// --- Pixels.

// A shape at a sub-sample.
typedef struct Hit {
    uint32_t sample; // index in the row of pixels: sub-row, then column
    uint32_t shape;
    float inverse_w;
    float color[4]; // premultiplied
} Hit;

// The sub-samples of one row of pixels.
typedef struct Row {
    Hit *hits;
    size_t count, room;
    Hit *sorted;     // sorted by sub-sample, with the same room as hits
    uint32_t *first; // [samples + 1]
    int width, side, row;
} Row;

static Result make_room(Row *row, size_t more, Error *error)
{
    if (row->count + more <= row->room) return RESULT_OK;
    size_t room = 2 * (row->count + more);
    Hit *hits = realloc(row->hits, room * sizeof *hits);
    if (hits) row->hits = hits;
    Hit *sorted = realloc(row->sorted, room * sizeof *sorted);
    if (sorted) row->sorted = sorted;
    if (!hits || !sorted)
        return error_set(error, RESULT_FAILED, "no memory for %zu sub-samples", room);
    row->room = room;
    return RESULT_OK;
}

int image_reference_cross(const Shape *shape, double y, double crossing[4])
{
    int count = 0;
    for (int i = 0; i < shape->corners; ++i) {
        const double *a = shape->corner[i], *b = shape->corner[(i + 1) % shape->corners];
        if (a[1] > b[1]) { // ordering the ends makes both shapes at an edge compute the same x
            const double *other = a;
            a = b, b = other;
        }
        if (y < a[1] || y >= b[1]) continue;
        double x = a[0] + (b[0] - a[0]) * ((y - a[1]) / (b[1] - a[1]));
        int at = count++;
        for (; at > 0 && crossing[at - 1] > x; --at) crossing[at] = crossing[at - 1];
        crossing[at] = x;
    }
    return count;
}

double image_reference_plane(const ShapePlane *plane, double x, double y)
{
    double value = plane->base + plane->dx * x + plane->dy * y;
    return fmin(fmax(value, plane->low), plane->high);
}

static void add_hit(Row *row, const Shape *shape, uint32_t number, uint32_t sample, double x,
                    double y)
{
    assert(row->count < row->room);
    Hit *hit = &row->hits[row->count++];
    hit->sample = sample;
    hit->shape = number;
    hit->inverse_w = (float)image_reference_plane(&shape->inverse_w, x, y);
    for (int k = 0; k < 3; ++k)
        hit->color[k] = (float)(shape->opacity * image_reference_plane(&shape->color[k], x, y));
    hit->color[3] = (float)shape->opacity;
}

static Result add_shape(Row *row, const Shape *shape, uint32_t number, Error *error)
{
    for (int i = 0; i < row->side; ++i) {
        double y = row->row + (i + 0.5) / row->side, crossing[4];
        int count = image_reference_cross(shape, y, crossing);
        for (int c = 0; c + 1 < count; c += 2) {
            // Sub-sample k is at (k + 1/2) / side.
            int most = row->width * row->side;
            int from = (int)fmin(fmax(ceil(crossing[c] * row->side - 0.5), 0), most);
            int to = (int)fmin(fmax(ceil(crossing[c + 1] * row->side - 0.5), 0), most);
            if (from >= to) continue;
            TRY(make_room(row, (size_t)(to - from), error));
            for (int k = from; k < to; ++k)
                add_hit(row, shape, number, (uint32_t)(i * most + k), (k + 0.5) / row->side, y);
        }
    }
    return RESULT_OK;
}

// Order from far to near. At equal depth, the later shape counts as farther.
static bool is_farther(const Hit *a, const Hit *b)
{
    return a->inverse_w < b->inverse_w || (a->inverse_w == b->inverse_w && a->shape > b->shape);
}

static void sort_by_sample(Row *row)
{
    uint32_t samples = (uint32_t)(row->width * row->side * row->side);
    memset(row->first, 0, (samples + 1) * sizeof *row->first);
    for (size_t i = 0; i < row->count; ++i) ++row->first[row->hits[i].sample + 1];
    for (uint32_t s = 0; s < samples; ++s) row->first[s + 1] += row->first[s];
    // Moves `first` of each sub-sample to the beginning of the next one.
    for (size_t i = 0; i < row->count; ++i)
        row->sorted[row->first[row->hits[i].sample]++] = row->hits[i];
    memmove(row->first + 1, row->first, samples * sizeof *row->first);
    row->first[0] = 0;
    for (uint32_t s = 0; s < samples; ++s)
        for (uint32_t i = row->first[s] + 1; i < row->first[s + 1]; ++i) {
            Hit hit = row->sorted[i];
            uint32_t at = i;
            for (; at > row->first[s] && is_farther(&hit, &row->sorted[at - 1]); --at)
                row->sorted[at] = row->sorted[at - 1];
            row->sorted[at] = hit;
        }
}

static bool has_hits(const Row *row, int x)
{
    for (int i = 0; i < row->side; ++i) {
        int sample = (i * row->width + x) * row->side;
        if (row->first[sample] != row->first[sample + row->side]) return true;
    }
    return false;
}

// The mean over the pixel; linear, premultiplied.
static void average_pixel(const Row *row, int x, const double background[4], double mean[4])
{
    memset(mean, 0, 4 * sizeof *mean);
    for (int i = 0; i < row->side * row->side; ++i) {
        int sample = i / row->side * row->width * row->side + x * row->side + i % row->side;
        double color[4];
        memcpy(color, background, sizeof color);
        for (uint32_t h = row->first[sample]; h < row->first[sample + 1]; ++h)
            for (int k = 3; k >= 0; --k)
                color[k] = row->sorted[h].color[k] + (1 - row->sorted[h].color[3]) * color[k];
        for (int k = 0; k < 4; ++k) mean[k] += color[k] / (row->side * row->side);
    }
}

// All pixels without hits have the same mean, which is found once a row.
static void write_row(const Row *row, const double background[4], Image *image)
{
    double empty[4] = {0};
    bool found = false;
    for (int x = 0; x < image->width; ++x) {
        double mean[4];
        uint8_t *pixel = image->pixels + ((size_t)row->row * (size_t)image->width + (size_t)x) *
                                             (size_t)image->channels;
        bool has = has_hits(row, x);
        if (has || !found) average_pixel(row, x, background, has ? mean : empty);
        if (!has) found = true, memcpy(mean, empty, sizeof mean);
        double alpha = image->channels == 4 ? mean[3] : 1;
        for (int k = 0; k < 3; ++k)
            pixel[k] = (uint8_t)lrint(255 * image_srgb_from_linear(mean[k] / fmax(alpha, 1e-9)));
        if (image->channels == 4) pixel[3] = (uint8_t)lrint(255 * fmin(alpha, 1));
    }
}

// An image being drawn. Threads take rows of pixels in turn; rows are independent.
typedef struct Drawing {
    const Shapes *shapes;
    const double *background; // [4], linear, premultiplied
    Image *image;
    int side, parts;
    Result results[PARALLEL_MOST];
    Error errors[PARALLEL_MOST];
} Drawing;

static Result draw_row(Row *row, const Drawing *drawing, Error *error)
{
    const Shapes *shapes = drawing->shapes;
    row->count = 0;
    for (uint32_t i = 0; i < shapes->count; ++i) {
        const Shape *shape = &shapes->shapes[i];
        if (shape->top >= row->row + 1 || shape->bottom <= row->row) continue;
        TRY(add_shape(row, shape, i, error));
    }
    sort_by_sample(row);
    write_row(row, drawing->background, drawing->image);
    return RESULT_OK;
}

static void draw_part(void *data, int part)
{
    Drawing *drawing = data;
    Error *error = &drawing->errors[part];
    Row row = {.width = drawing->image->width, .side = drawing->side};
    size_t samples = (size_t)row.width * (size_t)row.side * (size_t)row.side;
    row.first = malloc((samples + 1) * sizeof *row.first);
    Result result = row.first
                        ? RESULT_OK
                        : error_set(error, RESULT_FAILED, "no memory for %zu sub-samples", samples);
    for (row.row = part; row.row < drawing->image->height && result == RESULT_OK;
         row.row += drawing->parts)
        result = draw_row(&row, drawing, error);
    free(row.hits);
    free(row.sorted);
    free(row.first);
    drawing->results[part] = result;
}

Result image_reference_draw(Image *image, const ReferenceScene *scene, int side, Error *error)
{
    Shapes shapes = {0};
    double background[4] = {[3] = scene->background[3]};
    for (int k = 0; k < 3; ++k)
        background[k] = image_linear_from_srgb(scene->background[k]) * scene->background[3];
    Drawing drawing = {.shapes = &shapes,
                       .background = background,
                       .image = image,
                       .side = side,
                       .parts = scene->threads ? scene->threads : parallel_threads()};
    Projector p = {.scene = scene,
                   .width = image->width,
                   .height = image->height,
                   .focal = 0.5 * image->height * scene->view->projection[1][1],
                   .near_distance = scene->view->near_distance,
                   .least = 1e-6};
    Result result = create_shapes(&shapes, &p, error);
    if (result == RESULT_OK) parallel_run(drawing.parts, draw_part, &drawing);
    for (int i = 0; i < drawing.parts && result == RESULT_OK; ++i)
        if ((result = drawing.results[i]) != RESULT_OK) *error = drawing.errors[i];
    image_reference_destroy_shapes(&shapes);
    return result;
}
