// SPDX-License-Identifier: MIT
// The room scene: everything that a run needs to know: parameters, hair sections, head motion,
// forces, colliders, camera path and lights, from the command line, a scene file or both.
//
// It takes in arguments and scene files (scene_json.c, scene_tracks.c; scene_write.c writes
// them), reads the files that they name (assets.h), and says what holds at a time: head
// (rigid_track.h), forces, camera and lights (camera.h), and which step is which frame
// (schedule.h). The camera's automatic framing is in outline.h, which estimates what will be seen,
// and fit.h, which finds the nearest camera for what is seen. It hands all this on to `sim` and
// `draw`.
#pragma once

#include "base/bytes.h"
#include "base/error.h"
#include "base/params.h"
#include "scene/body.h"
#include "scene/colliders.h"
#include "scene/keyframes.h"
#include "scene/rigid_track.h"
#include "scene/section_tracks.h"

#include <jansson.h>
#include <stdint.h>

#define PARAM(...) +1
enum {
    SCENE_PARAMS = 0 // PARAM_COUNT
#include "base/params.def"
};
#undef PARAM

// Where a parameter's value comes from.
typedef enum Origin {
    ORIGIN_DEFAULT,    // the table, --look or --quality
    ORIGIN_SHARED_KEY, // of the scene file: the run's, or for all sections
    ORIGIN_KEY,        // the section's own
    ORIGIN_FLAG,       // the command line
} Origin;

// One hair file and how it behaves and looks.
typedef struct Section {
    char *file;                   // owned; relative to the working folder
    const Strands *given;         // hair from elsewhere, of which `file` is but the name; not owned
    SectionParams params;         // those that change over time: as at time 0
    SectionTracks tracks;         // how they change
    uint8_t origin[SCENE_PARAMS]; // an Origin for each row of the table that is a section's
} Section;

typedef enum LightKind { LIGHT_DIRECTIONAL, LIGHT_POINT, LIGHT_SPOT } LightKind;

// What a white matt surface square to the light shows is color * intensity: everywhere for a
// directional light; for the others at `distance`, and by the square of the distance elsewhere. A
// spot has all of it up to `inner` degrees off its axis and nothing beyond `outer`.
typedef struct Light {
    LightKind kind;
    float direction[3]; // unit vector: directional, from the hair towards the light (files give the
                        // way it travels); spot, the way that it looks
    float color[3];     // linear RGB, 0..1
    float intensity;    // factor, >= 0
    float position[3];  // m, in the world; not directional
    float distance;     // m, > 0; not directional
    float inner_deg, outer_deg; // 0 <= inner < outer <= 90; spot
    bool shadow;                // casts shadows, if there are any
} Light;

enum { SCENE_MAX_LIGHTS = 8, SCENE_MAX_SECTIONS = 1024 };

// What the command line asks for. Anything but REQUEST_RUN leaves the rest of the scene unfinished:
// print that and stop.
typedef enum SceneRequest {
    REQUEST_RUN,
    REQUEST_VERSION, // --version
    REQUEST_HELP,    // -h, --help
} SceneRequest;

// A mesh that is in memory already.
typedef struct GivenMesh {
    Mesh mesh;
    bool deforms; // by body_drive
} GivenMesh;

// A zeroed scene is empty and may be destroyed.
typedef struct Scene {
    SceneRequest request;
    const char *topic; // of REQUEST_HELP, in argv; NULL: none
    char *file;        // owned; the scene file, NULL: none
    RunParams run;
    uint8_t origin[SCENE_PARAMS]; // an Origin for each row of the table that is the run's
    Section *sections;            // [section_count], owned
    uint32_t section_count;
    RigidTrack head;                // moves the roots and the mesh
    const GivenMesh *given_mesh;    // a mesh from elsewhere, instead of run.mesh; not owned
    const Body *body;               // how the mesh deforms, set by assets_load; NULL: not at all
    Keyframes gravity;              // width 3, m/s2; without keys run.gravity holds
    Keyframes wind;                 // width 3, m/s; without keys run.wind holds
    Keyframes eye, target;          // width 3, m; without keys run.eye, run.target hold
    Keyframes fov;                  // width 1, deg; without keys run.fov holds
    Light lights[SCENE_MAX_LIGHTS]; // those of the look if the user names none
    bool own_lights;                // the user names some, or none at all by an empty list
    Colliders colliders;            // shapes that hair must not cross
    uint32_t light_count;           // 0 if the user gives an empty list: ambient light only
} Scene;

// Reads the command line of tractrix-render (argv[0] is skipped). Arguments that are no flags are
// hair files, each a section, or one scene file, which is known by the end ".json" or by its
// content. Flags override the scene file: those of a run its values (--gravity, --wind, --eye,
// --target and --fov also replace keyframes), those of a section the values of all sections.
// RESULT_USAGE for wrong flags, values or combinations, and flags without effect (effects_check);
// RESULT_BAD_INPUT for the scene file's content; RESULT_FAILED when memory is short. The scene may
// be destroyed in each case.
Result scene_from_arguments(Scene *scene, int argc, char **argv, Error *error);

// Reads a scene file and checks the combination of values as scene_check does. RESULT_BAD_INPUT
// with file, line or key, what was got and what was expected. Paths in the file are relative to the
// file's folder; in the struct, to the working folder. Hair files are not opened.
Result scene_read(Scene *scene, const char *path, Error *error);

// What chooses defaults for several parameters at once: words of --look and --quality, NULL: the
// table's.
typedef struct Presets {
    const char *look, *quality;
} Presets;

// What the command line says of values that others depend on; NULL: nothing.
typedef struct SceneOverrides {
    Presets presets;  // their words count instead of the file's
    const char *algo; // whose parameters are right in any section
} SceneOverrides;

// Whether a path is that of a scene file: named .json, or text that begins with '{', which no hair
// file does.
bool scene_is_file(const char *path);

// Fills a scene that scene_create has made: one scene file, known by scene_is_file,
// or hair files, each a section with the presets' defaults. RESULT_USAGE for an empty name,
// and for a scene file among others; errors as scene_read_unchecked.
Result scene_open(Scene *scene, const char *const *files, size_t count,
                  const SceneOverrides *overrides, Error *error);

// Gives a parameter a value as a flag does: of a section, or with -1 of all sections; of the run
// whatever `section` is. What changes over time of it (keyframes, tracks) goes. Errors of
// params_parse, and of colliders_parse.
Result scene_set(Scene *scene, int section, const ParamInfo *info, const char *text, Error *error);

// Whether neither file nor command line has given a parameter of the run.
bool scene_has_default(const Scene *scene, const char *name);

// A turntable lasts 6 s at 30 frames a second where nothing is said of either, with the step that
// other sequences have. RESULT_FAILED when memory is short.
Result scene_choose_turn(Scene *scene, Error *error);

// What is said gives way to what is said more closely: a transmission or melanin to a color;
// file_colors to all three; file_opacity to an opacity, and to file_colors that are refused. To be
// called once, when the last parameter is set.
void scene_settle_colors(Scene *scene);

// As scene_read, but without scene_settle_colors and scene_check, so that flags may still win and
// mend a combination.
Result scene_read_unchecked(Scene *scene, const char *path, const SceneOverrides *overrides,
                            Error *error);

// The same from the content of a scene file that `name` stands for in messages; paths in it begin
// at `folder` ("" or ended by '/').
Result scene_parse_unchecked(Scene *scene, const char *name, const Bytes *content,
                             const char *folder, const SceneOverrides *overrides, Error *error);

// Whether the values fit together: frame range, camera, message flags, device flags, the '%' in an
// output pattern, names of files. RESULT_USAGE naming the flags in conflict.
Result scene_check(const Scene *scene, Error *error);

// Whether the images are light as it is (.pfm, .exr).
bool scene_draws_floats(const RunParams *run);

// Every effective value as an object that is a scene file again (paths are relative to the working
// folder), for the stats file. Floats are as short as they can be if dumped with
// JSON_REAL_PRECISION(9). The caller owns the reference; NULL when memory is short.
json_t *scene_to_json(const Scene *scene);

// A run with defaults, the default lights and no section. RESULT_FAILED when memory is short; the
// scene may be destroyed in either case.
Result scene_create(Scene *scene, Error *error);
void scene_destroy(Scene *scene);

// Appends a section with copies of `file` and `params`. RESULT_USAGE beyond SCENE_MAX_SECTIONS,
// RESULT_FAILED when memory is short.
Result scene_add_section(Scene *scene, const char *file, const SectionParams *params, Error *error);

// Gives the fields of `params`, a RunParams or SectionParams as the scope says, the presets'
// defaults: first the look's, then the quality's, which win; a RunParams also their words. What a
// flag or a scene file says of a parameter wins over both, whatever the order. RESULT_USAGE with
// the flag's name for another word, RESULT_FAILED when memory is short.
Result scene_apply_presets(const Presets *presets, ParamScope scope, void *params, Error *error);

// Gives the scene another look or quality (`info`): what neither flags nor a scene file have set
// becomes what the presets say. Errors as scene_apply_presets.
Result scene_set_preset(Scene *scene, const ParamInfo *info, const char *word, Error *error);

// scene_create with the presets' defaults and lights. Errors as above.
Result scene_create_as(Scene *scene, const Presets *presets, Error *error);

// The lights of a scene that names none, by run.look. Those of the studio stand around the
// automatic camera, and around one that looks along -z where the scene has a camera of its own.
void scene_set_lights(Scene *scene);
