// SPDX-License-Identifier: MIT
// A number that identifies the scene of a frame and is stored in its file. It is equal for two
// frames that are drawn from equal values and files, so that --resume keeps no frame of another
// scene.
#pragma once

#include "gpu/gpu.h"
#include "image/image_text.h"
#include "scene/assets.h"
#include "scene/outline.h"

// The number's key among an image's texts.
#define FINGERPRINT_KEY "Scene"
enum { FINGERPRINT_BYTES = 17 }; // as text, including the final zero

// What all frames of a run share. A zeroed struct may be destroyed.
typedef struct Fingerprint {
    const Scene *scene;
    const Framing *framing;
    uint64_t hair;     // of everything that hair files depend on
    uint64_t image;    // of everything that images depend on
    ImageTexts origin; // what draws: Software, Renderer, Driver and, with a CPU driver, CPU
} Fingerprint;

// Includes program and driver, every parameter except FINGERPRINT_EXEMPT, tracks, colliders and
// lights, the contents of hair, mesh and maps as read, the camera's position (`framing`), the
// `exposure` that was found, and the program and driver that made the cache (`maker`, by
// cache_scene_maker) if this run's would have made another cache (NULL: no cache is read). `scene`
// and `framing` must outlive it. RESULT_BAD_INPUT for a map that can't be read, RESULT_FAILED when
// memory is short.
Result fingerprint_create(Fingerprint *fingerprint, const Scene *scene, const Assets *assets,
                          const Framing *framing, float exposure, const Gpu *gpu, const char *maker,
                          Error *error);
// A hash of what the exposure of a scene depends on, and of more: values, hair, meshes, maps and
// framing. RESULT_BAD_INPUT or RESULT_FAILED if a map cannot be read or memory is short.
Result fingerprint_of_scene(uint64_t *hash, const Scene *scene, const Assets *assets,
                            const Framing *framing, Error *error);

void fingerprint_destroy(Fingerprint *fingerprint);

// The number of frame `frame` as 16 hexadecimal digits, including its camera, lights and caption.
void fingerprint_of_image(char text[FINGERPRINT_BYTES], const Fingerprint *fingerprint, int frame);

// The same for the frame's hair file (--export), without camera and lights.
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
