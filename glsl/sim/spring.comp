// SPDX-License-Identifier: MIT
// Mass-spring strand: particles of mass 1, coil springs along the links, angular springs across
// them.
//
// A link r = x_j - x_{j-1} = m u (m = |r|) with rest length l exerts on the particle at its end
// the force F, and on the particle before it -F:
//     F = -k/2 (m - l) u + b theta e
// theta is the angle from u to the style's direction t; e is perpendicular to u, towards t. The
// first term is Hooke's law with half the coil's force for either end; the second is the same for
// the angle. Springs in a row: K = k/(n-1)^2 is the stiffness of a strand of n - 1 links, and B =
// b/(n-1) the stiffness against its weight, so K and B mean the same for any n. b <= k l/8: a
// short link must not be stiffer across than along.
//
// IMPLICIT 0, symplectic Euler: v' = e^{-ch} v + (g + c w + F_j - F_{j+1}) h f (forces.glsl), then
// r' = r + h (v'_j - v'_{j-1}). Nothing damps it, so F must have a potential, and the potential
// must be smooth on the scale of a link's move in a sub-step. F above has neither property. A link
// that stretches and shrinks at different angles extracts work from the angular force again and
// again. Near m = 0 the coil's force changes its direction with u, and at theta = pi the angular
// force does. Therefore, with e = SHORT L/(n-1), l' = max(l, e) and phi = theta^2/2,
//     U = k/4 (M - l')^2 + b' m^2/(m^2 + e^2) phi,
//     M^2 = m^2 + l'^2 - l^2,    b' = min(b, k l^3/8/(l^2 + e^2)) (l^2 + e^2)/l
//     F = -dU/dr = -k/2 (1 - l'/M) r - 2 b' phi m e^2/(m^2 + e^2)^2 u + b' phi' m/(m^2 + e^2) e
// This equals the F above at m = l, with three exceptions: the second term (at m = l it is b
// theta^2 e^2/(l^2 + e^2), 0.06 b theta^2 in an average link); links shorter than e, which are
// softer; and angles above 135 degrees, where phi' = 3 (pi - theta). No derivative of the coil's
// part exceeds k/2.
//
// IMPLICIT 1, backward Euler, linearised at the step's start (Baraff, Witkin: Large Steps in Cloth
// Simulation, SIGGRAPH 1998), so that rest states are exact at any step. Without springs the
// particles would fly at v* (forces.glsl), and the link would become r + w, w = h (v*_j -
// v*_{j-1}). The stiffness matrices are H = h^2 f (k/2 u u^T + (k/2 |1 - l/m| + b/l) (1 - u u^T))
// = q + sigma u u^T. The particles are displaced from their free flight by x, with x_0 = 0:
//     x_j + H_j (x_j - x_{j-1}) - H_{j+1} (x_{j+1} - x_j) = z_j - z_{j+1},    z = h^2 f F(r) - H w
// (Across a link shorter than l the coil's stiffness k/2 (1 - l/m) is negative. Its absolute
// value, at most k/2, keeps the matrix positive.) Eliminate from the tip on: x_j = S^{-1} (z + d +
// H x_{j-1}), S = M + H. M and d describe how the part beyond the link acts on its end; M = 1, d =
// 0 at the tip, and then
//     M <- 1 + M S^{-1} H,    d <- d - M S^{-1} (z + d)
// With A = M + q, g = A^{-1} u, a = M g and tau = sigma/(1 + sigma u.g), the Sherman-Morrison
// formula gives forms without cancellation for stiff springs: M S^{-1} H = q M A^{-1} + tau a a^T,
// M S^{-1} u = a/(1 + sigma u.g), M S^{-1} y = M A^{-1} y - tau a (g.y). S^{-1} is the same
// without the M, with g for a. So x_j = C x_{j-1} + S^{-1} (z + d), C = q A^{-1} + tau g a^T.
#include "common/shared_math.h"
#include "sim/particles.glsl"
#include "sim/spring_params.h"
#include "sim/stretch.glsl"

const float SHORT = 0.25;   // in average links; solver_spring.c uses it, too
const float STIFFEST = 1e9; // h^2 f k/2 above which float32 cannot tell a spring from a rigid link

struct Springs {
    float k, b; // of a link, 1/s^2 and m/s^2
};

Springs springs_of(int links)
{
    return Springs(spring_params.coil * float(links) * float(links),
                   spring_params.angular * float(links));
}

// The angular spring of link j, divided by the mean.
float angular_at(int j)
{
#if VARIES
    return own_along(j).x;
#else
    return 1.0;
#endif
}

// The angular spring's force on a link of direction u. It is 0 if u is opposite to the style's
// direction t.
vec3 angular_force(vec3 u, vec3 t, float b)
{
    float cosine = dot(u, t);
    vec3 across = t - cosine * u;
    float sine = sqrt(dot(across, across));
    float ratio = sine > 1e-6 ? atan(sine, cosine) / sine : (cosine > 0.0 ? 1.0 : 0.0);
    return b * ratio * across;
}

// The direction of the link r; that of the style if r has no length.
vec3 direction_of(vec3 r, vec3 t, out float m)
{
    float rr = dot(r, r), inverse = inversesqrt(max(rr, 1e-36));
    m = rr * inverse;
    return rr > 1e-36 ? r * inverse : t;
}

#if IMPLICIT
// Per particle: the rows of C, each with a component of S^{-1} (z + d).
layout(std430, binding = BIND_SCRATCH) buffer Scratch { vec4 scratch[]; };

mat3 inverse_of_symmetric(mat3 m)
{
    vec3 x = cross(m[1], m[2]), y = cross(m[2], m[0]), z = cross(m[0], m[1]);
    return mat3(x, y, z) * (1.0 / dot(m[0], x));
}

// From tip to root: stores C and S^{-1} (z + d) of each link.
void eliminate(int base, int n, vec3 wind, vec3 root_velocity, Root root_old)
{
    vec4 rotation = frame_rotation;
    float dt = step_params.dt, acts = dt * step_params.gain;
    Springs springs = springs_of(n - 1);
    float p = min(0.5 * acts * springs.k, STIFFEST), angular = acts * springs.b;
    mat3 M = mat3(1.0);
    vec3 d = vec3(0.0);
    int at = base + (n - 1) * STRAND_TILE;
    vec3 drawn = relative_fetch(position_before(at), root_old);
    vec4 v = velocity_before(at);
    vec3 flying = kick_at(n - 1, v.xyz, wind);
    for (int j = n - 1; j > 0; --j, at -= STRAND_TILE) {
        vec4 style = texelFetch(rest, at), v_before = velocity_before(at - STRAND_TILE);
        vec3 drawn_before =
            j == 1 ? vec3(0.0) : relative_fetch(position_before(at - STRAND_TILE), root_old);
        vec3 flying_before = j == 1 ? root_velocity : kick_at(j - 1, v_before.xyz, wind);
        float l = style.w, m, b = min(angular * angular_at(j), 0.25 * p * l);
        vec3 r = link_before(drawn_before, drawn, l, v.w), flown = dt * (flying - flying_before);
        vec3 t = rotate(rotation, style.xyz), u = direction_of(r, t, m);

        float q = p * min(abs(1.0 - l / max(m, 1e-18)), 1.0) + b / l, sigma = p - q;
        vec3 y = d + angular_force(u, t, b) - q * flown; // z + d without the coil's part
        float coil = p * (l - m) - sigma * dot(u, flown);
        mat3 inverse_A = inverse_of_symmetric(M + mat3(q));
        vec3 g = inverse_A * u, Ay = inverse_A * y, a = M * g;
        float share = 1.0 / (1.0 + sigma * dot(u, g)), tau = sigma * share;
        float gy = tau * dot(g, y);
        vec3 e = (coil * share - gy) * g + Ay;
        mat3 C = q * inverse_A + outerProduct(tau * g, a);
        scratch[3 * at] = vec4(C[0].x, C[1].x, C[2].x, e.x);
        scratch[3 * at + 1] = vec4(C[0].y, C[1].y, C[2].y, e.y);
        scratch[3 * at + 2] = vec4(C[0].z, C[1].z, C[2].z, e.z);

        d -= (coil * share - gy) * a + M * Ay;
        M = mat3(1.0) + q * (M * inverse_A) + outerProduct(tau * a, a);
        drawn = drawn_before;
        v = v_before;
        flying = flying_before;
    }
}

// From root to tip: displacements, new links and velocities.
void substitute(int base, int n, vec3 wind, vec3 root_velocity, Root root_old, Root root)
{
    float dt = step_params.dt, per_second = 1.0 / step_params.dt;
    vec3 drawn_before = vec3(0.0), flying_before = root_velocity, x_before = vec3(0.0);
    vec3 drawn = vec3(0.0),
         along = rotate(frame_rotation, texelFetch(rest, base + STRAND_TILE).xyz);
    carry_lead(base);
    positions[base] = vec4(root.at, 0.0);
    for (int j = 1; j < n; ++j) {
        int a = base + j * STRAND_TILE;
        vec3 was = relative_fetch(position_before(a), root_old);
        vec4 v = velocity_before(a);
        float l = texelFetch(rest, a).w;
        vec3 flying = kick_at(j, v.xyz, wind);
        vec3 s = link_before(drawn_before, was, l, v.w) + dt * (flying - flying_before);
        vec4 before = vec4(x_before, 1.0);
        vec3 x = vec3(dot(scratch[3 * a], before), dot(scratch[3 * a + 1], before),
                      dot(scratch[3 * a + 2], before));
        draw_link(a, root, s + (x - x_before), l, flying + per_second * x,
                  spring_params.stretch_drawn != 0u, drawn, along);
        drawn_before = was;
        flying_before = flying;
        x_before = x;
    }
}

// Two dispatches keep the longest strands below the limit of loop iterations of CPU drivers.
void main()
{
    int strand = first_strand(), n = int(step_params.vertex_count);
    if (strand >= int(step_params.strand_count)) return;
    int base = strand_base(strand);
    open_frame(strand);
    vec4 rest_root = strand_root(base);
    Root root = relative_root(frame_root(rest_root.xyz), rest_root.w),
         root_old = relative_root(position_before(base).xyz, rest_root.w);
    vec3 wind = strand_wind(rest_root.xyz, root.at);
    vec3 root_velocity = frame_move(rest_root.xyz) / step_params.dt;
    if (step_params.phase == 0u)
        eliminate(base, n, wind, root_velocity, root_old);
    else
        substitute(base, n, wind, root_velocity, root_old, root);
}
#else
// The force F above, of a link r = m u of length l.
vec3 link_force(vec3 r, vec3 u, vec3 t, float m, float l, Springs springs, float softness)
{
    float ee = softness * softness, both = l * l + ee, mm = m * m + ee, longer = max(l, softness);
    float b = min(springs.b, 0.125 * springs.k * l * (l * l / both)),
          part = b * both / l * (m / mm);
    float coil = 0.5 * springs.k *
                 (1.0 - longer * inversesqrt(max(m * m + (longer * longer - l * l), 1e-36)));
    float cosine = dot(u, t);
    vec3 across = t - cosine * u;
    float sine = length(across), theta = atan(sine, cosine), back = PI - theta,
          turning = min(theta, 3.0 * back);
    // phi
    float stored = theta < 0.75 * PI ? 0.5 * theta * theta : 0.375 * PI * PI - 1.5 * back * back;
    float ratio = sine > 1e-6 ? turning / sine : (cosine > 0.0 ? 1.0 : 3.0);
    return -coil * r - (part * 2.0 * stored * ee / mm) * u + (part * ratio) * across;
}

// Link lengths come from the stored stretch. Differences of positions would shake stiff springs by
// their rounding errors.
void main()
{
    int strand = first_strand(), n = int(step_params.vertex_count);
    if (strand >= int(step_params.strand_count)) return;
    int a = strand_base(strand);
    open_frame(strand);
    vec4 rotation = frame_rotation, rest_root = strand_root(a);
    Root root = relative_root(frame_root(rest_root.xyz), rest_root.w),
         root_old = relative_root(position_before(a).xyz, rest_root.w);
    vec3 wind = strand_wind(rest_root.xyz, root.at), fall = kick(vec3(0.0), wind);
    float dt = step_params.dt, gain = step_params.gain, decay = step_params.decay;
    Springs springs = springs_of(n - 1);
    float softness = SHORT * rest_root.w / float(n - 1); // e
    vec3 was = vec3(0.0);
    vec3 moved = frame_move(rest_root.xyz); // the root's displacement
    vec3 drawn = vec3(0.0), along = rotate(rotation, texelFetch(rest, a + STRAND_TILE).xyz);
    vec3 r = vec3(0.0), force = vec3(0.0); // of the link before
    vec4 v = vec4(0.0);
    float l = 0.0;
    carry_lead(a);
    positions[a] = vec4(root.at, 0.0);
    // The force of link j completes the force on particle j - 1.
    for (int j = 1; j <= n; ++j, a += STRAND_TILE) {
        vec4 style = vec4(0.0), next_v = vec4(0.0);
        vec3 next_r = vec3(0.0), next_force = vec3(0.0);
        if (j < n) {
            style = texelFetch(rest, a + STRAND_TILE);
            next_v = velocity_before(a + STRAND_TILE);
            vec3 to = relative_fetch(position_before(a + STRAND_TILE), root_old),
                 t = rotate(rotation, style.xyz);
            float m;
            next_r = link_before(was, to, style.w, next_v.w);
            vec3 u = direction_of(next_r, t, m);
            next_force = link_force(next_r, u, t, m, style.w,
                                    Springs(springs.k, springs.b * angular_at(j)), softness);
            was = to;
        }
        if (j > 1) {
#if VARIES
            vec3 now = kick_at(j - 1, v.xyz, wind) + gain * (force - next_force);
#else
            vec3 now = v.xyz * decay + fall + gain * (force - next_force);
#endif
            draw_link(a, root, r + (dt * now - moved), l, now, spring_params.stretch_drawn != 0u,
                      drawn, along);
            moved = dt * now;
        }
        r = next_r;
        v = next_v;
        l = style.w;
        force = next_force;
    }
}
#endif
