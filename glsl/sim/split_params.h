// SPDX-License-Identifier: MIT
// Parameters of split.comp.
#include "common/shared.h"

UNIFORM_BLOCK(SplitParams, split_params, BIND_SOLVER)
{
    int pulls; // along the strand in a step: two a round, there and back
}
END_BLOCK(SplitParams, split_params);
