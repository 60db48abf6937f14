// SPDX-License-Identifier: MIT
#include "formats/strands_report.h"
#include "base/doubles.h"
#include "base/quote.h"

#include <stdlib.h>
#include <string.h>

// --- Measuring.

static int compare_counts(const void *a, const void *b)
{
    uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

static uint32_t hash_root(const float root[3])
{
    uint32_t bits[3];
    memcpy(bits, root, sizeof bits);
    uint32_t hash = bits[0] * 0x9e3779b1u ^ bits[1] * 0x85ebca77u ^ bits[2] * 0xc2b2ae3du;
    return (hash ^ (hash >> 15)) * 0x2c1b3c6du;
}

// Counts the strands whose root coincides with that of an earlier strand. `table` is a hash table
// of `mask` + 1 entries, which are strand numbers plus 1, or 0 if free; it must be all 0.
static uint32_t count_shared_roots(const Strands *strands, uint32_t *table, size_t mask)
{
    uint32_t shared = 0;
    for (uint32_t s = 0; s < strands->strand_count; s++) {
        const float *root = strands->position[strands->first[s]];
        size_t place = hash_root(root) & mask;
        for (; table[place]; place = (place + 1) & mask)
            if (memcmp(root, strands->position[strands->first[table[place] - 1]],
                       sizeof(float[3])) == 0)
                break;
        if (table[place])
            shared++;
        else
            table[place] = s + 1;
    }
    return shared;
}

static Result find_shared_roots(StrandsReport *report, const Strands *strands, Error *error)
{
    size_t places = 16;
    while (places < 2 * (size_t)strands->strand_count) places *= 2;
    uint32_t *table = calloc(places, sizeof *table);
    if (!table) return error_set(error, RESULT_FAILED, "no memory to compare roots");
    report->shared_roots = count_shared_roots(strands, table, places - 1);
    free(table);
    return RESULT_OK;
}

static void measure_each(StrandsReport *report, const Strands *strands, double *lengths,
                         uint32_t *sizes)
{
    uint32_t count = strands->strand_count;
    report->length_total = 0.0;
    for (uint32_t s = 0; s < count; s++) {
        lengths[s] = strands_length(strands, s);
        sizes[s] = strands_size(strands, s);
        report->length_total += lengths[s];
    }
    doubles_sort(lengths, count);
    qsort(sizes, count, sizeof *sizes, compare_counts);
    report->length_min = lengths[0];
    report->length_median = lengths[count / 2];
    report->length_max = lengths[count - 1];
    report->size_min = sizes[0];
    report->size_median = sizes[count / 2];
    report->size_max = sizes[count - 1];
}

Result strands_report_measure(StrandsReport *report, const Strands *strands, Error *error)
{
    report->strands = strands->strand_count;
    report->vertices = strands->vertex_count;
    report->features = strands_features(strands);
    report->opaque = strands_are_opaque(strands);
    strands_bounds(strands, report->low, report->high);
    for (int axis = 0; axis < 3; axis++) {
        report->low[axis] = (float)(report->low[axis] + strands->origin[axis]);
        report->high[axis] = (float)(report->high[axis] + strands->origin[axis]);
    }
    if (strands->strand_count == 0) return RESULT_OK;
    double *lengths = malloc(strands->strand_count * sizeof *lengths);
    uint32_t *sizes = malloc(strands->strand_count * sizeof *sizes);
    if (lengths && sizes) measure_each(report, strands, lengths, sizes);
    Result result = lengths && sizes
                        ? find_shared_roots(report, strands, error)
                        : error_set(error, RESULT_FAILED, "no memory to measure %u strands",
                                    strands->strand_count);
    free(lengths);
    free(sizes);
    return result;
}

// --- Printing.

bool strands_report_is_clean(const StrandsReport *report)
{
    for (int kind = 0; kind < DEFECT_KINDS; kind++)
        if (report->defects[kind].count) return false;
    return report->flaws == 0;
}

void strands_report_describe(const StrandsReport *report, const char *path, DefectKind kind,
                             bool mended, char *text, size_t size)
{
    static const struct {
        const char *one, *many, *cure;
    } words[DEFECT_KINDS] = {
        [DEFECT_NOT_FINITE] = {"strand with a coordinate that is NaN, infinite or beyond 1000 km",
                               "strands with a coordinate that is NaN, infinite or beyond 1000 km",
                               "dropped"},
        [DEFECT_TOO_SHORT] = {"strand of fewer than two distinct vertices",
                              "strands of fewer than two distinct vertices", "dropped"},
        [DEFECT_COINCIDENT] = {"vertex that coincides with the one before it",
                               "vertices that coincide with the one before them", "merged"},
        [DEFECT_ATTRIBUTE] = {"attribute value that is not a finite number",
                              "attribute values that are not finite numbers", "replaced"},
        [DEFECT_OVER_LIMIT] = {"strand of more than maxNumVerticesInStrand vertices",
                               "strands of more than maxNumVerticesInStrand vertices",
                               "kept whole"},
        [DEFECT_PADDING] =
            {"strand that jumps from its tip to the origin, as padding with zeros does",
             "strands that jump from their tip to the origin, as padding with zeros "
             "does",
             "cut off at the tip"},
        [DEFECT_UNREAD] = {"byte after all known arrays", "bytes after all known arrays",
                           "not read"},
    };
    const Defect *defect = &report->defects[kind];
    snprintf(text, size,
             FORMAT_TABLE[report->kind]->text ? "%s:%llu: %s%u %s%s%s"
                                              : "%s: byte %llu: %s%u %s%s%s",
             path, (unsigned long long)defect->first_place, defect->count > 1 ? "first of " : "",
             defect->count, defect->count == 1 ? words[kind].one : words[kind].many,
             mended ? ": " : "", mended ? words[kind].cure : "");
}

uint32_t strands_report_print_mended(const StrandsReport *report, const char *path, FILE *stream)
{
    uint32_t lines = 0;
    for (int kind = 0; kind < DEFECT_KINDS; kind++) {
        if (report->defects[kind].count == 0) continue;
        char text[1024];
        strands_report_describe(report, path, (DefectKind)kind, true, text, sizeof text);
        fprintf(stream, "%s\n", quote(text).text);
        lines++;
    }
    if (*report->note) {
        fprintf(stream, "%s: %s\n", quote(path).text, quote(report->note).text);
        lines++;
    }
    const FormatContents *contents = &report->contents;
    if (contents->unread_count) {
        fprintf(stream, "%s: %u attribute%s of curves not read: %s\n", quote(path).text,
                contents->unread_count, contents->unread_count == 1 ? "" : "s",
                quote(contents->unread).text);
        lines++;
    }
    if (report->samples > 1 && !report->all_samples) {
        fprintf(stream, "%s: only the first of %u time samples is read\n", quote(path).text,
                report->samples);
        lines++;
    }
    return lines;
}

// Which guesses the printed line mentions: those of the unit and of the up axis.
static void find_guesses(const StrandsReport *report, bool *unit, bool *up)
{
    bool changes = report->unit_guessed && report->unit_used != 1.0f;
    changes = changes || (report->up_guessed && report->up_z);
    *unit = report->unit_guessed && changes;
    *up = report->up_guessed && changes && (*unit || report->up_z);
}

void strands_report_print_guess(const StrandsReport *report, const char *path, FILE *stream)
{
    bool unit, up;
    find_guesses(report, &unit, &up);
    if (!unit && !up) return;
    fprintf(stream, "%s: guessed ", quote(path).text);
    if (unit) fprintf(stream, "a unit of %g m", (double)report->unit_used);
    fprintf(stream, "%s", unit && up ? " and " : "");
    if (up) fprintf(stream, "%c up", report->up_z ? 'z' : 'y');
    fprintf(stream, ": set %s%s%s if this is wrong\n", unit ? "--unit" : "",
            unit && up ? " and " : "", up ? "--up" : "");
}

bool strands_report_same_guess(const StrandsReport *a, const StrandsReport *b)
{
    bool unit[2], up[2];
    find_guesses(a, &unit[0], &up[0]);
    find_guesses(b, &unit[1], &up[1]);
    return unit[0] == unit[1] && up[0] == up[1] && (!unit[0] || a->unit_used == b->unit_used) &&
           (!up[0] || a->up_z == b->up_z);
}

static void print_unit(const StrandsReport *report, FILE *stream)
{
    const Format *format = FORMAT_TABLE[report->kind];
    fprintf(stream, "  unit      %.6g m", (double)report->unit_used);
    if (!report->unit_guessed)
        fprintf(stream, " as given\n");
    else if (format->centimetres && report->unit_used != 1.0f)
        fprintf(stream,
                ", a guess: TressFX 2 assets are in centimetres (set --unit if it is wrong)\n");
    else
        fprintf(stream, ", a guess by the size (set --unit if it is wrong)\n");
    fprintf(stream, "  up        %c%s\n", report->up_z ? 'z' : 'y',
            report->up_guessed ? ", as usual in this format (set --up if it is wrong)"
                               : " as given");
}

static void print_notes(const StrandsReport *report, FILE *stream)
{
    if (*report->note) fprintf(stream, "  note      %s\n", quote(report->note).text);
    if (report->samples)
        fprintf(stream, "  times     %s%u\n", report->all_samples ? "" : "the first of ",
                report->samples);
    if (report->shuffled) fprintf(stream, "  order     shuffled, the file says 'is sorted 0'\n");
    if (report->rotation_was_deg)
        fprintf(stream, "  rotation  taken to be in degrees: a value is beyond 2 pi\n");
    if (report->empty_roots)
        fprintf(stream, "  left out  %u roots without hair\n", report->empty_roots);
    if (report->shared_roots)
        fprintf(stream, "  roots     %u strands begin exactly where an earlier one does\n",
                report->shared_roots);
}

void strands_report_print_contents(const StrandsReport *report, FILE *stream)
{
    const FormatContents *contents = &report->contents;
    uint32_t listed = contents->count < FORMAT_OBJECTS ? contents->count : FORMAT_OBJECTS;
    if (contents->unread_count)
        fprintf(stream, "  not read  %u attribute%s: %s\n", contents->unread_count,
                contents->unread_count == 1 ? "" : "s", quote(contents->unread).text);
    if (contents->count < 2 && !contents->left_out) return;
    for (uint32_t i = 0; i < listed; i++) {
        const FormatObject *object = &contents->object[i];
        fprintf(stream, "  object    %s: ", quote(object->path).text);
        if (object->why)
            fprintf(stream, "left out: %s\n", object->why);
        else
            fprintf(stream, "%u strand%s\n", object->strands, object->strands == 1 ? "" : "s");
    }
    if (contents->count > listed)
        fprintf(stream, "  objects   %u more, %u of all left out\n", contents->count - listed,
                contents->left_out);
}

void strands_report_print(const StrandsReport *report, const char *path, FILE *stream)
{
    char carried[256];
    fprintf(stream, "%s: %s", quote(path).text, FORMAT_TABLE[report->kind]->name);
    if (report->version > 0.0f) fprintf(stream, ", version %g", (double)report->version);
    fprintf(stream, "\n  strands   %u usable of %u\n", report->strands, report->declared_strands);
    fprintf(stream, "  vertices  %u usable of %u; per strand %u min, %u median, %u max\n",
            report->vertices, report->declared_vertices, report->size_min, report->size_median,
            report->size_max);
    fprintf(stream, "  length    %.6g m min, %.6g m median, %.6g m max\n", report->length_min,
            report->length_median, report->length_max);
    for (int axis = 0; axis < 3; axis++)
        fprintf(stream, "  %-8s  %c %.6g .. %.6g m\n", axis ? "" : "bounds", "xyz"[axis],
                (double)report -> low[axis], (double)report -> high[axis]);
    print_unit(report, stream);
    strands_features_describe(report->features, carried, sizeof carried);
    fprintf(stream, "  carries   %s%s\n", *carried ? carried : "positions only",
            report->opaque ? "" : ", opacities");
    print_notes(report, stream);
    strands_report_print_contents(report, stream);
    if (strands_report_is_clean(report)) fprintf(stream, "  defects   none\n");
    for (int kind = 0; kind < DEFECT_KINDS; kind++) {
        if (report->defects[kind].count == 0) continue;
        char text[1024];
        strands_report_describe(report, path, (DefectKind)kind, true, text, sizeof text);
        fprintf(stream, "  defect    %s\n", quote(text).text);
    }
}
