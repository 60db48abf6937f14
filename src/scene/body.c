// SPDX-License-Identifier: MIT
#include "scene/body.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// At most this many roots are used to find the head's motion.
enum { MOST_POINTS = 20000 };

// Sample rate (per second) for which the limits of cuts are defined.
static const double FULL_RATE = 24;

static void anchors_destroy(BodyAnchors *anchors)
{
    free(anchors->points);
    free(anchors->from);
    free(anchors->to);
    *anchors = (BodyAnchors){0};
}

void body_destroy(Body *body)
{
    anchors_destroy(&body->anchors);
    for (uint32_t i = 0; body->roots && i < body->section_count; ++i)
        mesh_binding_destroy(&body->roots[i]);
    free(body->roots);
    free(body->head.motion);
    mesh_sequence_destroy(&body->sequence);
    *body = (Body){0};
}

// --- Binding.

static Result bind_section(MeshBinding *binding, const Mesh *mesh, const char *name,
                           const Strands *strands, Error *error)
{
    float(*roots)[3] = malloc(((size_t)strands->strand_count + 1) * sizeof *roots);
    if (!roots)
        return error_set(error, RESULT_FAILED, "no memory for %u roots", strands->strand_count);
    for (uint32_t s = 0; s < strands->strand_count; ++s)
        memcpy(roots[s], strands->position[strands->first[s]], sizeof *roots);
    mesh_binding_destroy(binding);
    Result result = mesh_binding_create(binding, mesh, name, (const float(*)[3])roots,
                                        strands->strand_count, error);
    free(roots);
    return result;
}

static Result bind_all(Body *body, const Mesh *mesh, const Strands *strands, Error *error)
{
    for (uint32_t i = 0; i < body->section_count; ++i)
        TRY(bind_section(&body->roots[i], mesh, body->name, &strands[i], error));
    return RESULT_OK;
}

float body_distance(const Body *body)
{
    float most = 0;
    for (uint32_t i = 0; i < body->section_count; ++i) most = fmaxf(most, body->roots[i].median);
    return most;
}

static Result check_distance(const Body *body, Error *error)
{
    float far = body_distance(body);
    if (far <= BODY_FAR) return RESULT_OK;
    return error_set(error, RESULT_BAD_INPUT,
                     "%s: half of the roots are more than %.3g m from the mesh: expected at most "
                     "%.3g m (check --mesh-unit, --mesh-up and --mesh-rest)",
                     body->name, (double)far, (double)BODY_FAR);
}

// --- The head.

static Result anchors_create(BodyAnchors *anchors, const Body *body, Error *error)
{
    uint64_t all = 0;
    for (uint32_t i = 0; i < body->section_count; ++i) all += body->roots[i].count;
    uint64_t stride = 1 + all / MOST_POINTS, number = 0;
    size_t room = (size_t)(all / stride) + 2;
    *anchors = (BodyAnchors){.points = calloc(room, sizeof *anchors->points),
                             .from = calloc(room, sizeof *anchors->from),
                             .to = calloc(room, sizeof *anchors->to)};
    if (!anchors->points || !anchors->from || !anchors->to)
        return error_set(error, RESULT_FAILED, "no memory for the head's motion");
    for (uint32_t i = 0; i < body->section_count; ++i)
        for (uint32_t s = 0; s < body->roots[i].count; ++s, ++number)
            if (number % stride == 0) anchors->points[anchors->count++] = body->roots[i].points[s];
    return RESULT_OK;
}

static void place_anchors(const BodyAnchors *anchors, const float (*position)[3], Double3 *places)
{
    for (uint32_t i = 0; i < anchors->count; ++i)
        for (int k = 0; k < 3; ++k) {
            places[i][k] = 0;
            for (int c = 0; c < 3; ++c)
                places[i][k] += anchors->points[i].weight[c] *
                                (double)position[anchors->points[i].corner[c]][k];
        }
}

static void find_middle(const BodyAnchors *anchors, Double3 middle)
{
    memset(middle, 0, sizeof(Double3));
    for (uint32_t i = 0; i < anchors->count; ++i)
        double3_add_scaled(middle, 1.0 / anchors->count, anchors->from[i]);
}

// Finds the head's motion at each sample, relative to sample `origin`.
static void find_motions(Body *body, BodyAnchors *anchors, uint32_t origin)
{
    MeshSequence *sequence = &body->sequence;
    place_anchors(anchors, (const float(*)[3])mesh_sequence_at(sequence, origin), anchors->from);
    // From the origin in both directions, so that each fit starts from its neighbour in time.
    for (int64_t way = -1; way <= 1; way += 2) {
        RigidMotion near = {.rotation = {0, 0, 0, 1}};
        for (int64_t i = origin; i >= 0 && i < sequence->times.count; i += way) {
            place_anchors(anchors, (const float(*)[3])mesh_sequence_at(sequence, (uint32_t)i),
                          anchors->to);
            if (i != origin)
                near = rigid_motion_fit((const double(*)[3])anchors->from,
                                        (const double(*)[3])anchors->to, anchors->count, &near);
            body->head.motion[i] = near;
        }
    }
}

static void find_cuts(Body *body, const BodyAnchors *anchors, const BodyOptions *options)
{
    SampleTimes *times = &body->sequence.times;
    double slower = fmax(1, FULL_RATE / times->rate);
    Double3 middle, before, after;
    find_middle(anchors, middle);
    for (uint32_t i = 0; i + 1 < times->count; ++i) {
        RigidMotion back = rigid_motion_inverse(&body->head.motion[i]),
                    way = rigid_motion_product(&body->head.motion[i + 1], &back);
        rigid_motion_apply(&body->head.motion[i], middle, before);
        rigid_motion_apply(&body->head.motion[i + 1], middle, after);
        double sine = sqrt(way.rotation[0] * way.rotation[0] + way.rotation[1] * way.rotation[1] +
                           way.rotation[2] * way.rotation[2]),
               angle = 2 * atan2(sine, fabs(way.rotation[3])) * 57.29577951308232;
        times->cut[i] = double3_distance(before, after) > slower * (double)options->cut_distance ||
                        angle > slower * (double)options->cut_angle_deg;
    }
    body->head.times = *times;
}

static void move_points(const RigidMotion *motion, float (*position)[3], size_t count)
{
    for (size_t v = 0; v < count; ++v) {
        Double3 p, moved;
        double3_from_float(position[v], p);
        rigid_motion_apply(motion, p, moved);
        for (int k = 0; k < 3; ++k) position[v][k] = (float)moved[k];
    }
}

// Makes the motions relative to time 0, and converts the positions to the head's frame.
static void part_motion(Body *body)
{
    MeshSequence *sequence = &body->sequence;
    RigidMotion start = rigid_samples_evaluate(&body->head, 0), back = rigid_motion_inverse(&start);
    for (uint32_t i = 0; i < sequence->times.count; ++i) {
        RigidMotion *motion = &body->head.motion[i], own;
        *motion = rigid_motion_product(motion, &back);
        own = rigid_motion_inverse(motion);
        const double *q = own.rotation, *t = own.translation;
        bool still = q[0] == 0 && q[1] == 0 && q[2] == 0 && t[0] == 0 && t[1] == 0 && t[2] == 0;
        if (!still) move_points(&own, mesh_sequence_at(sequence, i), sequence->vertex_count);
    }
}

void body_drive(Body *body, float (*position)[3], double before, double after)
{
    MeshSequence *sequence = &body->sequence;
    BodyAnchors *anchors = &body->anchors;
    RigidMotion *motion = body->head.motion;
    place_anchors(anchors, (const float(*)[3])position, anchors->to);
    motion[0] = motion[1];
    motion[1] = rigid_motion_fit((const double(*)[3])anchors->from, (const double(*)[3])anchors->to,
                                 anchors->count, &motion[0]);
    RigidMotion back = rigid_motion_inverse(&motion[1]);
    move_points(&back, position, sequence->vertex_count);
    mesh_sequence_push(sequence, (const float(*)[3])position, before, after);
    body->head.times = sequence->times;
}

// --- The groom.

// Carries all strands from the rest pose to `position`.
static Result carry_groom(const Body *body, const Mesh *rest, const float (*position)[3],
                          Strands *strands, Error *error)
{
    MeshTurns turns;
    TRY(mesh_turns_create(&turns, rest, error));
    double(*turn)[4] = calloc((size_t)rest->vertex_count + 1, sizeof *turn);
    for (uint32_t v = 0; turn && v < rest->vertex_count; ++v)
        mesh_turns_find(&turns, v, position, turn[v]);
    for (uint32_t i = 0; turn && i < body->section_count; ++i)
        for (uint32_t s = 0; s < strands[i].strand_count; ++s) {
            RigidMotion motion =
                mesh_binding_motion(&body->roots[i], s, position, (const double(*)[4])turn);
            move_points(&motion, &strands[i].position[strands[i].first[s]],
                        strands[i].first[s + 1] - strands[i].first[s]);
        }
    Result result = turn ? RESULT_OK : error_set(error, RESULT_FAILED, "no memory for a groom");
    free(turn);
    mesh_turns_destroy(&turns);
    return result;
}

static Result find_head(Body *body, const BodyOptions *options, Error *error)
{
    BodyAnchors anchors;
    Result result = anchors_create(&anchors, body, error);
    if (result == RESULT_OK) {
        body->head.times = body->sequence.times;
        find_motions(body, &anchors, sample_span(&body->head.times, 0).near);
        find_cuts(body, &anchors, options);
        part_motion(body);
    }
    if (options->driven)
        body->anchors = anchors;
    else
        anchors_destroy(&anchors);
    return result;
}

static Result build(Body *body, Mesh *mesh, const Mesh *rest, Strands *strands,
                    const BodyOptions *options, Error *error)
{
    MeshSequence *sequence = &body->sequence;
    uint32_t count = sequence->times.count;
    body->roots = calloc((size_t)body->section_count + 1, sizeof *body->roots);
    body->head.motion = calloc((size_t)count + 1, sizeof *body->head.motion);
    sequence->times.cut = calloc((size_t)count + 1, sizeof *sequence->times.cut);
    if (!body->roots || !body->head.motion || !sequence->times.cut)
        return error_set(error, RESULT_FAILED, "no memory for %u samples of a mesh", count);
    mesh_sequence_evaluate(sequence, 0, mesh->position);
    TRY(bind_all(body, rest->vertex_count ? rest : mesh, strands, error));
    TRY(check_distance(body, error));
    TRY(find_head(body, options, error));
    mesh_sequence_evaluate(sequence, 0, mesh->position);
    mesh_compute_normals(mesh);
    if (rest->vertex_count)
        TRY(carry_groom(body, rest, (const float(*)[3])mesh->position, strands, error));
    float far = body_distance(body);
    TRY(bind_all(body, mesh, strands, error));
    for (uint32_t i = 0; i < body->section_count; ++i) body->roots[i].median = far;
    return RESULT_OK;
}

Result body_create(Body *body, MeshSequence *sequence, Mesh *mesh, const Mesh *rest,
                   Strands *strands, uint32_t section_count, const BodyOptions *options,
                   Error *error)
{
    *body = (Body){
        .sequence = *sequence, .mesh = mesh, .name = options->name, .section_count = section_count};
    *sequence = (MeshSequence){0};
    Result result = build(body, mesh, rest, strands, options, error);
    if (result != RESULT_OK) body_destroy(body);
    return result;
}

void body_middle(const Body *body, float middle[3])
{
    Double3 sum = {0};
    uint64_t count = 0;
    for (uint32_t i = 0; i < body->section_count; ++i)
        for (uint32_t s = 0; s < body->roots[i].count; ++s, ++count)
            double3_add_scaled(sum, 1, body->roots[i].points[s].place);
    for (int k = 0; k < 3; ++k) middle[k] = count ? (float)(sum[k] / (double)count) : 0;
}
