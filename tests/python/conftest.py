# SPDX-License-Identifier: MIT
import numpy as np
import pytest

import tractrix

pytest_plugins = ["pytester"]


@pytest.fixture(scope="session", autouse=True)
def software():
    """The CPU's driver: the same everywhere."""
    tractrix.select_device(software=True)


@pytest.fixture
def curls():
    """12 strands of 8 vertices, 0.2 m long, hanging from a circle, as (S, V, 3) in metres."""
    angle = np.linspace(0, 2 * np.pi, 12, endpoint=False)[:, None]
    down = np.linspace(0, 1, 8)[None, :]
    return np.stack((0.05 * np.cos(angle + down), -0.2 * down + 0 * angle, 0.05 * np.sin(angle + down)), axis=2)
