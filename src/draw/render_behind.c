// SPDX-License-Identifier: MIT
#include "draw/render_behind.h"

#include <stdlib.h>

static int clamp(int x, int most)
{
    return x < 0 ? 0 : x > most ? most : x;
}

// The part of the box that lies in the picture.
static BlockBase find_part(const RenderTarget *target, const int box[4])
{
    int width = target->width * target->samples, height = target->height * target->samples,
        x = clamp(box[0], width), y = clamp(box[1], height),
        right = clamp(box[2] < width ? box[2] + 1 : width, width),
        bottom = clamp(box[3] < height ? box[3] + 1 : height, height);
    return (BlockBase){
        .x = x, .y = y, .width = right > x ? right - x : 0, .height = bottom > y ? bottom - y : 0};
}

static Result make_room(RenderBehind *behind, size_t count, Error *error)
{
    if (behind->room >= count) return RESULT_OK;
    render_behind_destroy(behind);
    behind->light = malloc(count * sizeof *behind->light);
    behind->depth = malloc(count * sizeof *behind->depth);
    if (behind->light && behind->depth) {
        behind->room = count;
        return RESULT_OK;
    }
    render_behind_destroy(behind);
    return error_set(error, RESULT_FAILED, "no memory to read %zu px of mesh and floor", count);
}

Result render_behind_read(RenderBehind *behind, const RenderTarget *target, const int box[4],
                          uint64_t version, Error *error)
{
    if (behind->version == version) return RESULT_OK;
    BlockBase part = find_part(target, box);
    Result result = make_room(behind, (size_t)part.width * (size_t)part.height, error);
    if (result != RESULT_OK) return result;
    part.light = (const uint16_t(*)[4])(void *)behind->light;
    part.depth = behind->depth;
    glBindFramebuffer(GL_READ_FRAMEBUFFER, target->base_frame);
    glReadPixels(part.x, part.y, part.width, part.height, GL_RGBA, GL_HALF_FLOAT, behind->light);
    glReadPixels(part.x, part.y, part.width, part.height, GL_DEPTH_COMPONENT, GL_FLOAT,
                 behind->depth);
    behind->base = part;
    result = gpu_check("reading mesh and floor back", error);
    behind->version = result == RESULT_OK ? version : 0;
    return result;
}

void render_behind_destroy(RenderBehind *behind)
{
    free(behind->light);
    free(behind->depth);
    *behind = (RenderBehind){0};
}
