// SPDX-License-Identifier: MIT
// A symmetric tridiagonal system, row k: off_k u_{k-1} + diag_k u_k + off_{k+1} u_{k+1} = right_k,
// solved without arrays of its own (Thomas 1949): rows are eliminated as they come, then the
// unknowns follow in the opposite order,
//
//     factor_k = off_k / pivot_{k-1},   pivot_k = diag_k - off_k factor_k,
//     value_k = (right_k - off_k value_{k-1}) / pivot_k
//     u_{k-1} = value_{k-1} - factor_k u_k
//
// so that only value_k and factor_k must be kept. Either end may come first. Matrices here are
// positive definite: no pivoting.

// The least pivot: what a broken segment (length 0, NaN) leaves stays finite, and is found by its
// length afterwards.
const float LEAST_PIVOT = 1e-30;

struct Row {
    float inverse; // of the pivot
    float value;
};

struct Row3 { // three right sides
    float inverse;
    vec3 value;
};

const Row NO_ROW = Row(0.0, 0.0);
const Row3 NO_ROW3 = Row3(0.0, vec3(0.0));

// `factor` becomes what back-substitution needs: u of `before` is its value less factor times u of
// this row.
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
