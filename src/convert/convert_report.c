// SPDX-License-Identifier: MIT
#include "convert/convert_report.h"

#include "base/json.h"
#include "strands/strands.h"

// --- Text.

static void print_frames(const ConvertInput *input, FILE *stream)
{
    int count = convert_input_count(input);
    fprintf(stream, "  frames    %d, %d to %d", count, input->first, input->last);
    if (input->every > 1) fprintf(stream, " by %d", input->every);
    fprintf(stream, ", %g a second\n", input->fps);
}

void convert_print_input(const ConvertInput *input, FILE *stream)
{
    const Strands *layout = &input->cache.layout;
    if (input->cached) {
        fprintf(stream, "%s: a cache\n  strands   %u of %u section%s\n  vertices  %u\n",
                input->paths[0], layout->strand_count, input->cache.section_count,
                input->cache.section_count == 1 ? "" : "s", layout->vertex_count);
    }
    for (int i = 0; i < input->path_count && !input->cached; ++i)
        strands_report_print(&input->reports[i], input->paths[i], stream);
    if (convert_input_moves(input)) print_frames(input, stream);
}

// Few rows for many sizes: equal ranges, of whole numbers.
static void print_sizes(const StrandsFigures *figures, FILE *stream)
{
    enum { MOST_ROWS = 12, WIDEST = 40 };
    uint32_t low = figures->sizes[0].size, high = figures->sizes[figures->size_count - 1].size;
    uint32_t step = figures->size_count <= MOST_ROWS ? 1 : (high - low) / MOST_ROWS + 1;
    fprintf(stream, "\nvertices      strands\n");
    for (uint32_t i = 0; i < figures->size_count;) {
        uint32_t from =
            step == 1 ? figures->sizes[i].size : low + (figures->sizes[i].size - low) / step * step;
        uint32_t to = from + step - 1 < high ? from + step - 1 : high, strands = 0;
        for (; i < figures->size_count && figures->sizes[i].size <= to; ++i)
            strands += figures->sizes[i].strands;
        int bar = (int)((double)WIDEST * strands / figures->strands + 0.5);
        char range[32];
        snprintf(range, sizeof range, from == to ? "%u" : "%u-%u", from, to);
        fprintf(stream, "%-11s %9u %.*s\n", range, strands, bar,
                "########################################");
    }
}

void convert_print_figures(const StrandsFigures *figures, FILE *stream)
{
    fprintf(stream, "%u strands, %u vertices, %.6g m of hair\n", figures->strands,
            figures->vertices, figures->total_length);
    for (int axis = 0; axis < 3; ++axis)
        fprintf(stream, "%c  %.6g .. %.6g m\n", "xyz"[axis], (double)figures -> low[axis],
                (double)figures -> high[axis]);
    fprintf(stream, "\n%-18s %11s %11s %11s %11s %11s %11s\n", "", "min", "5 %", "median", "95 %",
            "max", "mean");
    for (int kind = 0; kind < FIGURE_KINDS; ++kind) {
        const Figure *f = &figures->figures[kind];
        char name[64];
        snprintf(name, sizeof name, "%s%s%s", figure_name((FigureKind)kind),
                 *figure_unit((FigureKind)kind) ? ", " : "", figure_unit((FigureKind)kind));
        fprintf(stream, "%-18s %11.5g %11.5g %11.5g %11.5g %11.5g %11.5g\n", name, f->min, f->low,
                f->median, f->high, f->max, f->mean);
    }
    if (figures->size_count) print_sizes(figures, stream);
}

// --- JSON.

static json_t *vector_to_json(const float vector[3])
{
    return json_pack("[fff]", (double)vector[0], (double)vector[1], (double)vector[2]);
}

static json_t *defects_to_json(const StrandsReport *report, const char *path)
{
    static const char *const names[DEFECT_KINDS] = {"not_finite", "too_short",  "coincident",
                                                    "attribute",  "over_limit", "unread"};
    json_t *list = json_array();
    for (int kind = 0; kind < DEFECT_KINDS; ++kind) {
        const Defect *defect = &report->defects[kind];
        char text[1024];
        if (!defect->count) continue;
        strands_report_describe(report, path, (DefectKind)kind, true, text, sizeof text);
        json_array_append_new(list, json_pack("{ss si sI ss}", "kind", names[kind], "count",
                                              defect->count, "first_place",
                                              (json_int_t)defect->first_place, "text", text));
    }
    return list;
}

static json_t *report_to_json(const StrandsReport *report, const char *path)
{
    return json_pack("{ss ss sf si si si si sf sb sb si si so}", "file", path, "kind",
                     FORMAT_TABLE[report->kind]->name, "version", (double)report->version,
                     "declared_strands", report->declared_strands, "declared_vertices",
                     report->declared_vertices, "strands", report->strands, "vertices",
                     report->vertices, "unit_m", (double)report->unit_used, "unit_guessed",
                     report->unit_guessed, "shuffled", report->shuffled, "empty_roots",
                     report->empty_roots, "shared_roots", report->shared_roots, "defects",
                     defects_to_json(report, path));
}

static json_t *input_to_json(const ConvertInput *input)
{
    json_t *list = json_array();
    if (input->cached)
        json_array_append_new(list, json_pack("{ss ss si}", "file", input->paths[0], "kind",
                                              "cache", "sections", input->cache.section_count));
    for (int i = 0; i < input->path_count && !input->cached; ++i)
        json_array_append_new(list, report_to_json(&input->reports[i], input->paths[i]));
    return list;
}

static json_t *figures_to_json(const StrandsFigures *figures)
{
    json_t *object =
        json_pack("{si si sf so so}", "strands", figures->strands, "vertices", figures->vertices,
                  "total_length_m", figures->total_length, "low_m", vector_to_json(figures->low),
                  "high_m", vector_to_json(figures->high));
    for (int kind = 0; kind < FIGURE_KINDS; ++kind) {
        const Figure *f = &figures->figures[kind];
        json_object_set_new(object, figure_name((FigureKind)kind),
                            json_pack("{ss sI sf sf sf sf sf sf}", "unit",
                                      figure_unit((FigureKind)kind), "count", (json_int_t)f->count,
                                      "min", f->min, "p5", f->low, "median", f->median, "p95",
                                      f->high, "max", f->max, "mean", f->mean));
    }
    json_t *sizes = json_array();
    for (uint32_t i = 0; i < figures->size_count; ++i)
        json_array_append_new(sizes, json_pack("{si si}", "vertices", figures->sizes[i].size,
                                               "strands", figures->sizes[i].strands));
    json_object_set_new(object, "sizes", sizes);
    return object;
}

static json_t *output_to_json(const ConvertOutput *output)
{
    char lost[300];
    strands_features_describe(output->lost, lost, sizeof lost);
    return json_pack("{ss ss si ss}", "file", output->path, "kind",
                     FORMAT_TABLE[output->kind]->name, "files", output->files, "left_out", lost);
}

Result convert_write_json(const char *path, const ConvertInput *input,
                          const StrandsFigures *figures, const ConvertOutput *output, Error *error)
{
    json_t *root =
        json_pack("{so so}", "input", input_to_json(input), "hair", figures_to_json(figures));
    if (convert_input_moves(input))
        json_object_set_new(root, "frames",
                            json_pack("{si si si sf}", "first", input->first, "last", input->last,
                                      "every", input->every, "fps", input->fps));
    if (output) json_object_set_new(root, "output", output_to_json(output));
    Result result = json_write_file(root, path, error);
    json_decref(root);
    return result;
}
