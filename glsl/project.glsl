// SPDX-License-Identifier: MIT
// Velocities of a strand of rigid segments, projected orthogonally on those that its shape allows: with unit directions d_j and wanted
// velocities u_j (the root's prescribed), the impulses lambda solve J J^T lambda = J u,
//
//     -d_j.d_{j-1} lambda_{j-1} + 2 lambda_j - d_j.d_{j+1} lambda_{j+1} = d_j.(u_j - u_{j-1})    (1 lambda_1 in the first row)
//     v_j = u_j - lambda_j d_j + lambda_{j+1} d_{j+1},
//
// which never adds energy. Where an oblique projection stands in its place (velocity = displacement / dt after pulls along the strand),
// the norm of one step's map is 2.6 for 16 and 3.8 for 32 particles, and hair gains energy from nothing.
//
// Which velocities are wanted: the kicked ones converge with dt, but are stable only while
//     sigma = dt (n - 1) sqrt(g / length)
// is below about 1.6; a share of those that the strand really had, (x - q)/dt, calms it. That share must be small: it makes the
// projection oblique again, and a strand that is all realised gains energy at every step. The one used was found by trial (a minute
// without drag, n = 4 .. 64, 30 to 240 Hz): min(0.1 (sigma - 1.2), 0.07 + 0.01 sigma), at least 0.
// Needs lane.glsl, tridiagonal.glsl, and keep, recall for a vec4 a particle.
const float SIGMA_KICKED = 1.2; // up to here none is realised

struct Projection {
    Row row;
    vec3 d_before, u_before;
    float realised; // share of the realised velocity
};

Projection project_open(Lane lane)
{
    float g = length(lane.push) / step_params.gain;
    float sigma = lane.dt * float(step_params.vertex_count - 1u) * sqrt(g / lane.length);
    float share = clamp(0.1 * (sigma - SIGMA_KICKED), 0.0, min(0.07 + 0.01 * sigma, 1.0));
    vec3 root_velocity = (lane.root - lane.root_old) / lane.dt;
    velocities[lane.address] = vec4(root_velocity, 0.0);
    positions[lane.address] = vec4(lane.root, 1.0);
    return Projection(NO_ROW, vec3(0.0), root_velocity, share);
}

// Root to tip: segment j points along d and ends at x (relative to the root), from q, where its kick wanted to take it by `move`. The
// velocity is stored first: a fetch of q may be delayed up to its use.
void project_add(inout Projection p, Lane lane, int j, vec3 d, vec3 x, vec3 q, vec3 move)
{
    int a = lane.address + j * STRAND_TILE;
    vec3 u = mix(move, x - (q - lane.root), p.realised) / lane.dt;
    float factor;
    p.row = eliminate(p.row, -dot(d, p.d_before), j == 1 ? 1.0 : 2.0, dot(d, u - p.u_before), factor);
    velocities[a] = vec4(u, factor);
    positions[a] = vec4(lane.root + x, 1.0);
    keep(j, vec4(d, p.row.value));
    p.d_before = d, p.u_before = u;
}

// Tip to root: the impulses, and the velocities that they leave.
void project_finish(Lane lane)
{
    float lambda = 0.0, factor_beyond = 0.0;
    vec3 t_beyond = vec3(0.0);
    for (int j = LAST; j >= 1; --j) {
        int a = lane.address + j * STRAND_TILE;
        vec4 k = recall(j), wanted = velocities[a];
        lambda = k.w - factor_beyond * lambda;
        factor_beyond = wanted.w;
        vec3 t = lambda * k.xyz;
        velocities[a] = vec4(wanted.xyz - t + t_beyond, 0.0);
        t_beyond = t;
    }
}
