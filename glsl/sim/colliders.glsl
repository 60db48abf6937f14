// SPDX-License-Identifier: MIT
// The surfaces that hair must not cross, at the step's end: distances (negative inside), normals
// and motion.
//
// A rounded cone is the union of all spheres with centres a + s e, 0 <= s <= L, and radii r + g s.
// The distance from p to it is the minimum of |p - a - s e| - r - g s over s. With y the coordinate
// of p along the axis and h across it, the derivative is zero at s = y + g h/sqrt(1 - g^2). The
// function is convex, so s is clamped to the axis. L = 0 is a sphere.

layout(binding = BIND_COLLIDERS) uniform samplerBuffer colliders; // see scene/colliders.c

struct Cone {
    vec4 first; // a, r
    vec4 axis;  // e, L
    vec2 grow;  // g, g/sqrt(1 - g^2)
};

Cone fetch_cone(int i)
{
    int at = i * COLLIDER_TEXELS;
    return Cone(texelFetch(colliders, at), texelFetch(colliders, at + 1),
                texelFetch(colliders, at + 2).xy);
}

// A few cones (CONES > 0) are fetched once and stay in registers, and loops over them are unrolled.
// A fetch costs a CPU driver as much as computing a distance.
#if CONES > 0
Cone few_cones[CONES];

void open_cones()
{
    for (int i = 0; i < CONES; ++i) few_cones[i] = fetch_cone(i);
}

#define CONE(i)      few_cones[i]
#define CONES_IN_ALL CONES
#else
void open_cones() {}

#define CONE(i)      fetch_cone(i)
#define CONES_IN_ALL int(collide_params.shapes[0].z)
#endif

float cone_distance(Cone cone, vec3 p, out vec3 normal)
{
    vec3 r = p - cone.first.xyz;
    float y = dot(r, cone.axis.xyz);
    float s = clamp(y + cone.grow.y * length(r - y * cone.axis.xyz), 0.0, cone.axis.w);
    vec3 from = r - s * cone.axis.xyz;
    float across = length(from);
    normal = across > 1e-18 ? from / across : vec3(0.0, 1.0, 0.0);
    return across - (cone.first.w + cone.grow.x * s);
}

float plane_distance(int i, vec3 p, out vec3 normal)
{
    vec4 plane = texelFetch(colliders, i * COLLIDER_TEXELS); // unit normal, height
    normal = plane.xyz;
    return dot(plane.xyz, p) - plane.w;
}

float ground_distance(int i, vec3 p, out vec3 normal) { return plane_distance(i, p, normal); }

struct Nearest {
    float distance;
    vec3 normal;
    float moved; // 1: moves with the head, 2: and by field_moved
};

void take_nearer(inout Nearest nearest, float distance, vec3 normal, float moved)
{
    bool nearer = distance < nearest.distance;
    nearest.normal = nearer ? normal : nearest.normal;
    nearest.moved = nearer ? moved : nearest.moved;
    nearest.distance = min(distance, nearest.distance);
}

// A loop over the shapes of each OTHER row of the table (collider_table.h). `body` may use i,
// distance, normal and moved. HAS_KIND is 0 if the scene has no such shape; then no code is
// generated.
#define LOOP_OTHER(kind, name, body)                                                               \
    range = ivec3(collide_params.shapes[group++].xyz);                                             \
    for (int i = range.x; HAS_##kind != 0 && i < range.z; ++i) {                                   \
        vec3 normal;                                                                               \
        body                                                                                       \
    }

// The surface with the smallest signed distance from p.
Nearest nearest_surface(vec3 p)
{
    Nearest nearest = Nearest(1e30, vec3(0.0), 0.0);
    int cones_moved = int(collide_params.shapes[0].y), group = 1;
    ivec3 range;
    for (int i = 0; i < CONES_IN_ALL; ++i) {
        vec3 normal;
        float distance = cone_distance(CONE(i), p, normal);
        take_nearer(nearest, distance, normal, i < cones_moved ? 1.0 : 0.0);
    }
#define TAKE_OTHER(kind, name, numbers, frame)                                                     \
    LOOP_OTHER(kind, name, float distance = name##_distance(i, p, normal);                         \
               take_nearer(nearest, distance, normal, i < range.y ? 1.0 : 0.0);)
    COLLIDERS(COLLIDER_NONE, TAKE_OTHER)
#if FIELD
    vec3 normal;
    float distance = field_distance(p, normal);
    take_nearer(nearest, distance, normal, BOUND != 0 ? 2.0 : 1.0);
#endif
    return nearest;
}

// The displacement in this step of a point that moves with the head and is now at p. Written so
// that small rotations do not cancel.
vec3 head_displacement(vec3 p)
{
    vec4 q = collide_params.head_turn_back;
    vec3 y = p - collide_params.head_translation.xyz, t = 2.0 * cross(q.xyz, y);
    return collide_params.head_translation.xyz - collide_params.head_translation_old.xyz -
           (q.w * t + cross(q.xyz, t));
}
