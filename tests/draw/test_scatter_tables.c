// SPDX-License-Identifier: MIT
// Marschner's table against the reference, and properties that hold for all light.
#include "draw/drawing.h"
#include "draw/scatter_tables.h"
#include "gpu/gpu_buffer.h"
#include "gpu/gpu_uniforms.h"
#include "support/needed.h"
#include "support/plain.h"
#include "support/reference_marschner.h"
#include "support/test_glsl.h"

#include "glsl/common/shared_math.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static Gpu gpu;
static ScatterTables tables;
static GLuint programs[2]; // probe_shade.comp, indexed by Lobes

static int open_gpu(void **state)
{
    (void)state;
    NEEDED(gpu_create(&gpu, &(GpuOptions){0}, error));
    tables.stock = gpu.tables;
    shader_add_sources(TEST_GLSL_SOURCES);
    shader_treat_warnings_as_errors(true);
    for (int lobes = LOBES_ENERGY; lobes <= LOBES_GAUSS; ++lobes) {
        const ShaderDefine defines[] = {{"MARSCHNER", 1 + lobes}, {NULL, 0}};
        NEEDED(shader_build_compute(&programs[lobes], "probe_shade.comp", defines, error));
    }
    return 0;
}

static int close_gpu(void **state)
{
    (void)state;
    scatter_tables_destroy(&tables);
    for (int i = 0; i < 2; ++i) shader_release(programs[i]);
    gpu_destroy(&gpu);
    return 0;
}

// A fibre that scatters by its table alone.
static SectionParams make_fibre(float color)
{
    SectionParams params;
    plain_section(&params);
    params.diffuse = 0;
    params.transmission = (AutoVec3){.value = {color, color, color}};
    return params;
}

typedef float Direction[4];

static void set_direction(Direction d, double theta, double phi)
{
    d[0] = (float)(cos(theta) * cos(phi));
    d[1] = (float)sin(theta);
    d[2] = (float)(cos(theta) * sin(phi));
    d[3] = 0;
}

// Computes f for `count` pairs of directions (towards the light, towards the eye) on the GPU.
static void scatter(const SectionParams *params, int count, Direction (*pairs)[2], float (*f)[4])
{
    GpuBuffer in, out;
    DrawParams draw_params = {.light_count = 1};
    MaterialParams look = drawing_material(params, 1);
    ScatterTable *table;
    look.color_variation = 0;
    look.warmth_variation = 0;
    NEEDED(scatter_tables_find(&tables, params->refraction, glm_rad(params->azimuthal_roughness),
                               &table, error));
    NEEDED(gpu_buffer_create(&in, &gpu.limits, "pairs", count * (int64_t)sizeof *pairs, pairs, 0,
                             error));
    NEEDED(gpu_buffer_create(&out, &gpu.limits, "answers", count * (int64_t)sizeof *f, NULL, 0,
                             error));
    gpu_uniforms_set(BIND_DRAW, &draw_params, sizeof draw_params);
    gpu_uniforms_set(BIND_MATERIAL, &look, sizeof look);
    gpu_buffer_bind_storage(&in, 0);
    gpu_buffer_bind_storage(&out, 1);
    glActiveTexture(GL_TEXTURE0 + BIND_SCATTER);
    glBindTexture(GL_TEXTURE_3D, scatter_table_texture(table));
    glUseProgram(programs[params->lobes]);
    glDispatchCompute((GLuint)(count + 31) / 32, 1, 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, out.buffer);
    glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, count * (GLsizeiptr)sizeof *f, f);
    gpu_buffer_destroy(&in);
    gpu_buffer_destroy(&out);
}

// Interpolates between nodes like a texture unit; the table has 128 x 64 x 24 nodes.
static double read_table(const float (*table)[4], const double at[3], int lobe)
{
    const int nodes[] = {SCATTER_AZIMUTHS, SCATTER_INCLINATIONS, SCATTER_COLORS};
    int base[3];
    double t[3], sum = 0;
    for (int k = 0; k < 3; ++k) {
        double x = at[k] * (nodes[k] - 1);
        base[k] = (int)fmin(x, nodes[k] - 2);
        t[k] = x - base[k];
    }
    for (int corner = 0; corner < 8; ++corner) {
        double weight = 1;
        size_t index = 0;
        for (int k = 2; k >= 0; --k) {
            int bit = corner >> k & 1;
            weight *= bit ? t[k] : 1 - t[k];
            index = index * (size_t)nodes[k] + (size_t)(base[k] + bit);
        }
        sum += weight * (double)table[index][lobe];
    }
    return sum;
}

// The largest difference from quadrature within a range of cos(theta_d), including the error of
// linear interpolation between nodes.
static double table_error(double eta, double roughness, const float (*table)[4], double from,
                          double to)
{
    double worst = 0;
    for (int i = 0; i < 1000; ++i) { // spread evenly by three irrational steps
        double at[3] = {fmod(i * 0.618034, 1), from + (to - from) * fmod(i * 0.754878, 1),
                        fmod(i * 0.569840, 1)};
        double exact[LOBE_COUNT];
        marschner_azimuthal(eta, roughness, at[1], at[2], at[0] * PI, 400, exact);
        for (int p = 0; p < LOBE_COUNT; ++p)
            worst = fmax(worst, fabs(read_table(table, at, p) - exact[p]));
    }
    return worst;
}

// Densities are up to 1.9 per radian. Below cos(theta_d) = 0.02, one degree from the fibre's
// direction, they change within one step of the table.
static void the_table_is_the_quadrature(void **state)
{
    (void)state;
    const double roughnesses_deg[] = {5, 12, 40, 75}, etas[] = {1.55, 1.55, 1.3, 1.55};
    for (int r = 0; r < 4; ++r) {
        ScatterTable *table;
        FibreTable read;
        double roughness = roughnesses_deg[r] * PI / 180;
        NEEDED(scatter_tables_find(&tables, (float)etas[r], (float)roughness, &table, error));
        NEEDED(scatter_table_read(table, &read, error));
        double worst = table_error(etas[r], roughness, read.values, 0.02, 1),
               along = table_error(etas[r], roughness, read.values, 1e-3, 0.02);
        print_message("roughness %g deg, eta %g: off by %.2g at most, along the fibre %.2g\n",
                      roughnesses_deg[r], etas[r], worst, along);
        if (worst > 1e-3 || along > 1.7e-3) fail_msg("the table is off by %g, %g", worst, along);
    }
}

// All lobes, for light and eye at any inclination, with tilted scales.
static void compare_with_reference(Lobes lobes)
{
    enum { COUNT = 2000 };
    static Direction pairs[COUNT][2];
    static float f[COUNT][4];
    const double beta[] = {8, 4, 16}, alpha[] = {-7.5, 3.75, 11.25};
    SectionParams params = make_fibre(0.6f);
    params.lobes = lobes;
    double color = linear_from_srgb(0.6f), worst = 0;
    for (int i = 0; i < COUNT; ++i)
        for (int k = 0; k < 2; ++k)
            set_direction(pairs[i][k], asin(1.98 * fmod(i * 0.618034 + k * 0.3, 1) - 0.99),
                          2 * PI * fmod(i * (k ? 0.754878 : 0.569840), 1));
    scatter(&params, COUNT, pairs, f);
    for (int i = 0; i < COUNT; ++i) {
        const float *l = pairs[i][0], *e = pairs[i][1];
        double theta_i = asin((double)l[1]), theta_r = asin((double)e[1]), n[LOBE_COUNT], sum = 0,
               scale = 0;
        double phi = atan2((double)l[2], (double)l[0]) - atan2((double)e[2], (double)e[0]);
        double theta_d = lobes == LOBES_ENERGY ? theta_r : (theta_r - theta_i) / 2;
        marschner_azimuthal(1.55, 12 * PI / 180, cos(theta_d), color, phi, 200, n);
        for (int p = 0; p < LOBE_COUNT; ++p) {
            double tilt = alpha[p] * PI / 180, width = beta[p] * PI / 180;
            double m = lobes == LOBES_ENERGY ? marschner_longitudinal(theta_i, theta_r, tilt, width)
                                             : marschner_gauss(theta_i, theta_r, tilt, width);
            sum += m * n[p];
            scale += m;
        }
        // Allowed: 1e-3 for the table, 6e-4 for the Bessel function, and float32's rounding in an
        // exponent of up to 1/v = 51.
        worst = fmax(worst, fabs((double)f[i][0] - sum) / (1e-3 * scale + 1e-3 * sum + 1e-5));
        if (worst > 1)
            fail_msg("theta %g -> %g, phi %g: %g instead of %g", theta_i, theta_r, phi,
                     (double)f[i][0], sum);
    }
    print_message("off by %.2g of the bound at most\n", worst);
    params_destroy_section(&params);
}

static void energy_lobes_are_the_reference(void **state)
{
    (void)state;
    compare_with_reference(LOBES_ENERGY);
}

static void gauss_lobes_are_the_reference(void **state)
{
    (void)state;
    compare_with_reference(LOBES_GAUSS);
}

enum { THETAS = 90, PHIS = 64 };
static Direction around[THETAS * PHIS][2];
static float from_around[THETAS * PHIS][4];

// Directions to the light all around, in cells of equal angles, with the eye at `theta`.
static void look_from(double theta)
{
    for (int i = 0; i < THETAS * PHIS; ++i) {
        set_direction(around[i][0], (i / PHIS + 0.5) * PI / THETAS - PI / 2,
                      (i % PHIS + 0.5) * 2 * PI / PHIS);
        set_direction(around[i][1], theta, 0);
    }
}

static double cell(int i)
{
    return cos((i / PHIS + 0.5) * PI / THETAS - PI / 2) * (PI / THETAS) * (2 * PI / PHIS);
}

// Under light of 1 from all directions, a fibre without pigment shows 1 from any side, for all
// roughnesses and tilts.
static void a_white_furnace_is_white(void **state)
{
    (void)state;
    const struct {
        float roughness, azimuthal, tilt, refraction;
    } fibres[] = {{8, 12, 7.5f, 1.55f}, {5, 8, 0, 1.55f}, {15, 30, 10, 1.4f}, {8, 12, 5, 1.8f}};
    double worst = 0;
    for (size_t m = 0; m < sizeof fibres / sizeof *fibres; ++m) {
        SectionParams params = make_fibre(1);
        params.roughness = fibres[m].roughness;
        params.azimuthal_roughness = fibres[m].azimuthal;
        params.cone_angle = fibres[m].tilt;
        params.refraction = fibres[m].refraction;
        for (double deg = -80; deg <= 80; deg += 20) {
            double sum = 0;
            look_from(deg * PI / 180);
            scatter(&params, THETAS * PHIS, around, from_around);
            for (int i = 0; i < THETAS * PHIS; ++i) sum += cell(i) * (double)from_around[i][0];
            worst = fmax(worst, fabs(sum - 1));
            if (fabs(sum - 1) > 0.01) fail_msg("fibre %zu at %g degrees shows %g", m, deg, sum);
        }
        params_destroy_section(&params);
    }
    print_message("off by %.2g at most\n", worst);
}

static void pigment_takes_light_away(void **state)
{
    (void)state;
    SectionParams params = make_fibre(0.5f);
    params.melanin = (AutoFloat){.value = 1.3f};
    double sum[3] = {0};
    look_from(0.3);
    scatter(&params, THETAS * PHIS, around, from_around);
    for (int i = 0; i < THETAS * PHIS; ++i)
        for (int k = 0; k < 3; ++k) sum[k] += cell(i) * (double)from_around[i][k];
    // F alone, the Fresnel reflection: 0.06
    assert_true(1 > sum[0] && sum[0] > sum[1] && sum[1] > sum[2] && sum[2] > 0.04);
    params_destroy_section(&params);
}

// S = f / cos(theta_i) is the same if the light goes the other way, with or without tilted scales.
// Rounding: angles err by 3e-7 (asin), and a Gaussian at 6 widths of 8 degrees multiplies that by
// 43. The table is read at azimuths that differ by the rounding of the cosine, at worst sqrt(2e-7)
// near 0.
static void light_goes_either_way_alike(void **state)
{
    (void)state;
    enum { COUNT = 4000 };
    static Direction pairs[COUNT][2];
    static float f[COUNT][4];
    SectionParams params = make_fibre(0.7f);
    params.lobes = LOBES_GAUSS;
    for (int i = 0; i < COUNT / 2; ++i) {
        for (int k = 0; k < 2; ++k)
            set_direction(pairs[2 * i][k], asin(1.98 * fmod(i * 0.618034 + k * 0.4, 1) - 0.99),
                          2 * PI * fmod(i * (k ? 0.754878 : 0.569840), 1));
        memcpy(pairs[2 * i + 1][0], pairs[2 * i][1], sizeof(Direction));
        memcpy(pairs[2 * i + 1][1], pairs[2 * i][0], sizeof(Direction));
    }
    scatter(&params, COUNT, pairs, f);
    for (int i = 0; i < COUNT / 2; ++i) {
        const float *in = pairs[2 * i][0], *out = pairs[2 * i][1];
        double there = (double)f[2 * i][0] / sqrt(1 - (double)in[1] * in[1]),
               back = (double)f[2 * i + 1][0] / sqrt(1 - (double)out[1] * out[1]);
        if (fabs(there - back) > 1e-4 * (there + back) + 1e-6)
            fail_msg("pair %d: %g there, %g back", i, there, back);
    }
    params_destroy_section(&params);
}

// Includes poles and equal and opposite directions, for little and much pigment.
static void no_direction_gives_nonsense(void **state)
{
    (void)state;
    enum { SIDES = 24, COUNT = (SIDES / 2 + 1) * SIDES };
    Direction directions[COUNT];
    static Direction pairs[COUNT * COUNT][2];
    static float f[COUNT * COUNT][4];
    for (int i = 0; i < COUNT; ++i)
        set_direction(directions[i], (i / SIDES) * 2 * PI / SIDES - PI / 2,
                      (i % SIDES) * 2 * PI / SIDES);
    for (int i = 0; i < COUNT * COUNT; ++i) {
        memcpy(pairs[i][0], directions[i / COUNT], sizeof(Direction));
        memcpy(pairs[i][1], directions[i % COUNT], sizeof(Direction));
    }
    const float colors[] = {0, 0, 0.5f, 0.5f, 1, 1};
    for (int c = 0; c < 6; ++c) {
        SectionParams params = make_fibre(colors[c]);
        params.lobes = c % 2 ? LOBES_GAUSS : LOBES_ENERGY;
        scatter(&params, COUNT * COUNT, pairs, f);
        for (int i = 0; i < COUNT * COUNT; ++i)
            for (int k = 0; k < 3; ++k)
                if (!(f[i][k] >= 0 && f[i][k] < 1e6))
                    fail_msg("colour %g, pair %d: %g", (double)colors[c], i, (double)f[i][k]);
        params_destroy_section(&params);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_table_is_the_quadrature),
        cmocka_unit_test(energy_lobes_are_the_reference),
        cmocka_unit_test(gauss_lobes_are_the_reference),
        cmocka_unit_test(a_white_furnace_is_white),
        cmocka_unit_test(pigment_takes_light_away),
        cmocka_unit_test(light_goes_either_way_alike),
        cmocka_unit_test(no_direction_gives_nonsense),
    };
    return cmocka_run_group_tests(tests, open_gpu, close_gpu);
}
