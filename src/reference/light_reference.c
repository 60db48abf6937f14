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

    // Sums of the environment's mean radiance times solid angle, up to each pixel and over all.
    double *around, all_around; // `around`: owned
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

// Follows the ray from cell to cell to the nearest cylinder within `reach` (m). `any`: to any
// cylinder.
static bool follow(const Paths *paths, const Ray *ray, double reach, bool any, Hit *hit)
{
    double begin, end, next[3], step[3];
    int cell[3];
    *hit = (Hit){.distance = reach};
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

// A place on a fibre's axis that a path has met.
typedef struct Place {
    const FibreReference *fibre;
    FibreBeams beams;
    Frame frame;
    Ray leaving; // from there; its `way` is still to be set
} Place;

static void find_density(const Place *place, const double way[3], double density[3])
{
    double at[3];
    for (int k = 0; k < 3; ++k) at[k] = dot(way, place->frame.axis[k]);
    fibre_reference_density(place->fibre, &place->beams, at[0], atan2(at[2], at[1]), density);
}

// Whether no hair lies within `reach` (m) along `way`.
static bool is_open(const Paths *paths, const Place *place, const double way[3], double reach)
{
    Ray ray = place->leaving;
    Hit hit;
    memcpy(ray.way, way, sizeof ray.way);
    return !follow(paths, &ray, reach, true, &hit);
}

// --- Lights.

// A light as a point sees it: a disc of even radiance.
typedef struct Disc {
    double way[3], distance; // unit, to its middle; m
    double cosine;           // of its angular radius; 1: it is a point
    double share;            // of the light's brightness that arrives without hair
} Disc;

static double spot_share(const Light *light, const double to_light[3])
{
    double inner = cos((double)light->inner_deg * M_PI / 180),
           outer = cos((double)light->outer_deg * M_PI / 180), cosine = 0;
    for (int k = 0; k < 3; ++k) cosine -= (double)light->direction[k] * to_light[k];
    double inside = fmax(0, fmin((cosine - outer) / (inner - outer), 1));
    return inside * inside;
}

static Disc find_disc(const Light *light, const double from[3])
{
    bool far = light->kind == LIGHT_DIRECTIONAL;
    double tangent = tan((double)light->radius * M_PI / 180);
    Disc disc = {.distance = HUGE_VAL, .share = 1};
    for (int k = 0; k < 3; ++k)
        disc.way[k] = far ? (double)light->direction[k] : (double)light->position[k] - from[k];
    if (!far) {
        disc.distance = sqrt(dot(disc.way, disc.way));
        tangent = (double)light->radius / disc.distance;
        disc.share = pow((double)light->distance / disc.distance, 2);
    }
    make_unit(disc.way);
    if (light->kind == LIGHT_SPOT) disc.share *= spot_share(light, disc.way);
    disc.cosine = 1 / sqrt(1 + tangent * tangent);
    return disc;
}

// A direction that is evenly distributed over the disc.
static void draw_way(const Disc *disc, Random *random, double way[3])
{
    memcpy(way, disc->way, sizeof disc->way);
    if (disc->cosine == 1) return;
    const double *d = disc->way, other[3] = {fabs(d[0]) < 0.5, fabs(d[0]) >= 0.5, 0};
    double w = 1 - random_real(random) * (1 - disc->cosine), off = sqrt(1 - w * w),
           turn = 2 * M_PI * random_real(random), side[3], up[3];
    cross(d, other, side);
    make_unit(side);
    cross(d, side, up);
    for (int k = 0; k < 3; ++k) way[k] = w * d[k] + off * (cos(turn) * side[k] + sin(turn) * up[k]);
}

// Adds the light that the lights send to this place and the fibre sends on. A matt white surface
// which faces a disc of the radiance L and the angular radius a shows L sin^2(a). So a light that
// it shows as 1 has L = 1 / sin^2(a), and L times the solid angle, 2 pi (1 - cos(a)), is 2 pi / (1
// + cos(a)).
static void add_lights(const Paths *paths, const Place *place, const double weight[3],
                       Random *random, double light[3])
{
    const LightReferenceScene *scene = paths->scene;
    for (uint32_t l = 0; l < scene->light_count; ++l) {
        const Light *lamp = &scene->lights[l];
        const Disc disc = find_disc(lamp, place->leaving.from);
        double density[3], way[3];
        draw_way(&disc, random, way);
        if (disc.share == 0 || !is_open(paths, place, way, disc.distance)) continue;
        find_density(place, way, density);
        for (int c = 0; c < 3; ++c)
            light[c] += 2 * M_PI / (1 + disc.cosine) * disc.share * (double)lamp->intensity *
                        (double)lamp->color[c] * weight[c] * density[c];
    }
}

// --- The environment. Its light is found in two ways: directions are drawn in proportion to its
// radiance, and paths that leave the hair go to it. Each direction counts in both, in proportion to
// its chances (the balance heuristic of Veach and Guibas, SIGGRAPH 1995).

// The height (-1 .. 1) of the upper edge of a row of the image.
static double edge_height(const Image *image, int row)
{
    return cos(M_PI * row / image->height);
}

// The radiance of a pixel.
static void find_pixel_light(const LightReferenceScene *scene, size_t pixel, double light[3])
{
    const Image *image = &scene->environment->image;
    const float *rgb = (const float *)(const void *)image->pixels + pixel * (size_t)image->channels;
    for (int c = 0; c < 3; ++c) light[c] = (double)scene->strength * fmax((double)rgb[c], 0);
}

static double mean_of(const double light[3])
{
    return (light[0] + light[1] + light[2]) / 3;
}

static bool sum_environment(Paths *paths)
{
    if (!paths->scene->environment) return true;
    const Image *image = &paths->scene->environment->image;
    size_t count = (size_t)image->width * (size_t)image->height;
    double sum = 0;
    paths->around = malloc(count * sizeof *paths->around);
    if (!paths->around) return false;
    for (size_t i = 0; i < count; ++i) {
        int row = (int)(i / (size_t)image->width);
        double light[3];
        find_pixel_light(paths->scene, i, light);
        sum += mean_of(light) * 2 * M_PI / image->width *
               (edge_height(image, row) - edge_height(image, row + 1));
        paths->around[i] = sum;
    }
    paths->all_around = sum;
    return true;
}

// The density (1/sr) with which a direction of this radiance is drawn.
static double chance_of(const Paths *paths, const double light[3])
{
    return paths->all_around > 0 ? mean_of(light) / paths->all_around : 0;
}

// Draws a direction, and finds its radiance.
static void draw_around(const Paths *paths, Random *random, double way[3], double light[3])
{
    const Image *image = &paths->scene->environment->image;
    double at = random_real(random) * paths->all_around;
    size_t first = 0, last = (size_t)image->width * (size_t)image->height - 1;
    while (first < last) {
        size_t middle = first + (last - first) / 2;
        if (paths->around[middle] > at)
            last = middle;
        else
            first = middle + 1;
    }
    int row = (int)(first / (size_t)image->width);
    double column = (double)(first % (size_t)image->width) + random_real(random),
           down = random_real(random), above = edge_height(image, row);
    float drawn[3];
    environment_way(&paths->scene->axes, 2 * M_PI * (column / image->width - 0.5),
                    above + down * (edge_height(image, row + 1) - above), drawn);
    for (int k = 0; k < 3; ++k) way[k] = (double)drawn[k];
    find_pixel_light(paths->scene, first, light);
}

// Adds the environment's light from one drawn direction.
static void add_environment(const Paths *paths, const Place *place, const double weight[3],
                            Random *random, double light[3])
{
    double way[3], density[3], radiance[3];
    if (!(paths->all_around > 0)) return;
    draw_around(paths, random, way, radiance);
    if (!is_open(paths, place, way, HUGE_VAL)) return;
    find_density(place, way, density);
    double chances =
        chance_of(paths, radiance) + fibre_reference_chance(&place->beams, weight, density);
    for (int c = 0; c < 3; ++c) light[c] += weight[c] * density[c] * radiance[c] / chances;
}

// The radiance from all around.
static void look_around(const LightReferenceScene *scene, const double way[3], double light[3])
{
    const float to[3] = {(float)way[0], (float)way[1], (float)way[2]};
    float place[2];
    for (int c = 0; c < 3; ++c) {
        double sky = (double)scene->sky[c], ground = (double)scene->ground[c];
        light[c] = ground + (0.5 + 0.5 * way[1]) * (sky - ground);
    }
    if (!scene->environment) return;
    const Image *image = &scene->environment->image;
    environment_place(scene->environment, &scene->axes, to, place);
    size_t column = (size_t)fmin((double)place[0], image->width - 1),
           row = (size_t)fmin((double)place[1], image->height - 1);
    find_pixel_light(scene, row * (size_t)image->width + column, light);
}

// Adds the light that a path meets which leaves the hair. `chance`: the density (1/sr) with which
// its direction was drawn.
static void add_around(const Paths *paths, const double way[3], const double weight[3],
                       double chance, double light[3])
{
    double radiance[3];
    look_around(paths->scene, way, radiance);
    double share = paths->scene->environment ? chance / (chance + chance_of(paths, radiance)) : 1;
    for (int c = 0; c < 3; ++c) light[c] += share * weight[c] * radiance[c];
}

// --- Whole paths.

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

// Makes the fibre's place where the ray has hit it.
static Place find_place(const Paths *paths, const Ray *ray, const Hit *hit)
{
    Place place = {.fibre = &paths->scene->items[hit->cylinder->item].fibre,
                   .leaving.own = hit->cylinder};
    double out[3] = {-ray->way[0], -ray->way[1], -ray->way[2]}, sine, on = 0;
    place.frame = find_frame(hit->cylinder, out, &sine);
    place.beams = fibre_reference_beams(place.fibre, sine, hit->offset);
    for (int k = 0; k < 3; ++k)
        on += (ray->from[k] + hit->distance * ray->way[k] - hit->cylinder->from[k]) *
              place.frame.axis[0][k];
    memcpy(place.leaving.from, hit->cylinder->from, sizeof place.leaving.from);
    add_scaled(place.leaving.from, place.frame.axis[0], on);
    return place;
}

// Draws where a path goes on. With an environment, returns the density (1/sr) with which it was
// drawn.
static double draw_leaving(const Paths *paths, Place *place, Random *random, double weight[3])
{
    const double before[3] = {weight[0], weight[1], weight[2]};
    double sine, azimuth, density[3], *way = place->leaving.way;
    fibre_reference_draw(place->fibre, &place->beams, random, weight, &sine, &azimuth);
    double across = sqrt(fmax(1 - sine * sine, 0)),
           at[3] = {sine, across * cos(azimuth), across * sin(azimuth)};
    for (int k = 0; k < 3; ++k) add_scaled(way, place->frame.axis[k], at[k]);
    make_unit(way);
    if (!paths->scene->environment) return 0;
    fibre_reference_density(place->fibre, &place->beams, sine, azimuth, density);
    return fibre_reference_chance(&place->beams, before, density);
}

// Follows one path from the eye; returns whether it met hair.
static bool follow_path(const Paths *paths, Ray ray, Random *random, double light[3])
{
    double weight[3] = {1, 1, 1}, chance = 0;
    for (int order = 0;; ++order) {
        Hit hit;
        if (!follow(paths, &ray, HUGE_VAL, false, &hit)) {
            if (order > 0) add_around(paths, ray.way, weight, chance, light);
            return order > 0;
        }
        if (order == paths->orders) return true;
        Place place = find_place(paths, &ray, &hit);
        add_lights(paths, &place, weight, random, light);
        add_environment(paths, &place, weight, random, light);
        chance = draw_leaving(paths, &place, random, weight);
        if (!goes_on(weight, random)) return true;
        ray = place.leaving;
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
    bool good = make_cylinders(&paths) && make_cells(&paths) && sum_environment(&paths);
    paths.parts = parallel_threads();
    if (good) parallel_run(paths.parts, draw_rows, &paths);
    free(paths.cylinders);
    free(paths.first);
    free(paths.of_cell);
    free(paths.around);
    if (!good) return error_set(error, RESULT_FAILED, "no memory for %u cylinders", paths.count);
    return interrupt_requested() ? error_set(error, RESULT_INTERRUPTED, "interrupted") : RESULT_OK;
}
