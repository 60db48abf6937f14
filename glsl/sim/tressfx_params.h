// SPDX-License-Identifier: MIT
// Parameters of tressfx.comp.
#include "common/shared.h"

UNIFORM_BLOCK(TressfxParams, tressfx_params, BIND_SOLVER)
{
    float local_share;     // of a gap, that a local pass moves either end of a segment by; steady:
                           // in each of two passes a frame
    float local_times;     // steady: stiffness of a pass, relative to one of two passes a frame
    float local_most;      // steady: greatest share of a pass
    float global_share;    // of the way to the style
    float global_range;    // share of the vertices, from the root, that go there
    float shock;           // share of the root's motion that moves the whole strand
    float shock_threshold; // m: second difference of vertex 1 over steps, beyond which all moves
    float most_move;       // m a step that become velocity
    float exchanged;       // steady: share of what damps a joint critically that is exchanged
    int local_passes;
    int length_passes; // TRESSFX4
}
END_BLOCK(TressfxParams, tressfx_params);
