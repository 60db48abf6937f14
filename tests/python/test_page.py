# SPDX-License-Identifier: MIT
# The first picture of docs/python.md, in at most ten lines of code, drawn smaller.
import re

import tractrix


def test_the_page_draws_its_picture(pytestconfig, tmp_path, monkeypatch):
    code = re.search(r"^```python\n(.*?)^```", (pytestconfig.rootpath / "docs/python.md").read_text(), re.M | re.S)[1]
    assert len([line for line in code.splitlines() if line.strip() and not line.startswith("import ")]) <= 10
    smaller = code.replace("(640, 480)", "(64, 48)").replace("frames=40", "frames=2").replace("size=(3000, ", "size=(300, ")
    assert smaller.count("(64, 48)") == smaller.count("frames=2") == smaller.count("size=(300, ") == 1
    monkeypatch.chdir(tmp_path)
    exec(compile(smaller, "docs/python.md", "exec"), {})
    assert tractrix.read_image("python.png").shape == (48, 64, 4)
