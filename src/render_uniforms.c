// SPDX-License-Identifier: MIT
#include "render_uniforms.h"

#include <assert.h>
#include <math.h>
#include <string.h>

_Static_assert(MAX_LIGHTS == SCENE_MAX_LIGHTS, "one limit");

float linear_from_srgb(float value)
{
    return value <= 0.04045f ? value / 12.92f : powf((value + 0.055f) / 1.055f, 2.4f);
}

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

void draw_params_set_lights(DrawParams *draw, const Light *lights, uint32_t count)
{
    assert(count <= MAX_LIGHTS);
    draw->light_count = (int)count;
    for (uint32_t i = 0; i < count; ++i)
        for (int k = 0; k < 3; ++k) {
            draw->light_direction[i][k] = lights[i].direction[k];
            draw->light_color[i][k] = lights[i].intensity * lights[i].color[k];
        }
}

MaterialParams material_params(const SectionParams *params, float radius)
{
    float cone = glm_rad(params->cone_angle);
    MaterialParams material = {
        .color_variation = params->color_variation,
        .radius = radius,
        .tip_ratio = params->tip_ratio,
        .opacity = params->opacity,
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
    linear_from_srgb_color(params->color, material.color);
    return material;
}
