// SPDX-License-Identifier: MIT
// Positions relative to the strand's root, in a buffer of positions in the world.
//
// X m from the origin, float32 rounds a coordinate by up to 2^-24 X. A short step moves a particle
// by less than that, so hair would stand still. Therefore the fourth component of a stored position
// says what its xyz have lost: three whole numbers from -127 to 127, in units of a quantum, packed
// into one integer below 2^24. 0 says that nothing was lost, which is right for positions from
// anywhere else.
//
// With coordinates of the root up to M and a reach of R, stored coordinates are below M + R and
// their distances from the root below R. A sum and a difference lose up to 2^-24 of these, so 127
// units are 2^-24 (M + 2R). 10 m from the origin a unit is 5e-9 m.

struct Root {
    vec3 at; // m, in the world, as stored
    float quantum;
};

Root relative_root(vec3 at, float reach)
{
    vec3 a = abs(at);
    return Root(at, (max(a.x, max(a.y, a.z)) + 2.0 * reach) * (1.0 / 127.0 / 16777216.0));
}

// The position relative to the root, m. `root`: that of the step in which it was stored.
vec3 relative_fetch(vec4 stored, Root root)
{
    float z = roundEven(stored.w * (1.0 / 65536.0)), yx = stored.w - 65536.0 * z,
          y = roundEven(yx * (1.0 / 256.0)), x = yx - 256.0 * y;
    return (stored.xyz - root.at) + root.quantum * vec3(x, y, z);
}

// What is stored of the position x relative to the root. `precise`: compilers may not cancel the
// sum with the difference.
vec4 relative_store(vec3 x, Root root)
{
    precise vec3 stored = root.at + x;
    precise vec3 lost = x - (stored - root.at);
    vec3 units = clamp(roundEven(lost * (1.0 / root.quantum)), -127.0, 127.0);
    return vec4(stored, units.x + 256.0 * units.y + 65536.0 * units.z);
}

// |r|^2 - l^2 of a link r whose length may differ from its rest length l; 0 if that could be the
// rounding of positions up to `reach` from the root.
float relative_off(vec3 r, float l, float reach)
{
    float off = dot(r, r) - l * l;
    return abs(off) > 2e-7 * reach * l ? off : 0.0;
}

// By how much the link r + e is longer than l. `size`: |r + e|; `off`: |r|^2 - l^2, 0 for links
// that keep their length. Unlike size - l this does not have the rounding errors of r and l.
float relative_longer(vec3 r, vec3 e, float l, float size, float off)
{
    return (off + dot(2.0 * r + e, e)) / (size + l);
}

// The change of a link r whose end moves by e and that then gets the length l. `d`: the unit vector
// along r + e.
vec3 relative_turn(vec3 r, vec3 e, float l, float size, float off, vec3 d)
{
    vec3 slight = (l * e - relative_longer(r, e, l, size, off) * r) / size;
    return size > 0.5 * l ? slight : l * d - r;
}
