# SPDX-License-Identifier: MIT
"""Images as arrays (H, W, 4), and image files."""

from __future__ import annotations

import ctypes
import os
from typing import Any, Union

import numpy as np

from ._declarations import RGBA8, RGBA16, RGBA32F, Image, WriteOptions
from ._error import usage
from ._library import Handle, call, library
from ._values import bytes_of

FORMATS = {np.dtype(np.uint8): RGBA8, np.dtype(np.uint16): RGBA16, np.dtype(np.float32): RGBA32F}
DTYPES = {number: dtype for dtype, number in FORMATS.items()}

ImageLike = Union[np.ndarray, str, "os.PathLike[str]"]


def rgba(name: str, value: Any) -> np.ndarray:
    """An image as (H, W, 4): grey becomes RGB, images without alpha become opaque. A path is read. uint8 and uint16 are
    sRGB with straight alpha; floats are linear light with premultiplied alpha."""
    if isinstance(value, (str, os.PathLike)):
        return read_image(value)
    if isinstance(value, np.ma.MaskedArray):
        raise usage(f"{name}: a masked array: expected an array without a mask, and mask=... where images are compared")
    array = np.asarray(value)
    if array.dtype == bool:
        array = array.astype(np.uint8) * 255
    if array.dtype.kind == "f":
        array = array.astype(np.float32, copy=False)
    if array.dtype not in FORMATS:
        raise usage(f"{name}: {array.dtype}: expected uint8, uint16, bool, floats or a path")
    if array.ndim == 2:
        array = array[:, :, None]
    if array.ndim != 3 or array.shape[2] not in (1, 3, 4) or 0 in array.shape:
        raise usage(f"{name}: shape {array.shape}: expected (H, W), (H, W, 3) or (H, W, 4)")
    if array.shape[2] == 4:
        return np.ascontiguousarray(array)
    whole = np.empty((*array.shape[:2], 4), array.dtype)
    whole[:, :, :3] = array
    whole[:, :, 3] = 1 if array.dtype.kind == "f" else np.iinfo(array.dtype).max
    return whole


def image_of(array: np.ndarray) -> Image:
    """The library's view of an array (H, W, 4), which must outlive it."""
    return Image(width=array.shape[1], height=array.shape[0], format=FORMATS[array.dtype], pixels=array.ctypes.data)


def read_image(path: str | os.PathLike[str]) -> np.ndarray:
    """Reads a PNG, EXR or PFM file: (H, W, 4), uint8 or uint16 as in the file, or linear light as float32."""
    picture = Handle("tractrix_picture_read", "tractrix_picture_destroy", bytes_of("path", path))
    image = library().tractrix_picture_image(picture.value).contents
    dtype = DTYPES[image.format]
    row = image.width * 4 * dtype.itemsize
    stride = image.row_bytes or row
    rows = np.frombuffer((ctypes.c_char * (stride * (image.height - 1) + row)).from_address(image.pixels), np.uint8)
    array = np.lib.stride_tricks.as_strided(rows, (image.height, row), (stride, 1)).copy()
    picture.close()
    return array.view(dtype).reshape(len(array), -1, 4)


def write_image(path: str | os.PathLike[str], image: ImageLike, *, half: bool | None = None) -> None:
    """Writes an image file. The suffix of `path` decides the file format: .png for uint8 and uint16, .jpg for opaque
    uint8, .exr or .pfm for floats. If all pixels are opaque, the file has no alpha channel; a .pfm file never has
    one. EXR files hold 32 bits a channel, with `half` 16; None: 16 for arrays of float16. NaN and infinity are refused."""
    array = rgba("image", image)
    if half is None:
        half = isinstance(image, np.ndarray) and image.dtype == np.float16 and os.fspath(path).lower().endswith(".exr")
    call("tractrix_image_write_with", ctypes.byref(image_of(array)), bytes_of("path", path),
         ctypes.byref(WriteOptions(half=half)))
