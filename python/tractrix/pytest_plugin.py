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

# The plugin writes into its own folder PAIRS inside the results folder, which may contain other files. PAIRS has the
# images that differ from their golden images, both under the same name, and the page REPORT that shows them.
PAIRS, GOLDENS, IMAGES, REPORT = "tractrix-pairs", "goldens", "images", "report.html"
# The test that each image of this session belongs to, by the image's name among the pairs.
OWNERS: pytest.StashKey[dict[str, str]] = pytest.StashKey()


def pytest_addoption(parser: pytest.Parser) -> None:
    group = parser.getgroup("tractrix", "image regression with tractrix")
    group.addoption("--tractrix-update", action="store_true",
                    help="write golden images that are missing or differ; in this run their tests still fail")
    group.addoption("--tractrix-results", metavar="DIR",
                    help="folder for images that differ and for the HTML page that shows them; each run deletes its subfolder tractrix-pairs (default: tractrix-results in the root folder of pytest)")
    parser.addini("tractrix_goldens", "folder of golden images, relative to the folder of the test file", default="goldens")
    parser.addini("tractrix_results", "as --tractrix-results, relative to the root folder of pytest", default="tractrix-results")


def results_of(config: pytest.Config) -> pathlib.Path:
    given = config.getoption("--tractrix-results")
    return (pathlib.Path(given).absolute() if given else config.rootpath / config.getini("tractrix_results")) / PAIRS


def is_worker(config: pytest.Config) -> bool:
    """Whether this process is a worker of pytest-xdist. Only the controller deletes and reports results."""
    return hasattr(config, "workerinput")


def pytest_sessionstart(session: pytest.Session) -> None:
    session.config.stash[OWNERS] = {}
    if not is_worker(session.config):
        shutil.rmtree(results_of(session.config), ignore_errors=True)


class ImageCheck:
    """What the fixture `tractrix_image` returns."""

    def __init__(self, request: pytest.FixtureRequest) -> None:
        self._config = request.config
        self._goldens = request.path.parent / request.config.getini("tractrix_goldens") / request.path.stem
        classes = [node.name for node in request.node.listchain() if isinstance(node, pytest.Class)]
        self._test = ".".join([*classes, request.node.name])
        self._module = os.path.relpath(request.path.with_suffix(""), request.config.rootpath).replace(os.sep, ".")
        self._id = request.node.nodeid
        self._names: set[str] = set()

    def check(self, image: ImageLike, *, name: str | None = None, mask: ImageLike | None = None,
              pixel_tolerance: float | None = None, max_failing_percent: float | None = None,
              max_flip: float | None = None, max_difference: float | None = None,
              max_local_difference: float | None = None) -> None:
        """Fails unless `image` matches its golden within the limits of tractrix.compare. Without limits the two must be
        equal. The golden is goldens/MODULE/TEST.png in the folder of the test file, TEST-NAME.png if `name` is given,
        and .exr for an image of floats. A missing golden is a failure; only --tractrix-update writes goldens."""
        __tracebackhide__ = True
        from . import compare
        from ._image import read_image, rgba

        new = rgba("image", image)
        file = file_name(self._test, name) + (".exr" if new.dtype.kind == "f" else ".png")
        if file in self._names:
            pytest.fail(f"{file}: this test has already checked an image: expected a different name=... for each image")
        self._names.add(file)
        golden = self._goldens / file
        owner = self._config.stash[OWNERS].setdefault(self._flat(golden), self._id)
        if owner != self._id:
            pytest.fail(f"{file}: {owner} has a golden of the same name: expected another name of the test, other parameters or name=...")
        if not golden.exists():
            self._fail(golden, new, "no golden")
        old = read_image(golden)
        if old.shape != new.shape:
            self._fail(golden, new, f"{new.shape[1]}x{new.shape[0]}, but the golden has {old.shape[1]}x{old.shape[0]}")
        if old.dtype != new.dtype:
            self._fail(golden, new, f"{new.dtype}, but the golden has {old.dtype}")
        result = compare(new, old, mask=mask, pixel_tolerance=pixel_tolerance, max_failing_percent=max_failing_percent,
                         max_flip=max_flip, max_difference=max_difference, max_local_difference=max_local_difference)
        if not result.within:
            self._fail(golden, new, f"{result.failing} of {result.compared} pixels differ, at most by {result.largest:.3g} levels at "
                                    f"{result.at[0]},{result.at[1]}, FLIP {result.flip:.4f}")

    def _flat(self, golden: pathlib.Path) -> str:
        """The file name of a golden in PAIRS: FOLDER.MODULE.TEST.png, where FOLDER is the folder of the test file. It is
        unique over all test files."""
        return f"{file_name(self._module, None)}.{golden.name}"

    def _fail(self, golden: pathlib.Path, new: Any, what: str) -> None:
        __tracebackhide__ = True
        from ._image import write_image

        shown = os.path.relpath(golden, self._config.rootpath)
        if self._config.getoption("--tractrix-update"):
            golden.parent.mkdir(parents=True, exist_ok=True)
            if golden.is_symlink() or golden.parent.is_symlink():
                pytest.fail(f"{shown}: {what}: not written: a symbolic link, which is not followed: expected a plain file", pytrace=False)
            write_image(golden, new)
            pytest.fail(f"{shown}: {what}: golden written: look at it, commit it, and run again", pytrace=False)
        results = results_of(self._config)
        flat = self._flat(golden)
        for folder in (GOLDENS, IMAGES):
            (results / folder).mkdir(parents=True, exist_ok=True)
        write_image(results / IMAGES / flat, new)
        if golden.exists():
            shutil.copyfile(golden, results / GOLDENS / flat)
        pytest.fail(f"{shown}: {what}: expected the same image (the new one is {results / IMAGES / flat}; --tractrix-update makes it the golden)",
                    pytrace=False)


def file_name(test: str, name: str | None) -> str:
    """A golden's file name without suffix, with characters that all file systems allow."""
    return re.sub(r"[^A-Za-z0-9._-]+", "_", test if name is None else f"{test}-{name}").strip("_")


@pytest.fixture
def tractrix_image(request: pytest.FixtureRequest) -> ImageCheck:
    """`tractrix_image.check(image, max_flip=0.02)` fails unless the image matches its golden within the limits."""
    return ImageCheck(request)


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter, config: pytest.Config) -> None:
    results = results_of(config)
    if is_worker(config) or not (results / IMAGES).is_dir():
        return
    count = len(list((results / IMAGES).iterdir()))
    line = f"tractrix: {count} image{'s that differ' if count > 1 else ' that differs'}: {results}"
    try:
        write_report(results)
        line += os.sep + REPORT
    except FileNotFoundError:
        line += f" (no page: {COMPARE} is not in PATH, TRACTRIX_BIN or the package)"
    except subprocess.CalledProcessError as error:
        line += f" (no page: {error.stderr.strip()})"
    terminalreporter.section("images")
    terminalreporter.line(line)


COMPARE = "tractrix-compare"


def compare_program() -> str:
    """The path of tractrix-compare: in this package (in wheels), in TRACTRIX_BIN or in PATH."""
    beside = pathlib.Path(__file__).with_name(COMPARE)
    if beside.exists():
        return str(beside)
    folder = os.environ.get("TRACTRIX_BIN")
    return os.path.join(folder, COMPARE) if folder else COMPARE


def write_report(results: pathlib.Path) -> None:
    """Writes the HTML page. No limits are given, since all images in PAIRS have already failed their tests."""
    done = subprocess.run([compare_program(), "-q", str(results / GOLDENS), str(results / IMAGES), "--html", str(results / REPORT)],
                          stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, check=False)
    if done.returncode > 1:  # 1: images differ
        raise subprocess.CalledProcessError(done.returncode, done.args, stderr=done.stderr)
