# SPDX-License-Identifier: MIT
"""Image regression tests in pytest: the fixture `tractrix_image` compares arrays with golden images. docs/python.md."""

from __future__ import annotations

import os
import pathlib
import re
import shutil
import subprocess
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from ._image import ImageLike

# Of a folder of results: pairs that differ, as tractrix-compare pairs them, and the page that shows them.
GOLDENS, IMAGES, REPORT = "goldens", "images", "report.html"


def pytest_addoption(parser: pytest.Parser) -> None:
    group = parser.getgroup("tractrix", "image regression with tractrix")
    group.addoption("--tractrix-update", action="store_true",
                    help="write golden images that lack or differ; these tests fail all the same")
    group.addoption("--tractrix-results", metavar="DIR",
                    help="folder for images that differ and their page; made anew (default: tractrix-results in the root)")
    parser.addini("tractrix_goldens", "folder of golden images, from that of the test file", default="goldens")
    parser.addini("tractrix_results", "as --tractrix-results, from the root", default="tractrix-results")


def results_of(config: pytest.Config) -> pathlib.Path:
    given = config.getoption("--tractrix-results")
    return pathlib.Path(given).absolute() if given else config.rootpath / config.getini("tractrix_results")


def is_worker(config: pytest.Config) -> bool:
    """Of pytest-xdist, whose controller keeps the results."""
    return hasattr(config, "workerinput")


def pytest_sessionstart(session: pytest.Session) -> None:
    if is_worker(session.config):
        return
    results = results_of(session.config)
    for old in (GOLDENS, IMAGES):  # and nothing else: the folder may be anybody's
        shutil.rmtree(results / old, ignore_errors=True)
    (results / REPORT).unlink(missing_ok=True)


class ImageCheck:
    """What the fixture gives."""

    def __init__(self, request: pytest.FixtureRequest) -> None:
        self._config = request.config
        self._goldens = request.path.parent / request.config.getini("tractrix_goldens") / request.path.stem
        cls = f"{request.cls.__name__}." if request.cls else ""
        self._test = cls + request.node.name
        self._names: set[str] = set()

    def check(self, image: ImageLike, *, name: str | None = None, mask: ImageLike | None = None,
              pixel_tolerance: float | None = None, max_failing_percent: float | None = None,
              max_flip: float | None = None) -> None:
        """Fails unless `image` is its golden within the limits, which are those of tractrix.compare: without any, equal.
        The golden is goldens/MODULE/TEST.png beside the test file, TEST-NAME.png with a `name`, .exr for floats. A golden
        that lacks is a failure; only --tractrix-update writes one."""
        __tracebackhide__ = True
        from . import compare
        from ._image import read_image, rgba

        new = rgba("image", image)
        file = file_name(self._test, name) + (".exr" if new.dtype.kind == "f" else ".png")
        if file in self._names:
            pytest.fail(f"{file}: checked before in this test: expected name=... for each of several images")
        self._names.add(file)
        golden = self._goldens / file
        if not golden.exists():
            self._fail(golden, new, "no golden")
        old = read_image(golden)
        if old.shape != new.shape:
            self._fail(golden, new, f"{new.shape[1]}x{new.shape[0]}, its golden {old.shape[1]}x{old.shape[0]}")
        result = compare(new, old, mask=mask, pixel_tolerance=pixel_tolerance, max_failing_percent=max_failing_percent,
                         max_flip=max_flip)
        if not result.same:
            self._fail(golden, new, f"{result.failing} of {result.compared} pixels differ, most {result.largest:.3g} levels at "
                                    f"{result.at[0]},{result.at[1]}, FLIP {result.flip:.4f}")

    def _fail(self, golden: pathlib.Path, new: Any, what: str) -> None:
        __tracebackhide__ = True
        from ._image import write_image

        shown = os.path.relpath(golden, self._config.rootpath)
        if self._config.getoption("--tractrix-update"):
            golden.parent.mkdir(parents=True, exist_ok=True)
            write_image(golden, new)
            pytest.fail(f"{shown}: {what}: written anew: look at it, commit it, and run again", pytrace=False)
        results = results_of(self._config)
        flat = f"{golden.parent.name}.{golden.name}"
        for folder in (GOLDENS, IMAGES):
            (results / folder).mkdir(parents=True, exist_ok=True)
        write_image(results / IMAGES / flat, new)
        if golden.exists():
            shutil.copyfile(golden, results / GOLDENS / flat)
        pytest.fail(f"{shown}: {what}: expected the same image (new: {results / IMAGES / flat}; --tractrix-update accepts it)",
                    pytrace=False)


def file_name(test: str, name: str | None) -> str:
    """Of a golden, without suffix: what may be in a file's name everywhere."""
    return re.sub(r"[^A-Za-z0-9._-]+", "_", test if name is None else f"{test}-{name}").strip("_")


@pytest.fixture
def tractrix_image(request: pytest.FixtureRequest) -> ImageCheck:
    """`tractrix_image.check(image, max_flip=0.02)`: the image equals its golden within limits."""
    return ImageCheck(request)


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter, config: pytest.Config) -> None:
    results = results_of(config)
    if is_worker(config) or not (results / IMAGES).is_dir():
        return
    count = len(list((results / IMAGES).iterdir()))
    line = f"tractrix: {count} image{'s'[: count > 1]} that differ: {results}"
    try:
        write_report(results)
        line += os.sep + REPORT
    except FileNotFoundError:
        line += f" (no page: no {COMPARE} in PATH, TRACTRIX_BIN or the package)"
    except subprocess.CalledProcessError as error:
        line += f" (no page: {error.stderr.strip()})"
    terminalreporter.section("images")
    terminalreporter.line(line)


COMPARE = "tractrix-compare"


def compare_program() -> str:
    """That of this package (wheels), of TRACTRIX_BIN, or of PATH."""
    beside = pathlib.Path(__file__).with_name(COMPARE)
    if beside.exists():
        return str(beside)
    folder = os.environ.get("TRACTRIX_BIN")
    return os.path.join(folder, COMPARE) if folder else COMPARE


def write_report(results: pathlib.Path) -> None:
    """Every image in it has failed its test, so the page has no limits: what differs at all is different there."""
    done = subprocess.run([compare_program(), "-q", str(results / GOLDENS), str(results / IMAGES), "--html", str(results / REPORT)],
                          stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, check=False)
    if done.returncode > 1:  # 1: images differ
        raise subprocess.CalledProcessError(done.returncode, done.args, stderr=done.stderr)
