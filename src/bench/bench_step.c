// SPDX-License-Identifier: MIT
#include "bench/bench_step.h"
#include "bench/test_vectors.h"

#include <math.h>
#include <string.h>

typedef struct Row {
    const char *rule, *category, *unit, *verdict;
    long rows, above, not_finite, worst_row;
    double median, worst, mark;
    char command[512];
} Row;

#define AT(member) offsetof(Row, member)
static const Column COLUMNS[] = {
    {"rule", COLUMN_TEXT, AT(rule), 7},
    {"category", COLUMN_TEXT, AT(category), 20},
    {"rows", COLUMN_WHOLE, AT(rows), 5},
    {"above_mark", COLUMN_WHOLE, AT(above), 10},
    {"not_finite", COLUMN_WHOLE, AT(not_finite), 10},
    {"worst_row", COLUMN_WHOLE, AT(worst_row), 9},
    {"median", COLUMN_REAL, AT(median), 9},
    {"worst", COLUMN_REAL, AT(worst), 9},
    {"unit", COLUMN_TEXT, AT(unit), 7},
    {"mark", COLUMN_REAL, AT(mark), 5},
    {"verdict", COLUMN_TEXT, AT(verdict), 7},
    {"command", COLUMN_CHARS, AT(command), 0},
};

// What is checked: its rule, and what it is measured by.
typedef struct Check {
    const char *rule, *unit;
    const char *command, *path;
    double mark;
    bool stated; // the mark is a bound
} Check;

static void add_category(Table *table, const Check *check, const TestVectorsCategory *category,
                         double bound)
{
    Row row = {.rule = check->rule,
               .category = category->name,
               .unit = check->unit,
               .rows = (long)category->rows,
               .above = (long)category->failed,
               .not_finite = (long)category->not_finite,
               .worst_row = category->worst_id,
               .median = category->median,
               .worst = category->worst,
               .mark = check->mark};
    row.verdict = table_check(table, row.worst, bound, "%s, row %ld, in %s", row.category,
                              row.worst_row, row.unit);
    snprintf(row.command, sizeof row.command, "tractrix-bench %s --vectors %s", check->command,
             check->path);
    table_add(table, &row);
}

static void add_report(Table *table, const Check *check, const TestVectorsReport *report)
{
    TestVectorsCategory all = {.name = "all", .worst = -1, .median = NAN};
    for (size_t i = 0; i < report->category_count; ++i) {
        const TestVectorsCategory *at = &report->categories[i];
        add_category(table, check, at, check->stated ? check->mark : NAN);
        if (at->worst > all.worst) all.worst = at->worst, all.worst_id = at->worst_id;
    }
    all.rows = report->rows, all.failed = report->failed, all.not_finite = report->not_finite;
    add_category(table, check, &all, NAN); // its categories have been checked
}

static Result open_table(Table *table, const BenchOptions *options, const Gpu *gpu, Error *error)
{
    return table_open(table, COLUMNS, sizeof COLUMNS / sizeof *COLUMNS, gpu, &options->output,
                      stdout, error);
}

Result bench_step(const BenchOptions *options, const Gpu *gpu, Error *error)
{
    static const char *const rules[] = {"ours", "thesis"};
    const char *path = options->vectors ? options->vectors : "tests/data/tractrix_steps.csv";
    Table table = {0};
    Result result = open_table(&table, options, gpu, error);
    for (TestVectorsRule rule = VECTORS_OURS; rule <= VECTORS_PUBLISHED && result == RESULT_OK;
         ++rule) {
        const Check check = {rules[rule], "floor32",         "step",
                             path,        VECTORS_STEP_MARK, rule == VECTORS_OURS};
        TestVectorsReport report;
        result = test_vectors_check_steps(&report, gpu, rule, path, error);
        if (result == RESULT_OK) add_report(&table, &check, &report);
    }
    return table_close(&table, result, error);
}

Result bench_chain(const BenchOptions *options, const Gpu *gpu, Error *error)
{
    const char *path = options->vectors ? options->vectors : "tests/data/chain_pulls.csv";
    const Check check = {"ours", "sens32", "chain", path, VECTORS_CHAIN_MARK, true};
    Table table = {0};
    TestVectorsReport report;
    Result result = open_table(&table, options, gpu, error);
    if (result == RESULT_OK) result = test_vectors_check_chains(&report, gpu, path, error);
    if (result == RESULT_OK) add_report(&table, &check, &report);
    return table_close(&table, result, error);
}
