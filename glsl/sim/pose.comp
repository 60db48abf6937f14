// SPDX-License-Identifier: MIT
// The strand that is drawn. It is rebuilt from the root; every direction is turned from the
// simulated direction towards the style's, by a share of the angle between them.
//   MIX 0: the style alone
//   MIX 1: the simulated strand alone
//   MIX 2: both, nearer to the simulated strand
//   MIX 3: both, nearer to the style
//   MIX 4: by a share that differs along the strand
// HANGS 1: at rest the simulated strand hangs straight down, along `hanging`, and the style is
// drawn. In motion, take the direction at a share of the way from `hanging` to the simulated
// segment; the rotation from `hanging` to that direction turns the style's segment.
// FADES 1 (with MIX 4): as the style changes over time, it holds less of gravity, and the
// simulated strand is drawn instead.
// BOUND 1: the mesh carries each strand in a frame of its own; `hanging` is a direction in that
// frame.
#include "sim/pose_params.h"
#include "common/hair_address.glsl"
#include "common/rigid.glsl"
#include "sim/relative.glsl"

layout(local_size_x = GROUP_SIZE) in;
#include "common/lane.glsl"
layout(binding = BIND_REST) uniform samplerBuffer rest;
#if BOUND
layout(binding = BIND_FRAMES) uniform samplerBuffer frames; // see shared.h
#endif
layout(binding = BIND_STATE) uniform samplerBuffer segments; // unit direction, rest length
layout(std430, binding = BIND_POSITION_OUT) writeonly buffer Positions { vec4 positions[]; };

// The polynomials of a turn. A uniform costs a load at each use, so they are read once into this
// struct.
struct Turn {
    vec4 cos_low, cos_high, sin_low, sin_high;
};

float polynomial(vec4 low, vec4 high, float x)
{
    float a = low.x + x * low.y, b = low.z + x * low.w, c = high.x + x * high.y,
          d = high.z + x * high.w, xx = x * x;
    return a + xx * b + xx * xx * (c + xx * d);
}

// Slerp from the unit vector a towards the unit vector b by a share w <= 1/2 of the angle between
// them. With the bisector h this turns a towards h by v = 2w of the half angle p <= 90 deg: cos(v
// p) a + sin(v p)/sin(p) (h - cos(p) a). Both factors are smooth functions of x = sin^2(p/2) <= 1/2
// and evaluated as polynomials, so no angle is needed. Antiparallel vectors have no bisector; then
// a stays. If the sum a + b is short, rounding makes h not quite perpendicular to a - b, and the
// result is not quite a unit vector.
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

#if MIX == 4
layout(binding = BIND_ALONG) uniform samplerBuffer along_strand; // solver_split.c

// From the unit vector a towards the unit vector b by a share w of the angle between them.
vec3 slerp(vec3 a, vec3 b, float w)
{
    float cosine = clamp(dot(a, b), -1.0, 1.0), angle = acos(cosine),
          sine = sqrt(max(1.0 - cosine * cosine, 0.0));
    vec3 turned =
        sine > 1e-4 ? (sin((1.0 - w) * angle) * a + sin(w * angle) * b) / sine : mix(a, b, w);
    return turned * inversesqrt(max(dot(turned, turned), 1e-12));
}
#endif

#if HANGS && MIX >= 2
// sin(v p) / sin(p) and cos(v p) for `cosine` = cos(p), p <= 90 deg.
vec2 share_of_turn(float cosine, Turn by, float v)
{
#if MIX == 4
    float angle = acos(cosine), sine = sqrt(max(1.0 - cosine * cosine, 0.0));
    return vec2(sine > 1e-4 ? sin(v * angle) / sine : v, cos(v * angle));
#else
    float x = 0.5 - 0.5 * cosine;
    return vec2(polynomial(by.sin_low, by.sin_high, x), polynomial(by.cos_low, by.cos_high, x));
#endif
}

// Rotates x about h x b by a share v of the angle from the unit vector h to the unit vector b. With
// half that angle, p, the rotation is the quaternion (sin(v p) axis, cos(v p)), axis = h x b / (2
// sin(p) cos(p)). When b passes -h, the axis flips. So from 150 degrees on, where 4 cos^2(p) is
// 0.27, v fades to the nearer of 0 and 1: the quaternion becomes (0, 1) or (sin(p) axis, cos(p)).
// The quaternion need not be a unit: the rotation is divided by its square.
vec3 turn_along(vec3 x, vec3 h, vec3 b, Turn by, float v)
{
    float square = clamp(0.5 + 0.5 * dot(h, b), 0.0, 1.0), cosine = sqrt(square),
          near = min(square * (4.0 / 0.27), 1.0);
    vec2 far = v < 0.5 ? vec2(0.0, 1.0) : vec2(1.0, cosine),
         turn = mix(far, share_of_turn(cosine, by, v), near * near * (3.0 - 2.0 * near));
    vec3 s = cross(h, b) * (0.5 * turn.x / max(cosine, 1e-6)), t = cross(s, x);
    return x + (turn.y * t + cross(s, t)) * (2.0 / max(dot(s, s) + turn.y * turn.y, 1e-12));
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

    vec3 translation = pose_params.head_translation.xyz, hanging = pose_params.hanging.xyz;
#if BOUND
    vec4 own = texelFetch(frames, 4 * s + 2);
    translation += rotate(rotation, texelFetch(frames, 4 * s + 3).xyz);
    rotation = product(rotation, own);
    hanging = rotate(rotation, hanging);
#endif
    Root at = relative_root(rotate(rotation, root.xyz) + translation, root.w);
    vec3 x = vec3(0.0);
    // A matrix rotates a vector with half as many operations as a quaternion.
    mat3 head = mat3(rotate(rotation, vec3(1.0, 0.0, 0.0)), rotate(rotation, vec3(0.0, 1.0, 0.0)),
                     rotate(rotation, vec3(0.0, 0.0, 1.0)));
    positions[first] = vec4(at.at, 0.0);
    for (int j = 1; j < n; ++j) {
        int a = first + j * STRAND_TILE;
#if MIX == 1
        vec4 segment = texelFetch(segments, a);
        vec3 d = segment.xyz;
#else
        vec4 segment = texelFetch(rest, a);
        vec3 d = head * segment.xyz;
#if MIX >= 2
        vec3 physical = texelFetch(segments, a).xyz;
#if MIX == 4
        float share = 1.0 - texelFetch(along_strand, 2 * (j - int(pose_params.lead))).x;
#else
        // The side that is nearer; `by` holds the other share.
        const float share = MIX == 2 ? 1.0 : 0.0;
#endif
#if HANGS
        vec3 turned = turn_along(d, hanging, physical, by, share);
#if FADES
        turned = slerp(physical, turned, pose_params.held);
#endif
#elif MIX == 4
        vec3 turned = slerp(d, physical, share);
#elif MIX == 2
        vec3 turned = turn(physical, d, by);
#else
        vec3 turned = turn(d, physical, by);
#endif
        d = j > int(pose_params.lead) ? turned : d;
#endif
#endif
        x += segment.w * d;
#if MIX == 0
        positions[a] = relative_store(x, at); // particles start there
#else
        positions[a] = vec4(at.at + x, 0.0);
#endif
    }
}
