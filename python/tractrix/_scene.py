# SPDX-License-Identifier: MIT
"""The input of a simulation: strands, mesh and parameters."""

from __future__ import annotations

import ctypes
import json
import os
from ctypes import c_float, c_uint32
from typing import Any, Mapping, Sequence, Tuple, Union

import numpy as np

from . import _arrays
from ._declarations import Mesh, Strands
from ._error import usage
from ._library import Handle, call
from ._values import bytes_of, text_of

# (S, V, 3), a list of (V, 3), (points, sizes), the path of a hair or scene file, or what a scene file holds.
StrandsLike = Union[np.ndarray, Sequence[np.ndarray], "tuple[np.ndarray, np.ndarray]", str, "os.PathLike[str]", Mapping[str, Any]]
MeshArrays = Tuple[np.ndarray, np.ndarray]  # vertices, triangles
# (vertices, triangles), or a path, or {body: (vertices, triangles)} for a scene of several bodies; or a mesh of trimesh.
MeshLike = Union[MeshArrays, Mapping[int, MeshArrays], str, "os.PathLike[str]", Any]

OF_ARRAYS = ("thickness", "color", "uv")


def is_path(value: Any) -> bool:
    return isinstance(value, (str, os.PathLike))


def scene_of(strands: StrandsLike, mesh: MeshLike | None, deforms: bool, parameters: Mapping[str, Any]) -> Handle:
    """Creates a scene. If `strands` are arrays, `parameters` must contain `unit`, and may contain `up` and arrays for
    `thickness`, `color` and `uv`."""
    given = {name: value for name, value in parameters.items() if value is not None}
    if isinstance(strands, Mapping):
        scene = Handle("tractrix_scene_parse", "tractrix_scene_destroy", _text_of(strands), None)
    elif is_path(strands):
        scene = Handle("tractrix_scene_read", "tractrix_scene_destroy", bytes_of("strands", strands))
    else:
        look = given.pop("look", None)
        scene = Handle("tractrix_scene_create", "tractrix_scene_destroy", None if look is None else bytes_of("look", text_of("look", look)))
        _add_strands(scene, strands, given)
    if mesh is not None and not is_path(mesh):
        _set_meshes(scene, mesh, deforms, given, parameters)
    elif deforms:
        raise usage("deforms: has no effect: expected mesh=(vertices, triangles) with it")
    elif mesh is not None:
        given["mesh"] = mesh
    for name, value in given.items():
        call("tractrix_scene_set", scene.value, -1, bytes_of("a parameter", name), bytes_of(name, text_of(name, value)))
    return scene


def _text_of(scene: Mapping[str, Any]) -> bytes:
    """A scene file's text. Paths of pathlib and numbers of numpy may occur in it."""
    try:
        return json.dumps(scene, default=lambda value: os.fspath(value) if is_path(value) else value.tolist()).encode()
    except (AttributeError, TypeError, ValueError) as error:
        raise usage(f"strands: {error}: expected a dict with what a scene file may hold") from None


def _add_strands(scene: Handle, strands: Any, given: dict[str, Any]) -> None:
    points, sizes = _arrays.strands(strands)
    unit, up = given.pop("unit", None), given.pop("up", None)
    parts = {name: given.pop(name) for name in OF_ARRAYS if name in given and (name != "color" or _is_array(given[name]))}
    thickness, color, uv = (parts.get(name) for name in OF_ARRAYS)
    if thickness is not None:
        thickness = _arrays.numbers("thickness", _arrays.array_of("thickness", thickness).ravel(), (len(points),))
    if color is not None:
        color = _arrays.array_of("color", color)
        color = _arrays.numbers("color", color.reshape(-1, color.shape[-1]), (len(points), None))
        if color.shape[1] not in (3, 4):
            raise usage(f"color: {color.shape[1]} numbers for each vertex: expected 3 or 4: linear RGB, or RGB and opacity")
        color = np.hstack((color, np.ones((len(color), 4 - color.shape[1]), np.float32)))
    if uv is not None:
        uv = _arrays.numbers("uv", uv, (len(sizes), 2))
    call("tractrix_scene_add_strands", scene.value, None,
         ctypes.byref(Strands(metres_per_unit=_arrays.metres("unit", unit), up_z=_arrays.up_z("up", up),
                              strand_count=len(sizes), sizes=_arrays.pointer(sizes, c_uint32),
                              position=_arrays.pointer(points, c_float), thickness=_arrays.pointer(thickness, c_float),
                              color=_arrays.pointer(color, c_float), uv=_arrays.pointer(uv, c_float))))


def _set_meshes(scene: Handle, mesh: Any, deforms: bool, given: dict[str, Any], parameters: Mapping[str, Any]) -> None:
    unit, up = given.pop("mesh_unit", parameters.get("unit")), given.pop("mesh_up", parameters.get("up"))
    if not isinstance(mesh, Mapping):
        made = _mesh("mesh", mesh, deforms, unit, up, "(vertices, triangles), a path, or {body: (vertices, triangles)}")
        call("tractrix_scene_set_mesh", scene.value, ctypes.byref(made))
        return
    if not mesh:
        raise usage("mesh: got {}: expected {body: (vertices, triangles)} for one body or more")
    for body, arrays in mesh.items():
        made = _mesh(f"mesh[{body!r}]", arrays, deforms, unit, up, "(vertices, triangles)")
        call("tractrix_scene_set_body_mesh", scene.value, _arrays.index("mesh", body), ctypes.byref(made))


def _mesh(name: str, mesh: Any, deforms: bool, unit: Any, up: Any, expected: str) -> Mesh:
    if hasattr(mesh, "vertices") and hasattr(mesh, "faces"):  # of trimesh
        mesh = mesh.vertices, mesh.faces
    if not isinstance(mesh, (tuple, list)) or len(mesh) != 2:
        raise usage(f"{name}: got {type(mesh).__name__}: expected {expected}")
    vertices = _arrays.numbers(f"{name}[0]", mesh[0], (None, 3))
    triangles = _arrays.numbers(f"{name}[1]", mesh[1], (None, 3), np.uint32)
    made = Mesh(metres_per_unit=_arrays.metres("mesh_unit", unit), up_z=_arrays.up_z("mesh_up", up), deforms=deforms,
                vertex_count=len(vertices), triangle_count=len(triangles),
                position=_arrays.pointer(vertices, c_float), triangle=_arrays.pointer(triangles, c_uint32))
    made.arrays = vertices, triangles  # they must live as long as the pointers to them
    return made


def _is_array(value: Any) -> bool:
    """Whether `value` has a color for each vertex and is not a value of the parameter `color` ("auburn", (1, 0, 0)). A
    strand has at least 2 vertices, so colors of vertices are at least 6 numbers."""
    return not is_path(value) and _arrays.array_of("color", value).size > 4
