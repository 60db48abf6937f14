// SPDX-License-Identifier: MIT
#include "draw/renderer_options.h"

#include <string.h>

RendererOptions renderer_options_of(const RunParams *run)
{
    RendererOptions options = {.raster = (Raster)run->raster,
                               .oit = (Oit)run->oit,
                               .oit_layers = run->oit_layers,
                               .least_seen = run->least_seen,
                               .ribbon_length = run->ribbon_length,
                               .width = run->size[0],
                               .height = run->size[1],
                               .samples = run->samples,
                               .seed = run->seed,
                               .lod = {run->lod_start, run->lod_end, run->lod_min, run->lod_width},
                               .scatter = {.kind = (Scatter)run->scatter,
                                           .cells = run->scatter_cells,
                                           .orders = run->scatter_orders,
                                           .strands = (uint32_t)run->scatter_strands},
                               .shadow = {.kind = (Shadow)run->shadow,
                                          .side = run->shadow_size,
                                          .spacing = run->shadow_spacing,
                                          .strands = run->shadow_strands}};
    memcpy(options.background, run->background, sizeof options.background);
    options.backdrop = *run->environment && run->environment_background;
    if (options.backdrop) options.background[3] = 1;
    return options;
}

int renderer_options_channels(const RunParams *run)
{
    return run->aov == AOV_NONE && renderer_options_of(run).background[3] < 1 ? 4 : 3;
}
