// SPDX-License-Identifier: MIT
// The table of colliders, simple shapes that hair must not cross: read by C (scene/colliders.c,
// which parses, writes and packs them) and by GLSL (sim/colliders.glsl, which pushes hair out).
//
// To add a collider: add a row OTHER below and, to sim/colliders.glsl, its distance function
//     float name_distance(int i, vec3 p, out vec3 normal)
// from a point of the world, m, to the shape at texel i * COLLIDER_TEXELS: negative inside;
// `normal` is the outward unit normal of the nearest surface.
//
// A row: KIND, name (in scenes and --colliders), its numbers, and the frame in which it stands:
// `any` (the head's, or the world's) or `world`. Of the numbers
//     x,y,z      are a point, m, and nx,ny,nz a direction of any length but 0: C turns them from
//                their frame into the world; they fill xyz of a new texel, and what follows w;
//     radius     is 0 or more, m; all others are any number, one behind the other;
//     height     alone, without a direction, is that along y: C fills 0,1,0 in.
// A shape lies within the ball about its first point whose radius is the sum of its other numbers;
// without a point it is the half-space below its height.
//
// CONE rows are rounded cones, which have a struct of their own and may stay in registers; they
// stand before the OTHER rows.
//
// Messages and help show the numbers as they stand here.
// clang-format off
#define COLLIDERS(CONE, OTHER)                                    \
    CONE(SPHERE, sphere, (x,y,z,radius), any)                     \
    CONE(CAPSULE, capsule, (x,y,z,radius,x,y,z,radius), any)      \
    OTHER(GROUND, ground, (height), world)                        \
    OTHER(PLANE, plane, (nx,ny,nz,height), world)
// clang-format on

#define COLLIDER_NONE(kind, name, numbers, frame)
#define COLLIDER_ONE(kind, name, numbers, frame) +1

// Of the shapes in memory: 0 are all cones, 1 and on the OTHER rows.
#define COLLIDER_GROUPS (1 COLLIDERS(COLLIDER_NONE, COLLIDER_ONE))

// vec4 of a shape.
#define COLLIDER_TEXELS 3

#ifdef __STDC__
// "sphere:x,y,z,radius; capsule:...": how --colliders has them.
#define COLLIDER_STRING(...)                      #__VA_ARGS__
#define COLLIDER_FORM(kind, name, numbers, frame) "; " #name ":" COLLIDER_STRING numbers
#define COLLIDER_FORMS                            COLLIDERS(COLLIDER_FORM, COLLIDER_FORM)
#endif
