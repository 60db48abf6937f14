// SPDX-License-Identifier: MIT
// The wish that the program ends, as a flag that loops look at. interrupt_install.h has signals set
// it.
#pragma once

#include <stdbool.h>

// Whether it was asked for. False for ever if nothing asks. Any thread may call it.
bool interrupt_requested(void);

// For what asks: says which thread is to notice; asks (in a signal's handler, too); whether that
// thread has noticed.
void interrupt_expect(void);
void interrupt_request(void);
bool interrupt_noticed(void);
