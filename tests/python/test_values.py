# SPDX-License-Identifier: MIT
# Parameters as keywords: each value becomes the text of a flag.
import pathlib

import numpy as np
import pytest

import tractrix
from tractrix._values import text_of


@pytest.mark.parametrize("name, value, text", [
    ("wind", (2, 0, 0), "2,0,0"),
    ("wind", np.array([0.5, 1e-7, -3.0]), "0.5,1e-07,-3.0"),
    ("style", (0.9, 0.3), "0.9:0.3"),
    ("style", 0.25, "0.25"),
    ("style", np.float32(0.5), "0.5"),
    ("wind", (np.float32(0.5), np.float64(1), 0), "0.5,1.0,0"),
    ("wind", [np.int64(2), np.array(3), -1.5], "2,3,-1.5"),
    ("smooth", np.int64(3), "3"),
    ("turn_lights", True, "true"),
    ("turn_lights", np.bool_(False), "false"),
    ("color", "auburn", "auburn"),
    ("color_map", pathlib.Path("a/b.png"), "a/b.png"),
])
def test_values_become_a_flags_text(name, value, text):
    assert text_of(name, value) == text


@pytest.mark.parametrize("use", [
    lambda text: tractrix.read_image(text),
    lambda text: tractrix.write_image(text, np.zeros((2, 2, 4), np.uint8)),
    lambda text: tractrix.simulate(text, frames=1),
    lambda text: tractrix.simulate("assets/fur.tfx", frames=1, color_map=pathlib.Path(text)),
])
def test_a_zero_character_ends_no_path(use):
    with pytest.raises(tractrix.TractrixValueError, match="expected no zero character"):
        use("assets/ball.obj\0.png")


@pytest.mark.parametrize("value", [object(), {"x": 1}, ("a", "b"), (True, False), 1j])
def test_other_values_are_refused(value):
    with pytest.raises(tractrix.TractrixValueError, match="wind: got .*: expected a text, a number") as caught:
        text_of("wind", value)
    assert caught.value.code == 2


def test_the_table_is_that_of_the_programs():
    table = tractrix.parameters()
    wind = table["wind"]
    assert (wind.kind, wind.unit, wind.default, wind.live, wind.of_section) == ("vec3", "m/s", "0,0,0", True, False)
    assert table["shadow"].choices == ("none", "approx", "dom")
    assert table["youngs_modulus"].owner == ("rod",)
    assert (table["fov"].minimum, table["fov"].maximum) == (1, 170)
    assert not {"output", "cache", "stats", "device", "quiet"} & set(table)
