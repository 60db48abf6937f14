// SPDX-License-Identifier: MIT
// The library of Tractrix. It simulates and renders hair with OpenGL 4.3, and compares images.
//
// Units: metres and seconds, unless a comment says otherwise. Coordinates are right-handed, y is
//   up. Text is UTF-8.
// Errors: if a function that returns a TractrixResult fails, it writes one line of text, without a
//   line end, into *error; `error` may be NULL. A function that fails changes none of its outputs,
//   with two exceptions: it sets the handle that it should have created to NULL, and
//   tractrix_compare may have written a part of `map`.
//   NULL for a required argument is TRACTRIX_USAGE; functions that return no result then return 0,
//   "" or NULL.
// Ownership: the library copies the arrays and texts that it gets. A handle belongs to the caller,
//   who frees it with the ..._destroy function of its type; these functions accept NULL. You may
//   destroy handles in any order: a device or a simulation is freed after everything that was
//   created from it has been destroyed.
// Threads: only one thread at a time may use a device and the handles that were created from it.
//   Different devices, scenes and pictures may be used by different threads at the same time.
// Side effects: the library prints nothing, installs no signal handlers and never ends the program.
//   It opens only files that an argument or a parameter names, and reads only plain files, no pipes
//   or devices. It does not change which OpenGL or
//   EGL context is current, and no setting of another library, such as the allocator of jansson.
// Locale: the locale of the host has no effect. Numbers in texts have a decimal point.
// fork(): a child process may only destroy the devices, simulations and renderers of its parent.
//   This frees nothing. All calls that need such a device fail with TRACTRIX_NO_GL, and so does
//   tractrix_device_open if it was called before the fork: drivers do not survive it. Fork first
//   and open devices then, or call exec() in the child.
// Structs whose first member is `size`: set `size` to sizeof the struct before each call, also if
//   the library fills in the struct. Newer versions may append members to these structs.
//   TractrixError and TractrixPose have no `size` and never change.
// Reproducibility: with the same OpenGL driver and processor family, the same calls give the same
//   positions and pixels, bit for bit. tractrix-render gives the same positions and pixels, too.
#ifndef TRACTRIX_H
#define TRACTRIX_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

#define TRACTRIX_VERSION_NUMBER 0x000200 // 0xMMmmpp: major, minor, patch
typedef enum TractrixResult {            // equal to the exit statuses of the programs
    TRACTRIX_OK = 0,
    TRACTRIX_FAILED = 1,     // a failure at run time: out of memory, disk full, driver error
    TRACTRIX_USAGE = 2,      // an argument or the value of a parameter is wrong
    TRACTRIX_BAD_INPUT = 3,  // the content of a file, of JSON text or of an array is wrong
    TRACTRIX_NO_GL = 4,      // there is no usable OpenGL
    TRACTRIX_CANCELLED = 130 // a TractrixProgress has returned false
} TractrixResult;
typedef struct TractrixError {
    char text[1024]; // "place: what is wrong: what was expected"
} TractrixError;
typedef struct TractrixDevice TractrixDevice;
typedef struct TractrixScene TractrixScene;
typedef struct TractrixSimulation TractrixSimulation;
typedef struct TractrixRenderer TractrixRenderer;
typedef struct TractrixPicture TractrixPicture;
typedef struct TractrixState TractrixState;

// The version of the loaded library: as a number like TRACTRIX_VERSION_NUMBER, and as the text that
// the programs' --version prints ("0.2.0"; builds between two versions also name the commit).
uint32_t tractrix_version_number(void);
const char *tractrix_version(void);
// Sets how many threads a call may use, 1 to 16; other values are clamped to 0 to 16. 0, the
// default: one thread for each processor that the process may use, at most 16. Applies to the whole
// process.
void tractrix_set_threads(int count);

// --- Devices.

typedef struct TractrixDeviceOptions {
    size_t size;
    const char *name; // device number, part of the renderer's or vendor's name, PCI address, device
                      // node or UUID, as for tractrix-render --device; NULL: the best device
    bool software;    // use only a CPU driver (software rendering)
    bool require_hardware; // use only a GPU, never a CPU driver; excludes `software`
} TractrixDeviceOptions;

// Opens a device with its own EGL context on its own thread. Calls may come from any thread, one at
// a time; each call waits until the device's thread has done its work. `options` NULL: the best
// device. TRACTRIX_NO_GL if no device can be used; the error text lists what was tried.
TractrixResult tractrix_device_open(TractrixDevice **device, const TractrixDeviceOptions *options,
                                    TractrixError *error);

// Makes a device from your own OpenGL context: version 4.3 or newer, by EGL or GLX. The context
// must be current on the calling thread, now and in every later call that uses this device or
// anything created from it, including the destroy functions. Each of these calls saves the state of
// OpenGL 4.3 core, sets what it needs, and restores your state. It discards pending errors of
// glGetError. A call fails with TRACTRIX_USAGE while a query of samples, primitives or time is
// active, or transform feedback that is not paused; and no conditional rendering may be active.
// TRACTRIX_NO_GL if no context is current or it lacks a required feature.
TractrixResult tractrix_device_borrow(TractrixDevice **device, TractrixError *error);
void tractrix_device_destroy(TractrixDevice *device);

// Is told the share of a long call that is done, 0 to 1, about every 50 ms; `data` is that of
// tractrix_device_set_progress. Returns whether the call may go on. It runs on the device's own
// thread, or on the calling thread if the device is borrowed, and must not call the library.
typedef bool TractrixProgress(void *data, double share);

// Sets the function that tractrix_simulation_create calls during the warm-up (parameter `preroll`).
// If it returns false, the call fails with TRACTRIX_CANCELLED. `progress` NULL: none.
void tractrix_device_set_progress(TractrixDevice *device, TractrixProgress *progress, void *data);

// Returns a property of the device. `what`: "renderer", "version", "vendor" (OpenGL's strings),
// "processor" (name of the CPU), "path" (how the context was made, for example "EGL device 0" or
// "borrowed"), "pci" (PCI address), "uuid", "node" (device node), or "passed-over" (why no GPU is
// used although there are signs of one). Returns "" if the property is unknown. The text is valid
// until the device is destroyed.
const char *tractrix_device_text(const TractrixDevice *device, const char *what);

// --- Parameters: the same as the options of tractrix-render and the keys of scene files
// (docs/options.md). In names, '-' and '_' mean the same.

typedef struct TractrixParameter {
    const char *name, *kind, *unit, *help, *default_text; // kind: "float", "vec3", "choice", ...
    const char *choices;     // the allowed words, separated by spaces; "": not limited to words
    const char *owner;       // names of the solvers that use it, separated by spaces; "": all
    double minimum, maximum; // limits of each number of the value; both 0: no limits
    bool of_section;         // each section of hair may have its own value
    bool live;               // can be changed during a simulation (tractrix_simulation_set)
} TractrixParameter;

// Returns row `index` of the table of parameters, or NULL if `index` is not below the number of
// rows. Rows stay valid until the process ends. The table does not contain the options that only
// concern the program tractrix-render: outputs, caches, devices and messages.
const TractrixParameter *tractrix_parameter(size_t index);

// --- Scenes: hair, mesh, parameters, lights and motion. A scene needs no device.

typedef struct TractrixStrands {
    size_t size;
    double metres_per_unit; // unit of `position`, above 0 to 1e9
    bool up_z;              // z is up in `position`, not y
    uint32_t strand_count;  // at least 1
    uint32_t vertices_each; // if `sizes` is NULL: vertices of every strand, 2 to 65,535
    const uint32_t *sizes;  // [strand_count]: vertices of each strand, 2 to 65,535; NULL: all
                            // strands have `vertices_each`
    const float *position;  // [vertices of all strands][3], strand by strand, root first; at most
                            // 1e6 m from 0 on each axis
    const float *thickness; // [vertices], in any unit. A vertex with the mean thickness has the
                            // radius that the parameter `radius` sets; the radii of other vertices
                            // are in proportion. NULL: all equal
    const float *color; // [vertices][4]: linear RGB and opacity, 0 to 1; NULL: parameters decide
    const float *uv;    // [strand_count][2]: texture coordinates of the root; NULL: none
} TractrixStrands;

typedef struct TractrixMesh {
    size_t size;
    double metres_per_unit; // unit of `position`, above 0 to 1e9
    bool up_z;              // z is up in `position`, not y
    bool deforms;           // tractrix_simulation_advance_mesh will move the vertices; hair is then
                            // bound to the mesh at its roots
    uint32_t vertex_count, triangle_count; // at least 3 and 1
    const float *position;    // [vertex_count][3], for a head whose pose is the identity; at most
                              // 1e6 m from 0 on each axis
    const uint32_t *triangle; // [triangle_count][3]: indices of vertices, counter-clockwise as seen
                              // from outside
} TractrixMesh;

// Creates a scene without hair. `look` chooses the defaults of lights, fibres, exposure and
// background: "studio" or "plain"; NULL: "studio".
TractrixResult tractrix_scene_create(TractrixScene **scene, const char *look, TractrixError *error);
// Creates a scene from a scene file, or from a hair file: the scene then has this hair and default
// parameters. `path` "-" (standard input) is refused with TRACTRIX_USAGE. The function checks that
// the scene's hair files and meshes can be opened (TRACTRIX_BAD_INPUT if not), but does not read
// them: each tractrix_simulation_create reads them. So you can still change parameters that affect
// reading, such as `unit` and `up`. If the mesh is a pattern of numbered files (mesh_%04d.obj),
// its files are checked only by tractrix_simulation_create.
TractrixResult tractrix_scene_read(TractrixScene **scene, const char *path, TractrixError *error);
// The same with the text of a scene file. Relative paths in the text are relative to `folder`;
// NULL: the current directory.
TractrixResult tractrix_scene_parse(TractrixScene **scene, const char *json, const char *folder,
                                    TractrixError *error);
void tractrix_scene_destroy(TractrixScene *scene);

// Appends a section of hair. `name` identifies the section in messages; NULL: "strands".
// TRACTRIX_BAD_INPUT if a strand has fewer than 2 or more than 65,535 vertices, a number that is
// not finite, a coordinate beyond 1e6 m, a colour beyond 0 to 1, a negative thickness, or two
// neighbouring vertices that coincide; the error text has the number of the strand, counted from 0.
TractrixResult tractrix_scene_add_strands(TractrixScene *scene, const char *name,
                                          const TractrixStrands *strands, TractrixError *error);
// Sets the mesh and replaces an earlier one; `mesh` NULL removes it. Hair collides with the mesh,
// and the mesh hides hair behind it. TRACTRIX_USAGE if the scene has several bodies;
// TRACTRIX_BAD_INPUT if a triangle has an index that is too large, or a coordinate is not finite or
// beyond 1e6 m.
TractrixResult tractrix_scene_set_mesh(TractrixScene *scene, const TractrixMesh *mesh,
                                       TractrixError *error);
// The same for one body of a scene; `mesh` must not be NULL. `body`: its index in the scene file's
// list of bodies, from 0; a scene without such a list has one body.
TractrixResult tractrix_scene_set_body_mesh(TractrixScene *scene, uint32_t body,
                                            const TractrixMesh *mesh, TractrixError *error);
uint32_t tractrix_scene_section_count(const TractrixScene *scene);
uint32_t tractrix_scene_body_count(const TractrixScene *scene);

// Sets a parameter. `text` is the value as written on the command line: ("wind", "2,0,0").
// `section`: the index of a section, for a parameter with `of_section`; -1 sets such a parameter in
// all sections that the scene has now, and is the only valid value for all other parameters.
// TRACTRIX_USAGE if the name, the section or the value is wrong; the error text says what is
// expected. Conflicts between parameters, and parameters without any effect, are found by
// tractrix_simulation_create.
TractrixResult tractrix_scene_set(TractrixScene *scene, int section, const char *name,
                                  const char *text, TractrixError *error);
// These two functions write a text: the value of a parameter (`section` -1: the value in the first
// section), or the whole scene as JSON. The JSON does not contain arrays; it only names them.
// `room` is the size of the buffer `text` in bytes. A longer text is cut; the text always ends with
// a zero byte, unless `room` is 0 or `text` is NULL: then nothing is written. Both functions return
// the length of the complete text without the zero byte, as snprintf does. They return 0 if the
// text is empty, if there is no such parameter or section, or if memory is short.
size_t tractrix_scene_get(const TractrixScene *scene, int section, const char *name, char *text,
                          size_t room);
size_t tractrix_scene_json(const TractrixScene *scene, char *text, size_t room);

// --- Simulations.

// Places the head in the world: x_world = rotation * x_head + translation. The rotation is a
// quaternion x, y, z, w whose length differs from 1 by less than 1e-3. The translation is in
// metres, -1e6 to 1e6.
typedef struct TractrixPose {
    double rotation[4], translation[3];
} TractrixPose;

// Creates a simulation of the scene as it is now; later changes of the scene do not affect the
// simulation. The call reads the scene's hair files and meshes and simulates the warm-up (parameter
// `preroll`). After the call the time is 0. TRACTRIX_USAGE if the scene has no hair, if parameters
// contradict each other, or if a parameter would have no effect; TRACTRIX_BAD_INPUT if a file is
// wrong.
TractrixResult tractrix_simulation_create(TractrixSimulation **simulation, TractrixDevice *device,
                                          const TractrixScene *scene, TractrixError *error);
void tractrix_simulation_destroy(TractrixSimulation *simulation);

// Returns messages about what was repaired, guessed or ignored when the scene was read: lines that
// each end with a line feed, or "" if there are none. The text is valid until the simulation is
// destroyed.
const char *tractrix_simulation_messages(const TractrixSimulation *simulation);

// Changes a parameter of a running simulation, from the next step or image on. Only parameters with
// `live` (TractrixParameter) can be changed: those of gravity, wind and camera, and those of
// drawing alone: colours, shading, light, shadows, exposure, background, samples, level of detail,
// `aov`. Renderers draw the next image as a new renderer would, but keep an automatic exposure
// until "exposure" is set. The value replaces the keyframes of the parameter, if it has any.
// TRACTRIX_USAGE if the parameter is not live or the value is wrong.
TractrixResult tractrix_simulation_set(TractrixSimulation *simulation, const char *name,
                                       const char *text, TractrixError *error);

// The same for one section of hair, from 0; -1: all sections.
TractrixResult tractrix_simulation_set_section(TractrixSimulation *simulation, int section,
                                               const char *name, const char *text,
                                               TractrixError *error);

// Simulates one frame: the video advances by 1 / fps seconds, the scene's time by speed / fps
// seconds (parameters `fps` and `speed`, which is 1 by default). `head` is the pose of the head,
// and of the mesh, at the end of the frame; the head moves there at constant speed during the
// frame. `head` NULL: the head moves as the scene says, or stays where it is if an earlier call has
// given a pose. The call only queues GPU work and does not wait for it. A pose is refused with
// TRACTRIX_USAGE if a frame is not a whole number of simulation steps (parameters `fps`, `speed`,
// `sim_rate`, `substeps`), if the mesh deforms, if the scene has several bodies, or if the pose is
// outside the ranges of TractrixPose.
TractrixResult tractrix_simulation_advance(TractrixSimulation *simulation, const TractrixPose *head,
                                           TractrixError *error);
// Simulates one frame like tractrix_simulation_advance, with the vertices of a mesh that deforms
// (TractrixMesh.deforms). `position`: [vertex_count][3], where the vertices are at the end of the
// frame, in world space, m, y up. During the frame each vertex moves in a straight line. The roots
// of the hair follow the mesh. TRACTRIX_USAGE if the scene has no such mesh, if it has another
// number of vertices, or if a frame is not a whole number of steps; TRACTRIX_BAD_INPUT if a
// coordinate is not finite or beyond 1e6 m.
TractrixResult tractrix_simulation_advance_mesh(TractrixSimulation *simulation,
                                                const float *position, uint32_t vertex_count,
                                                TractrixError *error);
// These two functions say where one body will be at the end of the frame that the next
// tractrix_simulation_advance simulates (with `head` NULL): the pose of its head, or the vertices
// of its mesh that deforms. `body` is its index in the scene file's list of bodies, from 0. If a
// body is placed twice, the last call counts. Bodies that are not placed move as the scene says, or
// stay where they are if an earlier call has placed them. Results as those of
// tractrix_simulation_advance and tractrix_simulation_advance_mesh, which are for scenes of one
// body.
TractrixResult tractrix_simulation_place_body(TractrixSimulation *simulation, uint32_t body,
                                              const TractrixPose *head, TractrixError *error);
TractrixResult tractrix_simulation_place_body_mesh(TractrixSimulation *simulation, uint32_t body,
                                                   const float *position, uint32_t vertex_count,
                                                   TractrixError *error);
double tractrix_simulation_time(const TractrixSimulation *simulation); // scene time, s

// Saves the state of the simulation between two frames. A simulation of an equal scene on a device
// of the same kind continues from there, bit for bit, as if it had never stopped. The call waits
// for the GPU. TRACTRIX_USAGE if the caller has moved a body of the scene.
TractrixResult tractrix_simulation_save(TractrixState **state, TractrixSimulation *simulation,
                                        TractrixError *error);
// Returns to a state: its time, and the hair as it was. TRACTRIX_BAD_INPUT if the state is of other
// hair or solvers, or damaged; the simulation may then be partly changed, and only a restored state
// makes it usable again.
TractrixResult tractrix_simulation_restore(TractrixSimulation *simulation,
                                           const TractrixState *state, TractrixError *error);
// The bytes of a state, for example for a file, and a state made of them. The bytes belong to the
// state; `size` may be NULL.
const void *tractrix_state_bytes(const TractrixState *state, size_t *size);
TractrixResult tractrix_state_create(TractrixState **state, const void *bytes, size_t size,
                                     TractrixError *error);
void tractrix_state_destroy(TractrixState *state);

typedef enum TractrixPart { TRACTRIX_GUIDES = 0, TRACTRIX_FOLLOWERS = 1 } TractrixPart;

// Guides have the order of the array or file that they come from. Followers follow in the order of
// their guides: all followers of the first guide, then those of the second, and so on.
typedef struct TractrixPositions {
    size_t size;
    uint32_t strand_count, vertex_count; // total of all strands; both 0 if there are no followers
    const uint32_t *sizes;               // [strand_count]: vertices of each strand; never changes
    const float *position;               // [vertex_count][4]: x, y, z, 1 in world space, m, strand
                                         // by strand, root first
} TractrixPositions;

// Fills `positions` with the current positions of a section's guides or followers, exactly as the
// renderer draws them. `section` is the section's index, from 0. The call waits for the GPU. The
// arrays belong to the simulation. They stay valid and unchanged until the next call that advances
// the simulation, sets one of its parameters, maps the same part of the same section, or destroys
// the simulation.
TractrixResult tractrix_simulation_map(TractrixSimulation *simulation, int section,
                                       TractrixPart part, TractrixPositions *positions,
                                       TractrixError *error);

// Copies the same positions on the GPU into `buffer`, an OpenGL buffer of the borrowed context,
// from byte `offset` on, a multiple of 16. The layout is that of TractrixPositions.position: 16
// bytes a vertex. The call only queues GPU work and does not wait for it. TRACTRIX_USAGE if the
// buffer does not exist or is too small, or if the device is not borrowed. TRACTRIX_FAILED if the
// positions need more bytes than the driver lets a shader write; OpenGL 4.3 guarantees 16 MiB.
TractrixResult tractrix_simulation_copy_to_gl(TractrixSimulation *simulation, int section,
                                              TractrixPart part, uint32_t buffer, size_t offset,
                                              TractrixError *error);

// --- Images.

typedef enum TractrixFormat {
    TRACTRIX_RGBA8 = 0,   // 8 bits a channel, sRGB, straight alpha
    TRACTRIX_RGBA32F = 1, // 32-bit floats, linear light, premultiplied alpha
    TRACTRIX_RGBA16 = 2   // 16 bits a channel, sRGB, straight alpha
} TractrixFormat;

typedef struct TractrixImage { // the first row is the top one
    size_t size;
    int width, height; // px, 1 to 16,384
    TractrixFormat format;
    size_t row_bytes; // bytes from the start of a row to the start of the next, a multiple of the
                      // size of a channel; 0: rows without gaps
    void *pixels;     // [height] rows of [width] pixels: red, green, blue, alpha
} TractrixImage;

typedef struct TractrixView { // matrices in column-major order, as for glUniformMatrix4fv
    size_t size;
    float world_to_eye[16]; // rotation and translation, without scale or mirroring
    float projection[16];   // eye space to OpenGL's clip space: a perspective that looks along -z,
                            // with 0 < near < far < infinity
} TractrixView;

// Creates a renderer with the parameters of the simulation's scene. `width`, `height`: 1 to 16,384
// px. If `exposure` is automatic, this call measures the exposure once; with TRACTRIX_RGBA32F an
// automatic exposure is 0, so pixels have the light of the scene unchanged.
TractrixResult tractrix_renderer_create(TractrixRenderer **renderer, TractrixSimulation *simulation,
                                        int width, int height, TractrixFormat format,
                                        TractrixError *error);
void tractrix_renderer_destroy(TractrixRenderer *renderer);

// Renders the current state of the simulation into image->pixels and waits until the image is
// complete. `view` NULL: the scene's camera. Alpha is 1 everywhere unless the parameter
// `background` is transparent. TRACTRIX_USAGE if the image does not have the size and format of the
// renderer, or if a matrix of the view is not as TractrixView says.
TractrixResult tractrix_render(TractrixRenderer *renderer, const TractrixView *view,
                               TractrixImage *image, TractrixError *error);

// Data of each pixel besides its colour: arrays [height][width], the first row is the top one;
// NULL: not wanted. A pixel that no strand covers enough has 0 in depth, tangent and strand.
typedef struct TractrixLayers {
    size_t size;
    float *coverage;  // share of the pixel that hair covers, 0 to 1
    float *depth;     // distance from the eye along the view, m
    float *tangent;   // [height][width][3]: unit vector along the strand in world space
    uint32_t *strand; // number that the strand has in --aov strand and in EXR files, 24 bits
} TractrixLayers;

// Renders an image as tractrix_render does, and layers of the same state and view in the same call.
// `layers` NULL: none. The first call with layers makes the renderer's images anew.
TractrixResult tractrix_render_layers(TractrixRenderer *renderer, const TractrixView *view,
                                      TractrixImage *image, const TractrixLayers *layers,
                                      TractrixError *error);

// Reads a PNG, EXR or PFM file. The content decides which, not the name. Alpha is 1 if the file has
// none. TRACTRIX_BAD_INPUT if the file is of another kind (JPEG, too) or damaged.
TractrixResult tractrix_picture_read(TractrixPicture **picture, const char *path,
                                     TractrixError *error);
// Returns the picture's image, which is valid until the picture is destroyed.
const TractrixImage *tractrix_picture_image(const TractrixPicture *picture);
void tractrix_picture_destroy(TractrixPicture *picture);
// Writes an image file. The suffix of `path` decides the file format: .png for TRACTRIX_RGBA8 and
// TRACTRIX_RGBA16; .jpg or .jpeg for TRACTRIX_RGBA8 with all pixels opaque; .exr or .pfm for
// TRACTRIX_RGBA32F. If all pixels are opaque, the file has no alpha channel. A .pfm file never has
// one: alpha is dropped. Floats are written with 32 bits: tractrix_picture_read gives them back.
// TRACTRIX_USAGE for another suffix or a format that does not suit the suffix; TRACTRIX_BAD_INPUT
// if a float is not finite.
TractrixResult tractrix_image_write(const TractrixImage *image, const char *path,
                                    TractrixError *error);

typedef struct TractrixWriteOptions {
    size_t size;
    bool half; // .exr: 16 bits a channel, with a precision of 1 / 2048
} TractrixWriteOptions;

// The same with options; NULL: none. TRACTRIX_USAGE if `half` does not suit the suffix or a value
// is beyond 65,504.
TractrixResult tractrix_image_write_with(const TractrixImage *image, const char *path,
                                         const TractrixWriteOptions *options, TractrixError *error);

// Limits within which two images pass, as the options of tractrix-compare. If all members but
// `size` are 0, only equal images pass. TRACTRIX_USAGE if a limit is out of range or if there is
// none.
typedef struct TractrixLimits {
    size_t size;
    double pixel_tolerance; // a pixel fails if a channel differs by more than this, in levels of 0
                            // to 255; at most 255; below 0: failing pixels do not count
    double max_failing_percent; // how many of the compared pixels may fail, 0 to 100 %
    double max_flip;            // largest allowed mean of FLIP, at most 1; 0 or less: no such limit
    double pixels_per_degree;   // viewing distance for FLIP, 1 to 1000; 0: the default, 67
    double max_difference;      // largest allowed difference of a channel, at most 255 levels; 0 or
                                // less: no such limit
    double max_local_difference; // largest allowed mean difference of a channel over 16 x 16
                                 // pixels, at most 255 levels; 0 or less: no such limit
} TractrixLimits;

typedef struct TractrixFigures { // docs/compare.md defines the figures
    size_t size;
    uint64_t compared, failing; // numbers of pixels; `failing` of the compared pixels fail
    double largest;             // largest difference of a channel, in levels of 0 to 255
    int at[2];                  // x, y of the first pixel with this difference, from the top left
    // `rmse` is in levels, `psnr` in dB; `flip` is the mean of FLIP and `flip_most` its largest
    // value, 0 to 1. Equal images: rmse 0, psnr INFINITY, ssim 1, flip and flip_most 0.
    double rmse, psnr, ssim, flip, flip_most;
    bool same;               // as `within`, by an older name
    bool within;             // the images are within the limits
    bool equal;              // there is no visible difference
    int local_at[2];         // x, y of the window below: its top left pixel
    double local_difference; // largest mean difference of a channel over 16 x 16 pixels, in levels
} TractrixFigures;

// Compares two images of the same size. Their formats may differ. `mask` is an image of the same
// size: pixels where the mask is black are ignored, pixels where it is white (luma at least half)
// or transparent are compared; NULL: all pixels are compared. `map` is an array [height][width]
// that receives FLIP's error of each pixel, NaN for ignored pixels; NULL: not wanted. `limits`
// NULL: only equal images pass. If the images differ, the function still returns TRACTRIX_OK; see
// figures->within. TRACTRIX_USAGE if the sizes differ, TRACTRIX_BAD_INPUT if the mask is all black
// or a float of an image is not finite.
TractrixResult tractrix_compare(TractrixFigures *figures, float *map, const TractrixImage *a,
                                const TractrixImage *b, const TractrixImage *mask,
                                const TractrixLimits *limits, TractrixError *error);
#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
