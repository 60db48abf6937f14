// SPDX-License-Identifier: MIT
// Writes depth only.

void main() {}
