// SPDX-License-Identifier: MIT
// An account of the energy that constraints give to a strand, which is none if they are kept exactly, and a guard against more than a
// little of it (needs particles.glsl, lane.glsl). Seen from the root, whose acceleration then acts like a force on all particles, particle j
// of mass 1 goes by m_j in a step, after u_j dt in the one before; without constraints it would go by f_j. Then
//
//     K' - K = sum (m - u dt).(m + u dt)/2/dt^2 = work of the forces + X,      X = sum (m - f).(m + u dt)/2/dt^2
//
// (leapfrog's energy: velocities between steps, work over the mean of two steps). The strand carries a = max(a + X, 0), what it has gained
// since it last had least, in the fourth component of the root's velocity. Above ALLOWED of what gravity could give to it, and of what it
// has, all its velocities are scaled so that the rest is gone.
const float ALLOWED = 0.005;

struct Account {
    vec3 moved, moved_before; // of the root, in this step and in the one before
    float gained, kinetic;    // times dt^2, dt^2/2
    float stored_before, stored; // in springs that count as constraints
};

Account account_open(Lane lane, float stored)
{
    vec3 before = texelFetch(velocity_before, lane.address).xyz * lane.dt;
    return Account(lane.root - lane.root_old, before, 0.0, 0.0, stored, stored);
}

// A particle that has gone by `move`, would have gone by `free` without constraints, and had the velocity v.
void account_add(inout Account account, Lane lane, vec3 move, vec3 free, vec3 v)
{
    vec3 now = move - account.moved, before = v * lane.dt - account.moved_before;
    account.gained += dot(move - free, 0.5 * (now + before));
    account.kinetic += dot(now, now);
}

// A whole step in sums, for want of each particle's f: uniform forces that move particles by `fall`.
void account_add_sums(inout Account account, vec3 fall, vec3 sum_now, vec3 sum_before, float squares_now, float squares_before)
{
    vec3 forced = fall - (account.moved - account.moved_before);
    account.gained += 0.5 * (squares_now - squares_before - dot(forced, sum_now + sum_before));
    account.kinetic += squares_now;
}

// Writes the root's velocity with the account, and scales the strand's velocities if need be. Its loop is rolled, so that a CPU driver
// leaves it after a round where no strand needs it.
void account_close(Account account, Lane lane, int last)
{
    float per_square = 1.0 / (lane.dt * lane.dt), kinetic = 0.5 * per_square * account.kinetic;
    float gained = texelFetch(velocity_before, lane.address).w + per_square * account.gained + (account.stored - account.stored_before);
    float fall = 0.5 * float(last) * lane.length * length(lane.push) / step_params.gain;
    float over = max(gained, 0.0) - ALLOWED * (fall + kinetic);
    bool guards = over > 0.0 && kinetic > 0.0 && over < 1e30;
    vec3 root = account.moved / lane.dt;
    float kept = guards ? sqrt(max(1.0 - over / kinetic, 0.0)) : 1.0;
    gained = gained > 0.0 && gained < 1e30 ? gained : 0.0; // 0 for a NaN
    velocities[lane.address] = vec4(root, guards ? gained - min(over, kinetic) : gained);
    for (int j = 1; guards && j <= last; ++j) {
        vec4 v = velocities[lane.address + j * STRAND_TILE];
        velocities[lane.address + j * STRAND_TILE] = vec4(root + kept * (v.xyz - root), v.w);
    }
}
