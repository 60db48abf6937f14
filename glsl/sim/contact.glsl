// SPDX-License-Identifier: MIT
// The law of a particle's contact with a surface, and what `collide.comp` keeps of it.
//
// With the gap g (m, or m/s between velocities) and the slip s along the surface, the force
// F = p n + f holds Signorini's and Coulomb's laws:
//     p >= 0, g >= 0, p g = 0;   |f| <= mu p, and f = -mu p s/|s| where s is not 0.
// Forces are multipliers of an augmented Lagrangian (Alart, Curnier: A mixed formulation for
// frictional contact problems prone to Newton like solution methods, CMAME 1991). A round begins
// with the forces p - NORMAL g and f - TANGENTIAL s at the place where the particle is; what they
// are at the place that the linear system finds replaces p and f. So a particle that sticks comes
// to where it was, although the stiffness is finite. Masses are 1, and stiffness is of that size:
// with more, contacts come into touch and lose it again in every round.

const float NORMAL = 20.0;
const float TANGENTIAL = 2.0;

const float FREE = 0.0, SLIDES = 1.0, STICKS = 2.0;

struct Touch {
    vec3 force;
    float state; // one of the three
};

// What a particle meets: the unit normal of the surface, the gap, and the slip, 0 if it is not
// known.
struct Meeting {
    vec3 normal;
    float gap;
    vec3 slip;
    bool slip_known;
};

// The force at the place of the meeting. Friction is bound by the p of the round before.
Touch touch_begin(Meeting at, float friction, Touch touch)
{
    float before = dot(touch.force, at.normal), pressed = before - NORMAL * at.gap;
    vec3 along = touch.force - before * at.normal, rubs = along - TANGENTIAL * at.slip;
    if (!(pressed > 0.0)) return Touch(vec3(0.0), FREE);
    float most = friction * max(before, 0.0), size = length(rubs);
    // A particle that turns round has stood still in between: it sticks, from no force on.
    bool turns = touch.state == SLIDES && most > 0.0 && dot(rubs, along) < 0.0;
    bool sticks = at.slip_known && (turns || size <= most);
    rubs = !at.slip_known ? vec3(0.0)
           : turns        ? -TANGENTIAL * at.slip
           : sticks       ? rubs
                          : rubs * (most / size);
    return Touch(pressed * at.normal + rubs, sticks ? STICKS : SLIDES);
}

// The force after the particle has moved by dx.
Touch touch_end(Touch touch, vec3 normal, bool slip_known, float friction, vec3 dx)
{
    float up = dot(dx, normal), across = touch.state == STICKS ? TANGENTIAL : 0.0;
    vec3 force = touch.force - NORMAL * up * normal - across * (dx - up * normal);
    float pressed = dot(force, normal), most = friction * pressed;
    if (touch.state == FREE || !(pressed > 0.0)) return Touch(vec3(0.0), FREE);
    vec3 rubs = force - pressed * normal;
    float size = length(rubs);
    bool sticks = slip_known && size <= most;
    rubs = !slip_known ? vec3(0.0) : sticks ? rubs : rubs * (most / size);
    return Touch(pressed * normal + rubs, sticks ? STICKS : SLIDES);
}

// The derivative of the force by the particle's place, negative.
mat3 touch_stiffness(Meeting at, Touch touch)
{
    float across = touch.state == STICKS ? TANGENTIAL : 0.0;
    return touch.state == FREE
               ? mat3(0.0)
               : diagonal(across) + (NORMAL - across) * outerProduct(at.normal, at.normal);
}

// In scratch memory, for each particle.
#if BENDS
const int PLACES = CONTACT_BENDING_PLACES;
#else
const int PLACES = CONTACT_PLACES;
#endif
int keep_base = 0;

int place(int j, int i) { return keep_base + (PLACES * j + i) * STRAND_TILE; }
// xyz: place relative to the root; w: state
void keep_here(int j, vec3 x, float state) { scratch[place(j, 0)] = vec4(x, state); }
vec4 recall_here(int j) { return scratch_at(place(j, 0)); }
void keep_force(int j, vec3 force, float need) { scratch[place(j, 1)] = vec4(force, need); }
vec4 recall_force(int j) { return scratch_at(place(j, 1)); } // w: the distance that it needs
void keep_turn(int j, Turn a)
{
    scratch[place(j, 2)] = vec4(a.U[0], a.v.x);
    scratch[place(j, 3)] = vec4(a.U[1], a.v.y);
    scratch[place(j, 4)] = vec4(a.U[2], a.v.z);
#if BENDS
    for (int i = 0; i < 3; ++i) scratch[place(j, 7 + i)].xyz = a.W[i];
#endif
}
Turn recall_turn(int j)
{
    vec4 a = scratch_at(place(j, 2)), b = scratch_at(place(j, 3)), c = scratch_at(place(j, 4));
    mat3 W = ZERO3;
#if BENDS
    W = mat3(scratch_at(place(j, 7)).xyz, scratch_at(place(j, 8)).xyz, scratch_at(place(j, 9)).xyz);
#endif
    return Turn(mat3(a.xyz, b.xyz, c.xyz), W, vec3(a.w, b.w, c.w));
}
// What the solver made of the place; then the change of the velocity.
void keep_free(int j, vec3 a) { scratch[place(j, 5)].xyz = a; }
vec3 recall_free(int j) { return scratch_at(place(j, 5)).xyz; }
// What is left of the residual in the linear system; in the place of a turn that was applied.
void keep_rest(int j, vec3 a) { scratch[place(j, 2)].xyz = a; }
vec3 recall_rest(int j) { return scratch_at(place(j, 2)).xyz; }
// The surface at x: normal; 1: the slip is known. For velocities: how it moves (Nearest.moved);
// -1: it is not touched.
void keep_surface(int j, vec4 a) { scratch[place(j, 6)] = a; }
vec4 recall_surface(int j) { return scratch_at(place(j, 6)); }
