// SPDX-License-Identifier: MIT
// A symmetric tridiagonal system with rows off_k u_{k-1} + diag_k u_k + off_{k+1} u_{k+1} =
// right_k, solved without arrays of its own (Thomas 1949). Rows are eliminated as they come; then
// the unknowns follow in the opposite order:
//
//     factor_k = off_k / pivot_{k-1},   pivot_k = diag_k - off_k factor_k,
//     value_k = (right_k - off_k value_{k-1}) / pivot_k
//     u_{k-1} = value_{k-1} - factor_k u_k
//
// Only value_k and factor_k must be stored. The elimination may start at either end. All matrices
// here are positive definite, so no pivoting is needed.

// The smallest pivot. It keeps the result of a broken segment (length 0, NaN) finite; the segment's
// wrong length is detected later.
const float LEAST_PIVOT = 1e-30;

struct Row {
    float inverse; // 1 / pivot
    float value;
};

struct Row3 { // for three right-hand sides
    float inverse;
    vec3 value;
};

const Row NO_ROW = Row(0.0, 0.0);
const Row3 NO_ROW3 = Row3(0.0, vec3(0.0));

// `factor` is for back-substitution: the unknown of `before` is its value minus factor times the
// unknown of this row.
Row eliminate(Row before, float off, float diagonal, float right, out float factor)
{
    factor = off * before.inverse;
    float inverse = 1.0 / max(diagonal - off * factor, LEAST_PIVOT);
    return Row(inverse, (right - off * before.value) * inverse);
}

Row3 eliminate(Row3 before, float off, float diagonal, vec3 right, out float factor)
{
    factor = off * before.inverse;
    float inverse = 1.0 / max(diagonal - off * factor, LEAST_PIVOT);
    return Row3(inverse, (right - off * before.value) * inverse);
}
