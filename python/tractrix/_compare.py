# SPDX-License-Identifier: MIT
"""Compares two images."""

from __future__ import annotations

import ctypes
import sys
from typing import NamedTuple

import numpy as np

from ._arrays import pointer
from ._declarations import Figures, Limits
from ._error import usage
from ._image import ImageLike, image_of, rgba
from ._library import call


class Comparison(NamedTuple):
    """The result of `compare`; docs/compare.md defines the figures.

    `within`: the images are within the limits; `same` is an older name for it. `equal`: there is no visible difference. `compared`: number of pixels that were compared; `failing`: how
    many of them failed. `largest`: the largest difference of a channel, in levels of 0 to 255; `at`: (x, y) of the
    first pixel with this difference. `rmse` is in levels, `psnr` in dB. `flip` is the mean of FLIP, `flip_most` its
    largest value. For equal images `rmse` and `flip` are 0, `ssim` is 1 and `psnr` is infinite. `map`: FLIP's error of
    each pixel, (H, W) float32, NaN where the mask excludes the pixel. `local_difference`: the largest mean difference of
    a channel over 16 x 16 pixels, in levels; `local_at`: (x, y) of their top left pixel."""

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
    within: bool
    equal: bool
    local_difference: float
    local_at: tuple[int, int]


def limits(pixel_tolerance: float | None = None, max_failing_percent: float | None = None,
           max_flip: float | None = None, pixels_per_degree: float | None = None, max_difference: float | None = None,
           max_local_difference: float | None = None) -> Limits:
    """The library's limits for the arguments of `compare`, with the rules of tractrix-compare: without arguments,
    images must be equal; limits other than those for failing pixels can be the only ones."""
    for name, value in (("pixel_tolerance", pixel_tolerance), ("max_failing_percent", max_failing_percent),
                        ("max_flip", max_flip), ("pixels_per_degree", pixels_per_degree),
                        ("max_difference", max_difference), ("max_local_difference", max_local_difference)):
        if value is not None and not value >= 0:
            raise usage(f"{name}: got {value}: expected a number from 0")
    if max_difference == 0 or max_flip == 0:  # only equal images pass, but to the library 0 means "no limit"
        pixel_tolerance = max_failing_percent = max_flip = max_difference = None
    if max_local_difference == 0:
        max_local_difference = sys.float_info.min
    others = max_flip is not None or max_difference is not None or max_local_difference is not None
    pixels = not others or pixel_tolerance is not None or max_failing_percent is not None
    return Limits(pixel_tolerance=(pixel_tolerance or 0) if pixels else -1,
                  max_failing_percent=max_failing_percent or 0,
                  max_flip=-1 if max_flip is None else max_flip, pixels_per_degree=pixels_per_degree or 0,
                  max_difference=max_difference or 0, max_local_difference=max_local_difference or 0)


def compare(image: ImageLike, golden: ImageLike, *, mask: ImageLike | None = None, pixel_tolerance: float | None = None,
            max_failing_percent: float | None = None, max_flip: float | None = None,
            pixels_per_degree: float | None = None, max_difference: float | None = None,
            max_local_difference: float | None = None) -> Comparison:
    """Compares two images of equal size: arrays (H, W), (H, W, 3), (H, W, 4) of uint8, uint16 or floats, or paths.
    Alpha is compared, too. White (or True) pixels of a `mask` are compared, black pixels are not. The limits are those of
    tractrix-compare: a pixel passes if no channel differs by more than `pixel_tolerance` levels of 255; an image passes
    if at most `max_failing_percent` of its pixels fail, its mean FLIP is at most `max_flip`, no channel differs by more
    than `max_difference` levels, and none by more than `max_local_difference` in the mean over any 16 x 16 pixels. Raises
    TractrixError(2) if the sizes differ, TractrixError(3) for NaN and infinity."""
    a, b = rgba("golden", golden), rgba("image", image)
    masked = None if mask is None else rgba("mask", mask)
    figures = Figures()
    flip_map = np.empty(b.shape[:2], np.float32)
    wanted = limits(pixel_tolerance, max_failing_percent, max_flip, pixels_per_degree, max_difference, max_local_difference)
    call("tractrix_compare", ctypes.byref(figures), pointer(flip_map, ctypes.c_float), ctypes.byref(image_of(a)),
         ctypes.byref(image_of(b)), None if masked is None else ctypes.byref(image_of(masked)), ctypes.byref(wanted))
    return Comparison(figures.same, figures.compared, figures.failing, figures.largest, tuple(figures.at), figures.rmse,
                      figures.psnr, figures.ssim, figures.flip, figures.flip_most, flip_map, figures.within, figures.equal,
                      figures.local_difference, tuple(figures.local_at))
