// SPDX-License-Identifier: MIT
#include "draw/render_hair.h"

#include "glsl/draw/draw.h"

// Particles that are projected at a time, so that what is kept of them stays small.
enum { GROUP_SIZE = 8, PART_PARTICLES = 1 << 19 };

Result render_hair_create(RenderHair *hair, bool nearest, Error *error)
{
    const ShaderDefine defines[] = {{"NEAREST", nearest}, {NULL, 0}};
    *hair = (RenderHair){.project = {.file = "draw/hair_project.comp", .group_size = GROUP_SIZE}};
    glGenVertexArrays(1, &hair->vertex_array);
    Result result =
        shader_build_draw(&hair->draw, "draw/hair.vert", "draw/hair.frag", defines, error);
    if (result != RESULT_OK) render_hair_destroy(hair);
    return result;
}

void render_hair_destroy(RenderHair *hair)
{
    look_programs_destroy(&hair->project);
    if (hair->draw) glDeleteProgram(hair->draw);
    if (hair->vertex_array) glDeleteVertexArrays(1, &hair->vertex_array);
    gpu_buffer_destroy(&hair->edges);
    gpu_buffer_destroy(&hair->shades);
    gpu_buffer_destroy(&hair->indices);
    gpu_buffer_destroy(&hair->command);
    gpu_buffer_destroy(&hair->material);
    *hair = (RenderHair){0};
}

static Result make_room(GpuBuffer *buffer, const GpuLimits *limits, const char *what, int64_t size,
                        GLenum format, Error *error)
{
    if (buffer->size >= size) return RESULT_OK;
    gpu_buffer_destroy(buffer);
    return gpu_buffer_create(buffer, limits, what, size, NULL, format, error);
}

static Result make_scratch(RenderHair *hair, uint32_t strands, uint32_t vertex_count,
                           const GpuLimits *limits, Error *error)
{
    int64_t particles = (int64_t)strands * vertex_count, segments = particles - strands;
    Result result =
        make_room(&hair->edges, limits, "hair edges", particles * 16, GL_RGBA32UI, error);
    if (result == RESULT_OK)
        result =
            make_room(&hair->shades, limits, "hair shades", particles * 16, GL_RGBA32UI, error);
    if (result == RESULT_OK)
        result = make_room(&hair->indices, limits, "hair triangles", segments * 24, 0, error);
    if (result == RESULT_OK)
        result = make_room(&hair->command, limits, "draw command", COMMAND_WORDS * 4, 0, error);
    return result;
}

static void write(const GpuBuffer *buffer, int64_t at, const void *data, size_t size)
{
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer->buffer);
    glBufferSubData(GL_SHADER_STORAGE_BUFFER, (GLintptr)at, (GLsizeiptr)size, data);
}

// How many strands are projected goes to *strands.
static Result project(RenderHair *hair, const HairBatch *batch, const Look *look, RenderCull *cull,
                      uint32_t *strands, Error *error)
{
    const MaterialParams *material = &look->material;
    const GLuint command[COMMAND_WORDS] = {[COMMAND_INSTANCE_COUNT] = 1};
    *strands = material->drawn_strands;
    gpu_buffer_set_uniforms(&hair->material, BIND_MATERIAL, material, sizeof *material);
    gpu_buffer_bind_texture(&batch->position, BIND_POSITION);
    Result result = RESULT_OK;
    if (cull->tries) result = render_cull_list(cull, batch, material, strands, error);
    if (result == RESULT_OK) result = look_programs_use(&hair->project, look, batch, error);
    if (result != RESULT_OK || *strands == 0) return result;
    glUniform2i(0, (GLint)*strands, cull->tries);
    write(&hair->command, 0, command, sizeof command);
    gpu_buffer_bind_texture(&batch->strand_id, BIND_STRAND_ID);
    gpu_buffer_bind_storage(&hair->edges, BIND_EDGES_OUT);
    gpu_buffer_bind_storage(&hair->shades, BIND_SHADES_OUT);
    gpu_buffer_bind_storage(&hair->indices, BIND_INDICES_OUT);
    gpu_buffer_bind_storage(&hair->command, BIND_COMMAND_OUT);
    glDispatchCompute((*strands + GROUP_SIZE - 1) / GROUP_SIZE, 1, 1);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_ELEMENT_ARRAY_BARRIER_BIT |
                    GL_COMMAND_BARRIER_BIT);
    return RESULT_OK;
}

static void draw_ribbons(RenderHair *hair)
{
    glUseProgram(hair->draw);
    glBindVertexArray(hair->vertex_array);
    gpu_buffer_bind_texture(&hair->edges, BIND_EDGES);
    gpu_buffer_bind_texture(&hair->shades, BIND_SHADES);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, hair->indices.buffer);
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, hair->command.buffer);
    glDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT, NULL);
    // The next part overwrites what this one's vertices read.
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT |
                    GL_BUFFER_UPDATE_BARRIER_BIT);
}

Result render_hair_draw(RenderHair *hair, const HairBatch *batch, const Look *look,
                        RenderCull *cull, const GpuLimits *limits, GpuTimer *timer, Error *error)
{
    Look part = *look;
    part.material = look_material(look, batch);
    uint32_t n = (batch->vertex_count - 1) * part.material.smooth_parts + 1,
             most = n < PART_PARTICLES ? PART_PARTICLES / n : 1,
             strands = part.material.drawn_strands;
    for (uint32_t first = 0; first < strands; first += most) {
        uint32_t left = strands - first, seen;
        part.material.first_strand = first;
        part.material.drawn_strands = left < most ? left : most;
        Result result = make_scratch(hair, part.material.drawn_strands, n, limits, error);
        if (result == RESULT_OK)
            result = render_cull_make_room(cull, limits, part.material.drawn_strands, error);
        gpu_timer_begin(timer, "draw_project");
        if (result == RESULT_OK) result = project(hair, batch, &part, cull, &seen, error);
        gpu_timer_end(timer);
        if (result != RESULT_OK) return result;
        if (seen == 0) continue;
        gpu_timer_begin(timer, "draw_hair");
        draw_ribbons(hair);
        gpu_timer_end(timer);
    }
    return RESULT_OK;
}
