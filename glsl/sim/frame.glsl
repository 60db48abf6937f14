// SPDX-License-Identifier: MIT
// The frame in which a strand is at rest, at the step's start (old) and end: x_world = rotation
// x_rest + translation. It is the head's frame. With BOUND 1 it is the frame of the deforming mesh
// at the strand's root, combined with the head's; then open_frame must be called before anything
// else for a strand (needs step_params.h, rigid.glsl).
#if BOUND
layout(binding = BIND_FRAMES) uniform samplerBuffer frames; // see shared.h
vec4 frame_rotation, frame_rotation_old;
vec3 frame_translation, frame_translation_old, frame_gravity;

// If a solver takes a step in parts, frames are interpolated over the step.
void frame_at(int strand, float share, vec4 head_rotation, vec3 head_translation, out vec4 rotation,
              out vec3 translation)
{
    vec4 before = texelFetch(frames, 4 * strand), after = texelFetch(frames, 4 * strand + 2);
    vec3 from = texelFetch(frames, 4 * strand + 1).xyz, to = texelFetch(frames, 4 * strand + 3).xyz;
    vec4 q = before + share * (after - before);
    rotation = product(head_rotation, q * inversesqrt(dot(q, q)));
    translation = rotate(head_rotation, from + share * (to - from)) + head_translation;
}

void open_frame(int strand)
{
    frame_at(strand, step_params.frame_old, step_params.head_rotation_old,
             step_params.head_translation_old.xyz, frame_rotation_old, frame_translation_old);
    frame_at(strand, step_params.frame_now, step_params.head_rotation,
             step_params.head_translation.xyz, frame_rotation, frame_translation);
    frame_gravity = step_params.gravity.xyz - rotate(frame_rotation, step_params.held.xyz);
}
#else
#define frame_rotation        step_params.head_rotation
#define frame_rotation_old    step_params.head_rotation_old
#define frame_translation     step_params.head_translation.xyz
#define frame_translation_old step_params.head_translation_old.xyz
#define frame_gravity         step_params.gravity.xyz
#define open_frame(strand)
#endif

// Where a root at rest (m) is at the step's start and end, and its displacement in the step. Far
// from the origin the difference of two positions would be too rough for short steps.
vec3 frame_root_old(vec3 root) { return rotate(frame_rotation_old, root) + frame_translation_old; }
vec3 frame_root(vec3 root) { return rotate(frame_rotation, root) + frame_translation; }

vec3 frame_move(vec3 root)
{
#if BOUND
    return frame_root(root) - frame_root_old(root);
#else
    vec3 arm = root - step_params.head_pivot.xyz;
    return step_params.head_move.xyz +
           (rotate(frame_rotation, arm) - rotate(frame_rotation_old, arm));
#endif
}
