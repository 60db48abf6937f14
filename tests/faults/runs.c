// SPDX-License-Identifier: MIT
#include "faults/runs.h"

#include <stdio.h>
#include <string.h>

const Run RUN_PREPARED[] = {
    {.program = "gen", .arguments = "--kind fur --count 20 --vertices 6 -q -o fur.tfx"},
    {.program = "gen", .arguments = "--kind curls --count 6 -q -o curls.tfx --mesh head.obj"},
    {.program = "render", .arguments = "fur.tfx --size 32x24 --look plain --algo none -q -o a.png"},
    {.program = "render",
     .arguments = "curls.tfx --size 32x24 --look plain --algo none -q -o b.png"},
    {.program = "render",
     .arguments = "fur.tfx --frames 4 --size 32x24 --look plain -q --cache move.cache"},
    {0},
};

#define SMALL "../../in/fur.tfx --size 32x24 --look plain -q "
#define LARGE "../../in/fur.tfx --size 64x48 --look plain -q --frames 24 "

const Run RUNS[] = {
    {.program = "gen",
     .name = "hair and mesh",
     .short_faults = 12,
     .arguments = "--kind fur --count 9 -q -o hair.tfx --mesh ball.obj"},
    {.program = "gen",
     .name = "fur on a mesh",
     .short_faults = 10,
     .arguments = "fur ../../in/head.obj --count 40 -q -o fur.tfx"},
    {.program = "convert",
     .name = "HAIR",
     .short_faults = 25,
     .arguments = "../../in/fur.tfx --resample 5 -q -o out.hair"},
    {.program = "convert",
     .name = "USD, figures",
     .short_faults = 30,
     .arguments = "../../in/fur.tfx ../../in/curls.tfx --subsample 50% --stats -q -o out.usda "
                  "--json out.json"},
    {.program = "convert",
     .name = "numpy",
     .short_faults = 15,
     .arguments = "../../in/fur.tfx -q -o out.npz"},
    {.program = "convert",
     .name = "cache to OBJ",
     .short_faults = 12,
     .arguments = "../../in/move.cache -q -o out_%d.obj"},
    {.program = "convert",
     .name = "cache to USD",
     .short_faults = 12,
     .arguments = "../../in/move.cache -q -o out.usda"},
    {.program = "compare",
     .name = "reports",
     .measured = "out.xml out.json out.html",
     .short_faults = 40,
     .status = 1,
     .arguments =
         "../../in/a.png ../../in/b.png -q --heatmap heat.png --sheet sheet.png --json out.json "
         "--junit out.xml --html out.html"},
    {.program = "render",
     .name = "PNG frames",
     .short_faults = 10,
     .arguments = SMALL "--frames 2 -o f_%d.png"},
    {.program = "render",
     .name = "video",
     .short_faults = 4,
     .arguments = SMALL "--frames 2 -o v.gif"},
    {.program = "render",
     .name = "y4m, USD",
     .short_faults = 4,
     .arguments = SMALL "--frames 2 -o v.y4m --export e.usda"},
    {.program = "render",
     .name = "cache, export, statistics",
     .short_faults = 8,
     .grows = true,
     .measured = "s.json",
     .arguments = SMALL "--frames 3 --cache c.cache --resume --export e_%d.hair --stats s.json"},
    {.program = "render",
     .name = "cache to EXR",
     .measured = "f_0.exr f_1.exr", // they name the processor, which a run may fail to find out
     .short_faults = 4,
     .arguments = SMALL "--frames 2 --from-cache ../../in/move.cache -o f_%d.exr"},
    {.program = "render",
     .name = "sheet, files of frames",
     .short_faults = 4,
     .arguments =
         SMALL "--frames 4 --contact-sheet 2x2 --caption frame,solver -o s.png --export e_%d.tfx "
               "--export-followers --followers 2"},
    {.program = "render",
     .name = "studio, head, quads",
     .short_faults = 3,
     .arguments = "../../in/curls.tfx --size 32x24 -q --mesh ../../in/head.obj --collide-mesh "
                  "--raster quads --scatter-cells 8 --shadow-size 64 -o f.png"},
    {.program = "render",
     .name = "studio, a wide groom",
     .short_faults = 3,
     .arguments = "../../in/curls.tfx --size 32x24 -q --volume 1 --algo split --scatter-cells 8 "
                  "-o f.pfm"},
    {.program = "bench",
     .name = "accuracy",
     .short_faults = 4,
     .measured = "out.csv out.json out.html",
     .arguments = "accuracy --part scale --reference ../../root/tests/data/motion --csv out.csv "
                  "--json out.json --html out.html"},
    {0},
};

const Run RUN_KILLED[] = {
    {.program = "render", .name = "PNG frames", .arguments = LARGE "-o f_%02d.png"},
    {.program = "render", .name = "video", .one_piece = true, .arguments = LARGE "-o v.mp4"},
    {.program = "render", .name = "cache", .grows = true, .arguments = LARGE "--cache c.cache"},
    {.program = "render", .name = "export", .arguments = LARGE "--resume --export e_%02d.tfx"},
    {0},
};

void run_words(const Run *run, char text[1000], char *words[RUN_WORDS])
{
    int count = 0;
    snprintf(text, 1000, "tractrix-%s %s", run->program, run->arguments);
    for (char *rest = text, *word; (word = strsep(&rest, " ")) && count < RUN_WORDS - 2;)
        if (*word) words[count++] = word;
    words[count] = NULL;
}
