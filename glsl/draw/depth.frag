// SPDX-License-Identifier: MIT
// Only depth is kept.

void main() {}
