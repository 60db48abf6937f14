// SPDX-License-Identifier: MIT
// The rounds of `collide.comp`: Newton's method for a strand's contacts, by elimination from tip to
// root (rod_front.glsl: unknowns are the turns of the links). A contact adds its force to a
// particle's residual and its stiffness to the matrix (contact.glsl). Tensions and forces of the
// linear system's solution are those with which the next round begins.

const float FAR_TURN = 0.3; // rad; a round turns no link by more
const float SETTLED = 5e-8; // a strand that moved less in a round is done, see forward()

int last() { return n - 1; }
int first_free() { return max(int(collide_params.carried), 1); }

// Fills the scratch memory from what the solver made of the strand.
void open_strand(Strand strand, float inside)
{
    vec3 x = vec3(0.0);
    float arc = 0.0;
    keep_here(0, x, FREE);
    for (int j = 1; j < n; ++j) {
        int a = strand.first + j * STRAND_TILE;
        vec3 x_before = x;
        x = particle_before(a, x + strand.root) - strand.root;
        arc += length(x - x_before);
        vec4 force = force_before(a);
        if (contact_before(a).w != collide_params.stamp_before) force = vec4(0.0);
        keep_here(j, x, force.w);
        keep_force(j, force.xyz, j < int(collide_params.carried) ? -1e30 : needed(a, inside, arc));
        keep_free(j, x);
        keep_surface(j, vec4(0.0, 0.0, 0.0, -1.0));
    }
}

// What particle j meets at x, relative to the root.
Meeting meet(Strand strand, int j, vec3 x, float need)
{
    vec3 at = strand.root + x;
    Nearest nearest = nearest_surface(at);
    Meeting here = Meeting(nearest.normal, nearest.distance - need, vec3(0.0), false);
    vec4 before = contact_before(strand.first + j * STRAND_TILE);
    if (before.w == collide_params.stamp_before) {
        vec3 slip = at - before.xyz - surface_displacement(at, nearest.moved);
        here.slip = slip - dot(slip, nearest.normal) * nearest.normal;
        here.slip_known = true;
    }
    return here;
}

// The same for velocities; `change`: of this one.
Meeting meet_velocity(Strand strand, int j, vec3 x, vec3 change, vec4 surface)
{
    vec3 v = velocity_before(strand.first + j * STRAND_TILE).xyz + change -
             surface_displacement(strand.root + x, surface.w) / collide_params.dt;
    float into = dot(v, surface.xyz);
    return Meeting(surface.xyz, surface.w < 0.0 ? 1e30 : into, v - into * surface.xyz, true);
}

#if BENDS
// By how much contact has turned link j so far, rad, or rad/s.
vec3 turned_by(int j, bool rates)
{
    vec3 e = recall_here(j).xyz - recall_here(j - 1).xyz,
         free = recall_free(j) - (j > 1 ? recall_free(j - 1) : vec3(0.0));
    return (rates ? cross(e, free) : cross(free, e)) / max(dot(e, e), 1e-30);
}
#endif

// From tip to root: the forces, and the elimination of the links' turns. `rates`: of velocities.
// `begins`: the first of the rounds.
void backward(Strand strand, bool rates, bool begins, inout Tally tally)
{
    Front front = front_open();
    vec3 N = vec3(0.0);
    vec4 here = recall_here(last());
#if BENDS
    vec3 turned_here = turned_by(last(), rates);
#endif
    for (int j = last(); j >= first_free(); --j) {
        vec4 before = recall_here(j - 1), kept = recall_force(j);
        vec3 e = here.xyz - before.xyz, free = recall_free(j);
        vec3 off = rates ? free : here.xyz - free;
        Touch touch = Touch(kept.xyz, here.w);
        Meeting at;
        if (rates)
            at = meet_velocity(strand, j, here.xyz, free, recall_surface(j));
        else
            at = meet(strand, j, here.xyz, kept.w);
        if (!rates && begins) tally.found = max(tally.found, -at.gap);
        touch = touch_begin(at, friction, touch);
        keep_here(j, here.xyz, touch.state);
        keep_force(j, touch.force, kept.w);
        if (!rates) keep_surface(j, vec4(at.normal, at.slip_known ? 1.0 : 0.0));
        front.A += diagonal(1.0) + touch_stiffness(at, touch);
        front.p -= off - touch.force;
        if (!begins && !rates) N += recall_rest(j);
        float ee = max(dot(e, e), 1e-30), tension = max(-dot(N, e) / ee, 0.0);
        front.E += diagonal(tension * ee) - tension * outerProduct(e, e);
#if BENDS
        // Half of it leaves strands that are draped over a ball five times as still as all of it.
        float bends = 0.5 * collide_params.bend / ee;
        vec3 turned_before = j > first_free() ? turned_by(j - 1, rates) : vec3(0.0);
        vec3 moment = bends * (turned_here - turned_before);
        front.E += diagonal(bends) + 1e-4 * outerProduct(e, e);
        front.s -= moment;
        keep_turn(j, front_eliminate(front, e, diagonal(-bends), diagonal(bends), ee));
        front.s += moment;
        turned_here = turned_before;
#else
        // Turns about the link itself move nothing; their stiffness only keeps the matrix regular.
        float idle = front.A[0].x + front.A[1].y + front.A[2].z;
        front.E += idle * outerProduct(e, e);
        keep_turn(j, front_eliminate(front, e, ZERO3, ZERO3, ee));
#endif
        here = before;
    }
}

// From root to tip: turns the links. Returns the square of the largest move by a link's own turn,
// in parts of the distance from the root.
float forward(bool rates)
{
    vec3 dx = vec3(0.0), x_before = recall_here(first_free() - 1).xyz, x_new = x_before;
#if BENDS
    vec3 w_before = vec3(0.0);
#endif
    float most = 0.0;
    for (int j = first_free(); j < n; ++j) {
        vec4 here = recall_here(j);
        Turn turn = recall_turn(j);
        vec3 e = here.xyz - x_before, w = turn.v - turn.U * dx;
#if BENDS
        w -= turn.W * w_before;
#endif
        vec3 z = cross(w, e);
        float ll = max(dot(e, e), 1e-30), turned = dot(z, z) / ll, l = sqrt(ll);
        float cut = !rates && turned > FAR_TURN * FAR_TURN ? FAR_TURN * inversesqrt(turned) : 1.0;
        if (!(turned < 1e30)) z = w = vec3(0.0); // too much for float32
        z *= cut;
        dx += z;
#if BENDS
        w_before = cut * w;
#endif
        vec4 kept = recall_force(j), surface = recall_surface(j);
        Touch touch =
            touch_end(Touch(kept.xyz, here.w), surface.xyz, rates || surface.w > 0.5, friction, dx);
        vec3 free = recall_free(j);
        keep_force(j, touch.force, kept.w);
        if (rates) {
            keep_here(j, here.xyz, touch.state);
            keep_free(j, free + dx);
            z *= collide_params.dt;
            most = max(most, dot(z, z) / (ll + 1.5 * dot(here.xyz, here.xyz)));
        } else {
            most = max(most, dot(z, z) / (ll + 1.5 * dot(here.xyz, here.xyz)));
            vec3 to = e + z;
            float size = length(to);
            x_new += e + relative_turn(e, z, l, size, 0.0, to / max(size, 1e-30));
            keep_here(j, x_new, touch.state);
            keep_rest(j, here.xyz + dx - free - touch.force);
        }
        x_before = here.xyz;
    }
    return most;
}

// Notes the surfaces that the particles touch at x, for the velocities.
void rest_on(Strand strand, int j, vec3 x, Nearest nearest, float gap, float l)
{
    vec3 at = abs(strand.root + x);
    // Rounding must not decide whether a particle flies into the surface.
    float rounding = EXACT * (l + max(at.x, max(at.y, at.z)));
    keep_surface(j, vec4(nearest.normal, gap < rounding ? nearest.moved : -1.0));
}
