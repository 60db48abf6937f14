// SPDX-License-Identifier: MIT
// The lobe of d'Eon et al. (2011) is the mean over the azimuth of exp(w/v) on the sphere, where w
// is the cosine of the angle from the mirrored direction. Average the light over the azimuth, and
// write it as a Legendre series in the sine of its inclination. Then a scattering by parallel
// fibres multiplies the coefficient of degree l by
//     S_l = sum over R, TT, TRT of albedo_p exp(-l (l + 1) v_p / 2).
// (The exponential is the coefficient of a normal distribution on the sphere, which stands for that
// of exp(w/v).) The light of all orders from the second on is
//     K(s, s') = sum over l of (2 l + 1) F_l G_l / (1 - q S_l) P_l(s) P_l(s')
// where P_l are Legendre polynomials; F, S and G scatter from the lamp, between fibres and to the
// eye; q is CONE_MET; s and s' are the sines at which light comes from the lamp and goes to the
// eye.
#include "draw/light_cone.h"

#include "glsl/draw/draw.h"

#include <math.h>

// Narrower lobes get this variance, because CONE_DEGREES terms would not resolve them.
static const double LEAST_VARIANCE = 0.0027; // (3 degrees)^2

// Fibres that are tilted against each other scatter light off the cone. The variance of the
// tangents times this factor is added to the lobes of F and S. The factor would be 1.5 if the tilts
// at both ends of a way were independent; 1.25 agreed best with path-traced light.
static const double SPREAD = 1.25;

// The share of perpendicular light that a fibre scatters in the lobe p, by channel.
static void find_albedos(const FibreLobes *lobes, int p, double albedo[3])
{
    for (int c = 0; c < 3; ++c) {
        const float(*row)[4] =
            (const float(*)[4])lobes->azimuthal +
            (c * SCATTER_INCLINATIONS + SCATTER_INCLINATIONS - 1) * SCATTER_AZIMUTHS;
        albedo[c] = 0;
        for (int i = 0; i < SCATTER_AZIMUTHS; ++i)
            albedo[c] += (i % (SCATTER_AZIMUTHS - 1) ? 1 : 0.5) * (double)row[i][p];
        albedo[c] *= 2 * PI / (SCATTER_AZIMUTHS - 1);
    }
}

// The factor by which one scattering multiplies the coefficient of this degree. The variance
// `extra` is added to each lobe. The tilt of a lobe counts as variance, too.
static double find_left(const FibreLobes *lobes, double albedo[3][3], int c, int degree,
                        double extra)
{
    double sum = 0;
    for (int p = 0; p < 3; ++p) {
        double tilt = (double)lobes->tilt_sin[p],
               variance = fmax((double)lobes->variance[p], LEAST_VARIANCE) + tilt * tilt + extra;
        sum += albedo[p][c] * exp(-0.5 * degree * (degree + 1) * variance);
    }
    return sum;
}

void cone_find_terms(ConeTerms *terms, const FibreLobes *lobes, float blur, float wide)
{
    double albedo[3][3], b = (double)blur, w = (double)wide;
    for (int p = 0; p < 3; ++p) find_albedos(lobes, p, albedo[p]);
    for (int c = 0; c < 3; ++c) {
        // `unit` scales K so that its mean over all directions is 1.
        const double met = (double)CONE_MET, all = find_left(lobes, albedo, c, 0, 0),
                     unit = (1 - met * all) / fmax(all * all, 1e-12);
        for (int l = 0; l < CONE_DEGREES; ++l) {
            double grid = 0;
            for (int row = CONE_LAST; row >= 0; --row) {
                bool is_grid = row == CONE_LAST;
                double spread = row * (double)CONE_STEP, tilts = SPREAD * spread * spread,
                       from = is_grid ? b : tilts, between = is_grid ? 2 * b : tilts,
                       to = is_grid ? b : 0,
                       left = find_left(lobes, albedo, c, l, from + w) *
                              find_left(lobes, albedo, c, l, to) /
                              (1 - met * find_left(lobes, albedo, c, l, between));
                if (is_grid) grid = left;
                // From the third row on, the light by exact lobes is mixed with the grid's: its
                // share is 3/4, 1/2, 1/4 and 0.
                double own = fmin((double)(CONE_LAST - row) / (CONE_LAST - 1), 1);
                terms->left[row][c][l] = (float)((2 * l + 1) * unit * (grid + own * (left - grid)));
            }
        }
    }
}

void cone_find_rows(const ConeTerms *terms, const ConeView *view, const float tangent[3],
                    float rows[CONE_ROWS][4])
{
    double s = 0, t = 0, product[CONE_DEGREES];
    for (int k = 0; k < 3; ++k) {
        s -= (double)tangent[k] * (double)view->to_light[k];
        t += (double)tangent[k] * (double)view->to_eye[k];
    }
    for (double l = 0, a = 1, b = s, c = 1, d = t; l < CONE_DEGREES; ++l) {
        double next = ((2 * l + 3) * s * b - (l + 1) * a) / (l + 2),
               after = ((2 * l + 3) * t * d - (l + 1) * c) / (l + 2);
        product[(int)l] = a * c;
        a = b, b = next, c = d, d = after;
    }
    for (int row = 0; row < CONE_ROWS; ++row) {
        for (int c = 0; c < 3; ++c) {
            double sum = 0;
            for (int l = 0; l < CONE_DEGREES; ++l)
                sum += product[l] * (double)terms->left[row][c][l];
            rows[row][c] = view->color[c] * (float)fmax(sum, 0);
        }
        rows[row][3] = 0;
    }
}
