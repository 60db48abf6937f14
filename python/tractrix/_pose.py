# SPDX-License-Identifier: MIT
"""The pose of a head: a matrix, or a quaternion and a translation."""

from __future__ import annotations

from typing import Any, Union

import numpy as np

from . import _arrays
from ._declarations import Pose
from ._error import usage

# A rigid (4, 4) matrix, or ((x, y, z, w), (x, y, z)); a rotation may also be a Rotation of scipy.
PoseLike = Union[np.ndarray, "tuple[Any, np.ndarray]", Any]

ROUNDING = 1e-4  # tolerance: rounding errors of a product of some float32 matrices


def pose_of(value: PoseLike) -> Pose:
    if hasattr(value, "as_quat"):
        value = value, (0.0, 0.0, 0.0)
    if isinstance(value, (tuple, list)) and len(value) == 2:
        turn = value[0].as_quat() if hasattr(value[0], "as_quat") else value[0]
        rotation = _arrays.numbers("head[0]", turn, (4,), np.float64)
        translation = _arrays.numbers("head[1]", value[1], (3,), np.float64)
        return Pose(rotation=tuple(rotation), translation=tuple(translation))
    matrix = _arrays.numbers("head", value, (4, 4), np.float64)
    turn = matrix[:3, :3]
    if not np.allclose(turn @ turn.T, np.eye(3), atol=ROUNDING) or np.linalg.det(turn) < 0 or not np.allclose(matrix[3], (0, 0, 0, 1)):
        raise usage("head: not rigid: expected a matrix that turns and moves without scale, last row 0 0 0 1")
    return Pose(rotation=tuple(quaternion(turn)), translation=tuple(matrix[:3, 3]))


def quaternion(turn: np.ndarray) -> np.ndarray:
    """The quaternion x y z w of a rotation matrix: an eigenvector of Bar-Itzhack's symmetric matrix (J. Guidance 23(6),
    2000). For a matrix with rounding errors this gives the nearest rotation."""
    m = turn
    k = np.array([
        [m[0, 0] - m[1, 1] - m[2, 2], m[1, 0] + m[0, 1], m[2, 0] + m[0, 2], m[2, 1] - m[1, 2]],
        [0, m[1, 1] - m[0, 0] - m[2, 2], m[2, 1] + m[1, 2], m[0, 2] - m[2, 0]],
        [0, 0, m[2, 2] - m[0, 0] - m[1, 1], m[1, 0] - m[0, 1]],
        [0, 0, 0, m[0, 0] + m[1, 1] + m[2, 2]]])
    return np.linalg.eigh(k.T)[1][:, -1]  # eigh reads the lower triangle; the largest eigenvalue comes last
