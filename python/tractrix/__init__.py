# SPDX-License-Identifier: MIT
"""Tractrix: simulates and draws hair, and compares images, on numpy arrays. docs/python.md shows how."""

from ._compare import Comparison, compare
from ._device import describe_device, select_device
from ._error import TractrixError, TractrixFileNotFoundError, TractrixValueError
from ._image import read_image, write_image
from ._library import set_threads, version
from ._simulation import Layered, Simulation, render, simulate
from ._values import Parameter, parameters

__all__ = ["Comparison", "Layered", "Parameter", "Simulation", "TractrixError", "TractrixFileNotFoundError",
           "TractrixValueError", "compare", "describe_device",
           "parameters", "read_image", "render", "select_device", "set_threads", "simulate", "version", "write_image"]


def __getattr__(name: str) -> str:
    """`__version__` is that of the loaded library."""
    if name == "__version__":
        return version()
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
