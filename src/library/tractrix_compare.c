// SPDX-License-Identifier: MIT
#include "library/library.h"

#include "image/compare.h"
#include "image/flip.h"

#include <stddef.h>
#include <string.h>

static Result take_limits(CompareLimits *limits, const TractrixLimits *asked, Error *error)
{
    TractrixLimits own;
    *limits = compare_limits_default();
    if (!asked) return RESULT_OK;
    TRY(library_take(&own, sizeof own, asked, offsetof(TractrixLimits, max_difference), "limits",
                     error));
    bool pixels = own.pixel_tolerance >= 0, flip = own.max_flip > 0,
         difference = own.max_difference > 0, local = own.max_local_difference > 0;
    double distance = own.pixels_per_degree == 0 ? FLIP_PIXELS_PER_DEGREE : own.pixels_per_degree;
    if (!(own.pixel_tolerance <= 255 && own.max_failing_percent >= 0 &&
          own.max_failing_percent <= 100 && own.max_flip <= 1 && own.max_difference <= 255 &&
          own.max_local_difference <= 255))
        return error_set(error, RESULT_USAGE,
                         "limits: a limit is out of range: expected at most 255 levels, 0 to 100 "
                         "%% of the pixels, and a FLIP of at most 1");
    if (!(distance >= 1 && distance <= 1000))
        return error_set(error, RESULT_USAGE,
                         "limits.pixels_per_degree: got %g, expected 1 to 1000", distance);
    if (!pixels && !flip && !difference && !local)
        return error_set(error, RESULT_USAGE,
                         "limits: no limit is set: expected one for pixels, differences or FLIP");
    *limits = (CompareLimits){.pixels_matter = pixels,
                              .pixel_tolerance = own.pixel_tolerance,
                              .max_failing = own.max_failing_percent,
                              .max_failing_percent = true,
                              .difference_matters = difference,
                              .max_difference = own.max_difference,
                              .local_matters = local,
                              .max_local = own.max_local_difference,
                              .flip_matters = flip,
                              .max_flip = own.max_flip,
                              .pixels_per_degree = distance};
    return RESULT_OK;
}

// Up to three images of equal size, and the mask that the third image gives.
typedef struct Compared {
    Image image[3];
    Mask mask;
} Compared;

static Result take_images(Compared *compared, const TractrixImage *const images[3], Error *error)
{
    static const char *const NAMES[] = {"a", "b", "mask"};
    TractrixImage taken[3];
    for (int i = 0; i < 3 && (images[i] || i < 2); ++i) {
        TRY(library_take_image(&taken[i], images[i], NAMES[i], error));
        if (taken[i].width != taken[0].width || taken[i].height != taken[0].height)
            return error_set(error, RESULT_USAGE,
                             "%s: has %dx%d pixels: expected %dx%d, the size of a", NAMES[i],
                             taken[i].width, taken[i].height, taken[0].width, taken[0].height);
        TRY(library_copy_image(&compared->image[i], &taken[i], NAMES[i], error));
    }
    return images[2] ? mask_create_from(&compared->mask, &compared->image[2], error) : RESULT_OK;
}

static Result compare(TractrixFigures *figures, float *map, const TractrixImage *const images[3],
                      const TractrixLimits *asked, Error *error)
{
    CompareLimits limits;
    CompareResult found;
    Compared compared = {0};
    TractrixFigures own;
    TRY(library_take(&own, sizeof own, figures, offsetof(TractrixFigures, within), "figures",
                     error));
    TRY(take_limits(&limits, asked, error));
    limits.figures = COMPARE_SSIM | COMPARE_FLIP;
    Result result = take_images(&compared, images, error);
    THEN(result, compare_images(&found, map, &compared.image[0], &compared.image[1],
                                images[2] ? &compared.mask : NULL, &limits, error));
    for (int i = 0; i < 3; ++i) image_destroy(&compared.image[i]);
    mask_destroy(&compared.mask);
    if (result != RESULT_OK) return result;
    own = (TractrixFigures){.size = own.size,
                            .compared = found.compared,
                            .failing = found.failing,
                            .largest = found.largest,
                            .at = {found.at[0], found.at[1]},
                            .rmse = found.rmse,
                            .psnr = found.psnr,
                            .ssim = found.ssim,
                            .flip = found.flip,
                            .flip_most = found.flip_most,
                            .same = found.within,
                            .within = found.within,
                            .equal = found.equal,
                            .local_at = {found.local_at[0], found.local_at[1]},
                            .local_difference = found.local};
    library_give(figures, &own);
    return RESULT_OK;
}

TractrixResult tractrix_compare(TractrixFigures *figures, float *map, const TractrixImage *a,
                                const TractrixImage *b, const TractrixImage *mask,
                                const TractrixLimits *limits, TractrixError *error)
{
    LIBRARY_CALL;
    Error why = {{0}};
    return library_end(
        compare(figures, map, (const TractrixImage *const[]){a, b, mask}, limits, &why), &why,
        error);
}
