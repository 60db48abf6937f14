// SPDX-License-Identifier: MIT
// The table of colliders, simple shapes that hair must not cross. C parses, writes and packs them
// (scene/colliders.c); GLSL pushes hair out of them (sim/colliders.glsl).
//
// To add a collider, add a row OTHER below and a distance function to sim/colliders.glsl:
//     float name_distance(int i, vec3 p, out vec3 normal)
// It returns the distance (m) from the point p in the world to the shape at texel i *
// COLLIDER_TEXELS, negative inside; `normal` is the outward unit normal of the nearest surface.
//
// A row has: KIND, the name (in scenes and --colliders), the numbers, and the frame of the shape,
// `any` (the head's or the world's) or `world`. The numbers are
//     x,y,z      a point, m, and nx,ny,nz a direction of any length but 0. C transforms them from
//                their frame to the world. They fill xyz of a new texel; the next number fills w.
//     radius     0 or more, m. All other numbers may have any value; they follow each other.
//     height     without a direction, the height along y; C fills in 0,1,0.
// A shape lies within the ball about its first point whose radius is the sum of its other numbers;
// without a point it is the half-space below its height.
//
// CONE rows are rounded cones. They have a struct of their own and may stay in registers, and they
// must come before the OTHER rows.
//
// Messages and help show the numbers as written here.
// clang-format off
#define COLLIDERS(CONE, OTHER)                                    \
    CONE(SPHERE, sphere, (x,y,z,radius), any)                     \
    CONE(CAPSULE, capsule, (x,y,z,radius,x,y,z,radius), any)      \
    OTHER(GROUND, ground, (height), world)                        \
    OTHER(PLANE, plane, (nx,ny,nz,height), world)
// clang-format on

#define COLLIDER_NONE(kind, name, numbers, frame)
#define COLLIDER_ONE(kind, name, numbers, frame) +1

// Groups of shapes in memory: group 0 has all cones, each of the others one row of OTHER shapes.
#define COLLIDER_GROUPS (1 COLLIDERS(COLLIDER_NONE, COLLIDER_ONE))

// vec4 per shape.
#define COLLIDER_TEXELS 3

#ifdef __STDC__
// "sphere:x,y,z,radius; capsule:...", the syntax of --colliders.
#define COLLIDER_STRING(...)                      #__VA_ARGS__
#define COLLIDER_FORM(kind, name, numbers, frame) "; " #name ":" COLLIDER_STRING numbers
#define COLLIDER_FORMS                            COLLIDERS(COLLIDER_FORM, COLLIDER_FORM)
#endif
