// SPDX-License-Identifier: MIT
// The linear system of a Newton round of `rod`, by elimination from tip to root.
//
// Unknowns of segment j: its turn w_j (rotation vector: across the segment it bends, along the
// segment it twists). Particle j then moves by dx_j = dx_{j-1} + w_j x e_j. What lies beyond is
// condensed into a quadratic form of dx_j and w_j, the front:
//     dx.A dx/2 + w.C^T dx + w.E w/2 - p.dx - s.w
// Joint j adds to it, and couples w_j with w_{j-1} by `G`. With K = A [.x e_j] + C, minimising over
// w_j gives H w_j = b - K^T dx_{j-1} - G w_{j-1}, which is kept as w_j = v - U dx_{j-1} - W
// w_{j-1}. Matrices are columns.

struct Front {
    mat3 A, C, E;
    vec3 p, s;
};

// The solution for a segment's turn.
struct Turn {
    mat3 U, W;
    vec3 v;
};

const mat3 ZERO3 = mat3(0.0);
Front front_open() { return Front(ZERO3, ZERO3, ZERO3, vec3(0.0), vec3(0.0)); }

mat3 diagonal(float a) { return mat3(a, 0.0, 0.0, 0.0, a, 0.0, 0.0, 0.0, a); }

// The linear map w -> M (w x e).
mat3 after_turn(mat3 M, vec3 e)
{
    return mat3(e.y * M[2] - e.z * M[1], e.z * M[0] - e.x * M[2], e.x * M[1] - e.y * M[0]);
}

// Columns e x M_i: the transpose of [. x e] applied to M.
mat3 moment_of(vec3 e, mat3 M) { return mat3(cross(e, M[0]), cross(e, M[1]), cross(e, M[2])); }

// The inverse of a symmetric positive matrix.
mat3 inverse_symmetric(mat3 M)
{
    vec3 c0 = cross(M[1], M[2]);
    float inverse_det = 1.0 / max(dot(M[0], c0), 1e-37);
    vec3 c1 = cross(M[2], M[0]), c2 = cross(M[0], M[1]);
    return mat3(c0, c1, c2) * inverse_det; // symmetric, so rows are columns
}

// Whether a symmetric matrix is positive, by its minors.
bool is_positive(mat3 M)
{
    const float LEAST = 1e-5; // of the trace: what rounding leaves uncertain
    float minor = M[0].x * M[1].y - M[0].y * M[1].x, det = dot(M[0], cross(M[1], M[2])),
          trace = M[0].x + M[1].y + M[2].z;
    return M[0].x > 0.0 && minor > 0.0 && det > LEAST * trace * minor;
}

// Eliminates w_j; the front becomes that of segment j - 1. `e`: the segment; `G`: the coupling of
// w_j (rows) and w_{j-1} (columns); `E_before`: the joint's own part of w_{j-1}.
// `stiffness` is added to a matrix that is not positive.
Turn front_eliminate(inout Front f, vec3 e, mat3 G, mat3 E_before, float stiffness)
{
    mat3 K = after_turn(f.A, e) + f.C, Ce = moment_of(e, f.C);
    mat3 H = f.E + moment_of(e, K) + transpose(Ce);
    if (!is_positive(H)) H += diagonal(stiffness);
    if (!is_positive(H)) H = diagonal(abs(H[0].x) + abs(H[1].y) + abs(H[2].z) + stiffness);
    vec3 b = cross(e, f.p) + f.s;
    mat3 inverse_H = inverse_symmetric(H);
    Turn turn;
    turn.U = inverse_H * transpose(K);
    turn.W = inverse_H * G;
    turn.v = inverse_H * b;
    f.A -= K * turn.U;
    f.C = -(K * turn.W);
    f.E = E_before - transpose(G) * turn.W;
    f.p -= K * turn.v;
    f.s = -(turn.v * G);
    return turn;
}
