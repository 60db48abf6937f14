# SPDX-License-Identifier: MIT
"""Progress of long calls, and Ctrl-C during them."""

from __future__ import annotations

import ctypes
import os
import select
import signal
import threading
from typing import Any, Callable

from ._declarations import Progress
from ._device import device
from ._library import library


class Watch:
    """While it is entered, long calls of the library tell `progress` the share that is done, from 0 to 1. They end early
    if `progress` raises an exception, which is then raised here, and when the main thread gets a signal: Python's
    handlers run only between calls, so a thread that waits in the library would not notice Ctrl-C."""

    def __init__(self, progress: Callable[[float], Any] | None) -> None:
        self._progress = progress
        self._raised: BaseException | None = None
        self._signals: tuple[int, int] | None = None
        self._before = -1
        self._function = Progress(self._step)

    def __enter__(self) -> Watch:
        if threading.current_thread() is threading.main_thread():
            self._signals = os.pipe()
            for end in self._signals:
                os.set_blocking(end, False)
            self._before = signal.set_wakeup_fd(self._signals[1], warn_on_full_buffer=False)
        library().tractrix_device_set_progress(device().value, self._function, None)
        return self

    def __exit__(self, *_: object) -> None:
        library().tractrix_device_set_progress(device().value, Progress(), None)
        if self._signals:
            signal.set_wakeup_fd(self._before)
            for end in self._signals:
                os.close(end)
        if self._raised:
            raise self._raised

    def _step(self, _: Any, share: float) -> bool:
        try:
            if self._signals and select.select([self._signals[0]], [], [], 0)[0]:
                self._pass_on()
                return False
            if self._progress:
                self._progress(share)
        except BaseException as error:  # pylint: disable=broad-exception-caught # it is raised in the caller's thread
            self._raised = error
            return False
        return True

    def _pass_on(self) -> None:
        """Gives the signals' numbers to the file that got them before."""
        assert self._signals
        numbers = os.read(self._signals[0], 4096)
        if self._before >= 0:
            os.write(self._before, numbers)
