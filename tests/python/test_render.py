# SPDX-License-Identifier: MIT
# render(): images of arrays and of files equal those of tractrix-render.
import inspect
import os
import re
import subprocess

import numpy as np
import pytest

import tractrix

SIZE = (48, 40)


def test_an_image_has_hair_on_its_background(curls):
    image = tractrix.render(curls, unit="m", size=SIZE, background="transparent", radius=0.01, look="plain")
    assert image.shape == (40, 48, 4) and image.dtype == np.uint8
    assert image[0, 0, 3] == 0 and image[:, :, 3].max() > 200


def test_light_is_linear_and_premultiplied(curls):
    light = tractrix.render(curls, unit="m", size=SIZE, background="transparent", radius=0.002, look="plain", dtype=np.float32)
    assert light.dtype == np.float32 and light[0, 0].tolist() == [0, 0, 0, 0]
    assert not light[light[:, :, 3] == 0].any()


def test_a_file_is_drawn_as_the_program_draws_it(tmp_path, pytestconfig):
    hair = pytestconfig.rootpath / "assets/fur.tfx"
    program = os.path.join(os.environ["TRACTRIX_BIN"], "tractrix-render")
    subprocess.run([program, str(hair), "--first", "2", "--size", "48x40", "--wind", "2,0,0", "--software", "-q", "-o", str(tmp_path / "x.png")], check=True)
    image = tractrix.render(hair, frames=2, size=SIZE, wind=(2, 0, 0))
    np.testing.assert_array_equal(image, tractrix.read_image(tmp_path / "x.png"))


def test_a_view_replaces_the_camera(curls):
    """One strand that stands at the origin, seen from z = 1 with 90 degrees: its root is in the middle."""
    strand = np.array([[(0, 0, 0), (0, 0.5, 0), (0, 1, 0)]])
    to_eye = np.eye(4)
    to_eye[2, 3] = -1
    near, far = 0.1, 10
    projection = np.array([(1, 0, 0, 0), (0, 1, 0, 0), (0, 0, -(far + near) / (far - near), -2 * far * near / (far - near)), (0, 0, -1, 0)])
    image = tractrix.render(strand, unit="m", size=(41, 41), view=(to_eye, projection), background="transparent", radius=0.05, algo="none", look="plain")
    columns = np.flatnonzero(image[:, :, 3].max(axis=0))
    assert abs(columns.mean() - 20) <= 0.5
    assert image[10, 20, 3] and not image[30, 20, 3]  # y is up


def test_colors_of_vertices_are_seen(curls):
    red = np.zeros((12, 8, 3))
    red[:, :, 0] = 0.8
    image = tractrix.render(curls, unit="m", color=red, size=SIZE, background="black", radius=0.002, look="plain", shading="kajiya").astype(int)
    assert image[:, :, 0].max() > image[:, :, 2].max() + 40
    image = tractrix.render(curls, unit="m", color=(0, 0, 0.8), size=SIZE, background="black", radius=0.002, look="plain", shading="kajiya").astype(int)
    assert image[:, :, 2].max() > image[:, :, 0].max() + 20


def test_arrays_of_small_hair_are_for_its_vertices(curls):
    """A strand of two vertices has two numbers of thickness and two of its root's uv."""
    strand = np.array([[(0, 0, 0), (0, 1, 0)]])
    image = tractrix.render(strand, unit="m", thickness=(1, 2), uv=[(0.5, 0.5)], size=SIZE, look="plain", radius=0.01)
    assert not np.array_equal(image, tractrix.render(strand, unit="m", size=SIZE, look="plain", radius=0.01))


def test_the_usual_size_is_the_programs(pytestconfig):
    page = (pytestconfig.rootpath / "docs/options.md").read_text()
    size = re.search(r"^\| `--size WxH` .*default (\d+)x(\d+)\]", page, re.M)
    for function in (tractrix.render, tractrix.Simulation.render):
        assert inspect.signature(function).parameters["size"].default == (int(size[1]), int(size[2]))


def test_thickness_of_vertices_is_relative_to_its_mean(curls):
    """Hair that is thick at its roots only covers the upper half, whatever its unit."""
    share = np.linspace(2, 0.01, 8)[None, :] * np.ones((12, 1))
    for scale in (1, 0.001):
        image = tractrix.render(curls, unit="m", thickness=share * scale, radius=0.004, tip_ratio=1, size=SIZE, background="transparent", look="plain")
        rows = np.flatnonzero(image[:, :, 3].any(axis=1))
        upper, lower = np.array_split(image[rows[0] : rows[-1] + 1, :, 3].sum(axis=1, dtype=int), 2)
        assert upper.sum() > 2 * lower.sum()


def test_what_simulate_yields_can_be_drawn(curls):
    positions = list(tractrix.simulate(curls, unit="m", frames=2))[-1]
    with tractrix.Simulation(curls, unit="m", look="plain", radius=0.002) as simulation:
        simulation.advance()
        simulation.advance()
        eye = {"eye": (0, 0, 1), "target": (0, -0.1, 0)}
        simulation.set(**eye)
        drawn = simulation.render(SIZE)
    again = tractrix.render(positions, unit="m", algo="none", look="plain", radius=0.002, size=SIZE, **eye)
    assert tractrix.compare(again, drawn, max_flip=0.02).same


@pytest.mark.parametrize("arguments, place", [({"size": (0, 4)}, "1"), ({"size": 4}, "size"), ({"dtype": np.int32}, "dtype: got int32"), ({"dtype": "float"}, "dtype: got float64"),
                                              ({"dtype": "rgb"}, "dtype: got .rgb.: expected uint8"),
                                              ({"view": (np.eye(4),)}, "view"), ({"view": (np.eye(3), np.eye(4))}, r"view\[0\]")])
def test_wrong_images_are_named(curls, arguments, place):
    with pytest.raises(tractrix.TractrixValueError, match=place):
        tractrix.render(curls, unit="m", **{"size": SIZE, **arguments})


def test_a_device_is_chosen_before_it_is_open(curls):
    next(tractrix.simulate(curls, unit="m", frames=1))
    with pytest.raises(tractrix.TractrixValueError, match="select_device"):
        tractrix.select_device(require_hardware=True)
    assert "llvmpipe" in tractrix.describe_device()["renderer"]


def test_after_fork_the_child_is_told(curls):
    tractrix.render(curls, unit="m", size=(8, 8))
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            tractrix.render(curls, unit="m", size=(8, 8))
            os.write(writer, b"drew")
        except tractrix.TractrixError as error:
            os.write(writer, f"{error.code} {error}".encode())
        os._exit(0)
    os.waitpid(child, 0)
    assert os.read(reader, 500).startswith(b"4 ")


def test_layers_come_with_the_image():
    with tractrix.Simulation("assets/fur.tfx", look="plain", algo="none", exposure=0) as hair:
        layers = hair.render_layers((48, 32))
        assert (layers.image == hair.render((48, 32))).all()
        assert layers.depth.shape == (32, 48) and layers.tangent.shape == (32, 48, 3) and layers.strand.dtype == np.uint32
        assert ((layers.strand > 0) == (layers.depth > 0)).all() and (layers.strand > 0).any()
        hair.set(color="#c02040", section=0)
        assert (hair.render((48, 32)) != layers.image).any()
