# SPDX-License-Identifier: MIT
"""Loads libtractrix.so.0 at the first call, so that `import tractrix` does not fail if it is missing."""

from __future__ import annotations

import ctypes
import functools
import os
import pathlib
import threading
import weakref
from typing import Any

from ._declarations import FUNCTIONS, Error
from ._error import FAILED, error_of

SONAME = "libtractrix.so.0"
OLDEST = 0x000200  # the version that this module was written for; newer versions only add functions
# A device's handles may be used by one thread at a time, but ctypes lets other threads run during a call.
lock = threading.RLock()


@functools.lru_cache(maxsize=None)
def library() -> ctypes.CDLL:
    """TRACTRIX_LIBRARY, or the file beside this module (in wheels), or the system's library."""
    beside = pathlib.Path(__file__).with_name(SONAME)
    path = os.environ.get("TRACTRIX_LIBRARY") or (str(beside) if beside.exists() else SONAME)
    try:
        loaded = ctypes.CDLL(path)
    except OSError as error:
        raise error_of(FAILED, f"{path}: cannot be loaded ({error}): expected the package libtractrix0, a wheel with "
                               f"the library in it, or its path in TRACTRIX_LIBRARY") from None
    for name, (result, arguments) in FUNCTIONS.items():
        try:
            function = getattr(loaded, name)
        except AttributeError:
            raise error_of(FAILED, f"{path}: no {name}: expected version 0.2.0 or newer") from None
        function.restype, function.argtypes = result, arguments
    if loaded.tractrix_version_number() < OLDEST:
        raise error_of(FAILED, f"{path}: version {loaded.tractrix_version().decode()}: expected 0.2.0 or newer")
    return loaded


def call(name: str, *arguments: Any) -> None:
    """Calls a function that returns a TractrixResult and takes an error as the last argument. Raises TractrixError."""
    error = Error()
    code = getattr(library(), name)(*arguments, ctypes.byref(error))
    if code:
        raise error_of(code, error.text.decode("utf-8", "replace"))


def _destroy(function: Any, pointer: ctypes.c_void_p) -> None:
    with lock:
        function(pointer)


class Handle:
    """A pointer from the library. It is destroyed once: by close(), with its last reference, or when Python ends."""

    def __init__(self, create: str, destroy: str, *arguments: Any) -> None:
        self.value = ctypes.c_void_p()
        call(create, ctypes.byref(self.value), *arguments)
        self.close = weakref.finalize(self, _destroy, getattr(library(), destroy), self.value)


def version() -> str:
    """The version of the loaded library."""
    return library().tractrix_version().decode()


def set_threads(count: int) -> None:
    """Sets the number of threads that a call may use, 1 to 16. 0, the default: one for each processor that the process
    may use."""
    library().tractrix_set_threads(count)
