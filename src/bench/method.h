// SPDX-License-Identifier: MIT
// A solver with its settings: what benchmarks compare.
#pragma once

#include "base/params.h"

#include <stdio.h>

typedef struct Method {
    const char *algo;
    const char *variant;  // "": the solver's first
    const char *settings; // flags of tractrix-render and their values, "--rope-iterations 50"; ""
} Method;

// The parameters of a section: defaults, then the flags `before`, then the method's. RESULT_USAGE
// for a solver, a variant, a flag or a value that does not exist, or settings of more than 4000
// bytes. The struct may be destroyed in either case.
Result method_params(SectionParams *params, const Method *method, const char *before, Error *error);

// Whether a parameter is one of those that `settings` may have: a section's, of the simulation,
// that changes how guides move.
bool method_takes(const ParamInfo *info);

// Whether the method's solver has the parameter of this name.
bool method_has(const Method *method, const char *param);

// Whether it is a solver in its default form, for which bounds are stated.
bool method_is_default(const Method *method);

// The variant's word: the method's, or the solver's first ("" if it has none).
const char *method_variant(const Method *method);

// "--algo rope --variant xpbd --rope-iterations 50", with the variant's word always said.
void method_format(const Method *method, char *text, size_t size);

enum { METHODS_MOST = 64 };

// The methods that a user asks for: one; or, with an algo of NULL, every solver that steps in its
// default form, with the same settings. Gives their count.
int method_list(const Method *asked, Method methods[METHODS_MOST]);
