// SPDX-License-Identifier: MIT
// The velocities in the middle of a step, for a strand of rigid segments: the implicit midpoint
// rule, linearised once.
//
// In the frame that moves with the root (q, v at the step's start, h = dt/2, p_0 = w_0 = 0):
//   1. Half a kick, v+ = K(v), and half of the effect of the style springs, implicitly: vs = keep
// v+ +
//      draw (style - q).
//   2. Tensions, from the directions d of the segments q + h v in the middle:  J J^T lambda = J vs,
//      J J^T = tridiag(-d_j.d_{j-1}, 2; 1).
//   3. Velocities in the middle, w = vs - J^T lambda. Compression (lambda-) acts along d, tension
//      (lambda+) along the directions that result from w itself, d = (r + h (w_j - w_{j-1}))/l.
// With
//      T = lambda+/l this is another tridiagonal system, (I + h Laplacian(T)) w = vs - J^T lambda-
// -
//      Laplacian(T) q. It is stable for any tension.
// The particles' targets are then p = q + dt w, with velocities u = 2w - v+ (constrain.glsl
// continues from there). For rigid segments w.(w - v+) = 0, so |u| = |v+|, and the kicks add the
// work of gravity along dt w. The method is of second order and conserves energy, apart from the
// changes that tractrices make to p (see constrain.glsl).
//
// The springs are evaluated at the step's end, q + dt w, as in the other solvers:
//     keep = 1/(1 + 2z),  draw = keep z/h,  z = k h^2 (step_style_spring in step.c).
// (Evaluation at q + dt w/2 would be of second order but without damping: strands that their
// springs compress buckled and trembled for ever.)
// Sweeps run in alternating directions. Needs strand.glsl, tridiagonal.glsl, keep.glsl.

// K(v) of particle j relative to the root: half a step of forces and drag.
vec3 kicked(Strand strand, int j, vec3 v)
{
    return kicked_velocity(strand, j, v) - strand.root_velocity;
}

// vs of a particle j that is `offset` from its place in the style. Also works for the difference of
// two particles with equal springs.
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
// The difference of vs between particles j and j - 1. `style` is the place of j and becomes that of
// j - 1.
vec3 sprung_apart(Strand strand, int j, vec3 kick, vec3 kick_before, vec3 q, vec3 q_before,
                  inout vec3 style)
{
    vec3 there = sprung(strand, j, kick, q - style);
    style -= next_style(vec3(0.0), fetch_rest(strand, j), strand.rotation);
    if (j == 1) return there;
    return there - sprung(strand, j - 1, kick_before, q_before - style);
}

vec3 style_of_tip(Strand strand)
{
    vec3 style = vec3(0.0);
    for (int k = 0; k < LAST; ++k)
        style = next_style(style, fetch_rest(strand, k + 1), strand.rotation);
    return style;
}
#endif

// From tip to root: the rows of the tensions. They depend only on differences along the strand.
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
        vec3 q_before = vec3(0.0), v_before = strand.root_velocity, kick_before = vec3(0.0);
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

// From root to tip: the tensions, and the rows of w, each of which is known one segment later.
// Returns the position of the style's tip relative to the root.
vec3 find_tensions(Strand strand)
{
    int last = LAST;
    float h = 0.5 * strand.dt, lambda = 0.0, factor_before = 0.0, t_before = 0.0, factor;
    vec3 q_before = vec3(0.0), g_before = vec3(0.0), vs_before = vec3(0.0), style = vec3(0.0);
    Row3 row = NO_ROW3;
    for (int k = 0; k < last; ++k) {
        int j = k + 1;
        vec4 kept = recall(j), r = fetch_rest(strand, j);
        vec3 q = fetch_position(strand, j);
        lambda = kept.w - factor_before * lambda;
        factor_before = recall_beside(j);
        float pull = max(lambda, 0.0), t = pull / r.w;
        vec3 g = (lambda - pull) * kept.xyz + t * (q - q_before);
        if (j > 1) {
            row = eliminate(row, -h * t_before, 1.0 + h * (t_before + t), vs_before - g_before + g,
                            factor);
            keep(j - 1, vec4(row.value, factor));
        }
#if STYLED
        style = next_style(style, r, strand.rotation);
#endif
        vs_before = sprung(strand, j, kicked(strand, j, fetch_velocity(strand, j)), q - style);
        q_before = q, g_before = g, t_before = t;
    }
    row = eliminate(row, -h * t_before, 1.0 + h * t_before, vs_before - g_before, factor);
    keep(last, vec4(row.value, factor));
    return style;
}

// The current particle on the way back from the tip.
struct Middle {
    vec3 w;
    vec3 style;   // relative to the root
    float factor; // factor of the particle's row
    float gained; // by the tensions' work on the particles beyond, m^2/s^2; 0 if tensions were
                  // exact
};

// Does steps 1 to 3 and starts at the tip.
Middle middle_open(Strand strand)
{
    find_directions(strand);
    vec3 style = find_tensions(strand);
    vec4 k = recall(LAST);
    return Middle(k.xyz, style, k.w, 0.0);
}

// Finishes particle j, which was at q: stores p in its position and u in its velocity. Then steps
// to j - 1. Returns p.
vec3 middle_place(inout Middle m, Strand strand, int j, vec3 q)
{
    int a = strand.address + j * STRAND_TILE;
    vec3 kick = kicked(strand, j, fetch_velocity(strand, j)), p = q + strand.dt * m.w;
    m.gained += 2.0 * dot(m.w, m.w - sprung(strand, j, kick, q - m.style));
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
