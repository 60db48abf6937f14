# SPDX-License-Identifier: MIT
"""The version is TRACTRIX_VERSION or that of the Makefile. If scripts/make-wheel has put the library beside the module,
the wheel is for the platform TRACTRIX_PLATFORM; otherwise it is for all platforms and uses the system's
libtractrix.so.0."""

import os
import pathlib
import re

from setuptools import Distribution, setup
from wheel.bdist_wheel import bdist_wheel

HERE = pathlib.Path(__file__).resolve().parent
PLATFORM = os.environ.get("TRACTRIX_PLATFORM")


def version() -> str:
    return os.environ.get("TRACTRIX_VERSION") or re.search(r"^VERSION := (.*)$", (HERE.parent / "Makefile").read_text(), re.M)[1]


class Bundled(Distribution):
    """A distribution with files for one platform."""

    def has_ext_modules(self) -> bool:
        return bool(PLATFORM)


class Wheel(bdist_wheel):
    """Tags the wheel for every Python 3, because it has no extension module."""

    def get_tag(self) -> "tuple[str, str, str]":
        return "py3", "none", PLATFORM or "any"


setup(version=version(), distclass=Bundled, cmdclass={"bdist_wheel": Wheel})
