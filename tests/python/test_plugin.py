# SPDX-License-Identifier: MIT
# The pytest plugin: goldens are found by the test's name, no golden is accepted automatically, and a page shows
# differences.
import numpy as np
import pytest

import tractrix

TEST = """
import numpy as np
import pytest

def picture(level=100, alpha=255):
    image = np.full((16, 16, 4), level, np.uint8)
    image[:, :, 3] = alpha
    return image

def test_plain(tractrix_image):
    tractrix_image.check({image})
"""


@pytest.fixture
def suite(pytester):
    """suite(image): a test file that checks this expression; run(*arguments) runs it."""

    def write(image):
        pytester.makepyfile(test_hair=TEST.format(image=image))

    write("picture()")
    pytester.write_test = write
    return pytester


def golden(suite, name="test_plain.png"):
    return suite.path / "goldens" / "test_hair" / name


def approve(suite):
    suite.runpytest("--tractrix-update")
    assert golden(suite).exists()


def test_a_missing_golden_fails_and_never_approves_itself(suite):
    for _ in range(2):
        result = suite.runpytest()
        result.assert_outcomes(failed=1)
        result.stdout.fnmatch_lines(["*goldens/test_hair/test_plain.png: no golden*--tractrix-update*"])
        assert not golden(suite).exists()
        assert (suite.path / "tractrix-results/tractrix-pairs/images/test_hair.test_plain.png").exists()


def test_update_writes_the_golden_and_fails_so_that_no_ci_passes_by_it(suite):
    result = suite.runpytest("--tractrix-update")
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(["*golden written: look at it*"])
    assert (tractrix.read_image(golden(suite)) == 100).any()
    suite.runpytest().assert_outcomes(passed=1)
    suite.runpytest("--tractrix-update").assert_outcomes(passed=1)


def test_update_follows_no_link_out_of_the_goldens(suite):
    outside = suite.path / "outside.png"
    golden(suite).parent.mkdir(parents=True)
    golden(suite).symlink_to(outside)
    result = suite.runpytest("--tractrix-update")
    result.stdout.fnmatch_lines(["*not written: a symbolic link*"])
    assert not outside.exists()


def test_an_image_that_differs_fails_with_figures_and_a_page(suite):
    approve(suite)
    suite.write_test("picture(104)")
    before = golden(suite).read_bytes()
    result = suite.runpytest()
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(["*256 of 256 pixels differ, at most by 4 levels at 0,0, FLIP 0.0*", "*1 image that differs: *report.html"])
    assert golden(suite).read_bytes() == before
    page = (suite.path / "tractrix-results/tractrix-pairs/report.html").read_text()
    assert "test_hair.test_plain" in page
    suite.write_test("picture()")
    suite.runpytest().assert_outcomes(passed=1)
    assert not (suite.path / "tractrix-results/tractrix-pairs/report.html").exists()  # the page of an earlier run is removed


def test_alpha_counts(suite):
    approve(suite)
    suite.write_test("picture(alpha=250)")
    suite.runpytest().assert_outcomes(failed=1)


def test_limits_and_masks_are_those_of_compare(suite):
    approve(suite)
    for image in ("picture(104), pixel_tolerance=4", "picture(104), max_flip=0.2", "picture(104), max_failing_percent=100",
                  "picture(104), mask=np.zeros((16, 16), np.uint8)"):
        suite.write_test(image)
        passed = suite.runpytest()
        if "mask" in image:  # a mask that hides everything is refused
            passed.assert_outcomes(failed=1)
        else:
            passed.assert_outcomes(passed=1)
    suite.write_test("picture(104), pixel_tolerance=3")
    suite.runpytest().assert_outcomes(failed=1)


def test_another_size_or_depth_is_no_golden(suite):
    approve(suite)
    suite.write_test("picture()[:8]")
    result = suite.runpytest()
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(["*16x8, but the golden has 16x16*"])
    suite.write_test("picture().astype(np.uint16) * 257, max_flip=1")
    result = suite.runpytest()
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(["*uint16, but the golden has uint8*"])


def test_floats_are_kept_as_exr(suite):
    suite.write_test("np.full((8, 8, 3), 2.1, np.float32)")
    suite.runpytest("--tractrix-update")
    assert tractrix.read_image(golden(suite, "test_plain.exr"))[0, 0].tolist() == [np.float32(2.1)] * 3 + [1]
    suite.runpytest().assert_outcomes(passed=1)


def test_every_test_class_parameter_and_name_has_its_golden(suite):
    suite.makepyfile(test_hair="""
        import numpy as np
        import pytest

        class TestA:
            @pytest.mark.parametrize("length", ["a/b", "c d"])
            def test_b(self, tractrix_image, length):
                image = np.zeros((4, 4), np.uint8)
                tractrix_image.check(image)
                tractrix_image.check(image, name="left")

        def test_twice(tractrix_image):
            image = np.zeros((4, 4), np.uint8)
            tractrix_image.check(image, name="x")
            tractrix_image.check(image, name="x")
    """)
    for _ in range(5):  # because a failing check ends its test
        suite.runpytest("--tractrix-update")
    result = suite.runpytest()
    result.assert_outcomes(passed=2, failed=1)
    result.stdout.fnmatch_lines(["*test_twice-x.png: this test has already checked an image*"])
    assert {path.name for path in golden(suite).parent.iterdir()} == {
        "TestA.test_b_a_b.png", "TestA.test_b_a_b_-left.png", "TestA.test_b_c_d.png", "TestA.test_b_c_d_-left.png", "test_twice-x.png"}


def test_two_tests_never_share_a_golden(suite):
    suite.makepyfile(test_hair="""
        import numpy as np
        import pytest

        class TestA:
            class TestB:
                def test_b(self, tractrix_image):
                    tractrix_image.check(np.zeros((4, 4), np.uint8))

        class TestB:
            def test_b(self, tractrix_image):
                tractrix_image.check(np.zeros((4, 4), np.uint8))

        @pytest.mark.parametrize("length", ["a/b", "a_b"])
        def test_c(tractrix_image, length):
            tractrix_image.check(np.zeros((4, 4), np.uint8))
    """)
    suite.runpytest("--tractrix-update")
    result = suite.runpytest()
    result.assert_outcomes(passed=3, failed=1)
    result.stdout.fnmatch_lines(["*test_c_a_b.png: test_hair.py::test_c?a/b? has a golden of the same name: expected *"])
    assert {path.name for path in golden(suite).parent.iterdir()} == {"TestA.TestB.test_b.png", "TestB.test_b.png", "test_c_a_b.png"}


def test_files_of_one_name_in_two_folders_are_told_apart(suite):
    (suite.path / "test_hair.py").rename(suite.mkpydir("left") / "test_hair.py")
    (suite.mkpydir("right") / "test_hair.py").write_text((suite.path / "left/test_hair.py").read_text())
    suite.runpytest().assert_outcomes(failed=2)
    assert {path.name for path in (suite.path / "tractrix-results/tractrix-pairs/images").iterdir()} == {
        "left.test_hair.test_plain.png", "right.test_hair.test_plain.png"}


def test_results_go_where_they_are_wanted_and_nothing_else_is_removed(suite):
    (suite.path / "kept").mkdir()
    (suite.path / "kept/mine.txt").write_text("x")
    suite.runpytest("--tractrix-results", "kept")
    assert (suite.path / "kept/tractrix-pairs/images/test_hair.test_plain.png").exists() and (suite.path / "kept/mine.txt").exists()


def test_results_beside_goldens_remove_none(suite):
    approve(suite)
    mine = [suite.path / "images/mine.png", suite.path / "report.html"]
    mine[0].parent.mkdir()
    for path in mine:
        path.write_text("mine")
    suite.runpytest("--tractrix-results", ".").assert_outcomes(passed=1)
    assert [path.read_text() for path in mine] == ["mine", "mine"]


def test_without_the_program_images_are_kept_and_a_line_says_so(suite, monkeypatch):
    monkeypatch.setenv("TRACTRIX_BIN", "/nowhere")
    monkeypatch.setattr("tractrix.pytest_plugin.pathlib.Path.with_name", lambda path, name: path / "none")
    result = suite.runpytest()
    result.stdout.fnmatch_lines(["*no page: tractrix-compare is not in PATH*"])


def test_tests_without_images_are_left_alone(suite):
    suite.makepyfile(test_hair="def test_nothing(): pass")
    result = suite.runpytest()
    result.assert_outcomes(passed=1)
    assert not (suite.path / "tractrix-results").exists()
    result.stdout.no_fnmatch_line("*tractrix: *")
