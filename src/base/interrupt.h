// SPDX-License-Identifier: MIT
// A flag that asks the program to end, which loops test. interrupt_install.h lets signals set it.
#pragma once

#include <stdbool.h>

// Whether the program was asked to end. Always false if nothing sets the flag. Thread-safe.
bool interrupt_requested(void);

// For the code that sets the flag: interrupt_expect says which thread should notice it,
// interrupt_request sets it (also from a signal handler), interrupt_noticed tells whether that
// thread has seen it.
void interrupt_expect(void);
void interrupt_request(void);
bool interrupt_noticed(void);
