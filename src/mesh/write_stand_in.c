// SPDX-License-Identifier: MIT
// A build tool that writes STAND_IN_TABLE (mesh/stand_in.h) as C to standard output.
#include "mesh/head.h"
#include "mesh/stand_in.h"

#include <math.h>
#include <stdio.h>

int main(void)
{
    Mesh mesh = {0};
    Error error;
    if (head_make_mesh(&mesh, STAND_IN_TRIANGLES, &error) != RESULT_OK) {
        fprintf(stderr, "write_stand_in: %s\n", error.text);
        return 1;
    }
    printf("#include \"mesh/stand_in.h\"\nstatic const int16_t POSITIONS[][3] = {\n");
    for (uint32_t v = 0; v < mesh.vertex_count; v++) {
        const float *p = mesh.position[v];
        printf("{%ld, %ld, %ld},\n", lround((double)p[0] / HEAD_UNIT),
               lround((double)p[1] / HEAD_UNIT), lround((double)p[2] / HEAD_UNIT));
    }
    printf("};\nstatic const uint16_t TRIANGLES[][3] = {\n");
    for (uint32_t t = 0; t < mesh.triangle_count; t++)
        printf("{%u, %u, %u},\n", mesh.triangle[t][0], mesh.triangle[t][1], mesh.triangle[t][2]);
    printf("};\nconst StandInTable STAND_IN_TABLE = {%u, %u, POSITIONS, TRIANGLES};\n",
           mesh.vertex_count, mesh.triangle_count);
    mesh_destroy(&mesh);
    return fflush(stdout) != 0 || ferror(stdout);
}
