// SPDX-License-Identifier: MIT
// The elastic energy of a strand's joints (after Bergou et al.: Discrete Elastic Rods, SIGGRAPH
// 2008; one angle tau of twist a joint). Needs rod_params.h, strand.glsl.
//
// Q_0, the first frame, is the clamp's rotation. A joint without load would let segment j point
// along a_j = Q_{j-1} s_j (s_j: the natural direction); it points along t_j. Q_j is Q_{j-1}
// followed by the smallest rotation from a_j to t_j and a turn by tau_j about t_j:
//     E = sum beta_j (1 - t_j.a_j) + gamma_j (tau_j - tau0_j)^2/2
//     beta_j = B/(rho A lbar_j),  gamma_j = beta_j/(1 + nu),  lbar_j = (l_{j-1} + l_j)/2
// Everything is per rho A, with masses m_j = (l_j + l_{j+1})/2. A clamp holds the direction at its
// own place, so lbar_1 = l_1/2; with LEAD 1 it is the segment before that is held. With that joint,
// and half a segment's mass at the tip, bending is of second order in the length of a segment.
//
// Gradient: let w_k be the small rotation of frame k. Across t_k it is t_k x dt_k. Along t_k it
// follows from (w_k - w_{k-1}).(a_k + t_k) = (1 + a_k.t_k) dtau_k, since a smallest rotation does
// not twist. G_k collects the factor of w_k in dE, from tip to root:
//     k = G_j.t_j/(1 + a_j.t_j),   dE/dt_j = -beta a_j + (G_j - k a_j) x t_j,
//     G_{j-1} = k (a_j + t_j) - beta a_j x t_j
// with tau at the minimum of E, gamma_j (tau_j - tau0_j) + G_j.t_j = 0.
//
// A joint that is bent by the angle d passes on up to 1/cos(d/2) times the twist that it receives.
// In a folded strand G would grow exponentially, although such a gradient is only valid within
// angles too small for any step. If joints passed on exactly what they receive, |G_{j-1}| would be
// at most the sum of the moments beyond. G is shortened to twice this sum, which changes nothing
// unless the strand is folded; the limiter (rod.comp) pays for the missing part.

// s_j in the head's frame at rest, tau0_j. BALANCED 0: the style's directions.
#if BALANCED
layout(binding = BIND_NATURAL) uniform samplerBuffer natural;
vec4 fetch_natural(Strand strand, int j)
{
    return texelFetch(natural, strand.address + j * STRAND_TILE);
}
#else
vec4 fetch_natural(Strand strand, int j) { return vec4(fetch_rest(strand, j).xyz, 0.0); }
#endif

// B/(rho A) of the joint at the root's end of segment j.
float bend_at(int j)
{
#if VARIES
    return own_along(j - 1).z;
#else
    return rod_params.bend;
#endif
}

// beta_j, m^3/s^2.
float joint_stiffness(Strand strand, int j, float l)
{
    float before = 0.0;
#if LEAD
    before = fetch_rest(strand, j - 1).w;
#else
    if (j > 1) before = fetch_rest(strand, j - 1).w;
#endif
    return 2.0 * bend_at(j) / (before + l);
}

// The frame Q_j from Q_{j-1}. `a` is the unloaded direction, t the direction.
vec4 frame_beyond(vec4 q, vec3 a, vec3 t, float tau)
{
    float one_cosine = 1.0 + dot(a, t);
    vec4 p = vec4(cross(a, t), one_cosine);
    p = one_cosine > 1e-6 ? p * inversesqrt(dot(p, p)) : vec4(0.0, 0.0, 0.0, 1.0);
    q = product(p, q);
    q = product(vec4(sin(0.5 * tau) * t, cos(0.5 * tau)), q);
    return q * inversesqrt(dot(q, q));
}

// E of a joint.
float joint_energy(float beta, vec3 a, vec3 t, float twisted)
{
    return 0.5 * beta * (dot(t - a, t - a) + rod_params.twist * twisted * twisted);
}

// The direction (a + t)/(1 + a.t), along which the turns of two neighbours differ by dtau.
vec3 twist_axis(vec3 a, vec3 t) { return (a + t) / max(1.0 + dot(a, t), 0.1); }

struct Moment {
    vec3 G;
    float most; // bound of the length of G
};

const Moment NO_MOMENT = Moment(vec3(0.0), 0.0);

// The gradient of E with respect to the segment's vector, whose length is l, and the moment of the
// frame before.
vec3 joint_gradient(float beta, float l, vec3 a, vec3 t, inout Moment moment)
{
    vec3 G = moment.G;
    float k = dot(G, t) / max(1.0 + dot(a, t), 0.1);
    vec3 by_t = -beta * a + cross(G - k * a, t);
    G = k * (a + t) - beta * cross(a, t);
    moment.most += 2.0 * beta;
    moment.G = G * min(moment.most * inversesqrt(max(dot(G, G), 1e-30)), 1.0);
    return (by_t - dot(by_t, t) * t) / l;
}
