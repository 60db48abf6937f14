# SPDX-License-Identifier: MIT
"""Tractrix: simulates and draws hair, and compares images, on numpy arrays. docs/python.md shows how."""

from ._compare import Comparison, compare
from ._device import describe_device, select_device
from ._error import TractrixError, TractrixValueError
from ._image import read_image, write_image
from ._library import set_threads, version
from ._simulation import Simulation, render, simulate
from ._values import Parameter, parameters

__all__ = ["Comparison", "Parameter", "Simulation", "TractrixError", "TractrixValueError", "compare", "describe_device",
           "parameters", "read_image", "render", "select_device", "set_threads", "simulate", "version", "write_image"]
