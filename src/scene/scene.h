// SPDX-License-Identifier: MIT
// The room scene: everything that a run needs: parameters, hair sections, head motion, forces,
// colliders, camera path and lights, from the command line, a scene file or both.
//
// Input: arguments and scene files (read by scene_json.c and scene_tracks.c, written by
// scene_write.c) and the files that they name (assets.h). Output, for `sim` and `draw`: the values
// at a time: head (rigid_track.h), forces, camera and lights (camera.h); and which step belongs to
// which frame (schedule.h). The automatic framing is in outline.h, which estimates what will be
// seen, and fit.h, which finds the nearest camera for what is seen.
#pragma once

#include "base/bytes.h"
#include "base/error.h"
#include "base/params.h"
#include "scene/body.h"
#include "scene/colliders.h"
#include "scene/rigid_track.h"
#include "scene/section_tracks.h"
#include "scene/track.h"

#include <jansson.h>
#include <stdint.h>

#define PARAM(...) +1
enum {
    SCENE_PARAMS = 0 // PARAM_COUNT
#include "base/params.def"
};
#undef PARAM

// The source of a parameter's value.
typedef enum Origin {
    ORIGIN_DEFAULT,    // the table, --look or --quality
    ORIGIN_SHARED_KEY, // the scene file: of the run, or for all sections
    ORIGIN_KEY,        // the scene file: of this section
    ORIGIN_FLAG,       // the command line
} Origin;

// One hair file, its behaviour and its look.
typedef struct Section {
    char *file;                         // owned; relative to the working folder
    const struct StrandsFrames *frames; // of its file, if they are played; owned by Assets
    const Strands *given;         // hair from memory, for which `file` is only a name; not owned
    SectionParams params;         // animated parameters: the value at time 0
    SectionTracks tracks;         // animated parameters
    uint8_t origin[SCENE_PARAMS]; // an Origin for each section parameter of the table
} Section;

typedef enum LightKind { LIGHT_DIRECTIONAL, LIGHT_POINT, LIGHT_SPOT } LightKind;

// A white matt surface facing the light shows color * intensity: everywhere for a directional
// light, at `distance` for the others, with inverse-square falloff. A spot has its full light up to
// `inner` degrees from its axis and none beyond `outer`.
typedef struct Light {
    LightKind kind;
    float direction[3]; // unit vector: directional, from the hair to the light (files have the
                        // opposite direction); spot, the direction of its light
    float color[3];     // linear RGB, 0..1
    float intensity;    // factor, >= 0
    float position[3];  // m, in the world; not directional
    float distance;     // m, > 0; not directional
    float inner_deg, outer_deg; // 0 <= inner < outer <= 90; spot
    float radius; // >= 0: of a directional light, as seen from the hair, degrees; of others, m
    bool shadow;  // casts shadows, if shadows are on
} Light;

#define SCENE_WIDE_MOST 45 // degrees: radius of a directional light

enum { SCENE_MAX_LIGHTS = 8, SCENE_MAX_SECTIONS = 1024, SCENE_MAX_BODIES = 16 };

// What the command line asks for. After anything but REQUEST_RUN the rest of the scene is
// unfinished; answer the request and stop.
typedef enum SceneRequest {
    REQUEST_RUN,
    REQUEST_VERSION, // --version
    REQUEST_HELP,    // -h, --help
} SceneRequest;

// A mesh from memory.
typedef struct GivenMesh {
    Mesh mesh;
    bool deforms; // moved by body_drive
} GivenMesh;

// A head or another body: its mesh, how it moves, and the hair on it. Hair moves, collides and is
// sheltered from wind as if its own body were alone; all bodies are drawn together.
typedef struct SceneBody {
    BodyParams params;
    uint8_t origin[SCENE_PARAMS];  // an Origin for each body parameter of the table
    RigidTrack head;               // moves the roots, the mesh and the colliders of its frame
    Colliders colliders;           // shapes that its hair must not cross
    const GivenMesh *given_mesh;   // a mesh from memory instead of params.mesh; not owned
    const Body *shape;             // the deforming mesh, set by assets_load; NULL if none
    uint32_t first, section_count; // its sections, one behind the other
} SceneBody;

// A zeroed scene is empty and may be destroyed.
typedef struct Scene {
    SceneRequest request;
    const char *topic; // of REQUEST_HELP, in argv; NULL if none
    char *file;        // owned; the scene file, NULL if none
    RunParams run;
    uint8_t origin[SCENE_PARAMS]; // an Origin for each run parameter of the table
    SceneBody bodies[SCENE_MAX_BODIES];
    uint32_t body_count;
    bool lists_bodies; // the scene file has a list of bodies
    Section *sections; // [section_count], owned; body by body
    uint32_t section_count;
    Track gravity;                  // width 3, m/s2; if not given, run.gravity
    Track wind;                     // width 3, m/s; if not given, run.wind
    Track eye, target;              // width 3, m; if not given, run.eye and run.target
    Track fov;                      // width 1, deg; if not given, run.fov
    Light lights[SCENE_MAX_LIGHTS]; // those of the look if the user gives none
    double world_origin[3];         // m: taken away from all places of the scene by assets_load,
                                    // because its hair is far from the world's zero
    bool plays;                     // animated hair files are played (set by programs that draw)
    bool own_lights;                // the user gives lights, or an empty list
    uint32_t light_count;           // 0 if the user gives an empty list: ambient light only
} Scene;

// Reads the command line of tractrix-render (argv[0] is skipped). Arguments that are not flags are
// hair files, each a section, or one scene file, recognised by its suffix ".json" or its content.
// Flags override the scene file: flags of the run override its values (--gravity, --wind, --eye,
// --target and --fov also its keyframes), flags of sections the values of all sections.
// RESULT_USAGE for wrong flags, values or combinations, and for flags without effect
// (effects_check); RESULT_BAD_INPUT for errors in the scene file; RESULT_FAILED when memory is
// short. The scene may be destroyed after an error.
Result scene_from_arguments(Scene *scene, int argc, char **argv, Error *error);

// Reads a scene file and checks the combination of values (scene_check). RESULT_BAD_INPUT with
// file, line or key, the value and what was expected. Paths in the file are relative to the file's
// folder; in the struct, to the working folder. Hair files are not opened.
Result scene_read(Scene *scene, const char *path, Error *error);

// Presets, which choose defaults for several parameters: words of --look and --quality. NULL: the
// table's.
typedef struct Presets {
    const char *look, *quality;
} Presets;

// Values of the command line on which others depend; NULL if not given.
typedef struct SceneOverrides {
    Presets presets;  // override the file's
    const char *algo; // parameters of this solver are accepted in any section
} SceneOverrides;

// Whether a path is that of a scene file: its name ends in .json, or it is text that begins with
// '{', as no hair file does.
bool scene_is_file(const char *path);

// Fills a scene made by scene_create: from one scene file (scene_is_file) or from hair files, each
// a section with the presets' defaults. RESULT_USAGE for an empty name and for a scene file
// together with other files; errors as scene_read_unchecked.
Result scene_open(Scene *scene, const char *const *files, size_t count,
                  const SceneOverrides *overrides, Error *error);

// Sets a parameter as a flag does: of a section, or of all sections if `section` is -1; a parameter
// of the run or of all bodies for any `section`. Removes the parameter's keyframes or track. Errors
// of params_parse and colliders_parse.
Result scene_set(Scene *scene, int section, const ParamInfo *info, const char *text, Error *error);

// The elements that have a scope's parameters: the run, or all bodies, or all sections; the
// RunParams, BodyParams or SectionParams of one; and the Origin of each of its rows.
uint32_t scene_count(const Scene *scene, ParamScope scope);
void *scene_params(const Scene *scene, ParamScope scope, uint32_t element);
uint8_t *scene_origins(const Scene *scene, ParamScope scope, uint32_t element);

// The body that a section is on.
const SceneBody *scene_body_of(const Scene *scene, uint32_t section);

// Where a body or a section stands in the scene file, for messages: "bodies[1]" with `then` behind
// it, or nothing if the file has no list of bodies; "sections[2]" or "bodies[1].sections[0]".
typedef struct ElementPlace {
    char text[48];
} ElementPlace;
ElementPlace scene_body_place(const Scene *scene, uint32_t body, const char *then);
ElementPlace scene_section_place(const Scene *scene, uint32_t section);

// Whether neither file nor command line set a parameter of the run.
bool scene_has_default(const Scene *scene, const char *name);

// Gives a turntable its default length and rate, 6 s at 30 frames per second, if neither is set;
// the time step stays that of other sequences. RESULT_FAILED when memory is short.
Result scene_choose_turn(Scene *scene, Error *error);

// Whether strands hold their shape by their own elasticity (the solver rod, except for its variant
// particles), so that a style of 0 keeps the groom.
bool section_is_elastic(const SectionParams *params);

// Resolves what depends on several parameters. Call once, after the last parameter is set.
// - Conflicts between colours: the setting with the higher Origin wins. A color replaces
//   transmission and melanin; all three replace file_colors; an opacity, or file_colors that are
//   off, replace file_opacity.
// - The style of elastic sections that neither file nor flag sets becomes 0.
void scene_settle(Scene *scene);

// Like scene_read, but without scene_settle and scene_check, so that flags can still
// override values and make a combination valid.
Result scene_read_unchecked(Scene *scene, const char *path, const SceneOverrides *overrides,
                            Error *error);

// The same, from the content of a scene file; `name` replaces its path in messages. Paths in it are
// relative to `folder` ("" or ending in '/').
Result scene_parse_unchecked(Scene *scene, const char *name, const Bytes *content,
                             const char *folder, const SceneOverrides *overrides, Error *error);

// Checks that the values fit together: frame range, camera, message flags, device flags, the '%' in
// an output pattern, names of files. RESULT_USAGE with the conflicting flags.
Result scene_check(const Scene *scene, Error *error);

// Makes run.first and run.last places from 0, once run.frame_number is known. RESULT_USAGE if they
// are not among the run's frames.
Result scene_number_frames(Scene *scene, Error *error);

// Whether the images store linear light (.pfm, .exr).
bool scene_draws_floats(const RunParams *run);

// All effective values as an object that is a valid scene file (paths relative to the working
// folder), for the stats file. Floats are as short as possible if dumped with
// JSON_REAL_PRECISION(9). The caller owns the reference; NULL when memory is short.
json_t *scene_to_json(const Scene *scene);

// Creates a run with defaults, the default lights, one body and no section. RESULT_FAILED when
// memory is short; the scene may be destroyed in either case.
Result scene_create(Scene *scene, Error *error);
void scene_destroy(Scene *scene);

// Appends a section of the last body with copies of `file` and `params`. RESULT_USAGE beyond
// SCENE_MAX_SECTIONS, RESULT_FAILED when memory is short.
Result scene_add_section(Scene *scene, const char *file, const SectionParams *params, Error *error);

// Sets the fields of `params` (a RunParams or SectionParams, depending on the scope) to the
// presets' defaults: first the look's, then the quality's, which override them; a RunParams also
// stores their words. Flags and scene files override both, in any order. RESULT_USAGE with the
// flag's name for an unknown word, RESULT_FAILED when memory is short.
Result scene_apply_presets(const Presets *presets, ParamScope scope, void *params, Error *error);

// Changes the look or quality (`info`) of the scene: everything that neither flags nor a scene file
// set gets the presets' values. Errors as scene_apply_presets.
Result scene_set_preset(Scene *scene, const ParamInfo *info, const char *word, Error *error);

// scene_create with the presets' defaults and lights. Errors as above.
Result scene_create_as(Scene *scene, const Presets *presets, Error *error);

// Sets the lights of a scene that gives none, by run.look. The studio's lights are placed around
// the automatic camera, or around a camera that looks along -z if the scene has its own camera.
void scene_set_lights(Scene *scene);
