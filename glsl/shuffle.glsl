// SPDX-License-Identifier: MIT
// A random order of 0 .. count - 1 without memory: numbers in fours, each four in an order of its seed's choice (exclusive or by 0 .. 3);
// those beyond count are passed over. Not more random than that: the accuracy of a step is best from root to tip. Needs hash.glsl.

struct Shuffle {
    uint at, flip, count;
};

Shuffle shuffle_open(uint seed, uint count) { return Shuffle(0u, hash_bits(seed) >> 30, count); }

uint shuffle_next(inout Shuffle s)
{
    uint number;
    do
        number = s.at++ ^ s.flip;
    while (number >= s.count && s.at < s.count + 4u); // that a call too many ends
    return number;
}
