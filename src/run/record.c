// SPDX-License-Identifier: MIT
#include "run/record.h"
#include "base/bytes.h"
#include "base/outfile.h"

#include <inttypes.h>
#include <libdeflate.h>
#include <stdlib.h>
#include <string.h>

enum { LINE_BYTES = 48 };

char *record_path(const Target *target)
{
    char *path = NULL;
    if (!target->before || target->kind != TARGET_FRAMES) return NULL;
    return asprintf(&path, "%s%s.scenes", target->before, target->after) < 0 ? NULL : path;
}

static void write_line(char text[LINE_BYTES], int frame, const RecordLine *line)
{
    snprintf(text, LINE_BYTES, "%d %s %08" PRIx32, frame, line->fingerprint, line->checksum);
}

// The CRC-32 of a whole file.
static Result find_checksum(uint32_t *checksum, const char *name, Error *error)
{
    Bytes file;
    TRY(bytes_read_plain(&file, name, error));
    *checksum = libdeflate_crc32(0, file.data, file.size);
    bytes_destroy(&file);
    return RESULT_OK;
}

Result record_add(const Target *target, int frame, const char *fingerprint, Error *error)
{
    char text[LINE_BYTES + 1];
    RecordLine line = {.checksum = 0};
    if (target->kind != TARGET_FRAMES) return RESULT_OK;
    char *path = record_path(target), *name = target_name_frame(target, frame);
    Result result =
        path && name ? RESULT_OK : error_set(error, RESULT_FAILED, "no memory for a file's name");
    THEN(result, find_checksum(&line.checksum, name, error));
    if (result == RESULT_OK) {
        snprintf(line.fingerprint, sizeof line.fingerprint, "%s", fingerprint);
        write_line(text, frame, &line);
        result = outfile_append(path, strcat(text, "\n"), error);
    }
    free(path);
    free(name);
    return result;
}

// Parses a line exactly as record_add writes it; ignores any other line.
static void take_line(Record *record, const char *text)
{
    int frame;
    RecordLine line;
    char whole[LINE_BYTES];
    if (sscanf(text, "%9d %16[0-9a-f] %8" SCNx32, &frame, line.fingerprint, &line.checksum) != 3 ||
        frame < 0 || frame >= record->count)
        return;
    write_line(whole, frame, &line);
    if (strcmp(text, whole) == 0) record->lines[frame] = line;
}

Result record_read(Record *record, const Target *target, int last, Error *error)
{
    Bytes file = {0};
    *record = (Record){.lines = calloc((size_t)last + 1, sizeof *record->lines), .count = last + 1};
    char *path = record_path(target), *rest = NULL;
    if (!record->lines || !path) {
        free(path);
        return error_set(error, RESULT_FAILED, "no memory for the record of %d frames", last + 1);
    }
    bool there = bytes_read_plain(&file, path, NULL) == RESULT_OK;
    for (char *line = there ? strtok_r((char *)file.data, "\n", &rest) : NULL; line;
         line = strtok_r(NULL, "\n", &rest))
        take_line(record, line);
    bytes_destroy(&file);
    free(path);
    return RESULT_OK;
}

void record_destroy(Record *record)
{
    free(record->lines);
    *record = (Record){0};
}

Result record_compare(const Record *record, int frame, const char *name, const char *fingerprint,
                      Error *why)
{
    uint32_t checksum;
    const RecordLine *line = &record->lines[frame];
    TRY(find_checksum(&checksum, name, why));
    if (!*line->fingerprint)
        return error_set(why, RESULT_FAILED, "%.300s: there is no record of how it was rendered",
                         name);
    if (line->checksum != checksum)
        return error_set(why, RESULT_FAILED, "%.300s: was changed after it was rendered", name);
    if (strcmp(line->fingerprint, fingerprint) == 0) return RESULT_OK;
    return error_set(why, RESULT_FAILED, "%.300s: was made with other parameters or input files",
                     name);
}
