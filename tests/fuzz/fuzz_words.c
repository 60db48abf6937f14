// SPDX-License-Identifier: MIT
// Small languages: CSV, formulas, lists of colliders.
#include "base/csv.h"
#include "base/formula.h"
#include "fuzz/fuzz.h"
#include "scene/colliders.h"

#include <math.h>
#include <string.h>

void fuzz_csv(const Bytes *bytes, int unused);
void fuzz_formula(const Bytes *bytes, int unused);
void fuzz_colliders(const Bytes *bytes, int unused);

void fuzz_csv(const Bytes *bytes, int unused)
{
    (void)unused;
    Csv csv = {0};
    Error error = {{0}};
    Result result = csv_read(&csv, fuzz_file("x.csv", bytes), &error);
    fuzz_claim_error(result, &error);
    for (size_t row = 0; row < csv.row_count; ++row)
        for (size_t column = 0; column < csv.column_count; ++column) {
            double value;
            fuzz_claim(csv_text(&csv, row, column) != NULL, "no field");
            fuzz_claim_error(csv_number(&csv, row, column, &value, &error), &error);
        }
    csv_destroy(&csv);
}

void fuzz_formula(const Bytes *bytes, int unused)
{
    (void)unused;
    if (memchr(bytes->data, 0, bytes->size)) return; // not text
    Formula formula = {0};
    Error error = {{0}};
    Result result = formula_create(&formula, (const char *)bytes->data, &error);
    fuzz_claim_error(result, &error);
    if (result == RESULT_OK) {
        double first = formula_evaluate(&formula, 0.75), second = formula_evaluate(&formula, 0.75);
        fuzz_claim(memcmp(&first, &second, sizeof first) == 0 || (isnan(first) && isnan(second)),
                   "%g, then %g", first, second);
    }
    formula_destroy(&formula);
}

void fuzz_colliders(const Bytes *bytes, int unused)
{
    (void)unused;
    if (memchr(bytes->data, 0, bytes->size)) return;
    Colliders colliders = {0};
    Error error = {{0}};
    Result result = colliders_parse(&colliders, (const char *)bytes->data, &error);
    fuzz_claim_error(result, &error);
    for (uint32_t i = 0; result == RESULT_OK && i < colliders.count; ++i)
        for (int k = 0; k < COLLIDER_NUMBERS; ++k)
            fuzz_claim(fabsf(colliders.list[i].numbers[k]) <= 1e6f, "collider %u", i);
    colliders_destroy(&colliders);
}
