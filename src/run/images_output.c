// SPDX-License-Identifier: MIT
#include "run/images_output.h"
#include "base/target.h"
#include "draw/renderer_options.h"

#include <cglm/mat4.h>
#include <string.h>

// Whether EXR files with layers are written. Images of --aov and contact sheets have no layers.
static bool has_layers(const RunParams *run, const Target *target)
{
    return target->format == TARGET_EXR && run->exr_layers && run->aov == AOV_NONE &&
           run->contact_sheet[0] == 1 && run->contact_sheet[1] == 1;
}

Result images_output_form(ImagesForm *form, const RunParams *run, Error *error)
{
    Target target;
    TRY(target_parse(&target, run->output, error));
    form->kind = target.floats ? IMAGE_FLOAT : run->depth == DEPTH_16 ? IMAGE_16 : IMAGE_8;
    form->layers = has_layers(run, &target);
    target_destroy(&target);
    return RESULT_OK;
}

static OutputOptions describe(const RunParams *run, int channels, ImageKind kind, int frame_count)
{
    return (OutputOptions){
        .target = run->output,
        .width = run->size[0],
        .height = run->size[1],
        .channels = channels,
        .kind = kind,
        .fps = (double)run->fps / run->every,
        .frame_count = frame_count,
        .first_number = run->frame_number.value,
        .columns = run->contact_sheet[0],
        .rows = run->contact_sheet[1],
        .exr_float = run->exr_float,
        .records = run->resume,
    };
}

Result images_output_check(const RunParams *run, int frame_count, Error *error)
{
    ImagesForm form;
    TRY(images_output_form(&form, run, error));
    const OutputOptions options =
        describe(run, renderer_options_channels(run), form.kind, frame_count);
    return output_check(&options, error);
}

Result images_output_create(Output **output, const Images *images, const Fingerprint *fingerprint,
                            int frame_count, Error *error)
{
    const RunParams *run = &images->scene->run;
    OutputOptions options = describe(run, renderer_channels(&images->renderer),
                                     images->renderer.options.kind, frame_count);
    options.texts = &fingerprint->origin;
    options.layers = images->layers != NULL;
    return output_create(output, &options, error);
}

void images_output_matrices(FrameExtra *extra, const View *view)
{
    // Maps clip space to the image: x from [-w, w] to [0, w], y likewise but upside down.
    mat4 halve = {{0.5f, 0, 0, 0}, {0, -0.5f, 0, 0}, {0, 0, 1, 0}, {0.5f, 0.5f, 0, 1}};
    mat4 from_world = {0}, projection = {0}, whole;
    memcpy(from_world, view->view, sizeof from_world);
    memcpy(projection, view->projection, sizeof projection);
    glm_mat4_mulN((mat4 *[]){&halve, &projection, &from_world}, 3, whole);
    memcpy(extra->world_to_camera, from_world, sizeof from_world);
    memcpy(extra->world_to_ndc, whole, sizeof whole);
}
