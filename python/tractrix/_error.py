# SPDX-License-Identifier: MIT
"""Exceptions."""

from __future__ import annotations

import errno
import os

FAILED, USAGE, BAD_INPUT, NO_GL = 1, 2, 3, 4


class TractrixError(Exception):
    """A call failed. `code` has the meaning of the programs' exit statuses: 1 failure at run time, 2 wrong usage, 3 bad
    input, 4 no usable OpenGL. `text` is one line: "place: what is wrong: what was expected"."""

    def __init__(self, code: int, text: str) -> None:
        super().__init__(code, text)
        self.code = code
        self.text = text

    def __str__(self) -> str:
        return self.text


class TractrixValueError(TractrixError, ValueError):
    """An argument, a parameter (code 2) or the content of an array or file (code 3) is wrong."""


class TractrixFileNotFoundError(TractrixValueError, FileNotFoundError):
    """A file that an argument or a scene names does not exist."""


def error_of(code: int, text: str) -> TractrixError:
    if text.endswith(f": {os.strerror(errno.ENOENT)}"):
        return TractrixFileNotFoundError(code, text)
    return (TractrixValueError if code in (USAGE, BAD_INPUT) else TractrixError)(code, text)


def usage(text: str) -> TractrixError:
    return error_of(USAGE, text)
