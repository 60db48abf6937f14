// SPDX-License-Identifier: MIT
// The main function of solvers with memory of a lane (keep.glsl, rod_keep.glsl): a lane calls
// step_strand for each of its strands.
void main()
{
    int s = first_strand(), count = int(step_params.strand_count);
    keep_open();
    for (int i = 0; i < STRANDS && s < count; ++i, s += GROUP_SIZE) step_strand(s);
}
