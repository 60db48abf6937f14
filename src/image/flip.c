// SPDX-License-Identifier: MIT
// Error of a pixel: E = dEc ^ (1 - dEf). dEc is the difference of the colours after a blur by the
// eye's contrast sensitivity. dEf is the difference of edges and points; it amplifies a difference
// of colours at the same pixel.
#include "image/flip.h"

#include "image/convolve.h"

#include "glsl/common/shared_math.h"

#include <math.h>
#include <stdlib.h>

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

// Back to linear RGB, clamped to the range of a monitor.
static void rgb_from_opponent(double rgb[3], const double ycc[3])
{
    double y = (ycc[0] + 16) / 116;
    double xyz[3] = {(y + ycc[1] / 500) * white(0), y * white(1), (y - ycc[2] / 200) * white(2)};
    solve_rgb(rgb, xyz);
    for (int i = 0; i < 3; ++i) rgb[i] = fmin(fmax(rgb[i], 0), 1);
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
// exponent of their differences.
static const double FEATURE_WIDTH = 0.082, QF = 0.5;

typedef struct Filters {
    ConvolveKernel blur[SENSITIVITIES];
    double shares[SENSITIVITIES]; // weight within the channel; 1 if it has one Gaussian
    ConvolveKernel gauss, edge, point;
} Filters;

// exp(-pi^2 x^2 / b) is a Gaussian of variance b / (2 pi^2). All kernels have the same radius,
// three standard deviations of the widest. Each kernel is normalised to sum 1, so a Gaussian's
// weight in two dimensions, its factor times the square of its original sum, becomes its share of
// the channel.
static void make_blurs(Filters *filters, double ppd)
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

static void make_filters(Filters *filters, double ppd)
{
    double sigma = 0.5 * FEATURE_WIDTH * ppd;
    int radius = (int)ceil(3 * sigma);
    make_blurs(filters, ppd);
    convolve_make_gauss(&filters->gauss, radius, sigma);
    convolve_make_derivative(&filters->edge, 1, radius, sigma);
    convolve_make_derivative(&filters->point, 2, radius, sigma);
}

// --- An image as the eye perceives it.

enum { YCC = 0, SEEN = 3, EDGE = 6, POINT, SCRATCH, PLANES = SCRATCH + 2 };

typedef struct Percept {
    int width, height;
    float *planes; // [PLANES][height][width] YCxCz, then blurred and in Hunt's L*a*b*, ...
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

// The norm of the responses to `kernel` along x and along y. The filters work on YCxCz's Y instead
// of the luminance in 0..1. That is an affine map of it: the offset drops out because the filters
// sum to 0, and the division by 116 undoes the factor.
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

// --- The error of a pixel.

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
    // Each of the two responses is at most 1, so the norm is at most sqrt(2), apart from rounding.
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
