// SPDX-License-Identifier: MIT
// A step of `chain`: rigid segments by direct solves, second order in dt.
//
// Segments r_j = q_j - q_{j-1} at the step's start with lengths l_j; predicted positions p_j
// (after the kick and the springs of the style), s_j = p_j - p_{j-1}.
//   1. Tensions: lambda_j from the constraint linearised about the old directions (Han, Harada:
//      Tridiagonal Matrix Formulation for Inextensible Hair Strand Simulation, VRIPHYS 2013), J
//      J^T lambda = l (|s| - l) with J J^T = tridiag(-r_j.r_{j-1}, 2 |r_j|^2; |r_1|^2).
//   2. Positions: x = p - g_j + g_{j+1}, with the impulses g of the tensions. Compression
//      (lambda-) acts along r. Tension (lambda+) acts along directions taken implicitly by
//      Newmark's method with theta = 1/4 (1/4 new + 1/2 now + 1/4 before). This is second order,
//      and no tension is too stiff: (I + theta Laplacian(lambda+)) x = y, again tridiagonal. A
//      segment that is much stiffer than the step would swing to -3, 5, -7 .. times its amplitude,
//      which only small swings survive. So theta grows to 1/2 with tensions above STIFF; the
//      amplitude then stays the same.
//   3. Twice: correct the remaining length errors along the current directions, J J^T lambda = |s|
//      (|s| - l), x_j -= lambda_j s_j, x_{j-1} += lambda_j s_j, applied to the segments
//      themselves.
//   4. Rebuild the strand from the root with exact lengths.
// Where a violent step leaves a segment off by more than half its length, two passes of tractrices
// replace this (rescue). Long strands at long steps would gain energy by either way;
// energy_account.glsl limits that.
//
// The sweeps run along the strand in alternating directions; each sweep does the back substitution
// of one elimination and the elimination of the next. Everything is relative to the root, and the
// systems are solved for the displacements x - q and changes of segments, which are not rounded
// like positions.
#include "sim/chain_params.h"
#include "sim/particles.glsl"
#include "sim/keep.glsl"
#include "sim/strand.glsl"
#include "sim/tractrix.glsl"
#include "sim/tridiagonal.glsl"
const float ALLOWED = 0.005; // share of the energy
#define SLOWS_AGAIN 0
#include "sim/energy_account.glsl"

const float THETA = 0.25;
const float STIFF = 8.0;    // tension above which theta grows
const float MOST_OFF = 0.5; // in lengths; above it tractrices take over

// From root to tip: predicts displacements and sets up the rows of the tensions.
void predict(Strand strand)
{
    int last = LAST;
    vec3 q_before = vec3(0.0), m_before = vec3(0.0), r_before = vec3(0.0), style = vec3(0.0);
    Row row = NO_ROW;
    keep(0, vec4(0.0));
    keep_beside(0, 0.0);
    for (int j = 1; j <= last; ++j) {
        vec3 q = fetch_position(strand, j), m = predicted_move(strand, j, q, style),
             r = q - q_before, e = m - m_before;
        float l = fetch_rest(strand, j).w, factor;
        row = eliminate(row, -dot(r, r_before), (j == 1 ? 1.0 : 2.0) * dot(r, r),
                        l * relative_longer(r, e, l, length(r + e), 0.0), factor);
        keep(j, vec4(m, row.value));
        keep_beside(j, factor);
        q_before = q, m_before = m, r_before = r;
    }
}

float implicit_share(float tension)
{
    float beyond = max(tension - STIFF, 0.0);
    return THETA + THETA * beyond / (beyond + STIFF);
}

// From tip to root: solves for the tensions and sets up the rows of the positions.
void pull_implicitly(Strand strand)
{
    float lambda = 0.0, factor_beyond = 0.0, implicit_beyond = 0.0;
    vec3 g_beyond = vec3(0.0), q = fetch_position(strand, LAST), v = fetch_velocity(strand, LAST);
    Row3 row = NO_ROW3;
    for (int j = LAST; j >= 1; --j) {
        vec3 q_before = j == 1 ? vec3(0.0) : fetch_position(strand, j - 1),
             v_before = fetch_velocity(strand, j - 1);
        vec4 k = recall(j);
        lambda = k.w - factor_beyond * lambda;
        factor_beyond = recall_beside(j);
        float tension = max(lambda, 0.0), theta = implicit_share(tension), factor;
        vec3 r = q - q_before, turned = strand.dt * (v - v_before);
        vec3 g = lambda * r - theta * tension * turned;
        float off = implicit_beyond, diagonal = 1.0 + (theta * tension + implicit_beyond);
        vec3 y = k.xyz - g + g_beyond;
        row = eliminate(row, -off, diagonal, y, factor);
        keep(j, vec4(row.value, factor));
        q = q_before, v = v_before, g_beyond = g, implicit_beyond = theta * tension;
    }
}

// From root to tip: solves for the displacements, of which only the changes e of the segments s = r
// + e are used further, and sets up the rows of the first correction.
void correct(Strand strand)
{
    int last = LAST;
    vec3 q_before = vec3(0.0), m_before = vec3(0.0), s_before = vec3(0.0);
    float factor_before = 0.0, factor;
    Row row = NO_ROW;
    for (int j = 1; j <= last; ++j) {
        vec4 k = recall(j);
        vec3 q = fetch_position(strand, j), r = q - q_before, m = k.xyz - factor_before * m_before,
             e = m - m_before, s = r + e;
        factor_before = k.w;
        float ss = dot(s, s), size = sqrt(ss);
        row = eliminate(row, -dot(s, s_before), (j == 1 ? 1.0 : 2.0) * ss,
                        size * relative_longer(r, e, fetch_rest(strand, j).w, size, 0.0), factor);
        keep(j, vec4(e, row.value));
        keep_beside(j, factor);
        q_before = q, m_before = m, s_before = s;
    }
}

// A correction removes t_j = lambda_j s_j from segment j and gives it to both neighbours (the root
// does not move): e_j += t_{j-1} - 2 t_j + t_{j+1}, which is known one segment later. In the two
// sweeps that apply a correction, `here` is the neighbour of segment j.
struct Corrected {
    vec3 r, e, t;
};

// From tip to root: applies the first correction and sets up the rows of the second.
void correct_again(Strand strand)
{
    float lambda = 0.0, factor_beyond = 0.0, factor;
    Corrected here = Corrected(vec3(0.0), vec3(0.0), vec3(0.0));
    vec3 t_beyond = vec3(0.0), s_beyond = vec3(0.0), q = fetch_position(strand, LAST);
    Row row = NO_ROW;
    for (int j = LAST; j >= 0; --j) {
        vec4 k = recall(j); // zero if j = 0
        vec3 q_before = j <= 1 ? vec3(0.0) : fetch_position(strand, j - 1), r = q - q_before;
        lambda = k.w - factor_beyond * lambda;
        factor_beyond = recall_beside(j);
        vec3 t = lambda * (r + k.xyz);
        if (j < LAST) {
            vec3 e = here.e + (t + t_beyond - (j == 0 ? 1.0 : 2.0) * here.t), s = here.r + e;
            float ss = dot(s, s), size = sqrt(ss);
            row = eliminate(
                row, -dot(s, s_beyond), (j == 0 ? 1.0 : 2.0) * ss,
                size * relative_longer(here.r, e, fetch_rest(strand, j + 1).w, size, 0.0), factor);
            keep(j + 1, vec4(e, row.value));
            keep_beside(j + 1, factor);
            s_beyond = s;
        }
        t_beyond = here.t, here = Corrected(r, k.xyz, t), q = q_before;
    }
}

// Stores the change of segment r, scaled to its length l. Returns its length error, as bits that
// order like the number; a NaN comes last.
int finish_segment(int j, vec3 r, vec3 e, float l)
{
    vec3 s = r + e;
    float ss = dot(s, s), inverse = inversesqrt(ss);
    keep(j, vec4(relative_turn(r, e, l, ss * inverse, 0.0, s * inverse), 0.0));
    return floatBitsToInt(abs(ss * inverse - l) / l);
}

// From root to tip: applies the second correction. Returns the largest length error.
int finish(Strand strand)
{
    int last = LAST, worst = 0;
    float lambda = 0.0, factor_before = 0.0;
    Corrected here = Corrected(vec3(0.0), vec3(0.0), vec3(0.0));
    vec3 t_before = vec3(0.0), q_before = vec3(0.0);
    for (int j = 1; j <= last; ++j) {
        vec4 k = recall(j);
        lambda = k.w - factor_before * lambda;
        factor_before = recall_beside(j);
        vec3 q = fetch_position(strand, j), r = q - q_before, t = lambda * (r + k.xyz);
        if (j > 1) {
            vec3 e = here.e + (t + t_before - (j == 2 ? 1.0 : 2.0) * here.t);
            worst = max(worst, finish_segment(j - 1, here.r, e, fetch_rest(strand, j - 1).w));
        }
        t_before = here.t, here = Corrected(r, k.xyz, t), q_before = q;
    }
    vec3 e = here.e + (t_before - (last == 1 ? 1.0 : 2.0) * here.t);
    return max(worst, finish_segment(last, here.r, e, fetch_rest(strand, last).w));
}

// Stores the velocity first: compilers may delay the fetch of q until it is used, which could be
// after a store to the buffer that q comes from. `moved`: relative to the root.
void put(Strand strand, int j, vec3 x, vec3 moved)
{
    int a = strand.address + j * STRAND_TILE;
    velocities[a] = vec4((moved + strand.moved) / strand.dt, 0.0);
    store_position(strand, a, x);
}

// From root to tip: rebuilds the strand and writes it.
void write(Strand strand, inout Account account)
{
    int last = LAST;
    vec3 x = vec3(0.0), moved = vec3(0.0), q_before = vec3(0.0), style = vec3(0.0);
    for (int j = 1; j <= last; ++j) {
        vec3 q = fetch_position(strand, j), v = fetch_velocity(strand, j),
             free = predicted_move(strand, j, q, style), e = recall(j).xyz,
             d = normalize(q - q_before + e);
        vec4 segment = fetch_rest(strand, j);
        x += segment.w * d;
        moved += e;
        account_add(account, strand, moved, free, v);
        put(strand, j, x, moved);
        q_before = q;
    }
}

// Two passes of tractrices (as in hybrid.comp) instead. Loops are not unrolled: on a CPU driver all
// lanes go through every branch, and this way they leave the loops after one round if no strand
// needs them. Intermediate results are stored in place of the velocities.
void rescue(Strand strand, inout Account account)
{
    int last = int(step_params.vertex_count - 1u);
    vec3 style = vec3(0.0), sum = vec3(0.0), sum_before = vec3(0.0);
    float squares = 0.0, squares_before = 0.0;
    for (int j = 1; j <= last; ++j) {
        vec3 before = fetch_velocity(strand, j) * strand.dt - account.moved_before;
        sum_before += before;
        squares_before += dot(before, before);
        vec3 q = fetch_position(strand, j);
        velocities[strand.address + j * STRAND_TILE] =
            vec4(q + predicted_move(strand, j, q, style), 0.0);
    }
    vec3 y = velocities[strand.address + last * STRAND_TILE].xyz, q = fetch_position(strand, last);
    for (int j = last; j >= 1; --j) {
        vec3 q_before = j == 1 ? vec3(0.0) : fetch_position(strand, j - 1), p = -strand.moved;
        if (j > 1) p = velocities[strand.address + (j - 1) * STRAND_TILE].xyz;
        float l = fetch_rest(strand, j).w;
        vec3 d = direction(q_before - q), move = limit_move(y - (q + p - q_before));
        // inaccurate if the move pushes exactly along the segment
        d = direction(tractrix_turn(d, l, move));
        y += l * d;
        velocities[strand.address + j * STRAND_TILE] = vec4(-d, 0.0);
        q = q_before;
    }
    vec3 move = limit_move(-y), x = vec3(0.0);
    for (int j = 1; j <= last; ++j) {
        float l = fetch_rest(strand, j).w;
        vec3 d = tractrix_turn(
            tractrix_renormalise(velocities[strand.address + j * STRAND_TILE].xyz), l, move);
        q = fetch_position(strand, j);
        d = direction(d);
        x += l * d;
        vec3 now = x - q;
        sum += now;
        squares += dot(now, now);
        put(strand, j, x, now);
    }
    account_add_sums(account, strand.dt * strand.push, sum, sum_before, squares, squares_before);
}

void step_strand(int s)
{
    Strand strand = strand_open(s, chain_params.spring);
    predict(strand);
    pull_implicitly(strand);
    correct(strand);
    correct_again(strand);
    bool violent = finish(strand) > floatBitsToInt(MOST_OFF);
    Account account = account_open(strand);
    if (violent)
        rescue(strand, account);
    else
        write(strand, account);
    store_root(strand);
    float gained = account_close(account, strand, int(step_params.vertex_count - 1u));
    velocities[strand.address] = vec4(account.moved / strand.dt, gained);
}
#include "sim/each_strand.glsl"
