// SPDX-License-Identifier: MIT
// The parameters of a run: three structs, and the table from which they are read, written and
// explained. Names, defaults, ranges and texts are only in params.def.
#pragma once

#include "base/error.h"
#include "base/profile.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// A number or vector that the program may choose. `value` is zero while `automatic`.
typedef struct AutoFloat {
    bool automatic;
    float value;
} AutoFloat;

typedef struct AutoInt {
    bool automatic;
    int value;
} AutoInt;

typedef struct AutoVec3 {
    bool automatic;
    float value[3];
} AutoVec3;

// The type of a value in C and its text form. Numbers must be finite.
typedef enum ParamKind {
    PARAM_BOOL,       // bool: true, false
    PARAM_INT,        // int: decimal
    PARAM_UINT,       // uint32_t: decimal
    PARAM_FLOAT,      // float: decimal, with or without exponent
    PARAM_PROFILE,    // ProfileNumber: decimal, or A:B, A:B@0.3:C along the strand (profile.h)
    PARAM_RATE,       // double, per second: decimal or fraction, A/B (rate.h)
    PARAM_TURN,       // float: decimal; "" (an option without a number) is 360
    PARAM_VEC3,       // float[3]: x,y,z
    PARAM_COLOR,      // float[3], sRGB 0..1: #rrggbb, r,g,b or a name (colors.h)
    PARAM_BACKGROUND, // float[4], sRGB and opacity 0..1: a color (opacity 1), or transparent (0)
    PARAM_AUTO_INT,   // AutoInt: auto, or a decimal
    PARAM_AUTO_FLOAT, // AutoFloat: auto, or a number
    PARAM_AUTO_VEC3,  // AutoVec3: auto, or x,y,z
    PARAM_AUTO_COLOR, // AutoVec3: auto, or a color
    PARAM_UNIT,       // AutoFloat, metres per unit of a file: auto, m, cm, mm, in, or a number
    PARAM_SIZE,       // int[2]: WxH
    PARAM_PART,       // int[2]: I/N, I at most N
    PARAM_CHOICE,     // int, an enumerator: one of the words
    PARAM_TEXT,       // char *, owned, never NULL: any text
    PARAM_PATH,       // char *, owned, never NULL: a path; empty for none
} ParamKind;

// The words of each CHOICE; their values count from 0.
#define CHOICES_NONE(X)
#define CHOICES_UP(X)    X(UP_AUTO, "auto") X(UP_Y, "y") X(UP_Z, "z")
#define CHOICES_SCALP(X) X(SCALP_AUTO, "auto") X(SCALP_NONE, "none")
#define CHOICES_FOLLOW(X)                                                                          \
    X(FOLLOW_OFFSET, "offset") X(FOLLOW_INTERPOLATE, "interpolate") X(FOLLOW_AUTO, "auto")
#define CHOICES_REST(X) X(REST_GROOM, "groom") X(REST_HANGING, "hanging")
#define CHOICES_TELEPORT(X)                                                                        \
    X(TELEPORT_CARRY, "carry") X(TELEPORT_LIMIT, "limit") X(TELEPORT_NONE, "none")
#define CHOICES_BACKEND(X) X(BACKEND_AUTO, "auto") X(BACKEND_EGL, "egl") X(BACKEND_OSMESA, "osmesa")
#define CHOICES_RASTER(X)                                                                          \
    X(RASTER_AUTO, "auto")                                                                         \
    X(RASTER_QUADS, "quads") X(RASTER_BLOCKS, "blocks") X(RASTER_COMPUTE, "compute")
#define CHOICES_OIT(X) X(OIT_AUTO, "auto") X(OIT_ABUFFER, "abuffer") X(OIT_NONE, "none")

#define CHOICES_TONE(X)  X(TONE_NONE, "none") X(TONE_REINHARD, "reinhard") X(TONE_FILMIC, "filmic")
#define CHOICES_DEPTH(X) X(DEPTH_8, "8") X(DEPTH_16, "16")
#define CHOICES_AOV(X)                                                                             \
    X(AOV_NONE, "none")                                                                            \
    X(AOV_COVERAGE, "coverage")                                                                    \
    X(AOV_DEPTH, "depth") X(AOV_TANGENT, "tangent") X(AOV_STRAND, "strand")
#define CHOICES_SHADING(X) X(SHADING_KAJIYA, "kajiya") X(SHADING_MARSCHNER, "marschner")
#define CHOICES_LOBES(X)   X(LOBES_ENERGY, "energy") X(LOBES_GAUSS, "gauss")
#define CHOICES_QUALITY(X)                                                                         \
    X(QUALITY_NORMAL, "normal") X(QUALITY_DRAFT, "draft") X(QUALITY_FINAL, "final")
#define CHOICES_LOOK(X)  X(LOOK_STUDIO, "studio") X(LOOK_PLAIN, "plain")
#define CHOICES_CURVE(X) X(CURVE_CATMULL_ROM, "catmull-rom") X(CURVE_BSPLINE, "bspline")
#define CHOICES_FRAMING(X)                                                                         \
    X(FRAMING_AUTO, "auto")                                                                        \
    X(FRAMING_EXPECTED, "expected") X(FRAMING_HAIR, "hair") X(FRAMING_ALL, "all")
#define CHOICES_SHADOW(X)  X(SHADOW_NONE, "none") X(SHADOW_APPROX, "approx") X(SHADOW_DOM, "dom")
#define CHOICES_SCATTER(X) X(SCATTER_NONE, "none") X(SCATTER_GRID, "grid")
#define CHOICES_MOTION(X)  X(MESH_SMOOTH, "smooth") X(MESH_LINEAR, "linear")
#define CHOICES_MESH(X)    X(MESH_MATT, "matt") X(MESH_SKIN, "skin")
#define CHOICES_FLOOR(X)   X(FLOOR_NONE, "none") X(FLOOR_PLANE, "plane") X(FLOOR_SHADOW, "shadow")

#define CHOICE_VALUE(value, word) value,
typedef enum UpAxis { CHOICES_UP(CHOICE_VALUE) } UpAxis;
typedef enum ScalpRule { CHOICES_SCALP(CHOICE_VALUE) } ScalpRule;
typedef enum FollowMode { CHOICES_FOLLOW(CHOICE_VALUE) } FollowMode;
typedef enum RestRule { CHOICES_REST(CHOICE_VALUE) } RestRule;
typedef enum TeleportRule { CHOICES_TELEPORT(CHOICE_VALUE) } TeleportRule;
typedef enum Backend { CHOICES_BACKEND(CHOICE_VALUE) } Backend;
typedef enum Quality { CHOICES_QUALITY(CHOICE_VALUE) } Quality;
typedef enum LookKind { CHOICES_LOOK(CHOICE_VALUE) } LookKind;
typedef enum CurveKind { CHOICES_CURVE(CHOICE_VALUE) } CurveKind;
typedef enum FramingKind { CHOICES_FRAMING(CHOICE_VALUE) } FramingKind;
typedef enum Shadow { CHOICES_SHADOW(CHOICE_VALUE) } Shadow;
typedef enum Scatter { CHOICES_SCATTER(CHOICE_VALUE) } Scatter;
typedef enum MeshMotion { CHOICES_MOTION(CHOICE_VALUE) } MeshMotion;
typedef enum MeshShading { CHOICES_MESH(CHOICE_VALUE) } MeshShading;
typedef enum FloorKind { CHOICES_FLOOR(CHOICE_VALUE) } FloorKind;
typedef enum Raster { CHOICES_RASTER(CHOICE_VALUE) } Raster;
typedef enum Oit { CHOICES_OIT(CHOICE_VALUE) } Oit;
typedef enum Lobes { CHOICES_LOBES(CHOICE_VALUE) } Lobes;
typedef enum Tone { CHOICES_TONE(CHOICE_VALUE) } Tone;
typedef enum Depth { CHOICES_DEPTH(CHOICE_VALUE) } Depth;
typedef enum Aov { CHOICES_AOV(CHOICE_VALUE) } Aov;
typedef enum Shading { CHOICES_SHADING(CHOICE_VALUE) } Shading;
#undef CHOICE_VALUE

// The headings of --help, in order.
#define PARAM_GROUPS(X)                                                                            \
    X(INPUT, "Input")                                                                              \
    X(OUTPUT, "Output")                                                                            \
    X(SIMULATION, "Simulation")                                                                    \
    X(FORCES, "Forces")                                                                            \
    X(COLLISION, "Collisions")                                                                     \
    X(CAMERA, "Camera")                                                                            \
    X(HAIR, "Hair")                                                                                \
    X(LIGHT, "Light")                                                                              \
    X(QUALITY, "Quality")                                                                          \
    X(DEVICE, "Device")

#define GROUP_VALUE(group, title) GROUP_##group,
typedef enum ParamGroup { PARAM_GROUPS(GROUP_VALUE) GROUP_COUNT } ParamGroup;
#undef GROUP_VALUE

// The three structs have a field for every row of params.def.
#define PARAM_FIELD_BOOL(field)  bool field;
#define PARAM_FIELD_INT(field)   int field;
#define PARAM_FIELD_UINT(field)  uint32_t field;
#define PARAM_FIELD_FLOAT(field) float field;
// A number and its profile along the strand: a ProfileNumber in two fields.
#define PARAM_FIELD_PROFILE(field)                                                                 \
    float field;                                                                                   \
    Profile field##_along;
#define PARAM_FIELD_RATE(field)       double field;
#define PARAM_FIELD_TURN(field)       float field;
#define PARAM_FIELD_VEC3(field)       float field[3];
#define PARAM_FIELD_COLOR(field)      float field[3];
#define PARAM_FIELD_BACKGROUND(field) float field[4];
#define PARAM_FIELD_AUTO_INT(field)   AutoInt field;
#define PARAM_FIELD_AUTO_FLOAT(field) AutoFloat field;
#define PARAM_FIELD_AUTO_VEC3(field)  AutoVec3 field;
#define PARAM_FIELD_AUTO_COLOR(field) AutoVec3 field;
#define PARAM_FIELD_UNIT(field)       AutoFloat field;
#define PARAM_FIELD_SIZE(field)       int field[2];
#define PARAM_FIELD_PART(field)       int field[2];
#define PARAM_FIELD_CHOICE(field)     int field;
#define PARAM_FIELD_TEXT(field)       char *field;
#define PARAM_FIELD_PATH(field)       char *field;

#define PARAM_IN_RUN(KIND, field) PARAM_FIELD_##KIND(field)
#define PARAM_IN_BODY(KIND, field)
#define PARAM_IN_SECTION(KIND, field)
#define PARAM(scope, KIND, GROUP, owner, field, ...) PARAM_IN_##scope(KIND, field)
typedef struct RunParams {
#include "base/params.def"
} RunParams;
#undef PARAM_IN_RUN
#undef PARAM_IN_BODY

#define PARAM_IN_RUN(KIND, field)
#define PARAM_IN_BODY(KIND, field) PARAM_FIELD_##KIND(field)
typedef struct BodyParams {
#include "base/params.def"
} BodyParams;
#undef PARAM_IN_BODY
#undef PARAM_IN_SECTION

#define PARAM_IN_BODY(KIND, field)
#define PARAM_IN_SECTION(KIND, field) PARAM_FIELD_##KIND(field)
typedef struct SectionParams {
#include "base/params.def"
} SectionParams;
#undef PARAM_IN_RUN
#undef PARAM_IN_BODY
#undef PARAM_IN_SECTION
#undef PARAM

typedef enum ParamScope { SCOPE_RUN, SCOPE_BODY, SCOPE_SECTION } ParamScope;

// A row of params.def.
typedef struct ParamInfo {
    const char *name; // of the field and the key of scene files; the flag has '-' instead of '_'
    ParamScope scope;
    ParamKind kind;
    ParamGroup group;
    const char *owner; // solvers that have it, separated by spaces; "": all
    char letter;       // one-letter flag, or 0
    size_t offset;     // offset of the field in the struct of the row's scope, bytes
    const char *default_text;
    double minimum, maximum;    // of each number, inclusive
    const char *unit;           // "" for a plain number
    const char *const *choices; // words, terminated by NULL; empty unless the kind is CHOICE
    const char *help;
} ParamInfo;

// Units of length that have a name.
typedef struct LengthUnit {
    const char *word;
    float metres;
} LengthUnit;
enum { LENGTH_UNIT_COUNT = 4 };
extern const LengthUnit LENGTH_UNITS[LENGTH_UNIT_COUNT];

extern const ParamInfo PARAM_TABLE[];
extern const size_t PARAM_COUNT;
extern const char *const GROUP_TITLES[GROUP_COUNT];

// Sets the defaults. RESULT_FAILED when memory is short; the struct may be destroyed in either
// case.
Result params_create_run(RunParams *params, Error *error);
Result params_create_body(BodyParams *params, Error *error);
Result params_create_section(SectionParams *params, Error *error);

// Frees what the struct owns and zeroes it; accepts a zeroed struct.
void params_destroy_run(RunParams *params);
void params_destroy_body(BodyParams *params);
void params_destroy_section(SectionParams *params);

// Makes a deep copy in `to`, which must not own anything. RESULT_FAILED when memory is short.
Result params_copy_body(BodyParams *to, const BodyParams *from, Error *error);
Result params_copy_section(SectionParams *to, const SectionParams *from, Error *error);

// A second name that flags and scene files may use, or NULL: --albedo is --color.
const char *params_also(const ParamInfo *info);

// The row with this name or second name, with '-' and '_' equal; NULL if there is none.
const ParamInfo *params_find(const char *name);

// Whether the solver of this name (--algo) has the parameter.
bool params_owned_by(const ParamInfo *info, const char *solver);

// Parses `text` into the row's field of `params`, the struct of the row's scope. RESULT_USAGE if it
// is not a value of that kind or out of range: the field keeps its value, and the error says what
// was given and what was expected. The caller adds the parameter's name as its user wrote it.
// RESULT_FAILED when memory is short.
Result params_parse(const ParamInfo *info, void *params, const char *text, Error *error);

// The field's value as the shortest text that params_parse reads back exactly. The caller frees it;
// NULL when memory is short.
char *params_format(const ParamInfo *info, const void *params);

// Describes the accepted values: "a number from 1 to 10000 (1/s)". Cut at `size`.
void params_describe(const ParamInfo *info, char *text, size_t size);
