// SPDX-License-Identifier: MIT
#include "reference/light_reference.h"
#include "base/interrupt.h"
#include "base/parallel.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

// --- Vectors.

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double to[3])
{
    for (int k = 0; k < 3; ++k)
        to[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static void add_scaled(double to[3], const double from[3], double factor)
{
    for (int k = 0; k < 3; ++k) to[k] += factor * from[k];
}

static void make_unit(double v[3])
{
    double length = sqrt(dot(v, v));
    for (int k = 0; k < 3; ++k) v[k] /= length;
}

// --- Cylinders, in a grid of cubic cells.

enum { PARTS = 4 };         // cylinders of a segment
enum { SIDE_MOST = 512 };   // cells along an axis
enum { NEIGHBOURHOOD = 2 }; // segments beside its own that a path cannot hit at once

typedef struct Cylinder {
    double from[3], along[3], length; // m; `along` is as long as the cylinder
    uint32_t item, strand, segment;
} Cylinder;

typedef struct Paths {
    const LightReferenceScene *scene;
    Image *image;
    int orders, paths, parts;
    uint64_t seed;

    Cylinder *cylinders; // [count], owned
    uint32_t count;
    double low[3], side; // m: of the cells
    int cells[3];
    uint32_t *first,
        *of_cell; // of_cell[first[c] .. first[c + 1] - 1]: cylinders near cell c, owned
} Paths;

// The uniform Catmull-Rom curve; at an end the missing vertex is mirrored.
static void find_point(const Strands *strands, uint32_t s, uint32_t segment, double t, double x[3])
{
    const float(*at)[3] = (const float(*)[3])strands->position + strands->first[s] + segment;
    bool root = segment == 0, tip = segment + 2 == strands_size(strands, s);
    for (int k = 0; k < 3; ++k) {
        double b = (double)at[0][k], c = (double)at[1][k], a = root ? 2 * b - c : (double)at[-1][k],
               d = tip ? 2 * c - b : (double)at[2][k];
        x[k] = b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
    }
}

static void add_segment(Paths *paths, uint32_t item, uint32_t strand, uint32_t segment)
{
    const Strands *strands = paths->scene->items[item].strands;
    double x[3];
    find_point(strands, strand, segment, 0, x);
    for (int part = 1; part <= PARTS; ++part) {
        Cylinder *cylinder = &paths->cylinders[paths->count];
        *cylinder = (Cylinder){.item = item, .strand = strand, .segment = segment};
        memcpy(cylinder->from, x, sizeof x);
        find_point(strands, strand, segment, (double)part / PARTS, x);
        for (int k = 0; k < 3; ++k) cylinder->along[k] = x[k] - cylinder->from[k];
        cylinder->length = sqrt(dot(cylinder->along, cylinder->along));
        paths->count += cylinder->length > 0;
    }
}

static bool make_cylinders(Paths *paths)
{
    const LightReferenceScene *scene = paths->scene;
    size_t most = 1;
    for (uint32_t i = 0; i < scene->item_count; ++i)
        most += (size_t)PARTS * scene->items[i].strands->vertex_count;
    paths->cylinders = malloc(most * sizeof *paths->cylinders);
    if (!paths->cylinders) return false;
    for (uint32_t i = 0; i < scene->item_count; ++i)
        for (uint32_t s = 0; s < scene->items[i].strands->strand_count; ++s)
            for (uint32_t j = 0; j + 1 < strands_size(scene->items[i].strands, s); ++j)
                add_segment(paths, i, s, j);
    return true;
}

// The box around a cylinder.
static void find_box(const Paths *paths, const Cylinder *cylinder, double low[3], double high[3])
{
    double radius = 1.001 * paths->scene->items[cylinder->item].radius;
    for (int k = 0; k < 3; ++k) {
        low[k] = cylinder->from[k] + fmin(cylinder->along[k], 0) - radius;
        high[k] = cylinder->from[k] + fmax(cylinder->along[k], 0) + radius;
    }
}

static int cell_along(const Paths *paths, int axis, double x)
{
    double cell = (x - paths->low[axis]) / paths->side;
    return (int)fmax(0, fmin(cell, paths->cells[axis] - 1));
}

// Adds each cylinder to the cells that its box meets: next[cell] is advanced, and the cylinder's
// number stored there if `of_cell` is not NULL.
static void fill_cells(const Paths *paths, uint32_t *next, uint32_t *of_cell)
{
    for (uint32_t i = 0; i < paths->count; ++i) {
        double low[3], high[3];
        int from[3], to[3];
        find_box(paths, &paths->cylinders[i], low, high);
        for (int k = 0; k < 3; ++k) {
            from[k] = cell_along(paths, k, low[k]);
            to[k] = cell_along(paths, k, high[k]);
        }
        for (int z = from[2]; z <= to[2]; ++z)
            for (int y = from[1]; y <= to[1]; ++y)
                for (int x = from[0]; x <= to[0]; ++x) {
                    uint32_t at = next[((size_t)z * paths->cells[1] + y) * paths->cells[0] + x]++;
                    if (of_cell) of_cell[at] = i;
                }
    }
}

// Lays about as many cells as there are cylinders.
static bool make_cells(Paths *paths)
{
    double high[3] = {0}, longest = 0, volume = 1;
    for (uint32_t i = 0; i < paths->count; ++i) {
        double a[3], b[3];
        find_box(paths, &paths->cylinders[i], a, b);
        for (int k = 0; k < 3; ++k) {
            paths->low[k] = i ? fmin(paths->low[k], a[k]) : a[k];
            high[k] = i ? fmax(high[k], b[k]) : b[k];
        }
    }
    for (int k = 0; k < 3; ++k) {
        volume *= high[k] - paths->low[k];
        longest = fmax(longest, high[k] - paths->low[k]);
    }
    paths->side = fmax(cbrt(volume / (paths->count + 1)), longest / SIDE_MOST) + 1e-12;
    size_t cells = 1;
    for (int k = 0; k < 3; ++k) {
        paths->cells[k] = (int)((high[k] - paths->low[k]) / paths->side) + 1;
        cells *= (size_t)paths->cells[k];
    }
    paths->first = calloc(cells + 2, sizeof *paths->first);
    if (!paths->first) return false;
    fill_cells(paths, paths->first + 2, NULL);
    for (size_t c = 0; c < cells; ++c) paths->first[c + 2] += paths->first[c + 1];
    paths->of_cell = malloc(((size_t)paths->first[cells + 1] + 1) * sizeof *paths->of_cell);
    if (!paths->of_cell) return false;
    fill_cells(paths, paths->first + 1, paths->of_cell); // advances first[c + 1] to the cell's end
    return true;
}

// --- Rays.

typedef struct Ray {
    double from[3], way[3]; // `way`: unit
    const Cylinder *own;    // the fibre that the ray leaves; NULL: none
} Ray;

typedef struct Hit {
    double distance, offset; // m; offset of the ray from the axis over the radius
    const Cylinder *cylinder;
} Hit;

static void try_cylinder(const Paths *paths, const Ray *ray, const Cylinder *cylinder, Hit *hit)
{
    const Cylinder *own = ray->own;
    if (own && own->item == cylinder->item && own->strand == cylinder->strand &&
        abs((int)own->segment - (int)cylinder->segment) <= NEIGHBOURHOOD)
        return;
    double radius = paths->scene->items[cylinder->item].radius, to[3], normal[3], turned[3];
    for (int k = 0; k < 3; ++k) to[k] = cylinder->from[k] - ray->from[k];
    cross(ray->way, cylinder->along, normal);
    double square = dot(normal, normal), off = dot(to, normal);
    if (off * off > radius * radius * square || square < 1e-30) return;
    cross(to, ray->way, turned);
    double on = dot(turned, normal) / square; // of the point that is nearest to the ray
    if (on < 0 || on >= 1) return;
    double distance = dot(to, ray->way) + on * dot(cylinder->along, ray->way);
    if (distance < 1e-3 * radius || distance >= hit->distance) return;
    *hit = (Hit){distance, off / (sqrt(square) * radius), cylinder};
}

// The part of the ray in the box of the cells; false: it misses the box.
static bool clip_ray(const Paths *paths, const Ray *ray, double *begin, double *end)
{
    *begin = 0, *end = HUGE_VAL;
    for (int k = 0; k < 3; ++k) {
        double a = paths->low[k] - ray->from[k], b = a + paths->side * paths->cells[k];
        if (fabs(ray->way[k]) < 1e-12) {
            if (a > 0 || b < 0) return false;
            continue;
        }
        a /= ray->way[k], b /= ray->way[k];
        *begin = fmax(*begin, fmin(a, b));
        *end = fmin(*end, fmax(a, b));
    }
    return *begin < *end;
}

// Follows the ray from cell to cell to the nearest cylinder. `any`: to any cylinder.
static bool follow(const Paths *paths, const Ray *ray, bool any, Hit *hit)
{
    double begin, end, next[3], step[3];
    int cell[3];
    *hit = (Hit){.distance = HUGE_VAL};
    if (!clip_ray(paths, ray, &begin, &end)) return false;
    for (int k = 0; k < 3; ++k) {
        double way = ray->way[k], x = ray->from[k] + begin * way;
        cell[k] = cell_along(paths, k, x);
        bool still = fabs(way) < 1e-12;
        step[k] = still ? HUGE_VAL : paths->side / fabs(way);
        next[k] = still ? HUGE_VAL
                        : begin + (paths->low[k] + (cell[k] + (way > 0)) * paths->side - x) / way;
    }
    for (;;) {
        size_t at = ((size_t)cell[2] * paths->cells[1] + cell[1]) * paths->cells[0] + cell[0];
        for (uint32_t i = paths->first[at]; i < paths->first[at + 1]; ++i) {
            try_cylinder(paths, ray, &paths->cylinders[paths->of_cell[i]], hit);
            if (any && hit->cylinder) return true;
        }
        int k = next[0] < next[1] ? (next[0] < next[2] ? 0 : 2) : (next[1] < next[2] ? 1 : 2);
        if (hit->distance <= next[k] || next[k] > end) break;
        cell[k] += ray->way[k] > 0 ? 1 : -1;
        if (cell[k] < 0 || cell[k] >= paths->cells[k]) break;
        next[k] += step[k];
    }
    return hit->cylinder != NULL;
}

// --- Paths.

// A fibre's axes where a path meets it: along it, towards the eye's side across it, and square to
// both.
typedef struct Frame {
    double axis[3][3];
} Frame;

static Frame find_frame(const Cylinder *cylinder, const double out[3], double *sine)
{
    Frame frame;
    for (int k = 0; k < 3; ++k) frame.axis[0][k] = cylinder->along[k] / cylinder->length;
    *sine = dot(frame.axis[0], out);
    memcpy(frame.axis[1], out, sizeof frame.axis[1]);
    add_scaled(frame.axis[1], frame.axis[0], -*sine);
    make_unit(frame.axis[1]);
    cross(frame.axis[0], frame.axis[1], frame.axis[2]);
    return frame;
}

// Adds the light that the sources send to this place and the fibre sends on.
static void add_lights(const Paths *paths, const Ray *leaving, const Frame *frame,
                       const FibreReference *fibre, const FibreBeams *beams, const double weight[3],
                       double light[3])
{
    const LightReferenceScene *scene = paths->scene;
    for (uint32_t l = 0; l < scene->light_count; ++l) {
        const Light *lamp = &scene->lights[l];
        Ray ray = *leaving;
        Hit hit;
        double density[3], at[3];
        for (int k = 0; k < 3; ++k) ray.way[k] = (double)lamp->direction[k];
        make_unit(ray.way);
        if (follow(paths, &ray, true, &hit)) continue;
        for (int k = 0; k < 3; ++k) at[k] = dot(ray.way, frame->axis[k]);
        fibre_reference_density(fibre, beams, at[0], atan2(at[2], at[1]), density);
        // A light of 1 shows a matt white surface as 1, so its irradiance is pi.
        for (int c = 0; c < 3; ++c)
            light[c] +=
                M_PI * (double)lamp->intensity * (double)lamp->color[c] * weight[c] * density[c];
    }
}

static void add_around(const LightReferenceScene *scene, const double way[3],
                       const double weight[3], double light[3])
{
    for (int c = 0; c < 3; ++c) {
        double sky = (double)scene->sky[c], ground = (double)scene->ground[c];
        light[c] += weight[c] * (ground + (0.5 + 0.5 * way[1]) * (sky - ground));
    }
}

// Ends faint paths at random, and makes up for those that it ends in those that it does not.
static bool goes_on(double weight[3], Random *random)
{
    const double FAINT = 0.3, KEPT = 0.6;
    double most = fmax(weight[0], fmax(weight[1], weight[2]));
    if (most >= FAINT) return true;
    if (random_real(random) * KEPT >= most) return false;
    for (int c = 0; c < 3; ++c) weight[c] *= KEPT / most;
    return true;
}

// Follows one path from the eye; returns whether it met hair.
static bool follow_path(const Paths *paths, Ray ray, Random *random, double light[3])
{
    double weight[3] = {1, 1, 1};
    for (int order = 0;; ++order) {
        Hit hit;
        if (!follow(paths, &ray, false, &hit)) {
            if (order > 0) add_around(paths->scene, ray.way, weight, light);
            return order > 0;
        }
        if (order == paths->orders) return true;
        const FibreReference *fibre = &paths->scene->items[hit.cylinder->item].fibre;
        double out[3] = {-ray.way[0], -ray.way[1], -ray.way[2]}, sine, azimuth;
        Frame frame = find_frame(hit.cylinder, out, &sine);
        FibreBeams beams = fibre_reference_beams(fibre, sine, hit.offset);
        double on = 0;
        for (int k = 0; k < 3; ++k)
            on += (ray.from[k] + hit.distance * ray.way[k] - hit.cylinder->from[k]) *
                  frame.axis[0][k];
        memcpy(ray.from, hit.cylinder->from, sizeof ray.from);
        add_scaled(ray.from, frame.axis[0], on);
        ray.own = hit.cylinder;
        add_lights(paths, &ray, &frame, fibre, &beams, weight, light);
        fibre_reference_draw(fibre, &beams, random, weight, &sine, &azimuth);
        if (!goes_on(weight, random)) return true;
        double across = sqrt(fmax(1 - sine * sine, 0)),
               at[3] = {sine, across * cos(azimuth), across * sin(azimuth)};
        memset(ray.way, 0, sizeof ray.way);
        for (int k = 0; k < 3; ++k) add_scaled(ray.way, frame.axis[k], at[k]);
        make_unit(ray.way);
    }
}

// A ray from the eye through a place of the image, px from the top left.
static Ray find_ray(const Paths *paths, double x, double y)
{
    const View *view = paths->scene->view;
    double high = paths->image->height, per_px = 2 * tan(0.5 * (double)view->fov) / high,
           way[3] = {(x - 0.5 * paths->image->width) * per_px, (0.5 * high - y) * per_px, -1};
    Ray ray = {0};
    for (int k = 0; k < 3; ++k) {
        ray.from[k] = (double)view->eye[k];
        for (int i = 0; i < 3; ++i) ray.way[k] += (double)view->view[k][i] * way[i];
    }
    make_unit(ray.way);
    return ray;
}

static void draw_row(const Paths *paths, int y)
{
    Random random = random_create(paths->seed, (uint64_t)y);
    int channels = paths->image->channels;
    float *pixel = (float *)(void *)paths->image->pixels +
                   (size_t)y * (size_t)paths->image->width * (size_t)channels;
    for (int x = 0; x < paths->image->width; ++x, pixel += channels) {
        double light[4] = {0};
        for (int n = 0; n < paths->paths; ++n) {
            double right = random_real(&random), down = random_real(&random);
            light[3] += follow_path(paths, find_ray(paths, x + right, y + down), &random, light);
        }
        for (int c = 0; c < channels; ++c) pixel[c] = (float)(light[c] / paths->paths);
    }
}

static void draw_rows(void *data, int part)
{
    const Paths *paths = data;
    for (int y = part; y < paths->image->height && !interrupt_requested(); y += paths->parts)
        draw_row(paths, y);
}

Result light_reference_draw(Image *image, const LightReferenceScene *scene, int orders, int count,
                            uint64_t seed, Error *error)
{
    Paths paths = {.scene = scene, .image = image, .orders = orders, .paths = count, .seed = seed};
    for (uint32_t l = 0; l < scene->light_count; ++l)
        if (scene->lights[l].kind != LIGHT_DIRECTIONAL || scene->lights[l].radius > 0)
            return error_set(error, RESULT_USAGE,
                             "light %u: has a place or a radius: expected a directional light", l);
    bool good = make_cylinders(&paths) && make_cells(&paths);
    paths.parts = parallel_threads();
    if (good) parallel_run(paths.parts, draw_rows, &paths);
    free(paths.cylinders);
    free(paths.first);
    free(paths.of_cell);
    if (!good) return error_set(error, RESULT_FAILED, "no memory for %u cylinders", paths.count);
    return interrupt_requested() ? error_set(error, RESULT_INTERRUPTED, "interrupted") : RESULT_OK;
}
