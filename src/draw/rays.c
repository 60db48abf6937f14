// SPDX-License-Identifier: MIT
#include "draw/rays.h"

// At the eye, clip x, y and w are 0, so a point at the offset q from the eye has the clip
// coordinates (a q, b q, c q) with the rows a, b, c of the matrix. For w = 1 they are x, y and 1;
// Cramer's rule gives q.
Rays rays_find(const DrawParams *draw)
{
    double row[3][3], cross[3][3], det = 0; // cross[k]: cross product of the other two rows
    const int rows[3] = {0, 1, 3};
    Rays rays;
    for (int k = 0; k < 3; ++k)
        for (int c = 0; c < 3; ++c) row[k][c] = (double)draw->clip_from_world[c][rows[k]];
    for (int k = 0; k < 3; ++k)
        for (int c = 0; c < 3; ++c) {
            const double *a = row[(k + 1) % 3], *b = row[(k + 2) % 3];
            cross[k][c] = a[(c + 1) % 3] * b[(c + 2) % 3] - a[(c + 2) % 3] * b[(c + 1) % 3];
        }
    for (int c = 0; c < 3; ++c) det += row[0][c] * cross[0][c];
    for (int c = 0; c < 3; ++c) {
        rays.across[c] = (float)(2 / (double)draw->width * cross[0][c] / det);
        rays.down[c] = (float)(2 / (double)draw->height * cross[1][c] / det);
        rays.from[c] = (float)((cross[2][c] - cross[0][c] - cross[1][c]) / det);
    }
    return rays;
}
