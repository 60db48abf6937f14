// SPDX-License-Identifier: MIT
// The published rules of `split`, kept for comparison (see split.comp). The root pulls the strand
// through the world without inertia, as through honey.
//   THESIS 0 (dragged): the tip flies like a mass on a string, pushed along the chord instead of
// the arc.
//   THESIS 1 (thesis): the tip flies straight; its velocity is that of its displacement by one
// round of pulls.

vec3 fly(inout Strand strand)
{
    vec3 target = strand.position + strand.velocity * step_params.dt;
#if THESIS
    return target;
#else
    return land(strand, target, target - strand.root);
#endif
}

vec3 drag_of(Strand strand) { return strand.root - strand.root_old; }

void settle(inout Strand strand, vec3 end)
{
#if THESIS
    strand.velocity = (end - strand.position) / step_params.dt;
    strand.position = end;
#else
    strand.position += strand.velocity * step_params.dt;
#endif
}
