// SPDX-License-Identifier: MIT
// The address of particle j of strand s in a batch of strands with n particles (hair_address of
// hair.h; needs shared.h).

int particle_address(int s, int j, int n)
{
    return (s / STRAND_TILE * n + j) * STRAND_TILE + s % STRAND_TILE;
}
