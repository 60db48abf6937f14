# SPDX-License-Identifier: MIT
"""Parameters: the library's table, and values as text in the form of tractrix-render's flags."""

from __future__ import annotations

import functools
import itertools
import os
from typing import Any, Mapping, NamedTuple

from ._error import usage
from ._library import library


class Parameter(NamedTuple):
    """A parameter of the library. `kind`: type of the value ("float", "vec3", "choice" ...); `default`: the default
    value as text; `choices`: the allowed words (empty: not limited to words); `owner`: names of the solvers that use
    the parameter (empty: all); `minimum` and `maximum`: limits of each number (both 0: no limits); `of_section`: each
    section of hair may have its own value; `live`: Simulation.set may change the value."""

    name: str
    kind: str
    unit: str
    help: str
    default: str
    choices: tuple[str, ...]
    owner: tuple[str, ...]
    minimum: float
    maximum: float
    of_section: bool
    live: bool


@functools.lru_cache(maxsize=None)
def parameters() -> Mapping[str, Parameter]:
    """Every parameter by its name."""
    table = {}
    for index in itertools.count():
        pointer = library().tractrix_parameter(index)
        if not pointer:
            return table
        row = pointer.contents
        text = {field: getattr(row, field).decode() for field in ("name", "kind", "unit", "help", "default_text", "choices", "owner")}
        table[text["name"]] = Parameter(text["name"], text["kind"], text["unit"], text["help"], text["default_text"],
                                        tuple(text["choices"].split()), tuple(text["owner"].split()), row.minimum,
                                        row.maximum, row.of_section, row.live)


# The separator between the numbers of a value, by the kind of the parameter; for all other kinds it is a comma.
_SEPARATORS = {"size": "x", "part": "/", "profile": ":"}


def plain(value: Any) -> Any:
    """numpy's arrays and numbers as Python lists and numbers."""
    return value.tolist() if hasattr(value, "tolist") else value


def bytes_of(what: str, value: str | os.PathLike[str]) -> bytes:
    """A text or path for the library, which takes a zero for the end: one in it would name another file."""
    encoded = os.fsencode(value)
    if b"\0" in encoded:
        raise usage(f"{what}: got {value!r}: expected no zero character")
    return encoded


def text_of(name: str, value: Any) -> str:
    """Converts `value` to the text that tractrix-render's option takes: text and paths stay unchanged, True becomes
    "true", numbers keep all digits, and sequences are joined with the separator of the parameter's kind."""
    if isinstance(value, (str, os.PathLike)):
        return os.fspath(value)
    value = plain(value)
    if isinstance(value, (list, tuple)):
        value = [plain(item) for item in value]
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, list) and all(isinstance(item, (int, float)) and not isinstance(item, bool) for item in value):
        row = parameters().get(name)
        return _SEPARATORS.get(row.kind if row else "", ",").join(map(repr, value))
    raise usage(f"{name}: got {value!r}: expected a text, a number, a sequence of numbers, True or False")
