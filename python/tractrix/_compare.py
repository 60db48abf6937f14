# SPDX-License-Identifier: MIT
"""Compares two images."""

from __future__ import annotations

import ctypes
from typing import NamedTuple

import numpy as np

from ._arrays import pointer
from ._declarations import Figures, Limits
from ._error import usage
from ._image import ImageLike, image_of, rgba
from ._library import call


class Comparison(NamedTuple):
    """The result of `compare`; docs/compare.md defines the figures.

    `same`: the images are the same within the limits. `compared`: number of pixels that were compared; `failing`: how
    many of them failed. `largest`: the largest difference of a channel, in levels of 0 to 255; `at`: (x, y) of the
    first pixel with this difference. `rmse` is in levels, `psnr` in dB. `flip` is the mean of FLIP, `flip_most` its
    largest value. For equal images `rmse` and `flip` are 0, `ssim` is 1 and `psnr` is infinite. `map`: FLIP's error of
    each pixel, (H, W) float32, NaN where the mask excludes the pixel."""

    same: bool
    compared: int
    failing: int
    largest: float
    at: tuple[int, int]
    rmse: float
    psnr: float
    ssim: float
    flip: float
    flip_most: float
    map: np.ndarray


def limits(pixel_tolerance: float | None = None, max_failing_percent: float | None = None,
           max_flip: float | None = None, pixels_per_degree: float | None = None) -> Limits:
    """The library's limits for the arguments of `compare`, with the rules of tractrix-compare: without arguments,
    images must be equal; if only `max_flip` is given, it is the only limit."""
    for name, value in (("pixel_tolerance", pixel_tolerance), ("max_failing_percent", max_failing_percent),
                        ("max_flip", max_flip), ("pixels_per_degree", pixels_per_degree)):
        if value is not None and not value >= 0:
            raise usage(f"{name}: got {value}: expected a number from 0")
    if max_flip == 0:  # only equal images pass, but to the library max_flip 0 means "no limit"
        pixel_tolerance = max_failing_percent = max_flip = None
    pixels = max_flip is None or pixel_tolerance is not None or max_failing_percent is not None
    return Limits(pixel_tolerance=(pixel_tolerance or 0) if pixels else -1,
                  max_failing_percent=max_failing_percent or 0,
                  max_flip=-1 if max_flip is None else max_flip, pixels_per_degree=pixels_per_degree or 0)


def compare(image: ImageLike, golden: ImageLike, *, mask: ImageLike | None = None, pixel_tolerance: float | None = None,
            max_failing_percent: float | None = None, max_flip: float | None = None,
            pixels_per_degree: float | None = None) -> Comparison:
    """Compares two images of equal size: arrays (H, W), (H, W, 3), (H, W, 4) of uint8, uint16 or floats, or paths.
    Alpha is compared, too. White pixels of a `mask` are compared, black pixels are not. The limits are those of
    tractrix-compare: a pixel passes if no channel differs by more than `pixel_tolerance` levels of 255; an image passes
    if at most `max_failing_percent` of its pixels fail and its mean FLIP is at most `max_flip`. Raises TractrixError(2)
    if the sizes differ."""
    a, b = rgba("golden", golden), rgba("image", image)
    masked = None if mask is None else rgba("mask", mask)
    figures = Figures()
    flip_map = np.empty(b.shape[:2], np.float32)
    wanted = limits(pixel_tolerance, max_failing_percent, max_flip, pixels_per_degree)
    call("tractrix_compare", ctypes.byref(figures), pointer(flip_map, ctypes.c_float), ctypes.byref(image_of(a)),
         ctypes.byref(image_of(b)), None if masked is None else ctypes.byref(image_of(masked)), ctypes.byref(wanted))
    return Comparison(figures.same, figures.compared, figures.failing, figures.largest, tuple(figures.at), figures.rmse,
                      figures.psnr, figures.ssim, figures.flip, figures.flip_most, flip_map)
