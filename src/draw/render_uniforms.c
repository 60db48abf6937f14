// SPDX-License-Identifier: MIT
#include "draw/render_uniforms.h"

#include "strands/paint.h"

#include "glsl/common/shared_math.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

_Static_assert(MAX_LIGHTS == SCENE_MAX_LIGHTS, "one limit");

void linear_from_srgb_color(const float srgb[3], float linear[3])
{
    for (int k = 0; k < 3; ++k) linear[k] = linear_from_srgb(srgb[k]);
}

void draw_params_set_view(DrawParams *draw, const View *view, int width, int height)
{
    mat4 projection = {0}, from_world = {0};
    memcpy(projection, view->projection, sizeof projection);
    memcpy(from_world, view->view, sizeof from_world);
    projection[1][1] = -projection[1][1]; // the picture's first row is its top
    glm_mat4_mul(projection, from_world, draw->clip_from_world);
    memcpy(draw->eye, view->eye, sizeof(vec3));
    draw->width = (float)width;
    draw->height = (float)height;
    draw->band[0] = (uint32_t)width;
    draw->focal = 0.5f * draw->height * view->projection[1][1];
    draw->near_distance = view->near_distance;
    // Clip z = z22 z + z32 with the distance before the eye w = -z.
    draw->depth[0] = -view->projection[2][2];
    draw->depth[1] = view->projection[3][2];
}

// t = clamp((cos a - cos outer) / (cos inner - cos outer), 0, 1) with a the angle off the axis; the
// shader knows the cosine off the way to the light, which is -cos a. Everything is inside for y =
// 0.
static void set_cone(const Light *light, float cone[4])
{
    cone[0] = 1;
    if (light->kind != LIGHT_SPOT) return;
    float outer = cosf(glm_rad(light->outer_deg)), inner = cosf(glm_rad(light->inner_deg));
    cone[1] = 1 / fmaxf(inner - outer, 1e-6f);
    cone[0] = -outer * cone[1];
}

void draw_params_set_lights(DrawParams *draw, const Light *lights, uint32_t count)
{
    assert(count <= MAX_LIGHTS);
    draw->light_count = (int)count;
    for (uint32_t i = 0; i < count; ++i) {
        const Light *light = &lights[i];
        bool far = light->kind == LIGHT_DIRECTIONAL;
        for (int k = 0; k < 3; ++k) {
            draw->light_place[i][k] = far ? light->direction[k] : light->position[k];
            draw->light_color[i][k] = light->intensity * light->color[k];
            draw->light_axis[i][k] = far ? 0 : light->direction[k];
        }
        draw->light_place[i][3] = !far;
        draw->light_axis[i][3] = light->distance * light->distance;
        set_cone(light, draw->light_cone[i]);
    }
}

// beta and alpha are of theta_h = (theta_i + theta_r) / 2: the lobe in theta_r is twice as wide and
// tilted by twice as much. Scales tilt R to the root; TT and TRT follow from R (Marschner et al.
// 2003, table 1).
static void set_lobes(const SectionParams *params, MaterialParams *material)
{
    static const float WIDTH[] = {1, 0.5f, 2}, TILT[] = {-1, 0.5f, 1.5f};
    for (int p = 0; p < 3; ++p) {
        float width = 2 * WIDTH[p] * glm_rad(params->roughness), v = width * width,
              tilt = 2 * TILT[p] * glm_rad(params->cone_angle);
        material->lobe_sharpness[p] = 1 / v;
        material->lobe_scale[p] = 1 / (v * (1 - expf(-2 / v)));
        material->lobe_tilt_cos[p] = cosf(tilt);
        material->lobe_tilt_sin[p] = sinf(tilt);
    }
}

MaterialParams material_params(const SectionParams *params, float radius)
{
    float cone = glm_rad(params->cone_angle);
    MaterialParams material = {
        .color_variation = params->color_variation,
        .warmth_variation = params->warmth_variation,
        .radius = radius,
        .tip_ratio = params->tip_ratio,
        .opacity = params->opacity,
        .shadow_opacity = params->shadow_opacity,
        .smooth_parts = (uint)params->smooth,
        .smooth_curve = (uint)params->curve,
        .ambient = params->ambient,
        .diffuse = params->diffuse,
        .specular1 = params->specular1,
        .exponent1 = params->exponent1,
        .specular2 = params->specular2,
        .exponent2 = params->exponent2,
        .shift1_cos = cosf(2 * cone),
        .shift1_sin = sinf(2 * cone),
        .shift2_cos = cosf(-3 * cone),
        .shift2_sin = sinf(-3 * cone),
    };
    paint_color(params, material.color);
    set_lobes(params, &material);
    return material;
}
