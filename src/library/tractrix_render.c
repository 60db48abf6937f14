// SPDX-License-Identifier: MIT
#include "library/library.h"

#include "run/exposure.h"
#include "run/fingerprint.h"
#include "run/survey.h"
#include "scene/camera.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_SIDE = 16384 };

struct TractrixRenderer {
    TractrixSimulation *simulation;
    Scene scene; // the simulation's scene with another size; owns nothing
    Framing framing;
    Images images;
    Image image;
    Image layers[EXR_LAYERS]; // if `layered`
    bool layered;             // has been asked for layers
    ImageKind kind;
    bool measured;  // `exposure` is that of exposure_find
    float exposure; // EV
    // The simulation's counters when the camera was aimed, the images were made, and the exposure
    // was found.
    uint64_t aims, looks, exposures;
};

static const ImageKind KINDS[] = {
    [TRACTRIX_RGBA8] = IMAGE_8, [TRACTRIX_RGBA32F] = IMAGE_FLOAT, [TRACTRIX_RGBA16] = IMAGE_16};

static void take_scene(TractrixRenderer *renderer, int width, int height)
{
    renderer->scene = renderer->simulation->scene;
    renderer->scene.run.size[0] = width;
    renderer->scene.run.size[1] = height;
}

static Result aim(TractrixRenderer *renderer, Error *error)
{
    const Assets *assets = &renderer->simulation->assets;
    SurveyReport unused;
    renderer->aims = renderer->simulation->aims;
    outline_frame(&renderer->framing, &renderer->scene, assets->strands, assets->meshes);
    if (!survey_is_wanted(&renderer->scene)) return RESULT_OK;
    return survey_fit_camera(&renderer->framing, &unused, &renderer->scene, assets,
                             &renderer->simulation->device->gpu, NULL, error);
}

// --- Lifetime.

// Takes the exposure of an equal scene on this device, or measures it.
static Result find_exposure(TractrixRenderer *renderer, Error *error)
{
    TractrixDevice *device = renderer->simulation->device;
    const Assets *assets = &renderer->simulation->assets;
    uint64_t scene;
    TRY(fingerprint_of_scene(&scene, &renderer->scene, assets, &renderer->framing, error));
    for (uint32_t i = 0; i < LIBRARY_EXPOSURES && i < device->exposure_count; ++i) {
        if (device->exposures[i].scene != scene) continue;
        renderer->exposure = device->exposures[i].value;
        return RESULT_OK;
    }
    TRY(exposure_find(&renderer->exposure, &renderer->scene, assets, &renderer->framing,
                      &device->gpu, error));
    device->exposures[device->exposure_count++ % LIBRARY_EXPOSURES] =
        (LibraryExposure){scene, renderer->exposure};
    return RESULT_OK;
}

// An automatic exposure is measured once, and again only when it is set anew.
static Result expose(TractrixRenderer *renderer, Error *error)
{
    TractrixSimulation *simulation = renderer->simulation;
    const RunParams *run = &renderer->scene.run;
    bool wanted = exposure_is_wanted(run, renderer->kind);
    if (renderer->exposures != simulation->exposures) renderer->measured = false;
    if (wanted && !renderer->measured) TRY(find_exposure(renderer, error));
    renderer->measured |= wanted;
    renderer->exposures = simulation->exposures;
    return RESULT_OK;
}

// Makes the images, also anew after parameters of drawing have changed.
static void destroy_pixels(TractrixRenderer *renderer)
{
    image_destroy(&renderer->image);
    for (int l = 0; l < EXR_LAYERS; ++l) image_destroy(&renderer->layers[l]);
}

static Result create_pixels(TractrixRenderer *renderer, Error *error)
{
    const int *size = renderer->scene.run.size;
    for (int l = 0; l < EXR_LAYERS && renderer->layered; ++l)
        TRY(image_create_kind(&renderer->layers[l], size[0], size[1], 3, IMAGE_FLOAT, error));
    return image_create_kind(&renderer->image, size[0], size[1],
                             renderer_channels(&renderer->images.renderer), renderer->kind, error);
}

static Result open_images(TractrixRenderer *renderer, Error *error)
{
    TractrixSimulation *simulation = renderer->simulation;
    const RunParams *run = &renderer->scene.run;
    images_destroy(&renderer->images);
    destroy_pixels(renderer);
    TRY(expose(renderer, error));
    TRY(images_create(&renderer->images, &renderer->scene, &simulation->assets,
                      &simulation->simulation, &renderer->framing,
                      &(ImagesForm){.kind = renderer->kind, .layers = renderer->layered},
                      &simulation->device->gpu, &simulation->timer, error));
    renderer->images.renderer.options.exposure =
        exposure_is_wanted(run, renderer->kind) ? renderer->exposure : run->exposure.value;
    TRY(create_pixels(renderer, error));
    renderer->looks = simulation->looks;
    return RESULT_OK;
}

static Result open_renderer(void *data, Error *error)
{
    TractrixRenderer *renderer = data;
    TRY(aim(renderer, error));
    return open_images(renderer, error);
}

static Result close_renderer(void *data, Error *error)
{
    TractrixRenderer *renderer = data;
    (void)error;
    images_destroy(&renderer->images);
    return RESULT_OK;
}

void tractrix_renderer_destroy(TractrixRenderer *renderer)
{
    LIBRARY_CALL;
    Error unused;
    if (!renderer) return;
    TractrixSimulation *simulation = renderer->simulation;
    if (library_on_device(simulation->device, close_renderer, renderer, &unused) == RESULT_OK) {
        destroy_pixels(renderer);
        free(renderer);
    }
    library_drop_simulation(simulation);
}

static Result create(TractrixRenderer **renderer, TractrixSimulation *simulation, int width,
                     int height, TractrixFormat format, Error *error)
{
    if (width < 1 || width > MOST_SIDE || height < 1 || height > MOST_SIDE)
        return error_set(error, RESULT_USAGE, "size: got %dx%d, expected 1x1 to %dx%d", width,
                         height, MOST_SIDE, MOST_SIDE);
    if ((unsigned)format >= sizeof KINDS / sizeof *KINDS)
        return error_set(error, RESULT_USAGE, "format: got %d, expected 0 to 2", (int)format);
    TractrixRenderer *made = *renderer = calloc(1, sizeof *made);
    if (!made) return error_set(error, RESULT_FAILED, "no memory for a renderer");
    library_keep_simulation(simulation);
    made->simulation = simulation;
    made->kind = KINDS[format];
    take_scene(made, width, height);
    return library_on_device(simulation->device, open_renderer, made, error);
}

TractrixResult tractrix_renderer_create(TractrixRenderer **renderer, TractrixSimulation *simulation,
                                        int width, int height, TractrixFormat format,
                                        TractrixError *error)
{
    LIBRARY_CALL;
    Error why = {{0}};
    if (!renderer) return library_refuse(error, "renderer: got NULL");
    *renderer = NULL;
    if (!simulation) return library_refuse(error, "simulation: got NULL");
    Result result = create(renderer, simulation, width, height, format, &why);
    if (result != RESULT_OK) {
        tractrix_renderer_destroy(*renderer);
        *renderer = NULL;
    }
    return library_end(result, &why, error);
}

// --- Drawing.

// Whether a column-major matrix only rotates and translates.
static bool is_rigid(const float m[16])
{
    for (int i = 0; i < 3; ++i)
        for (int k = i; k < 3; ++k) {
            const float *a = &m[4 * i], *b = &m[4 * k];
            if (!(fabsf(a[0] * b[0] + a[1] * b[1] + a[2] * b[2] - (float)(i == k)) < 1e-3f))
                return false;
        }
    float turn = m[8] * (m[1] * m[6] - m[2] * m[5]) + m[9] * (m[2] * m[4] - m[0] * m[6]) +
                 m[10] * (m[0] * m[5] - m[1] * m[4]);
    return turn > 0 && m[3] == 0 && m[7] == 0 && m[11] == 0 && m[15] == 1;
}

// Reads the view from the matrices: clip-space z = P10 z + P14, w = -z; the eye is at -R^T t.
static Result take_view(View *view, const TractrixView *asked, Error *error)
{
    TractrixView from;
    TRY(library_take(&from, sizeof from, asked, sizeof from, "view", error));
    const float *m = from.world_to_eye, *p = from.projection;
    memcpy(view->view, m, sizeof view->view);
    memcpy(view->projection, p, sizeof view->projection);
    for (int k = 0; k < 3; ++k)
        view->eye[k] = -(m[4 * k] * m[12] + m[4 * k + 1] * m[13] + m[4 * k + 2] * m[14]);
    view->fov = 2 * atanf(1 / p[5]);
    view->near_distance = p[14] / (p[10] - 1);
    view->far_distance = p[14] / (p[10] + 1);
    bool sound = true;
    for (int i = 0; i < 16; ++i) sound = sound && isfinite(m[i]) && isfinite(p[i]);
    if (!sound || !(p[0] > 0 && p[5] > 0) || p[11] != -1 || p[15] != 0)
        return error_set(
            error, RESULT_USAGE,
            "view: expected finite matrices and a perspective projection that looks along -z");
    if (!is_rigid(m))
        return error_set(error, RESULT_USAGE,
                         "view.world_to_eye: expected only a rotation and a translation");
    if (!(view->near_distance > 0 && view->far_distance > view->near_distance &&
          isfinite(view->far_distance)))
        return error_set(error, RESULT_USAGE,
                         "view: planes at %g and %g m: expected 0 < near < far",
                         (double)view->near_distance, (double)view->far_distance);
    return RESULT_OK;
}

typedef struct DrawCall {
    TractrixRenderer *renderer;
    const TractrixView *view;
    bool layers; // draw these, too
} DrawCall;

static Result draw_layers(TractrixRenderer *renderer, int frame, const View *view, Error *error)
{
    Images *images = &renderer->images;
    int place = images_place(images);
    TRY(images_begin(images, frame, view, &renderer->image, renderer->layers, error));
    TRY(images_settle(images, error));
    return images_take(images, place, &renderer->image, renderer->layers, error);
}

static Result draw(void *data, Error *error)
{
    DrawCall *call = data;
    TractrixRenderer *renderer = call->renderer;
    const int size[] = {renderer->scene.run.size[0], renderer->scene.run.size[1]};
    int frame = renderer->simulation->simulation.frame;
    View view;
    take_scene(renderer, size[0], size[1]);
    if (renderer->aims != renderer->simulation->aims) TRY(aim(renderer, error));
    bool same = renderer->looks == renderer->simulation->looks && renderer->image.pixels;
    if (!same || (call->layers && !renderer->layered)) {
        renderer->layered |= call->layers;
        TRY(open_images(renderer, error));
    }
    if (call->view)
        TRY(take_view(&view, call->view, error));
    else
        camera_view(&view, &renderer->scene, &renderer->framing, frame);
    if (call->layers) return draw_layers(renderer, frame, &view, error);
    return images_draw(&renderer->images, frame, &view, &renderer->image, error);
}

// Copies the layers that the caller wants. As in EXR files, a pixel has a strand in all of depth,
// tangent and strand, or in none.
static void give_layers(const TractrixRenderer *renderer, const TractrixLayers *layers)
{
    size_t count = (size_t)renderer->image.width * (size_t)renderer->image.height;
    const float *from[EXR_LAYERS];
    for (int l = 0; l < EXR_LAYERS; ++l)
        from[l] = (const float *)(const void *)renderer->layers[l].pixels;
    for (size_t i = 0; i < count; ++i) {
        const ExrPixel pixel = exr_file_pixel(from, i);
        if (layers->coverage) layers->coverage[i] = pixel.coverage;
        if (layers->depth) layers->depth[i] = pixel.depth;
        if (layers->strand) layers->strand[i] = pixel.strand;
        if (layers->tangent) memcpy(layers->tangent + 3 * i, pixel.tangent, sizeof pixel.tangent);
    }
}

static Result take_layers(TractrixLayers *taken, const TractrixLayers *layers, Error *error)
{
    *taken = (TractrixLayers){0};
    return layers ? library_take(taken, sizeof *taken, layers, sizeof *taken, "layers", error)
                  : RESULT_OK;
}

TractrixResult tractrix_render_layers(TractrixRenderer *renderer, const TractrixView *view,
                                      TractrixImage *image, const TractrixLayers *layers,
                                      TractrixError *error)
{
    LIBRARY_CALL;
    Error why = {{0}};
    TractrixImage to;
    TractrixLayers wanted;
    if (!renderer) return library_refuse(error, "renderer: got NULL");
    Result result = library_take_image(&to, image, "image", &why);
    THEN(result, take_layers(&wanted, layers, &why));
    if (result == RESULT_OK &&
        (to.width != renderer->scene.run.size[0] || to.height != renderer->scene.run.size[1] ||
         KINDS[to.format] != renderer->kind))
        result = error_set(&why, RESULT_USAGE,
                           "image: expected the renderer's size, %dx%d, and its format",
                           renderer->scene.run.size[0], renderer->scene.run.size[1]);
    DrawCall call = {renderer, view, layers != NULL};
    THEN(result, library_on_device(renderer->simulation->device, draw, &call, &why));
    if (result == RESULT_OK) library_put_image(&to, &renderer->image);
    if (result == RESULT_OK && layers) give_layers(renderer, &wanted);
    return library_end(result, &why, error);
}

TractrixResult tractrix_render(TractrixRenderer *renderer, const TractrixView *view,
                               TractrixImage *image, TractrixError *error)
{
    LIBRARY_CALL;
    return tractrix_render_layers(renderer, view, image, NULL, error);
}
