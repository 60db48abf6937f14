// SPDX-License-Identifier: MIT
#include "run/stats.h"

#include "base/json.h"
#include "gpu/shader.h"

#include "version.h"

#include <sys/resource.h>

// Rounds to a microsecond; further digits would be noise.
static json_t *milliseconds(double ms)
{
    return json_real((double)(long long)(ms * 1e3 + 0.5) / 1e3);
}

Result stats_create(Stats *stats, Error *error)
{
    *stats = (Stats){.root = json_object(), .frames = json_array()};
    if (stats->root && stats->frames) return RESULT_OK;
    stats_destroy(stats);
    return error_set(error, RESULT_FAILED, "no memory for statistics");
}

void stats_destroy(Stats *stats)
{
    json_decref(stats->root);
    json_decref(stats->frames);
    *stats = (Stats){0};
}

static json_t *describe_device(const Gpu *gpu)
{
    json_t *device = json_object();
    json_object_set_new(device, "renderer", json_string(gpu->renderer));
    json_object_set_new(device, "version", json_string(gpu->version));
    json_object_set_new(device, "vendor", json_string(gpu->vendor));
    json_object_set_new(device, "path", json_string(gpu->path));
    json_object_set_new(device, "pci", json_string(gpu->identity.pci));
    json_object_set_new(device, "uuid", json_string(gpu->identity.uuid));
    json_object_set_new(device, "software", json_boolean(gpu->software));
    json_object_set_new(device, "processor", json_string(gpu->processor));
    return device;
}

static json_t *describe_section(const char *file, const StrandsReport *report,
                                const SimulationSection *simulated)
{
    const Hair *hair = &simulated->hair;
    json_t *section = json_object();
    json_object_set_new(section, "file", json_string(file));
    json_object_set_new(section, "kind", json_string(FORMAT_TABLE[report->kind]->name));
    json_object_set_new(section, "metres_per_unit", json_real((double)report->unit_used));
    json_object_set_new(section, "up", json_string(report->up_z ? "z" : "y"));
    json_object_set_new(section, "strands", json_integer(hair->strand_count));
    json_object_set_new(section, "followers", json_integer(simulated->follow.hair.strand_count));
    json_object_set_new(section, "strands_in_file", json_integer(report->declared_strands));
    json_object_set_new(section, "particles", json_integer((json_int_t)hair->particle_count));
    json_object_set_new(section, "batches", json_integer(hair->batch_count));
    return section;
}

void stats_describe(Stats *stats, const Gpu *gpu, const Scene *scene, const Assets *assets,
                    const Simulation *simulation)
{
    if (!stats->root) return;
    json_t *hair = json_array();
    for (uint32_t i = 0; i < scene->section_count; ++i)
        json_array_append_new(hair, describe_section(scene->sections[i].file, &assets->reports[i],
                                                     &simulation->sections[i]));
    json_object_set_new(stats->root, "program", json_string("tractrix-render"));
    json_object_set_new(stats->root, "version", json_string(TRACTRIX_VERSION));
    json_object_set_new(stats->root, "commit", json_string(TRACTRIX_COMMIT));
    json_object_set_new(stats->root, "shaders",
                        json_string(shader_folder() ? shader_folder() : "built in"));
    json_object_set_new(stats->root, "device", describe_device(gpu));
    json_object_set_new(stats->root, "hair", hair);
    json_object_set_new(stats->root, "parameters", scene_to_json(scene));
}

void stats_add_exposure(Stats *stats, float exposure)
{
    if (stats->root) json_object_set_new(stats->root, "exposure", json_real((double)exposure));
}

void stats_add_frame(Stats *stats, GpuTimer *timer, const FrameTimes *times,
                     const RendererCounts *counts)
{
    if (!stats->root) return;
    gpu_timer_collect(timer);
    json_t *frame = json_object(), *passes = json_object();
    for (int i = 0; i < timer->count; ++i) {
        double total = timer->labels[i].total_ms;
        if (total > stats->pass_total_ms[i])
            json_object_set_new(passes, timer->labels[i].name,
                                milliseconds(total - stats->pass_total_ms[i]));
        stats->pass_total_ms[i] = total;
    }
    json_object_set_new(frame, "frame", json_integer(times->frame));
    json_object_set_new(frame, "simulate_ms", milliseconds(times->simulate_ms));
    json_object_set_new(frame, "draw_ms", milliseconds(times->draw_ms));
    json_object_set_new(frame, "wait_ms", milliseconds(times->wait_ms));
    json_object_set_new(frame, "gpu_ms", passes);
    json_object_set_new(frame, "segments", json_integer((json_int_t)counts->segments));
    json_object_set_new(frame, "strands_culled", json_integer((json_int_t)counts->culled));
    json_object_set_new(frame, "strands_hidden", json_integer((json_int_t)counts->hidden));
    json_object_set_new(frame, "strands_thinned", json_integer((json_int_t)counts->thinned));
    json_object_set_new(frame, "shadow_maps", json_integer((json_int_t)counts->shadow_maps));
    json_object_set_new(frame, "fragments", json_integer((json_int_t)counts->fragments));
    json_object_set_new(frame, "redraws", json_integer(counts->redraws));
    json_object_set_new(frame, "bands", json_integer(counts->bands));
    json_array_append_new(stats->frames, frame);
}

void stats_add_wall(Stats *stats, const char *name, double ms)
{
    if (!stats->root) return;
    json_t *wall = json_object_get(stats->root, "wall");
    if (!wall) {
        wall = json_object();
        json_object_set_new(stats->root, "wall", wall);
    }
    json_object_set_new(wall, name, milliseconds(ms));
}

static json_t *describe_passes(const GpuTimer *timer)
{
    json_t *passes = json_object();
    for (int i = 0; i < timer->count; ++i) {
        const TimerLabel *label = &timer->labels[i];
        json_t *pass = json_object();
        json_object_set_new(pass, "runs", json_integer(label->read));
        json_object_set_new(pass, "total_ms", milliseconds(label->total_ms));
        json_object_set_new(pass, "mean_ms",
                            milliseconds(label->read ? label->total_ms / label->read : 0));
        json_object_set_new(passes, label->name, pass);
    }
    return passes;
}

static json_t *describe_counts(const Simulation *simulation, int frames_drawn, int frames_repeated)
{
    SolverReport report = simulation_report(simulation);
    int simulated = simulation->frame + 1;
    json_t *counts = json_object();
    json_object_set_new(counts, "frames_simulated", json_integer(simulated));
    json_object_set_new(counts, "frames_drawn", json_integer(frames_drawn));
    json_object_set_new(counts, "frames_not_drawn",
                        json_integer(simulated - frames_drawn - frames_repeated));
    json_object_set_new(counts, "frames_repeated", json_integer(frames_repeated));
    json_object_set_new(counts, "steps", json_integer((json_int_t)simulation->steps));
    json_object_set_new(counts, "substeps", json_integer(simulation->substeps));
    json_object_set_new(counts, "steps_settling",
                        json_integer((json_int_t)simulation->schedule.settling));
    json_object_set_new(counts, "steps_per_s", json_real(simulation->schedule.steps_per_s));
    json_object_set_new(counts, "strand_steps", json_integer((json_int_t)simulation->strand_steps));
    json_object_set_new(counts, "strand_steps_asleep",
                        json_integer((json_int_t)simulation->strand_steps_asleep));
    json_object_set_new(counts, "poses", json_integer((json_int_t)simulation->poses));
    json_object_set_new(counts, "poses_skipped",
                        json_integer((json_int_t)simulation->poses_skipped));
    json_object_set_new(counts, "head_jumps", json_integer((json_int_t)simulation->jumps));
    json_object_set_new(counts, "moves_limited", json_integer((json_int_t)report.moves_limited));
    if (report.groom_weight > 0)
        json_object_set_new(counts, "groom_held_share",
                            json_real(report.groom_held / report.groom_weight));
    json_object_set_new(counts, "strands_slowed", json_integer((json_int_t)report.strands_slowed));
    json_object_set_new(counts, "contacts", json_integer((json_int_t)report.contacts));
    json_object_set_new(counts, "deepest_found_m", json_real((double)report.deepest_found));
    json_object_set_new(counts, "deepest_left_m", json_real((double)report.deepest_left));
    return counts;
}

void stats_finish(Stats *stats, const GpuTimer *timer, const Simulation *simulation,
                  int frames_drawn, int frames_repeated, const OutputCounters *output)
{
    if (!stats->root) return;
    json_object_set_new(stats->root, "counts",
                        describe_counts(simulation, frames_drawn, frames_repeated));
    json_object_set_new(stats->root, "passes", describe_passes(timer));
    if (output) {
        json_t *files = json_object();
        json_object_set_new(files, "frames", json_integer(output->frames));
        json_object_set_new(files, "bytes", json_integer((json_int_t)output->bytes));
        json_object_set_new(files, "encode_ms", milliseconds(output->encode_ms));
        json_object_set_new(stats->root, "output", files);
    }
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    json_object_set_new(stats->root, "peak_memory_kib", json_integer(usage.ru_maxrss));
    json_object_set(stats->root, "frames", stats->frames);
}

Result stats_write(const Stats *stats, const char *path, Error *error)
{
    return json_write_file(stats->root, path, error);
}
