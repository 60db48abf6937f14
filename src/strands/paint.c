// SPDX-License-Identifier: MIT
#include "strands/paint.h"

#include "image/image.h"
#include "image/png.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Absorption by one unit of each pigment, per fibre radius (red, green, blue).
static const double EUMELANIN[] = {0.419, 0.697, 1.37}, PHEOMELANIN[] = {0.187, 0.4, 1.05};

static void decode(const float srgb[3], float linear[3])
{
    for (int k = 0; k < 3; ++k) linear[k] = (float)image_linear_from_srgb((double)srgb[k]);
}

// --- Albedo.

// The apparent albedo of a head of hair as a function of sigma, the absorption per fibre radius:
//     DARKEST + SPAN exp(-STEEPNESS sigma^BEND)
// DARKEST is what opaque fibres still reflect; DARKEST + SPAN is what fibres without pigment
// reflect. The exposure is such that hair with an albedo of 0.19 shows as 0.19. Fitted to demo,
// bob, fall, curls and fur of assets/ and to two public grooms under the studio lights, with the
// light of skin on hair (docs/look.md gives the residuals).
static const double DARKEST = 0.0095, SPAN = 0.435, STEEPNESS = 3.35, BEND = 0.59;
static const double DARK_ROOM =
    5e-4;                           // least value above DARKEST: no colour has more than sigma 3.3
static const double FITTED_AT = 12; // azimuthal roughness, degrees

// By how much the square root of sigma grows with darkness at an azimuthal roughness (degrees):
// Chiang et al. 2016 (EGSR), equation 9. Its parameter b (0..1) is found by bisection as the value
// for which the logistic lobe has this standard deviation (equation 8).
static double chiang_scale(double roughness)
{
    double scale = roughness * M_PI / 180 * sqrt(3) / M_PI, low = 0, high = 1;
    for (int turn = 0; turn < 50; ++turn) {
        double b = 0.5 * (low + high);
        if (0.626657069 * (0.265 * b + 1.194 * b * b + 5.372 * pow(b, 22)) < scale)
            low = b;
        else
            high = b;
    }
    double b = 0.5 * (low + high), square = b * b;
    return 5.969 - 0.215 * b + 2.532 * square - 10.73 * square * b + 5.574 * square * square +
           0.245 * square * square * b;
}

// The factor on sigma that makes hair of this azimuthal roughness look as it does at FITTED_AT.
static double find_widening(const SectionParams *params)
{
    return pow(chiang_scale(FITTED_AT) / chiang_scale((double)params->azimuthal_roughness), 2);
}

// Converts an apparent colour to the transmittance of a fibre's diameter, exp(-2 sigma). A colour
// that is brighter than hair can be is scaled down and keeps its hue.
static void absorb(double wider, float linear[3])
{
    double brightest = fmax((double)linear[0], fmax((double)linear[1], (double)linear[2])),
           less = fmin(1, (DARKEST + SPAN) / fmax(brightest, DARKEST));
    for (int k = 0; k < 3; ++k) {
        double shown = fmax(less * (double)linear[k] - DARKEST, DARK_ROOM),
               sigma = pow(fmax(log(SPAN / shown), 0) / STEEPNESS, 1 / BEND);
        linear[k] = (float)exp(-2 * wider * sigma);
    }
}

// The inverse of absorb: converts the transmittance of a fibre's diameter to the apparent colour.
static void reveal(const SectionParams *params, float linear[3])
{
    double wider = find_widening(params);
    for (int k = 0; k < 3; ++k) {
        double sigma = -log((double)linear[k]) / (2 * wider); // infinite if no light gets through
        linear[k] = (float)(DARKEST + SPAN * exp(-STEEPNESS * pow(fmax(sigma, 0), BEND)));
    }
}

// Converts an apparent colour to what the shading model needs: Kajiya-Kay takes the colour itself,
// Marschner the transmittance of a fibre's diameter.
static void take_seen(const SectionParams *params, double wider, float linear[3])
{
    if (params->shading == SHADING_MARSCHNER) absorb(wider, linear);
}

void paint_color(const SectionParams *params, float linear[3])
{
    double red = (double)params->melanin_redness, amount = (double)params->melanin.value;
    bool seen = params->transmission.automatic;
    decode(seen ? params->color : params->transmission.value, linear);
    if (seen) take_seen(params, find_widening(params), linear);
    for (int k = 0; k < 3 && !params->melanin.automatic; ++k)
        linear[k] = (float)exp(-2 * amount * ((1 - red) * EUMELANIN[k] + red * PHEOMELANIN[k]));
}

SectionParams paint_as_seen(const SectionParams *params)
{
    SectionParams seen = *params;
    float shown[3];
    seen.shading = SHADING_KAJIYA;
    if (params->transmission.automatic && params->melanin.automatic) return seen;
    paint_color(params, shown);
    if (params->shading == SHADING_MARSCHNER) reveal(params, shown);
    for (int k = 0; k < 3; ++k) seen.color[k] = (float)image_srgb_from_linear((double)shown[k]);
    seen.transmission = (AutoVec3){.automatic = true};
    seen.melanin = (AutoFloat){.automatic = true};
    return seen;
}

static double texel(const Image *map, int64_t x, int64_t y, int channel)
{
    int64_t w = map->width, h = map->height;
    x = (x % w + w) % w, y = (y % h + h) % h;
    uint8_t level = map->pixels[(y * w + x) * map->channels + channel];
    return image_linear_from_srgb(level / 255.0);
}

// Bilinear lookup that repeats; a texel's colour belongs to its centre.
static void sample(const Image *map, const float uv[2], float linear[3])
{
    double u = (double)uv[0], v = (double)uv[1];
    double x = (u - floor(u)) * map->width - 0.5, y = (1 - (v - floor(v))) * map->height - 0.5;
    double left = floor(x), top = floor(y), s = x - left, t = y - top;
    int64_t i = (int64_t)left, j = (int64_t)top;
    for (int k = 0; k < 3; ++k) {
        double above = (1 - s) * texel(map, i, j, k) + s * texel(map, i + 1, j, k),
               below = (1 - s) * texel(map, i, j + 1, k) + s * texel(map, i + 1, j + 1, k);
        linear[k] = (float)((1 - t) * above + t * below);
    }
}

static Result paint_by_map(Paint *paint, const Strands *strands, const char *path, Error *error)
{
    if (!strands->strand_uv && !strands->vertex_uv)
        return error_set(error, RESULT_USAGE, "--color-map: the file has no texture coordinates");
    Image map;
    Result result = png_read(&map, path, error);
    for (uint32_t s = 0; result == RESULT_OK && s < strands->strand_count; ++s) {
        uint32_t root = strands->first[s];
        float color[3];
        sample(&map, strands->strand_uv ? strands->strand_uv[s] : strands->vertex_uv[root], color);
        for (uint32_t v = root; v < strands->first[s + 1]; ++v)
            memcpy(paint->color[v], color, sizeof color);
    }
    image_destroy(&map);
    return result;
}

static float clamp_share(float x)
{
    return fminf(fmaxf(x, 0), 1);
}

static void paint_by_file(Paint *paint, const Strands *strands)
{
    for (uint32_t v = 0; v < strands->vertex_count; ++v)
        for (int k = 0; k < 3; ++k) paint->color[v][k] = clamp_share(strands->color[v][k]);
}

static void take_all_seen(Paint *paint, const SectionParams *params)
{
    double wider = find_widening(params);
    for (uint32_t v = 0; v < paint->vertex_count; ++v) take_seen(params, wider, paint->color[v]);
}

static void paint_evenly(Paint *paint, const float color[3])
{
    for (uint32_t v = 0; v < paint->vertex_count; ++v)
        memcpy(paint->color[v], color, 3 * sizeof *color);
}

// How much of the tip's value vertex j of n takes: 0 up to `length` (a share of the strand) from
// the tip, then growing to 1 at the tip.
static float tip_share(float length, uint32_t j, uint32_t n)
{
    float from_tip = 1 - (float)j / (float)(n - 1);
    return length > 0 ? clamp_share(1 - from_tip / length) : 0;
}

static void paint_strand(Paint *paint, const Strands *strands, const SectionParams *params,
                         const float tip[3], uint32_t s)
{
    uint32_t first = strands->first[s], n = strands_size(strands, s);
    bool from_file = strands->color && params->file_opacity;
    double opacity = 0;
    for (uint32_t v = first; from_file && v < first + n; ++v)
        opacity += (double)clamp_share(strands->color[v][3]) / n;
    for (uint32_t j = 0; j < n; ++j) {
        float *color = paint->color[first + j], share = tip_share(params->tip_length, j, n);
        for (int k = 0; k < 3; ++k) color[k] += share * (tip[k] - color[k]);
        color[3] = from_file ? (float)opacity : 1;
    }
}

// The file's thickness at vertex v of strand s; 1 if the file has none.
static double file_thickness(const Strands *strands, uint32_t s, uint32_t v)
{
    if (strands->vertex_thickness) return fabs((double)strands->vertex_thickness[v]);
    return strands->strand_thickness ? fabs((double)strands->strand_thickness[s]) : 1;
}

static void set_thickness(Paint *paint, const Strands *strands, const SectionParams *params)
{
    bool from_file = params->file_thickness, tapers = from_file && strands->vertex_thickness;
    double mean = 0;
    for (uint32_t s = 0; s < strands->strand_count; ++s)
        for (uint32_t v = strands->first[s]; v < strands->first[s + 1]; ++v)
            mean += file_thickness(strands, s, v) / strands->vertex_count;
    if (!(mean > 0)) from_file = tapers = false;
    for (uint32_t s = 0; s < strands->strand_count; ++s) {
        uint32_t first = strands->first[s], n = strands_size(strands, s);
        for (uint32_t j = 0; j < n; ++j) {
            double factor = from_file ? file_thickness(strands, s, first + j) / mean : 1;
            if (!tapers) factor *= 1 - (1 - (double)params->tip_ratio) * j / (n - 1);
            paint->thickness[first + j] = (float)factor;
        }
    }
}

static bool is_wanted(const Strands *strands, const SectionParams *params)
{
    bool thickness = strands->vertex_thickness || strands->strand_thickness;
    return *params->color_map || params->tip_length > 0 ||
           (strands->color && params->file_colors) ||
           (params->file_opacity && !strands_are_opaque(strands)) ||
           (thickness && params->file_thickness);
}

Result paint_create(Paint *paint, const Strands *strands, const SectionParams *params, Error *error)
{
    *paint = (Paint){0};
    if (!is_wanted(strands, params)) return RESULT_OK;
    uint32_t count = strands->vertex_count;
    *paint = (Paint){.vertex_count = count,
                     .color = malloc(((size_t)count + 1) * sizeof *paint->color),
                     .thickness = malloc(((size_t)count + 1) * sizeof *paint->thickness)};
    Result result = RESULT_OK;
    float own[3], tip[3];
    paint_color(params, own);
    decode(params->tip_color, tip);
    take_seen(params, find_widening(params), tip);
    if (!paint->color || !paint->thickness)
        result = error_set(error, RESULT_FAILED, "no memory for the colours of %u vertices", count);
    else if (*params->color_map)
        result = paint_by_map(paint, strands, params->color_map, error);
    else if (strands->color && params->file_colors)
        paint_by_file(paint, strands), paint->colors_from_file = true;
    else
        paint_evenly(paint, own);
    bool seen = *params->color_map || paint->colors_from_file;
    if (result == RESULT_OK && seen) take_all_seen(paint, params);
    for (uint32_t s = 0; result == RESULT_OK && s < strands->strand_count; ++s)
        paint_strand(paint, strands, params, tip, s);
    if (result == RESULT_OK) set_thickness(paint, strands, params);
    if (result != RESULT_OK) paint_destroy(paint);
    return result;
}

bool paint_describe(const Strands *strands, const SectionParams *params, char *text, size_t size)
{
    uint32_t features = strands_features(strands);
    bool thickness = features & (STRANDS_HAS_STRAND_THICKNESS | STRANDS_HAS_VERTEX_THICKNESS);
    const struct {
        const char *what, *flag;
        bool carried, used;
    } looks[] = {
        {"colours", "--file-colors", strands->color, params->file_colors && !*params->color_map},
        {"opacities", "--file-opacity", !strands_are_opaque(strands), params->file_opacity},
        {"thickness", "--file-thickness", thickness, params->file_thickness},
    };
    size_t length = 0;
    *text = 0;
    for (size_t i = 0; i < sizeof looks / sizeof *looks; ++i)
        if (looks[i].carried && length < size)
            length +=
                (size_t)snprintf(text + length, size - length, "%s%s %s (%s)", length ? ", " : "",
                                 looks[i].what, looks[i].used ? "used" : "not used", looks[i].flag);
    return length > 0;
}

void paint_destroy(Paint *paint)
{
    free(paint->color);
    free(paint->thickness);
    *paint = (Paint){0};
}

// --- Radius, if neither the user nor the file gives one.

enum { MOST_SAMPLES = 500000, LEAST_CELLS = 8, MOST_CELLS = 64 };
static const double FIBRES = 3;      // in front of a point of the silhouette, on average
static const double SEEN = 0.5;      // share of the fibres that lie in front of the head or body
static const double TIP_RATIO = 0.3; // tip radius over root radius, the default of --tip-ratio
// Bounds of the radius, as shares of the longest strand. THICKEST applies to hair, STUBBIEST to
// fur.
static const double THINNEST = 1.0 / 5000, THICKEST = 1.0 / 400, STUBBIEST = 1.0 / 12;
static const double WIDEST = 1.0 / 300; // for fur, over the root of the silhouette's mean area
static const float NOTHING_TO_DRAW = 1e-4f;

// Fibres in a grid over the silhouette, for the three views along the axes.
typedef struct Silhouette {
    // length of fibre in the cell, each piece weighted by its share of the root's radius (m)
    double fibres[3][MOST_CELLS * MOST_CELLS];
    int cells;   // along the longest side of the box
    double side; // m, of one cell
    float low[3];
} Silhouette;

static int cell_of(const Silhouette *silhouette, double middle, int axis)
{
    int at = (int)((middle - (double)silhouette->low[axis]) / silhouette->side);
    return at < 0 ? 0 : at >= silhouette->cells ? silhouette->cells - 1 : at;
}

static void add_piece(Silhouette *silhouette, const double middle[3], const double fibres[3])
{
    int n = silhouette->cells, x = cell_of(silhouette, middle[0], 0),
        y = cell_of(silhouette, middle[1], 1), z = cell_of(silhouette, middle[2], 2);
    silhouette->fibres[0][y * n + z] += fibres[0];
    silhouette->fibres[1][z * n + x] += fibres[1];
    silhouette->fibres[2][x * n + y] += fibres[2];
}

// Adds a strand in pieces of at most half a cell, so that each piece belongs to one cell. Returns
// its length.
static double add_strand(Silhouette *silhouette, const Strands *strands, uint32_t s, double weight)
{
    uint32_t first = strands->first[s], n = strands_size(strands, s);
    double total = 0, taper = weight * (1 - TIP_RATIO) / (n - 1.0);
    for (uint32_t j = 0; j + 1 < n; ++j) {
        const float *a = strands->position[first + j], *b = strands->position[first + j + 1];
        double x = (double)b[0] - a[0], y = (double)b[1] - a[1], z = (double)b[2] - a[2],
               length = sqrt(x * x + y * y + z * z);
        total += length;
        // The box contains every segment, so `pieces` is bounded.
        int pieces = (int)ceil(2 * length / silhouette->side);
        double part = 1.0 / pieces, share = (weight - taper * (j + 0.5)) * part;
        double fibres[3] = {share * sqrt(y * y + z * z), share * sqrt(z * z + x * x),
                            share * sqrt(x * x + y * y)};
        for (int i = 0; i < pieces; ++i) {
            double along = (i + 0.5) * part;
            add_piece(silhouette, (double[3]){a[0] + along * x, a[1] + along * y, a[2] + along * z},
                      fibres);
        }
    }
    return total;
}

// The mean density (1/m) over the cells that contain hair. `area`: the area of these cells (m^2),
// averaged over the three views.
static double mean_density(const Silhouette *silhouette, double *area)
{
    double sum = 0, count = 0, cell = silhouette->side * silhouette->side;
    for (int view = 0; view < 3; ++view)
        for (int i = 0; i < silhouette->cells * silhouette->cells; ++i) {
            sum += silhouette->fibres[view][i];
            count += silhouette->fibres[view][i] > 0;
        }
    *area = count / 3 * cell;
    return sum / (count * cell);
}

float paint_auto_radius(const Strands *strands, uint32_t followers)
{
    float low[3], high[3];
    strands_bounds(strands, low, high);
    double longest = 0, side = 0, area;
    for (int k = 0; k < 3; ++k) side = fmax(side, (double)high[k] - (double)low[k]);
    if (!(side > 0)) return NOTHING_TO_DRAW;
    uint32_t stride = strands->vertex_count / MOST_SAMPLES + 1;
    // Cells are large enough to hold a few strands, because followers fill the space between
    // strands.
    int cells = (int)(sqrt((double)strands->strand_count / stride) / 2);
    cells = cells < LEAST_CELLS ? LEAST_CELLS : cells > MOST_CELLS ? MOST_CELLS : cells;
    Silhouette silhouette = {.cells = cells, .side = side / cells};
    memcpy(silhouette.low, low, sizeof low);
    for (uint32_t s = 0; s < strands->strand_count; s += stride)
        longest =
            fmax(longest, add_strand(&silhouette, strands, s, stride * (1 + (double)followers)));
    if (!(longest > 0)) return NOTHING_TO_DRAW;
    double radius = FIBRES / (SEEN * 2 * mean_density(&silhouette, &area));
    double fur = fmin(longest * STUBBIEST, sqrt(area) * WIDEST);
    return (float)fmin(fmax(radius, longest * THINNEST), fmax(longest * THICKEST, fur));
}

float paint_file_radius(const SectionParams *params, const Strands *strands)
{
    double mean = 0, longest = 0;
    if (!params->radius.automatic || !params->file_thickness || !strands->vertex_thickness ||
        strands->relative_widths)
        return 0;
    for (uint32_t v = 0; v < strands->vertex_count; ++v)
        mean += fabs((double)strands->vertex_thickness[v]) / strands->vertex_count;
    for (uint32_t s = 0; s < strands->strand_count; ++s)
        longest = fmax(longest, strands_length(strands, s));
    return mean > 1e-7 && mean < longest / 5 ? (float)(mean / 2) : 0;
}

float paint_radius(const SectionParams *params, const Strands *strands, uint32_t followers)
{
    float radius = params->radius.value;
    if (params->radius.automatic) radius = paint_file_radius(params, strands);
    if (!(radius > 0)) radius = paint_auto_radius(strands, followers);
    return params->width_scale * radius;
}
