// SPDX-License-Identifier: MIT
// The help of programs: for a terminal, as a manual page and in Markdown.
#include "base/options.h"
#include "base/options_complete.h"
#include "base/suggest.h"

#include "version.h"

#include <assert.h>
#include <ctype.h>
#include <string.h>

enum { WIDTH = 96, COLUMN = 30, FLAG_SIZE = 400, LIST_SIZE = 800 };

const Option OPTIONS_COMMON[OPTIONS_COMMON_COUNT] = {
    {"help", 'h', OPTION_STRING, 0, "[TOPIC]", 0, 0,
     "print help and stop; TOPIC: all, man, markdown, an option's name, or the completion of a "
     "shell: bash, zsh, fish"},
    {"version", 0, OPTION_SWITCH, 0, NULL, 0, 0, "print the version and stop"},
};

static size_t count_options(const OptionsProgram *program)
{
    return program->option_count + OPTIONS_COMMON_COUNT;
}

static const Option *option_at(const OptionsProgram *program, size_t i)
{
    return i < program->option_count ? &program->options[i]
                                     : &OPTIONS_COMMON[i - program->option_count];
}

static const char *heading_of(const OptionsProgram *program, size_t i)
{
    if (!program->headings) return "Options";
    return i < program->option_count ? program->headings[i] : "Other";
}

// Turns camera_up into "--camera-up".
static void write_name(char *text, size_t size, const char *name)
{
    snprintf(text, size, "--%s", name);
    for (char *at = text; *at; ++at)
        if (*at == '_') *at = '-';
}

// Writes "-j, --jobs N".
static void write_flag(const Option *option, char *text, size_t size)
{
    char letter[8] = "", name[80];
    write_name(name, sizeof name, option->name);
    if (option->letter) snprintf(letter, sizeof letter, "-%c, ", option->letter);
    snprintf(text, size, "%s%s%s%s", letter, name, option->value ? " " : "",
             option->value ? option->value : "");
}

// --- Layout.

// Prints the words of `text` from `column` on, wrapped at WIDTH. Lines after the first are
// indented. Text in [brackets] is not broken.
static void put_wrapped(FILE *stream, const char *text, size_t column, size_t indent)
{
    bool first = true;
    while (*text) {
        size_t length = *text == '[' ? strcspn(text, "]") + 1 : strcspn(text, " ");
        if (!first && column + 1 + length > WIDTH) {
            fprintf(stream, "\n%*s", (int)indent, "");
            column = indent;
            first = true;
        }
        fprintf(stream, "%s%.*s", first ? "" : " ", (int)length, text);
        column += length + (first ? 0 : 1);
        first = false;
        text += length;
        text += strspn(text, " ");
    }
    fputc('\n', stream);
}

static void put_entry(FILE *stream, const char *left, const char *text)
{
    int used = 0;
    while (strlen(left) > WIDTH - 2) { // a list of many words breaks behind a bar
        size_t fit = WIDTH - 2;
        while (fit > 0 && left[fit - 1] != '|') --fit;
        if (!fit) break;
        fprintf(stream, "  %*s%.*s\n", used, "", (int)fit, left);
        left += fit, used = 4;
    }
    used = fprintf(stream, "  %*s%s", used, "", left);
    if (used > COLUMN - 2) {
        fputc('\n', stream);
        used = 0;
    }
    fprintf(stream, "%*s", COLUMN - used, "");
    put_wrapped(stream, text, COLUMN, COLUMN);
}

static void put_heading(FILE *stream, const char *heading)
{
    fprintf(stream, "\n%s:\n", heading);
}

// Escapes the characters that roff would interpret.
static void put_roff(FILE *stream, const char *text)
{
    if (*text == '.' || *text == '\'') fputs("\\&", stream);
    for (; *text; text++) {
        if (*text == '\\')
            fputs("\\e", stream);
        else if (*text == '|')
            fputs("|\\:", stream); // lists of words may break here
        else if (*text == '-')
            fputs("\\-", stream);
        else
            fputc(*text, stream);
    }
    fputc('\n', stream);
}

static void put_roff_entry(FILE *stream, const char *tag, const char *text)
{
    fprintf(stream, ".TP\n.B ");
    put_roff(stream, tag);
    put_roff(stream, text);
}

static void put_roff_heading(FILE *stream, const char *heading)
{
    fprintf(stream, ".SS %s\n", heading);
}

static void put_roff_section(FILE *stream, const char *title)
{
    fprintf(stream, ".SH \"");
    for (; *title; title++) fputc(toupper((unsigned char)*title), stream);
    fprintf(stream, "\"\n");
}

// Escapes '|', which would end the cell, and '*'.
static void put_cell(FILE *stream, const char *text)
{
    for (; *text; text++) fprintf(stream, *text == '|' || *text == '*' ? "\\%c" : "%c", *text);
}

static void put_row(FILE *stream, const char *flag, const char *text)
{
    fprintf(stream, "| `");
    for (; *flag; flag++) fprintf(stream, *flag == '|' ? "\\%c" : "%c", *flag);
    fprintf(stream, "` | ");
    put_cell(stream, text);
    fprintf(stream, " |\n");
}

static void put_table_heading(FILE *stream, const char *heading)
{
    fprintf(stream, "\n## %s\n\n| option | what it does |\n| --- | --- |\n", heading);
}

// --- Options.

// Which options to list: those of a topic, the brief ones, or all.
typedef struct Selection {
    const char *topic;
    bool brief;
} Selection;

static bool selects(const OptionsProgram *program, Selection selection, size_t i)
{
    bool common = i >= program->option_count, listed = false;
    if (selection.topic) return !common && program->is_of(selection.topic, i);
    if (!selection.brief || !program->brief || common) return true;
    for (const char *const *name = program->brief; *name && !listed; ++name)
        listed = strcmp(*name, program->options[i].name) == 0;
    return listed;
}

// Prints each heading once, followed by its options.
static void list_options(FILE *stream, const OptionsProgram *program, Selection selection,
                         void (*heading)(FILE *stream, const char *heading),
                         void (*entry)(FILE *stream, const char *flag, const char *text))
{
    size_t count = count_options(program);
    bool done[OPTIONS_MOST + OPTIONS_COMMON_COUNT] = {false};
    assert(program->option_count <= OPTIONS_MOST);
    for (size_t i = 0; i < count; ++i) {
        if (done[i] || !selects(program, selection, i)) continue;
        const char *title = heading_of(program, i);
        heading(stream, selection.brief && program->brief ? "Options" : title);
        for (size_t j = i; j < count; ++j) {
            bool same = strcmp(heading_of(program, j), title) == 0;
            if (!(same || (selection.brief && program->brief)) || done[j] ||
                !selects(program, selection, j))
                continue;
            char flag[FLAG_SIZE];
            write_flag(option_at(program, j), flag, sizeof flag);
            entry(stream, flag, option_at(program, j)->help);
            done[j] = true;
        }
    }
}

// --- The forms of help.

static void put_usage(FILE *stream, const OptionsProgram *program)
{
    const char *line = program->synopsis;
    for (const char *before = "Usage:"; line; before = "      ") {
        int length = (int)strcspn(line, "\n");
        fprintf(stream, "%s %s %.*s\n", before, program->name, length, line);
        line = line[length] ? line + length + 1 : NULL;
    }
}

// Writes "input (hair files), output (images), ..., all", cut at `size`.
static void list_topics(const OptionsProgram *program, bool explained, char *text, size_t size)
{
    size_t length = 0;
    text[0] = 0;
    for (const char *const(*topic)[2] = program->topics; topic && (*topic)[0]; ++topic) {
        bool why = explained && (*topic)[1];
        if (length < size)
            length += (size_t)snprintf(text + length, size - length, "%s%s%s%s, ", (*topic)[0],
                                       why ? " (" : "", why ? (*topic)[1] : "", why ? ")" : "");
    }
    for (const OptionsChapter *const *c = program->chapters; c && *c && length < size; ++c)
        length += (size_t)snprintf(text + length, size - length, "%s, ", (*c)->topic);
    if (length < size)
        snprintf(text + length, size - length,
                 "all, man, markdown, bash, zsh, fish or an option's name");
}

static void put_text(FILE *stream, const OptionsProgram *program, bool brief)
{
    put_usage(stream, program);
    fputc('\n', stream);
    put_wrapped(stream, program->description, 0, 0);
    if (program->commands) put_heading(stream, "Commands");
    for (const char *const(*c)[2] = program->commands; c && (*c)[0]; ++c)
        put_entry(stream, (*c)[0], (*c)[1]);
    list_options(stream, program, (Selection){.brief = brief}, put_heading, put_entry);
    brief = brief && program->brief;
    if (brief) {
        char topics[LIST_SIZE];
        list_topics(program, true, topics, sizeof topics);
        fprintf(stream, "\nMore: --help TOPIC, with TOPIC one of\n");
        put_wrapped(stream, topics, 0, 0);
    }
    for (const char *const *note = brief ? NULL : program->notes; note && *note; ++note) {
        fputc('\n', stream);
        put_wrapped(stream, *note, 0, 0);
    }
    if (!brief) put_heading(stream, "Exit status");
    for (const char *const(*s)[2] = program->status; !brief && (*s)[0]; ++s)
        fprintf(stream, "  %3s  %s\n", (*s)[0], (*s)[1]);
    put_heading(stream, "Examples");
    for (const char *const *e = program->examples; *e; ++e) fprintf(stream, "  %s\n", *e);
}

static void put_chapter(FILE *stream, const OptionsChapter *chapter)
{
    put_wrapped(stream, chapter->text, 0, 0);
    for (const char *const(*entry)[3] = chapter->entries; (*entry)[0]; ++entry) {
        if (!(*entry)[2][0]) {
            put_entry(stream, (*entry)[0], (*entry)[1]);
            continue;
        }
        fprintf(stream, "\n\"%s\": ", (*entry)[0]);
        put_wrapped(stream, (*entry)[1], strlen((*entry)[0]) + 4, 2);
        fprintf(stream, "    ");
        put_wrapped(stream, (*entry)[2], 4, 4);
    }
}

static void put_man(FILE *stream, const OptionsProgram *program)
{
    const char *page = program->page ? program->page : program->name, *line = program->synopsis;
    fprintf(stream, ".TH ");
    for (const char *at = page; *at; ++at) fputc(toupper((unsigned char)*at), stream);
    fprintf(stream, " 1 \"\" \"Tractrix %s\"\n", TRACTRIX_VERSION);
    put_roff_section(stream, "Name");
    for (const char *at = page; *at; ++at) fprintf(stream, *at == '-' ? "\\-" : "%c", *at);
    fprintf(stream, " \\- ");
    put_roff(stream, program->summary);
    put_roff_section(stream, "Synopsis");
    for (char copy[200]; line;) {
        int length = (int)strcspn(line, "\n");
        fprintf(stream, ".B ");
        put_roff(stream, program->name);
        snprintf(copy, sizeof copy, "%.*s", length, line);
        put_roff(stream, copy);
        line = line[length] ? line + length + 1 : NULL;
        if (line) fprintf(stream, ".br\n");
    }
    put_roff_section(stream, "Description");
    put_roff(stream, program->description);
    if (program->commands) put_roff_section(stream, "Commands");
    for (const char *const(*c)[2] = program->commands; c && (*c)[0]; ++c)
        put_roff_entry(stream, (*c)[0], (*c)[1]);
    put_roff_section(stream, "Options");
    list_options(stream, program, (Selection){0}, put_roff_heading, put_roff_entry);
    for (const OptionsChapter *const *c = program->chapters; c && *c; ++c) {
        put_roff_section(stream, (*c)->title);
        put_roff(stream, (*c)->text);
        for (const char *const(*entry)[3] = (*c)->entries; (*entry)[0]; ++entry) {
            bool meant = (*entry)[2][0];
            put_roff_entry(stream, (*entry)[0], (*entry)[meant ? 2 : 1]);
            if (!meant) continue;
            fprintf(stream, ".br\n");
            put_roff(stream, (*entry)[1]);
        }
    }
    if (program->notes) put_roff_section(stream, "Notes");
    for (const char *const *note = program->notes; note && *note; ++note) {
        fprintf(stream, ".PP\n");
        put_roff(stream, *note);
    }
    put_roff_section(stream, "Exit status");
    for (const char *const(*s)[2] = program->status; (*s)[0]; ++s)
        put_roff_entry(stream, (*s)[0], (*s)[1]);
    put_roff_section(stream, "Examples");
    fprintf(stream, ".nf\n");
    for (const char *const *e = program->examples; *e; ++e) put_roff(stream, *e);
    fprintf(stream, ".fi\n");
}

static void put_markdown(FILE *stream, const OptionsProgram *program)
{
    fprintf(stream, "# Options of %s\n", program->name);
    for (const char *const *note = program->notes; note && *note; ++note)
        fprintf(stream, "\n%s\n", *note);
    list_options(stream, program, (Selection){0}, put_table_heading, put_row);
    for (const OptionsChapter *const *c = program->chapters; c && *c; ++c) {
        bool meant = (*c)->entries[0][2][0];
        fprintf(stream, "\n## %s\n\n%s\n\n| %s\n", (*c)->title, (*c)->text,
                meant ? "key | value | what it is |\n| --- | --- | --- |"
                      : "name | value |\n| --- | --- |");
        for (const char *const(*entry)[3] = (*c)->entries; (*entry)[0]; ++entry)
            fprintf(stream, "| `%s` | `%s` |%s%s%s\n", (*entry)[0], (*entry)[1], meant ? " " : "",
                    (*entry)[2], meant ? " |" : "");
    }
}

// --- Topics.

// Returns the topic whose description has the word nearest to this one, or NULL if none is near.
static const char *find_by_text(const OptionsProgram *program, const char *word)
{
    enum { SHORTEST = 4 }; // letters: "and" describes nothing
    char nearest[80] = "";
    const char *topic = NULL;
    for (const char *const(*t)[2] = program->topics; t && (*t)[0]; ++t) {
        char text[LIST_SIZE], *rest = NULL;
        snprintf(text, sizeof text, "%s", (*t)[1] ? (*t)[1] : "");
        for (char *is = strtok_r(text, " ,", &rest); is; is = strtok_r(NULL, " ,", &rest))
            if (strlen(is) >= SHORTEST &&
                suggest_nearest(word, (const char *[]){nearest, is}, 2) == is) {
                snprintf(nearest, sizeof nearest, "%s", is);
                topic = (*t)[0];
            }
    }
    return topic;
}

// Finds the topic or option that the user may have meant, spelled as he writes it; "" if there is
// none.
static void find_near(const OptionsProgram *program, const char *topic, char near[80])
{
    enum { MOST = OPTIONS_MOST + 64 };
    const char *names[MOST];
    size_t count = 0;
    for (const char *const(*t)[2] = program->topics; t && (*t)[0] && count < MOST; ++t)
        names[count++] = (*t)[0];
    for (const OptionsChapter *const *c = program->chapters; c && *c && count < MOST; ++c)
        names[count++] = (*c)->topic;
    for (size_t i = 0; i < program->option_count && count < MOST; ++i)
        names[count++] = program->options[i].name;
    const char *found = suggest_nearest(topic, names, count);
    if (!found) found = find_by_text(program, topic);
    snprintf(near, 80, "%s", found ? found : "");
    for (char *at = near; *at; ++at) *at = *at == '_' ? '-' : *at;
}

Result options_help(const OptionsProgram *program, const char *topic, FILE *stream, Error *error)
{
    const OptionsChapter *const *chapter = program->chapters;
    const char *const(*listed)[2] = program->topics;
    while (topic && chapter && *chapter && strcmp((*chapter)->topic, topic) != 0) ++chapter;
    while (topic && listed && (*listed)[0] && strcmp((*listed)[0], topic) != 0) ++listed;
    if (!topic)
        put_text(stream, program, true);
    else if (strcmp(topic, "all") == 0)
        put_text(stream, program, false);
    else if (strcmp(topic, "man") == 0)
        put_man(stream, program);
    else if (strcmp(topic, "markdown") == 0)
        put_markdown(stream, program);
    else if (options_complete(program, topic, stream))
        return RESULT_OK;
    else if (listed && (*listed)[0])
        list_options(stream, program, (Selection){.topic = topic}, put_heading, put_entry);
    else if (chapter && *chapter)
        put_chapter(stream, *chapter);
    else {
        const Option *option = options_find(program->options, program->option_count, topic);
        char flag[FLAG_SIZE];
        if (!option) option = options_find(OPTIONS_COMMON, OPTIONS_COMMON_COUNT, topic);
        char list[LIST_SIZE];
        list_topics(program, false, list, sizeof list);
        char near[80] = "";
        if (!option) find_near(program, topic, near);
        if (*near)
            return error_set(error, RESULT_USAGE, "--help: no topic '%.80s': did you mean '%s'?",
                             topic, near);
        if (!option)
            return error_set(error, RESULT_USAGE, "--help: no topic '%.80s': expected %s", topic,
                             list);
        write_flag(option, flag, sizeof flag);
        put_entry(stream, flag, option->help);
    }
    return RESULT_OK;
}
