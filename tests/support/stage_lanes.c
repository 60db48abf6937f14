// SPDX-License-Identifier: MIT
// The functions of a stage that read the state of the blocks backend. They are in a file of their
// own, because some of its names occur in src/passes, too.
#include "lanes/lanes.h"
#include "lanes/light_grid_onto.h"
#include "lanes/light_grid_show.h"
#include "support/stage.h"

struct Lanes *stage_lanes(void)
{
    assert_ptr_equal(studio.renderer.backend, &DRAW_LANES);
    return studio.renderer.state;
}

uint64_t stage_lanes_base_version(void)
{
    return stage_lanes()->base.version;
}

void stage_lanes_draw_hidden(bool on)
{
    stage_lanes()->draws_hidden = on;
}

const float (*stage_lanes_onto(void))[ONTO_FACES][4]
{
    const LightGrid *grid = &stage_lanes()->scatter.grid;
    return light_grid_lights_skin(grid) ? (const float(*)[ONTO_FACES][4])grid->state->onto : NULL;
}

size_t stage_lanes_cells(void)
{
    return light_lattice_cells(&stage_lanes()->scatter.grid.state->field.lattice);
}

void stage_lanes_show(uint32_t item, const float x[3][STRAND_TILE],
                      const float tangent[3][STRAND_TILE], float seen[3][STRAND_TILE])
{
    const struct Lanes *lanes = stage_lanes();
    light_grid_show(&lanes->scatter.grid, lanes->scatter.hair[item].kind, x, tangent, STRAND_TILE,
                    seen);
}
