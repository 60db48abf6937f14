// SPDX-License-Identifier: MIT
// Smooth noise in space.
#pragma once

// Between -1 and 1: random at whole coordinates, between them joined smoothly. Integers and
// products only: the same on every machine.
double noise_at(double x, double y, double z);
