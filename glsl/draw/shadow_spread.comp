// SPDX-License-Identifier: MIT
// The depth at which the layers of each texel begin: a smooth lower bound of the first depths. It
// is the minimum of 3 x 3 texels of the coarse map, interpolated between texels. No hair lies in
// front of it, because a texel lies among four coarse texels whose 3 x 3 squares all contain its
// own coarse texel. A lane processes the texels among four coarse texels.
#include "draw/shadow.h"

layout(local_size_x = GROUP_SIZE) in;
#include "common/lane.glsl"
layout(location = 0) uniform ivec2 map; // side, number
layout(binding = BIND_FIRST) uniform usamplerBuffer first;
layout(std430, binding = BIND_DEPTHS_OUT) writeonly buffer Depths { float depths[]; };

int side = map.x, coarse = map.x / SHADOW_COARSE;

float first_at(ivec2 texel)
{
    texel = clamp(texel, ivec2(0), ivec2(coarse - 1));
    return float(int(min(texelFetch(first, map.y * coarse * coarse + texel.y * coarse + texel.x).x,
                         uint(SHADOW_DEPTHS)))) *
           (1.0 / float(SHADOW_DEPTHS));
}

void main()
{
    int at = lane_index();
    // The lower left of the four coarse texels.
    ivec2 corner = ivec2(at % (coarse + 1), at / (coarse + 1)) - 1;
    if (corner.y >= coarse) return;
    float least[4] = float[4](1.0, 1.0, 1.0, 1.0);
    for (int y = -1; y <= 2; ++y)
        for (int x = -1; x <= 2; ++x) {
            float depth = first_at(corner + ivec2(x, y));
            if (x < 2 && y < 2) least[0] = min(least[0], depth);
            if (x > -1 && y < 2) least[1] = min(least[1], depth);
            if (x < 2 && y > -1) least[2] = min(least[2], depth);
            if (x > -1 && y > -1) least[3] = min(least[3], depth);
        }
    ivec2 low = corner * SHADOW_COARSE + SHADOW_COARSE / 2;
    for (int y = 0; y < SHADOW_COARSE; ++y)
        for (int x = 0; x < SHADOW_COARSE; ++x) {
            ivec2 texel = low + ivec2(x, y);
            vec2 share = (vec2(x, y) + 0.5) * (1.0 / float(SHADOW_COARSE));
            bool inside = texel == clamp(texel, ivec2(0), ivec2(side - 1));
            if (inside)
                depths[(map.y * side + texel.y) * side + texel.x] = mix(
                    mix(least[0], least[1], share.x), mix(least[2], least[3], share.x), share.y);
        }
}
