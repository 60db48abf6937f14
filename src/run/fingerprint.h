// SPDX-License-Identifier: MIT
// Which scene a frame shows, in a number that its file keeps: equal for two frames that are drawn
// from the same values and the same files, so that --resume keeps no frame of another scene.
#pragma once

#include "gpu/gpu.h"
#include "image/image_text.h"
#include "scene/assets.h"
#include "scene/outline.h"

// The key of the number among an image's texts.
#define FINGERPRINT_KEY "Scene"
enum { FINGERPRINT_BYTES = 17 }; // as text, with the zero

// What all frames of a run have in common. A zeroed struct may be destroyed.
typedef struct Fingerprint {
    const Scene *scene;
    const Framing *framing;
    uint64_t hair;     // of all that hair files depend on
    uint64_t image;    // of all that images depend on
    ImageTexts origin; // who draws: Software, Renderer, Driver and, of a CPU driver, CPU
} Fingerprint;

// Takes in program and driver, every parameter but those that FINGERPRINT_EXEMPT names, tracks,
// colliders and lights, the contents of hair, mesh and maps as they were read, where the camera
// stands (`framing`), the `exposure` that was found, and which program and driver made the cache
// (`maker`, as cache_scene_maker has it) unless this run's would have made the same (NULL: no cache
// is read). `scene` and `framing` outlive it. RESULT_BAD_INPUT for a map that cannot be read,
// RESULT_FAILED when memory is short.
Result fingerprint_create(Fingerprint *fingerprint, const Scene *scene, const Assets *assets,
                          const Framing *framing, float exposure, const Gpu *gpu, const char *maker,
                          Error *error);
void fingerprint_destroy(Fingerprint *fingerprint);

// The number of frame `frame`, 16 hexadecimal digits: with the camera, the lights and the caption
// that it has.
void fingerprint_of_image(char text[FINGERPRINT_BYTES], const Fingerprint *fingerprint, int frame);

// The same of its hair file (--export), which no camera and no light change.
void fingerprint_of_hair(char text[FINGERPRINT_BYTES], const Fingerprint *fingerprint, int frame);

// The texts of `origin` that count.
enum { FINGERPRINT_ORIGIN_COUNT = 3 };
extern const char *const FINGERPRINT_ORIGIN[FINGERPRINT_ORIGIN_COUNT];

// The parameters that do not count, each with the reason.
typedef struct FingerprintExempt {
    const char *name, *reason;
} FingerprintExempt;
extern const FingerprintExempt FINGERPRINT_EXEMPT[];
extern const size_t FINGERPRINT_EXEMPT_COUNT;
