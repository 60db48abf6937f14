// SPDX-License-Identifier: MIT
// A float's bits as an int that grows with it, which atomics can compare: of positive floats they
// do, of negative ones they fall.
int ordered(float x)
{
    int bits = floatBitsToInt(x);
    return bits < 0 ? bits ^ 0x7fffffff : bits;
}
