// SPDX-License-Identifier: MIT
// tractrix-render: from hair files and a scene to pictures.
#include "fibre.h"
#include "framing.h"
#include "hair_paint.h"
#include "help.h"
#include "interrupt.h"
#include "load.h"
#include "output.h"
#include "renderer.h"
#include "resume.h"
#include "sequence.h"
#include "simulation.h"
#include "stats.h"
#include "target.h"

#include "version.h"

#include <stdlib.h>
#include <string.h>

// All that a run makes, so that one function can destroy it in whatever state it is.
typedef struct Run {
    Scene scene;
    Assets assets;
    Gpu gpu;
    bool has_gpu;
    GpuTimer timer;
    Simulation simulation;
    Renderer renderer;
    RenderItem *items; // of each section its guides and, if there are any, its followers
    uint32_t item_count;
    Framing framing;
    Output *output;
    FrameSource source;
    Exporter exporter;
    bool exports;
    Resume resume;
    Stats stats;
    double begin_ms, loaded_ms, ready_ms;
} Run;

static void run_destroy(Run *run)
{
    output_destroy(run->output);
    if (run->exports) exporter_destroy(&run->exporter);
    resume_destroy(&run->resume);
    if (run->has_gpu) {
        frame_source_close(&run->source);
        renderer_destroy(&run->renderer);
        simulation_destroy(&run->simulation);
        gpu_timer_destroy(&run->timer);
        gpu_destroy(&run->gpu);
    }
    stats_destroy(&run->stats);
    free(run->items);
    assets_destroy(&run->assets);
    scene_destroy(&run->scene);
}

static GpuOptions gpu_options(const RunParams *params)
{
    GpuOptions options = {
        .backend = params->backend == BACKEND_EGL      ? GPU_BACKEND_EGL
                   : params->backend == BACKEND_OSMESA ? GPU_BACKEND_OSMESA
                                                       : GPU_BACKEND_AUTO,
        .device = params->device,
        .software = params->software,
        .require_hardware = params->require_hardware,
    };
#ifdef TRACTRIX_DEBUG
    options.debug = true;
#endif
    return options;
}

static void tell_cautions(const Scene *scene)
{
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

static Result paint_section(Run *run, uint32_t i, Error *error)
{
    SimulationSection *section = &run->simulation.sections[i];
    const Strands *strands = &run->assets.strands[i];
    const GpuLimits *limits = &run->gpu.limits;
    Paint paint;
    Result result = paint_create(&paint, strands, &run->scene.sections[i].params, error);
    if (result == RESULT_OK) result = hair_paint(&section->hair, strands, &paint, limits, error);
    if (result == RESULT_OK && section->follow.per_guide)
        result = hair_paint(&section->follow.hair, strands, &paint, limits, error);
    paint_destroy(&paint);
    return result == RESULT_USAGE ? error_prefix(error, result, "%s: ", run->scene.sections[i].file)
                                  : result;
}

static Result create_items(Run *run, Error *error)
{
    run->items = calloc(2 * (size_t)run->scene.section_count + 1, sizeof *run->items);
    if (!run->items)
        return error_set(error, RESULT_FAILED, "no memory for %u sections",
                         run->scene.section_count);
    for (uint32_t i = 0; i < run->scene.section_count; ++i) {
        const SimulationSection *section = &run->simulation.sections[i];
        const SectionParams *params = &run->scene.sections[i].params;
        float radius = params->radius.automatic
                           ? fibre_auto_radius(&run->assets.strands[i], section->follow.per_guide)
                           : params->radius.value;
        Result result = paint_section(run, i, error);
        if (result != RESULT_OK) return result;
        run->items[run->item_count++] = (RenderItem){&section->hair, params, radius};
        if (section->follow.per_guide)
            run->items[run->item_count++] = (RenderItem){&section->follow.hair, params, radius};
    }
    return RESULT_OK;
}

// Floats tell the depth in metres; PNG files from what the camera sees nearest to what is farthest,
// as the first picture has it.
static void set_depth_range(const Run *run, RendererOptions *options)
{
    View view;
    if (options->aov != AOV_DEPTH || options->kind == IMAGE_FLOAT) return;
    camera_view(&view, &run->scene, &run->framing, run->scene.run.first);
    options->depth_range[0] = view.near_distance;
    options->depth_range[1] = view.far_distance;
    if (!run->scene.run.quiet)
        fprintf(stderr, "depth: white is %.6g m before the eye, black %.6g m\n",
                (double)view.near_distance, (double)view.far_distance);
}

static Result describe_pictures(const Run *run, RendererOptions *options, Error *error)
{
    const RunParams *params = &run->scene.run;
    Target target;
    Result result = target_parse(&target, params->output, error);
    *options = (RendererOptions){
        .raster = (Raster)params->raster,
        .oit = (Oit)params->oit,
        .oit_layers = params->oit_layers,
        .width = params->size[0],
        .height = params->size[1],
        .exposure = params->exposure,
        .tone = (Tone)params->tone_map,
        .kind = params->depth == DEPTH_16 ? IMAGE_16 : IMAGE_8,
        .aov = (Aov)params->aov,
        .seed = params->seed,
        .lod = {params->lod_start, params->lod_end, params->lod_min, params->lod_width},
        .shadow = {.kind = (Shadow)params->shadow,
                   .side = params->shadow_size,
                   .spacing = params->shadow_spacing}};
    memcpy(options->background, params->background, sizeof options->background);
    if (result != RESULT_OK) return result;
    if (target.floats) options->kind = IMAGE_FLOAT;
    set_depth_range(run, options);
    target_destroy(&target);
    return RESULT_OK;
}

static Result open_renderer(Run *run, Error *error)
{
    RendererOptions options;
    framing_compute(&run->framing, &run->scene, run->assets.strands,
                    run->assets.has_mesh ? &run->assets.mesh : NULL);
    Result result = describe_pictures(run, &options, error);
    if (result == RESULT_OK)
        result = renderer_create(&run->renderer, &run->gpu, &run->timer, &options, error);
    if (result == RESULT_OK && run->assets.has_mesh)
        result =
            renderer_set_mesh(&run->renderer, &run->assets.mesh, run->scene.run.mesh_color, error);
    if (result == RESULT_OK) result = create_items(run, error);
    return result;
}

static Result open_output(Run *run, Error *error)
{
    const RunParams *params = &run->scene.run;
    const OutputOptions options = {
        .target = params->output,
        .width = params->size[0],
        .height = params->size[1],
        .channels = renderer_channels(&run->renderer),
        .kind = run->renderer.options.kind,
        .fps = (double)params->fps / params->every,
        .frame_count = sequence_count_drawn(params) - run->resume.count,
    };
    return output_create(&run->output, &options, error);
}

// What can be said before any file is opened.
static Result check_words(const Scene *scene, Error *error)
{
    Target target = {0};
    Result result =
        *scene->run.output ? target_parse(&target, scene->run.output, error) : RESULT_OK;
    target_destroy(&target);
    if (result == RESULT_OK && scene->run.collide_mesh && !*scene->run.mesh)
        result = error_set(error, RESULT_USAGE, "--collide-mesh: expected a mesh, --mesh");
    if (result == RESULT_OK && *scene->run.export) {
        result = target_parse_hair(&target, scene->run.export, error);
        target_destroy(&target);
    }
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
    if (result == RESULT_OK && !params->quiet) tell_cautions(&run->scene);
    if (result == RESULT_OK) result = open_gpu(run, error);
    if (result == RESULT_OK)
        result = simulation_create(&run->simulation, &run->gpu, &run->timer, &run->scene,
                                   run->assets.strands, &run->assets.mesh, error);
    if (result == RESULT_OK) result = open_source(run, error);
    if (result == RESULT_OK && draws) result = open_renderer(run, error);
    if (result == RESULT_OK && draws) result = open_output(run, error);
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
    int frames = sequence->output ? sequence->frames_drawn + sequence->frames_repeated
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
    bool described = run->output && frames > 0;
    fprintf(stderr, described ? ": %s\n" : "%s\n", described ? output_describe(run->output) : "");
}

static Result write_stats(Run *run, const Sequence *sequence, Error *error)
{
    const RunParams *params = &run->scene.run;
    if (!*params->stats) return RESULT_OK;
    OutputCounters counters = {0};
    if (run->output) counters = output_count(run->output);
    stats_add_wall(&run->stats, "load_ms", run->loaded_ms - run->begin_ms);
    stats_add_wall(&run->stats, "set_up_ms", run->ready_ms - run->loaded_ms);
    stats_add_wall(&run->stats, "frames_ms", stats_clock_ms() - run->ready_ms);
    stats_add_wall(&run->stats, "total_ms", stats_clock_ms() - run->begin_ms);
    stats_finish(&run->stats, &run->timer, &run->simulation, sequence->frames_drawn,
                 sequence->frames_repeated, run->output ? &counters : NULL);
    return stats_write(&run->stats, params->stats, error);
}

static Result render(Run *run, Error *error)
{
    Result result = prepare(run, error);
    if (result != RESULT_OK) return result;
    Sequence sequence = {
        .scene = &run->scene,
        .simulation = &run->simulation,
        .source = &run->source,
        .exporter = run->exports ? &run->exporter : NULL,
        .done = run->resume.done,
        .renderer = run->output ? &run->renderer : NULL,
        .output = run->output,
        .framing = &run->framing,
        .items = run->items,
        .item_count = run->item_count,
        .timer = &run->timer,
        .stats = &run->stats,
    };
    result = sequence_run(&sequence, error);
    if (result == RESULT_OK && run->output &&
        run->resume.count < sequence_count_drawn(&run->scene.run))
        result = output_finish(run->output, error);
    if (result == RESULT_OK) result = frame_source_finish(&run->source, error);
    if (result == RESULT_OK) result = write_stats(run, &sequence, error);
    if (result == RESULT_OK && !run->scene.run.quiet)
        tell_result(run, &sequence, stats_clock_ms() - run->begin_ms);
    return result;
}

static Result answer(Run *run, Error *error)
{
    const RunParams *params = &run->scene.run;
    switch (run->scene.request) {
    case REQUEST_HELP:
        help_write_text(stdout);
        return RESULT_OK;
    case REQUEST_MAN:
        help_write_man(stdout, TRACTRIX_VERSION);
        return RESULT_OK;
    case REQUEST_MARKDOWN:
        help_write_markdown(stdout);
        return RESULT_OK;
    case REQUEST_VERSION:
        printf("tractrix-render %s (%s)\n", TRACTRIX_VERSION, TRACTRIX_COMMIT);
        return RESULT_OK;
    case REQUEST_RUN:
        break;
    }
    if (params->list_devices) return gpu_list_devices(stdout, error);
    if (params->check) {
        error->text[0] = 0; // the report says it all
        return assets_check(&run->scene, stdout);
    }
    return render(run, error);
}

// `--algo list` needs no hair file, so it is looked for before anything else.
static bool wants_solver_list(int argc, char **argv)
{
    for (int i = 1; i < argc; ++i)
        if (strcmp(argv[i], "--algo=list") == 0 ||
            (strcmp(argv[i], "--algo") == 0 && i + 1 < argc && strcmp(argv[i + 1], "list") == 0))
            return true;
    return false;
}

int main(int argc, char **argv)
{
    interrupt_install();
    if (wants_solver_list(argc, argv)) {
        solver_print_list(stdout);
        return RESULT_OK;
    }
    Run run = {.begin_ms = stats_clock_ms()};
    Error error = {{0}};
    Result result = scene_from_arguments(&run.scene, argc, argv, &error);
    if (result == RESULT_OK) result = answer(&run, &error);
    run_destroy(&run);
    if (fflush(stdout) != 0 || ferror(stdout))
        result = error_set(&error, RESULT_FAILED, "cannot write to standard output");
    // A file's fault begins with the file; everything else with the program's name.
    if (result != RESULT_OK && error.text[0])
        fprintf(stderr, "%s%s\n",
                result == RESULT_BAD_INPUT ? "" : "tractrix-render: ", error.text);
    return result;
}
