// SPDX-License-Identifier: MIT
#include "draw/fibre_kinds.h"

static int find(const FibreKinds *kinds, const Look *look)
{
    int kind = 0;
    while (kind < kinds->count &&
           (kinds->table[kind].values != look->table.values ||
            !fibre_lobes_match(&kinds->lobes[kind], &look->material, look->mean_color)))
        ++kind;
    return kind;
}

bool fibre_kinds_know(const FibreKinds *kinds, const Look *look)
{
    return find(kinds, look) < kinds->count;
}

Result fibre_kinds_find(FibreKinds *kinds, const Look *look, int *kind, Error *error)
{
    *kind = find(kinds, look);
    if (*kind < kinds->count) return RESULT_OK;
    if (*kind == LIGHT_GRID_KINDS) {
        --*kind;
        return RESULT_OK;
    }
    if (!fibre_lobes_create(&kinds->lobes[*kind], look->table, &look->material, look->mean_color))
        return error_set(error, RESULT_FAILED, "no memory for a table of marschner shading");
    kinds->table[*kind] = look->table;
    ++kinds->count;
    return RESULT_OK;
}

void fibre_kinds_destroy(FibreKinds *kinds)
{
    for (int k = 0; k < kinds->count; ++k) fibre_lobes_destroy(&kinds->lobes[k]);
    *kinds = (FibreKinds){0};
}
