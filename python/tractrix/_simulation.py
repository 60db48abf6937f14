# SPDX-License-Identifier: MIT
"""Simulates and draws hair."""

from __future__ import annotations

import ctypes
import itertools
import os
import tempfile
from typing import TYPE_CHECKING, Any, Callable, Iterable, Iterator, List, Literal, NamedTuple, Union

import numpy as np

from . import _arrays
from ._declarations import FOLLOWERS, GUIDES, Layers, Positions, View
from ._device import device
from ._error import FAILED, error_of, usage
from ._image import FORMATS, image_of, write_image
from ._library import Handle, call, library, lock
from ._pose import PoseLike, pose_of
from ._progress import Watch
from ._scene import MeshLike, StrandsLike, scene_of
from ._values import bytes_of, text_of

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._parameters import Parameters

# (S, V, 4): x y z 1 in the world, m, root first; a list of (V, 4) if strands have different numbers of vertices.
PositionsLike = Union[np.ndarray, List[np.ndarray]]
Part = Literal["guides", "followers"]
PARTS = {"guides": GUIDES, "followers": FOLLOWERS}


def part_of(name: str) -> int:
    if name not in PARTS:
        raise usage(f"part: got {name!r}: expected guides or followers")
    return PARTS[name]


class Layered(NamedTuple):
    """An image and data of its pixels: `coverage`, the share that hair covers; `depth` of the strand in front, m from the eye;
    its `tangent` in the world, (H, W, 3); its number `strand`, as in EXR files of tractrix-render. Without a strand they are 0."""

    image: np.ndarray
    coverage: np.ndarray
    depth: np.ndarray
    tangent: np.ndarray
    strand: np.ndarray


class Simulation:
    """A simulation of hair. It starts at time 0; each `advance` simulates one frame.

    `strands` is the path of a hair file or scene file, a dict with what a scene file holds, or arrays of root-first vertices: (S, V, 3), a list of (V, 3),
    or (points, sizes). Arrays need `unit`. `mesh` is (vertices, triangles) or a path, or, for a scene of several
    bodies, a dict of (vertices, triangles) by the number of the body. With `deforms` you pass the vertices of the mesh
    to each `advance`. All other keywords are the parameters of tractrix-render (docs/options.md),
    with `_` for `-`. If `strands` are arrays, these parameters may be arrays: `thickness` (of each vertex, in any unit;
    a vertex with the mean thickness has the radius `radius`), `color` (of each vertex: linear RGB, or linear RGB and
    opacity) and `uv` (of each root). Raises TractrixError.

    `progress` is called during the warm-up (parameter `preroll`) with the share that is done, 0 to 1, on another thread; an
    exception that it raises ends the warm-up, as does Ctrl-C.

    Use `with` or close() to free the simulation; otherwise it is freed when its last reference is gone."""

    def __init__(self, strands: StrandsLike, *, mesh: MeshLike | None = None, deforms: bool = False,
                 progress: Callable[[float], Any] | None = None, **parameters: Unpack[Parameters]) -> None:
        self._handle: Handle | None = None
        scene = scene_of(strands, mesh, deforms, parameters)
        with lock, Watch(progress):
            self._handle = Handle("tractrix_simulation_create", "tractrix_simulation_destroy", device().value, scene.value)
        scene.close()
        self._renderers: dict[Any, Handle] = {}

    def __repr__(self) -> str:
        return "<tractrix.Simulation, closed>" if self._handle is None else f"<tractrix.Simulation at {self.time:.6g} s>"

    def _repr_png_(self) -> bytes | None:
        """The picture that notebooks show."""
        if self._handle is None:
            return None
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "hair.png")
            write_image(path, self.render((480, 480)))
            with open(path, "rb") as file:
                return file.read()

    def __enter__(self) -> Simulation:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        with lock:
            self._forget_renderers()
            self._handle = None  # the library's object is destroyed now, or with the last view of its memory

    @property
    def _pointer(self) -> ctypes.c_void_p:
        if self._handle is None:
            raise error_of(FAILED, "Simulation: used after close()")
        return self._handle.value

    def _forget_renderers(self) -> None:
        for renderer in self._renderers.values():
            renderer.close()
        self._renderers.clear()

    @property
    def messages(self) -> list[str]:
        """Lines about repairs, guesses and omissions when the scene was read."""
        with lock:
            return library().tractrix_simulation_messages(self._pointer).decode().splitlines()

    @property
    def time(self) -> float:
        """The scene's time in seconds."""
        with lock:
            return library().tractrix_simulation_time(self._pointer)

    def set(self, *, section: int = -1, **parameters: Unpack[Parameters]) -> None:
        """Changes live parameters (`tractrix.parameters()[name].live`). They take effect at the next step or image.
        `section`: the section of hair, from 0, for parameters of sections; -1: all sections. An automatic exposure stays
        as measured until `exposure` is set."""
        with lock:
            for name, value in parameters.items():
                call("tractrix_simulation_set_section", self._pointer, section, bytes_of("a parameter", name), bytes_of(name, text_of(name, value)))

    def save(self) -> bytes:
        """The state of the simulation. A simulation of an equal scene continues from it with `restore`, bit for bit. Raises
        TractrixError(2) if you have moved the head, the mesh or a body."""
        with lock:
            state = Handle("tractrix_simulation_save", "tractrix_state_destroy", self._pointer)
            size = ctypes.c_size_t()
            address = library().tractrix_state_bytes(state.value, ctypes.byref(size))
            content = ctypes.string_at(address, size.value)
            state.close()
        return content

    def restore(self, state: bytes) -> None:
        """Returns to a state that `save` gave: its time, and the hair as it was. Raises TractrixError(3) for a state of other
        hair or solvers."""
        with lock:
            made = Handle("tractrix_state_create", "tractrix_state_destroy", state, len(state))
            call("tractrix_simulation_restore", self._pointer, made.value)
            made.close()

    def advance(self, head: PoseLike | None = None, *, mesh: np.ndarray | None = None) -> None:
        """Simulates one frame, which is speed / fps seconds of the scene (parameters `fps` and `speed`; `speed` is 1 by
        default). `head`: the pose of the head at the end of the frame, a rigid (4, 4) matrix or a quaternion and a
        translation in m, ((x, y, z, w), (x, y, z)). Without `head` the head moves as the scene says, or stays where it
        is if an earlier call has given a pose. `mesh`: the vertices (N, 3) of a deforming mesh at the end of the frame,
        in world space, m, y up. `head` and `mesh` need frames that are a whole number of simulation steps."""
        if head is not None and mesh is not None:
            raise usage("advance: got both head and mesh, expected only one of them")
        with lock:
            if mesh is not None:
                vertices = _arrays.numbers("mesh", mesh, (None, 3))
                call("tractrix_simulation_advance_mesh", self._pointer, _arrays.pointer(vertices, ctypes.c_float), len(vertices))
            else:
                call("tractrix_simulation_advance", self._pointer, None if head is None else ctypes.byref(pose_of(head)))

    def place(self, body: int, head: PoseLike | None = None, *, mesh: np.ndarray | None = None) -> None:
        """Says where one body of the scene will be at the end of the frame that the next `advance()` simulates. `body`:
        its index in the scene file's list of bodies. `head` or `mesh` as for `advance`, which is for scenes of one
        body. Bodies that are not placed move as the scene says, or stay where they are if they were placed before."""
        if (head is None) == (mesh is None):
            raise usage("place: expected either head or mesh")
        number = _arrays.index("body", body)
        with lock:
            if mesh is not None:
                vertices = _arrays.numbers("mesh", mesh, (None, 3))
                call("tractrix_simulation_place_body_mesh", self._pointer, number, _arrays.pointer(vertices, ctypes.c_float), len(vertices))
            else:
                call("tractrix_simulation_place_body", self._pointer, number, ctypes.byref(pose_of(head)))

    def positions(self, section: int = 0, *, part: Part = "guides", copy: bool = True) -> PositionsLike:
        """The vertices of guides or followers as they are drawn now, read-only: (S, V, 4), x y z 1 in the world, m,
        root first; a list of (V, 4) if strands have different numbers of vertices. With copy=False the array is a view
        of the library's memory: the next call of this object may change its content. The memory lives as long as the
        view."""
        view = Positions()
        with lock:
            call("tractrix_simulation_map", self._pointer, section, part_of(part), ctypes.byref(view))
            if not view.vertex_count:
                return np.empty((0, 0, 4), np.float32)
            memory = (ctypes.c_float * 4 * view.vertex_count).from_address(ctypes.addressof(view.position.contents))
            memory.owner = self._handle  # the array holds `memory`, which holds the simulation
            points = np.ctypeslib.as_array(memory)
            sizes = np.ctypeslib.as_array(view.sizes, (view.strand_count,))
            if copy:
                points = points.copy()
        points.flags.writeable = False
        if (sizes == sizes[0]).all():
            return points.reshape(len(sizes), sizes[0], 4)
        return np.split(points, np.cumsum(sizes)[:-1])

    def render(self, size: tuple[int, int] = (960, 960), *, dtype: Any = np.uint8,
               view: tuple[np.ndarray, np.ndarray] | None = None) -> np.ndarray:
        """An image of the current state: (H, W, 4), top row first. uint8 and uint16 are sRGB with straight alpha;
        float32 is linear light with premultiplied alpha. `view`: (world_to_eye, projection), two (4, 4) matrices for
        column vectors; default: the scene's camera. Automatic exposure is measured at the first image, and again
        whenever `size` or `dtype` differs from that of the previous image; with float32 it is 0."""
        return self._render(size, dtype, view, None)

    def render_layers(self, size: tuple[int, int] = (960, 960), *, dtype: Any = np.uint8,
                      view: tuple[np.ndarray, np.ndarray] | None = None) -> Layered:
        """The image that `render` gives, and data of each of its pixels: coverage, depth, tangent and strand."""
        width, height = (int(length) for length in _arrays.numbers("size", size, (2,), np.int64))
        shape = max(height, 0), max(width, 0)
        arrays = [np.empty(shape, np.float32), np.empty(shape, np.float32), np.empty((*shape, 3), np.float32), np.empty(shape, np.uint32)]
        coverage, depth, tangent = (_arrays.pointer(array, ctypes.c_float) for array in arrays[:3])
        layers = Layers(coverage=coverage, depth=depth, tangent=tangent, strand=_arrays.pointer(arrays[3], ctypes.c_uint32))
        return Layered(self._render(size, dtype, view, layers), *arrays)

    def _render(self, size: tuple[int, int], dtype: Any, view: tuple[np.ndarray, np.ndarray] | None, layers: Layers | None) -> np.ndarray:
        try:
            kind = np.dtype(dtype)
        except TypeError:
            kind = None
        if kind not in FORMATS:
            raise usage(f"dtype: got {kind or repr(dtype)}: expected uint8, uint16 or float32")
        width, height = (int(length) for length in _arrays.numbers("size", size, (2,), np.int64))
        with lock:
            key = width, height, kind
            if key not in self._renderers:
                self._forget_renderers()
                self._renderers[key] = Handle("tractrix_renderer_create", "tractrix_renderer_destroy", self._pointer,
                                              width, height, FORMATS[kind])
            pixels = np.empty((height, width, 4), kind)
            call("tractrix_render_layers", self._renderers[key].value, None if view is None else ctypes.byref(_view_of(view)),
                 ctypes.byref(image_of(pixels)), None if layers is None else ctypes.byref(layers))
        return pixels


def _view_of(view: tuple[np.ndarray, np.ndarray]) -> View:
    matrices = [_arrays.numbers(f"view[{index}]", matrix, (4, 4)).T.ravel() for index, matrix in enumerate(view)]
    if len(matrices) != 2:
        raise usage(f"view: {len(matrices)} matrices: expected (world_to_eye, projection)")
    return View(world_to_eye=tuple(matrices[0]), projection=tuple(matrices[1]))


def render(strands: StrandsLike, *, mesh: MeshLike | None = None, size: tuple[int, int] = (960, 960),
           dtype: Any = np.uint8, view: tuple[np.ndarray, np.ndarray] | None = None,
           frames: int = 0, **parameters: Unpack[Parameters]) -> np.ndarray:
    """Renders one image, (H, W, 4), of the hair at time 0, or after `frames` simulated frames. The other arguments are
    those of Simulation and Simulation.render. For several images of the same hair create a Simulation."""
    with Simulation(strands, mesh=mesh, **parameters) as simulation:
        for _ in range(frames):
            simulation.advance()
        return simulation.render(size, dtype=dtype, view=view)


def simulate(strands: StrandsLike, *, frames: int | None = None, head: Iterable[PoseLike] | None = None,
             mesh: MeshLike | None = None, mesh_frames: Iterable[np.ndarray] | None = None, section: int = 0,
             part: Part = "guides", copy: bool = True, **parameters: Unpack[Parameters]) -> Iterator[PositionsLike]:
    """Yields the positions of the hair at the end of each frame, as Simulation.positions does. `head`: a pose of the
    head for each frame. `mesh_frames`: the vertices of a deforming mesh for each frame. Pass at most one of them.
    `frames`: how many frames; may be missing if `head` or `mesh_frames` is given, whose length is then used. The other
    arguments are those of Simulation."""
    if head is not None and mesh_frames is not None:
        raise usage("simulate: got both head and mesh_frames, expected only one of them")
    if frames is None and head is None and mesh_frames is None:
        raise usage("frames: not given: expected a number, or head or mesh_frames, which have one for each frame")
    part_of(part)
    simulation = Simulation(strands, mesh=mesh, deforms=mesh_frames is not None, **parameters)
    return _positions(simulation, frames, head, mesh_frames, section, part, copy)


def _positions(simulation: Simulation, frames: int | None, head: Iterable[PoseLike] | None,
               mesh_frames: Iterable[np.ndarray] | None, section: int, part: Part, copy: bool) -> Iterator[PositionsLike]:
    """A separate generator, so that simulate() raises at the call and not at the first item."""
    with simulation:
        driven = head if head is not None else mesh_frames
        count = 0
        for item in itertools.islice(itertools.repeat(None) if driven is None else driven, frames):
            simulation.advance(**({"mesh": item} if mesh_frames is not None else {"head": item}))
            yield simulation.positions(section, part=part, copy=copy)
            count += 1
        if frames is not None and count < frames:
            name = "head" if head is not None else "mesh_frames"
            raise usage(f"{name}: {count} items: expected one for each of {frames} frames")
