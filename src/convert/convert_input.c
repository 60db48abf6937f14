// SPDX-License-Identifier: MIT
#include "convert/convert_input.h"

#include "base/json.h"
#include "base/quote.h"
#include "base/reader.h"
#include "strands/strands.h"
#include "strands/strands_edit.h"

#include <jansson.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { USUAL_FPS = 60 };

// --- Caches.

static Result refuse_cache(const CacheStrands *strands, const char *what, Error *error)
{
    return error_set(error, RESULT_BAD_INPUT, "%s: %s", strands->cache.file.path, what);
}

static Result read_fps(CacheStrands *strands, Error *error)
{
    const Bytes *text = &strands->cache.scene;
    json_t *scene = json_read((const char *)text->data, text->size, 0, NULL);
    if (!scene && json_memory_short())
        return error_set(error, RESULT_FAILED, "%s: no memory for its scene",
                         strands->cache.file.path);
    strands->fps = json_number_value(json_object_get(scene, "fps"));
    strands->number = (int)json_integer_value(json_object_get(scene, "frame_number"));
    json_decref(scene);
    return strands->fps > 0 ? RESULT_OK : refuse_cache(strands, "its scene has no fps", error);
}

// --- The hair in a cache. For each section: runs of strands with equal vertex counts, then the
// strands' numbers in the hair file, in the order of the runs. count_all checks and counts them,
// place_all stores them.

typedef struct Counts {
    uint64_t strands, vertices;
    bool good;
} Counts;

static void count_section(Reader *reader, Counts *counts)
{
    uint32_t strands = reader_read_u32(reader, "strands"), in_runs = 0;
    reader_read_u32(reader, "a checksum");
    uint32_t runs = reader_read_u32(reader, "runs");
    for (uint32_t i = 0; i < runs && reader_ok(reader); ++i) {
        uint32_t size = reader_read_u32(reader, "vertices"), count = reader_read_u32(reader, "");
        counts->vertices += (uint64_t)size * count;
        counts->good = counts->good && size >= 2 && count <= strands - in_runs;
        in_runs += count;
    }
    counts->strands += strands;
    counts->good = counts->good && in_runs == strands &&
                   reader_check_array(reader, reader->at, strands, 4, "numbers");
    if (counts->good) reader->at += 4 * (size_t)strands;
}

static Counts count_all(const Bytes *hair, uint32_t *sections)
{
    Reader reader = reader_begin_binary("", hair, NULL);
    Counts counts = {.good = true};
    *sections = reader_read_u32(&reader, "sections");
    for (uint32_t i = 0; i < *sections && counts.good && reader_ok(&reader); ++i)
        count_section(&reader, &counts);
    counts.good = counts.good && reader_ok(&reader) && reader_left(&reader) == 0 &&
                  counts.strands > 0 && counts.strands < UINT32_MAX && counts.vertices < UINT32_MAX;
    return counts;
}

// Stores the strands of one section, which begin at *first_strand, and moves *first_strand behind
// them. sizes[s + 1] gets the vertex count of strand s; it is 0 for strands that have not been seen
// yet. False if a strand occurs twice.
static bool place_section(CacheStrands *to, Reader *reader, uint32_t section,
                          uint32_t *first_strand, uint32_t *sizes)
{
    uint32_t strands = reader_read_u32(reader, ""), place = *first_strand;
    reader_read_u32(reader, "");
    uint32_t runs = reader_read_u32(reader, "");
    size_t numbers_at = reader->at + 8 * (size_t)runs;
    for (uint32_t i = 0; i < runs; ++i) {
        uint32_t size = reader_read_u32(reader, ""), count = reader_read_u32(reader, "");
        Reader numbers = *reader;
        numbers.at = numbers_at + 4 * (size_t)(place - *first_strand);
        for (uint32_t k = 0; k < count; ++k, ++place) {
            uint32_t number = reader_read_u32(&numbers, "");
            if (number >= strands || sizes[*first_strand + number + 1]) return false;
            to->order[place] = *first_strand + number;
            to->section[place] = section;
            sizes[*first_strand + number + 1] = size;
        }
    }
    reader->at = numbers_at + 4 * (size_t)strands;
    *first_strand += strands;
    return true;
}

static Result place_all(CacheStrands *strands, Error *error)
{
    Reader reader = reader_begin_binary("", &strands->cache.hair, NULL);
    uint32_t *first = strands->layout.first, strand = 0;
    reader_read_u32(&reader, "");
    for (uint32_t i = 0; i < strands->section_count; ++i)
        if (!place_section(strands, &reader, i, &strand, first))
            return refuse_cache(strands, "its hair has a strand twice", error);
    for (uint32_t s = 0; s < strands->layout.strand_count; ++s) first[s + 1] += first[s];
    return RESULT_OK;
}

// Frames are compressed, so the file's size does not limit the number of vertices. This check keeps
// a small damaged file from allocating all memory.
static bool is_too_much(const CacheStrands *strands, const Counts *counts)
{
    enum { FACTOR = 64, SURE_BYTES = 64 << 20, VERTEX_BYTES = 36 }; // layout and two frames
    return counts->vertices * VERTEX_BYTES > FACTOR * strands->cache.file.size + SURE_BYTES;
}

static Result read_hair(CacheStrands *strands, Error *error)
{
    Counts counts = count_all(&strands->cache.hair, &strands->section_count);
    if (!counts.good)
        return refuse_cache(strands, "its hair does not have the layout of docs/cache.md", error);
    if (is_too_much(strands, &counts))
        return refuse_cache(strands, "its hair has more vertices than a file of its size can hold",
                            error);
    TRY(strands_create(&strands->layout, (uint32_t)counts.strands, (uint32_t)counts.vertices,
                       error));
    strands->order = malloc(counts.strands * sizeof *strands->order);
    strands->section = malloc(counts.strands * sizeof *strands->section);
    strands->positions = malloc(counts.vertices * sizeof *strands->positions);
    if (strands->order && strands->section && strands->positions) return place_all(strands, error);
    return error_set(error, RESULT_FAILED, "%s: no memory for a frame", strands->cache.file.path);
}

static void close_cache(CacheStrands *strands)
{
    cache_file_close(&strands->cache);
    strands_destroy(&strands->layout);
    free(strands->order);
    free(strands->section);
    free(strands->positions);
    *strands = (CacheStrands){0};
}

static Result open_cache(CacheStrands *strands, const char *path, Error *error)
{
    *strands = (CacheStrands){0};
    Result result = cache_file_open(&strands->cache, path, error);
    THEN(result, read_fps(strands, error));
    THEN(result, read_hair(strands, error));
    if (result != RESULT_OK) close_cache(strands);
    return result;
}

static Result read_cache(CacheStrands *strands, int frame, Strands *read, Error *error)
{
    const Strands *layout = &strands->layout;
    float head[CACHE_HEAD_FLOATS], (*at)[3] = strands->positions;
    *read = (Strands){0};
    Result result = cache_file_read(&strands->cache, frame, head, at, layout->vertex_count, error);
    THEN(result, strands_create(read, layout->strand_count, layout->vertex_count, error));
    if (result != RESULT_OK) return result;
    memcpy(read->first, layout->first, ((size_t)layout->strand_count + 1) * sizeof *read->first);
    for (uint32_t i = 0; i < layout->strand_count; ++i) {
        uint32_t s = strands->order[i], size = strands_size(layout, s);
        memcpy(read->position[layout->first[s]], at, size * sizeof *at);
        at += size;
    }
    if (strands->section_count < 2) return RESULT_OK;
    read->strand_group = malloc(((size_t)layout->strand_count + 1) * sizeof *read->strand_group);
    if (!read->strand_group) return error_set(error, RESULT_FAILED, "no memory for the sections");
    for (uint32_t s = 0; s < layout->strand_count; ++s)
        read->strand_group[s] = (float)strands->section[s];
    return RESULT_OK;
}

// --- Frames.

static bool frame_is_there(const ConvertInput *input, int frame)
{
    char *name = target_name_frame(&input->pattern, frame);
    bool there = name && access(name, F_OK) == 0;
    free(name);
    return there;
}

// The last frame before the first missing file, or the last frame of a cache or of a file with
// frames.
static int find_last(const ConvertInput *input)
{
    int last = input->first;
    if (input->cached) return input->cache.number + (int)input->cache.cache.frame_count - 1;
    if (input->framed) return input->frames.first + (int)input->frames.count - 1;
    while (frame_is_there(input, last)) ++last;
    return last - 1;
}

// Checks that the file has the frames --first and --last.
static Result check_framed(const ConvertInput *input, Error *error)
{
    int first = input->frames.first, last = find_last(input);
    if (input->first >= first && input->last <= last && input->first <= input->last)
        return RESULT_OK;
    return error_set(
        error, RESULT_BAD_INPUT, "%s: no frame %d: the file has frames %d to %d", input->paths[0],
        input->first < first || input->first > last ? input->first : input->last, first, last);
}

// Fails if frames are missing: the cache is unfinished, or numbered files continue after a gap.
static Result check_whole(const ConvertInput *input, Error *error)
{
    const CacheFile *cache = &input->cache.cache;
    int last = input->numbered ? target_find_numbers(&input->pattern).last : -1;
    if (input->cached && !cache->finished)
        return error_set(error, RESULT_FAILED,
                         "%s: unfinished or cut off after %u complete frames: expected a complete "
                         "cache, --partial or --last N",
                         input->paths[0], cache->frame_count);
    if (last > input->last && input->last >= input->first)
        return error_set(error, RESULT_FAILED,
                         "%s: no file for frame %d, but one for frame %d: expected files for all "
                         "frames, --partial or --last N",
                         input->paths[0], input->last + 1, last);
    return RESULT_OK;
}

static Result choose_frames(ConvertInput *input, Error *error)
{
    bool whole = input->whole && input->last < 0;
    bool cut = input->first > 0 || input->last >= 0 || input->every > 1;
    if (!convert_input_moves(input)) {
        input->first = input->last = 0;
        if (cut || input->fps > 0)
            return error_set(error, RESULT_USAGE,
                             "--first, --last, --every and --fps have no effect: expected a cache "
                             "or numbered files (x_%%04d.tfx)");
        return RESULT_OK;
    }
    double own = input->cached ? input->cache.fps : input->frames.fps;
    if (input->fps <= 0) input->fps = own > 0 ? own : USUAL_FPS;
    int own_first = input->framed ? input->frames.first : input->cached ? input->cache.number : 0;
    if (input->first == 0) input->first = own_first;
    if (input->last < 0) input->last = find_last(input);
    if (whole) TRY(check_whole(input, error));
    if (input->framed) return check_framed(input, error);
    int last = input->last >= input->first ? input->last : input->first;
    if (input->cached)
        return cache_file_check(&input->cache.cache, last - input->cache.number, error);
    if (input->last >= input->first) return RESULT_OK;
    return error_set(error, RESULT_BAD_INPUT, "%s: no file for frame %d", input->paths[0],
                     input->first);
}

// --- Reading a file.

static void report_mended(const ConvertInput *input, const StrandsReport *report, int file,
                          const char *path)
{
    if (!input->messages) return;
    strands_report_print_mended(report, path, input->messages);
    if (input->says_guess && input->reports[file].strands == 0)
        strands_report_print_guess(report, path, input->messages);
    if (report->shuffled)
        fprintf(input->messages, "%s: strands are shuffled: the file says 'is sorted 0'\n",
                quote(path).text);
}

// `frames`: NULL to read the first frame only.
static Result read_file(ConvertInput *input, const char *path, int file, Strands *strands,
                        StrandsFrames *frames, Error *error)
{
    StrandsReport report;
    StrandsReadOptions options = input->options;
    if (options.recenters && input->centred) {
        options.recenters = false;
        options.origin = input->origin;
    }
    TRY(strands_read_frames(strands, frames, path, &options, &report, error));
    if (!input->centred) memcpy(input->origin, strands->origin, sizeof input->origin);
    input->centred = true;
    report_mended(input, &report, file, path);
    input->features |= strands_features(strands);
    if (input->reports[file].strands == 0) input->reports[file] = report;
    return RESULT_OK;
}

// A single file may have frames.
static Result open_single(ConvertInput *input, Error *error)
{
    if (input->path_count > 1 || input->cached || input->numbered) return RESULT_OK;
    TRY(read_file(input, input->paths[0], 0, &input->still,
                  input->wants_frames ? &input->frames : NULL, error));
    input->framed = input->frames.count > 0;
    return RESULT_OK;
}

// --- Opening.

Result convert_input_open(ConvertInput *input, Error *error)
{
    Result result = RESULT_OK;
    for (int i = 0; i < input->path_count; ++i) {
        bool cached;
        TRY(cache_file_matches(input->paths[i], &cached, error));
        bool numbered = !cached && strchr(input->paths[i], '%') && access(input->paths[i], F_OK);
        input->cached = input->cached || cached;
        input->numbered = input->numbered || numbered;
        if ((cached || numbered) && input->path_count > 1)
            return error_set(
                error, RESULT_USAGE,
                "%s: has several frames and cannot be joined with other files: expected one input",
                input->paths[i]);
    }
    input->reports = calloc((size_t)input->path_count + 1, sizeof *input->reports);
    if (!input->reports) return error_set(error, RESULT_FAILED, "no memory for reports");
    if (input->cached) result = open_cache(&input->cache, input->paths[0], error);
    if (input->numbered) result = format_target(&input->pattern, input->paths[0], error);
    THEN(result, open_single(input, error));
    return result == RESULT_OK ? choose_frames(input, error) : result;
}

void convert_input_close(ConvertInput *input)
{
    close_cache(&input->cache);
    strands_destroy(&input->still);
    strands_frames_destroy(&input->frames);
    target_destroy(&input->pattern);
    free(input->reports);
    *input = (ConvertInput){0};
}

// --- Reading.

// The unit and the up axis that were guessed for the first frame are used for all later ones.
static Result read_numbered(ConvertInput *input, int frame, Strands *strands, Error *error)
{
    char *name = target_name_frame(&input->pattern, frame);
    if (!name) return error_set(error, RESULT_FAILED, "no memory for a name");
    Result result = read_file(input, name, 0, strands, NULL, error);
    if (result == RESULT_OK) {
        input->options.unit = input->reports[0].unit_used;
        input->options.up = input->reports[0].up_z ? UP_Z : UP_Y;
    }
    free(name);
    return result;
}

// A frame of a single file: a copy of `still` with the positions of the frame.
static Result read_framed(const ConvertInput *input, int frame, Strands *strands, Error *error)
{
    size_t count = input->still.vertex_count;
    TRY(strands_join(strands, &input->still, 1, error));
    memcpy(strands->position, input->frames.position + (frame - input->frames.first) * count,
           count * sizeof *strands->position);
    return RESULT_OK;
}

static Result read_files(ConvertInput *input, Strands *strands, Error *error)
{
    if (input->path_count == 1) {
        *strands = input->still;
        input->still = (Strands){0};
        return RESULT_OK;
    }
    Strands *sets = calloc((size_t)input->path_count, sizeof *sets);
    Result result =
        sets ? RESULT_OK
             : error_set(error, RESULT_FAILED, "no memory for %d files", input->path_count);
    for (int i = 0; i < input->path_count && result == RESULT_OK; ++i)
        result = read_file(input, input->paths[i], i, &sets[i], NULL, error);
    THEN(result, strands_join(strands, sets, (uint32_t)input->path_count, error));
    THEN(result, strands_group_sets(strands, sets, (uint32_t)input->path_count, true, error));
    for (int i = 0; sets && i < input->path_count; ++i) strands_destroy(&sets[i]);
    free(sets);
    return result;
}

Result convert_input_read(ConvertInput *input, int frame, Strands *strands, Error *error)
{
    *strands = (Strands){0};
    if (input->cached)
        return read_cache(&input->cache, frame - input->cache.number, strands, error);
    if (input->numbered) return read_numbered(input, frame, strands, error);
    if (input->framed) return read_framed(input, frame, strands, error);
    return read_files(input, strands, error);
}

// --- Text and JSON.

static void print_frames(const ConvertInput *input, FILE *stream)
{
    int count = convert_input_count(input);
    fprintf(stream, "  frames    %d, %d to %d", count, input->first, input->last);
    if (input->every > 1) fprintf(stream, " by %d", input->every);
    fprintf(stream, ", %g a second%s\n", input->fps,
            input->cached && !input->cache.cache.finished ? "; unfinished or cut off" : "");
}

void convert_input_print(const ConvertInput *input, FILE *stream)
{
    const Strands *layout = &input->cache.layout;
    if (input->cached) {
        fprintf(stream, "%s: a cache\n  strands   %u of %u section%s\n  vertices  %u\n",
                quote(input->paths[0]).text, layout->strand_count, input->cache.section_count,
                input->cache.section_count == 1 ? "" : "s", layout->vertex_count);
    }
    for (int i = 0; i < input->path_count && !input->cached; ++i)
        strands_report_print(&input->reports[i], input->paths[i], stream);
    if (convert_input_moves(input)) print_frames(input, stream);
}

static json_t *defects_to_json(const StrandsReport *report, const char *path)
{
    static const char *const names[DEFECT_KINDS] = {
        "not_finite", "too_short", "coincident", "attribute", "over_limit", "padding", "unread"};
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

static json_t *contents_to_json(const FormatContents *contents)
{
    json_t *list = json_array();
    for (uint32_t i = 0; i < contents->count && i < FORMAT_OBJECTS; ++i) {
        const FormatObject *object = &contents->object[i];
        json_t *entry = json_pack("{ss si}", "path", object->path, "strands", object->strands);
        if (object->why) json_object_set_new(entry, "left_out", json_string(object->why));
        json_array_append_new(list, entry);
    }
    return list;
}

static json_t *report_to_json(const StrandsReport *report, const char *path)
{
    return json_pack(
        "{ss ss sf si si si si sf sb ss sb sb si si ss si si si so ss so}", "file", path, "kind",
        FORMAT_TABLE[report->kind]->name, "version", (double)report->version, "declared_strands",
        report->declared_strands, "declared_vertices", report->declared_vertices, "strands",
        report->strands, "vertices", report->vertices, "unit_m", (double)report->unit_used,
        "unit_guessed", report->unit_guessed, "up", report->up_z ? "z" : "y", "up_guessed",
        report->up_guessed, "shuffled", report->shuffled, "empty_roots", report->empty_roots,
        "shared_roots", report->shared_roots, "note", report->note, "flaws", report->flaws,
        "object_count", report->contents.count, "objects_left_out", report->contents.left_out,
        "objects", contents_to_json(&report->contents), "attributes_not_read",
        report->contents.unread, "defects", defects_to_json(report, path));
}

json_t *convert_input_to_json(const ConvertInput *input)
{
    json_t *list = json_array();
    if (input->cached)
        json_array_append_new(list, json_pack("{ss ss si}", "file", input->paths[0], "kind",
                                              "cache", "sections", input->cache.section_count));
    for (int i = 0; i < input->path_count && !input->cached; ++i)
        json_array_append_new(list, report_to_json(&input->reports[i], input->paths[i]));
    return list;
}
