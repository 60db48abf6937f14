// SPDX-License-Identifier: MIT
// The published rules of `split`, kept to compare with (see split.comp): the root pulls the strand
// through the world, as through honey.
//   THESIS 0 (dragged): the tip flies as a mass on a string, pushed along the chord, not the arc.
//   THESIS 1 (thesis): the tip flies straight, and its velocity is what one round of pulls leaves.

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
