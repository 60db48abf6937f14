// SPDX-License-Identifier: MIT
// An account of the energy that constraints add to a strand, and a guard against adding more than a
// little. (Exact constraints would add none. Needs particles.glsl, strand.glsl.) In the frame of
// the root, the root's acceleration acts like a force on all particles. Particle j, of mass 1,
// moves by m_j in a step and moved by u_j dt in the step before; without constraints it would move
// by f_j. Then
//
//     K' - K = sum (m - u dt).(m + u dt)/2/dt^2 = work of the forces + X,
//     X = sum (m - f).(m + u dt)/2/dt^2
//
// (leapfrog's energy: velocities between steps, work over the mean of two steps). The fourth
// component of the root's velocity stores a = max(a + X, 0), the energy gained since the account
// was last at its lowest. ALLOWED (set by the solver) is the permitted gain, as a share of the
// energy that gravity could give to the strand and of the energy that it has. If a exceeds that,
// the strand moves only by the share k of its way: each segment turns from its old direction
// towards the new one. For moves k m, X = A k^2 + B k + C, so the greatest k within ALLOWED follows
// directly. Segments that turn far
// move by more than k; this difference goes into the account. If no k suffices, take the k with the
// smallest gain and reduce the velocities to pay for the rest.
//
// SLOWS_AGAIN 1: segments that flip have no intermediate direction and move by all of their way or
// none. If the strand's moves then have more than 1.1 times the intended energy, they are reduced
// again.

const float NOISE = 1e-6; // of a strand's length; rounding errors are 6e-8

struct Account {
    vec3 moved, moved_before;        // of the root, in this step and in the previous one
    float squares, linear, constant; // energies, times 2 dt^2
    float gained;                    // in earlier steps, not paid yet
};

Account account_open(Strand strand)
{
    vec4 before = velocity_before(strand.address);
    return Account(strand.moved, before.xyz * strand.dt, 0.0, 0.0, 0.0, before.w);
}

// Adds a particle that moved by `now` relative to the root, would have moved by `forced` without
// constraints, and had the velocity v.
void account_add(inout Account account, Strand strand, vec3 now, vec3 forced, vec3 v)
{
    vec3 before = v * strand.dt - account.moved_before;
    account.squares += dot(now, now);
    account.linear += dot(now, before - forced);
    account.constant -= dot(forced, before);
}

// Adds a whole step by sums, if f is not known for each particle: uniform forces move all particles
// by `fall`.
void account_add_sums(inout Account account, vec3 fall, vec3 sum_now, vec3 sum_before,
                      float squares_now, float squares_before)
{
    vec3 forced = fall - (account.moved - account.moved_before);
    account.squares += squares_now;
    account.linear -= dot(forced, sum_now);
    account.constant -= squares_before + dot(forced, sum_before);
}

// The greatest k in [0, 1] with a k^2 + b k + c <= 0, or the k with the smallest value; a > 0.
float share_within(float a, float b, float c)
{
    float discriminant = b * b - 4.0 * a * c;
    if (discriminant <= 0.0) return clamp(-0.5 * b / a, 0.0, 1.0);
    float q = 0.5 * (abs(b) + sqrt(discriminant));
    return clamp(b > 0.0 ? -c / q : q / a, 0.0, 1.0);
}

// The factor of velocities that leaves the share 1 - x of their energy. A quotient of equal numbers
// may exceed 1: GLSL 4.30 (4.7.1) allows divisions an error of 2.5 units in the last place.
float root_of_rest(float x) { return sqrt(max(1.0 - x, 0.0)); }

#if SLOWS_AGAIN
const int MOST_SLOWED = 6; // per step
const float LESS = 0.3;    // factor of each reduction; one half would leave it undecided which way
                           // a flipping segment goes
#endif

// Scales the strand's move by `share` and also its velocities by `kept`.
void account_slow(inout Account account, Strand strand, int last, float share, float kept)
{
    float squares = 0.0;
    vec3 x = vec3(0.0), now = vec3(0.0), full_before = vec3(0.0), root = account.moved / strand.dt,
         v_before = root;
    for (int j = 1; j <= last; ++j) {
        int a = strand.address + j * STRAND_TILE;
        vec4 v = velocities[a], segment = fetch_rest(strand, j);
        vec3 full = relative_fetch(positions[a], strand.root),
             turned = strand.dt * (v.xyz - v_before), link = full - full_before - turned,
             slowed = link + share * turned, d = direction(slowed);
        x += segment.w * d;
        // `kept` of an earlier call leaves links whose old lengths are off
        float off = relative_off(link, segment.w, strand.total_length);
        now += relative_turn(link, share * turned, segment.w, length(slowed), off, d);
        full_before = full, v_before = v.xyz;
        velocities[a] = vec4(root + kept * now / strand.dt, v.w);
        store_position(strand, a, x);
        squares += dot(now, now);
    }
    account.squares = squares;
}

// An estimate of the energy that gravity and wind could give to the strand.
float account_fall(Strand strand, int last)
{
    return 0.5 * float(last) * strand.total_length * length(strand.push) / step_params.gain;
}

// The energy that rounding errors of positions seem to have. Hair at rest that its style holds has
// no other energy and needs no guard.
float account_noise(Strand strand, int last)
{
    float speed = NOISE * strand.total_length / strand.dt;
    return 0.5 * float(last) * speed * speed;
}

// Slows the strand down if necessary, which updates `squares`. Returns the energy that the strand
// has gained and not paid. The loop is not unrolled, so a CPU driver leaves it after one round if
// no strand needs another.
float account_close(inout Account account, Strand strand, int last)
{
    float per_square = 0.5 / (strand.dt * strand.dt), kinetic = per_square * account.squares,
          linear = per_square * account.linear;
    float constant = account.gained + per_square * account.constant;
    float fall = ALLOWED * account_fall(strand, last) + account_noise(strand, last);
    float gained = kinetic + linear + constant,
          over = max(gained, 0.0) - (fall + ALLOWED * kinetic), share = 1.0, kept = 1.0;
    bool guards = over > 0.0 && kinetic > 0.0 && over < 1e30;
    if (guards) {
        share = share_within((1.0 - ALLOWED) * kinetic, linear, constant - fall);
        kinetic *= share * share;
        gained = kinetic + share * linear + constant;
        over = clamp(gained - (fall + ALLOWED * kinetic), 0.0, kinetic);
        kept = kinetic > 0.0 ? root_of_rest(over / kinetic) : 1.0;
        account_slow(account, strand, last, share, kept);
        gained -= over;
        gained += kept * kept * (per_square * account.squares - kinetic);
#if SLOWS_AGAIN
        for (int i = 0; i < MOST_SLOWED && per_square * account.squares > 1.1 * kinetic; ++i) {
            share *= LESS, kinetic *= LESS * LESS;
            gained = share * linear + constant;
            account_slow(account, strand, last, LESS, 1.0);
            gained += per_square * account.squares;
        }
#endif
    }
    return gained > 0.0 && gained < 1e30 ? gained : 0.0; // 0 if NaN
}
