// SPDX-License-Identifier: MIT
// Per pixel: E = dEc ^ (1 - dEf), with dEc the difference of colours as they are seen after the
// contrast sensitivity of the eye has blurred them, and dEf that of edges and points, which makes
// a difference of colours count the more where there is a difference of features.
#include "image/flip.h"

#include "image/convolve.h"

#include "glsl/common/shared_math.h"

#include <math.h>
#include <stdlib.h>

// --- Colours.

// The primaries of IEC 61966-2-1 under D65 at x = 0.31271, y = 0.32902, as the authors' tool has
// them: exact fractions of those chromaticities. The white is the sum of each row.
static const double XYZ_FROM_RGB[3][3] = {
    {10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
    {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
    {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382},
};

static double determinant(const double m[3][3], int r0, int r1, int c0, int c1)
{
    return m[r0][c0] * m[r1][c1] - m[r0][c1] * m[r1][c0];
}

// Cramer's rule: element r, c of the inverse is the cofactor c, r over the determinant.
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

// X, Y and Z relative to white.
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

// Back to linear RGB, clamped to what a monitor shows.
static void rgb_from_opponent(double rgb[3], const double ycc[3])
{
    double y = (ycc[0] + 16) / 116;
    double xyz[3] = {(y + ycc[1] / 500) * white(0), y * white(1), (y - ycc[2] / 200) * white(2)};
    solve_rgb(rgb, xyz);
    for (int i = 0; i < 3; ++i) rgb[i] = fmin(fmax(rgb[i], 0), 1);
}

// CIE 15: a cube root with a straight line below (6/29)^3.
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

// The exponent of differences, and the share pc of the largest one which is mapped linearly to
// 0..pt; the rest goes to pt..1.
static const double QC = 0.7, PC = 0.4, PT = 0.95;

// Green and blue are the two colours of sRGB that are farthest apart.
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

// Table 1: a contrast sensitivity is the sum of a Gaussian or two, a sqrt(pi / b) exp(-pi^2 x^2 /
// b) with x in degrees.
static const struct {
    int channel; // of YCxCz
    double a, b;
} SENSITIVITY[] = {{0, 1, 0.0047}, {1, 1, 0.0053}, {2, 34.1, 0.04}, {2, 13.5, 0.025}};
enum { SENSITIVITIES = sizeof SENSITIVITY / sizeof *SENSITIVITY };
static const double SENSITIVITY_WIDEST = 0.04;

// Width of the edges and points that are looked for, in degrees (section 4.2), and the exponent of
// their differences.
static const double FEATURE_WIDTH = 0.082, QF = 0.5;

typedef struct Filters {
    ConvolveKernel blur[SENSITIVITIES];
    double shares[SENSITIVITIES]; // of a channel's weight; 1 where it has one Gaussian
    ConvolveKernel gauss, edge, point;
} Filters;

// exp(-pi^2 x^2 / b) is a Gaussian of variance b / (2 pi^2); three of the widest one's standard
// deviations are the radius of all. The kernels have sum 1, so the Gaussian's own weight in two
// dimensions, its factor times the square of its sum, becomes a share.
static void make_blurs(Filters *filters, double ppd)
{
    int radius = (int)ceil(3 * sqrt(SENSITIVITY_WIDEST / (2 * M_PI * M_PI)) * ppd);
    double totals[3] = {0};
    for (int i = 0; i < SENSITIVITIES; ++i) {
        double sigma = sqrt(SENSITIVITY[i].b / (2 * M_PI * M_PI)) * ppd;
        convolve_make_gauss(&filters->blur[i], radius, sigma);
        double sum = 1 / filters->blur[i].weights[radius]; // as exp(0) = 1
        filters->shares[i] = SENSITIVITY[i].a * sqrt(M_PI / SENSITIVITY[i].b) * sum * sum;
        totals[SENSITIVITY[i].channel] += filters->shares[i];
    }
    for (int i = 0; i < SENSITIVITIES; ++i) filters->shares[i] /= totals[SENSITIVITY[i].channel];
}

static void make_filters(Filters *filters, double ppd)
{
    double sigma = 0.5 * FEATURE_WIDTH * ppd;
    int radius = (int)ceil(3 * sigma);
    make_blurs(filters, ppd);
    convolve_make_gauss(&filters->gauss, radius, sigma);
    convolve_make_derivative(&filters->edge, 1, radius, sigma);
    convolve_make_derivative(&filters->point, 2, radius, sigma);
}

// --- An image: what of it is compared.

enum { YCC = 0, SEEN = 3, EDGE = 6, POINT, SCRATCH, PLANES = SCRATCH + 2 };

typedef struct Percept {
    int width, height;
    float *planes; // [PLANES][height][width]: YCxCz, the same blurred and then Hunt's L*a*b*, ...
} Percept;

static float *plane_of(const Percept *percept, int plane)
{
    return percept->planes + (size_t)plane * (size_t)percept->width * (size_t)percept->height;
}

static void split_opponents(Percept *percept, const FloatImage *image)
{
    double table[256];
    size_t count = (size_t)image->width * (size_t)image->height;
    for (int i = 0; i < 256; ++i) table[i] = float_image_linear((float)i);
    for (size_t i = 0; i < count; ++i) {
        double rgb[3], ycc[3];
        for (int k = 0; k < 3; ++k) {
            float level = fminf(fmaxf(image->rgb[3 * i + (size_t)k], 0), 255);
            rgb[k] = level == truncf(level) ? table[(int)level] : float_image_linear(level);
        }
        flip_opponent(ycc, rgb);
        for (int k = 0; k < 3; ++k) plane_of(percept, YCC + k)[i] = (float)ycc[k];
    }
}

static void apply(const Percept *percept, int out, int in, const ConvolveKernel *x,
                  const ConvolveKernel *y)
{
    float *between = plane_of(percept, SCRATCH);
    convolve_apply_x(between, plane_of(percept, in), percept->width, percept->height, x);
    convolve_apply_y(plane_of(percept, out), between, percept->width, percept->height, y);
}

static void see_colors(const Percept *percept, const Filters *filters)
{
    size_t count = (size_t)percept->width * (size_t)percept->height;
    float *part = plane_of(percept, SCRATCH + 1);
    for (size_t i = 0; i < 3 * count; ++i) plane_of(percept, SEEN)[i] = 0;
    for (int s = 0; s < SENSITIVITIES; ++s) {
        int channel = SENSITIVITY[s].channel;
        float *seen = plane_of(percept, SEEN + channel);
        apply(percept, SCRATCH + 1, YCC + channel, &filters->blur[s], &filters->blur[s]);
        for (size_t i = 0; i < count; ++i) seen[i] += (float)filters->shares[s] * part[i];
    }
    for (size_t i = 0; i < count; ++i) {
        double ycc[3], rgb[3], lab[3];
        for (int k = 0; k < 3; ++k) ycc[k] = (double)plane_of(percept, SEEN + k)[i];
        rgb_from_opponent(rgb, ycc);
        flip_hunt_lab(lab, rgb);
        for (int k = 0; k < 3; ++k) plane_of(percept, SEEN + k)[i] = (float)lab[k];
    }
}

// The length of the two responses, along x and along y, of `kernel` to the luminance Y between 0
// and 1. An affine map of YCxCz's Y commutes with the filters, whose sum is 0: it takes the factor.
static void find_feature(const Percept *percept, int out, const ConvolveKernel *kernel,
                         const ConvolveKernel *gauss)
{
    size_t count = (size_t)percept->width * (size_t)percept->height;
    float *x = plane_of(percept, out), *y = plane_of(percept, SCRATCH + 1);
    apply(percept, out, YCC, kernel, gauss);
    apply(percept, SCRATCH + 1, YCC, gauss, kernel);
    for (size_t i = 0; i < count; ++i) x[i] = sqrtf(x[i] * x[i] + y[i] * y[i]) / 116;
}

static Result percept_create(Percept *percept, const FloatImage *image, const Filters *filters,
                             Error *error)
{
    size_t count = (size_t)image->width * (size_t)image->height;
    *percept = (Percept){.width = image->width, .height = image->height};
    percept->planes = malloc(count * PLANES * sizeof *percept->planes);
    if (!percept->planes)
        return error_set(error, RESULT_FAILED, "no memory for FLIP of images of %d x %d",
                         image->width, image->height);
    split_opponents(percept, image);
    see_colors(percept, filters);
    find_feature(percept, EDGE, &filters->edge, &filters->gauss);
    find_feature(percept, POINT, &filters->point, &filters->gauss);
    return RESULT_OK;
}

// ---

static double error_at(const Percept *a, const Percept *b, size_t i, double most)
{
    double p[3], q[3];
    for (int k = 0; k < 3; ++k) {
        p[k] = (double)plane_of(a, SEEN + k)[i];
        q[k] = (double)plane_of(b, SEEN + k)[i];
    }
    double color = redistribute(flip_hyab(p, q), most);
    double edge = fabs((double)plane_of(a, EDGE)[i] - (double)plane_of(b, EDGE)[i]);
    double point = fabs((double)plane_of(a, POINT)[i] - (double)plane_of(b, POINT)[i]);
    // A response is at most sqrt(2) long, being two of at most 1; beyond the exact bound there is
    // only rounding.
    double feature = fmin(pow(fmax(edge, point) / sqrt(2), QF), 1);
    return color > 0 ? fmin(pow(color, 1 - feature), 1) : 0;
}

Result flip_compare(float *map, double *mean, const FloatImage *a, const FloatImage *b,
                    double pixels_per_degree, Error *error)
{
    Filters filters;
    Percept p = {0}, q = {0};
    size_t count = (size_t)a->width * (size_t)a->height;
    make_filters(&filters, pixels_per_degree);
    Result result = percept_create(&p, a, &filters, error);
    THEN(result, percept_create(&q, b, &filters, error));
    if (result == RESULT_OK) {
        double most = largest_power(), sum = 0;
        for (size_t i = 0; i < count; ++i) {
            map[i] = (float)error_at(&p, &q, i, most);
            sum += (double)map[i];
        }
        *mean = sum / (double)count;
    }
    free(p.planes);
    free(q.planes);
    return result;
}
