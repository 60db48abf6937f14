// SPDX-License-Identifier: MIT
// Random values that belong to a strand.

// Uniform bits from a number, equal on every machine (the finaliser "lowbias32" of C. Wellons).
uint hash_bits(uint id)
{
    id = (id ^ (id >> 16)) * 0x7feb352du;
    id = (id ^ (id >> 15)) * 0x846ca68bu;
    return id ^ (id >> 16);
}

// Uniform in -1 .. 1.
float hash_signed(uint id) { return float(int(hash_bits(id) >> 8)) * (2.0 / 16777215.0) - 1.0; }
