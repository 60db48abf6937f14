// SPDX-License-Identifier: MIT
// Bending and twist towards the style: a rod without a twist of its own (after Bergou et al.:
// Discrete Elastic Rods, SIGGRAPH 2008) whose frames are turned as little as possible from segment
// to segment. Needs chain_params.h, keep.glsl, strand.glsl.
//
// The head's rotation is the frame Q_0. Segment j of direction t_j would go on as the style does
// along a_j = Q_{j-1} (the style's direction j); Q_j is Q_{j-1} turned by the smallest rotation
// from a_j to t_j. Energy: E = sum beta_j (1 - t_j.a_j), beta_j = K (n-1)^2 l_j: the weight of a
// strand that is held horizontally turns its first joint by about g/(2K) radians, whatever n (and
// all of it by (n-1)/3 as much).
//
// Its gradient by the directions, exactly: with w_k the small rotation of frame k, t_k x dt_k
// across t_k, and along it, because a smallest rotation does not twist, (w_k - w_{k-1}).(a_k + t_k)
// = 0. From tip to root G_k gathers what multiplies w_k in dE:
//     tau = G_j.t_j/(1 + a_j.t_j),
//     dE/dt_j = -beta a_j + (G_j - tau a_j) x t_j,
//     G_{j-1} = tau (a_j + t_j) - beta a_j x t_j
// so twist is handed on down to the root, and forces and moments are balanced.
//
// Folds: a joint bent by d hands on up to 1/cos(d/2) times the twist that it is given, so that G
// grows exponentially with the number of joints that are nearly folded, whose gradients hold within
// angles too small for any step (E itself is at most 2 sum beta): crumpled strands were thrown
// about. Where joints hand on what they are given, turning frame j - 1 turns those beyond as much,
// and with them each a_i:
//     |G_{j-1}| <= sum_{i >= j} beta_i
// G is shortened to that, which changes nothing that is not folded. What is then missing from the
// gradient the account sees as gained.
//
// In time: forces of the positions at the step's start, and for masses M = 1 + MASS dt^2 b D^T D
// (D: differences along the strand, b = K (n-1)^2/l), which leaves leapfrog's energy as it is and
// bounds b dt^2/M at any stiffness. Drag acts on these masses too, up to half of what is critical
// for the slowest swing that they allow, pi/(2 (n-1) sqrt(MASS) dt): 0.9/((n-1) dt).
//
// At rest: tensions lambda, found for masses of 1 and without bending, and the corrections' mu
// leave the strand where it is if f = J^T lambda + M J^T mu, which is the balance of forces f = J^T
// lambda only for mu = 0. So mu is carried on: it adds to the tensions of the next step (1/s^2, in
// the fourth component of velocities), and rest states do not depend on the step. (Tensions that
// take bending into account at once, J J^T lambda = J f, have the same rest states, but are
// unstable at long steps: where joints are bent by an angle d, a share d^2 of a stiff zigzag's
// force acts on smooth motions, whose masses M are smaller by thousands.) A segment also bends what
// comes behind it: its own stiffness is K (n-1)^2 (l_j + l_{j+1})/l_j^2, so b is larger by
// l_{j+1}/(2 l_j) where that is above 1.
const float MASS = 3.0;

#if IN_REGISTERS
vec3 kept_goal[VERTICES];
void keep_goal(int j, vec3 a) { kept_goal[j] = a; }
vec3 recall_goal(int j) { return kept_goal[j]; }
void keep_carried(int j, float mu) { kept_goal[j].x = mu; }
float recall_carried(int j) { return kept_goal[j].x; }
#else // the place beside keep_beside's
void keep_goal(int j, vec3 a) { scratch[keep_base + (2 * j + 1) * STRAND_TILE].yzw = a; }
vec3 recall_goal(int j) { return scratch[keep_base + (2 * j + 1) * STRAND_TILE].yzw; }
void keep_carried(int j, float mu) { scratch[keep_base + (2 * j + 1) * STRAND_TILE].y = mu; }
float recall_carried(int j) { return scratch[keep_base + (2 * j + 1) * STRAND_TILE].y; }
#endif
// (goals are no longer needed where tensions to carry on are kept)

// What an acceleration moves particles by in a step, with the implicit style spring as it does
// gravity.
float bend_acts(Strand strand) { return strand.dt * step_params.gain * (1.0 - strand.spring.pull); }

// K (n-1)^2
float bend_stiffness(int last) { return chain_params.bend * float(last) * float(last); }

// From root to tip.
struct Frames {
    vec4 rotation; // Q
    float energy;  // over K (n-1)^2
};

Frames frames_open(Strand strand) { return Frames(strand.rotation, 0.0); }

// Goes on to the segment of direction t; gives its a.
vec3 frames_advance(inout Frames frames, vec3 t, vec4 rest)
{
    vec3 a = rotate(frames.rotation, rest.xyz), axis = cross(a, t);
    float one_cosine = 1.0 + dot(a, t);
    vec4 p = vec4(axis, one_cosine), q = frames.rotation;
    p = one_cosine > 1e-6 ? p * inversesqrt(dot(p, p)) : vec4(0.0, 0.0, 0.0, 1.0);
    vec4 turned =
        vec4(p.w * q.xyz + q.w * p.xyz + cross(p.xyz, q.xyz), p.w * q.w - dot(p.xyz, q.xyz));
    frames.rotation = turned * inversesqrt(dot(turned, turned));
    frames.energy += 0.5 * rest.w * dot(t - a, t - a); // 1 - t.a without cancellation
    return a;
}

// From tip to root, over K (n-1)^2.
struct Moment {
    vec3 G;
    float most; // of the length of G: the sum of beta
};

const Moment NO_MOMENT = Moment(vec3(0.0), 0.0);

// The gradient by segment r of length l; the moment becomes that of the segment before.
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
