# SPDX-License-Identifier: MIT
# compare(): figures, limits, alpha, masks, shapes and files of images.
import numpy as np
import pytest

import tractrix


@pytest.fixture
def image():
    return np.random.default_rng(1).integers(0, 256, (24, 32, 4), np.uint8)


def test_an_image_equals_itself(image):
    result = tractrix.compare(image, image)
    assert result.same and result.failing == 0 and result.compared == 24 * 32
    assert (result.rmse, result.flip, result.ssim) == (0, 0, 1)
    assert result.map.shape == (24, 32) and result.map.dtype == np.float32 and not result.map.any()


def test_one_pixel_is_found(image):
    image[:, :, 3] = 255
    other = image.copy()
    image[7, 5, 1], other[7, 5, 1] = 100, 110
    result = tractrix.compare(other, image)
    assert not result.same and result.failing == 1 and result.at == (5, 7)
    assert result.largest == pytest.approx(10) and result.map[7, 5] == pytest.approx(result.flip_most)
    assert tractrix.compare(other, image, pixel_tolerance=10).same
    assert not tractrix.compare(other, image, pixel_tolerance=9).same
    assert tractrix.compare(other, image, max_failing_percent=0.2).same
    assert not tractrix.compare(other, image, max_failing_percent=0.1).same
    assert tractrix.compare(other, image, max_flip=0.5).same  # without other limits it is the only one
    assert not tractrix.compare(other, image, max_flip=0.5, pixel_tolerance=0).same
    assert not tractrix.compare(other, image, max_flip=0, pixel_tolerance=20).same and tractrix.compare(image, image, max_flip=0).same


@pytest.mark.parametrize("name", ["pixel_tolerance", "max_failing_percent", "max_flip", "pixels_per_degree"])
@pytest.mark.parametrize("value", [-1, float("nan")])
def test_limits_below_zero_are_refused(image, name, value):
    """The library takes a negative limit for no limit."""
    with pytest.raises(tractrix.TractrixValueError, match=f"{name}: got {value}: expected"):
        tractrix.compare(image, ~image, **{name: value})


def test_alpha_counts(image):
    other = image.copy()
    other[3, 4, 3] ^= 64
    assert not tractrix.compare(other, image).same


def test_a_mask_hides_what_is_black(image):
    other, mask = image.copy(), np.full((24, 32), 255, np.uint8)
    other[3, 4] ^= 255
    mask[3, 4] = 0
    result = tractrix.compare(other, image, mask=mask)
    assert result.same and result.compared == 24 * 32 - 1 and np.isnan(result.map[3, 4])


def test_grey_and_rgb_are_opaque_rgba(image):
    grey = image[:, :, 0]
    rgb = np.dstack((grey, grey, grey))
    rgba = np.dstack((rgb, np.full_like(grey, 255)))
    assert tractrix.compare(grey, rgb).same and tractrix.compare(rgb, rgba).same and tractrix.compare(grey[:, :, None], rgba).same
    light = np.dstack((np.full((24, 32, 3), 0.5, np.float32), np.ones((24, 32), np.float32)))
    assert tractrix.compare(light[:, :, :3], light).same


def test_rows_may_lie_apart(image):
    wide = np.zeros((24, 40, 4), np.uint8)
    wide[:, :32] = image
    assert tractrix.compare(wide[:, :32], image).same


def test_sizes_must_be_equal(image):
    with pytest.raises(tractrix.TractrixValueError, match="24") as caught:
        tractrix.compare(image[:, :31], image)
    assert caught.value.code == 2


@pytest.mark.parametrize("value", [np.zeros((4, 4), int), np.zeros((4, 4, 2), np.uint8), np.zeros((0, 4, 4), np.uint8), np.zeros(4, np.uint8)])
def test_other_arrays_are_refused(value):
    with pytest.raises(tractrix.TractrixValueError, match="image: .*: expected"):
        tractrix.compare(value, np.zeros((4, 4), np.uint8))


@pytest.mark.parametrize("dtype, suffix", [(np.uint8, "png"), (np.uint16, "png"), (np.float32, "exr"), (np.float32, "pfm")])
@pytest.mark.parametrize("opaque", [True, False])
def test_files_keep_what_arrays_hold(tmp_path, dtype, suffix, opaque):
    top = 1 if dtype == np.float32 else np.iinfo(dtype).max
    image = (np.random.default_rng(2).random((5, 7, 4)) * top).astype(dtype)
    if opaque or suffix == "pfm":
        image[:, :, 3] = top
    tractrix.write_image(tmp_path / f"x.{suffix}", image)
    read = tractrix.read_image(tmp_path / f"x.{suffix}")
    assert read.dtype == dtype and read.shape == image.shape
    np.testing.assert_array_equal(read, image)
    assert tractrix.compare(tmp_path / f"x.{suffix}", read).same


def test_exr_files_hold_halves_on_request(tmp_path):
    image = np.random.default_rng(3).random((5, 7, 4)).astype(np.float32)
    tractrix.write_image(tmp_path / "x.exr", image, half=True)
    read = tractrix.read_image(tmp_path / "x.exr")
    np.testing.assert_allclose(read, image, rtol=2**-11)
    tractrix.write_image(tmp_path / "y.exr", image.astype(np.float16))
    np.testing.assert_array_equal(tractrix.read_image(tmp_path / "y.exr"), read)
    for path, value in (("x.pfm", image), ("x.exr", image * 1e5)):
        with pytest.raises(tractrix.TractrixValueError, match="half"):
            tractrix.write_image(tmp_path / path, value, half=True)


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_images_must_be_finite(tmp_path, value):
    image = np.zeros((4, 6), np.float32)
    image[2, 5] = value
    for call in (lambda: tractrix.compare(image, image), lambda: tractrix.compare(np.ones((4, 6)), image),
                 lambda: tractrix.write_image(tmp_path / "x.exr", image)):
        with pytest.raises(tractrix.TractrixValueError, match="expected finite numbers") as caught:
            call()
        assert caught.value.code == 3
    assert not (tmp_path / "x.exr").exists()


def test_local_and_largest_differences_have_limits(image):
    image[:, :, 3] = 255
    other = image.copy()
    image[8:12, 8:12, 0], other[8:12, 8:12, 0] = 100, 116
    result = tractrix.compare(other, image)
    assert result.local_difference == 1 and result.local_at == (0, 0) and not result.equal and not result.within
    for name, value in (("max_difference", 16), ("max_local_difference", 1)):
        assert tractrix.compare(other, image, **{name: value}).within
        assert not tractrix.compare(other, image, **{name: 0.9 * value}).within and not tractrix.compare(other, image, **{name: 0}).within


def test_masks_of_bools_and_no_masked_arrays(image):
    other, mask = image.copy(), np.ones((24, 32), bool)
    other[3, 4] ^= 255
    mask[3, 4] = False
    assert tractrix.compare(other, image, mask=mask).equal
    with pytest.raises(tractrix.TractrixValueError, match="masked array"):
        tractrix.compare(np.ma.masked_array(image, image > 7), image)


def test_files_that_are_none_say_so(tmp_path):
    (tmp_path / "x.png").write_bytes(b"no image")
    for name in ("x.png", "none.png"):
        with pytest.raises(tractrix.TractrixError, match=name) as caught:
            tractrix.read_image(tmp_path / name)
        assert caught.value.code in (1, 3)
    with pytest.raises(tractrix.TractrixValueError):
        tractrix.write_image(tmp_path / "y.png", np.zeros((2, 2, 4), np.float32))
