# SPDX-License-Identifier: MIT
# ctypes checks no types: _declarations.py must agree with tractrix.h, member by member, argument by argument.
import ctypes
import re

import pytest

from tractrix import _declarations, _error, _library

SCALARS = {"size_t": ctypes.c_size_t, "uint32_t": ctypes.c_uint32, "uint64_t": ctypes.c_uint64, "int": ctypes.c_int,
           "bool": ctypes.c_bool, "float": ctypes.c_float, "double": ctypes.c_double, "char": ctypes.c_char}
HANDLES = {"TractrixDevice", "TractrixScene", "TractrixSimulation", "TractrixRenderer", "TractrixPicture", "TractrixState"}


def without_comments(text):
    return re.sub(r"//[^\n]*|^#[^\n]*", "", text, flags=re.M)


def type_of(words, stars):
    """The ctypes type of a C type without const, with so many stars."""
    if words == "char" and stars == 1:
        return ctypes.c_char_p
    if words == "void":
        return ctypes.c_void_p if stars else None
    if words == "TractrixProgress":  # a pointer to it is ctypes' function type
        return _declarations.Progress
    if words in HANDLES:
        kind, stars = ctypes.c_void_p, stars - 1
    elif words in SCALARS:
        kind = SCALARS[words]
    else:
        kind = getattr(_declarations, words.replace("Tractrix", "", 1), ctypes.c_int)  # otherwise an enum
    for _ in range(stars):
        kind = ctypes.POINTER(kind)
    return kind


def declared(text):
    """Of "const float *position" or "char text[1024]": name and type."""
    text = text.replace("const ", "").strip()
    match = re.fullmatch(r"(\w+)\s*(\**)\s*(\w+)((?:\[\w+\])*)", text)
    assert match, text
    kind = type_of(match[1], len(match[2]))
    for length in reversed(re.findall(r"\[(\w+)\]", match[4])):
        kind = kind * int(length)
    return match[3], kind


def members(body):
    for statement in filter(None, map(str.strip, body.split(";"))):
        first, *more = statement.split(",")
        yield declared(first)
        base = re.match(r"(?:const )?\w+", first)[0]
        for other in more:
            yield declared(f"{base} {other.strip()}")


@pytest.fixture(scope="module")
def header(pytestconfig):
    return without_comments((pytestconfig.rootpath / "src/library/tractrix.h").read_text())


def test_structs_are_those_of_the_header(header):
    structs = {name: list(members(body)) for body, name in re.findall(r"typedef struct \w+ \{(.*?)\} Tractrix(\w+);", header, re.S)}
    assert len(structs) > 8
    for name, fields in structs.items():
        assert getattr(_declarations, name)._fields_ == fields, name
        sized = fields[0] == ("size", ctypes.c_size_t)
        assert issubclass(getattr(_declarations, name), _declarations.Sized) == sized
        if sized:
            assert getattr(_declarations, name)().size == ctypes.sizeof(getattr(_declarations, name))


def test_functions_are_those_of_the_header(header):
    functions = {}
    for result, stars, name, arguments in re.findall(r"^(?:const )?(\w+)\s+(\**)(tractrix_\w+)\(([^)]*)\);", header, re.M):
        arguments = " ".join(arguments.split())
        kinds = [] if arguments == "void" else [declared(argument)[1] for argument in arguments.split(", ")]
        functions[name] = (type_of(result, len(stars)), kinds)
    assert len(functions) > 30
    for name, declaration in _declarations.FUNCTIONS.items():
        assert declaration == functions[name], name


def test_numbers_are_those_of_the_header(header):
    numbers = {name: int(value) for name, value in re.findall(r"TRACTRIX_(\w+) = (\d+)", header)}
    for name in ("FAILED", "USAGE", "BAD_INPUT", "NO_GL"):
        assert getattr(_error, name) == numbers[name]
    for name in ("RGBA8", "RGBA16", "RGBA32F", "GUIDES", "FOLLOWERS"):
        assert getattr(_declarations, name) == numbers[name]


def test_the_comparison_notices_a_change():
    assert list(members("size_t size; int at[2]; const float *a, *b;")) == [
        ("size", ctypes.c_size_t), ("at", ctypes.c_int * 2), ("a", ctypes.POINTER(ctypes.c_float)), ("b", ctypes.POINTER(ctypes.c_float))]
    assert declared("TractrixDevice **device")[1] == ctypes.POINTER(ctypes.c_void_p)
    assert declared("const TractrixImage *a")[1] == ctypes.POINTER(_declarations.Image)
    assert declared("TractrixPart part")[1] == ctypes.c_int


def test_the_library_says_its_version():
    version = _library.library().tractrix_version_number()
    assert _library.version().startswith(f"{version >> 16}.{version >> 8 & 255}.{version & 255}")
