// SPDX-License-Identifier: MIT
// Tractrix as a library: simulates and draws hair with OpenGL 4.3, and compares images.
//
// Units: metres, seconds, y up, right-handed, unless a member says otherwise. Text is UTF-8.
// Failure: a function that returns TractrixResult writes one line, without a line end, to *error
//   (NULL: none) and leaves outputs alone, but for handles, which become NULL.
// Ownership: what is passed in is copied. A handle is the caller's, for ..._destroy, which takes
//   NULL. A device or simulation that is destroyed lives on until its last child is destroyed.
// Threads: all handles of one device are used by one thread at a time; several devices, scenes and
//   pictures may be used at once.
// Manners: no output, no signal handler, no exit, no file but those that an argument or a parameter
//   names, no change of the caller's current OpenGL or EGL context. After fork() the child may only
//   destroy, which frees nothing there: all else of a device fails with TRACTRIX_NO_GL.
// Structs whose first member is `size`: the caller sets it to their sizeof, since newer versions
//   append members. TractrixError and TractrixPose have none and stay as they are.
// Bytes: the same calls on the same driver and processor family give the same positions and pixels,
//   those of tractrix-render.
#ifndef TRACTRIX_H
#define TRACTRIX_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

#define TRACTRIX_VERSION_NUMBER 0x000200 // major, minor, patch: a byte each
typedef enum TractrixResult {            // the programs' exit statuses
    TRACTRIX_OK = 0,
    TRACTRIX_FAILED = 1,    // at run time: memory, disk, driver
    TRACTRIX_USAGE = 2,     // an argument or a parameter is wrong
    TRACTRIX_BAD_INPUT = 3, // content of a file, of JSON or of an array is wrong
    TRACTRIX_NO_GL = 4      // no usable OpenGL
} TractrixResult;
typedef struct TractrixError {
    char text[1024]; // "place: what is wrong: what was expected"
} TractrixError;
typedef struct TractrixDevice TractrixDevice;
typedef struct TractrixScene TractrixScene;
typedef struct TractrixSimulation TractrixSimulation;
typedef struct TractrixRenderer TractrixRenderer;
typedef struct TractrixPicture TractrixPicture;

uint32_t tractrix_version_number(void); // of the library that was loaded
const char *tractrix_version(void);     // as --version: "0.2.0", or with the commit behind it
// Threads that a call may use, 1 to 16; 0: one a processor that the process may use, the default.
void tractrix_set_threads(int count);

// --- Devices.

typedef struct TractrixDeviceOptions {
    size_t size;
    const char *name; // as --device: number, part of the name, PCI address, node; NULL: the best
    bool software;    // only a CPU driver
    bool require_hardware; // no CPU driver
} TractrixDeviceOptions;

// A device with an EGL context of its own, on a thread of its own: calls come from any thread and
// wait for that one. `options` NULL: the best device. TRACTRIX_NO_GL with all that was tried.
TractrixResult tractrix_device_open(TractrixDevice **device, const TractrixDeviceOptions *options,
                                    TractrixError *error);

// The caller's OpenGL context, 4.3 or newer, EGL or GLX, current on this thread now and in every
// call of this device and its children, destroy too. Calls expect OpenGL's default state and leave
// defaults, but for viewport, scissor box, and bindings of programs, vertex arrays,
// framebuffers, buffers, textures, samplers, images and uniform blocks: set yours again.
// TRACTRIX_NO_GL if no context is current or it offers too little.
TractrixResult tractrix_device_borrow(TractrixDevice **device, TractrixError *error);
void tractrix_device_destroy(TractrixDevice *device);

// "renderer", "version", "vendor", "processor", "path" (the way in), "pci", "uuid", "node",
// "passed-over" (why no GPU is used); "" if not known. Valid while the device lives.
const char *tractrix_device_text(const TractrixDevice *device, const char *what);

// --- Parameters: those of tractrix-render's flags and scene files, by name ('-' reads as '_').

typedef struct TractrixParameter {
    const char *name, *kind, *unit, *help, *default_text; // kind: "float", "vec3", "choice", ...
    const char *choices;     // words with a blank between them; "": not of words
    const char *owner;       // names of the solvers that have it; "": all
    double minimum, maximum; // of each number; both 0: none
    bool of_section;         // may differ by section
    bool live;               // tractrix_simulation_set takes it
} TractrixParameter;

// A row of the table, valid for ever; NULL: there are no more. Without those that name outputs,
// caches, devices and messages: these belong to the program.
const TractrixParameter *tractrix_parameter(size_t index);

// --- Scenes: hair, mesh, parameters, lights, motion. Need no device.

typedef struct TractrixStrands {
    size_t size;
    double metres_per_unit; // > 0
    bool up_z;              // z is up
    uint32_t strand_count;
    uint32_t vertices_each; // of every strand, 2 to 65,535, if `sizes` is NULL
    const uint32_t *sizes;  // [strand_count]
    const float *position;  // [vertices of all strands][3], root first
    const float *thickness; // [vertices], in any unit: the parameter `radius` is the radius where
                            // it equals its mean over all vertices; NULL: even
    const float *color;     // [vertices][4], linear RGB and opacity; NULL: by parameters
    const float *uv;        // [strand_count][2], of the root; NULL: none
} TractrixStrands;

typedef struct TractrixMesh {
    size_t size;
    double metres_per_unit; // > 0
    bool up_z;
    bool deforms; // tractrix_simulation_advance_mesh will move its vertices: hair is bound to it
    uint32_t vertex_count, triangle_count;
    const float *position;    // [vertex_count][3], while the head's pose is the identity
    const uint32_t *triangle; // [triangle_count][3], counter-clockwise from outside
} TractrixMesh;

// Empty, with the defaults of a look: "studio" (NULL) or "plain".
TractrixResult tractrix_scene_create(TractrixScene **scene, const char *look, TractrixError *error);
// From a scene file or a hair file; "-" is refused. Hair and meshes that it names are there now,
// and are read by each tractrix_simulation_create, as the parameters then say (unit, up, ...);
// whether all files of a pattern (mesh_%04d.obj) are there is found out then.
TractrixResult tractrix_scene_read(TractrixScene **scene, const char *path, TractrixError *error);
// From a scene file's text; relative paths in it begin at `folder` (NULL: the working folder).
TractrixResult tractrix_scene_parse(TractrixScene **scene, const char *json, const char *folder,
                                    TractrixError *error);
void tractrix_scene_destroy(TractrixScene *scene);

// Appends a section; `name` (NULL: "strands") stands for it in messages. TRACTRIX_BAD_INPUT with
// the number of a strand whose neighbouring vertices coincide or whose numbers are not finite.
TractrixResult tractrix_scene_add_strands(TractrixScene *scene, const char *name,
                                          const TractrixStrands *strands, TractrixError *error);
// Replaces the mesh; NULL: none. Hair collides with it, and it hides hair.
TractrixResult tractrix_scene_set_mesh(TractrixScene *scene, const TractrixMesh *mesh,
                                       TractrixError *error);
uint32_t tractrix_scene_section_count(const TractrixScene *scene);

// A parameter from its text as a flag has it: ("wind", "2,0,0"). `section` -1: all that there are,
// and the run. TRACTRIX_USAGE with what was expected. That a parameter has no effect, or that two
// exclude each other, is TRACTRIX_USAGE of tractrix_simulation_create.
TractrixResult tractrix_scene_set(TractrixScene *scene, int section, const char *name,
                                  const char *text, TractrixError *error);
// A parameter's text (`section` -1: that of the first), and the whole scene as JSON: at most `room`
// bytes with the zero. They return the length that there would be, without it; 0: an empty text, no
// such parameter or section, or no memory.
size_t tractrix_scene_get(const TractrixScene *scene, int section, const char *name, char *text,
                          size_t room);
size_t tractrix_scene_json(const TractrixScene *scene, char *text, size_t room);

// --- Simulations.

typedef struct TractrixPose {           // x_world = rotation x + translation
    double rotation[4], translation[3]; // unit quaternion x y z w; m
} TractrixPose;

// Of the scene as it is now; later changes of it change nothing here. Time is 0, the warm-up
// (--preroll) is done. TRACTRIX_USAGE if there is no hair, or parameters do not fit together.
TractrixResult tractrix_simulation_create(TractrixSimulation **simulation, TractrixDevice *device,
                                          const TractrixScene *scene, TractrixError *error);
void tractrix_simulation_destroy(TractrixSimulation *simulation);

// Lines about what was mended, guessed or left out when the scene was read, each with a line end;
// "": none. Valid while the simulation lives.
const char *tractrix_simulation_messages(const TractrixSimulation *simulation);

// As tractrix_scene_set, from the next step or image on, for live parameters (TractrixParameter):
// of gravity, wind, the camera, sky and ground.
TractrixResult tractrix_simulation_set(TractrixSimulation *simulation, const char *name,
                                       const char *text, TractrixError *error);

// On by one frame, 1 / fps seconds. `head`: where the head and the mesh are at its end, reached
// evenly; NULL: as the scene says, or where they are once a pose was given. Only queues GPU work.
// TRACTRIX_USAGE for a pose where a frame is no whole number of steps (fps and sim_rate), where the
// mesh deforms, or where the scene has several bodies.
TractrixResult tractrix_simulation_advance(TractrixSimulation *simulation, const TractrixPose *head,
                                           TractrixError *error);
// The same with the vertices of the mesh (TractrixMesh.deforms) at the frame's end, in the world:
// [vertex_count][3], m, y up. Vertices go straight; hair follows the skin at its roots.
TractrixResult tractrix_simulation_advance_mesh(TractrixSimulation *simulation,
                                                const float *position, uint32_t vertex_count,
                                                TractrixError *error);
double tractrix_simulation_time(const TractrixSimulation *simulation); // s, of the scene

typedef enum TractrixPart { TRACTRIX_GUIDES = 0, TRACTRIX_FOLLOWERS = 1 } TractrixPart;

typedef struct TractrixPositions { // strands in the order they came in, followers guide by guide
    size_t size;
    uint32_t strand_count, vertex_count; // of all strands; there may be no followers
    const uint32_t *sizes;               // [strand_count], vertices; never changes
    const float *position;               // [vertex_count][4], x y z 1 in the world, root first
} TractrixPositions;

// The positions as drawn now. Waits for the GPU. They are valid, and constant, until the next
// advance, set, map of this part or destroy.
TractrixResult tractrix_simulation_map(TractrixSimulation *simulation, int section,
                                       TractrixPart part, TractrixPositions *positions,
                                       TractrixError *error);

// The same without waiting, to byte `offset` (a multiple of 16) of a buffer of the borrowed
// context. TRACTRIX_USAGE if the buffer is too small or the device is not borrowed, TRACTRIX_FAILED
// if the positions are more than the driver lets a shader write (OpenGL 4.3: at least 16 MiB).
TractrixResult tractrix_simulation_copy_to_gl(TractrixSimulation *simulation, int section,
                                              TractrixPart part, uint32_t buffer, size_t offset,
                                              TractrixError *error);

// --- Images.

typedef enum TractrixFormat {
    TRACTRIX_RGBA8 = 0,   // sRGB, straight alpha
    TRACTRIX_RGBA32F = 1, // linear light, premultiplied alpha
    TRACTRIX_RGBA16 = 2   // as RGBA8
} TractrixFormat;

typedef struct TractrixImage { // top row first
    size_t size;
    int width, height; // px, 1 to 16,384
    TractrixFormat format;
    size_t row_bytes; // from row to row; 0: without gaps
    void *pixels;
} TractrixImage;

typedef struct TractrixView { // column by column, as glUniformMatrix4fv has them
    size_t size;
    float world_to_eye[16]; // a rotation and a translation, nothing else
    float projection[16];   // eye to clip space, perspective, near and far finite
} TractrixView;

// Draws by the scene's parameters. An automatic exposure is found now (RGBA32F: light as it is).
TractrixResult tractrix_renderer_create(TractrixRenderer **renderer, TractrixSimulation *simulation,
                                        int width, int height, TractrixFormat format,
                                        TractrixError *error);
void tractrix_renderer_destroy(TractrixRenderer *renderer);

// Draws as things are now into image->pixels, of the renderer's size and format, and waits. `view`
// NULL: the scene's camera. Alpha is 1 where the background is opaque.
TractrixResult tractrix_render(TractrixRenderer *renderer, const TractrixView *view,
                               TractrixImage *image, TractrixError *error);

// PNG, EXR and PFM files by content; alpha 1 where they have none. The image lives as long as the
// picture. Written by suffix: .png, or .jpg (.jpeg) of opaque RGBA8; .exr or .pfm of floats. Pixels
// that are all opaque are written without alpha, as tractrix-render does. TRACTRIX_USAGE for a
// format that the file cannot hold.
TractrixResult tractrix_picture_read(TractrixPicture **picture, const char *path,
                                     TractrixError *error);
const TractrixImage *tractrix_picture_image(const TractrixPicture *picture);
void tractrix_picture_destroy(TractrixPicture *picture);
TractrixResult tractrix_image_write(const TractrixImage *image, const char *path,
                                    TractrixError *error);

typedef struct TractrixLimits { // as tractrix-compare's; all 0: equal images alone are the same
    size_t size;
    double pixel_tolerance; // levels of 255 that a pixel may be off; below 0: pixels don't count
    double max_failing_percent; // of the compared pixels that may be off by more
    double max_flip;            // above 0 to 1: of FLIP's mean; 0 or less: FLIP does not count
    double pixels_per_degree;   // of FLIP; 0: 67
} TractrixLimits;

typedef struct TractrixFigures { // docs/compare.md has the definitions
    size_t size;
    uint64_t compared, failing; // pixels
    double largest;             // difference of a channel, levels of 255
    int at[2];                  // x, y of the first pixel that has it
    double rmse, psnr, ssim, flip, flip_most;
    bool same; // within the limits
} TractrixFigures;

// `mask`: white is compared, black is not; NULL: all is. `map`: [height][width], FLIP of each
// pixel, NaN where masked; NULL: none. `limits` NULL: equal only. That images differ is no failure,
// that their sizes do is TRACTRIX_USAGE.
TractrixResult tractrix_compare(TractrixFigures *figures, float *map, const TractrixImage *a,
                                const TractrixImage *b, const TractrixImage *mask,
                                const TractrixLimits *limits, TractrixError *error);
#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
