# SPDX-License-Identifier: MIT
"""Converts arrays of the caller to the library's form: contiguous, 32 bits, with a known shape."""

from __future__ import annotations

import ctypes
import operator
from typing import Any

import numpy as np

from ._error import BAD_INPUT, error_of, usage


def array_of(name: str, value: Any) -> np.ndarray:
    try:
        return np.asarray(value)
    except ValueError:
        raise usage(f"{name}: rows of different lengths: expected an array of numbers") from None


def numbers(name: str, value: Any, shape: tuple[int | None, ...], dtype: Any = np.float32) -> np.ndarray:
    """Converts `value` to an array of `dtype`. It must already have `shape`, where None stands for any length."""
    try:
        array = np.asarray(value)
        if array.dtype.kind not in ("iu" if np.dtype(dtype).kind in "iu" else "iuf"):
            raise ValueError
    except ValueError:
        raise usage(f"{name}: got {type(value).__name__}: expected an array of "
                    f"{'whole ' if np.dtype(dtype).kind in 'iu' else ''}numbers of shape {words(shape)}") from None
    if array.ndim != len(shape) or any(want not in (None, have) for want, have in zip(shape, array.shape)):
        raise usage(f"{name}: shape {array.shape}: expected {words(shape)}")
    limits = np.iinfo(dtype) if np.dtype(dtype).kind in "iu" else None
    if limits and array.size and (array.min() < limits.min or array.max() > limits.max):
        raise error_of(BAD_INPUT, f"{name}: {array.min()} to {array.max()}: expected {limits.min} to {limits.max}")
    return np.ascontiguousarray(array, dtype)


def index(name: str, value: Any) -> int:
    """An index, from 0."""
    try:
        number = operator.index(value)
    except TypeError:
        number = -1
    if not 0 <= number < 2**32:
        raise usage(f"{name}: got {value!r}: expected a number from 0")
    return number


def words(shape: tuple[int | None, ...]) -> str:
    inside = ", ".join("N" if length is None else str(length) for length in shape)
    return f"({inside},)" if len(shape) == 1 else f"({inside})"


def pointer(array: np.ndarray | None, kind: Any) -> Any:
    """A pointer to the first number, valid as long as the array. NULL for None."""
    return None if array is None else array.ctypes.data_as(ctypes.POINTER(kind))


def strands(value: Any) -> tuple[np.ndarray, np.ndarray]:
    """Converts strands to two arrays: the positions (V, 3) of all strands, concatenated, and the number of vertices of
    each strand. `value` is (S, V, 3), a list of (V, 3), or (points, sizes). Positions may have a fourth number, as
    those that simulate() yields; it is ignored."""
    if isinstance(value, tuple) and len(value) == 2 and array_of("strands[1]", value[1]).ndim == 1:
        points, sizes = points_of("strands[0]", value[0]), numbers("strands[1]", value[1], (None,), np.uint32)
        if sizes.sum(dtype=np.uint64) != len(points):
            raise error_of(BAD_INPUT, f"strands: the sizes add up to {sizes.sum(dtype=np.uint64)}: expected {len(points)}, the number of points")
        return points, sizes
    if isinstance(value, (list, tuple)):
        pieces = [points_of(f"strands[{index}]", piece) for index, piece in enumerate(value)]
        if not pieces:
            raise usage("strands: an empty list: expected at least one strand")
        return np.concatenate(pieces), np.array([len(piece) for piece in pieces], np.uint32)
    array = array_of("strands", value)
    if array.ndim != 3 or array.shape[2] not in (3, 4):
        raise usage(f"strands: shape {array.shape}: expected (S, V, 3), a list of (V, 3), (points, sizes) or a path")
    return points_of("strands", array.reshape(-1, array.shape[2])), np.full(len(array), array.shape[1], np.uint32)


def points_of(name: str, value: Any) -> np.ndarray:
    array = array_of(name, value)
    return numbers(name, array[:, :3] if array.ndim == 2 and array.shape[1] == 4 else array, (None, 3))


# The length of each unit of --unit, in metres.
_METRES = {"m": 1.0, "cm": 0.01, "mm": 0.001, "in": 0.0254}


def metres(name: str, unit: Any) -> float:
    if unit is None:
        raise usage(f"{name}: not given: expected m, cm, mm, in or a number of metres, because an array does not state its unit")
    length = _METRES.get(unit) if isinstance(unit, str) else unit
    if not isinstance(length, (int, float, np.number)) or not 0 < length < np.inf:
        raise usage(f"{name}: got {unit!r}: expected m, cm, mm, in or a number of metres")
    return float(length)


def up_z(name: str, up: str | None) -> bool:
    if up not in (None, "y", "z"):
        raise usage(f"{name}: got {up!r}: expected y or z")
    return up == "z"
