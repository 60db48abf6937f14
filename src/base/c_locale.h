// SPDX-License-Identifier: MIT
// The "C" locale for threads of a process that has another one: text has decimal points, English
// messages and letters without accents only there. Programs never leave the "C" locale. The library
// enters it in each of its functions (library.h), and parallel_start in each thread. So no other
// code need ask for a locale when it reads or writes numbers.
#pragma once

#include <locale.h>

// Switches the calling thread, and no other one, to the "C" locale. Returns the locale that the
// thread had before, for c_locale_leave.
locale_t c_locale_enter(void);
void c_locale_leave(locale_t before);
