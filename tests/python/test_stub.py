# SPDX-License-Identifier: MIT
# Types: the stub agrees with the table of parameters, and a type checker finds mistakes with it.
import os
import shutil
import subprocess
import sys

import pytest


def test_the_stub_is_that_of_the_table(pytestconfig):
    printed = subprocess.run([sys.executable, "scripts/python-stub"], cwd=pytestconfig.rootpath, capture_output=True, text=True, check=True).stdout
    kept = (pytestconfig.rootpath / "python/tractrix/_parameters.pyi").read_text()
    assert kept == printed, "python/tractrix/_parameters.pyi is out of date: run scripts/update-options"


@pytest.mark.skipif(not shutil.which("mypy"), reason="no mypy")
def test_a_type_checker_takes_what_is_right_and_finds_what_is_wrong(pytestconfig, tmp_path):
    (tmp_path / "example.py").write_text("""\
import numpy as np
import tractrix

strands = np.zeros((1, 2, 3))
image = tractrix.render(strands, unit="m", wind=(2, 0, 0), shadow="dom", style=(0.9, 0.3), turn_lights=True)
tractrix.compare(image, "golden.png", max_flip=0.02).flip + 1
tractrix.render(strands, unit="m", shadow="deep")
tractrix.render(strands, unit="m", wnd=(2, 0, 0))
tractrix.render(strands, unit="m", turn_lights="maybe")
""")
    # mypy compares what it keeps there with the files; numpy's types alone take it 2 s.
    cache = pytestconfig.rootpath / "out/mypy-cache"
    run = subprocess.run([shutil.which("mypy"), "--enable-incomplete-feature=Unpack", "--cache-dir", str(cache), "example.py"], cwd=tmp_path,
                         env={**os.environ, "MYPYPATH": str(pytestconfig.rootpath / "python")}, capture_output=True, text=True)
    wrong = sorted(int(line.split(":")[1]) for line in run.stdout.splitlines() if line.startswith("example.py:") and ": error:" in line)
    assert wrong == [7, 8, 9], run.stdout + run.stderr
