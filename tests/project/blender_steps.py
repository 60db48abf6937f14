# SPDX-License-Identifier: MIT
"""Runs inside Blender (test_blender.sh): each step builds a scene, exports or imports it by blender_hair.py and compares.

Arguments after `--`: folder of the programs, scratch folder. The last line is `N passed, N failed, N skipped`.
"""

import contextlib
import io
import json
import math
import os
import subprocess
import sys
import traceback

import bmesh
import bpy
import numpy as np
from bpy_extras.object_utils import world_to_camera_view
from mathutils import Euler, Matrix, Vector

BIN, WORK = sys.argv[sys.argv.index("--") + 1 :][:2]
ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "scripts"))
sys.dont_write_bytecode = True
import blender_hair as hair  # noqa: E402  pylint: disable=wrong-import-position

os.environ["TRACTRIX_CONVERT"] = os.path.join(BIN, "tractrix-convert")

COUNTS = {"passed": 0, "failed": 0, "skipped": 0}
EVERY_STEP = []


def step(function):
    """Adds a test."""
    EVERY_STEP.append(function)
    return function


def check(what, holds, got=""):
    """Counts a test; prints it if it fails."""
    COUNTS["passed" if holds else "failed"] += 1
    if not holds:
        print(f"FAILED: {what}: {got}", flush=True)


def skip(why):
    """Counts a test that cannot run here."""
    COUNTS["skipped"] += 1
    print(f"skipped: {why}", flush=True)


def path(name):
    """A file in the scratch folder."""
    return os.path.join(WORK, name)


def tractrix(*words):
    """Runs tractrix-render or another program; a failure shows its error output."""
    done = subprocess.run([os.path.join(BIN, words[0]), *words[1:]], capture_output=True, text=True, check=False)
    check(" ".join(words[:2]) + " runs", done.returncode == 0, done.stderr)


def empty():
    """An empty scene."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)


def export(*words, status=hair.DONE):
    """Exports by the command line."""
    got = hair.main(["export", *words])
    check(f"export {' '.join(words)} ends with {status}", got == status, got)


def some_hair(strands=6, size=5, seed=1, ragged=False):
    """Strands in a unit box with all properties."""
    rng = np.random.default_rng(seed)
    sizes = rng.integers(2, 9, strands) if ragged else np.full(strands, size)
    total = int(sizes.sum())
    return hair.Hair(
        rng.random((total, 3)).astype(np.float32), sizes.astype(np.int32), rng.random((strands, 2)).astype(np.float32),
        rng.random(total).astype(np.float32) * 1e-3, rng.random((total, 4)).astype(np.float32), fps=25,
    )  # fmt: skip


def read_tfx(name):
    """Positions (S, P, 3), strand UV (S, 2) and thickness (S,) of a TressFX 4 file; None if it lacks them."""
    with open(name, "rb") as file:
        data = file.read()
    version, strands, size, *offsets = np.frombuffer(data, "<u4", 8)
    assert np.uint32(version).view(np.float32) == 4
    place = np.frombuffer(data, "<f4", strands * size * 4, offsets[0]).reshape(strands, size, 4)
    uv = np.frombuffer(data, "<f4", strands * 2, offsets[1]).reshape(strands, 2) if offsets[1] else None
    thickness = np.frombuffer(data, "<f4", strands, offsets[3]) if offsets[3] else None
    return place[..., :3], uv, thickness


@step
def add_on():
    """The add-on installs from its single file, registers menu entries and operators, works, and unregisters."""
    bpy.ops.preferences.addon_install(filepath=os.path.join(ROOT, "scripts", "blender_hair.py"))
    check("the add-on is enabled", bpy.ops.preferences.addon_enable(module="blender_hair") == {"FINISHED"})
    empty()
    given = some_hair()
    hair.new_curves(bpy.context, "given", given)
    bpy.ops.export_scene.tractrix_hair(filepath=path("add_on.npz"), scene=True)
    check("the menu's export writes hair and scene", os.path.exists(path("add_on.npz")) and os.path.exists(path("add_on.json")))
    empty()
    bpy.ops.import_scene.tractrix_hair(filepath=path("add_on.npz"))
    check("the menu's import makes curves", [len(c.curves) for c in bpy.data.hair_curves] == [6])
    try:
        bpy.ops.import_scene.tractrix_hair(filepath=path("none.npz"))
        check("a missing file is an error", False)
    except RuntimeError as error:
        check("a missing file is an error", "no such file" in str(error), error)
    bpy.ops.preferences.addon_disable(module="blender_hair")
    check("the add-on is gone", "tractrix_hair" not in dir(bpy.ops.export_scene))


@step
def curves_object():
    """Every property of a Curves object is exported exactly, also for strands of different sizes."""
    for ragged in (False, True):
        empty()
        given = some_hair(ragged=ragged)
        hair.new_curves(bpy.context, "given", given)
        export("-o", path("curves.npz"))
        got = hair.read_npz(path("curves.npz"))
        for name in ("points", "sizes", "uv", "radius", "color"):
            same = np.array_equal(getattr(got, name), getattr(given, name))
            check(f"{name} of a Curves object, ragged {ragged}", same, getattr(got, name))
    with np.load(path("curves.npz")) as file:
        names = set(file.files)
    check("ragged .npz has points and sizes", {"points", "sizes", "uv", "radius", "color", "fps", "unit", "up"} == names, names)
    with np.load(path("curves.npz")) as file:
        np.savez(path("centimetres.npz"), **{**file, "unit": np.float32(0.01), "up": np.array("z")})
    got = hair.read_npz(path("centimetres.npz"))
    check(
        "unit and axis of .npz", np.allclose(got.points, hair.to_y_up(given.points) * 0.01) and np.allclose(got.radius, given.radius * 0.01)
    )
    export("-o", path("ragged.tfx"))
    with open(path("ragged.tfx"), encoding="ascii") as file:
        check("ragged .tfx is text", file.readline() == "numStrands 6\n")
    export("--resample", "7", "-o", path("even.tfx"))
    place, uv, _ = read_tfx(path("even.tfx"))
    tips = given.points[given.first + given.sizes - 1]
    check("resampled strands keep roots and tips", np.array_equal(place[:, [0, -1]], np.stack((given.points[given.first], tips), 1)))
    check("resampled strands keep uv", np.array_equal(uv, given.uv))
    even = np.linalg.norm(np.diff(hair.resample(hair.Hair(given.points[:2], given.sizes[:1] * 0 + 2), 5).points, axis=0), axis=1)
    check("resampled points are evenly spaced", np.ptp(even) < 1e-6, even)
    tractrix("tractrix-render", path("even.tfx"), "--check", "--unit", "m")


@step
def cubic_curves():
    """NURBS of a Curves object are exported as the lines that Blender draws."""
    empty()
    old = bpy.data.curves.new("old", "CURVE")
    old.dimensions = "3D"
    spline = old.splines.new("NURBS")
    spline.points.add(4)
    spline.points.foreach_set("co", np.c_[np.random.default_rng(2).random((5, 3)), np.ones(5)].ravel())
    spline.order_u, spline.use_endpoint_u = 4, True
    obj = bpy.data.objects.new("old", old)
    bpy.context.scene.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)
    export("-o", path("nurbs_old.npz"))
    bpy.ops.object.convert(target="CURVES")
    check("the curve is a Curves object", bpy.context.object.type == "CURVES")
    export("-o", path("nurbs.npz"))
    wanted, got = hair.read_npz(path("nurbs_old.npz")), hair.read_npz(path("nurbs.npz"))
    check("more points than the NURBS has", len(got.points) > 5, len(got.points))
    check(
        "they are those of the old curve",
        got.points.shape == wanted.points.shape and np.allclose(got.points, wanted.points, atol=1e-6),
        (got.points, wanted.points),
    )
    check("the object is as it was", not bpy.context.object.modifiers and not bpy.data.node_groups)


@step
def units_and_axes():
    """Blender's z up and unit become y up and metres; an object's own transform is applied."""
    empty()
    old = bpy.data.curves.new("old", "CURVE")
    old.dimensions, old.bevel_depth = "3D", 0.5
    spline = old.splines.new("POLY")
    spline.points.add(1)
    spline.points.foreach_set("co", [1, 2, 3, 1, 4, 5, 6, 1])
    obj = bpy.data.objects.new("old", old)
    obj.location = (10, 0, 0)
    bpy.context.scene.collection.objects.link(obj)
    bpy.context.scene.unit_settings.scale_length = 0.01
    export("-o", path("units.npz"))
    got = hair.read_npz(path("units.npz"))
    check("centimetres, z up", np.allclose(got.points, [[0.11, 0.03, -0.02], [0.14, 0.06, -0.05]], atol=1e-8), got.points)
    check("a bevel is the radius", np.allclose(got.radius, 0.005), got.radius)
    bezier = bpy.data.curves.new("bezier", "CURVE")
    bezier.dimensions = "3D"
    spline = bezier.splines.new("BEZIER")
    spline.bezier_points.add(1)
    spline.bezier_points[1].co = (1, 0, 0)
    bpy.context.scene.collection.objects.link(bpy.data.objects.new("bezier", bezier))
    export("--objects", "bezier", "-o", path("bezier.npz"))
    got = hair.read_npz(path("bezier.npz"))
    check("Bezier splines as they are drawn", len(got.points) == spline.resolution_u + 1, len(got.points))


def hairy_sphere(count=40):
    """A sphere of 0.1 m with hair of 0.1 m."""
    bpy.ops.mesh.primitive_uv_sphere_add(radius=0.1, segments=24, ring_count=12)
    obj = bpy.context.object
    obj.modifiers.new("hair", "PARTICLE_SYSTEM")
    settings = obj.particle_systems[0].settings
    settings.type, settings.count, settings.display_step = "HAIR", count, 3
    settings.hair_length, settings.radius_scale, settings.root_radius, settings.tip_radius = 0.1, 0.001, 0.2, 0.1
    settings.use_close_tip = False
    settings.child_type = "INTERPOLATED"
    return obj


@step
def particle_hair():
    """Particle hair grows from the sphere's faces with their texture coordinates; parents, children or both."""
    empty()
    obj = hairy_sphere()
    export("-o", path("particles.tfx"), "--mesh", path("particles.obj"))
    place, uv, thickness = read_tfx(path("particles.tfx"))
    check("40 hairs of 9 points", place.shape == (40, 9, 3), place.shape)
    from_middle = np.linalg.norm(place[:, 0], axis=1)
    check("roots lie on the sphere's faces", 0.097 < from_middle.min() and from_middle.max() < 0.1001, from_middle)
    check("diameter at the root", np.allclose(thickness, 0.2 * 0.001, rtol=1e-5), thickness)
    root = hair.to_z_up(place[:, 0])
    depsgraph = bpy.context.evaluated_depsgraph_get()
    # Particles interpolate within a quad, nearest_uv within its triangles. On the quads' diagonal, where the difference is
    # largest, it is t - t r / (1 - (1 - r) t) of a face's width; next to the pole r = sin 15 / sin 30 degrees: 0.163 at most.
    off = np.abs(hair.nearest_uv(root, obj, depsgraph) - uv).max(0)
    check("uv is that of the nearest face", off[0] < 0.17 / 24 and off[1] < 1e-5, off)
    with open(path("particles.obj"), encoding="ascii") as file:
        rows = file.read().splitlines()
    check("the emitter is the mesh, in triangles", sum(r.startswith("f ") for r in rows) == 24 * 22, len(rows))
    export("-o", path("children.npz"), "--children", "children")
    export("-o", path("all.npz"), "--children", "all")
    some, every = hair.read_npz(path("children.npz")), hair.read_npz(path("all.npz"))
    check("all hair is parents and children", len(every.sizes) == 40 + len(some.sizes) and len(some.sizes) >= 40, len(every.sizes))
    check("radius falls from root to tip", np.allclose(every.radius[:9], np.linspace(1e-4, 5e-5, 9), rtol=1e-4), every.radius[:9])


@step
def rigid_head():
    """The emitter's motion becomes the scene file's head, and Tractrix puts roots where Blender does."""
    empty()
    obj = hairy_sphere()
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end, scene.render.fps = 1, 9, 25
    for frame, place, turn in ((1, (0, 0, 0), (0, 0, 0)), (5, (0.02, 0.05, 0.01), (20, 10, 100)), (9, (0, 0.1, 0), (0, -30, 230))):
        obj.location, obj.rotation_euler = place, Euler([math.radians(a) for a in turn])
        obj.keyframe_insert("location", frame=frame)
        obj.keyframe_insert("rotation_euler", frame=frame)
    export("--frames", "scene", "-o", path("head.npz"))
    export("--frames", "scene", "-o", path("head.tfx"), "--scene", path("head.json"))
    truth = hair.read_npz(path("head.npz"))
    with open(path("head.json"), encoding="utf-8") as file:
        members = json.load(file)
    check("frames of the animation", truth.frames.shape == (9, 360, 3) and members["frames"] == 9, truth.frames.shape)
    check("a key a frame", len(members["head"]["keys"]) == 9 and members["head"]["keys"][8]["time"] == 0.32)
    turns = [np.linalg.norm(k["rotate"]) for k in members["head"]["keys"]]
    check("turns beyond 180 degrees go on", turns[8] > 220, turns)
    tractrix("tractrix-render", path("head.json"), "--algo", "none", "-q", "--export", path("head.usda"))
    got = hair.read_usda(path("head.usda"))
    error = np.abs(got.frames - truth.frames)[:, truth.first].max()
    check("Tractrix's roots are Blender's within 1e-6 m", error < 1e-6, error)
    print(f"rigid head: roots {error:.3g} m off")
    obj.scale = (1, 1, 1)
    obj.keyframe_insert("scale", frame=1)
    obj.scale = (1.5, 1, 1)
    obj.keyframe_insert("scale", frame=9)
    export("--frames", "scene", "-o", path("soft.tfx"), "--scene", path("soft.json"))
    with open(path("soft.json"), encoding="utf-8") as file:
        check("a head that stretches is not written", "head" not in json.load(file))
    hair_of_one = hair.new_curves(bpy.context, "one", some_hair(strands=1))
    hair_of_one.keyframe_insert("location", frame=1)
    hair_of_one.location = (1, 0, 0)
    hair_of_one.keyframe_insert("location", frame=9)
    export("--frames", "scene", "--objects", "one", "-o", path("one.tfx"), "--scene", path("one.json"))
    with open(path("one.json"), encoding="utf-8") as file:
        check("the head of a single root is not written", "head" not in json.load(file))
    check("no rotation without three roots", raises(lambda: hair.fit_rigid(np.zeros((2, 3)), np.zeros((2, 3)))))


def raises(work):
    """Whether `work` raises a HairError."""
    try:
        work()
    except hair.HairError:
        return True
    return False


def cross_strands(places, arm):
    """A Hair with a short strand through each point (N, 3; m, y up), along x for even points and y for odd ones."""
    axes = np.array([[arm, 0, 0] if i % 2 == 0 else [0, arm, 0] for i in range(len(places))])
    points = np.stack([places - axes, places, places + axes], 1).reshape(-1, 3)
    return hair.Hair(points.astype(np.float32), np.full(len(places), 3, np.int32), radius=np.full(len(points), 2e-3, np.float32))


@step
def camera():
    """Both programs show the middles of short strands at the same pixels."""
    empty()
    scene = bpy.context.scene
    places = np.array([[0, 0, 0], [0.3, 0.2, 0.1], [-0.35, 0.25, -0.2], [-0.3, -0.25, 0.15], [0.33, -0.2, -0.3]])
    hair.new_curves(bpy.context, "points", cross_strands(places, 0.004))
    data = bpy.data.cameras.new("camera")
    obj = bpy.data.objects.new("camera", data)
    scene.collection.objects.link(obj)
    scene.camera = obj
    for fit, size, lens in (("HORIZONTAL", (320, 200), 35), ("VERTICAL", (240, 320), 32)):
        data.sensor_fit, data.lens = fit, lens
        scene.render.resolution_x, scene.render.resolution_y = size
        obj.matrix_world = (
            Matrix.Translation((0.5, -1.6, 0.4)) @ Euler((math.radians(78), math.radians(9), math.radians(16))).to_matrix().to_4x4()
        )
        export("-o", path("camera.tfx"), "--scene", path("camera.json"))
        bpy.context.view_layer.update()
        seen = np.array([world_to_camera_view(scene, obj, Vector(p))[:2] for p in hair.to_z_up(places)]) * size
        tractrix("tractrix-render", path("camera.json"), "--algo", "none", "-q", "--aov", "coverage", "--frames", "1", "--followers", "0",
                 "--scalp", "none", "-o", path("camera.pfm"))  # fmt: skip
        with open(path("camera.json"), encoding="utf-8") as file:
            check("radius in the scene file", json.load(file)["sections"][0]["radius"] == 0.002)
        error = max(np.hypot(*(middle_of(path("camera.pfm"), p) - p)) for p in seen)
        check(f"camera, {fit}: within half a pixel", error < 0.5, error)
        print(f"camera, {fit}: {error:.3f} px off")


def middle_of(name, around, reach=12):
    """The centroid of light within `reach` pixels of a point (x from the left, y from below) in a PFM file."""
    with open(name, "rb") as file:
        kind, size, scale = file.readline(), file.readline().split(), float(file.readline())
        pixels = np.frombuffer(file.read(), "<f4" if scale < 0 else ">f4").reshape(
            int(size[1]), int(size[0]), 3 if kind[1:2] == b"F" else 1
        )
    y, x = np.mgrid[: pixels.shape[0], : pixels.shape[1]] + 0.5
    weight = pixels[..., 0] * (np.hypot(x - around[0], y - around[1]) < reach)
    return np.array([(x * weight).sum(), (y * weight).sum()]) / max(weight.sum(), 1e-9)


@step
def scene_back():
    """Camera, lights, size and rate of a scene file are imported as they were exported."""
    empty()
    scene = bpy.context.scene
    hair.new_curves(bpy.context, "hair", some_hair())
    hairy_sphere()
    lamps = {"SUN": ("directional", 3), "POINT": ("point", 20), "SPOT": ("spot", 30)}
    for kind, (_, energy) in lamps.items():
        light = bpy.data.lights.new(kind, kind)
        light.energy, light.color = energy, (1, 0.5, 0.25)
        obj = bpy.data.objects.new(kind, light)
        obj.location, obj.rotation_euler = (0.5, -1, 2), (0.3, 0.4, 0.5)
        scene.collection.objects.link(obj)
    camera_data = bpy.data.cameras.new("camera")
    scene.camera = bpy.data.objects.new("camera", camera_data)
    scene.collection.objects.link(scene.camera)
    scene.camera.location, scene.camera.rotation_euler = (0.5, -1.5, 0.3), (1.4, 0.05, 0.3)
    scene.render.resolution_x, scene.render.resolution_y, scene.render.fps = 400, 300, 30
    scene.frame_start, scene.frame_end = 1, 4
    first = path("first.json")
    export("--frames", "scene", "-o", path("first.tfx"), "--mesh", path("first.obj"), "--scene", first)
    tractrix("tractrix-render", first, "-q", "--frames", "1", "--size", "40x30", "--scatter", "none", "-o", path("first.png"))
    check(
        "the scene comes back",
        hair.main(["import", path("first.tfx").replace("first.tfx", "add_on.npz"), "--scene", first, "-o", path("b.blend")]) == 0,
    )
    bpy.ops.wm.open_mainfile(filepath=path("b.blend"))
    export("--frames", "scene", "-o", path("second.tfx"), "--mesh", path("second.obj"), "--scene", path("second.json"))
    with open(first, encoding="utf-8") as one, open(path("second.json"), encoding="utf-8") as other:
        one, other = json.load(one), json.load(other)
    for name in ("size", "fps", "frames", "eye", "fov", "sky"):
        check(f"{name} of the scene", np.allclose(one[name], other[name], atol=2e-6), (one[name], other[name]))
    check("three lights", [light["type"] for light in other["lights"]] == ["directional", "spot", "point"], other["lights"])
    for was, now in zip(one["lights"], other["lights"]):
        for name in was:
            same = was[name] == now[name] if isinstance(was[name], (str, bool)) else np.allclose(was[name], now[name], atol=1e-3)
            check(f"{name} of a {was['type']} light", same, (was[name], now[name]))


@step
def camera_by_formulas():
    """A camera that moves by formulas is not imported; the message says so, and not that the file has none."""
    empty()
    times, still = np.zeros(1), {"eye": [0, 0, 2], "target": [0, 0, 0]}
    for members, line, cameras in (
        ({"camera": {"eye": ["sin(t)", 0, "cos(t)"]}}, "the camera moves by formulas: no camera is imported", 0),
        ({}, "the scene file has no camera: none is imported", 0),
        ({"camera": {"fov": "30-5*t"}, **still}, "the camera moves by formulas: they are not imported", 1),
    ):
        said = io.StringIO()
        with contextlib.redirect_stderr(said):
            hair.place_camera(bpy.context, members, times)
        check(line, said.getvalue() == f"blender_hair: {line}\n", said.getvalue())
        check(f"{cameras} cameras", len(bpy.data.cameras) == cameras, len(bpy.data.cameras))


@step
def materials():
    """Melanin, a plain colour, or a map of the hair's material become those of the section."""
    for kind, member, wanted in (
        ("ShaderNodeBsdfHairPrincipled", "melanin", -math.log(0.5) * 0.506 / 0.419),
        ("ShaderNodeBsdfPrincipled", "albedo", [hair.srgb([0.2])[0], hair.srgb([0.1])[0], hair.srgb([0.05])[0]]),
        ("ShaderNodeTexImage", "color_map", "map.png"),
    ):
        empty()
        obj = hair.new_curves(bpy.context, "hair", some_hair())
        material = bpy.data.materials.new("hair")
        material.use_nodes = True
        nodes = material.node_tree.nodes
        nodes.clear()
        shader = nodes.new(kind if "Bsdf" in kind else "ShaderNodeBsdfPrincipled")
        if member == "melanin":
            shader.parametrization, shader.inputs["Melanin"].default_value = "MELANIN", 0.5
        elif member == "albedo":
            shader.inputs["Base Color"].default_value = (0.2, 0.1, 0.05, 1)
        else:
            texture = nodes.new(kind)
            texture.image = bpy.data.images.new("map", 4, 4)
            texture.image.filepath_raw, texture.image.file_format = path("map.png"), "PNG"
            texture.image.save()
            material.node_tree.links.new(texture.outputs[0], shader.inputs["Base Color"])
        obj.data.materials.append(material)
        export("-o", path("material.tfx"), "--scene", path("material.json"))
        with open(path("material.json"), encoding="utf-8") as file:
            got = json.load(file)["sections"][0].get(member)
        same = got == wanted if isinstance(wanted, str) else got is not None and np.allclose(got, wanted, atol=1e-5)
        check(f"{member} of the material", same, (got, wanted))
    tractrix("tractrix-render", path("material.json"), "-q", "--frames", "1", "--size", "40x30", "-o", path("material.png"))


@step
def light_units():
    """A white matt plane in Cycles is as bright as the scene file's intensity."""
    if not hasattr(bpy.types, "CyclesRenderSettings") and "cycles" not in bpy.context.preferences.addons:
        return skip("light: this Blender has no Cycles")
    for kind, energy in (("SUN", 2.0), ("POINT", 60.0), ("SPOT", 60.0), ("AREA", 12.0)):
        empty()
        scene = bpy.context.scene
        bpy.ops.mesh.primitive_plane_add(size=0.02)
        light = bpy.data.lights.new(kind, kind)
        light.energy = energy
        if kind in ("POINT", "SPOT"):
            light.shadow_soft_size = 0
        if kind == "AREA":
            light.size = 0.01
        lamp = bpy.data.objects.new(kind, light)
        lamp.location = (0, 0, 1)
        scene.collection.objects.link(lamp)
        scene.camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
        scene.collection.objects.link(scene.camera)
        scene.camera.location, scene.camera.data.lens, scene.camera.data.clip_start = (0.2, 0, 0.9), 2000, 0.01
        scene.camera.rotation_euler = Vector((0.2, 0, 0.9)).to_track_quat("Z", "Y").to_euler()
        shows = plane_radiance(scene)
        wanted = hair.light_of(lamp, 1.0)["intensity"] * 0.8  # Blender's default material reflects 0.8
        check(f"{kind}: Cycles and the scene file agree", abs(shows / wanted - 1) < 0.03, (shows, wanted))
    return None


def plane_radiance(scene):
    """The mean linear value of an image of 4 x 4 pixels by Cycles, without world light."""
    scene.render.engine, scene.cycles.samples, scene.cycles.max_bounces = "CYCLES", 16, 0
    scene.cycles.use_denoising = False
    scene.render.resolution_x = scene.render.resolution_y = 4
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
    scene.render.filepath = path("plane.exr")
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(path("plane.exr"))
    return float(np.array(image.pixels[:]).reshape(-1, 4)[:, 0].mean())


def bending_body(count=40):
    """A hairy sphere that is bent by an armature and inflated by a shape key, frames 1 to 9."""
    obj = hairy_sphere(count)
    flat = bmesh.new()  # so that both programs put roots on triangles
    flat.from_mesh(obj.data)
    bmesh.ops.triangulate(flat, faces=flat.faces)
    flat.to_mesh(obj.data)
    flat.free()
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end, scene.render.fps = 1, 9, 25
    obj.shape_key_add(name="Basis")
    swollen = obj.shape_key_add(name="swollen")
    for vertex, key in zip(obj.data.vertices, swollen.data):
        key.co = vertex.co * (1.3 if vertex.co.x > 0 else 1.0)
    for frame, share in ((1, 0.0), (9, 1.0)):
        swollen.value = share
        swollen.keyframe_insert("value", frame=frame)
    rig = bpy.data.objects.new("rig", bpy.data.armatures.new("rig"))
    scene.collection.objects.link(rig)
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    low, high = rig.data.edit_bones.new("low"), rig.data.edit_bones.new("high")
    low.head, low.tail, high.head, high.tail = (0, 0, -0.1), (0, 0, 0), (0, 0, 0), (0, 0, 0.1)
    high.parent = low
    bpy.ops.object.mode_set(mode="OBJECT")
    for name, side in (("low", -1), ("high", 1)):
        group = obj.vertex_groups.new(name=name)
        group.add([v.index for v in obj.data.vertices if v.co.z * side >= 0], 1.0, "REPLACE")
    bend = obj.modifiers.new("bend", "ARMATURE")
    bend.object = rig
    while obj.modifiers[0] != bend:  # so that hair grows on the bent skin
        bpy.context.view_layer.objects.active = obj
        bpy.ops.object.modifier_move_up(modifier="bend")
    bone = rig.pose.bones["high"]
    bone.rotation_mode = "XYZ"
    for frame, angle in ((1, 0), (9, 50)):
        bone.rotation_euler = (math.radians(angle), 0, 0)
        bone.keyframe_insert("rotation_euler", frame=frame)
    return obj


def evaluated(obj, frame):
    """(V, 3) world positions of a mesh at a frame, m, y up."""
    bpy.context.scene.frame_set(frame)
    now = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = now.to_mesh()
    points = hair.to_y_up(hair.into_world(now, hair.column(mesh.vertices, "co", 3)))
    now.to_mesh_clear()
    return points


@step
def deforming_body():
    """Tractrix gets a bending body with its hair bound to it, and its simulated hair is imported onto the body."""
    empty()
    obj = bending_body()
    truth = np.stack([evaluated(obj, frame) for frame in range(1, 10)])
    check("the body bends", np.abs(truth - truth[0]).max() > 0.02, np.abs(truth - truth[0]).max())
    export("--frames", "scene", "-o", path("body_hair.npz"))
    hairs = hair.read_npz(path("body_hair.npz"))
    export("--frames", "scene", "-o", path("bound.tfx"), "--mesh", path("body.obj"), "--scene", path("bound.json"))
    with open(path("bound.json"), encoding="utf-8") as file:
        members = json.load(file)
    check("the scene has the samples and no head", members["mesh"] == "body.npz" and "head" not in members, members.get("mesh"))
    with np.load(path("body.npz")) as body:
        check("samples are Blender's to rounding", np.abs(body["positions"] - truth).max() < 1e-6)
        check("rate of the samples", body["fps"] == 25 and body["faces"].shape[1] == 3)
    export("--frames", "scene", "-o", path("bound.tfx"), "--mesh", path("again.npz"), "--scene", path("again.json"))
    with np.load(path("again.npz")) as body:
        check("--mesh x.npz writes the same", np.abs(body["positions"] - truth).max() < 1e-6)
    tractrix("tractrix-render", path("bound.json"), "--algo", "none", "-q", "--export", path("bound.usda"))
    simulated = hair.read_usda(path("bound.usda"))
    error = np.abs(simulated.frames - hairs.frames)[:, hairs.first].max()
    check("Tractrix's roots are Blender's within 1e-6 m", error < 1e-6, error)
    print(f"deforming body: roots {error:.3g} m off")
    empty()
    hair.main(["import", path("bound.usda"), "--scene", path("bound.json")])
    back = bpy.data.objects["body"]
    error = max(np.abs(evaluated(back, 1 + f) - truth[f]).max() for f in range(9))
    check("the body comes back at each frame", error < 1e-6, error)
    export("--frames", "scene", "--objects", "bound", "-o", path("bound_back.npz"))
    error = np.abs(hair.read_npz(path("bound_back.npz")).frames - simulated.frames).max()
    check("its hair comes back at each frame", error < 1e-6, error)


@step
def other_topology():
    """A mesh whose faces change is refused; the message names object and frame, and nothing is written."""
    empty()
    obj = bending_body(4)
    build = obj.modifiers.new("build", "BUILD")
    build.frame_start, build.frame_duration = 1, 9
    export("--frames", "scene", "--mesh", path("changing.npz"), status=hair.BAD_INPUT)
    check("nothing is written", not os.path.exists(path("changing.npz")))
    for words in (["--mesh", path("x.obj")], ["--mesh", path("x.pc2"), "-o", path("x.tfx")], []):
        export(*words, status=hair.USAGE)


@step
def character():
    """The command that tractrix-render recommends converts a skinned .glb to samples."""
    empty()
    obj = bending_body(4)
    for modifier in [m for m in obj.modifiers if m.type == "PARTICLE_SYSTEM"]:
        obj.modifiers.remove(modifier)
    obj.shape_key_clear()
    try:
        if "bool" not in vars(np):  # as in import_character
            np.bool = bool
        bpy.ops.export_scene.gltf(filepath=path("character.glb"))
    except (AttributeError, RuntimeError) as error:
        skip(f"this Blender has no glTF: {error}")
        return
    truth = [evaluated(obj, frame) for frame in (1, 9)]
    done = subprocess.run(
        [os.path.join(BIN, "tractrix-render"), os.path.join(ROOT, "assets", "curls.tfx"), "--mesh", path("character.glb"), "-o", path("x.png")],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    command = "export FILE --mesh x.npz --frames scene"
    check("the message names the command", done.returncode == 3 and command in done.stderr, done.stderr)
    export(path("character.glb"), "--mesh", path("baked.npz"), "--frames", "scene")
    with np.load(path("baked.npz")) as body:
        for sample, points in ((0, truth[0]), (-1, truth[1])):
            far = np.linalg.norm(body["positions"][sample][:, None] - points[None], axis=2)
            check("baked vertices are the skin's", max(far.min(0).max(), far.min(1).max()) < 1e-5, (far.min(0).max(), far.min(1).max()))


@step
def alembic_unit():
    """An .abc file by Tractrix contains its unit, which tractrix-convert reads."""
    if bpy.app.build_options.alembic:
        return  # Blender's importer has its own scale
    curls = os.path.join(ROOT, "assets", "curls.tfx")
    tractrix("tractrix-convert", curls, "--unit", "m", "--to-unit", "cm", "-o", path("centimetres.abc"))
    empty()
    hair.import_hair(bpy.context, path("centimetres.abc"))
    export("-o", path("centimetres_back.npz"))
    points, wanted = hair.read_npz(path("centimetres_back.npz")).points, hair.convert_hair(curls, ("--unit", "m")).points
    check("the unit of .abc is the file's", np.abs(points - wanted).max() < 1e-5, np.abs(points - wanted).max())


@step
def round_trip():
    """A groom keeps its shape along .abc -> Blender -> .tfx -> simulation -> .usda -> Blender."""
    empty()
    hair.import_hair(bpy.context, os.path.join(ROOT, "tests", "data", "groom.abc"))
    bpy.context.scene.frame_end = 6
    export("--frames", "1:6", "-o", path("groom.tfx"), "--scene", path("groom.json"))
    place, uv, _ = read_tfx(path("groom.tfx"))
    with open(os.path.join(ROOT, "assets", "curls.tfx"), "rb") as file:
        source = np.frombuffer(file.read()[160:], "<f4", 300 * 48 * 4).reshape(300, 48, 4)[::10, :, :3]
    error = np.abs(place - source).max()
    check("the .abc file's strands are those of assets/curls.tfx, which it was made from", error < 1e-5 and uv.shape == (30, 2), error)
    with open(path("groom.json"), encoding="utf-8") as file:
        check("a scene without light and camera leaves both to Tractrix", not {"lights", "sky", "eye"} & set(json.load(file)))
    tractrix("tractrix-render", path("groom.json"), "--drag", "3", "-q", "--export", path("sim.usda"))
    empty()
    check("the simulation is imported", hair.main(["import", path("sim.usda"), "-o", path("sim.blend")]) == 0)
    bpy.ops.wm.open_mainfile(filepath=path("sim.blend"))
    scene = bpy.context.scene
    check("frames and rate", (scene.frame_start, scene.frame_end, scene.render.fps) == (1, 6, 24), scene.frame_end)
    export("--frames", "scene", "-o", path("back.npz"))
    wanted, got = hair.read_usda(path("sim.usda")), hair.read_npz(path("back.npz"))
    check("the strands moved", np.abs(wanted.frames[5] - wanted.frames[0]).max() > 0.01)
    error = np.linalg.norm(got.frames - wanted.frames, axis=2).max()
    check("every point of every frame arrives within 1e-5 m", error < 1e-5, error)
    print(f"round trip: {got.frames.shape[0]} frames of {got.frames.shape[1]} points, {error:.3g} m off")
    check("curves are named after the file", bpy.data.objects.get("sim") is not None)
    tractrix("tractrix-render", path("groom.json"), "--drag", "3", "-q", "--cache", path("sim.cache"))
    check("a cache is imported", hair.main(["import", path("sim.cache")]) == 0)
    export("--frames", "scene", "-o", path("cache.npz"))
    check("a cache holds the same", np.array_equal(hair.read_npz(path("cache.npz")).frames, got.frames))
    tractrix("tractrix-render", path("groom.json"), "--from-cache", path("sim.cache"), "--drag", "3", "-q", "--export", path("n_%04d.tfx"))
    check("numbered files are imported", hair.main(["import", path("n_%04d.tfx"), "--unit", "m"]) == 0)
    export("--frames", "scene", "-o", path("numbered.npz"))
    told = subprocess.run([os.path.join(BIN, "tractrix-convert"), "--help", "all"], capture_output=True, text=True, check=False).stdout
    if "npz" in told:
        tractrix("tractrix-convert", path("back.npz"), "-o", path("convert.usda"))
        check("tractrix-convert reads the frames of .npz", np.array_equal(hair.read_usda(path("convert.usda")).frames, got.frames))
        tractrix("tractrix-convert", path("curves.npz"), "-o", path("convert.npz"))
        one, other = hair.read_npz(path("curves.npz")), hair.read_npz(path("convert.npz"))
        same = [np.array_equal(getattr(one, n), getattr(other, n)) for n in ("points", "sizes", "uv", "radius", "color")]
        check("tractrix-convert keeps all of .npz", all(same), same)
    else:
        skip("tractrix-convert does not read .npz")
    check("numbered files hold the same", np.array_equal(hair.read_npz(path("numbered.npz")).frames, got.frames))


@step
def bad_input():
    """Unreadable input gives one error line and an exit status."""
    with open(path("bad.npz"), "wb") as file:
        file.write(b"no zip")
    np.savez(path("odd.npz"), points=np.zeros((5, 3), np.float32), sizes=np.array([2, 2], np.int32))
    with open(path("bad.usda"), "w", encoding="ascii") as file:
        file.write('#usda 1.0\ndef BasisCurves "a" {\n int[] curveVertexCounts = [2]\n point3f[] points = [(0, 0, 0)]\n}\n')
    with open(path("bad.json"), "w", encoding="ascii") as file:
        file.write("[]")
    for words, status in (
        (["import", path("none.npz")], hair.BAD_INPUT), (["import", path("bad.npz")], hair.BAD_INPUT),
        (["import", path("odd.npz")], hair.BAD_INPUT), (["import", path("bad.usda")], hair.BAD_INPUT),
        (["import", path("none.blend"), "--scene", path("bad.json")], hair.BAD_INPUT), (["import"], hair.USAGE),
        (["export", "-o", path("x.png")], hair.USAGE), (["export", "-o", path("x.npz"), "--frames", "9:1"], hair.USAGE),
        (["export", "-o", path("x.npz"), "--objects", "nobody"], hair.USAGE), (["export", "-o", path("x.npz")], hair.BAD_INPUT),
        (["export", "-o", path("x.npz"), "--children", "aunts"], hair.USAGE), (["walk"], hair.USAGE),
    ):  # fmt: skip
        empty()
        got = hair.main(words)
        check(f"status of {words}", got == status, got)
    check("no file is left behind", not os.path.exists(path("x.npz")))


def main():
    """Runs all steps, or only those named in TRACTRIX_STEPS if it is set."""
    chosen = os.environ.get("TRACTRIX_STEPS", "").split()
    for one in EVERY_STEP:
        if chosen and one.__name__ not in chosen:
            continue
        try:
            one()
        except Exception:  # pylint: disable=broad-except
            check(one.__name__, False, traceback.format_exc())
    print("{passed} passed, {failed} failed, {skipped} skipped".format(**COUNTS), flush=True)
    return COUNTS["failed"] > 0


sys.exit(main())
