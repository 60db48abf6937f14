// SPDX-License-Identifier: MIT
// Names of image files that are not read, for messages.
#pragma once

#include "base/bytes.h"

// "a WebP image" by the content's first bytes; NULL if it is none of the known kinds.
const char *image_kind_name(const Bytes *file);
