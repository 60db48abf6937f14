// SPDX-License-Identifier: MIT
// The hair of a scene file (USD, Alembic): a list of its objects, and one policy for both formats.
// A reader adds the objects that it finds, each with what the file says about it. scene_hair_make
// decides which are read, makes the strands, and says what is left out and why. docs/formats.md
// has the policy as a table.
#pragma once

#include "formats/basis_curves.h"
#include "formats/format.h"

// Why an object of curves is not read. What is said about those from SCENE_CLOSED on is a flaw,
// which --strict refuses.
typedef enum SceneWhy {
    SCENE_READ,
    SCENE_EMPTY,     // it has no points, such as an `over`
    SCENE_UNWANTED,  // the caller's choice of objects leaves it out
    SCENE_ABSENT,    // inactive or abstract
    SCENE_HIDDEN,    // invisible in all samples, or of purpose guide or proxy
    SCENE_CLOSED,    // curves without ends
    SCENE_FOREIGN,   // NURBS or Hermite curves, or of an unknown basis
    SCENE_SCATTERED, // of a PointInstancer
    SCENE_DAMAGED,   // its arrays do not fit
    SCENE_WHYS
} SceneWhy;

typedef struct SceneObject {
    char path[FORMAT_PATH_SIZE]; // "/Head/scalp"
    BasisCurves curves;
    int node;       // the reader's number of the object, for its transform
    uint64_t place; // line of a text file, byte of a binary one
    SceneWhy why;
    double *guide;      // [guide_count] 1 for each strand that is a guide, which is left out beside
    size_t guide_count; // others; a single number is for all strands
    bool centimetres;   // widths are always in centimetres (Unreal's)
    bool skinned;       // a skeleton moves it, which is not read
} SceneObject;

typedef struct SceneHair {
    Reader *reader;
    FormatWishes wishes;
    SceneObject *object; // [count]
    uint32_t count, room;
    double *time; // [time_count] of the frames, or only of the first one
    uint32_t time_count;
    double origin[3];  // taken away from all positions
    uint32_t features; // STRANDS_HAS_..., of some objects only, and so lost
    // The reader's:
    void *file;
    // The matrix of an object in the world: p' = p M. Fails the reader.
    void (*find_matrix)(void *file, int node, double time, double matrix[4][4]);
    // Sets `time` to the times of the objects that are read (with wishes.all_frames all of them),
    // and the source's samples, fps and first_frame. Fails the reader.
    void (*find_times)(void *file, struct SceneHair *hair, FormatSource *source);
} SceneHair;

// Adds an object, which then owns the curves; NULL, and fails the reader, if memory is short.
SceneObject *scene_hair_add(SceneHair *hair, const char *path, const BasisCurves *curves);

// Makes the source of the objects. Fails the reader if none can be read: with the damage of the
// first one, with what is left out, or with `otherwise`.
Result scene_hair_make(SceneHair *hair, FormatSource *source, const char *otherwise);
void scene_hair_destroy(SceneHair *hair);
