// SPDX-License-Identifier: MIT
#include "bench/image_shapes.h"

#include "base/double3.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double LEAST_COSINE = 0.25; // of the joints' 1 + n0.n1: longer mitres are cut

// What does not change within a section.
typedef struct Projector {
    const ReferenceScene *scene;
    const ReferenceItem *item;
    double width, height, focal, near_distance; // px, px, px, m
    double base[3];                             // the section's colour, linear
} Projector;

// A vertex of a strand before the camera.
typedef struct Vertex {
    double eye[3]; // in the camera's frame: x right, y up, z towards the viewer, m
    double radius;
    double color[3];
} Vertex;

// The same on the screen.
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

// What reaches x from the light, as a white matt surface square to it shows it, and the unit vector
// towards it (scene.h).
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

// Half-way between ground and sky where the side of the fibre that is seen faces the horizon.
static double sky_share(const ReferenceVertex *v)
{
    double along = double3_dot(v->tangent, v->to_eye), side[3];
    for (int k = 0; k < 3; ++k) side[k] = v->to_eye[k] - along * v->tangent[k];
    unit(side);
    return 0.5 + acos(-1) / 8 * side[1];
}

// Kajiya & Kay (1989), highlights as Scheuermann (2004): light at the angle t to the fibre leaves
// on the cone at pi - t, turned by twice the scales' tilt for the first highlight and by three
// times, the other way, for the second, which has the fibre's colour.
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

// Uniform in -1 .. 1, the same as glsl/common/hash.glsl gives.
static double hash_signed(uint32_t id)
{
    id = (id ^ (id >> 16)) * 0x7feb352du;
    id = (id ^ (id >> 15)) * 0x846ca68bu;
    id ^= id >> 16;
    return (id >> 8) * (2.0 / 16777215) - 1;
}

static void to_camera(const View *view, const float x[3], double eye[3])
{
    for (int k = 0; k < 3; ++k) {
        eye[k] = view->view[3][k];
        for (int c = 0; c < 3; ++c) eye[k] += (double)view->view[c][k] * x[c];
    }
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
    to_camera(p->scene->view, x[j], v.eye);
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

// Moves `from` towards `to` up to the near plane.
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
    point.x = p->width / 2 + p->focal * v->eye[0] * point.inverse_w;
    point.y = p->height / 2 - p->focal * v->eye[1] * point.inverse_w;
    point.half_width = p->focal * v->radius * point.inverse_w;
    memcpy(point.color, v->color, sizeof point.color);
    return point;
}

static void set_direction(const Point *a, const Point *b, double d[2])
{
    double x = b->x - a->x, y = b->y - a->y, length = hypot(x, y);
    d[0] = length > 1e-6 ? x / length : 0;
    d[1] = length > 1e-6 ? y / length : 0;
}

// From the middle line to the left edge at a joint of ribbons that run along d0 and d1.
static void find_mitre(const Projector *p, const Point *at, const double d0[2], const double d1[2],
                       double mitre[2])
{
    double n[2] = {-d0[1] - d1[1], d0[0] + d1[0]}, length = hypot(n[0], n[1]);
    double q = length > 0 ? (n[0] * (at->x - p->width / 2) + n[1] * (at->y - p->height / 2)) /
                                (length * p->focal)
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

// From `first` at a to `last` at b.
static ShapePlane plane_between(const Point *a, const Point *b, double first, double last)
{
    double x = b->x - a->x, y = b->y - a->y, square = fmax(x * x + y * y, 1e-12);
    ShapePlane plane = {.dx = (last - first) * x / square, .dy = (last - first) * y / square};
    plane.base = first - plane.dx * a->x - plane.dy * a->y;
    plane.low = fmin(first, last);
    plane.high = fmax(first, last);
    return plane;
}

// `before` and `after` are the neighbours' directions, d the ribbon's own; 0 where there is none.
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
    for (int k = 0; k < 3; ++k) shape->color[k] = plane_between(a, b, a->color[k], b->color[k]);
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
    bool from_seen = -from->eye[2] >= p->near_distance, to_seen = -to->eye[2] >= p->near_distance;
    if (!from_seen && !to_seen) return segment;
    Vertex a = from_seen ? *from : clip(p, from, to), b = to_seen ? *to : clip(p, to, from);
    segment.a = project(p, &a);
    segment.b = project(p, &b);
    set_direction(&segment.a, &segment.b, segment.direction);
    segment.visible = segment.direction[0] != 0 || segment.direction[1] != 0;
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
    double opacity = m->opacity;
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
        to_camera(p->scene->view, mesh->position[mesh->triangle[t][i]], v.eye);
        if (-v.eye[2] < p->near_distance) return;
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

static Result make_room(Shapes *shapes, const ReferenceScene *scene, Error *error)
{
    size_t count = scene->mesh ? scene->mesh->triangle_count : 0;
    for (uint32_t i = 0; i < scene->item_count; ++i) count += scene->items[i].strands->vertex_count;
    *shapes = (Shapes){.shapes = malloc((count + 1) * sizeof *shapes->shapes)};
    if (shapes->shapes) return RESULT_OK;
    return error_set(error, RESULT_FAILED, "no memory for %zu shapes", count);
}

Result shapes_create(Shapes *shapes, const ReferenceScene *scene, int width, int height,
                     Error *error)
{
    Result result = make_room(shapes, scene, error);
    if (result != RESULT_OK) return result;
    const View *view = scene->view;
    Projector p = {.scene = scene,
                   .width = width,
                   .height = height,
                   .focal = 0.5 * height * view->projection[1][1],
                   .near_distance = view->near_distance};
    for (uint32_t i = 0; i < scene->item_count; ++i) {
        p.item = &scene->items[i];
        float base[3];
        paint_color(p.item->material, base);
        for (int k = 0; k < 3; ++k) p.base[k] = base[k];
        for (uint32_t s = 0; s < p.item->strands->strand_count; ++s) add_strand(shapes, &p, s);
    }
    for (uint32_t t = 0; scene->mesh && t < scene->mesh->triangle_count; ++t)
        add_triangle(shapes, &p, scene->mesh, t);
    return RESULT_OK;
}

void shapes_destroy(Shapes *shapes)
{
    free(shapes->shapes);
    *shapes = (Shapes){0};
}
