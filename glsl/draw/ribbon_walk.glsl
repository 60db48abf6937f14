// SPDX-License-Identifier: MIT
// The loop along a strand that both rasterisers use: it projects and shades the strand's points,
// and leaves out points where the ribbon is straight. The including file decides what is done with
// the ribbons. It defines three functions and WALK_BEYOND, the number of additional turns after the
// last point, in which the tip takes the place of missing points.
#include "draw/draw.h"
#include "draw/material.h"
#include "common/hair_address.glsl"
#include "common/hash.h"
#include "draw/curve.glsl"
#include "draw/paint.glsl"
#include "draw/shade.glsl"
#include "draw/ribbon.glsl"

struct Walk {
    int points;          // points of the strand: particles, or points of its curve
    float opacity;       // of the strand
    Particle kept, last; // the last kept point; the previous point
    vec2 way;            // the ribbon's direction before `kept`
    float bent;          // sum of ribbon_bend over the points left out since `kept`
};

void see_point(Particle p); // called for each point
// Whether `last` must be kept, in the turn of point j, which is p.
bool ends_ribbon(Walk w, int j, Particle p);
// Handles the joint at `kept`, between the directions `way` and `next`.
void put_joint(Walk w, int j, vec2 next);

int count_points()
{
    Curve curve = curve_open(0, int(material.vertex_count));
    return curve.segments * curve.parts + 1;
}

Walk walk_strand(int s, uint id)
{
    int n = int(material.vertex_count), root = particle_address(s, 0, n);
    Painter painter = paint_strand(id, n);
    if (s == int(material.last_strand)) painter.radius *= material.last_share;
    vec3 eye = draw_params.eye.xyz;
    Fibre fibre = fibre_material();
    Curve curve = curve_open(root, n);
    vec3 here = curve_point(curve, 0), before = here;
    vec4 here_clip = clip_from_world * vec4(here, 1.0), before_clip = here_clip;
    Particle none = Particle(RibbonPoint(0.0, 0.0, 0.0, 0.0), vec3(0.0));
    Walk w = Walk(count_points(), paint_opacity(root), none, none, vec2(0.0), 0.0);
    int lit = particle_address(s, 0, w.points); // index of the light at the strand's points
#if SHADOW
    float shadow_opacity = material.shadow_opacity * paint_opacity_share(root);
#endif
    for (int j = 0; j < w.points + WALK_BEYOND; ++j) {
        int k = WALK_BEYOND > 0 ? min(j, w.points - 1) : j;
        float place = curve_place(curve, k);
        int at = root + int(place) * STRAND_TILE;
        vec3 after = curve_point(curve, j + 1);
        vec4 after_clip = clip_from_world * vec4(after, 1.0);
        Particle p;
        float radius = paint_radius(painter, at, place);
        p.at = project(clip_near(here_clip, before_clip, after_clip), radius);
#if SHADOW
        shadow_fibre = vec2(2.0 * radius, shadow_opacity);
        shadow_find(here);
#endif
        p.color = shade_particle(fibre, painter, at, lit + k * STRAND_TILE, here,
                                 unit(after - before), unit(eye - here));
        see_point(p);
        if (j > 1) w.bent += bend(w.kept, w.last, p);
        if (j == 1 || ends_ribbon(w, j, p)) {
            vec2 next = direction(w.kept, w.last);
            put_joint(w, j, next);
            w.way = next;
            w.kept = w.last;
            w.bent = 0.0;
        }
        w.last = p;
        before = here;
        before_clip = here_clip;
        here = after;
        here_clip = after_clip;
    }
    return w;
}
