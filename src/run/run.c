// SPDX-License-Identifier: MIT
#include "run/run.h"
#include "base/activity.h"
#include "base/clock.h"
#include "base/interrupt.h"
#include "base/outfile.h"
#include "base/quote.h"
#include "base/target.h"
#include "gpu/gl_count.h"
#include "run/cache_scene.h"
#include "run/caption.h"
#include "run/exposure.h"
#include "run/run_paths.h"
#include "run/survey.h"
#include "scene/effects.h"
#include "scene/scalp_guess.h"
#include "strands/follow_plan.h"

#include <stdlib.h>
#include <string.h>

void run_destroy(Run *run)
{
    activity_end();
    if (run->exports) exporter_destroy(&run->exporter);
    resume_destroy(&run->done);
    fingerprint_destroy(&run->fingerprint);
    if (run->has_gpu) {
        frame_source_close(&run->source);
        output_destroy(run->output);
        images_destroy(&run->images);
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
    options.debug = stderr;
#endif
    return options;
}

Result run_print_platform(const RunParams *params, FILE *stream, Error *error)
{
    Gpu gpu;
    const GpuOptions options = gpu_options(params);
    TRY(gpu_create(&gpu, &options, error));
    fprintf(stream, "%s\n", gpu.platform);
    gpu_destroy(&gpu);
    return RESULT_OK;
}

static void warn_all(const Scene *scene)
{
    effects_warn(scene, stderr);
    for (uint32_t i = 0; i < scene->section_count; ++i) {
        const Section *section = &scene->sections[i];
        const char *caution = solver_caution(&section->params);
        if (caution)
            fprintf(stderr, "%s: --algo %s: %s\n", quote(section->file).text, section->params.algo,
                    caution);
    }
}

static Result open_gpu(Run *run, Error *error)
{
    const RunParams *params = &run->scene.run;
    const GpuOptions options = gpu_options(params);
    TRY(gpu_create(&run->gpu, &options, error));
    run->has_gpu = true;
    gpu_timer_create(&run->timer, *params->stats != 0, run->gpu.software);
    if (!params->quiet)
        fprintf(stderr, "%s, OpenGL %s (%s)\n", quote(run->gpu.renderer).text,
                quote(run->gpu.version).text, run->gpu.path);
    if (!params->quiet && *run->gpu.passed_over.text)
        fprintf(stderr, "no GPU is used: %s\n", run->gpu.passed_over.text);
    return RESULT_OK;
}

// The name must have a known suffix. With --part it must name a file per frame.
static Result check_target(const RunParams *run, const char *path,
                           Result (*parse)(Target *target, const char *text, Error *error),
                           Error *error)
{
    Target target = {0};
    if (!*path) return RESULT_OK;
    Result result = parse(&target, path, error);
    if (result == RESULT_OK && target.stream) result = outfile_refuse_terminal("-", error);
    if (result == RESULT_OK && target.stream && outfile_is_stdout(run->stats))
        result = error_set(error, RESULT_USAGE,
                           "--stats -: images go to standard output: expected a file");
    if (result == RESULT_OK && target.kind == TARGET_VIDEO && run->part[1] > 1)
        result =
            error_set(error, RESULT_USAGE,
                      "--part: %s is one file with all frames: expected one file per frame", path);
    target_destroy(&target);
    return result;
}

static Result check_sheet(const RunParams *run, Error *error)
{
    const int *sheet = run->contact_sheet;
    if ((sheet[0] == 1 && sheet[1] == 1) || run->part[1] == 1) return RESULT_OK;
    return error_set(
        error, RESULT_USAGE,
        "--part: a contact sheet of %dx%d is one file with all frames: expected one file per frame",
        sheet[0], sheet[1]);
}

Result run_check(const Scene *scene, Error *error)
{
    const RunParams *run = &scene->run;
    TRY(check_target(run, run->output, target_parse, error));
    TRY(check_target(run, run->export, format_target, error));
    TRY(check_sheet(run, error));
    if (run->resume) TRY(resume_check(run, error));
    TRY(run_paths_claim(scene, error));
    if (*run->output) TRY(images_output_check(run, sequence_count_drawn(run), error));
    if (*run->export) TRY(exporter_check(run->export, sequence_count_drawn(run), error));
    TRY(caption_check(run->caption, error));
    for (uint32_t i = 0; i < scene->section_count; ++i)
        TRY(solver_check(&scene->sections[i].params, error));
    return RESULT_OK;
}

// Refuses a file that is not a cache or has too few frames, before hair is read.
static Result check_cache(const RunParams *run, Error *error)
{
    CacheFile cache;
    if (!*run->from_cache) return RESULT_OK;
    Result result = cache_file_open(&cache, run->from_cache, error);
    THEN(result, cache_file_check(&cache, sequence_last_frame(run), error));
    cache_file_close(&cache);
    return result;
}

// Refuses a cache of a scene with other values or other hair, before a device is opened. Whether it
// belongs to the same meshes is checked later, because this needs the simulation.
static Result check_cache_scene(const Scene *scene, const Strands *strands, Error *error)
{
    CacheFile cache;
    if (!*scene->run.from_cache) return RESULT_OK;
    Result result = cache_file_open(&cache, scene->run.from_cache, error);
    THEN(result, cache_scene_compare_values(&cache.scene, scene, scene->run.from_cache, error));
    THEN(result,
         cache_scene_compare_strands(&cache.hair, scene, strands, scene->run.from_cache, error));
    cache_file_close(&cache);
    return result;
}

// Computes the fingerprint of the run's frames. If another program version or driver made the cache
// that is drawn, the fingerprint includes that maker.
static Result describe(Run *run, Error *error)
{
    char *maker = NULL;
    if (run->source.reads) {
        maker = cache_scene_maker(&run->source.reader.cache.scene);
        if (!maker) return error_set(error, RESULT_FAILED, "no memory for a cache's scene");
    }
    bool own = maker && strcmp(maker, cache_scene_own_maker()) == 0;
    Result result = fingerprint_create(&run->fingerprint, &run->scene, &run->assets, &run->framing,
                                       run->exposure, &run->gpu, own ? NULL : maker, error);
    free(maker);
    return result;
}

// Finds the finished frames of an interrupted run.
static Result find_done(Run *run, Error *error)
{
    const RunParams *params = &run->scene.run;
    FramesDone *done = &run->done;
    if (!params->resume) return RESULT_OK;
    TRY(resume_find(done, params, sequence_last_frame(params), &run->fingerprint, error));
    if (params->quiet) return RESULT_OK;
    if (done->count)
        fprintf(stderr, "%d of %d frames are already written\n", done->count,
                sequence_count_drawn(params));
    if (done->stale)
        fprintf(stderr, "%d existing file%s will be written again: %s\n", done->stale,
                done->stale == 1 ? "" : "s", done->why.text);
    return RESULT_OK;
}

static void warn_lost(const Exporter *exporter)
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
    FILE *messages = params->quiet ? NULL : stderr;
    TRY(frame_source_open(&run->source, &run->simulation, run->assets.strands,
                          sequence_last_frame(params), messages, error));
    if (!*params->export) return RESULT_OK;
    TRY(exporter_create(&run->exporter, params->export, sequence_count_drawn(params),
                        &run->simulation, run->assets.strands, error));
    run->exports = true;
    if (!params->quiet) warn_lost(&run->exporter);
    return RESULT_OK;
}

static void report_steps(const Simulation *simulation)
{
    const Schedule *schedule = &simulation->schedule;
    fprintf(stderr, "steps of %.6g ms, %d a %s, %.6g a frame", 1e3 / schedule->steps_per_s,
            simulation->substeps, simulation->scene->run.sim_rate > 0 ? "period" : "frame",
            schedule->steps_per_frame);
    fprintf(stderr, schedule->settling ? ", %lld before the first\n" : "\n",
            (long long)schedule->settling);
}

// Prints an automatic camera as values of the options that set it, unless the scene moves it.
static void report_camera(const Run *run)
{
    const RunParams *params = &run->scene.run;
    const float *eye = run->framing.eye, *target = run->framing.target;
    bool moves = track_is_given(&run->scene.eye) || track_is_given(&run->scene.target);
    if (!params->verbose || moves || !(params->eye.automatic || params->target.automatic)) return;
    if (!params->eye.automatic) eye = params->eye.value;
    if (!params->target.automatic) target = params->target.value;
    const double *o = run->scene.world_origin;
    fprintf(stderr, "camera: --eye=%.9g,%.9g,%.9g --target=%.9g,%.9g,%.9g\n", (double)eye[0] + o[0],
            (double)eye[1] + o[1], (double)eye[2] + o[2], (double)target[0] + o[0],
            (double)target[1] + o[1], (double)target[2] + o[2]);
}

// Fits the camera to the hair, unless the scene sets the camera.
static Result aim(Run *run, Error *error)
{
    const RunParams *params = &run->scene.run;
    SurveyReport report;
    outline_frame(&run->framing, &run->scene, run->assets.strands, run->assets.meshes);
    if (!survey_is_wanted(&run->scene)) {
        report_camera(run);
        return RESULT_OK;
    }
    TRY(survey_fit_camera(&run->framing, &report, &run->scene, &run->assets, &run->gpu,
                          params->quiet ? NULL : stderr, error));
    activity_set(NULL);
    if (params->verbose)
        fprintf(stderr, "camera: fits %d frames, simulated in %.2g s\n", report.frames,
                report.ms / 1e3);
    report_camera(run);
    if (!params->quiet && report.step.most > 0)
        fprintf(stderr,
                "loop: hair moves by at most %.3g mm (RMS %.3g) from the last frame to the first, "
                "%.3g mm (%.3g) between other frames\n",
                1e3 * (double)report.seam.most, 1e3 * (double)report.seam.rms,
                1e3 * (double)report.step.most, 1e3 * (double)report.step.rms);
    return RESULT_OK;
}

// Finds the exposure, unless the scene sets it, and reports it as a value for --exposure.
static Result expose(Run *run, Error *error)
{
    const RunParams *params = &run->scene.run;
    run->exposure = params->exposure.value;
    if (!exposure_is_wanted(params, scene_draws_floats(params) ? IMAGE_FLOAT : IMAGE_8))
        return RESULT_OK;
    activity_set("finding the exposure");
    TRY(exposure_find(&run->exposure, &run->scene, &run->assets, &run->framing, &run->gpu, error));
    activity_set(NULL);
    if (!params->quiet)
        fprintf(stderr, "exposure: %+.4g EV (--exposure auto)\n", (double)run->exposure);
    return RESULT_OK;
}

// Reports sections whose file asks for no followers and which get some to fill gaps.
static void report_filled(const Run *run)
{
    for (uint32_t i = 0; i < run->scene.section_count; ++i) {
        const Section *section = &run->scene.sections[i];
        const Strands *strands = &run->assets.strands[i];
        if (section->params.hidden) continue;
        follow_plan_tell_gaps(&section->params, strands, quote(section->file).text, stderr);
        if (!follow_plan_fills(&section->params, strands)) continue;
        fprintf(stderr,
                "%s: %u followers fill the space between %u strands: set --followers to change "
                "their number\n",
                quote(section->file).text, run->simulation.sections[i].follow.hair.strand_count,
                strands->strand_count);
    }
}

// Frees the strands in the CPU's memory once they are uploaded, for 1,000,000 strands of 16
// vertices 256 MB. Caches and exports still need them.
static void release_strands(Run *run)
{
    if (run->exports || *run->scene.run.cache) return; // frames that are played are kept apart
    for (uint32_t i = 0; i < run->assets.section_count; ++i)
        strands_destroy(&run->assets.strands[i]);
}

static void report_depth(const RendererOptions *options)
{
    const float *range = options->depth_range;
    if (options->aov == AOV_DEPTH && options->kind != IMAGE_FLOAT)
        fprintf(stderr, "depth: white is %.6g m from the eye, black %.6g m\n", (double)range[0],
                (double)range[1]);
}

static Result open_images(Run *run, Error *error)
{
    const RunParams *params = &run->scene.run;
    ImagesForm form;
    TRY(images_output_form(&form, params, error));
    TRY(images_create(&run->images, &run->scene, &run->assets, &run->simulation, &run->framing,
                      &form, &run->gpu, &run->timer, error));
    run->images.renderer.options.exposure = run->exposure;
    if (!params->quiet) report_depth(&run->images.renderer.options);
    return images_output_create(&run->output, &run->images, &run->fingerprint,
                                sequence_count_drawn(params) - run->done.count, error);
}

// Reads files before the driver is started, so that errors in files are reported quickly. The
// output folder is created last, just before the first frame.
static Result prepare(Run *run, Error *error)
{
    const RunParams *params = &run->scene.run;
    bool draws = *params->output != 0;
    run->scene.plays = true;
    activity_start(stderr, params->quiet);
    TRY(run_check(&run->scene, error));
    TRY(check_cache(params, error));
    TRY(assets_load(&run->assets, &run->scene, params->quiet ? NULL : stderr, params->verbose,
                    error));
    TRY(run_check(&run->scene, error)); // its frames are known now
    TRY(scalp_guess(&run->scene, &run->assets, params->quiet ? NULL : stderr, params->verbose,
                    error));
    // After a guessed scalp has added its colliders.
    TRY(check_cache_scene(&run->scene, run->assets.strands, error));
    activity_set(NULL);
    run->loaded_ms = clock_ms();
    if (!params->quiet) warn_all(&run->scene);
    TRY(open_gpu(run, error));
    activity_set("fitting the camera");
    if (draws) TRY(aim(run, error));
    if (draws) TRY(expose(run, error));
    activity_set("uploading hair");
    TRY(simulation_create(&run->simulation, &run->gpu, &run->timer, &run->scene,
                          run->assets.strands, run->assets.meshes, error));
    activity_set(NULL);
    if (draws && !params->quiet) report_filled(run);
    TRY(open_source(run, error));
    TRY(describe(run, error));
    TRY(find_done(run, error));
    activity_set("preparing the renderer");
    if (draws) TRY(open_images(run, error));
    if (*params->stats) {
        TRY(stats_create(&run->stats, error));
        stats_describe(&run->stats, &run->gpu, &run->scene, &run->assets, &run->simulation);
        if (draws) stats_add_exposure(&run->stats, run->exposure);
    }
    release_strands(run);
    activity_set(NULL);
    if (params->verbose) report_steps(&run->simulation);
    run->ready_ms = clock_ms();
    return RESULT_OK;
}

static void report_result(const Run *run, const Sequence *sequence, double ms)
{
    int frames = run->output ? sequence->frames_drawn + sequence->frames_repeated
                             : run->simulation.frame + 1;
    SolverReport report = simulation_report(&run->simulation);
    if (report.moves_limited && run->scene.run.verbose)
        fprintf(stderr, "%llu moves of vertices were shortened to 100 strand lengths a step\n",
                (unsigned long long)report.moves_limited);
    if (report.groom_weight > 0 && run->scene.run.verbose)
        fprintf(stderr, "forces that hold the groom, beside its fibres: %.2f of its weight\n",
                report.groom_held / report.groom_weight);
    if (report.strands_slowed && run->scene.run.verbose)
        fprintf(stderr, "%.2g %% of the strands' steps gained energy and were slowed down\n",
                1e2 * (double)report.strands_slowed / (double)run->simulation.strand_steps);
    const CacheWriter *cache = &run->source.writer;
    if (cache->frame_count && run->scene.run.verbose)
        fprintf(stderr, "%s: %u frames, %.3g MB, %.3g ms a frame to pack and write\n",
                quote(cache->path).text, cache->frame_count, (double)cache->at * 1e-6,
                cache->write_ms / cache->frame_count);
    fprintf(stderr, "%d frame%s in %.1f s, %.3g a second", frames, frames == 1 ? "" : "s", ms / 1e3,
            frames * 1e3 / ms);
    bool described = run->output && frames > 0;
    fprintf(stderr, described ? ": %s\n" : "%s\n",
            described ? quote(output_describe(run->output)).text : "");
}

static Result write_stats(Run *run, const Sequence *sequence, Error *error)
{
    const RunParams *params = &run->scene.run;
    if (!*params->stats) return RESULT_OK;
    OutputCounters counters = {0};
    if (run->output) counters = output_count(run->output);
    stats_add_wall(&run->stats, "load_ms", run->loaded_ms - run->begin_ms);
    stats_add_wall(&run->stats, "set_up_ms", run->ready_ms - run->loaded_ms);
    stats_add_wall(&run->stats, "frames_ms", clock_ms() - run->ready_ms);
    stats_add_wall(&run->stats, "total_ms", clock_ms() - run->begin_ms);
    stats_finish(&run->stats, &run->timer, &run->simulation, sequence->frames_drawn,
                 sequence->frames_repeated, run->output ? &counters : NULL);
    return stats_write(&run->stats, params->stats, error);
}

Result run_go(Run *run, Error *error)
{
    TRY(prepare(run, error));
    if (getenv("TRACTRIX_GL_CALLS"))
        gl_count_start(); // for developers: prints a table of calls at the end
    Sequence sequence = {
        .scene = &run->scene,
        .source = &run->source,
        .images = &run->images,
        .output = run->output,
        .exporter = run->exports ? &run->exporter : NULL,
        .fingerprint = &run->fingerprint,
        .done = run->done.done,
        .timer = &run->timer,
        .stats = &run->stats,
    };
    Result result = sequence_run(&sequence, error);
    gl_count_print(stderr);
    bool failed = result != RESULT_OK && result != RESULT_INTERRUPTED;
    if (failed && run->output) output_flush(run->output);
    TRY(result);
    activity_set("finishing");
    if (run->output && run->done.count < sequence_count_drawn(&run->scene.run))
        TRY(output_finish(run->output, error));
    if (run->exports) TRY(exporter_finish(&run->exporter, error));
    TRY(frame_source_finish(&run->source, error));
    TRY(write_stats(run, &sequence, error));
    activity_end();
    if (!run->scene.run.quiet) report_result(run, &sequence, clock_ms() - run->begin_ms);
    return RESULT_OK;
}
