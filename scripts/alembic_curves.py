# SPDX-License-Identifier: MIT
"""Reads the curves of an Alembic file (.abc, Ogawa), with numpy alone: for a Blender that was built without Alembic.

    python3 alembic_curves.py groom.abc -o groom.npz [--scale 0.01]

The layout follows Alembic's own reader (lib/Alembic/Ogawa, lib/Alembic/AbcCoreOgawa, lib/Alembic/AbcGeom). A file is a
tree of groups and data. An object's group holds its properties, its children and their headers; a property's group holds
a piece of data for each sample that differs from the one before.
"""

import argparse
import os
import struct
import sys
from dataclasses import dataclass, field

import numpy as np

PODS = ("?", "u1", "i1", "<u2", "<i2", "<u4", "<i4", "<u8", "<i8", "<f2", "<f4", "<f8")
DATA_BIT = 1 << 63
KEY_BYTES, HASH_BYTES = 16, 32
CUBIC, LINEAR = 0, 1
BSPLINE, CATMULL_ROM = 2, 3
SCALE, TRANSLATE, ROTATE, MATRIX, ROTATE_X, ROTATE_Y, ROTATE_Z = range(7)
CHANNELS = {SCALE: 3, TRANSLATE: 3, ROTATE: 4, MATRIX: 16, ROTATE_X: 1, ROTATE_Y: 1, ROTATE_Z: 1}
MOST_DEPTH = 64
MOST_NUMBERS = 1 << 31  # in all frames of one object


class AlembicError(Exception):
    """One line: place, what is wrong, what was expected."""


@dataclass
class Property:
    """A property's header: samples first .. last differ from the one before each, all others repeat."""

    compound: bool
    array: bool
    kind: str  # numpy's
    extent: int  # numbers of one item
    samples: int
    first: int
    last: int
    sampling: int
    group: int  # place of its group


@dataclass
class Node:
    """An object: its schema, group, and the samples of its transforms above, outermost first."""

    name: str
    schema: str
    group: int
    above: list = field(default_factory=list)  # arrays (1 or F, 4, 4) of row vectors' matrices
    rate: float = 0.0  # their samples a second; 0: still


class Archive:
    """The bytes of a file, its time samplings and its texts."""

    def __init__(self, path: str):
        self.path = path
        with open(path, "rb") as file:
            self.bytes = file.read()
        if self.bytes[:5] != b"Ogawa":
            old = "HDF5, the form before 2013" if self.bytes[1:4] == b"HDF" else "no Alembic file"
            raise AlembicError(f"{path}: {old}: expected Ogawa")
        if len(self.bytes) < 16 or self.bytes[5] != 0xFF:
            raise self.wrong(5, "the file was not closed: expected a complete one")
        top = self.children(self.number(8))
        if len(top) < 6:
            raise self.wrong(8, f"{len(top)} parts: expected 6")
        self.rates = self.samplings(self.data(top[4]))
        self.texts = [b""] + self.indexed(self.data(top[5]))
        self.top = top[2]

    def wrong(self, at: int, what: str) -> AlembicError:
        """An error at a byte."""
        return AlembicError(f"{self.path}: byte {at}: {what}")

    def number(self, at: int) -> int:
        """The 64-bit number at a byte."""
        if at + 8 > len(self.bytes):
            raise self.wrong(at, "the file ends: expected 8 more bytes")
        return struct.unpack_from("<Q", self.bytes, at)[0]

    def children(self, group: int) -> list:
        """The places of a group's children; DATA_BIT marks data."""
        if group & DATA_BIT:
            raise self.wrong(group & ~DATA_BIT, "data: expected a group")
        count = self.number(group) if group else 0
        if count > (len(self.bytes) - group) // 8 - 1:
            raise self.wrong(group, f"a group of {count} parts: expected what fits into the file")
        return list(struct.unpack_from(f"<{count}Q", self.bytes, group + 8)) if count else []

    def data(self, place: int) -> bytes:
        """The bytes of a child that is data."""
        if not place & DATA_BIT:
            raise self.wrong(place, "a group: expected data")
        at = place & ~DATA_BIT
        size = self.number(at) if at else 0
        if size > len(self.bytes) - at - 8:
            raise self.wrong(at, f"data of {size} bytes: expected what fits into the file")
        return self.bytes[at + 8 : at + 8 + size] if at else b""

    @staticmethod
    def samplings(data: bytes) -> list:
        """Samples a second of each time sampling; 0: not even."""
        rates, at = [], 0
        while at + 16 <= len(data):
            _, step, times = struct.unpack_from("<IdI", data, at)
            even = times == 1 and 0 < step < 1e6
            rates.append(1 / step if even else 0.0)
            at += 16 + 8 * times
        return rates

    @staticmethod
    def indexed(data: bytes) -> list:
        """Texts of one byte's length each."""
        texts, at = [], 0
        while at < len(data):
            texts.append(data[at + 1 : at + 1 + data[at]])
            at += 1 + data[at]
        return texts

    def text(self, index: int) -> bytes:
        """A text that a header names by number."""
        if index >= len(self.texts):
            raise AlembicError(f"{self.path}: text {index} of {len(self.texts)}: expected one that is there")
        return self.texts[index]

    def rate(self, made: Property) -> float:
        """Samples of a property in a second; 0 where they are uneven."""
        return self.rates[made.sampling] if made.sampling < len(self.rates) else 0.0

    def objects(self, group: int) -> list:
        """Name, metadata and group of an object's children."""
        parts = self.children(group)
        if not parts or not parts[-1] & DATA_BIT:
            return []
        headers, at, found = self.data(parts[-1])[:-HASH_BYTES], 0, []
        while at + 4 < len(headers) and len(found) + 2 < len(parts):
            (length,) = struct.unpack_from("<I", headers, at)
            name = headers[at + 4 : at + 4 + length]
            at += 4 + length
            index = headers[at] if at < len(headers) else 0
            at += 1
            if index == 0xFF and at + 4 <= len(headers):
                (length,) = struct.unpack_from("<I", headers, at)
                meta = headers[at + 4 : at + 4 + length]
                at += 4 + length
            else:
                meta = self.text(index)
            found.append((name.decode("utf-8", "replace"), meta.decode("utf-8", "replace"), parts[len(found) + 1]))
        return found

    def properties(self, group: int) -> dict:
        """The properties of a compound by name."""
        parts = self.children(group)
        if not parts or not parts[-1] & DATA_BIT:
            return {}
        data, at, found = self.data(parts[-1]), 0, {}
        try:
            while at < len(data) and len(found) < len(parts) - 1:
                name, made, at = self.property(data, at, parts[len(found)])
                found[name] = made
        except struct.error:
            raise self.wrong(parts[-1] & ~DATA_BIT, "a property's header is cut off") from None
        return found

    def property(self, data: bytes, at: int, group: int) -> tuple:
        """Name and Property of the header at a byte of `data`, and where the next one begins."""
        (info,) = struct.unpack_from("<I", data, at)
        at += 4
        form = "<" + "BHI?"[(info >> 2) & 3]
        width = struct.calcsize(form)

        def take() -> int:
            nonlocal at
            at += width
            return struct.unpack_from(form, data, at - width)[0]

        made = Property(info & 3 == 0, info & 2 != 0, "", (info >> 12) & 0xFF, 0, 0, 0, 0, group)
        if not made.compound:
            pod = (info >> 4) & 15
            made.kind = PODS[pod] if pod < len(PODS) else ""
            made.samples = take()
            if info & 0x200:
                made.first, made.last = take(), take()
            elif not info & 0x800:
                made.first, made.last = 1, made.samples - 1
            if info & 0x100:
                made.sampling = take()
        length = take()
        name = data[at : at + length].decode("utf-8", "replace")
        at += length
        if (info >> 20) & 0xFF == 0xFF:
            at += take()
        return name, made, at

    def sample(self, made: Property, index: int) -> np.ndarray:
        """Sample `index` of a property, the last one where it has fewer: (N, extent), or (N,) of extent 1."""
        index = min(index, made.samples - 1)
        if index < made.first or made.last == 0:
            place = 0
        else:
            place = min(index, made.last) - made.first + 1
        parts = self.children(made.group)
        place *= 2 if made.array else 1
        if place >= len(parts) or not made.kind:
            raise self.wrong(made.group, f"sample {index} of a property: expected numbers that are there")
        data = self.data(parts[place])[KEY_BYTES:]
        values = np.frombuffer(data[: len(data) // np.dtype(made.kind).itemsize * np.dtype(made.kind).itemsize], made.kind)
        if made.extent > 1 and len(values) % made.extent == 0:
            values = values.reshape(-1, made.extent)
        return values


def walk(archive: Archive) -> list:
    """All objects that hold curves."""
    found, waiting, seen = [], [(Node("", "", archive.top), 0)], {0}
    while waiting:
        node, depth = waiting.pop()
        if node.schema.startswith("AbcGeom_Curve"):
            found.append(node)
        if depth > MOST_DEPTH or (node.group in seen and depth and node.group):
            raise AlembicError(f"{archive.path}: {node.name}: an object within itself, or more than {MOST_DEPTH} deep: expected a tree")
        seen.add(node.group)
        for name, meta, group in reversed(archive.objects(node.group)):
            schema = dict(part.split("=", 1) for part in meta.split(";") if "=" in part).get("schema", "")
            child = Node(f"{node.name}/{name}", schema, group, list(node.above), node.rate)
            if schema.startswith("AbcGeom_Xform"):
                add_transform(archive, child)
            waiting.append((child, depth + 1))
    return found


def compound_of(archive: Archive, node: Node, name: str) -> dict:
    """The properties of an object's schema, {} if it has none."""
    parts = archive.children(node.group)
    own = archive.properties(parts[0]) if parts and not parts[0] & DATA_BIT else {}
    return archive.properties(own[name].group) if name in own and own[name].compound else {}


def add_transform(archive: Archive, node: Node) -> None:
    """Appends the matrices of a transform to those above the node; one that does not inherit begins anew."""
    own = compound_of(archive, node, ".xform")
    if ".inherits" in own and not archive.sample(own[".inherits"], 0).any():
        node.above.clear()
    if ".ops" not in own or ".vals" not in own:
        return
    steps = [int(op) >> 4 for op in np.ravel(archive.sample(own[".ops"], 0))]
    values = own[".vals"]
    count = 1 if values.last == 0 else values.samples
    samples = [np.ravel(archive.sample(values, i)).astype(np.float64) for i in range(max(count, 1))]
    if any(s not in CHANNELS for s in steps) or any(len(v) < sum(CHANNELS[s] for s in steps) for v in samples):
        raise AlembicError(f"{archive.path}: {node.name}: a transform that is not understood: expected numbers for each of its steps")
    node.above.append(np.stack([matrix_of(steps, v) for v in samples]))
    if count > 1:
        node.rate = archive.rate(values)


def matrix_of(steps: list, values: np.ndarray) -> np.ndarray:
    """(4, 4) for row vectors: the last step acts first, as in Alembic."""
    matrix, at = np.eye(4), 0
    for step in steps:
        given = values[at : at + CHANNELS[step]]
        at += CHANNELS[step]
        one = np.eye(4)
        if step == SCALE:
            one[range(3), range(3)] = given
        elif step == TRANSLATE:
            one[3, :3] = given
        elif step == MATRIX:
            one = given.reshape(4, 4)
        else:
            axis = given[:3] if step == ROTATE else np.eye(3)[step - ROTATE_X]
            one[:3, :3] = turn(axis, np.radians(given[-1])).T
        matrix = one @ matrix
    return matrix


def turn(axis: np.ndarray, angle: float) -> np.ndarray:
    """(3, 3) rotation of column vectors (Rodrigues)."""
    x, y, z = axis / max(np.linalg.norm(axis), 1e-12)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def through(points: np.ndarray, sizes: np.ndarray) -> np.ndarray:
    """Points (F, V, 3) on uniform cubic B-splines for their control points: at the knots; the ends stay."""
    first = np.cumsum(sizes) - sizes
    inner = np.ones(points.shape[1], bool)
    inner[first], inner[first + sizes - 1] = False, False
    at = np.flatnonzero(inner)
    moved = points.copy()
    moved[:, at] = (points[:, at - 1] + 4 * points[:, at] + points[:, at + 1]) / 6
    return moved


def parameter(archive: Archive, own: dict, name: str) -> np.ndarray:
    """The first sample of a geometry parameter, indexed or not; None if there is none."""
    made = own.get(name)
    if made is None:
        return None
    if not made.compound:
        return archive.sample(made, 0)
    inner = archive.properties(made.group)
    if ".vals" not in inner:
        return None
    values = archive.sample(inner[".vals"], 0)
    indices = archive.sample(inner[".indices"], 0) if ".indices" in inner else np.arange(len(values))
    if len(indices) and indices.max() >= len(values):
        raise AlembicError(f"{archive.path}: '{name}' has {len(values)} values: expected more than index {indices.max()}")
    return values[indices]


def curves_of(archive: Archive, node: Node) -> dict:
    """The arrays of one object: frames (F, V, 3), sizes (S,), uv (S, 2), radius (V,), rate."""
    own = compound_of(archive, node, ".geom")
    place = f"{archive.path}: {node.name}"
    if "P" not in own or "nVertices" not in own:
        raise AlembicError(f"{place}: no positions: expected P and nVertices")
    positions, counts = own["P"], own["nVertices"]
    sizes = archive.sample(counts, 0).astype(np.int64)
    kind, wrap, basis = (
        (int(b) for b in np.ravel(archive.sample(own["curveBasisAndType"], 0))[:3]) if "curveBasisAndType" in own else (1, 0, 0)
    )
    if wrap or counts.last > 0 or (kind != LINEAR and not (kind == CUBIC and basis in (BSPLINE, CATMULL_ROM))):
        raise AlembicError(
            f"{place}: closed curves, Bezier curves or changing numbers of points: expected linear, B-spline or Catmull-Rom curves"
        )
    count = max([1 if positions.last == 0 else positions.samples] + [len(m) for m in node.above])
    if count * max(int(sizes.sum()), 1) > MOST_NUMBERS // 3:
        raise AlembicError(f"{place}: {count} samples of {sizes.sum()} positions: expected fewer")
    frames = []
    for i in range(count):
        points = archive.sample(positions, i).astype(np.float64)
        if points.ndim != 2 or points.shape[1] != 3 or sizes.sum() != len(points) or (len(sizes) and sizes.min() < 0):
            raise AlembicError(f"{place}: {len(points)} positions: expected {sizes.sum()}")
        for matrix in reversed(node.above):
            m = matrix[min(i, len(matrix) - 1)]
            points = points @ m[:3, :3] + m[3, :3]
        frames.append(points)
    frames = np.stack(frames)
    if kind == CUBIC and basis == BSPLINE:
        frames = through(frames, sizes)
    rate = node.rate if positions.last == 0 else archive.rate(positions)
    return {"frames": frames, "sizes": sizes, "rate": rate, **looks(archive, own, sizes)}


def looks(archive: Archive, own: dict, sizes: np.ndarray) -> dict:
    """Texture coordinates (S, 2) and radii (V,) of curves, None where the file has none."""
    uv, width = parameter(archive, own, "uv"), parameter(archive, own, "width")
    total, first = int(sizes.sum()), np.cumsum(sizes) - sizes
    if uv is not None:
        uv = uv if uv.ndim == 2 and uv.shape[1] == 2 else uv[:0]
        uv = uv if len(uv) == len(sizes) else uv[first] if len(uv) == total else None
    if width is not None:
        width = np.ravel(width)
        spread = {1: lambda: np.full(total, width[0]), len(sizes): lambda: np.repeat(width, sizes), total: lambda: width}
        width = spread[len(width)]() / 2 if len(width) in spread else None
    return {"uv": uv, "radius": width}


@np.errstate(all="ignore")  # what is not finite is refused
def read(path: str, scale: float = 1.0) -> dict:
    """All curves of a file: points (V, 3) and, with several samples, frames (F, V, 3) in metres, y up; sizes (S,); uv (S, 2) and
    radius (V,) or None; fps. `scale`: metres of one unit. Raises AlembicError."""
    try:
        archive = Archive(path)
        parts = [curves_of(archive, node) for node in walk(archive)]
    except OSError as error:
        raise AlembicError(f"{path}: {error.strerror}") from None
    except (ValueError, IndexError, struct.error, MemoryError) as error:
        raise AlembicError(f"{path}: damaged: {error}") from None
    parts = [p for p in parts if len(p["sizes"])]
    if not parts:
        raise AlembicError(f"{path}: no curves: expected a groom")
    count = max(len(p["frames"]) for p in parts)
    if any(len(p["frames"]) not in (1, count) for p in parts):
        raise AlembicError(f"{path}: curves of different numbers of samples: expected the same for all that move")
    frames = np.concatenate([np.broadcast_to(p["frames"], (count, *p["frames"].shape[1:])) for p in parts], 1)
    frames = (frames * scale).astype(np.float32)
    if not np.isfinite(frames).all():
        raise AlembicError(f"{path}: positions that are not finite: expected numbers")
    result = {"points": frames[0], "sizes": np.concatenate([p["sizes"] for p in parts]).astype(np.int32)}
    for name, factor in (("uv", 1.0), ("radius", scale)):
        values = [p[name] for p in parts]
        result[name] = None if any(v is None for v in values) else (np.concatenate(values) * factor).astype(np.float32)
    result["frames"] = frames if count > 1 else None
    result["fps"] = next((p["rate"] for p in parts if p["rate"] > 0 and len(p["frames"]) > 1), 24.0)
    return result


def arrays(hair: dict) -> dict:
    """What a .npz file of Tractrix holds: positions (S, P, 3) where all strands have as many points, else points and sizes."""
    sizes = hair["sizes"]
    even = (sizes == sizes[0]).all()
    shape = (len(sizes), int(sizes[0]), 3)
    made = {"positions": hair["points"].reshape(shape)} if even else {"points": hair["points"], "sizes": sizes}
    if hair["frames"] is not None:
        made["frames"] = hair["frames"].reshape(-1, *shape) if even else hair["frames"]
    made.update({name: hair[name] for name in ("uv", "radius") if hair[name] is not None})
    return {**made, "fps": np.float32(hair["fps"]), "unit": np.float32(1), "up": np.array("y")}


def main() -> int:
    """The command line."""
    parser = argparse.ArgumentParser(prog="alembic_curves", description="Curves of an Alembic file to .npz.")
    parser.add_argument("input", help=".abc")
    parser.add_argument("-o", "--output", required=True, help=".npz")
    parser.add_argument("--scale", type=float, default=1.0, help="metres of one unit of the file (default 1)")
    words = parser.parse_args()
    try:
        made = arrays(read(words.input, words.scale))
        with open(words.output + ".part", "wb") as file:
            np.savez(file, **made)
        os.replace(words.output + ".part", words.output)
    except (AlembicError, OSError) as error:
        print(f"alembic_curves: {error}", file=sys.stderr)
        return 3 if isinstance(error, AlembicError) else 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
