// SPDX-License-Identifier: MIT
// The strand that is drawn: rebuilt from the root, every direction turned by a share of the angle
// from the physical one to the style's.
//   MIX 0: the style alone
//   MIX 1: the physical strand alone
//   MIX 2: nearer to the physical strand
//   MIX 3: nearer to the style
//   MIX 4: by a share that differs along the strand
// HANGS 1: at rest the physical strand hangs straight down, along `hanging`, and the style is what
// is drawn. So the style's segment is turned by the rotation that takes `hanging` to what is a
// share of the way from there to the physical segment.
#include "sim/pose_params.h"
#include "common/hair_address.glsl"
#include "common/rigid.glsl"

layout(local_size_x = GROUP_SIZE) in;
#include "common/lane.glsl"
layout(binding = BIND_REST) uniform samplerBuffer rest;
layout(binding = BIND_STATE) uniform samplerBuffer segments; // unit direction, rest length
layout(std430, binding = BIND_POSITION_OUT) writeonly buffer Positions { vec4 positions[]; };

// The polynomials of a turn. Uniforms cost a load wherever they are named, so they are read once,
// into this.
struct Turn {
    vec4 cos_low, cos_high, sin_low, sin_high;
};

float polynomial(vec4 low, vec4 high, float x)
{
    float a = low.x + x * low.y, b = low.z + x * low.w, c = high.x + x * high.y,
          d = high.z + x * high.w, xx = x * x;
    return a + xx * b + xx * xx * (c + xx * d);
}

// Slerp from the unit vector a towards the unit vector b by a share w <= 1/2 of their angle. With
// the bisector h this is a turn towards h by v = 2w of the half angle p <= 90 deg: cos(v p) a +
// sin(v p)/sin(p) (h - cos(p) a). Both factors are smooth functions of x = sin^2(p/2) <= 1/2, given
// as polynomials, so that no angle is needed. Antiparallel vectors have no bisector: a stays. Where
// the sum is short, what rounding leaves of it is not quite across, and the result not quite of
// length 1.
vec3 turn(vec3 a, vec3 b, Turn by)
{
    vec3 sum = a + b;
    float ss = dot(sum, sum);
    float inverse = inversesqrt(max(ss, 1e-12));
    float cos_p = 0.5 * ss * inverse;
    float x = 0.5 - 0.5 * cos_p;
    vec3 turned = polynomial(by.cos_low, by.cos_high, x) * a +
                  polynomial(by.sin_low, by.sin_high, x) * (sum * inverse - cos_p * a);
    turned *= ss < 1e-2 ? inversesqrt(dot(turned, turned)) : 1.0;
    return ss > 1e-12 ? turned : a;
}

// The same, but that a result which would flip to the other side as b passes -a fades to a there:
// |a + b|^2 = 2 + 2 cos, 0.27 at 150 degrees.
vec3 turn_fading(vec3 a, vec3 b, Turn by)
{
    vec3 kept = mix(a, turn(a, b, by), smoothstep(0.0, 0.27, 2.0 + 2.0 * dot(a, b)));
    return kept * inversesqrt(max(dot(kept, kept), 1e-12));
}

#if HANGS && MIX >= 2
// turn_between, of unit length also where a and b point nearly the opposite way, and rounding
// decides about which axis; x where it leaves none.
vec3 swing(vec3 a, vec3 b, vec3 x)
{
    vec3 turned = turn_between(a, b, x);
    float square = dot(turned, turned);
    if (dot(a, b) > -0.9) return turned;
    return square > 1e-4 ? turned * inversesqrt(square) : x;
}
#endif

#if MIX == 4
layout(binding = BIND_ALONG) uniform samplerBuffer along_strand; // solver_split.c

// From the unit vector a towards the unit vector b by a share w of their angle. With HANGS it
// fades to the nearer one where they point nearly the opposite way, as turn_fading does.
vec3 slerp(vec3 a, vec3 b, float w)
{
    float cosine = clamp(dot(a, b), -1.0, 1.0), angle = acos(cosine),
          sine = sqrt(max(1.0 - cosine * cosine, 0.0));
    vec3 turned =
        sine > 1e-4 ? (sin((1.0 - w) * angle) * a + sin(w * angle) * b) / sine : mix(a, b, w);
#if HANGS
    turned = mix(w < 0.5 ? a : b, turned, smoothstep(0.0, 0.27, 2.0 + 2.0 * cosine));
#endif
    return turned * inversesqrt(max(dot(turned, turned), 1e-12));
}
#endif

void main()
{
    int s = lane_index(), n = int(pose_params.vertex_count);
    if (s >= int(pose_params.strand_count)) return;
    int first = particle_address(s, 0, n);
    vec4 root = texelFetch(rest, first), rotation = pose_params.head_rotation;
    Turn by = Turn(pose_params.turn_cos[0], pose_params.turn_cos[1], pose_params.turn_sin[0],
                   pose_params.turn_sin[1]);

    vec3 x = rotate(rotation, root.xyz) + pose_params.head_translation.xyz;
    positions[first] = vec4(x, 1.0);
    for (int j = 1; j < n; ++j) {
        int a = first + j * STRAND_TILE;
#if MIX == 1
        vec4 segment = texelFetch(segments, a);
        vec3 d = segment.xyz;
#else
        vec4 segment = texelFetch(rest, a);
        vec3 d = rotate(rotation, segment.xyz);
#if MIX == 4
        vec3 start = HANGS == 1 ? pose_params.hanging.xyz : d;
        vec3 swung = slerp(start, texelFetch(segments, a).xyz,
                           1.0 - texelFetch(along_strand, 2 * (j - int(pose_params.lead))).x);
#if HANGS
        swung = swing(start, swung, d);
#endif
        d = j > int(pose_params.lead) ? swung : d;
#elif HANGS && MIX >= 2
        vec3 hanging = pose_params.hanging.xyz, physical = texelFetch(segments, a).xyz;
#if MIX == 2
        vec3 swung = turn_fading(physical, hanging, by);
#else
        vec3 swung = turn_fading(hanging, physical, by);
#endif
        d = j > int(pose_params.lead) ? swing(hanging, swung, d) : d;
#elif MIX == 2
        d = turn(texelFetch(segments, a).xyz, d, by);
#elif MIX == 3
        d = turn(d, texelFetch(segments, a).xyz, by);
#endif
#endif
        x += segment.w * d;
        positions[a] = vec4(x, 1.0);
    }
}
