# SPDX-License-Identifier: MIT
# simulate() and Simulation: positions of strands in the form of the input, moved by frames, poses and meshes.
import gc
import json
import os
import signal
import threading
import weakref

import numpy as np
import pytest

import tractrix


def moved(x):
    """A rigid matrix: x metres to the right."""
    matrix = np.eye(4)
    matrix[0, 3] = x
    return matrix


def test_positions_come_in_the_form_of_the_strands(curls):
    frames = list(tractrix.simulate(curls, unit="m", frames=3))
    assert len(frames) == 3
    for positions in frames:
        assert positions.shape == (12, 8, 4) and positions.dtype == np.float32 and not positions.flags.writeable
        assert (positions[:, :, 3] == 1).all()
        np.testing.assert_allclose(positions[:, 0, :3], curls[:, 0], atol=1e-6)  # roots stay


def test_strands_of_several_sizes_come_as_a_list(curls):
    pieces = [strand[: 3 + index % 5] for index, strand in enumerate(curls)]
    sizes = np.array([len(piece) for piece in pieces])
    by_list = next(tractrix.simulate(pieces, unit="m", frames=1))
    by_sizes = next(tractrix.simulate((np.concatenate(pieces), sizes), unit="m", frames=1))
    assert [len(strand) for strand in by_list] == list(sizes)
    for a, b in zip(by_list, by_sizes):
        np.testing.assert_array_equal(a, b)


def test_the_same_call_gives_the_same_bytes_and_wind_other_ones(curls):
    still, again, windy = (list(tractrix.simulate(curls, unit="m", frames=4, wind=wind))[-1] for wind in ((0, 0, 0), None, (5, 0, 0)))
    np.testing.assert_array_equal(still, again)
    assert (windy[:, -1, 0] - still[:, -1, 0]).mean() > 1e-4


def test_units_and_the_axis_that_points_up(curls):
    metres = next(tractrix.simulate(curls, unit="m", frames=1, algo="none"))
    for unit in ("cm", 0.01):
        np.testing.assert_allclose(next(tractrix.simulate(curls * 100, unit=unit, frames=1, algo="none")), metres, atol=1e-6)
    z_up = np.stack((curls[:, :, 0], -curls[:, :, 2], curls[:, :, 1]), axis=2)  # y up turned by 90 degrees about x
    np.testing.assert_allclose(next(tractrix.simulate(z_up, unit="m", up="z", frames=1, algo="none")), metres, atol=1e-6)


def test_roots_follow_the_head(curls):
    poses = [moved(x) for x in (0.01, 0.02, 0.03)]
    by_matrix = list(tractrix.simulate(curls, unit="m", head=poses))
    assert len(by_matrix) == 3
    for pose, positions in zip(poses, by_matrix):
        np.testing.assert_allclose(positions[:, 0, :3], curls[:, 0] + pose[:3, 3], atol=1e-6)
    by_quaternion = list(tractrix.simulate(curls, unit="m", head=[((0, 0, 0, 1), pose[:3, 3]) for pose in poses]))
    np.testing.assert_array_equal(by_matrix[-1], by_quaternion[-1])


def test_a_turned_head_turns_the_roots(curls):
    angle = 0.05
    turn = np.eye(4)
    turn[:3, :3] = [[np.cos(angle), 0, np.sin(angle)], [0, 1, 0], [-np.sin(angle), 0, np.cos(angle)]]
    positions = next(tractrix.simulate(curls, unit="m", head=[turn]))
    np.testing.assert_allclose(positions[:, 0, :3], curls[:, 0] @ turn[:3, :3].T, atol=1e-6)


def test_hair_is_bound_to_a_mesh_that_deforms(curls):
    corners = np.array([(-1, 0.001, -1), (1, 0.001, -1), (1, 0.001, 1), (-1, 0.001, 1)], float)
    faces = np.array([(0, 2, 1), (0, 3, 2)])
    frames = [corners + (0, 0.002 * frame, 0) for frame in (1, 2)]
    last = list(tractrix.simulate(curls, unit="m", mesh=(corners, faces), mesh_frames=frames, collide=False))[-1]
    np.testing.assert_allclose(last[:, 0, :3], curls[:, 0] + (0, 0.004, 0), atol=1e-5)


def test_bodies_of_a_scene_are_placed(tmp_path, curls):
    np.savez(tmp_path / "curls.npz", points=curls)
    scene = tmp_path / "two.json"
    scene.write_text('{"algo": "none", "bodies": [{"sections": [{"file": "curls.npz", "unit": "m"}]}, '
                     '{"sections": [{"file": "curls.npz", "unit": "m"}]}]}')
    roots = curls[:, 0]
    around = np.array([[-0.01, 0, -0.01], [0.01, 0, -0.01], [0, 0, 0.01]])
    vertices = (roots[:, None] + around).reshape(-1, 3)
    mesh = vertices, np.arange(len(vertices)).reshape(-1, 3)
    with tractrix.Simulation(scene) as pair:
        pair.place(1, moved(0.02))
        pair.advance()
        np.testing.assert_allclose(pair.positions(0)[:, 0, :3], roots, atol=1e-6)
        np.testing.assert_allclose(pair.positions(1)[:, 0, :3], roots + [0.02, 0, 0], atol=1e-6)
        for wrong in ((2, moved(0)), (-1, moved(0)), ("x", moved(0)), (0, None)):
            with pytest.raises(ValueError, match="body|place"):
                pair.place(*wrong)
        with pytest.raises(ValueError, match="2 bodies"):
            pair.advance(moved(0))
    with tractrix.Simulation(scene, mesh={1: mesh}, mesh_unit="m", deforms=True) as pair:
        pair.place(1, mesh=vertices + [0, 0.01, 0])
        pair.advance()
        np.testing.assert_allclose(pair.positions(1)[:, 0, :3], roots + [0, 0.01, 0], atol=1e-5)
    with pytest.raises(ValueError, match="body: got 2"):
        tractrix.Simulation(scene, mesh={2: mesh}, mesh_unit="m")
    with pytest.raises(ValueError, match=r"^mesh\[1\]: got str: expected \(vertices, triangles\)$"):
        tractrix.Simulation(scene, mesh={1: "ball.obj"}, mesh_unit="m")
    with pytest.raises(ValueError, match="mesh: got {}: expected"):
        tractrix.Simulation(scene, mesh={}, deforms=True)


def test_followers_are_asked_for(curls):
    with tractrix.Simulation(curls, unit="m", followers=2, algo="none") as simulation:
        assert simulation.positions().shape == (12, 8, 4)
        assert simulation.positions(part="followers").shape == (24, 8, 4)
    with tractrix.Simulation(curls, unit="m", followers=0) as simulation:
        assert len(simulation.positions(part="followers")) == 0
    assert next(tractrix.simulate(curls, unit="m", frames=1, followers=2, part="followers", algo="none")).shape == (24, 8, 4)
    with pytest.raises(tractrix.TractrixValueError, match="part: got 'both': expected"):
        tractrix.simulate(curls, unit="m", frames=1, part="both")


def test_a_simulation_takes_new_wind_and_tells_the_time(curls):
    with tractrix.Simulation(curls, unit="m", fps=30) as simulation:
        simulation.advance()
        assert simulation.time == pytest.approx(1 / 30)
        simulation.set(wind=(5, 0, 0))
        before = simulation.positions()
        for _ in range(3):
            simulation.advance()
        assert (simulation.positions()[:, -1, 0] - before[:, -1, 0]).mean() > 1e-4
        with pytest.raises(tractrix.TractrixValueError, match="frames|live"):
            simulation.set(frames=3)
    with pytest.raises(tractrix.TractrixError, match="Simulation: used after close"):
        simulation.advance()


def test_views_show_what_copies_keep(curls):
    with tractrix.Simulation(curls, unit="m") as simulation:
        view, copy = simulation.positions(copy=False), simulation.positions()
        np.testing.assert_array_equal(view, copy)
        assert np.shares_memory(view, simulation.positions(copy=False)) and not np.shares_memory(view, copy)


def test_a_view_keeps_the_memory_that_it_shows(curls):
    with tractrix.Simulation(curls, unit="m") as simulation:
        handle = weakref.ref(simulation._handle)
        strand = simulation.positions(copy=False)[0]
        before = strand.copy()
    del simulation
    gc.collect()
    assert handle() is not None
    np.testing.assert_array_equal(strand, before)
    del strand
    gc.collect()
    assert handle() is None


@pytest.mark.parametrize("arguments, place", [
    ({}, "unit: not given"),
    ({"unit": "furlong"}, "unit: got 'furlong'"),
    ({"unit": "m", "up": "x"}, "up: got 'x'"),
    ({"unit": "m", "wnd": 1}, "wnd"),
    ({"unit": "m", "fov": 500}, "fov"),
    ({"unit": "m", "mesh": 3}, "mesh: got int: expected"),
    ({"unit": "m", "mesh": (np.zeros((3, 3)), np.array([[0, 1, -1]]))}, "mesh"),
    ({"unit": "m", "uv": np.zeros((3, 2))}, "uv: shape"),
    ({"unit": "m", "color": np.zeros((12, 8, 2))}, "color: 2 numbers"),
    ({"unit": "m", "color": [[[1, 0, 0]], [[1, 0], [1]]]}, "color: rows of different lengths"),
    ({"unit": "m", "thickness": [[1, 2], [3]]}, "thickness: rows of different lengths"),
    ({"unit": "m", "thickness": (1, 2, 3)}, "thickness: shape"),
    ({"unit": "m", "deforms": True}, "deforms: has no effect: expected mesh"),
])
def test_wrong_arguments_are_named(curls, arguments, place):
    with pytest.raises(tractrix.TractrixValueError, match=place) as caught:
        tractrix.Simulation(curls, **arguments)
    assert caught.value.code in (2, 3) and "\n" not in caught.value.text


@pytest.mark.parametrize("strands, place", [
    (np.zeros((4, 3)), r"strands: shape \(4, 3\): expected"),
    (np.zeros((4, 2, 2)), "strands: shape"),
    ([], "strands: an empty list"),
    ((np.zeros((4, 3)), np.array([2, 3])), "strands: the sizes add up to 5: expected 4, the number of points"),
    (np.zeros((1, 2, 3)), "0"),  # vertices that coincide
    (np.full((1, 2, 3), np.nan), "0"),
    (np.array([[[1j, 0, 0], [0, 0, 1]]]), "strands: got"),
    ([[(0, 0, 0), (0, 1)]], r"strands\[0\]: rows of different lengths"),
    (([(0, 0, 0)], [[1], [1, 2]]), r"strands\[1\]: rows of different lengths"),
    ("no/such.tfx", "no/such.tfx"),
])
def test_wrong_strands_are_named(strands, place):
    with pytest.raises(tractrix.TractrixError, match=place):
        tractrix.render(strands, unit="m", size=(8, 8))


@pytest.mark.parametrize("head", [np.eye(3), 2 * np.eye(4), np.diag((1, 1, -1, 1)), ((0, 0, 0), (0, 0, 0)), "left"])
def test_wrong_poses_are_named(curls, head):
    with pytest.raises(tractrix.TractrixValueError, match="head"):
        next(tractrix.simulate(curls, unit="m", head=[head]))


def test_poses_that_run_out_are_named(curls):
    with pytest.raises(tractrix.TractrixValueError, match="head: 1 items: expected one for each of 2 frames"):
        list(tractrix.simulate(curls, unit="m", frames=2, head=[np.eye(4)]))


def test_simulations_of_several_threads_take_turns(curls):
    results = [None] * 3

    def work(index):
        results[index] = list(tractrix.simulate(curls, unit="m", frames=3))[-1]

    threads = [threading.Thread(target=work, args=(index,)) for index in range(len(results))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    np.testing.assert_array_equal(results[0], results[1])
    np.testing.assert_array_equal(results[0], results[2])


def test_notebooks_see_the_hair_and_its_time():
    hair = tractrix.Simulation("assets/fur.tfx", look="plain", algo="none", fps=10)
    hair.advance()
    assert repr(hair) == "<tractrix.Simulation at 0.1 s>" and hair._repr_png_().startswith(b"\x89PNG")
    hair.close()
    assert repr(hair) == "<tractrix.Simulation, closed>" and hair._repr_png_() is None
    assert tractrix.__version__ == tractrix.version()


@pytest.mark.parametrize("call", [lambda: tractrix.Simulation("none.tfx"), lambda: tractrix.read_image("none.png"),
                                  lambda: tractrix.Simulation("assets/fur.tfx", mesh="none.obj")])
def test_a_missing_file_is_what_python_calls_it(call):
    with pytest.raises(FileNotFoundError, match="none") as caught:
        call()
    assert isinstance(caught.value, tractrix.TractrixValueError) and caught.value.code == 3


@pytest.mark.parametrize("name, value", [("color", 128.0), ("color", -0.1), ("thickness", -1.0)])
def test_values_of_vertices_have_their_range(name, value):
    strands = np.zeros((2, 3, 3), np.float32)
    strands[:, :, 1] = np.arange(3) * -0.1
    array = np.full((2, 3, 3) if name == "color" else (2, 3), 0.5, np.float32)
    array[1, 2] = value
    with pytest.raises(tractrix.TractrixValueError, match=f"{name}: strand 1: got {value:g}: expected") as caught:
        tractrix.Simulation(strands, unit="m", **{name: array})
    assert caught.value.code == 3


LONG = {"look": "plain", "preroll": 3600}  # seconds, which take minutes to simulate


def test_a_warm_up_tells_its_progress_and_ends_when_that_raises():
    shares = []

    def stop(share):
        shares.append(share)
        if len(shares) == 3:
            raise LookupError("enough")

    with pytest.raises(LookupError, match="enough"):
        tractrix.Simulation("assets/fur.tfx", progress=stop, **LONG)
    assert len(shares) == 3 and 0 < shares[0] < shares[1] < shares[2] < 0.5
    done = []
    tractrix.Simulation("assets/fur.tfx", progress=done.append, look="plain", preroll=0.5).close()
    assert done == sorted(done)


def test_ctrl_c_ends_a_warm_up():
    timer = threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        tractrix.Simulation("assets/fur.tfx", **LONG)
    timer.join()
    assert signal.set_wakeup_fd(-1) == -1
    tractrix.Simulation("assets/fur.tfx", look="plain", algo="none").close()


def test_a_scene_is_a_dict(tmp_path):
    scene = {"look": "plain", "sections": [{"file": "assets/fur.tfx", "color": "#c02040"}, {"file": "assets/curls.tfx", "radius": np.float64(1e-3)}]}
    (tmp_path / "scene.json").write_text(json.dumps({**scene, "sections": [{**section, "file": os.path.abspath(section["file"])} for section in scene["sections"]]}, default=float))
    images = [tractrix.render(source, size=(48, 32), exposure=0, algo="none") for source in (scene, tmp_path / "scene.json")]
    assert (images[0] == images[1]).all()
    with pytest.raises(tractrix.TractrixValueError, match="sections"):
        tractrix.Simulation({"sections": 3})
    with pytest.raises(tractrix.TractrixValueError, match="strands: .*expected a dict with what"):
        tractrix.Simulation({"sections": [object()]})


def test_rotations_and_meshes_of_other_modules_are_taken():
    class Rotation:
        def as_quat(self):
            return np.array([0, 0, 1, 0])

    class Trimesh:
        vertices, faces = np.eye(3), np.array([[0, 1, 2]])

    heads = [(Rotation(), (0.1, 0, 0)), ((0, 0, 1, 0), (0.1, 0, 0))]
    moved = [list(tractrix.simulate("assets/fur.tfx", head=[head], look="plain"))[0] for head in heads]
    assert (moved[0] == moved[1]).all()
    meshes = (Trimesh(), (Trimesh.vertices, Trimesh.faces))
    images = [tractrix.render("assets/fur.tfx", mesh=mesh, mesh_unit="m", look="plain", algo="none", exposure=0, size=(48, 32)) for mesh in meshes]
    assert (images[0] == images[1]).all()


def test_a_simulation_returns_to_a_state():
    with tractrix.Simulation("assets/fur.tfx", look="plain", wind=(3, 0, 0)) as hair:
        hair.advance()
        state = hair.save()
        ends = []
        for _ in range(2):
            hair.advance()
            ends.append(hair.positions())
            hair.restore(state)
        assert (ends[0] == ends[1]).all()
        with pytest.raises(tractrix.TractrixValueError, match="another simulation"):
            hair.restore(state[:100])
