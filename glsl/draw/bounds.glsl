// SPDX-License-Identifier: MIT
// Maps a float to an integer with the same order, for atomic minimum and maximum. The bits of
// positive floats already have this order; those of negative floats have the opposite order.
int ordered(float x)
{
    int bits = floatBitsToInt(x);
    return bits < 0 ? bits ^ 0x7fffffff : bits;
}
