// SPDX-License-Identifier: MIT
// The hair on straight ways through the light grid (needs light.glsl and the buffers of slots,
// state and depth): light_grid_behind in C.

float behind(ivec3 place, vec3 way, int ordinate, int first, float most)
{
    vec3 middle = vec3(place) + 0.5;
    float main = max(max(max(abs(way.x), abs(way.y)), abs(way.z)), 1e-6), far = length(way) / main,
          sum = 0.0;
    for (int k = first; float(k) < main && sum <= most; ++k) {
        ivec3 at = ivec3(floor(middle + float(k) * way / main));
        if (!cell_inside(at)) break;
        int slot = slots[cell_address(at)];
        if (slot >= 0 && slot < int(state.filled))
            sum += (k > 0 ? 1.0 : 0.5) * far * depth[slot * LIGHT_ORDINATES + ordinate];
    }
    return sum;
}
