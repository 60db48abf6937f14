// SPDX-License-Identifier: MIT
#include "lanes/shadow_light.h"

#include "lanes/shadow_tile.h"

// As light_through_hair of shadow.glsl finds it.
typedef struct Search {
    const ShadowMap *shadow;
    const CastParams *params;
    const MappedCaster *caster;
    const uint32_t *layers; // [LAYERS][side][side]
    float across, *left, *behind;
    float last; // LAYER_END: a bound that compilers know makes them jump
} Search;

SIMD_INLINE float mix4(float a, float b, float c, float d, float u, float v)
{
    float above = a + u * (b - a), below = c + u * (d - c);
    return above + v * (below - above);
}

// Where a tile's particles look: the texel before them, what they are beyond it, and their layer.
typedef struct Looks {
    float u[W], v[W], share[W];
    int texel[W], layer[W];
} Looks;

SIMD_INLINE void find_looks(const Search *search, const Places *places, Looks *looks)
{
    const float *depths = search->shadow->depths;
    int side = search->shadow->side;
    float edge = (float)side - 1.01f, last = search->last, begin[W];
    for (int k = 0; k < W; ++k) {
        float u = simd_min(simd_max(places->u[k] - 0.5f, 0), edge),
              v = simd_min(simd_max(places->v[k] - 0.5f, 0), edge);
        looks->texel[k] = (int)v * side + (int)u;
        looks->u[k] = u - (float)(int)u;
        looks->v[k] = v - (float)(int)v;
    }
    for (int k = 0; k < W; ++k) {
        int at = looks->texel[k], below = at + side;
        begin[k] = mix4(depths[at], depths[at + 1], depths[below], depths[below + 1], looks->u[k],
                        looks->v[k]);
    }
    for (int k = 0; k < W; ++k) {
        float root = sqrtf(simd_positive(places->z[k] - begin[k])),
              layer = simd_min((float)LAYERS * root, last);
        looks->layer[k] = (int)layer;
        looks->share[k] = layer - (float)(int)layer;
    }
}

// Of all fibres along the light's way those that are not before the point, nor its own.
SIMD_INLINE void find_behind(const Search *search, const Tile *tile, const Places *places,
                             const Looks *looks, const float before[W], float *behind)
{
    const uint32_t *last = search->layers + (size_t)(LAYERS - 1) * (size_t)search->shadow->side *
                                                (size_t)search->shadow->side;
    int side = search->shadow->side;
    for (int k = 0; k < W; ++k) {
        int at = looks->texel[k], below = at + side;
        float all = mix4(layer_depth(last[at], 1), layer_depth(last[at + 1], 1),
                         layer_depth(last[below], 1), layer_depth(last[below + 1], 1), looks->u[k],
                         looks->v[k]);
        float own = own_layer_depth(2 * places->radius[k] * search->across, tile->opacity[k], 1);
        behind[k] = simd_positive(all - own - simd_positive(before[k]));
    }
}

SIMD_INLINE void find_lights(const Search *search, const Tile *tile, const Places *places,
                             float *left, float *behind)
{
    const uint32_t *layers = search->layers;
    int side = search->shadow->side, squares = side * side;
    float sum[W], most = (float)side;
    Looks looks;
    find_looks(search, places, &looks);
    for (int k = 0; k < W; ++k) {
        int at = looks.texel[k] + looks.layer[k] * squares, below = at + side;
        float share = looks.share[k];
        sum[k] = mix4(layer_depth(layers[at], share), layer_depth(layers[at + 1], share),
                      layer_depth(layers[below], share), layer_depth(layers[below + 1], share),
                      looks.u[k], looks.v[k]);
    }
    for (int k = 0; k < W; ++k)
        sum[k] -= own_layer_depth(2 * places->radius[k] * search->across, tile->opacity[k],
                                  looks.share[k]);
    // Beside the map no hair stands in the light, nor behind a lamp.
    for (int k = 0; k < W; ++k) {
        bool inside = (places->u[k] >= 0) & (places->v[k] >= 0) & (places->u[k] <= most) &
                      (places->v[k] <= most);
        sum[k] *= inside ? 1.f : 0.f;
    }
    if (behind) find_behind(search, tile, places, &looks, sum, behind);
    for (int k = 0; k < W; ++k) left[k] = simd_exp2(-(float)LOG2E * simd_positive(sum[k]));
}

SIMD_INLINE void find_light(const Search *search, int part)
{
    const MappedCaster *caster = search->caster;
    Places places;
    int range[2];
    find_range(caster, part, search->shadow->parts, range);
    for (int t = range[0]; t < range[1]; ++t) {
        Tile tile = open_tile(caster, t);
        for (int j = 0; j < mapped_caster_points(caster); ++j) {
            find_places(search->params, &tile, j, &places);
            size_t at = (tile.number * (size_t)mapped_caster_points(caster) + (size_t)j) * W;
            find_lights(search, &tile, &places, search->left + at,
                        search->behind ? search->behind + at : NULL);
        }
    }
}

SIMD_STAGE(find_light, Search)

void shadow_light_find(ShadowMap *shadow, const CastParams *params, const MappedCaster *caster,
                       float across, const uint32_t *layers, float *left, float *behind)
{
    Search search = {.shadow = shadow,
                     .params = params,
                     .caster = caster,
                     .layers = layers,
                     .across = across,
                     .left = left,
                     .behind = behind,
                     .last = LAYER_END};
    run_find_light(&search, shadow->parts);
}
