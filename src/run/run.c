// SPDX-License-Identifier: MIT
#include "run/run.h"
#include "base/interrupt.h"
#include "base/target.h"
#include "run/caption.h"
#include "run/survey.h"
#include "scene/effects.h"
#include "scene/fit.h"
#include "strands/strands.h"

#include <string.h>

void run_destroy(Run *run)
{
    if (run->exports) exporter_destroy(&run->exporter);
    resume_destroy(&run->resume);
    if (run->has_gpu) {
        frame_source_close(&run->source);
        pictures_destroy(&run->pictures);
        simulation_destroy(&run->simulation);
        gpu_timer_destroy(&run->timer);
        gpu_destroy(&run->gpu);
    }
    stats_destroy(&run->stats);
    assets_destroy(&run->assets);
    scene_destroy(&run->scene);
}

static GpuOptions gpu_options(const RunParams *params)
{
    GpuOptions options = {
        .backend = (Backend)params->backend,
        .device = params->device,
        .software = params->software,
        .require_hardware = params->require_hardware,
    };
#ifdef TRACTRIX_DEBUG
    options.debug = true;
#endif
    return options;
}

static void warn_all(const Scene *scene)
{
    effects_warn(scene, stderr);
    for (uint32_t i = 0; i < scene->section_count; ++i) {
        const Section *section = &scene->sections[i];
        const char *caution = solver_caution(&section->params);
        if (caution)
            fprintf(stderr, "%s: --algo %s: %s\n", section->file, section->params.algo, caution);
    }
}

static Result open_gpu(Run *run, Error *error)
{
    const RunParams *params = &run->scene.run;
    const GpuOptions options = gpu_options(params);
    Result result = gpu_create(&run->gpu, &options, error);
    if (result != RESULT_OK) return result;
    run->has_gpu = true;
    gpu_timer_create(&run->timer, *params->stats != 0, run->gpu.software);
    if (!params->quiet)
        fprintf(stderr, "%s, OpenGL %s (%s)\n", run->gpu.renderer, run->gpu.version, run->gpu.path);
    return RESULT_OK;
}

// A name of files is one of its kind, and holds a share of the frames if no more is asked for.
static Result check_target(const RunParams *run, const char *path,
                           Result (*parse)(Target *target, const char *text, Error *error),
                           Error *error)
{
    Target target = {0};
    if (!*path) return RESULT_OK;
    Result result = parse(&target, path, error);
    if (result == RESULT_OK && target.kind == TARGET_VIDEO && run->part[1] > 1)
        result = error_set(error, RESULT_USAGE,
                           "--part: %s holds all frames, expected a file for each", path);
    target_destroy(&target);
    return result;
}

static Result check_sheet(const RunParams *run, Error *error)
{
    const int *sheet = run->contact_sheet;
    if ((sheet[0] == 1 && sheet[1] == 1) || run->part[1] == 1) return RESULT_OK;
    return error_set(error, RESULT_USAGE,
                     "--contact-sheet %dx%d: expected no --part, since one file holds all frames",
                     sheet[0], sheet[1]);
}

// What can be said before any file is opened.
static Result check_words(const Scene *scene, Error *error)
{
    const RunParams *run = &scene->run;
    Result result = check_target(run, run->output, target_parse, error);
    if (result == RESULT_OK) result = check_target(run, run->export, format_target, error);
    if (result == RESULT_OK) result = check_sheet(run, error);
    if (result == RESULT_OK) result = caption_check(run->caption, error);
    bool fits = run->framing == FRAMING_HAIR || run->framing == FRAMING_ALL;
    if (result == RESULT_OK && fits && !fit_is_free(scene))
        result =
            error_set(error, RESULT_USAGE,
                      "--framing %s: expected an automatic --eye, and no keys of eye or target",
                      run->framing == FRAMING_ALL ? "all" : "hair");
    for (uint32_t i = 0; i < scene->section_count && result == RESULT_OK; ++i)
        result = solver_check(&scene->sections[i].params, error);
    return result;
}

static Result find_done(Run *run, Error *error)
{
    const RunParams *params = &run->scene.run;
    if (!params->resume) return RESULT_OK;
    Result result = resume_find(&run->resume, params, sequence_last_frame(params), error);
    if (run->resume.count && !params->quiet)
        fprintf(stderr, "%d of %d frames are there\n", run->resume.count,
                sequence_count_drawn(params));
    return result;
}

static void tell_lost(const Exporter *exporter)
{
    char lost[300];
    strands_features_describe(exporter->lost, lost, sizeof lost);
    if (*lost)
        fprintf(stderr, "--export: %s files leave out: %s\n", FORMAT_TABLE[exporter->kind]->name,
                lost);
}

static Result open_source(Run *run, Error *error)
{
    const RunParams *params = &run->scene.run;
    Result result =
        frame_source_open(&run->source, &run->simulation, run->assets.strands,
                          sequence_last_frame(params), params->quiet ? NULL : stderr, error);
    if (result == RESULT_OK && *params->export) {
        result = exporter_create(&run->exporter, params->export, sequence_count_drawn(params),
                                 &run->simulation, run->assets.strands, error);
        run->exports = result == RESULT_OK;
        if (run->exports && !params->quiet) tell_lost(&run->exporter);
    }
    return result;
}

static void tell_steps(const Simulation *simulation)
{
    const Schedule *schedule = &simulation->schedule;
    fprintf(stderr, "steps of %.6g ms, %d a %s, %.6g a frame", 1e3 / schedule->steps_per_s,
            simulation->substeps, simulation->scene->run.sim_rate > 0 ? "period" : "frame",
            schedule->steps_per_frame);
    fprintf(stderr, schedule->settling ? ", %lld before the first\n" : "\n",
            (long long)schedule->settling);
}

// Where the camera stands, unless the scene says it.
static Result aim(Run *run, Error *error)
{
    const RunParams *params = &run->scene.run;
    SurveyReport report;
    outline_frame(&run->framing, &run->scene, run->assets.strands,
                  run->assets.has_mesh ? &run->assets.mesh : NULL);
    if (!survey_is_wanted(&run->scene)) return RESULT_OK;
    Result result =
        survey_fit_camera(&run->framing, &report, &run->scene, &run->assets, &run->gpu, error);
    if (result == RESULT_OK && params->verbose)
        fprintf(stderr, "camera: fits %d frames, looked at in %.2g s\n", report.frames,
                report.ms / 1e3);
    if (result == RESULT_OK && !params->quiet && report.step.most > 0)
        fprintf(stderr,
                "loop: from the last frame to the first hair moves by %.3g mm at most (RMS %.3g), "
                "from others to the next by %.3g mm (%.3g)\n",
                1e3 * (double)report.seam.most, 1e3 * (double)report.seam.rms,
                1e3 * (double)report.step.most, 1e3 * (double)report.step.rms);
    return result;
}

// Files first: what is wrong with them is told before a driver is started. The output's folder is
// made last but before any work.
static Result prepare(Run *run, Error *error)
{
    const RunParams *params = &run->scene.run;
    bool draws = *params->output != 0;
    Result result = check_words(&run->scene, error);
    if (result == RESULT_OK) result = find_done(run, error);
    if (result == RESULT_OK)
        result = assets_load(&run->assets, &run->scene, params->quiet ? NULL : stderr,
                             params->verbose, error);
    run->loaded_ms = stats_clock_ms();
    if (result == RESULT_OK && !params->quiet) warn_all(&run->scene);
    if (result == RESULT_OK) result = open_gpu(run, error);
    if (result == RESULT_OK && draws) result = aim(run, error);
    if (result == RESULT_OK)
        result = simulation_create(&run->simulation, &run->gpu, &run->timer, &run->scene,
                                   run->assets.strands, &run->assets.mesh, error);
    if (result == RESULT_OK) result = open_source(run, error);
    if (result == RESULT_OK && draws)
        result = pictures_create(&run->pictures, &run->scene, &run->assets, &run->simulation,
                                 &run->framing, &run->gpu, &run->timer,
                                 sequence_count_drawn(params) - run->resume.count, error);
    if (result == RESULT_OK && *params->stats) {
        result = stats_create(&run->stats, error);
        stats_describe(&run->stats, &run->gpu, &run->scene, &run->assets, &run->simulation);
    }
    if (result == RESULT_OK && params->verbose) tell_steps(&run->simulation);
    run->ready_ms = stats_clock_ms();
    return result;
}

static void tell_result(const Run *run, const Sequence *sequence, double ms)
{
    int frames = run->pictures.output ? sequence->frames_drawn + sequence->frames_repeated
                                      : run->simulation.frame + 1;
    SolverReport report = simulation_report(&run->simulation);
    if (report.moves_limited && run->scene.run.verbose)
        fprintf(stderr, "%llu moves of more than 100 strand lengths a step were cut\n",
                (unsigned long long)report.moves_limited);
    const CacheWriter *cache = &run->source.writer;
    if (cache->frame_count && run->scene.run.verbose)
        fprintf(stderr, "%s: %u frames, %.3g MB, %.3g ms a frame to pack and write\n", cache->path,
                cache->frame_count, (double)cache->at * 1e-6, cache->write_ms / cache->frame_count);
    fprintf(stderr, "%d frame%s in %.1f s, %.3g a second", frames, frames == 1 ? "" : "s", ms / 1e3,
            frames * 1e3 / ms);
    bool described = run->pictures.output && frames > 0;
    fprintf(stderr, described ? ": %s\n" : "%s\n",
            described ? output_describe(run->pictures.output) : "");
}

static Result write_stats(Run *run, const Sequence *sequence, Error *error)
{
    const RunParams *params = &run->scene.run;
    if (!*params->stats) return RESULT_OK;
    OutputCounters counters = {0};
    if (run->pictures.output) counters = output_count(run->pictures.output);
    stats_add_wall(&run->stats, "load_ms", run->loaded_ms - run->begin_ms);
    stats_add_wall(&run->stats, "set_up_ms", run->ready_ms - run->loaded_ms);
    stats_add_wall(&run->stats, "frames_ms", stats_clock_ms() - run->ready_ms);
    stats_add_wall(&run->stats, "total_ms", stats_clock_ms() - run->begin_ms);
    stats_finish(&run->stats, &run->timer, &run->simulation, sequence->frames_drawn,
                 sequence->frames_repeated, run->pictures.output ? &counters : NULL);
    return stats_write(&run->stats, params->stats, error);
}

Result run_go(Run *run, Error *error)
{
    Result result = prepare(run, error);
    if (result != RESULT_OK) return result;
    Sequence sequence = {
        .scene = &run->scene,
        .source = &run->source,
        .pictures = &run->pictures,
        .exporter = run->exports ? &run->exporter : NULL,
        .done = run->resume.done,
        .timer = &run->timer,
        .stats = &run->stats,
    };
    result = sequence_run(&sequence, error);
    if (result == RESULT_OK && run->pictures.output &&
        run->resume.count < sequence_count_drawn(&run->scene.run))
        result = output_finish(run->pictures.output, error);
    if (result == RESULT_OK && run->exports) result = exporter_finish(&run->exporter, error);
    if (result == RESULT_OK) result = frame_source_finish(&run->source, error);
    if (result == RESULT_OK) result = write_stats(run, &sequence, error);
    if (result == RESULT_OK && !run->scene.run.quiet)
        tell_result(run, &sequence, stats_clock_ms() - run->begin_ms);
    return result;
}
