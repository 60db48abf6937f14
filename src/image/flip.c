// SPDX-License-Identifier: MIT
// Error of a pixel: E = dEc ^ (1 - dEf). dEc is the difference of the colours after a blur by the
// eye's contrast sensitivity. dEf is the difference of edges and points; it amplifies a difference
// of colours at the same pixel.
#include "image/flip.h"

#include "base/simd.h"
#include "image/convolve.h"

#include "glsl/common/shared_math.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

// --- Colours.

// RGB to XYZ for the primaries of IEC 61966-2-1 and D65 at x = 0.31271, y = 0.32902: the exact
// fractions that the authors' tool uses. White is the sum of each row.
static const double XYZ_FROM_RGB[3][3] = {
    {10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
    {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
    {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382},
};

static double determinant(const double m[3][3], int r0, int r1, int c0, int c1)
{
    return m[r0][c0] * m[r1][c1] - m[r0][c1] * m[r1][c0];
}

// Inverts XYZ_FROM_RGB by Cramer's rule: element r, c of the inverse is the cofactor c, r over the
// determinant.
static void solve_rgb(double rgb[3], const double xyz[3])
{
    double volume = 0;
    for (int c = 0; c < 3; ++c)
        volume += XYZ_FROM_RGB[0][c] * determinant(XYZ_FROM_RGB, 1, 2, (c + 1) % 3, (c + 2) % 3);
    for (int r = 0; r < 3; ++r) {
        rgb[r] = 0;
        for (int c = 0; c < 3; ++c)
            rgb[r] += xyz[c] / volume *
                      determinant(XYZ_FROM_RGB, (c + 1) % 3, (c + 2) % 3, (r + 1) % 3, (r + 2) % 3);
    }
}

static double white(int i)
{
    return XYZ_FROM_RGB[i][0] + XYZ_FROM_RGB[i][1] + XYZ_FROM_RGB[i][2];
}

// X, Y and Z divided by those of white.
static void relative_xyz(double xyz[3], const double rgb[3])
{
    for (int i = 0; i < 3; ++i)
        xyz[i] = (XYZ_FROM_RGB[i][0] * rgb[0] + XYZ_FROM_RGB[i][1] * rgb[1] +
                  XYZ_FROM_RGB[i][2] * rgb[2]) /
                 white(i);
}

void flip_opponent(double ycc[3], const double rgb[3])
{
    double xyz[3];
    relative_xyz(xyz, rgb);
    ycc[0] = 116 * xyz[1] - 16;
    ycc[1] = 500 * (xyz[0] - xyz[1]);
    ycc[2] = 200 * (xyz[1] - xyz[2]);
}

// Back to linear RGB; `ycc` without the offset of Y, -16.
static void rgb_from_opponents(double rgb[3], const double ycc[3])
{
    double y = ycc[0] / 116;
    double xyz[3] = {(y + ycc[1] / 500) * white(0), y * white(1), (y - ycc[2] / 200) * white(2)};
    solve_rgb(rgb, xyz);
}

// CIE 15: a cube root, with a straight line below (6/29)^3.
static double lab_curve(double t)
{
    const double delta = 6.0 / 29;
    return t > delta * delta * delta ? cbrt(t) : t / (3 * delta * delta) + 4.0 / 29;
}

void flip_hunt_lab(double lab[3], const double rgb[3])
{
    double xyz[3];
    relative_xyz(xyz, rgb);
    for (int i = 0; i < 3; ++i) xyz[i] = lab_curve(xyz[i]);
    lab[0] = 116 * xyz[1] - 16;
    lab[1] = 0.01 * lab[0] * 500 * (xyz[0] - xyz[1]);
    lab[2] = 0.01 * lab[0] * 200 * (xyz[1] - xyz[2]);
}

double flip_hyab(const double a[3], const double b[3])
{
    double da = a[1] - b[1], db = a[2] - b[2];
    return fabs(a[0] - b[0]) + sqrt(da * da + db * db);
}

// QC is the exponent of colour differences. The lower share PC of their range is mapped linearly to
// 0..PT, the rest to PT..1.
static const double QC = 0.7, PC = 0.4, PT = 0.95;

// Green and blue are the two sRGB colours with the largest difference.
static double largest_power(void)
{
    const double green[3] = {0, 1, 0}, blue[3] = {0, 0, 1};
    double a[3], b[3];
    flip_hunt_lab(a, green);
    flip_hunt_lab(b, blue);
    return pow(flip_hyab(a, b), QC);
}

static double redistribute(double hyab, double most)
{
    double power = pow(hyab, QC), knee = PC * most;
    return power < knee ? PT / knee * power : PT + (power - knee) / (most - knee) * (1 - PT);
}

double flip_color_difference(double hyab)
{
    return redistribute(hyab, largest_power());
}

// --- Filters.

// Table 1: a contrast sensitivity is a sum of one or two Gaussians a sqrt(pi / b) exp(-pi^2 x^2 /
// b), x in degrees.
static const struct {
    int channel; // of YCxCz
    double a, b;
} SENSITIVITY[] = {{0, 1, 0.0047}, {1, 1, 0.0053}, {2, 34.1, 0.04}, {2, 13.5, 0.025}};
enum { SENSITIVITIES = sizeof SENSITIVITY / sizeof *SENSITIVITY };
static const double SENSITIVITY_WIDEST = 0.04;

// FEATURE_WIDTH is the width of the detected edges and points in degrees (section 4.2), QF the
// exponent of their differences, 0.5: a square root.
static const double FEATURE_WIDTH = 0.082;

struct FlipFilters {
    ConvolveKernel blur[SENSITIVITIES];
    double shares[SENSITIVITIES]; // weight within the channel; 1 if it has one Gaussian
    ConvolveKernel gauss, edge, point;
    // Matrices from linear RGB to opponents, from these to RGB, and from RGB to XYZ relative to
    // white. Opponents are YCxCz, but Y without its offset of -16: blurs keep an offset, edges and
    // points have none, and without it floats are as exact in the dark as in the light.
    double opponents[3][3], rgb[3][3], xyz[3][3];
    float linear[256]; // of sRGB levels
};

// exp(-pi^2 x^2 / b) is a Gaussian of variance b / (2 pi^2). All kernels have the same radius,
// three standard deviations of the widest. Each kernel is normalised to sum 1, so a Gaussian's
// weight in two dimensions, its factor times the square of its original sum, becomes its share of
// the channel.
static void make_blurs(FlipFilters *filters, double ppd)
{
    int radius = (int)ceil(3 * sqrt(SENSITIVITY_WIDEST / (2 * M_PI * M_PI)) * ppd);
    double totals[3] = {0};
    for (int i = 0; i < SENSITIVITIES; ++i) {
        double sigma = sqrt(SENSITIVITY[i].b / (2 * M_PI * M_PI)) * ppd;
        convolve_make_gauss(&filters->blur[i], radius, sigma);
        double sum = 1 / filters->blur[i].weights[radius]; // because exp(0) = 1
        filters->shares[i] = SENSITIVITY[i].a * sqrt(M_PI / SENSITIVITY[i].b) * sum * sum;
        totals[SENSITIVITY[i].channel] += filters->shares[i];
    }
    for (int i = 0; i < SENSITIVITIES; ++i) filters->shares[i] /= totals[SENSITIVITY[i].channel];
}

static void make_matrices(FlipFilters *filters)
{
    for (int c = 0; c < 3; ++c) {
        double unit[3] = {c == 0, c == 1, c == 2}, black[3] = {0}, opponents[3], offset[3], rgb[3],
               xyz[3];
        flip_opponent(opponents, unit);
        flip_opponent(offset, black);
        relative_xyz(xyz, unit);
        rgb_from_opponents(rgb, unit);
        for (int r = 0; r < 3; ++r) {
            filters->opponents[r][c] = opponents[r] - offset[r];
            filters->xyz[r][c] = xyz[r];
            filters->rgb[r][c] = rgb[r];
        }
    }
}

static void make_filters(FlipFilters *filters, double ppd)
{
    double sigma = 0.5 * FEATURE_WIDTH * ppd;
    int radius = (int)ceil(3 * sigma);
    make_blurs(filters, ppd);
    convolve_make_gauss(&filters->gauss, radius, sigma);
    convolve_make_derivative(&filters->edge, 1, radius, sigma);
    convolve_make_derivative(&filters->point, 2, radius, sigma);
    make_matrices(filters);
    for (int i = 0; i < 256; ++i) filters->linear[i] = (float)float_image_linear((float)i);
}

// --- An image as the eye perceives it.

// Planes of an image. LIGHT holds linear RGB until the blurred colours take its place.
enum { OPPONENTS = 0, LIGHT = 3, SEEN = LIGHT, EDGE = 6, POINT, SCRATCH, PLANES = SCRATCH + 2 };

typedef struct Percept {
    const FlipFilters *filters;
    int width, height;
    float *planes; // [PLANES][height][width]
} Percept;

SIMD_INLINE float *plane_of(const Percept *percept, int plane)
{
    return percept->planes + (size_t)plane * (size_t)percept->width * (size_t)percept->height;
}

static void find_light(const Percept *percept, const FloatImage *image)
{
    size_t count = (size_t)percept->width * (size_t)percept->height;
    for (size_t k = 0; k < 3; ++k) {
        float *light = plane_of(percept, LIGHT + (int)k);
        for (size_t i = 0; i < count; ++i) {
            float level = SHARED_MIN(SHARED_MAX(image->rgb[3 * i + k], 0), 255);
            int whole = (int)level;
            light[i] = level == (float)whole ? percept->filters->linear[whole]
                                             : (float)float_image_linear(level);
        }
    }
}

SIMD_INLINE void transform(double to[3], const double matrix[3][3], const double from[3])
{
    for (int r = 0; r < 3; ++r)
        to[r] = matrix[r][0] * from[0] + matrix[r][1] * from[1] + matrix[r][2] * from[2];
}

SIMD_INLINE void split_opponents(const Percept *percept, int part)
{
    int count = percept->width * percept->height;
    float *planes[6];
    (void)part;
    for (int k = 0; k < 3; ++k) {
        planes[k] = plane_of(percept, LIGHT + k);
        planes[3 + k] = plane_of(percept, OPPONENTS + k);
    }
    for (int i = 0; i < count; ++i) {
        double rgb[3] = {(double)planes[0][i], (double)planes[1][i], (double)planes[2][i]},
               opponents[3];
        transform(opponents, percept->filters->opponents, rgb);
        for (int k = 0; k < 3; ++k) planes[3 + k][i] = (float)opponents[k];
    }
}

// The cube root of t >= 2^-126: a guess from the exponent of a float, within 4 %, then three of
// Halley's steps, whose errors are about the cubes of those before.
SIMD_INLINE double cube_root(double t)
{
    float rough = (float)t;
    int32_t bits;
    memcpy(&bits, &rough, sizeof bits);
    double root =
        (double)simd_float_of((uint32_t)((int32_t)((float)bits * (1 / 3.0f)) + 709958130));
    for (int i = 0; i < 3; ++i) {
        double cube = root * root * root;
        root = root * (cube + 2 * t) / (2 * cube + t);
    }
    return root;
}

// lab_curve without a branch.
SIMD_INLINE double lab_curve_lane(double t)
{
    const double delta = 6.0 / 29, knee = delta * delta * delta;
    double root = cube_root(t > knee ? t : knee), line = t / (3 * delta * delta) + 4.0 / 29;
    return t > knee ? root : line;
}

// The blurred opponents in place: to RGB, clamped to the range of a monitor, and to Hunt's L*a*b*.
// In double, because a* and b* are small differences.
SIMD_INLINE void see(const Percept *percept, int part)
{
    int count = percept->width * percept->height;
    float *seen[3];
    (void)part;
    for (int k = 0; k < 3; ++k) seen[k] = plane_of(percept, SEEN + k);
    for (int i = 0; i < count; ++i) {
        double opponents[3] = {(double)seen[0][i], (double)seen[1][i], (double)seen[2][i]}, rgb[3],
               xyz[3];
        transform(rgb, percept->filters->rgb, opponents);
        for (int k = 0; k < 3; ++k) {
            rgb[k] = rgb[k] > 0 ? rgb[k] : 0;
            rgb[k] = rgb[k] < 1 ? rgb[k] : 1;
        }
        transform(xyz, percept->filters->xyz, rgb);
        for (int k = 0; k < 3; ++k) xyz[k] = lab_curve_lane(xyz[k]);
        double lightness = 116 * xyz[1] - 16;
        seen[0][i] = (float)lightness;
        seen[1][i] = (float)(0.01 * lightness * 500 * (xyz[0] - xyz[1]));
        seen[2][i] = (float)(0.01 * lightness * 200 * (xyz[1] - xyz[2]));
    }
}

SIMD_CALL(split_opponents, Percept)
SIMD_CALL(see, Percept)

static void apply(const Percept *percept, int out, int in, const ConvolveKernel *x,
                  const ConvolveKernel *y)
{
    float *between = plane_of(percept, SCRATCH);
    convolve_apply_x(between, plane_of(percept, in), percept->width, percept->height, x);
    convolve_apply_y(plane_of(percept, out), between, percept->width, percept->height, y);
}

static void see_colors(const Percept *percept)
{
    size_t count = (size_t)percept->width * (size_t)percept->height;
    const FlipFilters *filters = percept->filters;
    const float *part = plane_of(percept, SCRATCH + 1);
    for (int s = 0; s < SENSITIVITIES; ++s) {
        int channel = SENSITIVITY[s].channel;
        bool first = s == 0 || SENSITIVITY[s - 1].channel != channel;
        float *seen = plane_of(percept, SEEN + channel), share = (float)filters->shares[s];
        apply(percept, first ? SEEN + channel : SCRATCH + 1, OPPONENTS + channel, &filters->blur[s],
              &filters->blur[s]);
        for (size_t i = 0; i < count && first && share < 1; ++i) seen[i] *= share;
        for (size_t i = 0; i < count && !first; ++i) seen[i] += share * part[i];
    }
    call_see(percept);
}

// The norms of the responses to edges and points along x and along y. The filters work on Y in 0 to
// 116; they are linear. Derivatives come first: a blur before them would add roundings of Y, which
// the square root in find_differences would make large.
static void find_features(const Percept *percept)
{
    const FlipFilters *filters = percept->filters;
    const ConvolveKernel *kernels[] = {&filters->edge, &filters->point};
    int width = percept->width, height = percept->height;
    size_t count = (size_t)width * (size_t)height;
    const float *luminance = plane_of(percept, OPPONENTS);
    float *between = plane_of(percept, SCRATCH), *y = plane_of(percept, SCRATCH + 1);
    for (int f = 0; f < 2; ++f) {
        float *x = plane_of(percept, EDGE + f);
        convolve_apply_x(between, luminance, width, height, kernels[f]);
        convolve_apply_y(x, between, width, height, &filters->gauss);
        convolve_apply_y(between, luminance, width, height, kernels[f]);
        convolve_apply_x(y, between, width, height, &filters->gauss);
        for (size_t i = 0; i < count; ++i) x[i] = sqrtf(x[i] * x[i] + y[i] * y[i]) * (1 / 116.0f);
    }
}

static void perceive(const Percept *percept, const FloatImage *image)
{
    find_light(percept, image);
    call_split_opponents(percept);
    see_colors(percept);
    find_features(percept);
}

// --- The error of a pixel.

// The difference of the colours as HyAB, and that of the features, already to the power QF.
typedef struct Differences {
    const Percept *a, *b;
    float *color, *feature; // [height][width]
} Differences;

SIMD_INLINE void find_differences(const Differences *differences, int part)
{
    const Percept *a = differences->a, *b = differences->b;
    int count = a->width * a->height;
    const float *p[POINT + 1], *q[POINT + 1];
    (void)part;
    for (int k = SEEN; k <= POINT; ++k) p[k] = plane_of(a, k), q[k] = plane_of(b, k);
    for (int i = 0; i < count; ++i) {
        float da = p[SEEN + 1][i] - q[SEEN + 1][i], db = p[SEEN + 2][i] - q[SEEN + 2][i];
        float edge = fabsf(p[EDGE][i] - q[EDGE][i]), point = fabsf(p[POINT][i] - q[POINT][i]);
        differences->color[i] = fabsf(p[SEEN][i] - q[SEEN][i]) + sqrtf(da * da + db * db);
        // Each of the two responses is at most 1, so the norm is at most sqrt(2), apart from
        // rounding.
        differences->feature[i] = simd_min(sqrtf(simd_max(edge, point) * 0.70710678f), 1);
    }
}

SIMD_CALL(find_differences, Differences)

static float redistribute_float(float hyab, float most)
{
    float power = powf(hyab, (float)QC), knee = (float)PC * most, top = (float)PT;
    return power < knee ? top / knee * power : top + (power - knee) / (most - knee) * (1 - top);
}

Result flip_create(Flip *flip, size_t pixels, double pixels_per_degree, Error *error)
{
    *flip = (Flip){.filters = malloc(sizeof *flip->filters),
                   .planes = malloc(2 * pixels * PLANES * sizeof *flip->planes),
                   .pixels = pixels};
    if (!flip->filters || !flip->planes) {
        flip_destroy(flip);
        return error_set(error, RESULT_FAILED, "no memory for FLIP of %zu pixels", pixels);
    }
    make_filters(flip->filters, pixels_per_degree);
    return RESULT_OK;
}

void flip_destroy(Flip *flip)
{
    free(flip->filters);
    free(flip->planes);
    *flip = (Flip){0};
}

int flip_reach(double pixels_per_degree)
{
    return (int)ceil(3 * fmax(sqrt(SENSITIVITY_WIDEST / (2 * M_PI * M_PI)), 0.5 * FEATURE_WIDTH) *
                     pixels_per_degree);
}

void flip_find(const Flip *flip, float *map, const FloatImage *a, const FloatImage *b)
{
    size_t count = (size_t)a->width * (size_t)a->height;
    float most = (float)largest_power();
    Percept p = {flip->filters, a->width, a->height, flip->planes}, q = p;
    assert(count <= flip->pixels && a->width == b->width && a->height == b->height);
    q.planes += count * PLANES;
    perceive(&p, a);
    perceive(&q, b);
    Differences differences = {&p, &q, plane_of(&p, SCRATCH), plane_of(&q, SCRATCH)};
    call_find_differences(&differences);
    for (size_t i = 0; i < count; ++i) {
        float color = differences.color[i], feature = differences.feature[i];
        map[i] = color > 0 ? SHARED_MIN(powf(redistribute_float(color, most), 1 - feature), 1) : 0;
    }
}

Result flip_compare(float *map, double *mean, const FloatImage *a, const FloatImage *b,
                    double pixels_per_degree, Error *error)
{
    Flip flip;
    size_t count = (size_t)a->width * (size_t)a->height;
    double sum = 0;
    TRY(flip_create(&flip, count, pixels_per_degree, error));
    flip_find(&flip, map, a, b);
    flip_destroy(&flip);
    for (size_t i = 0; i < count; ++i) sum += (double)map[i];
    *mean = sum / (double)count;
    return RESULT_OK;
}
