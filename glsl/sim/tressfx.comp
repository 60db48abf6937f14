// SPDX-License-Identifier: MIT
// TressFX's constraints (AMD TressFX 4; Han, Harada: Real-time Hair Simulation with Efficient Hair
// Style Preservation, VRIPHYS 2012).
//
// The head carries vertices 0 and 1. The other vertices are predicted, x* = x + dt (v decay + g
// gain), and corrected:
//   shock    a share of the rigid motion of the root's segment moves the whole strand (all of it
//   where the root is jerked)
//   global   the first `range` of the vertices move towards the style's position
//   local    with R_j, the smallest rotation from the style's segment j to the strand's, segment
//   j+1 should be b_{j+1} = R_j r_{j+1}
//   lengths
//
// TRESSFX4 1: as published. Each local pass moves, from the root on, both ends of a segment by a
// share of the gap b - s. Each pass of the lengths moves both ends of every second edge, then of
// the others. The effect of a stiffness depends on passes and dt.
//
// TRESSFX4 0 (`steady`): the same local passes, but their shares s are chosen such that the
// stiffness does not depend on passes and dt. In a pass, the gap of a joint contains what the pass
// has moved before it. At rest under a load `a` a vertex, a pass must move vertex j by -a dt^2, so
// that the gap of joint j is -m a dt^2, m = n - 1 - j, whatever the shares are; and to first order
// the joints' bends are g_1/s_1, g_2/s_2 - 2 g_1, g_j/s_j - 3 g_{j-1} + g_{j-2}. The tip's
// deflection is the sum of bends times m:
//     (sum_j m^2/s_j - B) a dt^2,   B = 2 (n-2)(n-3) + sum_{m=1}^{n-4} (2 m^2 + m) + 1
// So a pass with equal shares has the stiffness F = s/(1 - s B/S), S = sum_{m=1}^{n-2} m^2. F is to
// be 2/passes (dt/frame)^2 times that of the share that TressFX has in two passes a frame. The
// first joint, of which only one end moves, has the share F in its own right (at most 1), and the
// others get what leaves the same deflection; with equal shares it would be the softest in long
// steps.
//
// Lengths: Newton's method, J J^T lambda = |s| (|s| - l), tridiagonal, gives the share by which
// each segment s must shorten. Moving along s as it is would be y_j = x_j - lambda_j s_j +
// lambda_{j+1} s_{j+1}. Under the strand's weight lambda is up to n g dt^2/l, and a segment would
// turn by 4 lambda times its deviation from the direction of the tension: to and fro in each step
// if that is much more than 1. So tension acts along the segments that it leaves: (I + K) y = x,
// (K y)_j = lambda_j (y_j - y_{j-1}) - lambda_{j+1} (y_{j+1} - y_j), tridiagonal and positive
// definite. This turns no segment beyond the direction of the tension, for any lambda. Negative
// lambda pushes along s. All this is done twice; if the second time moved along s, long loose
// strands would gain half of the energy that they can release by falling. Then each segment gets
// its exact length. v = (x - x_before)/dt, where the displacement x - x_before is summed up from
// the corrections: a difference of positions would have their rounding error.
//
// Exchange of velocity: the target of segment j+1 follows from segment j, but segment j feels no
// reaction. So these forces have no potential, K of x'' = -K x is not symmetric, and its
// eigenvalues w^2 (1 + i e) gain about e w/2 per second. A long step damps that by w^2 dt/2. So
// that a short step does not flutter either, neighbours exchange a share X of their velocity
// difference before they fly: v_j += X u, v_{j+1} -= X u, u = v_{j+1} - v_j. This keeps momentum,
// and energy falls for any X < 1. A joint alone would oscillate by W^2 = 2 passes
// s/dt^2; X = W dt damps it critically. At 1/2 both get the same velocity.
#include "sim/particles.glsl"
#include "sim/tressfx_params.h"

// The strand is corrected in the head's frame with its root at the origin, where the style needs no
// rotation. REST(j) is the direction and length of the style's segment j. During the step
// `velocities` have the vertices' previous positions, FROM(j), and `positions` their displacements,
// MOVE(j). Everything stays in memory: these loops with few accesses are as fast there as unrolled
// loops in registers, and compile in a sixth of the time.
int strand = 0, n = 0; // of the lane, set in main
int address(int j) { return particle_address(strand, j + LEAD, n + LEAD); }
#define REST(j) texelFetch(rest, address(j))
#define FROM(j) velocities[address(j)].xyz
#define MOVE(j) positions[address(j)].xyz

vec3 unit(vec3 v, vec3 otherwise)
{
    float square = dot(v, v);
    return square > 1e-30 ? v * inversesqrt(square) : otherwise;
}

vec4 conjugate(vec4 rotation) { return vec4(-rotation.xyz, rotation.w); }

// The sum of m^2 for m = 1 .. last.
float sum_of_squares(float last) { return last * (last + 1.0) * (2.0 * last + 1.0) / 6.0; }

// The shares of a pass at the first joint (x) and the others (y), from that of TressFX in two
// passes a frame.
vec2 pass_shares(float share)
{
#if TRESSFX4
    return vec2(share);
#else
    float m = max(float(n), 3.0) - 2.0, last = m - 2.0, S = sum_of_squares(m),
          B = 2.0 * m * (m - 1.0) + 2.0 * sum_of_squares(last) + 0.5 * last * (last + 1.0) + 1.0;
    float firm = tressfx_params.local_times * share / max(1.0 - share * B / S, 0.05);
    firm = max(firm, 1e-12);
    float first = min(firm, 2.0 * tressfx_params.local_most),
          others = (S - m * m) / max(S / firm + B - m * m / first, 1e-6);
    return vec2(first, min(others, tressfx_params.local_most));
#endif
}

vec2 mean_shares = vec2(0.0); // of the lane, set in main

// The shares of the local pass and of the global shape at vertex j.
float local_at(int j)
{
#if VARIES
    vec2 shares = pass_shares(own_along(j).x);
#else
    vec2 shares = mean_shares;
#endif
    return j > 2 ? shares.y : shares.x;
}

float global_at(int j)
{
#if VARIES
    return own_along(j).y;
#else
    return tressfx_params.global_share;
#endif
}

// The motion of the head in this step, in the head's frame at its end.
struct Carried {
    Root root_old, root;
    vec3 root_moved;     // in the world
    vec3 first_moved;    // displacement of vertex 1
    vec3 first_old;      // old direction of the first segment, which is now REST(1)
    vec3 first_velocity; // of vertex 1 in the previous step
    float share;         // share of the root's rigid motion that moves the whole strand
};

Carried carried_by_head()
{
    vec4 root = strand_root(address(0)), first = REST(1), old = frame_rotation_old;
    Carried carried;
    carried.root_old = relative_root(frame_root_old(root.xyz), root.w);
    carried.root = relative_root(frame_root(root.xyz), root.w);
    carried.root_moved = frame_move(root.xyz);
    vec3 first_old = rotate(old, first.xyz), first_new = rotate(frame_rotation, first.xyz);
    carried.first_old = rotate(conjugate(frame_rotation), first_old);
    vec3 moved = carried.root_moved + first.w * (first_new - first_old);
    carried.first_velocity = velocity_before(address(1)).xyz;
    vec3 jerk = moved - step_params.dt * carried.first_velocity;
    float threshold = tressfx_params.shock_threshold;
    carried.share = dot(jerk, jerk) > threshold * threshold ? 1.0 : tressfx_params.shock;
    carried.first_moved = (1.0 - carried.share) * rotate(conjugate(frame_rotation), moved);
    velocities[address(1)] = vec4(moved / step_params.dt, 0.0); // for the jerk of the next step
    return carried;
}

// A vertex between a short segment and one that is more than MOST_LEVER times as long moves and
// exchanges by less than its share. Otherwise it would turn the short segment, and with it the
// frame of the long one, by more than it corrects.
const float MOST_LEVER = 2.0;

// Stores the predicted displacements and the previous positions, both in the head's frame.
void predict(Carried carried)
{
    vec3 wind = strand_wind(strand_root(address(0)).xyz, carried.root.at),
         home = carried.root_moved;
    vec3 style = vec3(0.0), first = REST(1).xyz, first_old = carried.first_old;
    vec4 to_head = conjugate(frame_rotation);
    float dt = step_params.dt, global = tressfx_params.global_share,
          last_global = tressfx_params.global_range * float(n), share = carried.share;
    home = rotate(to_head, home);
#if !TRESSFX4
    // The other vertices' velocities are relative to the motion that moves the whole strand.
    vec3 ahead = (1.0 - share) * carried.first_velocity;
    float both = 2.0 * float(tressfx_params.local_passes),
          exchanged = tressfx_params.exchanged * min(sqrt(both * mean_shares.y), 0.5);
#endif
    for (int j = 1; j < n; ++j) {
        int a = address(j);
        vec4 segment = REST(j);
        style += segment.w * segment.xyz;
        vec3 from = rotate(to_head, relative_fetch(position_before(a), carried.root_old));
#if TRESSFX4
        vec3 v = velocity_before(a).xyz;
        vec3 move = dt * rotate(to_head, v * step_params.decay + frame_gravity * dt);
        if (float(j) < last_global) move += global * (style + home - (from + move));
#else
        vec3 v = ahead;
        ahead = velocity_before(address(min(j + 1, n - 1))).xyz;
        float lever = min(1.0, MOST_LEVER * segment.w / REST(min(j + 1, n - 1)).w);
        vec3 given = (j + 1 < n ? exchanged * lever : 0.0) * (ahead - v);
        v += given, ahead -= given;
        vec3 move = dt * rotate(to_head, kick_at(j, v, wind));
        vec3 force = dt * rotate(to_head, kick_at(j, vec3(0.0), wind));
#endif
        move = mix(move, turn_between(first_old, first, move), share);
        from = mix(from - home, turn_between(first_old, first, from), share);
#if !TRESSFX4
        if (float(j) < last_global) {
            // The move towards the style takes the share s of the forces, too, but the passes have
            // to balance all of them; up to a stiffness that is stable.
            float s = global_at(j);
            vec3 net = force - s * (from + force - style);
            move += s * (style - (from + move)) +
                    (min(1.0 / (1.0 - s), 1.5 / max(s, 1e-9)) - 1.0) * net;
        }
#endif
        positions[a] = vec4(move, 0.0);
        if (j > 1) velocities[a] = vec4(from, 0.0);
    }
}

// A vertex: its place and its displacement.
struct Vertex {
    vec3 x, move;
};

// Vertex 1, which the head carries.
Vertex first_vertex(Carried carried)
{
    vec4 first = REST(1);
    return Vertex(first.w * first.xyz, carried.first_moved);
}

Vertex vertex_at(int j)
{
    vec3 move = MOVE(j);
    return Vertex(FROM(j) + move, move);
}

void add_move(inout Vertex vertex, vec3 move) { vertex.x += move, vertex.move += move; }

void keep_local_shape(Carried carried)
{
    vec3 before = vec3(0.0);
    Vertex here = first_vertex(carried);
    vec4 rest_here = REST(1);
    for (int j = 1; j < n - 1; ++j) {
        vec4 rest_next = REST(j + 1);
        vec3 wanted =
            rest_next.w *
            turn_between(rest_here.xyz, unit(here.x - before, rest_here.xyz), rest_next.xyz);
        Vertex next = vertex_at(j + 1);
        vec3 gap = local_at(j + 1) * (here.x + wanted - next.x);
        if (j > 1) {
            add_move(here, -gap * min(1.0, MOST_LEVER * rest_here.w / rest_next.w));
            MOVE(j) = here.move;
        }
        before = here.x;
        here = next;
        add_move(here, gap);
        rest_here = rest_next;
    }
    MOVE(n - 1) = here.move;
}

#if TRESSFX4

// The force of the wind on a segment t, -(t x w) x t, towards where the air moves. TressFX's unit
// of length, the centimetre, is built into it, and it grows with the square of a stretched segment;
// the clamp keeps a storm finite.
void blow()
{
    vec4 root = strand_root(address(0));
    vec3 wind = rotate(conjugate(frame_rotation), strand_wind(root.xyz, frame_root(root.xyz)));
    float strength = 1e4 * step_params.dt * step_params.dt, most = tressfx_params.most_move;
    if (dot(wind, wind) == 0.0) return;
    for (int j = 2; j < n - 1; ++j) {
        vec3 t = vertex_at(j + 1).x - vertex_at(j).x, blown = strength * cross(cross(t, wind), t);
        float square = dot(blown, blown);
        MOVE(j) += square > most * most ? blown * (most * inversesqrt(square)) : blown;
    }
}

void keep_edge(inout Vertex a, inout Vertex b, float rest_length, float share_a, float share_b)
{
    vec3 edge = b.x - a.x;
    vec3 excess = edge * (1.0 - rest_length / max(length(edge), 1e-9));
    add_move(a, share_a * excess);
    add_move(b, -share_b * excess);
}

// Corrects the even edges (0 1), (2 3) .. and the odd edges (1 2), (3 4) .. in one sweep: an odd
// edge follows as soon as the even edges on both sides are done. The head holds vertices 0 and 1.
void keep_lengths(Carried carried)
{
    Vertex b = first_vertex(carried); // end of the previous even edge
    for (int j = 2; j < n; j += 2) {
        Vertex c = vertex_at(j), d = vertex_at(min(j + 1, n - 1));
        if (j + 1 < n) keep_edge(c, d, REST(min(j + 1, n - 1)).w, 0.5, 0.5);
        keep_edge(b, c, REST(j).w, j > 2 ? 0.5 : 0.0, j > 2 ? 0.5 : 1.0);
        if (j > 2) MOVE(j - 1) = b.move;
        MOVE(j) = c.move;
        b = d;
    }
    if ((n & 1) == 0) MOVE(n - 1) = b.move;
}

#else

// A segment: r before the step, its change e, s = r + e, and its length. Before the step it may
// have been too short (`off`), because the head turned and took a share of the strand along.
struct Segment {
    vec3 r, e, s;
    float size, off;
};

Segment segment_between(vec3 from, vec3 move, vec3 from_before, vec3 move_before, float l,
                        float longest)
{
    vec3 r = from - from_before, e = move - move_before, s = r + e;
    return Segment(r, e, s, length(s), relative_off(r, l, longest));
}

// The rows of J J^T lambda = |s| (|s| - l), eliminated from the root on.
struct Rows {
    vec3 from, move, s;     // the previous vertex, and the segment that ends there
    float per_pivot, right; // of the previous row
};

Rows open_rows(Carried carried)
{
    Vertex first = first_vertex(carried);
    return Rows(first.x - first.move, first.move, vec3(0.0), 0.0, 0.0);
}

// Eliminates the row of the segment that ends in vertex j, which has moved by `move`, and returns
// its right-hand side, which the caller stores in the fourth component of `positions`. Stores the
// elimination factor in that of `velocities`.
float add_row(inout Rows rows, int j, vec3 move, float longest)
{
    vec3 from = FROM(j);
    float l = REST(j).w;
    Segment segment = segment_between(from, move, rows.from, rows.move, l, longest);
    float longer = relative_longer(segment.r, segment.e, l, segment.size, segment.off);
    float square = dot(segment.s, segment.s), off = -dot(segment.s, rows.s);
    float diagonal = j == 2 ? square : 2.0 * square, factor = off * rows.per_pivot;
    float pivot = max(diagonal - off * factor, 1e-6 * diagonal);
    float per_pivot = pivot > 1e-30 ? 1.0 / pivot : 0.0;
    float right = (segment.size * longer - off * rows.right) * per_pivot;
    velocities[address(j)].w = factor;
    rows = Rows(from, move, segment.s, per_pivot, right);
    return right;
}

// From the tip on: solves for lambda of each segment and at the same time eliminates the row of (I
// + K) y = x, for the displacements: with y = from + m, (I + K) m = x - from - K from. The diagonal
// is summed like a ladder of resistors with one resistor to ground at each vertex, own_j = 1 +
// own_{j+1} lambda_{j+1}/(own_{j+1} + lambda_{j+1}), which needs no subtraction. Stores m_j = xyz +
// w m_{j-1}.
void pull_together(Carried carried)
{
    float lambda = 0.0, factor = 0.0, own = 0.0, share = 0.0;
    Vertex first = first_vertex(carried);
    vec3 move = MOVE(n - 1), from = FROM(n - 1), kept = vec3(0.0), pushed = vec3(0.0);
    for (int j = n - 1; j >= 2; --j) {
        int a = address(j);
        lambda = positions[a].w - factor * lambda;
        vec3 next_move = j > 2 ? MOVE(j - 1) : first.move,
             next_from = j > 2 ? FROM(j - 1) : first.x - first.move;
        float tension = max(lambda, 0.0);
        vec3 r = from - next_from, push = lambda * r + (lambda - tension) * (move - next_move);
        kept = move - push + pushed + share * kept;
        own = 1.0 + share * own;
        float per_pivot = 1.0 / (own + tension);
        share = tension * per_pivot;
        positions[a] = vec4(per_pivot * kept, share);
        factor = velocities[a].w, move = next_move, from = next_from, pushed = push;
    }
}

void keep_lengths(Carried carried)
{
    float longest = strand_root(address(0)).w;
    Rows rows = open_rows(carried);
    for (int j = 2; j < n; ++j) positions[address(j)].w = add_row(rows, j, MOVE(j), longest);
    pull_together(carried);
    rows = open_rows(carried);
    for (int j = 2; j < n; ++j) {
        vec4 pulled = positions[address(j)];
        vec3 move = pulled.xyz + pulled.w * rows.move;
        positions[address(j)] = vec4(move, add_row(rows, j, move, longest));
    }
    pull_together(carried);
}

#endif

// Sets lengths and velocities and transforms back to the world.
void finish(Carried carried)
{
    vec4 to_world = frame_rotation;
    float dt = step_params.dt, most = tressfx_params.most_move;
    Vertex first = first_vertex(carried);
    vec3 moved = first.move, world = rotate(to_world, first.x);
#if !TRESSFX4
    float longest = strand_root(address(0)).w;
    vec3 from_before = first.x - first.move, move_before = first.move;
#endif
    positions[address(0)] = vec4(carried.root.at, 0.0);
    velocities[address(0)] = vec4(0.0);
    positions[address(1)] = relative_store(world, carried.root);
    for (int j = 2; j < n; ++j) {
        int a = address(j);
        vec4 now = positions[a];
        vec3 from = velocities[a].xyz;
#if TRESSFX4
        moved = now.xyz;
        world = rotate(to_world, from + moved);
#else
        vec4 style = REST(j);
        float l = style.w;
        vec3 move = now.xyz + now.w * move_before;
        Segment segment = segment_between(from, move, from_before, move_before, l, longest);
        vec3 along = unit(segment.s, style.xyz);
        moved += relative_turn(segment.r, segment.e, l, segment.size, segment.off, along);
        // Summing rotated segments; rotating the sum would cause rounding errors larger than a
        // short segment permits.
        world += l * rotate(to_world, along);
        from_before = from, move_before = move;
#endif
        float square = dot(moved, moved), limit = most * most;
#if TRESSFX4
        float kept = square > limit ? limit / square : 1.0;
#else
        float kept = square > limit ? most * inversesqrt(square) : 1.0;
#endif
        velocities[a] = vec4(rotate(to_world, moved * (kept / dt)), 0.0);
        positions[a] = relative_store(world, carried.root);
    }
}

void main()
{
    strand = first_strand();
    if (strand >= int(step_params.strand_count)) return;
    n = int(step_params.vertex_count);
    open_frame(strand);
    mean_shares = pass_shares(tressfx_params.local_share);
    Carried carried = carried_by_head();
    carry_lead(address(0));
    predict(carried);
    int local_passes = n > 2 ? tressfx_params.local_passes : 0;
    for (int i = 0; i < local_passes; ++i) keep_local_shape(carried);
#if TRESSFX4
    blow();
    int length_passes = tressfx_params.length_passes;
    for (int i = 0; i < length_passes; ++i) keep_lengths(carried);
#else
    keep_lengths(carried);
#endif
    // TressFX pushes vertices out of capsules at this point; here the collision pass does.
    finish(carried);
}
