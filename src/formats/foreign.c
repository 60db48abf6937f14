// SPDX-License-Identifier: MIT
#include "formats/foreign.h"

#include <string.h>

#define HAIR FOREIGN_BLENDER_HAIR
#define MESH                                                                                       \
    "bake it: blender -b --python scripts/blender_hair.py -- export FILE --mesh x.npz --frames "   \
    "scene (installed: /usr/share/tractrix/blender_hair.py)"
#define NO_STRANDS "it keeps no strands: export Alembic, USD or Wavefront lines"
#define LIGHTS     "--environment takes it as light"
#define UNPACK     "unpack it"
#define ALEMBIC    "export Alembic there"

static const ForeignFile FILES[] = {
    {"\x89HDF", "HDF5, as in old Alembic files (.abc)",
     "rewrite it: abcconvert -toOgawa FILE x.abc", "rewrite it: abcconvert -toOgawa FILE x.abc"},
    {"PXR-USDC", "binary USD (.usdc)", "convert it: usdcat FILE -o x.usda",
     "convert it: usdcat FILE -o x.usda"},
    {"BLENDER", "a Blender file (.blend)", HAIR, MESH},
    {"\x28\xb5\x2f\xfd", "compressed by zstd, as Blender files (.blend) are", HAIR, MESH},
    {"\x1f\x8b", "compressed by gzip, as old Blender files (.blend) may be", UNPACK ", or " HAIR,
     UNPACK ", or " MESH},
    {"BZh", "compressed by bzip2", UNPACK, UNPACK},
    {"\xfd"
     "7zXZ",
     "compressed by xz", UNPACK, UNPACK},
    {"7z\xbc\xaf", "a 7-Zip archive", UNPACK, UNPACK},
    {"//Maya ASCII", "a Maya scene (.ma)", ALEMBIC, ALEMBIC},
    {"FOR4", "a Maya scene (.mb)", ALEMBIC, ALEMBIC},
    {"FOR8", "a Maya scene (.mb)", ALEMBIC, ALEMBIC},
    {"Kaydara FBX", "FBX", NO_STRANDS, MESH},
    {"; FBX", "FBX", NO_STRANDS, MESH},
    {"glTF", "GLB", NO_STRANDS, MESH},
    {"\x7fNSJ", "a Houdini file (.bgeo)", "export .usda there", "export .usda there"},
    {"# vtk", "a VTK file", "write its lines as PLY or Wavefront lines", "save it as PLY"},
    {"#sdf ", "a file of Pixar's scene description before USD", "expected USD", "expected USD"},
    {"#!", "a script", "expected hair", "expected .obj or .ply"},
    {"%PDF", "a PDF file", "expected hair", "expected .obj or .ply"},
    {"solid ", "STL, a mesh", FOREIGN_WANTS_HAIR, "convert it to .obj or .ply"},
    {"OFF\n", "OFF, a mesh", FOREIGN_WANTS_HAIR, "convert it to .obj or .ply"},
    {"#?RADIANCE", "a Radiance image (.hdr)", LIGHTS, LIGHTS},
    {"#?RGBE", "a Radiance image (.hdr)", LIGHTS, LIGHTS},
    {"v/1\x01", "an EXR image", LIGHTS, LIGHTS},
    {"\x89PNG", "a PNG image", "expected hair", "expected .obj or .ply"},
    {"\xff\xd8\xff", "a JPEG image", "expected hair", "expected .obj or .ply"},
    {"GIF8", "a GIF image", "expected hair", "expected .obj or .ply"},
    {"8BPS", "a Photoshop image", "expected hair", "expected .obj or .ply"},
    {"RIFF", "a WebP image, a sound or a video (RIFF)", "expected hair", "expected .obj or .ply"},
};

const ForeignFile *foreign_find(const void *data, size_t size)
{
    for (size_t i = 0; i < sizeof FILES / sizeof *FILES; ++i) {
        size_t length = strlen(FILES[i].begin);
        if (size >= length && memcmp(data, FILES[i].begin, length) == 0) return &FILES[i];
    }
    return NULL;
}
