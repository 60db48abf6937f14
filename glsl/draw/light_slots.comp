// SPDX-License-Identifier: MIT
// Gives slots to the marked cells of the light grid, then to the cells next to them, which
// interpolation between cells reads, and to cells next to the mesh, which reflects light there.
//   BESIDE 0: marks become slots   1: cells next to cells with slots get slots   2: slots get the
//       numbers of their cells
#include "draw/light.h"
#include "draw/light.glsl"
#include "draw/light_walls.glsl"

layout(local_size_x = GROUP_SIZE) in;
#include "common/lane.glsl"
layout(std430, binding = BIND_LIGHT_SLOTS_OUT) buffer Slots
{
    int slots[];
}; // 1: marked; -1: no slot
layout(std430, binding = BIND_LIGHT_STATE_OUT) buffer State { LightState state; };
#if BESIDE == 2
layout(std430, binding = BIND_LIGHT_CELLS_OUT) buffer Cells { LightCell cell[]; };
#endif

void main()
{
    int at = lane_index();
    if (at >= int(light_params.count.w)) return;
    int slot = slots[at];
#if BESIDE == 0
    slots[at] = slot == 1 ? int(atomicAdd(state.filled, 1u)) : -1;
#elif BESIDE == 1
    // Other lanes give out slots meanwhile; those are behind the slots with hair.
    int filled = int(state.filled);
    if (slot >= 0) return;
    ivec3 place = cell_place(at);
    bool beside = light_params.walled != 0u && is_beside_mesh(place);
    for (int q = 0; q < 27; ++q) {
        ivec3 near = place + ivec3(q % 3, q / 3 % 3, q / 9) - 1;
        if (!cell_inside(near)) continue;
        int other = slots[cell_address(near)];
        beside = beside || (other >= 0 && other < filled);
    }
    if (beside) slots[at] = filled + int(atomicAdd(state.beside, 1u));
#else
    if (slot >= 0) cell[slot].places.x = at;
#endif
}
