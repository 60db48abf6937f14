// SPDX-License-Identifier: MIT
#include "draw/scatter_tables.h"
#include "gpu/gpu.h"
#include "gpu/shader.h"

#include "glsl/draw/draw.h"

#include <stdlib.h>
#include <string.h>

enum { GROUP_SIZE = 32, NODES = SCATTER_AZIMUTHS * SCATTER_INCLINATIONS * SCATTER_COLORS };
_Static_assert(SCATTER_COLORS % 4 == 0, "scatter.comp makes four at a time");

typedef struct Fibre {
    float refraction, roughness;
} Fibre;

struct ScatterTable {
    Fibre fibre;
    GLuint texture;
    bool is_read;
    float values[NODES][4]; // as the texture has them
};

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

static Result fill(GLuint texture, const Fibre *fibre, Error *error)
{
    const ShaderDefine defines[] = {{"GROUP_SIZE", GROUP_SIZE}, {NULL, 0}};
    GLuint program;
    TRY(shader_build_compute(&program, "draw/scatter.comp", defines, error));
    glBindImageTexture(0, texture, 0, GL_TRUE, 0, GL_WRITE_ONLY, GL_RGBA16F);
    glUseProgram(program);
    glUniform2f(0, fibre->refraction, fibre->roughness);
    glDispatchCompute((SCATTER_AZIMUTHS + GROUP_SIZE - 1) / GROUP_SIZE, SCATTER_INCLINATIONS, 1);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
    shader_release(program);
    return gpu_check("the table of marschner shading", error);
}

static void destroy_table(void *value)
{
    glDeleteTextures(1, &((ScatterTable *)value)->texture);
}

static Result fail_memory(Error *error)
{
    return error_set(error, RESULT_FAILED, "no memory for a table of marschner shading");
}

static Result make(ScatterTable **table, Stock *stock, const Fibre *fibre, Error *error)
{
    GLuint texture = create_texture();
    Result result = fill(texture, fibre, error);
    if (result == RESULT_OK) {
        *table = stock_add(stock, fibre, sizeof *fibre, sizeof **table, destroy_table);
        if (!*table) result = fail_memory(error);
    }
    if (result == RESULT_OK)
        (*table)->fibre = *fibre, (*table)->texture = texture;
    else
        glDeleteTextures(1, &texture);
    return result;
}

Result scatter_tables_find(ScatterTables *tables, float refraction, float roughness,
                           ScatterTable **table, Error *error)
{
    const Fibre fibre = {refraction, roughness};
    for (uint32_t i = 0; i < tables->count; ++i) {
        *table = tables->taken[i];
        if (memcmp(&(*table)->fibre, &fibre, sizeof fibre) == 0) return RESULT_OK;
    }
    ScatterTable **more = realloc(tables->taken, (tables->count + 1) * sizeof(ScatterTable *));
    if (!more) return fail_memory(error);
    tables->taken = more;
    *table = stock_take(tables->stock, &fibre, sizeof fibre);
    if (!*table) TRY(make(table, tables->stock, &fibre, error));
    tables->taken[tables->count++] = *table;
    return RESULT_OK;
}

void scatter_tables_destroy(ScatterTables *tables)
{
    for (uint32_t i = 0; i < tables->count; ++i) stock_return(tables->stock, tables->taken[i]);
    free(tables->taken);
    *tables = (ScatterTables){0};
}

unsigned scatter_table_texture(const ScatterTable *table)
{
    return table->texture;
}

Result scatter_table_read(ScatterTable *table, FibreTable *values, Error *error)
{
    if (!table->is_read) {
        glActiveTexture(GL_TEXTURE0 + BIND_SCATTER);
        glBindTexture(GL_TEXTURE_3D, table->texture);
        glGetTexImage(GL_TEXTURE_3D, 0, GL_RGBA, GL_FLOAT, table->values);
        TRY(gpu_check("the table of marschner shading", error));
        table->is_read = true;
    }
    values->values = (const float(*)[4])table->values;
    return RESULT_OK;
}
