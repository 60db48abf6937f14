#!/bin/sh
# SPDX-License-Identifier: MIT
# The short form of `make torture`: some call sites of each small run fail, one call at a time, and each kind of run is
# killed twice.
bin=${TRACTRIX_BIN:-out/release}
exec "$bin/tests/faults/torture" "$bin"
