# SPDX-License-Identifier: MIT
"""The device of this process. There is one; it is opened when it is first needed."""

from __future__ import annotations

import ctypes

from ._declarations import DeviceOptions
from ._error import usage
from ._library import Handle, library, lock
from ._values import bytes_of

_options: tuple[str | None, bool, bool] = (None, False, False)
_device: Handle | None = None

_TEXTS = ("renderer", "version", "vendor", "processor", "path", "pci", "uuid", "node", "passed-over")


def device() -> Handle:
    global _device
    with lock:
        if _device is None:
            name, software, require_hardware = _options
            options = DeviceOptions(name=bytes_of("name", name) if name is not None else None, software=software,
                                    require_hardware=require_hardware)
            _device = Handle("tractrix_device_open", "tractrix_device_destroy", ctypes.byref(options))
        return _device


def select_device(name: str | None = None, *, software: bool = False, require_hardware: bool = False) -> None:
    """Chooses the device for simulating and rendering. Call it before the first simulation or image; otherwise the best
    device is used. `name`: a device number, a part of its name, its PCI address, node or UUID, as for tractrix-render
    --device; `software`: use only CPU drivers; `require_hardware`: never use a CPU driver. Raises TractrixError with
    code 2 if a device with other options is already open."""
    global _options
    with lock:
        if _device is not None and _options != (name, software, require_hardware):
            raise usage("select_device: a device is open already: expected the call before the first image or simulation")
        _options = (name, software, require_hardware)


def describe_device() -> dict[str, str]:
    """The known properties of the device: `renderer`, `version`, `vendor`, `processor`, `path` (how the OpenGL context
    was made), `pci`, `uuid`, `node`, and `passed-over` (why no GPU is used although there are signs of one). Opens the
    device if it is not open yet."""
    with lock:
        texts = {what: library().tractrix_device_text(device().value, what.encode()).decode() for what in _TEXTS}
    return {what: text for what, text in texts.items() if text}
