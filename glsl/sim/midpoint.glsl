// SPDX-License-Identifier: MIT
// Velocities in the middle of a step, of a strand of rigid segments: the implicit midpoint rule,
// linearised once.
//
// In the frame that moves with the root (q, v at the step's start, h = dt/2, p_0 = w_0 = 0):
//   1. half a kick, v+ = K(v), and half of what the style springs do, vs = keep v+ + draw (style -
//      q), implicitly
//   2. tensions, from the segments' directions d in the middle, those of q + h v:  J J^T lambda = J
//      vs, J J^T = tridiag(-d_j.d_{j-1}, 2; 1)
//   3. velocities in the middle, w = vs - J^T lambda, where pushing (lambda-) acts along d, and
//      pulling along the directions that w itself leads to, d = (r + h (w_j - w_{j-1}))/l: with T =
//      lambda+/l a tridiagonal system again, (I + h Laplacian(T)) w = vs - J^T lambda- -
//      Laplacian(T) q. No tension is too stiff for it.
// From there particles want to go to p = q + dt w, and have u = 2w - v+ (constrain.glsl goes on
// from there): as w.(w - v+) = 0 for rigid segments, |u| = |v+|, and the kicks add what gravity
// does along dt w. Second order, and energy neither comes nor goes, but for what tractrices change
// about p (see constrain.glsl).
//
// The springs' end that counts is that of the step, q + dt w, as in the other solvers:
//     keep = 1/(1 + 2z),  draw = keep z/h,  z = k h^2 (step_style_spring in step.c).
// (q + dt w/2 would be second order and damp nothing: strands that their springs push together
// buckled, and trembled on.)
// The sweeps run to and fro. Needs strand.glsl, tridiagonal.glsl, and keep, recall (vec4 a
// particle), keep_beside, recall_beside.

// K(v) of particle j relative to the root: forces and drag for half a step.
vec3 kicked(Strand strand, int j, vec3 v)
{
    return kicked_velocity(strand, j, v) - strand.root_velocity;
}

// vs of particle j that is `offset` from its place in the style; of two particles' difference as
// well where their springs are alike.
vec3 sprung(Strand strand, int j, vec3 kick, vec3 offset)
{
#if STYLED
    StyleSpring spring = spring_of(strand, j);
    return spring.keep * kick - spring.draw * offset;
#else
    return kick;
#endif
}

#if VARIES
// What particles j - 1 and j differ by in vs. `style`: j's place, then that of j - 1.
vec3 sprung_apart(Strand strand, int j, vec3 kick, vec3 kick_before, vec3 q, vec3 q_before,
                  inout vec3 style)
{
    vec3 there = sprung(strand, j, kick, q - strand.root_old - style);
    style -= next_style(vec3(0.0), fetch_rest(strand, j), strand.rotation);
    if (j == 1) return there;
    return there - sprung(strand, j - 1, kick_before, q_before - strand.root_old - style);
}

vec3 style_of_tip(Strand strand)
{
    vec3 style = vec3(0.0);
    for (int j = 1; j <= LAST; ++j)
        style = next_style(style, fetch_rest(strand, j), strand.rotation);
    return style;
}
#endif

// Tip to root: rows of the tensions. Only differences along the strand count.
void find_directions(Strand strand)
{
    float h = 0.5 * strand.dt;
    vec3 q = fetch_position(strand, LAST), v = fetch_velocity(strand, LAST),
         kick = kicked(strand, LAST, v), d_beyond = vec3(0.0);
    Row row = NO_ROW;
#if VARIES
    vec3 style = style_of_tip(strand);
#endif
    for (int j = LAST; j >= 1; --j) {
        vec3 q_before = strand.root_old, v_before = strand.root_velocity, kick_before = vec3(0.0);
        if (j > 1) {
            q_before = fetch_position(strand, j - 1), v_before = fetch_velocity(strand, j - 1);
            kick_before = kicked(strand, j - 1, v_before);
        }
        vec3 r = q - q_before, d = direction(r + h * (v - v_before));
#if VARIES
        vec3 apart = sprung_apart(strand, j, kick, kick_before, q, q_before, style);
#else
        vec3 offset = r;
#if STYLED
        offset -= next_style(vec3(0.0), fetch_rest(strand, j), strand.rotation);
#endif
        vec3 apart = sprung(strand, j, kick - kick_before, offset);
#endif
        float factor;
        row = eliminate(row, -dot(d, d_beyond), j == 1 ? 1.0 : 2.0, dot(d, apart), factor);
        keep(j, vec4(d, row.value));
        keep_beside(j, factor);
        q = q_before, v = v_before, kick = kick_before, d_beyond = d;
    }
}

// Root to tip: tensions; rows of w, each known one segment later. Gives where the style's tip is,
// relative to the root.
vec3 find_tensions(Strand strand)
{
    int last = LAST;
    float h = 0.5 * strand.dt, lambda = 0.0, factor_before = 0.0, t_before = 0.0, factor;
    vec3 q_before = strand.root_old, g_before = vec3(0.0), vs_before = vec3(0.0), style = vec3(0.0);
    Row3 row = NO_ROW3;
    for (int j = 1; j <= last; ++j) {
        vec4 k = recall(j), r = fetch_rest(strand, j);
        vec3 q = fetch_position(strand, j);
        lambda = k.w - factor_before * lambda;
        factor_before = recall_beside(j);
        float pull = max(lambda, 0.0), t = pull / r.w;
        vec3 g = (lambda - pull) * k.xyz + t * (q - q_before);
        if (j > 1) {
            row = eliminate(row, -h * t_before, 1.0 + h * (t_before + t), vs_before - g_before + g,
                            factor);
            keep(j - 1, vec4(row.value, factor));
        }
#if STYLED
        style = next_style(style, r, strand.rotation);
#endif
        vs_before = sprung(strand, j, kicked(strand, j, fetch_velocity(strand, j)),
                           q - strand.root_old - style);
        q_before = q, g_before = g, t_before = t;
    }
    row = eliminate(row, -h * t_before, 1.0 + h * t_before, vs_before - g_before, factor);
    keep(last, vec4(row.value, factor));
    return style;
}

// On the way back from the tip: the particle whose turn it is.
struct Middle {
    vec3 w;
    vec3 style;   // relative to the root
    float factor; // of its row
    float gained; // by what tensions did to the particles beyond, m^2/s^2: 0 if they were exact
};

// Steps 1 to 3; the tip's turn.
Middle middle_open(Strand strand)
{
    find_directions(strand);
    vec3 style = find_tensions(strand);
    vec4 k = recall(LAST);
    return Middle(k.xyz, style, k.w, 0.0);
}

// Particle j, at q: writes p where its position will be, u where its velocity will be. Then j - 1
// has its turn. Gives p.
vec3 middle_place(inout Middle m, Strand strand, int j, vec3 q)
{
    int a = strand.address + j * STRAND_TILE;
    vec3 offset = q - strand.root_old, kick = kicked(strand, j, fetch_velocity(strand, j)),
         p = offset + strand.dt * m.w;
    m.gained += 2.0 * dot(m.w, m.w - sprung(strand, j, kick, offset - m.style));
    keep_aim(a, j, p);
    keep_velocity(a, j, vec4(2.0 * m.w - kick, 0.0));
#if STYLED
    m.style -= next_style(vec3(0.0), fetch_rest(strand, j), strand.rotation);
#endif
    if (j > 1) {
        vec4 k = recall(j - 1);
        m.w = k.xyz - m.factor * m.w, m.factor = k.w;
    } else {
        m.w = vec3(0.0);
    }
    return p;
}
