# SPDX-License-Identifier: MIT
"""Hair from Blender to Tractrix and back, headless or as an add-on (File > Import, File > Export).

    blender -b scene.blend --python blender_hair.py -- export -o hair.npz
    blender -b --python blender_hair.py -- export groom.abc -o hair.tfx --scene scene.json
    blender -b --python blender_hair.py -- import sim.usda -o sim.blend

Needs Blender 3.4 or newer and its numpy. docs/blender.md describes it. Data of Blender are in Blender's units with z up,
data of Tractrix in metres with y up; if a function has both, names tell them apart. S: strands, P: points of a strand (or
`sizes`), V: points in all, F: frames.
"""

import argparse
import json
import math
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import traceback
from dataclasses import dataclass, field
from typing import Callable, Optional

import bpy
import numpy as np
from mathutils import Matrix, Vector, geometry
from mathutils.bvhtree import BVHTree

bl_info = {
    "name": "Tractrix hair",
    "author": "Tractrix",
    "version": (1, 0, 0),
    "blender": (3, 4, 0),
    "location": "File > Import, File > Export",
    "description": "Hair curves and particle hair to Tractrix, simulated hair back",
    "category": "Import-Export",
}

DONE, FAILED, USAGE, BAD_INPUT = 0, 1, 2, 3
TOLERANCE_M = 1e-4  # largest deviation of roots from a rigid motion
MAX_LIGHTS = 8
USUAL_RADII = (1.0, 0.01)  # Blender's default radii of curves
POLY_CURVE = 1  # `curve_type` of curves that are polylines
KEYS_APART = 10.0  # distance of absolute shape keys in Blender


class HairError(Exception):
    """An error with one line, `place: what is wrong: what was expected`, and an exit status."""

    def __init__(self, message: str, status: int = BAD_INPUT):
        super().__init__(message)
        self.status = status


def say(message: str) -> None:
    """Prints one line for the user to standard error."""
    print(f"blender_hair: {message}", file=sys.stderr, flush=True)


# --- Strands, and the files that Tractrix reads


@dataclass
class Hair:
    """Strands in metres, y up, concatenated, each from root to tip."""

    points: np.ndarray  # (V, 3) float32
    sizes: np.ndarray  # (S,) int32, points of each strand
    uv: Optional[np.ndarray] = None  # (S, 2) float32, on the surface at the root
    radius: Optional[np.ndarray] = None  # (V,) float32, m
    color: Optional[np.ndarray] = None  # (V, 4) float32, linear RGB and opacity
    frames: Optional[np.ndarray] = None  # (F, V, 3) float32
    fps: float = 24.0

    @property
    def first(self) -> np.ndarray:
        """(S,) index of each root."""
        return np.concatenate(([0], np.cumsum(self.sizes)[:-1])).astype(np.int64)

    @property
    def even(self) -> bool:
        """Whether all strands have the same number of points."""
        return bool((self.sizes == self.sizes[0]).all())


def write_whole(path: str, write: Callable[[str], None]) -> None:
    """Calls `write` with a temporary file in the folder of `path`, then renames it: the file appears complete or not at all."""
    folder, name = os.path.split(os.path.abspath(path))
    temporary = os.path.join(folder, f".{os.getpid()}_{name}")
    try:
        write(temporary)
        os.replace(temporary, path)
    except OSError as error:
        raise HairError(f"{path}: cannot be written: {error.strerror}", FAILED) from None
    finally:
        if os.path.exists(temporary):
            os.remove(temporary)


def resample(hair: Hair, count: int) -> Hair:
    """`hair` resampled to `count` points for each strand, at equal distances along its lines; root and tip are exact."""
    low, share = np.empty((len(hair.sizes), count), np.int64), np.empty((len(hair.sizes), count), np.float64)
    for s, (first, size) in enumerate(zip(hair.first, hair.sizes)):
        line = hair.points[first : first + size].astype(np.float64)
        along = np.concatenate(([0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))))
        at = np.linspace(0, along[-1], count)
        k = np.clip(np.searchsorted(along, at, side="right") - 1, 0, size - 2)
        low[s] = first + k
        share[s] = np.clip((at - along[k]) / np.maximum(along[k + 1] - along[k], 1e-300), 0, 1)
        share[s, -1] = 1
    low, share = low.ravel(), share.ravel()

    def mix(values: Optional[np.ndarray]) -> Optional[np.ndarray]:
        """Interpolates values of the old points (last axis but one) to the new points."""
        if values is None:
            return None
        t = share if values.ndim == 1 else share[:, None]
        axis = max(values.ndim - 2, 0)
        mixed = np.take(values, low, axis) * (1 - t) + np.take(values, low + 1, axis) * t
        return mixed.astype(np.float32)

    sizes = np.full(len(hair.sizes), count, np.int32)
    return Hair(mix(hair.points), sizes, hair.uv, mix(hair.radius), mix(hair.color), mix(hair.frames), hair.fps)


def tfx_binary(hair: Hair) -> bytes:
    """A TressFX 4 file, for strands with equal numbers of points."""
    strands, size = len(hair.sizes), int(hair.sizes[0])
    movable = np.ones((strands, size, 1), np.float32)
    movable[:, 0] = 0
    place = np.concatenate((hair.points.reshape(strands, size, 3), movable), 2)
    arrays = [place, hair.uv, None, None, hair.color]  # positions, strand UV, vertex UV, thickness, colour
    if hair.radius is not None:
        arrays[3] = 2 * hair.radius[hair.first]
    offsets, body, at = [], [], 160
    for array in arrays:
        offsets.append(0 if array is None else at)
        if array is not None:
            body.append(np.ascontiguousarray(array, "<f4").tobytes())
            at += len(body[-1])
    header = struct.pack("<f7I", 4.0, strands, size, *offsets)
    return header + bytes(160 - len(header)) + b"".join(body)


def tfx_text(hair: Hair) -> str:
    """A TressFX 2 file, for strands with different numbers of points."""
    uv = np.zeros((len(hair.sizes), 2), np.float32) if hair.uv is None else hair.uv
    lines = [f"numStrands {len(hair.sizes)}", "is sorted 1"]
    for s, (first, size) in enumerate(zip(hair.first, hair.sizes)):
        lines.append(f"strand {s} numVerts {size} texcoord {uv[s, 0]:.9g} {uv[s, 1]:.9g}")
        lines += [f"{x:.9g} {y:.9g} {z:.9g}" for x, y, z in hair.points[first : first + size]]
    return "\n".join(lines) + "\n"


def npz_arrays(hair: Hair) -> dict:
    """The arrays of a `.npz` file: `positions` (S, P, 3) or `points` and `sizes`, and the other properties of `hair`."""
    arrays = {"fps": np.float32(hair.fps), "unit": np.float32(1), "up": np.array("y")}
    if hair.even:
        shape = (len(hair.sizes), int(hair.sizes[0]), 3)
        arrays["positions"] = hair.points.reshape(shape)
    else:
        arrays["points"], arrays["sizes"] = hair.points, hair.sizes
    if hair.frames is not None:
        arrays["frames"] = hair.frames.reshape(len(hair.frames), *shape) if hair.even else hair.frames
    for name in ("uv", "radius", "color"):
        if getattr(hair, name) is not None:
            arrays[name] = getattr(hair, name)
    return arrays


def write_hair(path: str, hair: Hair) -> None:
    """Writes `.tfx` (TressFX 4, or TressFX 2 text if strands have different numbers of points) or `.npz`."""
    if path.endswith(".npz"):

        def write(name: str) -> None:
            with open(name, "wb") as file:
                np.savez(file, **npz_arrays(hair))

    elif path.endswith(".tfx"):
        if not hair.even and (hair.radius is not None or hair.color is not None):
            say(f"{path}: strands differ in their number of points: written as TressFX text, without radius and colour; --resample N keeps both")
        if hair.frames is not None:
            say(f"{path}: holds only the first frame: .npz keeps all frames")
        data = tfx_binary(hair) if hair.even else tfx_text(hair).encode()

        def write(name: str) -> None:
            with open(name, "wb") as file:
                file.write(data)

    else:
        raise HairError(f"{path}: unknown kind of file: expected .npz or .tfx", USAGE)
    write_whole(path, write)


def read_npz(path: str) -> Hair:
    """Reads a file with the arrays of `npz_arrays`."""
    try:
        with np.load(path, allow_pickle=False) as file:
            data = {name: file[name] for name in file.files}
        points = data["positions"] if "positions" in data else data["points"]
        if points.ndim == 3:
            sizes = np.full(points.shape[0], points.shape[1], np.int32)
        else:
            sizes = data["sizes"].astype(np.int32)
        hair = Hair(points.reshape(-1, 3).astype(np.float32), sizes, fps=float(data.get("fps", 24)))
    except (OSError, ValueError, KeyError, IndexError) as error:
        raise HairError(f"{path}: {error}: expected arrays `positions`, or `points` and `sizes`") from None
    if len(sizes) == 0 or sizes.min() < 2 or sizes.sum() != len(hair.points):
        raise HairError(f"{path}: `sizes` do not add up to the points: expected at least 2 points a strand")
    wanted = {"uv": (len(sizes), 2), "radius": (len(hair.points),), "color": (len(hair.points), 4)}
    for name, shape in wanted.items():
        if name in data:
            if data[name].shape != shape:
                raise HairError(f"{path}: `{name}` has shape {data[name].shape}: expected {shape}")
            setattr(hair, name, data[name].astype(np.float32))
    if "frames" in data:
        if data["frames"].size % hair.points.size:
            raise HairError(f"{path}: `frames` has shape {data['frames'].shape}: expected all points of each frame")
        hair.frames = data["frames"].reshape(-1, len(hair.points), 3).astype(np.float32)
    return in_metres(hair, float(data.get("unit", 1)), str(data.get("up", "y")) == "z")


def in_metres(hair: Hair, unit: float, up_z: bool) -> Hair:
    """Converts `hair` from its file's unit and axis to metres with y up, in place."""
    for name in ("points", "frames", "radius"):
        values = getattr(hair, name)
        if values is not None and unit != 1:
            values = values * np.float32(unit)
        if values is not None and up_z and name != "radius":
            values = to_y_up(values)
        setattr(hair, name, values)
    return hair


def _usda_numbers(text: str, kind: type) -> np.ndarray:
    return np.array(text.translate(str.maketrans("()[],", "     ")).split(), kind)


def read_usda(path: str) -> Hair:
    """Reads one prim of linear curves with all its time samples, as tractrix-convert and tractrix-render write it."""
    with open(path, encoding="utf-8", errors="replace") as file:
        text = file.read()
    prims = len(re.findall(r"def BasisCurves\b", text))
    if not text.startswith("#usda") or prims != 1 or "xformOp:" in text or '"cubic"' in text:
        raise HairError(f"{path}: has {prims} prims of curves, or transforms, or cubic curves: expected a file that tractrix-convert wrote, with one prim of linear curves")

    def array(name: str, kind: type = np.float32) -> Optional[np.ndarray]:
        found = re.search(rf"\] {name} = \[(.*?)\]", text, re.S)
        return _usda_numbers(found[1], kind) if found else None

    sizes = array("curveVertexCounts", np.int32)
    samples = re.search(r"\] points\.timeSamples = \{(.*?)\}", text, re.S)
    still = array("points")
    if samples:
        values = [_usda_numbers(value, np.float32) for value in re.findall(r":\s*\[(.*?)\]", samples[1], re.S)]
    else:
        values = [] if still is None else [still]
    if sizes is None or not values or any(len(v) != 3 * sizes.sum() for v in values):
        raise HairError(f"{path}: points do not fit the numbers of vertices: expected 3 numbers a vertex")
    frames = np.stack(values).reshape(len(values), -1, 3)
    unit = re.search(r"metersPerUnit = ([\d.eE+-]+)", text)
    rate = re.search(r"timeCodesPerSecond = ([\d.eE+-]+)", text)
    uv, width = array("primvars:st"), array("widths")
    hair = Hair(frames[0], sizes, frames=frames if len(frames) > 1 else None, fps=float(rate[1]) if rate else 24.0)
    if uv is not None and len(uv) == 2 * len(sizes):
        hair.uv = uv.reshape(-1, 2)
    if width is not None and len(width) in (1, len(sizes), len(hair.points)):
        each = len(hair.points) if len(width) == 1 else hair.sizes if len(width) == len(sizes) else 1
        hair.radius = np.repeat(width / 2, each)
    return in_metres(hair, float(unit[1]) if unit else 0.01, 'upAxis = "Z"' in text)


def convert_hair(path: str, units: tuple = ()) -> Hair:
    """Reads a cache, numbered files, Alembic or any other hair file with tractrix-convert; `units`: its --unit and --up."""
    here = os.path.dirname(os.path.abspath(__file__))
    beside = os.pathsep.join(os.path.join(here, *folder) for folder in (("..", "out", "release"), ("..", "..", "bin")))
    name = "tractrix-convert"
    program = os.environ.get("TRACTRIX_CONVERT") or shutil.which(name) or shutil.which(name, path=beside)
    if not program:
        raise HairError(f"{path}: tractrix-convert is needed to read this file: expected tractrix-convert on the PATH, or its path in TRACTRIX_CONVERT", FAILED)
    with tempfile.TemporaryDirectory() as folder:
        usda = os.path.join(folder, "hair.usda")
        done = subprocess.run([program, path, *units, "-o", usda], capture_output=True, text=True, check=False)
        lines = [line.removeprefix("tractrix-convert: ") for line in done.stderr.splitlines()]
        if done.returncode:
            raise HairError(lines[-1] if lines else f"{path}: tractrix-convert failed", done.returncode)
        for line in lines:
            say(line)
        return read_usda(usda)


# --- Axes, colours, rigid motion


def to_y_up(points: np.ndarray) -> np.ndarray:
    """Converts (..., 3) from z up to y up."""
    return np.stack((points[..., 0], points[..., 2], -points[..., 1]), -1)


def to_z_up(points: np.ndarray) -> np.ndarray:
    """Converts (..., 3) from y up to z up."""
    return np.stack((points[..., 0], -points[..., 2], points[..., 1]), -1)


def unit_of(scene) -> float:
    """Metres of one unit of Blender's scene."""
    return 1.0 if scene.unit_settings.system == "NONE" else scene.unit_settings.scale_length


def srgb(color) -> list:
    """Linear RGB -> sRGB, both clamped to 0..1."""
    values = [min(max(float(c), 0.0), 1.0) for c in list(color)[:3]]
    return [round(12.92 * c if c <= 0.0031308 else 1.055 * c ** (1 / 2.4) - 0.055, 6) for c in values]


def linear(color) -> list:
    """sRGB of a scene file, `#rrggbb` or three numbers -> linear RGB; a color name gives white."""
    if isinstance(color, str):
        match = re.fullmatch(r"#([0-9a-fA-F]{6})", color)
        color = [int(match[1][i : i + 2], 16) / 255 for i in (0, 2, 4)] if match else [1, 1, 1]
    return [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in color]


def fit_rigid(rest: np.ndarray, moved: np.ndarray) -> tuple:
    """Least-squares R (3, 3), t (3,) with moved = R rest + t (Kabsch 1976), and the largest remaining distance.

    Both arrays are (N, 3) float64. If all points lie on one line the rotation is not defined: HairError.
    """
    a, b = rest - rest.mean(0), moved - moved.mean(0)
    spread = np.linalg.svd(a, compute_uv=False) if len(a) > 2 else np.zeros(3)
    if spread[1] <= 1e-6 * max(spread[0], 1e-12):
        raise HairError("roots lie on one line: expected three that do not, to find the head's rotation")
    u, _, v = np.linalg.svd(a.T @ b)
    flip = np.diag([1, 1, np.sign(np.linalg.det(v.T @ u.T))])
    rotation = v.T @ flip @ u.T
    shift = moved.mean(0) - rotation @ rest.mean(0)
    return rotation, shift, float(np.linalg.norm(rest @ rotation.T + shift - moved, axis=1).max())


def rotation_vector(rotation: np.ndarray, before: np.ndarray) -> np.ndarray:
    """Axis times angle (rad) of a rotation matrix (3, 3). Of all such vectors, the one nearest to `before`."""
    skew = 0.5 * np.array([rotation[2, 1] - rotation[1, 2], rotation[0, 2] - rotation[2, 0], rotation[1, 0] - rotation[0, 1]])
    sine, cosine = float(np.linalg.norm(skew)), 0.5 * (float(np.trace(rotation)) - 1)
    angle = math.atan2(sine, cosine)
    if sine > 1e-7:
        axis = skew / sine
    elif cosine < 0:  # half a turn: the columns of R + 1 lie along the axis
        along = (rotation + np.eye(3))[:, int(np.argmax(np.diag(rotation)))]
        axis = along / np.linalg.norm(along)
    else:
        length = float(np.linalg.norm(before))
        axis = before / length if length > 0 else np.array([0.0, 0.0, 1.0])
    turns = round((float(axis @ before) - angle) / (2 * math.pi))
    return axis * (angle + 2 * math.pi * turns)


def head_track(roots: np.ndarray, fps: float) -> tuple:
    """The `head` of a scene file for roots (F, S, 3) in metres, y up, and the largest residual with its frame."""
    rest = roots[0].astype(np.float64)
    pivot, turned, keys, worst = rest.mean(0), np.zeros(3), [], (0.0, 0)
    for f, moved in enumerate(roots.astype(np.float64)):
        rotation, shift, residual = fit_rigid(rest, moved)
        worst = max(worst, (residual, f))
        turned = rotation_vector(rotation, turned)
        translate = rotation @ pivot + shift - pivot
        keys.append({
            "time": round(f / fps, 9),
            "translate": [round(float(x), 9) for x in translate],
            "rotate": [round(math.degrees(x), 7) for x in turned],
        })  # fmt: skip
    return {"pivot": [round(float(x), 9) for x in pivot], "keys": keys}, worst


# --- Out of Blender: strands


@dataclass
class Piece:
    """The strands of one object at one frame, in Blender's world. Arrays as in Hair; `uv` and others may be None."""

    name: str
    points: np.ndarray
    sizes: np.ndarray
    uv: Optional[np.ndarray] = None
    radius: Optional[np.ndarray] = None
    color: Optional[np.ndarray] = None
    surface: object = None  # the mesh object that the hair grows on
    material: object = None


@dataclass
class ExportOptions:
    """The options; see the parser's help."""

    output: str
    frames: Optional[tuple] = None  # first and last; None: the current frame
    objects: list = field(default_factory=list)
    children: str = "parents"
    resample: int = 0
    mesh: str = ""
    mesh_object: str = ""
    scene: str = ""
    tolerance: float = TOLERANCE_M


def into_world(obj, points: np.ndarray) -> np.ndarray:
    """Transforms points (N, 3) of an object to the world, float64."""
    matrix = np.array(obj.matrix_world, np.float64)
    return points @ matrix[:3, :3].T + matrix[:3, 3]


def column(collection, name: str, width: int, kind=np.float32) -> np.ndarray:
    """An attribute of all items of a Blender collection: (N, width), or (N,) for width 1."""
    values = np.empty(len(collection) * width, kind)
    collection.foreach_get(name, values)
    return values if width == 1 else values.reshape(-1, width)


def attribute_of(data, name: str, member: str, width: int) -> Optional[np.ndarray]:
    """A named attribute of a Curves or Mesh; None if there is none with `width` numbers."""
    found = data.attributes.get(name)
    return column(found.data, member, width) if found and len(found.data) else None


def curves_piece(obj, context) -> Optional[Piece]:
    """The strands of a Curves object after its modifiers. Poly and Catmull-Rom curves give their points, other curves the
    points that Blender draws."""
    depsgraph = context.evaluated_depsgraph_get()
    data = obj.evaluated_get(depsgraph).data
    if len(data.curves) == 0:
        return None
    types = attribute_of(data, "curve_type", "value", 1) if "curve_type" in data.attributes else None
    if types is None or (types <= POLY_CURVE).all():
        return points_of_curves(obj, obj.evaluated_get(depsgraph))
    modifier = obj.modifiers.new("Tractrix lines", "NODES")
    modifier.node_group = tree = drawn_curves()
    try:
        context.view_layer.update()
        return points_of_curves(obj, obj.evaluated_get(context.evaluated_depsgraph_get()))
    finally:
        obj.modifiers.remove(modifier)
        bpy.data.node_groups.remove(tree)


def points_of_curves(obj, evaluated) -> Piece:
    """The control points of an evaluated Curves object with their attributes."""
    data = evaluated.data
    return Piece(
        obj.name,
        into_world(evaluated, column(data.position_data, "vector", 3)),
        column(data.curves, "points_length", 1, np.int32),
        attribute_of(data, "surface_uv_coordinate", "vector", 2),
        attribute_of(data, "radius", "value", 1),
        attribute_of(data, "color", "color", 4),
        obj.data.surface,
        obj.active_material,
    )


def drawn_curves():
    """A node group that converts all curves to poly curves with the points that Blender draws."""
    tree = geometry_tree("Tractrix lines")
    begin, end, lines = (tree.nodes.new(kind) for kind in ("NodeGroupInput", "NodeGroupOutput", "GeometryNodeResampleCurve"))
    if hasattr(lines, "mode"):
        lines.mode = "EVALUATED"
    else:  # Blender 5
        lines.inputs["Mode"].default_value = "Evaluated"
    tree.links.new(begin.outputs[0], lines.inputs["Curve"])
    tree.links.new(lines.outputs[0], end.inputs[0])
    return tree


def geometry_tree(name: str):
    """An empty node group from geometry to geometry."""
    tree = bpy.data.node_groups.new(name, "GeometryNodeTree")
    if hasattr(tree, "interface"):  # Blender 4
        tree.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
        tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    else:
        tree.inputs.new("NodeSocketGeometry", "Geometry")
        tree.outputs.new("NodeSocketGeometry", "Geometry")
    return tree


def spline_piece(obj, depsgraph) -> Optional[Piece]:
    """The splines of an old Curve object, as importers make them. Poly splines give their points, others the points that
    Blender draws."""
    evaluated = obj.evaluated_get(depsgraph)
    data = evaluated.to_curve(depsgraph, apply_modifiers=True)
    straight = [s for s in data.splines if s.type == "POLY" or (s.type == "NURBS" and s.order_u == 2)]
    if data.splines and len(straight) == len(data.splines):
        points = [column(s.points, "co", 4)[:, :3] for s in straight]
        radius = np.concatenate([column(s.points, "radius", 1) for s in straight])
        depth = obj.data.bevel_depth
        # Alembic's importer stores the file's widths as radii of curves without a bevel.
        radius = radius * depth if depth > 0 else 0.5 * radius if (radius != 1).any() else None
    else:
        points, radius = drawn_lines(obj, evaluated), None
    evaluated.to_curve_clear()
    if not points:
        return None
    sizes = np.array([len(p) for p in points], np.int32)
    return Piece(obj.name, into_world(evaluated, np.concatenate(points)), sizes, radius=radius, material=obj.active_material)


def drawn_lines(obj, evaluated) -> list:
    """The polylines (P, 3) that Blender draws for an old Curve object without bevel."""
    if obj.data.bevel_depth > 0 or obj.data.extrude > 0:
        raise HairError(f"object '{obj.name}': Bezier or NURBS splines with a bevel: expected none, or poly splines")
    mesh = evaluated.to_mesh()
    points = column(mesh.vertices, "co", 3)
    joined = np.zeros(len(points), bool)  # whether a point continues the line of the previous point
    edges = np.sort(column(mesh.edges, "vertices", 2, np.int32), axis=1)
    joined[edges[edges[:, 1] - edges[:, 0] == 1, 1]] = True
    evaluated.to_mesh_clear()
    return np.split(points, np.flatnonzero(~joined)[1:]) if len(points) else []


def particle_radius(settings, size: int) -> np.ndarray:
    """(size,) radius of a hair from root to tip in Blender's units, as Cycles draws it."""
    left, shape = 1 - np.linspace(0, 1, size), settings.shape
    left = left ** (1 + shape) if shape < 0 else left ** (1 / max(1 - shape, 1e-6))
    root, tip = settings.root_radius * settings.radius_scale / 2, settings.tip_radius * settings.radius_scale / 2
    radius = left * (root - tip) + tip
    if settings.use_close_tip:
        radius[-1] = 0
    return radius.astype(np.float32)


def particle_pieces(obj, depsgraph, children: str) -> list:
    """The hair of an object's particle systems: the paths that the viewport draws, for the hair that `children` selects."""
    pieces = []
    evaluated = obj.evaluated_get(depsgraph)
    for modifier in evaluated.modifiers:
        system = getattr(modifier, "particle_system", None)
        if modifier.type != "PARTICLE_SYSTEM" or not modifier.show_viewport or system.settings.type != "HAIR":
            continue
        parents, every = len(system.particles), len(system.particles) + len(system.child_particles)
        if children == "children" and every == parents:
            raise HairError(f"object '{obj.name}', particle system '{system.name}': it has no children: expected --children parents")
        numbers = range(*{"parents": (0, parents), "children": (parents, every), "all": (0, every)}[children])
        size = 2**system.settings.display_step + 1
        if len(numbers) == 0:
            continue
        paths = np.array([[system.co_hair(evaluated, particle_no=n, step=k) for k in range(size)] for n in numbers])
        uv = None
        if obj.data.uv_layers:
            first = system.particles[0]
            uv = np.array([
                system.uv_on_emitter(modifier, particle=system.particles[n] if n < parents else first, particle_no=n, uv_no=0)
                for n in numbers
            ])  # fmt: skip
        slot = system.settings.material - 1
        material = obj.material_slots[slot].material if 0 <= slot < len(obj.material_slots) else None
        radius = np.tile(particle_radius(system.settings, size), len(numbers))
        sizes = np.full(len(numbers), size, np.int32)
        pieces.append(Piece(f"{obj.name}/{system.name}", paths.reshape(-1, 3), sizes, uv, radius, None, obj, material))
    return pieces


def hair_objects(context, names: list) -> list:
    """The objects to export: the named ones, otherwise all visible objects with hair. Old curves are used only if there is no
    other hair."""
    context.view_layer.update()
    visible = [o for o in context.view_layer.objects if o.visible_get()]
    if names:
        missing = [n for n in names if n not in context.scene.objects]
        if missing:
            raise HairError(f"object '{missing[0]}': no such object: expected one of the scene", USAGE)
        return [context.scene.objects[n] for n in names]
    strands = [o for o in visible if o.type == "CURVES" or any(p.settings.type == "HAIR" for p in o.particle_systems)]
    return strands or [o for o in visible if o.type == "CURVE"]


def gather(context, objects: list, children: str) -> list:
    """The pieces of all objects at the scene's current frame."""
    depsgraph = context.evaluated_depsgraph_get()
    pieces = []
    for obj in objects:
        if obj.type == "CURVES":
            pieces.append(curves_piece(obj, context))
        elif obj.type == "CURVE":
            pieces.append(spline_piece(obj, depsgraph))
        else:
            pieces += particle_pieces(obj, depsgraph, children)
    pieces = [whole_strands(p) for p in pieces if p]
    return [p for p in pieces if len(p.sizes)]


def whole_strands(piece: Piece) -> Piece:
    """The piece without strands of one point; prints a line about these."""
    keep = piece.sizes > 1
    if keep.all():
        return piece
    say(f"object '{piece.name}': {int((~keep).sum())} strands of fewer than 2 points are left out")
    of_point = np.repeat(keep, piece.sizes)

    def only(values: Optional[np.ndarray], mask: np.ndarray) -> Optional[np.ndarray]:
        return None if values is None else values[mask]

    return Piece(
        piece.name, piece.points[of_point], piece.sizes[keep], only(piece.uv, keep), only(piece.radius, of_point),
        only(piece.color, of_point), piece.surface, piece.material,
    )  # fmt: skip


def nearest_uv(roots: np.ndarray, surface, depsgraph) -> Optional[np.ndarray]:
    """(S, 2) texture coordinates of a mesh object at the points nearest to `roots` (S, 3, Blender's world)."""
    evaluated = surface.evaluated_get(depsgraph)
    mesh = evaluated.to_mesh()
    mesh.calc_loop_triangles()
    layer = mesh.uv_layers.active
    if not layer or not mesh.loop_triangles:
        evaluated.to_mesh_clear()
        return None
    place = into_world(evaluated, column(mesh.vertices, "co", 3))
    corners = column(mesh.loop_triangles, "vertices", 3, np.int32)
    loops = column(mesh.loop_triangles, "loops", 3, np.int32)
    texture = column(layer.data, "uv", 2)
    tree = BVHTree.FromPolygons(place.tolist(), corners.tolist(), all_triangles=True)
    uv = np.zeros((len(roots), 2), np.float32)
    for s, root in enumerate(roots):
        at, _, triangle, _ = tree.find_nearest(Vector(root))
        a, b, c = (Vector(place[v]) for v in corners[triangle])
        at_uv = geometry.barycentric_transform(at, a, b, c, *(Vector((*texture[i], 0)) for i in loops[triangle]))
        uv[s] = at_uv[:2]
    evaluated.to_mesh_clear()
    return uv


def join(pieces: list, scene, depsgraph, surface) -> Hair:
    """Joins all pieces to one Hair. A property that a piece lacks is dropped with a warning; missing texture coordinates are
    looked up on the surface."""
    for piece in pieces:
        on = piece.surface or surface
        if piece.uv is None and on:
            first = np.concatenate(([0], np.cumsum(piece.sizes)[:-1]))
            piece.uv = nearest_uv(piece.points[first], on, depsgraph)
    unit = unit_of(scene)
    joined = {}
    for name in ("uv", "radius", "color"):
        values = [getattr(p, name) for p in pieces]
        lacking = [p.name for p in pieces if getattr(p, name) is None]
        joined[name] = None if lacking else np.concatenate(values).astype(np.float32)
        if lacking and len(lacking) < len(pieces):
            say(f"object '{lacking[0]}': has no {name}: the {name} of the other objects is not exported")
    if joined["radius"] is not None and is_usual(joined["radius"]):
        say(f"the radius is {joined['radius'][0]:g} everywhere, which is Blender's default: it is not exported")
        joined["radius"] = None
    if joined["radius"] is not None:
        joined["radius"] *= np.float32(unit)
    points = to_y_up(np.concatenate([p.points for p in pieces]) * unit).astype(np.float32)
    return Hair(points, np.concatenate([p.sizes for p in pieces]).astype(np.int32), fps=frames_per_second(scene), **joined)


def is_usual(radius: np.ndarray) -> bool:
    """Whether all radii have one of Blender's default values."""
    return any((np.abs(radius - usual) < 1e-6).all() for usual in USUAL_RADII)


def frames_per_second(scene) -> float:
    """Frames per second of Blender's timeline."""
    return scene.render.fps / scene.render.fps_base


def collect(context, options: ExportOptions) -> tuple:
    """The scene's Hair, its pieces at the first frame, and the roots (F, S, 3) in metres, y up (None without frames)."""
    scene = context.scene
    objects = hair_objects(context, options.objects)
    if options.frames:
        scene.frame_set(options.frames[0])
    pieces = gather(context, objects, options.children)
    if not pieces:
        raise HairError(f"{bpy.data.filepath or 'scene'}: no hair: expected Curves, particle hair or curve objects that are visible")
    surface = bpy.data.objects.get(options.mesh_object) if options.mesh_object else None
    hair = join(pieces, scene, context.evaluated_depsgraph_get(), surface)
    if not np.isfinite(hair.points).all():
        raise HairError("the hair has coordinates that are not finite")
    if not options.frames:
        return hair, pieces, None
    roots, frames = [], []
    for number in range(options.frames[0], options.frames[1] + 1):
        scene.frame_set(number)
        now = gather(context, objects, options.children)
        points = to_y_up(np.concatenate([p.points for p in now]) * unit_of(scene)).astype(np.float32) if now else hair.points[:0]
        if len(points) != len(hair.points):
            raise HairError(f"frame {number}: {len(points)} points: expected {len(hair.points)} as in frame {options.frames[0]}")
        roots.append(points[hair.first])
        if options.output.endswith(".npz"):
            frames.append(points)
    scene.frame_set(options.frames[0])
    hair.frames = np.stack(frames) if frames else None
    return hair, pieces, np.stack(roots)


# --- Out of Blender: the head's mesh, camera, lights


def mesh_text(objects: list, scene, depsgraph) -> str:
    """A Wavefront file of the triangles of mesh objects with their texture coordinates, in metres, y up."""
    lines, base, base_uv = [], 1, 1
    for obj in objects:
        evaluated = obj.evaluated_get(depsgraph)
        mesh = evaluated.to_mesh()
        mesh.calc_loop_triangles()
        place = to_y_up(into_world(evaluated, column(mesh.vertices, "co", 3)) * unit_of(scene))
        corners = column(mesh.loop_triangles, "vertices", 3, np.int32) + base
        lines += [f"o {obj.name.replace(' ', '_')}"] + [f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in place]
        if mesh.uv_layers.active:
            texture = column(mesh.uv_layers.active.data, "uv", 2)
            loops = column(mesh.loop_triangles, "loops", 3, np.int32) + base_uv
            lines += [f"vt {u:.7g} {v:.7g}" for u, v in texture]
            lines += ["f " + " ".join(f"{v}/{t}" for v, t in zip(*pair)) for pair in zip(corners, loops)]
            base_uv += len(texture)
        else:
            lines += [f"f {a} {b} {c}" for a, b, c in corners]
        base += len(place)
        evaluated.to_mesh_clear()
    return "\n".join(lines) + "\n"


def body_samples(context, objects: list, numbers: range) -> dict:
    """The arrays of a deforming mesh: evaluated positions (F, V, 3) at each frame, m, y up, and the faces of the first frame."""
    scene, frames, faces, shapes = context.scene, [], [], []
    for number in numbers:
        scene.frame_set(number)
        depsgraph = context.evaluated_depsgraph_get()
        places, base = [], 0
        for i, obj in enumerate(objects):
            evaluated = obj.evaluated_get(depsgraph)
            mesh = evaluated.to_mesh()
            corners, sides = column(mesh.loops, "vertex_index", 1, np.int32), column(mesh.polygons, "loop_total", 1, np.int32)
            if number == numbers[0]:
                mesh.calc_loop_triangles()
                faces.append(column(mesh.loop_triangles, "vertices", 3, np.int32) + base)
                shapes.append((len(mesh.vertices), corners, sides))
            count, *same = shapes[i]
            if len(mesh.vertices) != count or not all(map(np.array_equal, same, (corners, sides))):
                raise HairError(
                    f"object '{obj.name}': frame {number}: {len(mesh.vertices)} vertices with other faces: expected the {count} of frame "
                    f"{numbers[0]} (switch off modifiers that remesh or decimate)"
                )
            places.append(to_y_up(into_world(evaluated, column(mesh.vertices, "co", 3)) * unit_of(scene)))
            base += count
            evaluated.to_mesh_clear()
        frames.append(np.concatenate(places).astype(np.float32))
    scene.frame_set(numbers[0])
    positions = np.stack(frames)
    if not np.isfinite(positions).all():
        raise HairError("the mesh has coordinates that are not finite")
    return {"positions": positions, "faces": np.concatenate(faces), "fps": frames_per_second(scene), "unit": 1.0, "up": "y"}


def write_body(context, options: ExportOptions, meshes: list) -> None:
    """Writes the mesh that hair is bound to, over all frames, as `.npz`."""
    first, last = options.frames or (context.scene.frame_current,) * 2
    body = body_samples(context, meshes, range(first, last + 1))
    path = os.path.splitext(options.mesh)[0] + ".npz"

    def write(name: str) -> None:
        with open(name, "wb") as file:
            np.savez(file, **body)

    write_whole(path, write)
    say(f"{path}: {body['positions'].shape[0]} samples of {body['positions'].shape[1]} vertices")


def head_meshes(context, options: ExportOptions, pieces: list) -> list:
    """The mesh objects to export: the named one, otherwise those that hair grows on, otherwise all visible ones."""
    if options.mesh_object:
        obj = context.scene.objects.get(options.mesh_object)
        if not obj or obj.type != "MESH":
            raise HairError(f"object '{options.mesh_object}': no such mesh: expected one of the scene", USAGE)
        return [obj]
    grown = list(dict.fromkeys(p.surface for p in pieces if p.surface))
    meshes = grown or [o for o in context.view_layer.objects if o.type == "MESH" and o.visible_get()]
    if not meshes:
        raise HairError("--mesh: the scene has no mesh: expected a surface, an emitter or --mesh-object", USAGE)
    return meshes


def camera_pose(scene, depsgraph, middle: np.ndarray) -> dict:
    """Eye, target, up direction (Tractrix's axes, m) and vertical field of view (degrees) at the scene's current frame."""
    render = scene.render
    camera = scene.camera.evaluated_get(depsgraph)
    matrix = np.array(camera.matrix_world, np.float64)
    axes = matrix[:3, :3] / np.linalg.norm(matrix[:3, :3], axis=0)
    eye = to_y_up(matrix[:3, 3] * unit_of(scene))
    forward, up = to_y_up(-axes[:, 2]), to_y_up(axes[:, 1])
    projection = camera.calc_matrix_camera(
        depsgraph, x=render.resolution_x, y=render.resolution_y, scale_x=render.pixel_aspect_x, scale_y=render.pixel_aspect_y
    )
    distance = max(float((middle - eye) @ forward), 0.1)
    return {
        "eye": eye, "target": eye + distance * forward, "up": up,
        "fov": math.degrees(2 * math.atan(1 / projection[1][1])),
        "shift": (projection[0][2], projection[1][2]),
    }  # fmt: skip


def rounded(values, digits: int = 7) -> list:
    """A list for JSON."""
    return [round(float(v), digits) for v in values]


def camera_keys(context, options: ExportOptions, middle: np.ndarray) -> dict:
    """The scene file's members for the camera. Prints a warning for properties that Tractrix does not have."""
    scene, render = context.scene, context.scene.render
    if scene.camera.data.type != "PERSP":
        raise HairError(f"camera '{scene.camera.name}': type {scene.camera.data.type}: expected PERSP, the only type that Tractrix draws")
    if render.pixel_aspect_x != render.pixel_aspect_y:
        say("camera: its pixels are not square: they become square")
    first, last = options.frames or (scene.frame_current, scene.frame_current)
    poses = []
    for number in range(first, last + 1):
        if options.frames:
            scene.frame_set(number)
        poses.append(camera_pose(scene, context.evaluated_depsgraph_get(), middle))
    if options.frames:
        scene.frame_set(first)
    start = poses[0]
    if max(abs(x) for x in start["shift"]) > 1e-6:
        say(f"camera '{scene.camera.name}': its lens shift is not exported: the picture differs from Blender's")
    keys = {
        "eye": rounded(start["eye"]),
        "target": rounded(start["target"]),
        "camera_up": rounded(start["up"]),
        "fov": round(start["fov"], 6),
    }
    moves = max(np.abs(p[k] - start[k]).max() for p in poses for k in ("eye", "target", "fov"))
    if moves > 1e-6:
        rate = frames_per_second(scene)
        keys["camera"] = {"keys": [
            {"time": round(f / rate, 9), "eye": rounded(p["eye"]), "target": rounded(p["target"]), "fov": round(p["fov"], 6)}
            for f, p in enumerate(poses)
        ]}  # fmt: skip
        roll = max(roll_off(p, start["up"]) for p in poses)
        if roll > 0.01:
            say(f"camera '{scene.camera.name}': it rolls by up to {roll:.2f} degrees, which is not exported: camera_up is that of the first frame")
    return keys


def roll_off(pose: dict, up: np.ndarray) -> float:
    """The roll in degrees of the pose against a camera with the same direction of view and the given up direction."""
    forward = pose["target"] - pose["eye"]
    forward = forward / np.linalg.norm(forward)
    right = np.cross(forward, up)
    right = right / max(np.linalg.norm(right), 1e-9)
    return math.degrees(math.acos(min(max(float(np.cross(right, forward) @ pose["up"]), -1), 1)))


def light_of(obj, unit: float) -> dict:
    """One light of a scene file. Blender's W/m2 of a sun and W of other lights are converted to the light that a white matt
    surface reflects (1/pi)."""
    light, matrix = obj.data, np.array(obj.matrix_world, np.float64)
    way = to_y_up(-matrix[:3, 2] / np.linalg.norm(matrix[:3, 2]))
    peak = max(*light.color, 1e-9)
    made = {"color": srgb([c / peak for c in light.color]), "shadow": bool(light.use_shadow)}
    if light.type == "SUN":
        return {"type": "directional", "direction": rounded(way), "intensity": round(light.energy * peak / math.pi, 7), **made}
    made.update(position=rounded(to_y_up(matrix[:3, 3] * unit)), distance=1)
    flux = light.energy * peak
    if light.type == "AREA":
        say(f"light '{obj.name}': an area light becomes a spot without size or spread")
        shows = flux / (math.pi**2 if bpy.app.version >= (4, 0, 0) else 4 * math.pi)  # Cycles 3.4 and 4.3, measured
        return {"type": "spot", "direction": rounded(way), "inner": 0, "outer": 90, "intensity": round(shows, 7), **made}
    made["intensity"] = round(flux / (4 * math.pi**2), 7)
    if light.type == "POINT":
        return {"type": "point", **made}
    outer = min(math.degrees(light.spot_size / 2), 90)
    edge = math.cos(math.radians(outer))
    inner = min(math.degrees(math.acos(edge + (1 - edge) * light.spot_blend)), outer - 0.1)
    return {"type": "spot", "direction": rounded(way), "inner": round(max(inner, 0), 6), "outer": round(outer, 6), **made}


def light_keys(context) -> dict:
    """The scene file's members for light: lights, sky, ground, background, exposure, tone curve."""
    scene = context.scene
    lamps = [o for o in context.view_layer.objects if o.type == "LIGHT" and o.visible_get() and o.data.energy > 0]
    radiance = world_radiance(scene)
    if not lamps and max(radiance) <= 0:
        say("the scene has no light: Tractrix uses its default lights")
        return {}
    if len(lamps) > MAX_LIGHTS:
        say(f"{len(lamps)} lights: the strongest {MAX_LIGHTS} are kept")
    lights = [light_of(o, unit_of(scene)) for o in lamps]
    lights.sort(key=lambda light: (light["type"] != "directional", -light["intensity"]))
    if max(radiance) > 1:
        say(f"world: {max(radiance):.3g} is brighter than white: it becomes white")
    view = scene.view_settings
    return {
        "lights": lights[:MAX_LIGHTS], "sky": srgb(radiance), "ground": srgb(radiance),
        "background": "transparent" if scene.render.film_transparent else srgb(radiance),
        "exposure": round(view.exposure, 6), "tone_map": "none" if view.view_transform in ("Standard", "Raw") else "filmic",
    }  # fmt: skip


def world_radiance(scene) -> list:
    """Linear RGB of a uniform world. A world with a picture or a sky is replaced by its plain colour, with a warning."""
    world = scene.world
    if not world:
        return [0.0, 0.0, 0.0]
    node = next((n for n in world.node_tree.nodes if n.type == "BACKGROUND"), None) if world.use_nodes and world.node_tree else None
    if not node:
        return list(world.color)[:3]
    if node.inputs["Color"].is_linked:
        say("world: its image or sky texture is not exported: its plain colour is used")
    return [c * node.inputs["Strength"].default_value for c in list(node.inputs["Color"].default_value)[:3]]


def color_keys(material, folder: str) -> dict:
    """A section's colour or map, relative to `folder`, from a Principled Hair or Principled material; {} if it has none."""
    nodes = material.node_tree.nodes if material and material.use_nodes else []
    for node in nodes:
        if node.type == "BSDF_HAIR_PRINCIPLED" and node.parametrization == "MELANIN":
            pigment = -math.log(max(1 - node.inputs["Melanin"].default_value, 1e-4))
            # Cycles' eumelanin absorbs 0.506 where Tractrix' unit absorbs 0.419 (red).
            redness = node.inputs["Melanin Redness"].default_value
            return {"melanin": round(pigment * 0.506 / 0.419, 6), "melanin_redness": round(redness, 6)}
        if node.type in ("BSDF_HAIR_PRINCIPLED", "BSDF_PRINCIPLED"):
            entry = node.inputs.get("Color") or node.inputs.get("Base Color")
            if entry and entry.is_linked:
                return map_keys(entry.links[0].from_node, material, folder)
            if entry:
                return {"albedo": srgb(entry.default_value)}
    return {}


def map_keys(node, material, folder: str) -> dict:
    """`color_map` for an image texture that is a PNG file; other textures are left out with a warning."""
    name = bpy.path.abspath(node.image.filepath) if node.type == "TEX_IMAGE" and node.image else ""
    if name.lower().endswith(".png") and os.path.exists(name):
        return {"color_map": os.path.relpath(name, folder)}
    say(f"material '{material.name}': its colour is not exported: expected a plain colour, or an image texture of a PNG file")
    return {}


def scene_members(context, options: ExportOptions, hair: Hair, pieces: list, head: Optional[dict]) -> dict:
    """All members of the scene file for the exported hair."""
    scene, render = context.scene, context.scene.render
    folder = os.path.dirname(os.path.abspath(options.scene))
    section = {"file": os.path.relpath(options.output, folder), "unit": "m", "up": "y"}
    if hair.radius is not None:
        roots, tips = hair.radius[hair.first], hair.radius[hair.first + hair.sizes - 1]
        section["radius"] = round(max(float(roots.mean()), 1e-7), 9)
        section["tip_ratio"] = round(min(float(tips.mean() / max(roots.mean(), 1e-12)), 1), 6)
    section.update(color_keys(pieces[0].material, folder))
    share = render.resolution_percentage / 100
    members = {
        "size": [max(int(render.resolution_x * share), 1), max(int(render.resolution_y * share), 1)],
        "fps": round(hair.fps, 6), "sections": [section],
    }  # fmt: skip
    if options.frames:
        members["frames"] = options.frames[1] - options.frames[0] + 1
    if options.mesh:
        members.update(mesh=os.path.relpath(options.mesh, folder))
        if options.mesh.endswith(".obj"):
            members.update(mesh_unit="m", mesh_up="y")
        skin = color_keys(head_meshes(context, options, pieces)[0].active_material, folder)
        if "albedo" in skin:
            members["mesh_color"] = skin["albedo"]
    if head:
        members["head"] = head
    if scene.camera:
        members.update(camera_keys(context, options, hair.points.astype(np.float64).mean(0)))
    else:
        say("the scene has no camera: Tractrix uses its default camera")
    members.update(light_keys(context))
    return members


def moving_head(roots: Optional[np.ndarray], options: ExportOptions, fps: float) -> Optional[dict]:
    """The head's track if the roots move like a rigid body; reports the residual."""
    if roots is None or np.abs(roots - roots[0]).max() <= 1e-7:
        return None
    try:
        head, (residual, frame) = head_track(roots, fps)
    except HairError as error:
        say(f"{error}: no head is written")
        return None
    place = f"frame {options.frames[0] + frame}"
    if residual > options.tolerance:
        say(f"{place}: roots are {residual:.3g} m off a rigid motion, more than {options.tolerance:g} m: no head is written")
        if not options.mesh:
            say("the hair will not move: expected --mesh x.npz for the deforming body to which it is bound")
        return None
    say(f"the head's rigid motion: {len(roots)} keys, roots at most {residual:.3g} m off ({place})")
    return head


def export_hair(context, options: ExportOptions) -> None:
    """Writes everything that `options` ask for, then restores the scene's frame."""
    present = context.scene.frame_current
    try:
        if not options.output:
            write_body(context, options, head_meshes(context, options, []))
            return
        hair, pieces, roots = collect(context, options)
        if options.resample:
            hair = resample(hair, options.resample)
        write_hair(options.output, hair)
        names = ", ".join(p.name for p in pieces[:4]) + (", ..." if len(pieces) > 4 else "")
        say(f"{options.output}: {len(hair.sizes)} strands, {len(hair.points)} points of {names}")
        bound = options.mesh.endswith(".npz")
        head = None if bound else moving_head(roots, options, hair.fps)
        if options.mesh:
            meshes = head_meshes(context, options, pieces)
            moves = roots is not None and np.abs(roots - roots[0]).max() > 1e-7
            if bound or (moves and not head):
                write_body(context, options, meshes)
                options.mesh = os.path.splitext(options.mesh)[0] + ".npz"
            else:
                text = mesh_text(meshes, context.scene, context.evaluated_depsgraph_get())
                write_whole(options.mesh, lambda name: write_text(name, text))
        if options.scene:
            members = scene_members(context, options, hair, pieces, head)
            write_whole(options.scene, lambda name: write_text(name, json_text(members)))
    finally:
        context.scene.frame_set(present)


def json_text(members: dict) -> str:
    """JSON with lists of numbers and the keys of tracks on one line each."""
    text = json.dumps(members, indent=2)
    text = re.sub(r"\[\s+([^][{}]*?)\s+\]", lambda m: "[" + re.sub(r",\s+", ", ", m[1]) + "]", text)
    text = re.sub(r"\{\s+(\"time\"[^{}]*?)\s+\}", lambda m: "{" + re.sub(r",\s+", ", ", m[1]) + "}", text)
    return text + "\n"


def write_text(path: str, text: str) -> None:
    """Writes UTF-8."""
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


# --- Into Blender


def new_curves(context, name: str, hair: Hair):
    """A Curves object of poly curves with radius, texture coordinates and colour of `hair` (m, y up)."""
    unit = unit_of(context.scene)
    points = (to_z_up(hair.points) / unit).astype(np.float32)
    if hasattr(bpy.types.Curves, "add_curves"):  # Blender 4
        data = bpy.data.hair_curves.new(name)
        data.add_curves(hair.sizes.tolist())
        data.position_data.foreach_set("vector", points.ravel())
        obj = bpy.data.objects.new(name, data)
        context.scene.collection.objects.link(obj)
        kinds = data.attributes.get("curve_type") or data.attributes.new("curve_type", "INT8", "CURVE")
        kinds.data.foreach_set("value", np.full(len(hair.sizes), POLY_CURVE, np.int8))
    else:
        obj = converted_curves(context, name, points, hair)
    arrays = {
        "radius": ("FLOAT", "POINT", "value", None if hair.radius is None else hair.radius / unit),
        "surface_uv_coordinate": ("FLOAT2", "CURVE", "vector", hair.uv),
        "color": ("FLOAT_COLOR", "POINT", "color", hair.color),
    }
    for attribute, (kind, domain, member, values) in arrays.items():
        if values is not None:
            made = obj.data.attributes.get(attribute) or obj.data.attributes.new(attribute, kind, domain)
            made.data.foreach_set(member, np.ascontiguousarray(values, np.float32).ravel())
    obj.data.update_tag()
    return obj


def converted_curves(context, name: str, points: np.ndarray, hair: Hair):
    """Makes a Curves object from an old Curve, because Blender 3 has no other way. `points` are in Blender's units."""
    old = bpy.data.curves.new(name, "CURVE")
    old.dimensions = "3D"
    for first, size in zip(hair.first, hair.sizes):
        spline = old.splines.new("POLY")
        spline.points.add(int(size) - 1)
        spline.points.foreach_set("co", np.c_[points[first : first + size], np.ones(size, np.float32)].ravel())
    obj = bpy.data.objects.new(name, old)
    context.scene.collection.objects.link(obj)
    for other in context.selected_objects:
        other.select_set(False)
    obj.select_set(True)
    context.view_layer.objects.active = obj
    bpy.ops.object.convert(target="CURVES")
    return context.view_layer.objects.active


def animate(context, obj, hair: Hair) -> None:
    """Animates a Curves object with the positions of `hair.frames`: a hidden mesh has them as absolute shape keys, one for
    each frame, and a node modifier copies them. Everything is stored in the .blend file; positions between frames are
    interpolated linearly.
    """
    scene, start = context.scene, context.scene.frame_start
    mesh = bpy.data.meshes.new(obj.name + " motion")
    mesh.vertices.add(hair.frames.shape[1])
    carrier = key_shapes(context, mesh, hair.frames, "KEY_LINEAR", f"frame - {start}")
    carrier.hide_render = True
    take_positions(obj, carrier)
    carrier.hide_set(True)
    scene.frame_end = start + len(hair.frames) - 1
    set_rate(scene, hair.fps)
    scene.frame_set(start)


def key_shapes(context, mesh, samples: np.ndarray, kind: str, at: str):
    """An object of `mesh` with samples (F, V, 3; m, y up) as absolute shape keys. `at`: the visible sample as a function of
    `frame`."""
    samples = (to_z_up(samples) / unit_of(context.scene)).astype(np.float32)
    mesh.vertices.foreach_set("co", samples[0].ravel())
    obj = bpy.data.objects.new(mesh.name, mesh)
    context.scene.collection.objects.link(obj)
    for f, points in enumerate(samples):
        key = obj.shape_key_add(name=f"frame {f}", from_mix=False)
        key.interpolation = kind
        key.data.foreach_set("co", points.ravel())
    keys = mesh.shape_keys
    keys.use_relative = False
    time = keys.driver_add("eval_time").driver
    time.type, time.expression = "SCRIPTED", f"{keys.key_blocks[0].frame} + {KEYS_APART} * ({at})"
    return obj


def take_positions(obj, carrier) -> None:
    """A node modifier that moves the points of `obj` to the vertices of `carrier`, index by index."""
    tree = geometry_tree(carrier.name)
    kinds = ("NodeGroupInput", "NodeGroupOutput", "GeometryNodeObjectInfo", "GeometryNodeInputPosition",
             "GeometryNodeInputIndex", "GeometryNodeSampleIndex", "GeometryNodeSetPosition")  # fmt: skip
    begin, end, info, position, index, sample, move = (tree.nodes.new(kind) for kind in kinds)
    info.inputs["Object"].default_value = carrier
    sample.data_type = "FLOAT_VECTOR"
    vector_in = next(s for s in sample.inputs if s.type == "VECTOR" and s.enabled)
    vector_out = next(s for s in sample.outputs if s.type == "VECTOR" and s.enabled)
    links = ((begin.outputs[0], move.inputs["Geometry"]), (info.outputs["Geometry"], sample.inputs["Geometry"]),
             (position.outputs[0], vector_in), (index.outputs[0], sample.inputs["Index"]),
             (vector_out, move.inputs["Position"]), (move.outputs[0], end.inputs[0]))  # fmt: skip
    for source, sink in links:
        tree.links.new(source, sink)
    obj.modifiers.new(carrier.name, "NODES").node_group = tree


def set_rate(scene, fps: float) -> None:
    """Sets the frames per second of Blender's timeline, which stores an integer and a divisor."""
    scene.render.fps = max(round(fps), 1)
    scene.render.fps_base = scene.render.fps / fps


def import_hair(context, path: str, scale: Optional[float] = None, units: tuple = ()) -> None:
    """Imports the strands of `path` with their frames. Binary USD and `.abc` are read by Blender's importers if it has them.

    `scale`: metres of one unit in these files; None: 1 for Blender's importers; for tractrix-convert the file's unit or a
    guess.
    """
    kind = os.path.splitext(path)[1].lower()
    if not os.path.exists(path) and "%" not in path:
        raise HairError(f"{path}: no such file")
    if kind in (".abc", ".usd", ".usdc", ".usdz") and by_blender(path, kind, scale):
        return
    if kind in (".usd", ".usdc", ".usdz"):
        raise HairError(f"{path}: this Blender was built without USD: expected .usda (usdcat x.usdc -o x.usda)", FAILED)
    readers = {".npz": read_npz, ".usda": read_usda}
    if kind == ".abc" and scale:
        units = ("--unit", f"{scale:.9g}", *units)
    hair = readers[kind](path) if kind in readers else convert_hair(path, units)
    if hair.radius is None:
        hair.radius = radius_for(path, units, len(hair.points))
    obj = new_curves(context, os.path.splitext(os.path.basename(path))[0], hair)
    if hair.frames is not None:
        animate(context, obj, hair)
    frames = 1 if hair.frames is None else len(hair.frames)
    say(f"{path}: {len(hair.sizes)} strands, {len(hair.points)} points, {frames} frame{'s' * (frames != 1)}")


def radius_for(path: str, units: tuple, count: int) -> Optional[np.ndarray]:
    """(count,) the radius in m that tractrix-convert finds for a file without radii; Blender's default would be centimetres.
    None without tractrix-convert."""
    try:
        return np.full(count, convert_hair(path, units).radius.mean(), np.float32)
    except HairError as error:
        say(f"{error}: Blender's default radius is used")
        return None


def by_blender(path: str, kind: str, scale: Optional[float]) -> bool:
    """Imports with Blender's own importer, if Blender was built with it."""
    if not getattr(bpy.app.build_options, "alembic" if kind == ".abc" else "usd"):
        return False
    if kind == ".abc":
        bpy.ops.wm.alembic_import(filepath=os.path.abspath(path), scale=scale or 1.0, as_background_job=False)
    else:
        bpy.ops.wm.usd_import(filepath=os.path.abspath(path), scale=scale or 1.0)
    return True


# --- Into Blender: scene files


def track_values(track: dict, key: str, times: np.ndarray, default) -> np.ndarray:
    """(F, ...) values of a track of a scene file: monotone cubic (Fritsch and Butland 1984) or linear interpolation, constant
    outside."""
    keys = [(k["time"], k[key]) for k in track.get("keys", []) if key in k]
    if not keys:
        return np.tile(np.asarray(default, np.float64), (len(times),) + (1,) * np.ndim(default))
    t, v = np.array([k[0] for k in keys], np.float64), np.array([k[1] for k in keys], np.float64)
    if len(t) == 1:
        return np.repeat(v, len(times), 0)
    v2 = v.reshape(len(t), -1)
    h = np.diff(t)[:, None]
    d = np.diff(v2, axis=0) / h
    slope = np.zeros_like(v2)
    if track.get("interpolation") != "linear":
        weight = (h[:-1] + 2 * h[1:]) / (3 * (h[:-1] + h[1:]))
        product, mean = d[:-1] * d[1:], weight * d[1:] + (1 - weight) * d[:-1]
        slope[1:-1] = np.where(product > 0, product / np.where(product > 0, mean, 1), 0)
    at = np.clip(times, t[0], t[-1])
    k = np.clip(np.searchsorted(t, at, side="right") - 1, 0, len(t) - 2)
    s = ((at - t[k]) / h[k, 0])[:, None]
    if track.get("interpolation") == "linear":
        values = v2[k] * (1 - s) + v2[k + 1] * s
    else:
        values = (v2[k] * (1 + 2 * s) * (1 - s) ** 2 + v2[k + 1] * s**2 * (3 - 2 * s)
                  + h[k] * (slope[k] * s * (1 - s) ** 2 + slope[k + 1] * s**2 * (s - 1)))  # fmt: skip
    return values.reshape((len(times),) + v.shape[1:])


def key_pose(obj, matrices: list, start: int) -> None:
    """Places `obj` at the matrices, one for each frame from `start`. A single matrix sets no keys."""
    obj.rotation_mode = "QUATERNION"
    for f, matrix in enumerate(matrices):
        obj.location, obj.rotation_quaternion, _ = matrix.decompose()
        if len(matrices) > 1:
            obj.keyframe_insert("location", frame=start + f)
            obj.keyframe_insert("rotation_quaternion", frame=start + f)


def camera_matrix(eye: np.ndarray, target: np.ndarray, up: np.ndarray) -> Matrix:
    """Blender's matrix of a camera, from points in Blender's axes and units."""
    back = (eye - target) / max(np.linalg.norm(eye - target), 1e-12)
    right = np.cross(up, back)
    if np.linalg.norm(right) < 1e-9:
        right = np.cross([0.0, 1.0, 0.0], back)
    right = right / np.linalg.norm(right)
    matrix = np.eye(4)
    matrix[:3] = np.column_stack((right, np.cross(back, right), back, eye))
    return Matrix(matrix.tolist())


def place_camera(context, members: dict, times: np.ndarray) -> None:
    """A camera with the pose and the vertical field of view of a scene file."""
    track = members.get("camera", {})
    by_formulas = any(k in track for k in ("eye", "target", "fov"))
    if not isinstance(members.get("eye"), list) and not any("eye" in k for k in track.get("keys", [])):
        say("the camera moves by formulas: no camera is imported" if by_formulas else "the scene file has no camera: none is imported")
        return
    if by_formulas:
        say("the camera moves by formulas: they are not imported")
    scene, unit = context.scene, unit_of(context.scene)
    eye, target = (to_z_up(track_values(track, k, times, members.get(k, [0, 0, 0]))) / unit for k in ("eye", "target"))
    fov = track_values(track, "fov", times, members.get("fov", 30.0))
    up = to_z_up(np.array(members.get("camera_up", [0, 1, 0]), np.float64))
    data = bpy.data.cameras.new("Tractrix camera")
    obj = bpy.data.objects.new(data.name, data)
    scene.collection.objects.link(obj)
    data.sensor_fit, data.clip_start, data.clip_end = "VERTICAL", 0.001, 1000
    moving = len(times) > 1 and bool(track)
    count = len(times) if moving else 1
    key_pose(obj, [camera_matrix(eye[f], target[f], up) for f in range(count)], scene.frame_start)
    for f in range(count):
        data.lens = data.sensor_height / (2 * math.tan(math.radians(float(fov[f])) / 2))
        if moving:
            data.keyframe_insert("lens", frame=scene.frame_start + f)
    scene.camera = obj


def place_light(context, light: dict, number: int) -> None:
    """One light of a scene file; the reverse of `light_of`."""
    kind = light.get("type", "directional")
    data = bpy.data.lights.new(f"Tractrix light {number}", {"directional": "SUN", "point": "POINT", "spot": "SPOT"}[kind])
    obj = bpy.data.objects.new(data.name, data)
    context.scene.collection.objects.link(obj)
    data.color = linear(light.get("color", "#ffffff"))
    intensity = light.get("intensity", 1.0)
    if kind == "directional":
        data.energy, data.angle = math.pi * intensity, 0
    else:
        data.energy, data.shadow_soft_size = 4 * math.pi**2 * intensity * light.get("distance", 1.0) ** 2, 0
        obj.location = to_z_up(np.array(light["position"], np.float64)) / unit_of(context.scene)
    if kind != "point":
        way = to_z_up(np.array(light["direction"], np.float64))
        obj.rotation_mode = "QUATERNION"
        obj.rotation_quaternion = Vector(way).to_track_quat("-Z", "Y")
    if kind == "spot":
        outer, inner = math.radians(light.get("outer", 45)), math.radians(light.get("inner", 0))
        data.spot_size = 2 * outer
        data.spot_blend = (math.cos(inner) - math.cos(outer)) / (1 - math.cos(outer))


def place_body(context, path: str, members: dict) -> None:
    """A mesh that deforms, from `.npz`: its samples are shape keys at their times."""
    scene, name = context.scene, os.path.splitext(os.path.basename(path))[0]
    try:
        with np.load(path, allow_pickle=False) as arrays:
            positions, faces = arrays["positions"].astype(np.float64), arrays["faces"].astype(np.int32)
            about = {key: arrays[key].item() for key in ("fps", "unit", "up") if key in arrays}
        if positions.ndim != 3 or faces.ndim != 2 or faces.size == 0 or faces.min() < 0 or faces.max() >= positions.shape[1]:
            raise ValueError("positions and faces do not fit")
    except (OSError, KeyError, ValueError) as error:
        raise HairError(f"{path}: {error}: expected positions (samples, vertices, 3) and faces") from None
    units = {"m": 1.0, "cm": 0.01, "mm": 0.001, "in": 0.0254}
    positions *= units.get(members.get("mesh_unit"), float(about.get("unit", 1.0)))
    if members.get("mesh_up", about.get("up", "y")) == "z":
        positions = to_y_up(positions)
    if members.get("head"):
        say("the mesh deforms: its samples move it, the keys of the head do not")
    fps = frames_per_second(scene)
    rate = members.get("mesh_fps", about.get("fps", fps))
    rate = fps if rate == "auto" else float(rate)
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(np.zeros((positions.shape[1], 3)).tolist(), [], faces.tolist())
    kind = "KEY_LINEAR" if members.get("mesh_motion") == "linear" or len(positions) == 1 else "KEY_CATMULL_ROM"
    seconds = f"(frame - {scene.frame_start}) / {fps:.9g} * {float(members.get('speed', 1)):.9g}"
    key_shapes(context, mesh, positions, kind, f"({seconds} - {float(members.get('mesh_start', 0)):.9g}) * {rate:.9g}")


def place_mesh(context, path: str, members: dict, times: np.ndarray) -> None:
    """The scene file's mesh, moved by its head."""
    scene = context.scene
    unit = {"m": 1.0, "cm": 0.01, "mm": 0.001, "in": 0.0254}.get(members.get("mesh_unit", "m"), 1.0) / unit_of(scene)
    before = set(bpy.data.objects)
    axes = {"up_axis": "Z", "forward_axis": "Y"} if members.get("mesh_up") == "z" else {"up_axis": "Y", "forward_axis": "NEGATIVE_Z"}
    bpy.ops.wm.obj_import(filepath=path, **axes)
    head = members.get("head", {})
    if any(isinstance(head.get(k), list) for k in ("translate", "rotate")):
        say("the head moves by formulas, which are not imported: the mesh does not move")
    pivot = np.array(head.get("pivot", [0, 0, 0]), np.float64)
    move, turn = (track_values(head, k, times, [0, 0, 0]) for k in ("translate", "rotate"))
    count = len(times) if head.get("keys") else 1
    poses = []
    for f in range(count):
        axis, centre = to_z_up(turn[f]), to_z_up(pivot) / unit_of(scene)
        angle = math.radians(float(np.linalg.norm(axis)))
        spin = Matrix.Rotation(angle, 4, Vector(axis) if angle else Vector((0, 0, 1)))
        shift = Vector(to_z_up(move[f]) / unit_of(scene) + centre)
        poses.append(Matrix.Translation(shift) @ spin @ Matrix.Translation(Vector(-centre)))
    for obj in set(bpy.data.objects) - before:
        turned = obj.matrix_world.to_3x3().to_4x4()  # apply the importer's rotation to the vertices
        obj.data.transform(Matrix.Scale(unit, 4) @ turned)
        obj.matrix_world = Matrix.Identity(4)
        key_pose(obj, poses, scene.frame_start)


def import_scene(context, path: str) -> None:
    """Imports camera, lights, world, mesh, size and frame rate of a scene file of Tractrix. Hair is imported separately."""
    try:
        with open(path, encoding="utf-8") as file:
            members = json.load(file)
        if not isinstance(members, dict):
            raise ValueError("not an object")
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise HairError(f"{path}: {reason}: expected a scene file") from None
    scene = context.scene
    fps, count = float(members.get("fps", 60)), int(members.get("frames", 120))
    set_rate(scene, fps)
    size = members.get("size", [960, 960])
    size = [int(n) for n in size.split("x")] if isinstance(size, str) else size
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.render.resolution_percentage = 100
    scene.frame_end = scene.frame_start + count - 1
    times = np.arange(count) / fps * float(members.get("speed", 1))
    place_camera(context, members, times)
    if "lights" not in members:
        say("the scene file has no lights: none are imported")
    for number, light in enumerate(members.get("lights", [])):
        place_light(context, light, number)
    if "mesh" in members:
        mesh = os.path.join(os.path.dirname(os.path.abspath(path)), members["mesh"])
        if mesh.endswith(".npz"):
            place_body(context, mesh, members)
        elif mesh.endswith(".obj") and "%" not in mesh:
            place_mesh(context, mesh, members, times)
        else:
            say(f"{mesh}: the mesh is not imported: expected .obj or .npz")
    world = scene.world = scene.world or bpy.data.worlds.new("World")
    world.use_nodes = False
    if "sky" in members:
        world.color = [(a + b) / 2 for a, b in zip(linear(members["sky"]), linear(members.get("ground", members["sky"])))]
    scene.render.film_transparent = members.get("background") == "transparent"
    if isinstance(members.get("exposure"), (int, float)):
        scene.view_settings.exposure = members["exposure"]
    scene.view_settings.view_transform = "Standard" if members.get("tone_map") == "none" else scene.view_settings.view_transform


# --- Command line


class Parser(argparse.ArgumentParser):
    """A parser whose errors are one line and status 2."""

    def error(self, message: str):
        raise HairError(f"command line: {message}: --help lists what is expected", USAGE)


def frame_range(text: str) -> tuple:
    """`A:B` or `scene`."""
    if text == "scene":
        return (bpy.context.scene.frame_start, bpy.context.scene.frame_end)
    match = re.fullmatch(r"(-?\d+):(-?\d+)", text)
    if not match or int(match[1]) > int(match[2]):
        raise HairError(f"--frames {text}: expected FIRST:LAST or scene", USAGE)
    return (int(match[1]), int(match[2]))


SCALE_HELP = "metres of one unit of an .abc or binary USD file; without: 1 for Blender's importers, else as the file says or as it is guessed"


def parser() -> Parser:
    """Parses the arguments after `--`."""
    top = Parser(prog="blender_hair", description="Hair from Blender to Tractrix and back.")
    commands = top.add_subparsers(dest="command", required=True, parser_class=Parser)
    out = commands.add_parser("export", help="hair of the scene, or of a file that Blender imports, to .tfx or .npz")
    out.add_argument("input", nargs="?", default="", help=".abc, .usda, .usdc, .npz, .blend, .glb, .gltf or .fbx; without it the open scene")
    out.add_argument("-o", "--output", default="", help="x.npz, or x.tfx (TressFX 4; text where strands differ in size)")
    out.add_argument("--frames", default="", help="FIRST:LAST or scene: export these frames, for .npz files and the head's motion")
    out.add_argument("--objects", default="", help="names, separated by commas; without: all visible objects with hair")
    out.add_argument("--children", choices=("parents", "children", "all"), default="parents", help="which hair of particle systems")
    out.add_argument("--resample", type=int, default=0, metavar="N", help="N points a strand, at equal distances")
    out.add_argument("--mesh", default="", metavar="x.obj", help="also write the mesh that hair grows on; x.npz: over all frames. Alone, without -o, all visible meshes")
    out.add_argument("--mesh-object", default="", metavar="NAME", help="object for --mesh and for texture coordinates")
    out.add_argument("--scene", default="", metavar="x.json", help="also write a scene file: camera, lights, head, look")
    out.add_argument("--scale", type=float, metavar="M", help=SCALE_HELP)
    out.add_argument("--tolerance", type=float, default=TOLERANCE_M, metavar="M", help="largest distance of roots from a rigid motion of the head, metres")
    back = commands.add_parser("import", help="hair and scene files into Blender")
    back.add_argument("input", nargs="?", default="", help=".npz, .usda, .abc, .cache, x_%%04d.tfx or any hair file")
    back.add_argument("--scene", default="", metavar="x.json", help="camera, lights and mesh of a scene file of Tractrix")
    back.add_argument("--unit", default="", help="unit of hair files that do not state one: m, cm, mm, in or a number of metres")
    back.add_argument("--up", choices=("y", "z"), help="axis that points up in hair files that do not state one")
    back.add_argument("--scale", type=float, metavar="M", help=SCALE_HELP)
    back.add_argument("-o", "--output", default="", help="x.blend; x.abc or x.usd where Blender was built with them")
    return top


def open_input(path: str, scale: Optional[float]) -> None:
    """Opens a .blend file, or imports a file of hair into an empty scene."""
    if path.endswith(".blend"):
        if not os.path.exists(path):
            raise HairError(f"{path}: no such file")
        try:
            bpy.ops.wm.open_mainfile(filepath=path)
        except RuntimeError:
            raise HairError(f"{path}: expected a .blend file") from None
    elif path:
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        kind = os.path.splitext(path)[1].lower()
        if kind in (".glb", ".gltf", ".fbx"):
            import_character(bpy.context, path, kind)
        else:
            import_hair(bpy.context, path, scale)


def import_character(context, path: str, kind: str) -> None:
    """Imports a skinned character with Blender's own importer; the timeline gets the range of its actions."""
    if not os.path.exists(path):
        raise HairError(f"{path}: no such file")
    if "bool" not in vars(np):  # Debian 12's glTF importer uses a name that its numpy no longer has
        np.bool = bool
    importer = bpy.ops.import_scene.fbx if kind == ".fbx" else bpy.ops.import_scene.gltf
    try:
        importer(filepath=os.path.abspath(path))
    except (RuntimeError, AttributeError) as error:
        raise HairError(f"{path}: Blender cannot import it: {str(error).strip().splitlines()[-1]}") from None
    ranges = [action.frame_range for action in bpy.data.actions]
    if ranges:
        context.scene.frame_start = math.floor(min(r[0] for r in ranges))
        context.scene.frame_end = math.ceil(max(r[1] for r in ranges))


def save(path: str) -> None:
    """Writes the scene to `.blend`, `.abc` or `.usd`."""
    kind = os.path.splitext(path)[1].lower()
    if kind == ".blend":
        if not os.path.isdir(os.path.dirname(os.path.abspath(path))):
            raise HairError(f"{path}: no such folder", FAILED)
        bpy.ops.wm.save_as_mainfile(filepath=os.path.abspath(path), check_existing=False)
    elif kind == ".abc" and bpy.app.build_options.alembic:
        bpy.ops.wm.alembic_export(filepath=os.path.abspath(path), as_background_job=False)
    elif kind.startswith(".usd") and bpy.app.build_options.usd:
        bpy.ops.wm.usd_export(filepath=os.path.abspath(path), export_animation=True)
    elif kind == ".abc" or kind.startswith(".usd"):
        raise HairError(f"{path}: this Blender was built without {'Alembic' if kind == '.abc' else 'USD'}: expected .blend", FAILED)
    else:
        raise HairError(f"{path}: unknown kind of file: expected .blend, .abc or .usd", USAGE)


def run_export(words: argparse.Namespace) -> None:
    """`export`."""
    if not words.output and (not words.mesh.endswith(".npz") or words.scene):
        raise HairError("command line: expected -o x.npz or x.tfx for hair, or --mesh x.npz alone", USAGE)
    if words.mesh and not words.mesh.endswith((".obj", ".npz")):
        raise HairError(f"{words.mesh}: unknown kind of file: expected .obj or .npz", USAGE)
    if words.output and not words.output.endswith((".npz", ".tfx")):
        raise HairError(f"{words.output}: unknown kind of file: expected .npz or .tfx", USAGE)
    if words.resample and words.resample < 2:
        raise HairError(f"--resample {words.resample}: expected at least 2", USAGE)
    open_input(words.input, words.scale)
    chosen = vars(words).copy()
    chosen["frames"] = frame_range(words.frames) if words.frames else None
    chosen["objects"] = [n for n in words.objects.split(",") if n]
    for name in ("command", "input", "scale"):
        del chosen[name]
    export_hair(bpy.context, ExportOptions(**chosen))


def run_import(words: argparse.Namespace) -> None:
    """`import`."""
    if not words.input and not words.scene:
        raise HairError("command line: nothing to import: expected a file or --scene", USAGE)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    if words.scene:
        import_scene(bpy.context, words.scene)
    if words.input:
        given = (("--unit", words.unit), ("--up", words.up))
        import_hair(bpy.context, words.input, words.scale, tuple(part for pair in given if pair[1] for part in pair))
    if words.output:
        save(words.output)


def main(arguments: list) -> int:
    """Runs a command line; returns the exit status."""
    try:
        words = parser().parse_args(arguments)
        {"export": run_export, "import": run_import}[words.command](words)
        return DONE
    except HairError as error:
        say(str(error))
        return error.status
    except SystemExit as stop:  # --help
        return int(stop.code or 0)
    except Exception as error:  # pylint: disable=broad-except  # Blender itself would end with status 0
        if os.environ.get("TRACTRIX_TRACE"):
            traceback.print_exc()
        say(f"{type(error).__name__}: {str(error).splitlines()[0] if str(error) else 'without a message'}")
        return FAILED


# --- Add-on


class TRACTRIX_OT_export(bpy.types.Operator):  # pylint: disable=invalid-name
    """Write the scene's hair for Tractrix"""

    bl_idname = "export_scene.tractrix_hair"
    bl_label = "Export Tractrix hair"

    filepath: bpy.props.StringProperty(subtype="FILE_PATH", default="hair.npz")
    filter_glob: bpy.props.StringProperty(default="*.npz;*.tfx", options={"HIDDEN"})
    children: bpy.props.EnumProperty(
        name="Particle hair", items=[(w, w.capitalize(), "") for w in ("parents", "children", "all")], default="parents"
    )
    animation: bpy.props.BoolProperty(name="Animation", description="All frames of the scene, and the head's motion")
    resample: bpy.props.IntProperty(name="Points a strand", description="0: as they are", default=0, min=0, max=10000)
    mesh: bpy.props.BoolProperty(name="Mesh", description="Also write NAME.obj, the mesh that hair grows on")
    scene: bpy.props.BoolProperty(name="Scene file", description="Also write NAME.json: camera, lights, head, look", default=True)

    def execute(self, context):
        """Writes the files."""
        path = bpy.path.abspath(self.filepath)
        stem = os.path.splitext(path)[0]
        frames = (context.scene.frame_start, context.scene.frame_end) if self.animation else None
        options = ExportOptions(
            path, frames, [], self.children, self.resample, stem + ".obj" if self.mesh else "", scene=stem + ".json" if self.scene else ""
        )
        return attempt(self, lambda: export_hair(context, options))

    def invoke(self, context, _event):
        """Asks for the file."""
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}


class TRACTRIX_OT_import(bpy.types.Operator):  # pylint: disable=invalid-name
    """Read hair that Tractrix made, or a scene file of Tractrix"""

    bl_idname = "import_scene.tractrix_hair"
    bl_label = "Import Tractrix hair"
    bl_options = {"UNDO"}

    filepath: bpy.props.StringProperty(subtype="FILE_PATH")
    filter_glob: bpy.props.StringProperty(default="*.npz;*.usda;*.tfx;*.hair;*.cache;*.abc;*.json", options={"HIDDEN"})

    def execute(self, context):
        """Reads the file."""
        path = bpy.path.abspath(self.filepath)
        read = import_scene if path.endswith(".json") else import_hair
        return attempt(self, lambda: read(context, path))

    invoke = TRACTRIX_OT_export.invoke


def attempt(operator, work: Callable[[], object]) -> set:
    """Runs `work` for an operator and reports a HairError in Blender's window."""
    try:
        work()
    except HairError as error:
        operator.report({"ERROR"}, str(error))
        return {"CANCELLED"}
    return {"FINISHED"}


def export_entry(menu, _context):
    """The line in File > Export."""
    menu.layout.operator(TRACTRIX_OT_export.bl_idname, text="Tractrix hair (.npz, .tfx)")


def import_entry(menu, _context):
    """The line in File > Import."""
    menu.layout.operator(TRACTRIX_OT_import.bl_idname, text="Tractrix hair (.npz, .usda, .tfx, .json)")


def register():
    """Called by Blender when the add-on is switched on."""
    bpy.utils.register_class(TRACTRIX_OT_export)
    bpy.utils.register_class(TRACTRIX_OT_import)
    bpy.types.TOPBAR_MT_file_export.append(export_entry)
    bpy.types.TOPBAR_MT_file_import.append(import_entry)


def unregister():
    """Called by Blender when the add-on is switched off."""
    bpy.types.TOPBAR_MT_file_import.remove(import_entry)
    bpy.types.TOPBAR_MT_file_export.remove(export_entry)
    bpy.utils.unregister_class(TRACTRIX_OT_import)
    bpy.utils.unregister_class(TRACTRIX_OT_export)


if __name__ == "__main__":
    sys.exit(main(sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else sys.argv[1:]))
