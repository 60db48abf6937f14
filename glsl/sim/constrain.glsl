// SPDX-License-Identifier: MIT
// The end of a step, after midpoint.glsl has found the middle. Tractrices have moved the positions
// to x, which may differ from the targets p.
//
// Velocities: after another half kick, u = K(u) is projected orthogonally onto the velocities that
// the new shape, with unit directions d, permits. The impulses lambda solve J J^T lambda = J u,
//
//     -d_j.d_{j-1} lambda_{j-1} + 2 lambda_j - d_j.d_{j+1} lambda_{j+1} = d_j.(u_j - u_{j-1})
//     v_j = u_j - lambda_j d_j + lambda_{j+1} d_{j+1}    (1 lambda_1 in the first row),
//
// This removes the kinetic energy sum lambda_j (J u)_j / 2 = sum pivot value^2 / 2 and never adds
// any. (An oblique projection, such as velocity = displacement / dt after pulls along the strand,
// has a norm of 2.6 for 16 and 3.8 for 32 particles.)
//
// Energy: the tensions of the middle have second-order errors. So has x - p, along which gravity
// and springs do work. At long steps these errors could feed a motion without end. So if their sum
// is a gain, the velocities are scaled to pay for it:
//
//     |v|^2/2 <= |u|^2/2 - gained + sum (a + k (style - (x + p)/2)).(x - p)
//
// Everything is in the frame that moves with the root. Needs midpoint.glsl, tridiagonal.glsl.

struct Constraint {
    Row row;
    vec3 d_before, u_before, style;
    float kinetic; // twice the kinetic energy of the u so far
    float lost;    // twice the energy that the projection removes
    float worked;  // work of the forces from p to x
};

Constraint constrain_open(Strand strand)
{
    velocities[strand.address] = vec4(strand.root_velocity, 0.0);
    store_root(strand);
    return Constraint(NO_ROW, vec3(0.0), vec3(0.0), vec3(0.0), 0.0, 0.0, 0.0);
}

// From root to tip: adds segment j, which points along d and ends at x, relative to the root.
void constrain_add(inout Constraint p, Strand strand, int j, vec3 d, vec3 x)
{
    int a = strand.address + j * STRAND_TILE;
    vec3 aim = recall_aim(a, j),
         u = kicked(strand, j, recall_velocity(a, j).xyz + strand.root_velocity);
#if VARIES
    vec3 force = kick_at(j, vec3(0.0), strand.wind) / forces_along(j).y;
#else
    vec3 force = strand.push / step_params.gain;
#endif
#if STYLED
    p.style = next_style(p.style, fetch_rest(strand, j), strand.rotation);
    force += spring_of(strand, j).stiffness * (p.style - 0.5 * (x + aim));
#endif
    float factor, off = -dot(d, p.d_before), right = dot(d, u - p.u_before),
                  right_left = right - off * p.row.value;
    p.row = eliminate(p.row, off, j == 1 ? 1.0 : 2.0, right, factor);
    p.lost += p.row.value * right_left;
    p.kinetic += dot(u, u);
    p.worked += dot(force, x - aim);
    keep_velocity(a, j, vec4(u, factor));
    store_position(strand, a, x);
    keep(j, vec4(d, p.row.value));
    p.d_before = d, p.u_before = u;
}

// Rounding of a position, as a share of the strand's length.
const float ROUNDED = 6e-8;

// The factor of the velocities that pays for the energy gained in the step. The work that rounding
// seems to do is not gained: if each gain were paid and no loss came back, it would slow down hair
// in short steps.
float pay(Constraint p, Strand strand, float gained)
{
    float rounding =
        float(LAST) * ROUNDED * strand.total_length * length(strand.push) / step_params.gain;
    float has = p.kinetic - p.lost, may = p.kinetic + 2.0 * (p.worked - gained + rounding);
    return has > may ? sqrt(max(may, 0.0) / max(has, LEAST_PIVOT)) : 1.0; // never 0/0
}

// From tip to root: computes the impulses and the final velocities.
void constrain_finish(Constraint p, Strand strand, float gained)
{
    float lambda = 0.0, factor_beyond = 0.0, scale = pay(p, strand, gained);
    vec3 t_beyond = vec3(0.0);
    for (int j = LAST; j >= 1; --j) {
        int a = strand.address + j * STRAND_TILE;
        vec4 k = recall(j), u = recall_velocity(a, j);
        lambda = k.w - factor_beyond * lambda;
        factor_beyond = u.w;
        vec3 t = lambda * k.xyz;
        velocities[a] = vec4(strand.root_velocity + scale * (u.xyz - t + t_beyond), 0.0);
        t_beyond = t;
    }
}
