// SPDX-License-Identifier: MIT
// Bending and twist towards the style: a rod without a twist variable of its own (after Bergou et
// al.: Discrete Elastic Rods, SIGGRAPH 2008). Its frames are rotated as little as possible from
// segment to segment. Needs chain_params.h, keep.glsl, strand.glsl.
//
// Q_0, the first frame, is the head's rotation. If the strand bent like the style, segment j would
// point along a_j = Q_{j-1} (the style's direction j); its actual direction is t_j. Q_j is Q_{j-1}
// followed by the smallest rotation from a_j to t_j. The energy is E = sum beta_j (1 - t_j.a_j),
// beta_j = K (n-1)^2 l_j. With this scaling, a strand that is held horizontally bends at its first
// joint by about g/(2K) radians under its weight, for any n (and by (n-1)/3 times that in total).
//
// The exact gradient with respect to the directions: let w_k be the small rotation of frame k.
// Across t_k it is t_k x dt_k. Along t_k it follows from the fact that a smallest rotation does not
// twist: (w_k - w_{k-1}).(a_k + t_k) = 0. G_k collects the factor of w_k in dE, from tip to root:
//     tau = G_j.t_j/(1 + a_j.t_j),
//     dE/dt_j = -beta a_j + (G_j - tau a_j) x t_j,
//     G_{j-1} = tau (a_j + t_j) - beta a_j x t_j
// So twist is passed on to the root, and forces and moments are balanced.
//
// Folds: a joint that is bent by the angle d passes on up to 1/cos(d/2) times the twist that it
// receives. So G grows exponentially with the number of nearly folded joints, although such a
// gradient is only valid within angles too small for any step (E itself is at most 2 sum beta).
// Crumpled strands flew about. If joints passed on exactly the twist that they receive, rotating
// frame j - 1 would rotate all frames beyond, and each a_i, by the same angle:
//     |G_{j-1}| <= sum_{i >= j} beta_i
// G is shortened to this bound, which changes nothing unless the strand is folded. The energy
// account treats the missing part of the gradient as gained energy.
//
// Time stepping: forces are those of the positions at the step's start, for masses M = 1 + MASS
// dt^2 b D^T D (D: differences along the strand, b = K (n-1)^2/l). These masses leave leapfrog's
// energy unchanged and bound b dt^2/M at any stiffness. Drag acts on these masses, too, up to half
// of the critical damping of the slowest oscillation that they allow, pi/(2 (n-1) sqrt(MASS) dt):
// 0.9/((n-1) dt).
//
// Rest states: the tensions lambda are computed for masses of 1 and without bending, the
// corrections are mu. The strand stays where it is if f = J^T lambda + M J^T mu. That is the
// balance of forces f = J^T lambda only if mu = 0. So mu is carried over: it is added to the
// tensions of the next step (1/s^2, in the fourth component of velocities), which makes rest states
// independent of the step. (Tensions that include bending at once, J J^T lambda = J f, have the
// same rest states but are unstable at long steps: where joints are bent by an angle d, a share d^2
// of a stiff zigzag's force acts on smooth motions, whose masses M are thousands of times smaller.)
// A segment also bends the part behind it: its own stiffness is K (n-1)^2 (l_j + l_{j+1})/l_j^2, so
// b is multiplied by l_{j+1}/(2 l_j) if that is above 1.
const float MASS = 3.0;

#if IN_REGISTERS
vec3 kept_goal[VERTICES];
void keep_goal(int j, vec3 a) { kept_goal[j] = a; }
vec3 recall_goal(int j) { return kept_goal[j]; }
void keep_carried(int j, float mu) { kept_goal[j].x = mu; }
float recall_carried(int j) { return kept_goal[j].x; }
#else // the place after the one of keep_beside
void keep_goal(int j, vec3 a) { scratch[keep_base + (2 * j + 1) * STRAND_TILE].yzw = a; }
vec3 recall_goal(int j) { return scratch[keep_base + (2 * j + 1) * STRAND_TILE].yzw; }
void keep_carried(int j, float mu) { scratch[keep_base + (2 * j + 1) * STRAND_TILE].y = mu; }
float recall_carried(int j) { return scratch[keep_base + (2 * j + 1) * STRAND_TILE].y; }
#endif
// goals are no longer needed when the tensions to carry over are stored

// The displacement that an acceleration of 1 causes in a step, given that the style spring is
// implicit.
float bend_acts(Strand strand) { return strand.dt * step_params.gain * (1.0 - strand.spring.pull); }

// K (n-1)^2
float bend_stiffness(int last) { return chain_params.bend * float(last) * float(last); }

// The frames from root to tip.
struct Frames {
    vec4 rotation; // Q
    float energy;  // divided by K (n-1)^2
};

Frames frames_open(Strand strand) { return Frames(strand.rotation, 0.0); }

// Advances to the segment of direction t and returns its a.
vec3 frames_advance(inout Frames frames, vec3 t, vec4 rest)
{
    vec3 a = rotate(frames.rotation, rest.xyz), axis = cross(a, t);
    float one_cosine = 1.0 + dot(a, t);
    vec4 p = vec4(axis, one_cosine), q = frames.rotation;
    p = one_cosine > 1e-6 ? p * inversesqrt(dot(p, p)) : vec4(0.0, 0.0, 0.0, 1.0);
    vec4 turned =
        vec4(p.w * q.xyz + q.w * p.xyz + cross(p.xyz, q.xyz), p.w * q.w - dot(p.xyz, q.xyz));
    frames.rotation = turned * inversesqrt(dot(turned, turned));
    frames.energy += 0.5 * rest.w * dot(t - a, t - a); // 1 - t.a, without cancellation
    return a;
}

// The moment from tip to root, divided by K (n-1)^2.
struct Moment {
    vec3 G;
    float most; // bound of the length of G: the sum of beta
};

const Moment NO_MOMENT = Moment(vec3(0.0), 0.0);

// Returns the gradient with respect to segment r of length l, and advances the moment to the
// segment before.
vec3 bend_gradient(vec3 r, float l, vec3 a, inout Moment moment)
{
    vec3 t = r / l, G = moment.G;
    float tau = dot(G, t) / max(1.0 + dot(a, t), 0.1);
    vec3 by_t = -l * a + cross(G - tau * a, t);
    G = tau * (a + t) - l * cross(a, t);
    moment.most += l;
    moment.G = G * min(moment.most * inversesqrt(max(dot(G, G), 1e-30)), 1.0);
    return (by_t - dot(by_t, t) * t) / l;
}
