// SPDX-License-Identifier: MIT
// Where particle j of strand s lies in a batch of strands of n particles (hair_address of hair.h;
// needs shared.h).

int particle_address(int s, int j, int n)
{
    return (s / STRAND_TILE * n + j) * STRAND_TILE + s % STRAND_TILE;
}
