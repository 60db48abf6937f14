// SPDX-License-Identifier: MIT
#include "draw/scatter_tables.h"
#include "gpu/gpu.h"

#include "glsl/draw/draw.h"

#include <stdlib.h>

enum { GROUP_SIZE = 32, COLORS_EACH = 4 };
_Static_assert(SCATTER_COLORS % COLORS_EACH == 0, "scatter.comp makes so many at a time");

static GLuint create_texture(void)
{
    GLuint texture;
    glGenTextures(1, &texture);
    glActiveTexture(GL_TEXTURE0 + BIND_SCATTER);
    glBindTexture(GL_TEXTURE_3D, texture);
    glTexStorage3D(GL_TEXTURE_3D, 1, GL_RGBA16F, SCATTER_AZIMUTHS, SCATTER_INCLINATIONS,
                   SCATTER_COLORS);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_WRAP_R, GL_CLAMP_TO_EDGE);
    return texture;
}

static void fill(GLuint program, const ScatterTable *table)
{
    glBindImageTexture(0, table->texture, 0, GL_TRUE, 0, GL_WRITE_ONLY, GL_RGBA16F);
    glUseProgram(program);
    glUniform2f(0, table->refraction, table->roughness);
    glDispatchCompute((SCATTER_AZIMUTHS + GROUP_SIZE - 1) / GROUP_SIZE, SCATTER_INCLINATIONS,
                      SCATTER_COLORS / COLORS_EACH);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
}

static Result add(ScatterTables *tables, float refraction, float roughness, Error *error)
{
    const ShaderDefine defines[] = {{"GROUP_SIZE", GROUP_SIZE}, {NULL, 0}};
    if (!tables->program) {
        TRY(shader_build_compute(&tables->program, "draw/scatter.comp", defines, error));
    }
    ScatterTable *more = realloc(tables->tables, (tables->count + 1) * sizeof *more);
    if (!more) return error_set(error, RESULT_FAILED, "no memory for a table of marschner shading");
    tables->tables = more;
    ScatterTable *table = &tables->tables[tables->count++];
    *table = (ScatterTable){refraction, roughness, NULL, create_texture()};
    fill(tables->program, table);
    return gpu_check("the table of marschner shading", error);
}

Result scatter_tables_find(ScatterTables *tables, float refraction, float roughness,
                           GLuint *texture, Error *error)
{
    for (uint32_t i = 0; i < tables->count; ++i) {
        *texture = tables->tables[i].texture;
        if (tables->tables[i].refraction == refraction && tables->tables[i].roughness == roughness)
            return RESULT_OK;
    }
    TRY(add(tables, refraction, roughness, error));
    *texture = tables->tables[tables->count - 1].texture;
    return RESULT_OK;
}

Result scatter_tables_read(ScatterTables *tables, GLuint texture, FibreTable *table, Error *error)
{
    const size_t count = (size_t)SCATTER_AZIMUTHS * SCATTER_INCLINATIONS * SCATTER_COLORS;
    ScatterTable *mine = tables->tables;
    while (mine->texture != texture) ++mine;
    if (!mine->values) {
        mine->values = malloc(count * sizeof *mine->values);
        if (!mine->values)
            return error_set(error, RESULT_FAILED, "no memory for a table of marschner shading");
        glActiveTexture(GL_TEXTURE0 + BIND_SCATTER);
        glBindTexture(GL_TEXTURE_3D, texture);
        glGetTexImage(GL_TEXTURE_3D, 0, GL_RGBA, GL_FLOAT, mine->values);
    }
    table->values = (const float(*)[4])mine->values;
    return gpu_check("the table of marschner shading", error);
}

void scatter_tables_destroy(ScatterTables *tables)
{
    for (uint32_t i = 0; i < tables->count; ++i) free(tables->tables[i].values);
    for (uint32_t i = 0; i < tables->count; ++i) glDeleteTextures(1, &tables->tables[i].texture);
    free(tables->tables);
    if (tables->program) glDeleteProgram(tables->program);
    *tables = (ScatterTables){0};
}
