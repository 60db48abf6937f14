// SPDX-License-Identifier: MIT
// The published rules of `split`, kept for comparison (see split.comp). The root pulls the strand
// through the world without inertia, as through honey.
//   THESIS 0 (dragged): the tip flies like a mass on a string, pushed along the chord instead of
// the arc.
//   THESIS 1 (thesis): the tip flies straight; its velocity is that of its displacement by one
// round of pulls.

vec3 fly(inout Strand strand)
{
    vec3 flown = strand.velocity * step_params.dt - strand.moved;
#if THESIS
    return strand.position + flown;
#else
    return land(strand, flown);
#endif
}

vec3 drag_of(Strand strand) { return strand.moved; }

void settle(inout Strand strand, vec3 target, vec3 end)
{
#if THESIS
    strand.velocity = (end - strand.position + strand.moved) / step_params.dt;
    strand.position = end;
#else
    strand.position = target;
#endif
}
